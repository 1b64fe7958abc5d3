"""Commands that change something are carried out only where a word of theirs is said and the model is sure."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred
from wirelessagent.language.word_tables import words_of

CHANGING = ("apply", "confirm", "undo", "reset")
_SURE_OF_A_COMMAND = 0.6
_CUES = {  # a command that changes something has a part of one of these words in it
    topic: deferred(f"(?i){'|'.join(words_of('talk_forms', 'cues', topic))}") for topic in ("reset", "undo", "apply")
}


def is_unsure(topic: str, plain: str, certainty: float) -> bool:
    """Whether a command that changes something may have been meant, and has to be asked for.

    >>> is_unsure("undo", "undo that", 0.9), is_unsure("undo", "hmm", 0.9), is_unsure("history", "hmm", 0.5)
    (False, True, False)
    """
    cue = _CUES.get(topic)
    said = cue is None or cue.search(plain) is not None
    return topic in CHANGING and not (said and certainty >= _SURE_OF_A_COMMAND)

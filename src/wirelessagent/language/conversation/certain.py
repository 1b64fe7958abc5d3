"""Whether a command that changes something is all that a line says; where it is not, the operator is asked.

The offline recogniser hears "undo" in "the people in the back can't hear us" and in "I didn't say undo". So what it
takes for apply, undo or start over is carried out only where every word of the line belongs to such a command.
"""

from __future__ import annotations

import re

from wirelessagent.language import forms
from wirelessagent.language.conversation.command_words import CHINESE, WORDS
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import NAME
from wirelessagent.language.text import normalise

_CHANGING = ("apply", "undo", "reset")
_LONGEST = 120
"""Characters of a line that may be nothing but a command."""

_ZH_WORD = re.compile("|".join(CHINESE))
_ZH_DENIED = re.compile("如果|要是|假如|吗|要不要|该不该|能不能|可不可以|没|别|不(?:是|要|用|想|该|能|会|准|许|再)|未")
_LATIN = re.compile(r"[a-zß-ÿœ](?:[a-zß-ÿœ'’-]*[a-zß-ÿœ])?")
_LETTER = re.compile(r"[^\W_]")
_POLITE = re.compile(
    r"^(?:(?:oh|ah|well|ok(?:ay)?)[,\s]+)?(?:no|nein|non)\s*[,，.;!]\s*|\b(?:could|can|would|will)\s+you(?:\s+mind)?\b|\bnever\s*mind\b|"
    r"^(?:could|can)\s+(?:we|i)\b|\bgo\s+ahead\b|能不能帮我|可不可以帮我|能帮我"
)


def made_certain(line: Line, intent: Intent, text: str) -> Intent:
    """The command where a line is nothing else or it changes nothing, a question of yes or no in its place otherwise.

    ``text`` is all that was said; a line may be the beginning of it.
    """
    if intent.kind != "command" or intent.topic not in _CHANGING or not intent.recogniser.startswith(NAME):
        return intent
    if is_only_a_command(text):
        return intent
    return line.ask("unsure_command", text=line.voice.say(f"command.{intent.topic}"))


def is_only_a_command(text: str) -> bool:
    """Whether every word of a line belongs to a command, and none denies it, supposes it or asks about it.

    >>> is_only_a_command("oh no, please take that back"), is_only_a_command("he's back")
    (True, False)
    """
    plain = normalise(text).lower().strip()
    if len(plain) > _LONGEST:
        return False
    said = _POLITE.sub(" ", plain)
    if said == plain and (plain.endswith("?") or forms.begins_like_a_question(plain)):
        return False
    if _ZH_DENIED.search(said):
        return False
    words = _LATIN.findall(said)
    if any(word.replace("’", "'") not in WORDS for word in words):
        return False
    return not _LETTER.search(_ZH_WORD.sub("", _LATIN.sub("", said)))

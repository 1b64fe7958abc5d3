"""The LLM recogniser: an LLM chooses the meaning, the rules hold it to the figures, and answer where it does not.

Every sentence is read by the offline recogniser first. The LLM then fills in a typed form (:mod:`.prompt`), in which
figures are references to those that the parser found; what it says is checked against the sentence (:mod:`.check`), and
it is asked once more if that fails. After that, and whenever it does not answer in time, the offline recogniser's
intent stands, and says so. Either goes through the guard that stands behind every recogniser.
"""

from __future__ import annotations

import dataclasses
import logging

from wirelessagent.language.intent import Intent
from wirelessagent.language.llm import prompt
from wirelessagent.language.llm.check import NAME, Case
from wirelessagent.language.llm.client import LlmSettings, NoAnswer, ask, require_llm
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.sentence import own_words
from wirelessagent.language.text import normalise
from wirelessagent.telling.catalogue import message

_MAX_CHARACTERS = 2000
_log = logging.getLogger(__name__)


class LlmRecogniser(Recogniser):
    """Recognises intents with the LLM of the settings, and offline where it fails.

    Raises:
        InputError: the settings are not complete.
        MissingDependencyError: the extra ``llm`` is not installed.
    """

    name = NAME
    is_spared = True

    def __init__(self, settings: LlmSettings | None = None, offline: Recogniser | None = None) -> None:
        require_llm()
        self._settings = settings or LlmSettings.read()
        self._offline = offline or OfflineRecogniser()

    def read(self, text: str, context: Context | None = None) -> Intent:
        """What the operator may mean, as it is read; never raises, whatever the text."""
        known = context or Context()
        offline = self._offline.read(text, known)
        if not text.strip() or len(text) > _MAX_CHARACTERS or too_many_figures(normalise(text)):
            return offline
        own = own_words()
        case = Case(text, known, offline, own)
        try:
            data = prompt.case(text, case.figures, known)
            form = prompt.meaning_with(tuple(words.objective for words in own))
            return ask(self._settings, prompt.instructions(own), data, case.read, form=form)
        except NoAnswer as error:
            _log.info("%s", error)
            note = message(offline.language, "llm.note", clause=error.told(offline.language))
            reply, recogniser = f"{offline.reply} {note}".strip(), f"{offline.recogniser} ({error})"
            return dataclasses.replace(offline, reply=reply, recogniser=recogniser)

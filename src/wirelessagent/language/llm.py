"""The LLM recogniser: an LLM chooses the meaning, the rules hold it to the figures, and answer where it does not.

Every sentence is read by the offline recogniser first. The LLM then fills in a typed form (:mod:`llm_meaning`), in
which figures are references to those that the parser found; what it says is checked against the sentence
(:mod:`llm_check`), and it is asked once more if that fails. After that, and whenever it does not answer in time, the
offline recogniser's intent stands, and says so.
"""

from __future__ import annotations

import dataclasses
import logging
from collections.abc import Mapping
from typing import cast

from wirelessagent import plugins
from wirelessagent.language import llm_prompt
from wirelessagent.language.excess import too_many_figures
from wirelessagent.language.intent import Constraint, Intent, IntentKind
from wirelessagent.language.llm_check import Case, Read
from wirelessagent.language.llm_door import NoAnswer, fill_in, require_llm
from wirelessagent.language.llm_meaning import meaning_with
from wirelessagent.language.llm_prompt import Offer
from wirelessagent.language.llm_reasons import note
from wirelessagent.language.llm_settings import LlmSettings
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.replies import Voice
from wirelessagent.language.sentence import labels_of, own_words
from wirelessagent.language.text import normalise
from wirelessagent.model.objective import Objective

NAME = "llm"
_MAX_CHARACTERS = 2000
_AGREED, _ALONE = 0.95, 0.8  # how sure: both recognisers read the same kind, objective and topic, or the LLM alone
_log = logging.getLogger(__name__)


class LlmRecogniser(Recogniser):
    """Recognises intents with the LLM of the settings, and offline where it fails.

    Raises:
        InputError: the settings are not complete.
        MissingDependencyError: the extra ``llm`` is not installed.
    """

    name = NAME

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
        offers = offered()
        case = Case(text, known, offline, [offer.own_words() for offer in offers])
        try:
            read = fill_in(
                self._settings,
                llm_prompt.instructions(offers),
                _sendable(llm_prompt.case(text, case.figures, known)),
                meaning_with(tuple(offer.name for offer in offers)),
                case.read,
            )
        except NoAnswer as error:
            _log.info("%s", error)
            return _without_llm(offline, error)
        return _intent(read, case)


def offered() -> tuple[Offer, ...]:
    """Every objective that loads, as an LLM is told of it."""
    found = [item for item in plugins.plugins("objective") if item.cls is not None]
    return tuple(
        Offer(name=item.name, summary=item.summary, phrases=cast("type[Objective]", item.cls).phrases) for item in found
    )


def _sendable(data: str) -> str:
    """The data as they are, unless they hold half a character."""
    try:
        data.encode()
    except UnicodeEncodeError as error:
        raise NoAnswer("unsendable") from error
    return data


def _without_llm(offline: Intent, error: NoAnswer) -> Intent:
    """The offline recogniser's intent, which says that it is and why."""
    said = note(error.told(offline.language), offline.language)
    return dataclasses.replace(
        offline, reply=f"{offline.reply} {said}".strip(), recogniser=f"{offline.recogniser} ({error})"
    )


def _intent(read: Read, case: Case) -> Intent:
    offline = case.offline
    agreed = (read.kind, read.objective, read.topic) == (offline.kind, offline.objective, offline.topic)
    same = agreed and dict(read.constraints) == dict(offline.constraints)
    left = {name: words for name, words in offline.evidence.items() if name == "not_used"}
    return Intent(
        kind=cast(IntentKind, read.kind),
        objective=read.objective,
        constraints=read.constraints,
        dropped=read.dropped,
        amends=read.amends,
        topic=read.topic,
        details=read.details,
        language=read.language,
        confidence=_AGREED if agreed else _ALONE,
        pending=_rules(offline) if read.kind == "clarify" else {},
        evidence={**read.evidence, **left} if read.kind == "allocate" else {},
        reply=offline.reply if same and read.kind != "clarify" else _reply(read),
        recogniser=NAME,
    )


def _rules(offline: Intent) -> Mapping[str, Constraint]:
    """What the rules read, for the answer to a question back to use."""
    return {**offline.pending, **offline.constraints}


def _reply(read: Read) -> str:
    """What to say to a sentence that the rules read otherwise."""
    if read.kind == "clarify":
        return read.question
    voice = Voice(read.language, labels_of(own_words(), read.language))
    if read.objective is not None and read.amends:
        return voice.amended(read.constraints, read.dropped)
    if read.objective is not None:
        return voice.restated(read.objective, read.constraints, ())
    if read.kind == "out_of_scope" or read.topic is None:
        return voice.say("out_of_scope" if read.kind == "out_of_scope" else "help")
    return voice.say(f"{read.kind}.{read.topic}", user=voice.user(str(read.details.get("user", ""))))

"""The LLM recogniser: an LLM chooses the meaning, the rules hold it to the figures, and answer where it does not.

Every sentence is read by the offline recogniser first. The LLM then fills in a typed form (:mod:`.prompt`), in which
figures are references to those that the parser found; what it says is checked against the sentence, and it is asked
once more if that fails. After that, and whenever it does not answer in time, the offline recogniser's intent stands,
and says so.

The check is the same whichever LLM it is and whatever it was told: the LLM chooses among what the rules leave open. The
aim or the change that it sees must be one that the model of the rules finds possible; its figures, users and limits are
those that the rules read or that the conversation holds; where the rules are in doubt about one, the operator is asked.
Only the operator's plain words apply an allocation. Of a question back they see what only asks, with figures that were
listed: what claims that something was done, or names an address, is no question. What such an intent may still have
missed (a refusal, a report, a condition) is the guard's to see, as it is of any recogniser.
"""

from __future__ import annotations

import dataclasses
import functools
import logging
import math
import re
import unicodedata
from collections.abc import Mapping, Sequence
from typing import Any

from wirelessagent.language import moods
from wirelessagent.language.guard import CHANGING
from wirelessagent.language.intent import (
    EVERYBODY,
    LISTS_OF_USERS,
    Constraint,
    Detail,
    Intent,
    checked_constraints,
    same_constraints,
)
from wirelessagent.language.llm import prompt
from wirelessagent.language.llm.client import LlmSettings, NoAnswer, Objection, ask, require_llm
from wirelessagent.language.llm.prompt import KINDS, Meaning, Reference, figures_of, matching, plain
from wirelessagent.language.moods import dropped_in, may_lift
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.quantities import amount_of_another_time, parse_quantities
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.replies import Voice
from wirelessagent.language.request import serving
from wirelessagent.language.sentence import labels_of, own_words, read_once
from wirelessagent.language.stated import unread
from wirelessagent.language.text import normalise
from wirelessagent.language.vocabulary import OwnWords
from wirelessagent.language.word_tables import deferred, either
from wirelessagent.model.errors import InputError
from wirelessagent.telling.catalogue import message

NAME = "llm"
ACTING = ("apply", "confirm")
"""Commands that only the operator's plain words may give."""

_AGREED, _ALONE = 0.95, 0.8  # how sure: both recognisers read the same kind, objective and topic, or the LLM alone
_POSSIBLE = 0.1
"""The least chance that the rules' model gives what an LLM may see; by the development sets, with LLMs that lie."""
_SOMETHING_ELSE = 0.6
"""The chance of a question, or of something else, from which an LLM may see no request in it; by the same."""
_SENTENCE = deferred(r"(?s).+?(?:[.!?](?=\s|$)|[。！？\uff1f\uff01]|\n|$)")
_ADDRESS = deferred(
    r"(?i)[a-z][a-z0-9+.-]*:\s*/\s*/|\bwww\.|\b(?:mailto|javascript|data|tel):|[^\s@]@[^\s@]|\[\s*link|\]\s*\(|"
    r"(?<![0-9])[a-z0-9-]+\.(?:[a-z]{2,24})(?=[/\s:?#,;)\uff1f]|$)"
)
_CLAIM = deferred(rf"(?i)(?<!\bbe ){either('talk_forms', 'sentences', 'claims')}")
_CLOSE = 1e-6
_NUMBERED = deferred(r"[^0-9]*([0-9]{1,9})[^0-9]*")


class Case:
    """One sentence in its conversation, as the rules read it, beside which an LLM's meaning is held.

    Attributes:
        rules: the constraints that the rules read, whatever kind of sentence they see.
        figures: those that the LLM may refer to.
    """

    def __init__(self, text: str, context: Context, offline: Intent, own: Sequence[OwnWords] = ()) -> None:
        self._text, self._context, self._offline, self._own = text, context, offline, tuple(own) or own_words()
        self._sentence = read_once(text, self._own, context)
        self._reading, self._plain = self._sentence.reading, self._sentence.plain
        asks = offline.kind in ("allocate", "clarify")
        self.rules: Mapping[str, Constraint] = (
            {**offline.pending, **offline.constraints} if asks else self._reading.values
        )
        self.figures = figures_of(self._sentence, context, offline, self.rules)
        self._chances = self._sentence.chances.kinds
        _, back = serving(self._reading.back, context.constraints, context.user_names)
        dropped, self._dropped_spans = dropped_in(self._plain, context)
        self._dropped = {*offline.dropped, *dropped, *back} & set(context.constraints)

    def read(self, meaning: Meaning) -> Intent:
        """The meaning as an intent.

        Raises:
            Objection: it cannot be what the sentence says.
        """
        try:
            return self._intent(meaning)
        except InputError as error:
            raise Objection("impossible", str(error)) from error

    def _intent(self, meaning: Meaning) -> Intent:
        given: dict[str, Any] = {"objective": None, "constraints": {}, "evidence": {}, "reply": ""}
        if meaning.kind == "allocate":
            given |= self._request(meaning)
        elif meaning.kind == "clarify":
            known = [figure.value for figure in self.figures if figure.kind in ("power", "rate")]
            given |= {"reply": question_back(meaning.question, known), "pending": self.rules}
        elif meaning.kind != "out_of_scope":
            given |= self._about(meaning)
        intent = Intent(kind=meaning.kind, language=meaning.language, recogniser=NAME, confidence=_ALONE, **given)
        offline = self._offline
        agreed = (intent.kind, intent.objective, intent.topic) == (offline.kind, offline.objective, offline.topic)
        as_read = agreed and dict(intent.constraints) == dict(offline.constraints)
        reply = intent.reply or (offline.reply if as_read else self._reply(intent))
        return dataclasses.replace(intent, confidence=_AGREED if agreed else _ALONE, reply=reply)

    def _reply(self, intent: Intent) -> str:
        """What to say to a sentence that the rules read otherwise."""
        voice = Voice(intent.language, labels_of(self._own, intent.language))
        if intent.objective is not None:
            amended = voice.amended(intent.constraints, intent.dropped) if intent.amends else None
            return voice.restated(intent.objective, intent.constraints, ()) if amended is None else amended
        if intent.kind == "out_of_scope" or intent.topic is None:
            return voice.say("out_of_scope" if intent.kind == "out_of_scope" else "help")
        return voice.say(f"{intent.kind}.{intent.topic}", user=voice.users((str(intent.details.get("user", "")),)))

    def _request(self, meaning: Meaning) -> dict[str, Any]:
        objective = meaning.objective or (self._context.objective if meaning.amends else None)
        if objective is None or meaning.topic is not None:
            raise Objection("impossible", "kind allocate needs an objective and no topic; use clarify if it is unclear")
        words = self._quoted(meaning, objective)
        constraints = self._constraints(meaning)
        self._lets_nothing_go(meaning)
        new = any(not self._is_held(name, value) for name, value in constraints.items())
        changes = not words and objective == self._context.objective and bool(new or meaning.drops)
        if (self._offline.kind, self._offline.objective) != ("allocate", objective):
            self._is_possible(None if changes else objective)
        self._agrees(constraints)
        said = {"objective": words} if words else {}
        known = {name: words for name, words in self._offline.evidence.items() if name in (*constraints, "not_used")}
        return {
            "objective": objective, "constraints": {**constraints, **self.rules}, "dropped": tuple(meaning.drops),
            "amends": meaning.amends, "evidence": known | said,
        }  # fmt: skip

    def _quoted(self, meaning: Meaning, objective: str) -> str:
        """The operator's words for the objective, as they stand in the sentence."""
        quote = [re.escape(word) for word in normalise(meaning.objective_words).split()]
        if not quote:
            if objective in (self._context.objective if meaning.amends else None, self._offline.objective):
                return ""
            raise Objection("not_quoted", "copy the operator's words into objective_words")
        match = re.search(r"\s+".join(quote), normalise(self._text), re.IGNORECASE)
        if match is None:
            raise Objection("misquoted", "objective_words must be copied from the sentence exactly, in one piece")
        return self._text[slice(*match.span())]

    def _is_possible(self, label: str | None) -> None:
        """Objects to an aim or a command that the rules give no chance, and to a request where they see none.

        Without a label, what is asked for only changes the limits of the current request.
        """
        seen = self._offline.kind
        chance = sum(chance for label, chance in self._chances.items() if label.partition(".")[0] == seen)
        if (seen in ("question", "out_of_scope") and chance >= _SOMETHING_ELSE) or moods.is_a_program(self._text):
            raise Objection("not_asked", f"the sentence asks for nothing of the cell: kind {seen}, or clarify")
        goal = self._sentence.goal  # an aim of a plug-in is found by its own phrases
        spoken = 1.0 if label in goal.options and goal.verdict == "clear" else 0.0
        if label is not None and self._chances.get(label, spoken) < _POSSIBLE:
            raise Objection("not_tied", f"the sentence speaks of no {label}: say what it speaks of, or use clarify")

    def _lets_nothing_go(self, meaning: Meaning) -> None:
        """Limits of the current request go if the operator took them back, and only then."""
        held = self._context.constraints
        amends, drops = meaning.amends, set(meaning.drops)
        if (amends and self._context.objective is None) or (drops and not (amends and drops <= set(held))):
            raise Objection("no_request", f"the current request to amend has {', '.join(held) or 'no limits'}")
        if held:
            keeps = amends or bool(self._dropped) or not self._reading.values or moods.keeps_the_limits(self._plain)
            expected = self._offline.amends if self._offline.kind == "allocate" else keeps
            if amends != expected:
                raise Objection("let_go" if expected else "no_request", f"amends must be {str(expected).lower()} here")
        if drops != self._dropped if self._dropped else not all(may_lift(name, self._plain) for name in drops):
            expected = ", ".join(sorted(self._dropped)) or "nothing"
            raise Objection("let_go", f"the sentence takes back {expected}: drops must be that, or use clarify")

    def _constraints(self, meaning: Meaning) -> dict[str, Constraint]:
        found: dict[str, dict[str, float]] = {}
        for stated in meaning.constraints:
            value = self._figure(stated.figure, stated.constraint)
            if stated.constraint == "outage_probability" and value >= 0.5:
                value = round(1 - value, 12)  # a reliability, and the outage that it leaves
            users = list(map(self._user, stated.users)) or [EVERYBODY]
            found[stated.constraint] = found.get(stated.constraint, {}) | dict.fromkeys(users, value)
        figures = {name: value[EVERYBODY] if set(value) == {EVERYBODY} else value for name, value in found.items()}
        lists = {name: tuple(dict.fromkeys(map(self._user, getattr(meaning, name)))) for name in LISTS_OF_USERS}
        return {**figures, **{name: users for name, users in lists.items() if users}}

    def _figure(self, given: Reference, name: str) -> float:
        """The figure that is referred to for a constraint or a detail."""
        figure = matching(self.figures, given, name)
        if figure is None:
            fit = ", ".join(each.label for each in self.figures if matching([each], each.label, name))
            raise Objection("invented", f"{name}: {str(given)[:40]!r} was not said; said is {fit or 'none'}")
        return figure.value

    def _user(self, said: str) -> str:
        """A user as the operator calls them, by number or by name; neither sentence nor session names others."""
        name = said.strip().casefold()
        match = _NUMBERED.fullmatch(name)
        number = "" if match is None else str(int(match[1]))
        known = next((each for each in sorted(self._named) if each.casefold() in (name, number)), None)
        if known is None:
            raise Objection("no_user", f"the sentence names no user {said.strip()[:40]!r}")
        return known

    @functools.cached_property
    def _named(self) -> set[str]:
        """Everybody whom the sentence or the session names."""
        context = self._context
        named = {*self._reading.named, *context.question.users, str(self._offline.details.get("user", EVERYBODY))}
        for limits in (self.rules, context.question.pending, context.constraints, context.supposed):
            for value in limits.values():
                named.update(value if isinstance(value, Mapping | tuple) else (EVERYBODY,))
        return named

    def _agrees(self, constraints: Mapping[str, Constraint]) -> None:
        """The rules read the same, wherever they read anything; what they did not read is as the session holds it."""
        for name, value in constraints.items():
            if name not in self.rules and not self._is_held(name, value):
                raise Objection("doubtful", f"the sentence is not plain about {plain({name: value})}: use clarify")
        for name, value in self.rules.items():
            if not _is_in(constraints, name, value):
                words = self._offline.evidence.get(name, "") or "the sentence"
                key = "otherwise" if name in constraints else "left_out"
                raise Objection(key, f"{words!r} says {plain({name: value})}; say so too, or use clarify")
        named = [(item.start, item.end) for item in self._sentence.found if item.term.concept != "domain"]
        known = [*self._reading.masked, *self._reading.counted, *named, *self._dropped_spans]
        if self._reading.doubts or unread(self._plain, known) or amount_of_another_time(self._plain):
            raise Objection("doubtful", "a figure or a user of the sentence is not plain: use clarify")

    def _is_held(self, name: str, value: Constraint) -> bool:
        """Whether the session holds exactly this limit."""
        context = self._context
        own = {} if name in context.constraints else {"max_power_w": context.max_power_w}
        return any(_is_in(limits, name, value) for limits in (context.constraints, context.question.pending, own))

    def _about(self, meaning: Meaning) -> dict[str, Any]:
        """A question or a command."""
        topic = meaning.topic
        plainly = (self._offline.kind, self._offline.topic) == ("command", topic)
        unasked = topic == "confirm" and self._context.awaits != "confirmation"
        changes = meaning.kind == "command" and topic in CHANGING and not plainly
        if (topic in ACTING and (unasked or not plainly)) or (changes and "not" in self._sentence.concepts):
            raise Objection("go_ahead", f"the operator did not plainly say {topic}: use clarify")
        if changes:
            self._is_possible(f"command.{topic}")
        details: dict[str, Detail] = {}
        for name, given in meaning.details.model_dump(exclude_none=True).items():
            details[name] = self._figure(given, name) if name in KINDS else given
        if "user" in details:
            details["user"] = self._user(str(details["user"]))
        if "compared_with" in details:
            details["with"] = details.pop("compared_with")
        if topic == "what_if" and (constraints := checked_constraints(self._constraints(meaning))):
            details["constraints"] = constraints
        if topic == "what_if" and meaning.objective:
            details["objective"] = meaning.objective
        return {"topic": topic, "details": details}


def _is_in(limits: Mapping[str, Constraint], name: str, value: Constraint) -> bool:
    """Whether a constraint stands among these limits as it is."""
    return name in limits and same_constraints({name: value}, {name: limits[name]}, _CLOSE)


def question_back(text: str, known: Sequence[float]) -> str:
    """What to ask the operator, of what an LLM says; ``known`` are the figures in W and bit/s that it may name.

    >>> question_back("I see. The least power or the highest rate?", [])
    'The least power or the highest rate?'

    Raises:
        Objection: it asks nothing, or does not only ask.
    """
    if _ADDRESS.search(text):
        raise Objection("pretended", "the question may hold no address or link")
    shown = "".join(sign if unicodedata.category(sign)[0] != "C" or sign == "\n" else " " for sign in text)
    asked = [said for each in _SENTENCE.findall(shown.strip()) if (said := each.strip()).endswith(("?", "\uff1f"))]
    question = " ".join(asked)
    if not question:
        raise Objection("asked_nothing", "kind clarify needs a question to the operator, with its question mark")
    if _CLAIM.search(question):
        raise Objection("pretended", "nothing was done, so the question may not say so")
    said = [q for q in parse_quantities(question) if q.kind in ("power", "rate")]
    if any(not any(math.isclose(q.value, value, rel_tol=1e-3) for value in known) for q in said):
        raise Objection("invented", "the question may only name listed figures")
    return question


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

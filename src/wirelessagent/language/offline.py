"""The offline recogniser: a lexicon and rules, no model, no network. It acts only when it is sure, and asks otherwise.

Figures first (``quantities``, ``constraints``), then the objective from the words that remain (``vocabulary``,
``goals``). There is one default: a rate for each user under a power limit, with no wish, means the highest total rate
with both; a rate or a limit alone is asked about. Any registered objective is understood by its name, its aliases and
its own phrases.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from typing import cast

from wirelessagent import plugins
from wirelessagent.language import goals
from wirelessagent.language.constraints import Reading, read_constraints
from wirelessagent.language.goals import Goal
from wirelessagent.language.intent import CONSTRAINTS, Intent, IntentKind
from wirelessagent.language.leftovers import unread
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.replies import Voice
from wirelessagent.language.text import language_of, normalise
from wirelessagent.language.vocabulary import Found, OwnWords, Unit, Vocabulary, units_of
from wirelessagent.model.objective import Objective

NAME = "offline"
_MAX_CHARACTERS = 2000
_DEFAULT_CONFIDENCE = 0.75
_BUILT_IN_ORDER = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
_FAIR_OBJECTIVES = ("proportional_fairness", "max_min_rate")
_COMPARE = ("compare", "比较", "对比")
_REFUSED = re.compile(
    r"(?i)[,.?!;:\uff0c。]\s*(?:no|not|nope|never|不|不要|不是|不行|不用)[\s.!。]*$"
)  # "max rate? no"
_ABOUT_THE_NETWORK = (
    "rate", "stream", "power", "battery", "efficiency", "performance", "domain", "direct", "fair", "fairly", "same",
    "worst",
)  # fmt: skip


class OfflineRecogniser(Recogniser):
    """Recognises intents from words alone, in English and Chinese."""

    name = NAME

    def recognise(self, text: str, context: Context | None = None) -> Intent:
        """What the operator means; never raises, whatever the text."""
        del context
        own = _own_words()
        language = language_of(text[:_MAX_CHARACTERS])
        voice = Voice(language, _labels(own, language))
        if len(text) > _MAX_CHARACTERS:
            return _Answer(voice).ask("too_long")
        return _Understanding(text, own, voice).intent()


def recognise(text: str) -> Intent:
    """What the operator means, by the offline recogniser.

    >>> intent = recognise("Save power for sensors, 200 kbit/s each")
    >>> intent.objective, dict(intent.constraints)
    ('min_power', {'min_rate_bps': 200000.0})
    """
    return OfflineRecogniser().recognise(text)


class _Answer:
    """Intents in one operator's language."""

    def __init__(self, voice: Voice) -> None:
        self.voice = voice

    def ask(self, key: str, confidence: float = 0.5, **names: str) -> Intent:
        return self.tell("clarify", key, confidence, **names)

    def tell(self, kind: IntentKind, key: str, confidence: float, **names: str) -> Intent:
        return Intent(
            kind=kind, objective=None, constraints={}, language=self.voice.language, confidence=confidence, evidence={},
            reply=self.voice.say(key, **names), recogniser=NAME,
        )  # fmt: skip

    def allocate(self, objective: str, reading: Reading, words: str, confidence: float) -> Intent:
        dropped = reading.exact & {"max_rate_bps"} if objective == "min_power" else frozenset[str]()
        values = {name: reading.values[name] for name in CONSTRAINTS if name in reading.values and name not in dropped}
        evidence = {name: reading.evidence[name] for name in values}
        if words:
            evidence = {"objective": words} | evidence
        if reading.not_used:
            evidence["not_used"] = " … ".join(reading.not_used)
        return Intent(
            kind="allocate", objective=objective, constraints=values, language=self.voice.language, evidence=evidence,
            confidence=confidence, reply=self.voice.restated(objective, values, reading.not_used), recogniser=NAME,
        )  # fmt: skip


class _Understanding:
    """One sentence, read once: its figures, its terms, and what they amount to."""

    def __init__(self, text: str, own: tuple[OwnWords, ...], voice: Voice) -> None:
        self._text, self._own, self._voice, self._answer = text, own, voice, _Answer(voice)
        plain = normalise(text)
        quantities = parse_quantities(text)
        self._has_figures = bool(quantities)
        self._reading = read_constraints(text, plain, quantities)
        self._units: list[Unit] = units_of(plain, self._reading.masked)
        self._found: list[Found] = _vocabulary(own).find(self._units)
        self._concepts = {item.term.concept for item in self._found}
        read = [*self._reading.masked, *self._reading.counted, *self._named_spans()]
        self._unread = unread(plain, read)
        self._goal: Goal = goals.goal_of(self._found)

    def _named_spans(self) -> list[tuple[int, int]]:
        """Where the words of wishes stand, such as "P1"; "5G" is left to be told from "5G each"."""
        return [(item.start, item.end) for item in self._found if item.term.concept != "domain"]

    def intent(self) -> Intent:
        if not self._units:
            return self._answer.ask("empty", confidence=1.0)
        return self._not_a_request() or self._unfulfillable() or self._request()

    def _not_a_request(self) -> Intent | None:
        """Commands, questions and what has nothing to do with a cell."""
        signalled = self._goal.verdict in ("clear", "contradiction")
        first = self._found[0] if self._found else None
        leads = first is not None and first.first == 0
        about_network = bool(self._concepts & set(_ABOUT_THE_NETWORK)) or self._has_figures
        if "help" in self._concepts and not signalled:
            return self._answer.tell("question", "help", 0.9)
        if first is not None and leads and not first.corrected and self._commands(first, signalled):
            return self._answer.tell("command", "command", 0.85)
        if self._is_question(leads):
            if about_network:
                return self._answer.tell("question", "question", 0.8)
            if len(self._units) >= 3:
                return self._answer.tell("out_of_scope", "out_of_scope", 0.8)
        if "off_topic" in self._concepts and not signalled and not self._reading.values:
            return self._answer.tell("out_of_scope", "out_of_scope", 0.9)
        if "unsupported" in self._concepts and self._goal.verdict in ("none", "weak", "opposite"):
            return self._answer.tell("out_of_scope", "unsupported", 0.8, text=self._words_for("unsupported"))
        return None

    def _commands(self, first: Found, signalled: bool) -> bool:
        """Whether the sentence begins with a command about an earlier allocation, and names no wish of its own."""
        if first.term.concept == "undo":
            return self._goal.verdict in ("none", "weak")
        return first.term.concept == "command" and (not signalled or self._text_of(first).lower() in _COMPARE)

    def _is_question(self, leads: bool) -> bool:
        asked = [item for item in self._found if item.term.concept == "question"]
        if not asked or (leads and self._found[0].term.concept == "polite"):
            return False
        at_the_start = asked[0].first == 0 and not asked[0].corrected
        return at_the_start or self._voice.language == "zh"

    def _unfulfillable(self) -> Intent | None:
        """The first thing in the sentence that can't be done as said, put as a question."""
        if self._reading.doubts:
            doubt = self._reading.doubts[0]
            return self._answer.ask(doubt.key, 0.8, **doubt.names)
        if self._unread is not None:
            return self._answer.ask("unread", 0.8, text=self._text[slice(*self._unread)].strip())
        if "strange" in self._concepts:
            return self._answer.ask("strange", 0.8, text=self._words_for("strange"))
        if self._is_vaguely_fair():
            offered = [name for name in _FAIR_OBJECTIVES if name in self._voice.labels]
            if not offered:
                return self._answer.ask("unclear", 0.8)
            return self._answer.ask("fairness", 0.8, both=self._voice.both(offered, "or"))
        if "unsupported" in self._concepts and self._goal.verdict == "clear":
            goal = self._voice.label(self._goal.objective)
            return self._answer.ask("unsupported_with_goal", 0.8, text=self._words_for("unsupported"), goal=goal)
        exact_power = "max_power_w" in self._reading.exact and self._goal.objective == "min_power"
        if exact_power:
            return self._answer.ask("exact_power", 0.8, text=self._reading.evidence["max_power_w"])
        return None

    def _is_vaguely_fair(self) -> bool:
        """Whether something is to be equal or fair, and it is not said what or how."""
        settled = any(name in _FAIR_OBJECTIVES for name in self._goal.options)
        return "fair" in self._concepts or (bool(self._concepts & {"fairly", "same"}) and not settled)

    def _request(self) -> Intent:
        goal, ask = self._goal, self._answer.ask
        offered = [name for name in goal.options if name in self._voice.labels or goal.verdict == "opposite"]
        if _REFUSED.search(normalise(self._text)):
            return ask("negated")
        if goal.verdict == "clear" and goal.objective in self._voice.labels:
            words = " … ".join(self._text[start:end] for start, end in _merged(goal.spans))
            return self._answer.allocate(goal.objective, self._reading, words, goal.confidence)
        if goal.verdict == "contradiction" and len(offered) > 1:
            key = "contradiction" if set(offered) == {"max_rate", "min_power"} else "rivals"
            return ask(key, both=self._voice.both(offered))
        if goal.verdict == "negated":
            return ask("negated")
        if goal.verdict == "opposite":
            return ask("opposite", goal=self._voice.both([n for n in offered if n not in self._voice.labels]))
        return self._from_limits() or self._unclear()

    def _from_limits(self) -> Intent | None:
        """Limits without a wish: a promised rate under a power limit has one sensible reading, the others are asked."""
        values = self._reading.values
        if not values:
            return None
        no_other_wish = self._goal.verdict == "none" or self._goal.objective == "max_rate"
        if {"min_rate_bps", "max_power_w"} <= set(values) and no_other_wish and "max_rate" in self._voice.labels:
            return self._answer.allocate("max_rate", self._reading, "", _DEFAULT_CONFIDENCE)
        key = "rate_only" if "min_rate_bps" in values else "limits_only"
        return self._answer.ask(key, constraints=self._quoted(values))

    def _unclear(self) -> Intent:
        if self._goal.verdict == "weak" and self._goal.objective in self._voice.labels:
            guess = self._goal.objective
            others = self._voice.choices(without=guess)
            return self._answer.ask("weak", 0.6, goal=self._voice.label(guess), choices=others)
        return self._answer.ask("greeting" if "greeting" in self._concepts else "unclear")

    def _quoted(self, values: Mapping[str, float]) -> str:
        """The limits as the operator wrote them."""
        return self._voice.both([self._reading.evidence[name] for name in values])

    def _text_of(self, item: Found) -> str:
        return self._text[item.start : item.end]

    def _words_for(self, concept: str) -> str:
        return next(self._text_of(item) for item in self._found if item.term.concept == concept)


def _merged(spans: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Spans from left to right, those that overlap made one."""
    merged: list[tuple[int, int]] = []
    for start, end in sorted(spans):
        if merged and start < merged[-1][1]:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return merged


def _own_words() -> tuple[OwnWords, ...]:
    """The words of every objective that loads, the built-in ones first."""
    own: list[OwnWords] = []
    for found in plugins.plugins("objective"):
        if found.cls is None:
            continue
        cls = cast("type[Objective]", found.cls)
        spoken = tuple((language, tuple(words)) for language, words in cls.phrases.items())
        own.append(OwnWords(objective=found.name, names=(found.name, *cls.aliases), phrases=spoken))
    order = {name: place for place, name in enumerate(_BUILT_IN_ORDER)}
    return tuple(sorted(own, key=lambda words: (order.get(words.objective, len(order)), words.objective)))


def _labels(own: Sequence[OwnWords], language: str) -> dict[str, str]:
    """What to call each objective: its first phrase in the language, else in any, else its name."""
    labels: dict[str, str] = {}
    for words in own:
        phrases = dict(words.phrases)
        spoken = phrases.get(language) or phrases.get("en") or next(iter(phrases.values()), ())
        labels[words.objective] = spoken[0] if spoken else words.objective.replace("_", " ")
    return labels


@functools.lru_cache(maxsize=8)
def _vocabulary(own: tuple[OwnWords, ...]) -> Vocabulary:
    return Vocabulary(own)

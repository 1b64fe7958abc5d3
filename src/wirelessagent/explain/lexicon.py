"""Sentences by key in English and Chinese, as each kind of answer has them; other languages read English."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wirelessagent.explain.case import Case
from wirelessagent.explain.report import name_of_figure
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called


@dataclass(frozen=True)
class Lexicon:
    """The sentences of one kind of answer, with places for names and figures; both languages have the same ones."""

    english: Mapping[str, str]
    chinese: Mapping[str, str]

    def say(self, language: str, key: str, **names: object) -> str:
        """The sentence of this key in the operator's language."""
        return (self.chinese if language == "zh" else self.english)[key].format(**names)


WORDS = Lexicon(
    english={
        "power": "radiated power",
        "efficiency": "energy efficiency",
        "rate": "total rate",
        "value": "value",
        "comma": ", ",
        "one": "subcarrier {first}",
        "several": "subcarriers {first}–{last}",
        "outcome": "{figure} {value}",
        "outcome_power": "{figure} {value}, {power} radiated",
    },
    chinese={
        "power": "发射功率",
        "efficiency": "能效",
        "rate": "总速率",
        "value": "目标值",
        "comma": "、",
        "one": "第 {first} 个子载波",
        "several": "第 {first}–{last} 个子载波",
        "outcome": "{figure} {value}",
        "outcome_power": "{figure} {value}，发射 {power}",
    },
)


def value_name(case: Case, language: str) -> str:
    """What the value is called in a sentence, as in "total rate"."""
    named = name_of_figure(case.decision, language)
    if named or case.objective.measure != "utility":
        return named or WORDS.say(language, case.objective.measure)
    return WORDS.say(language, "rate" if case.objective.unit == "bit/s" else "value")


def listed(names: Sequence[str], language: str) -> str:
    """Users in a row."""
    return WORDS.say(language, "comma").join(called(language, name) for name in names)


def place(first: int, last: int, language: str) -> str:
    """Subcarriers as people count them, from 1."""
    return WORDS.say(language, "one" if first == last else "several", first=first + 1, last=last + 1)


def outcome_in_words(case: Case, decision: Decision, language: str) -> str:
    """What a decision is worth and takes."""
    key = "outcome" if case.objective.measure == "power" else "outcome_power"
    value, power = human(decision.value, decision.unit), human(decision.total_power_w, "W")
    return WORDS.say(language, key, figure=value_name(case, language), value=value, power=power)


def paragraph(said: Sequence[str], language: str) -> str:
    """Sentences one after the other."""
    return ("" if language == "zh" else " ").join(one for one in said if one)

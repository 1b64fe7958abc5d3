"""Sentences by key in English and Chinese, as each kind of answer has them; other languages read English."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.report import name_of_figure
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human


@dataclass(frozen=True)
class Lexicon:
    """The sentences of one kind of answer, with places for names and figures; both languages have the same ones."""

    english: Mapping[str, str]
    chinese: Mapping[str, str]

    def say(self, language: str, key: str, **names: object) -> str:
        """The sentence of this key in the operator's language."""
        return (self.chinese if language == "zh" else self.english)[key].format(**names)


_MOST_TOLD_W = 1e12
"""Powers beyond this are told as that much at least."""

WORDS = Lexicon(
    english={
        "power": "radiated power",
        "efficiency": "energy efficiency",
        "rate": "total rate",
        "weighted": "weighted total rate",
        "value": "value",
        "comma": ", ",
        "one": "subcarrier {first}",
        "several": "subcarriers {first}–{last}",
        "outcome": "{figure} {value}",
        "outcome_power": "{figure} {value}, {power} radiated",
        "needs": "the promised rates need at least {least}, more than the {budget} allowed",
        "needs_found": "the promised rates need at least {least}, more than the {budget} allowed, and an "
        "allocation with {most} was found",
    },
    chinese={
        "power": "发射功率",
        "efficiency": "能效",
        "rate": "总速率",
        "weighted": "加权总速率",
        "value": "目标值",
        "comma": "、",
        "one": "子载波 {first}",
        "several": "子载波 {first}–{last}",
        "outcome": "{figure} {value}",
        "outcome_power": "{figure} {value}，发射 {power}",
        "needs": "承诺的速率至少需要 {least}，超过允许的 {budget}",
        "needs_found": "承诺的速率至少需要 {least}，超过允许的 {budget}；已找到一个用 {most} 的分配",
    },
)


def value_name(case: Case, language: str) -> str:
    """What the value is called in a sentence, as in "total rate"."""
    named = name_of_figure(case.decision, language)
    if named:
        return named
    if case.objective.measure != "utility":
        return WORDS.say(language, case.objective.measure)
    if case.objective.unit != "bit/s":
        return WORDS.say(language, "value")
    return WORDS.say(language, "rate" if case.problem.weights is None else "weighted")


def listed(names: Sequence[str], language: str) -> str:
    """Names in a row."""
    return WORDS.say(language, "comma").join(names)


def place(first: int, last: int, language: str) -> str:
    """Subcarriers as people count them, from 1."""
    return WORDS.say(language, "one" if first == last else "several", first=first + 1, last=last + 1)


def outcome_in_words(case: Case, decision: Decision, language: str) -> str:
    """What a decision is worth and takes."""
    key = "outcome" if case.objective.measure == "power" else "outcome_power"
    value, power = human(decision.value, decision.unit), human(decision.total_power_w, "W")
    return WORDS.say(language, key, figure=value_name(case, language), value=value, power=power)


def reason_in_words(decision: Decision, language: str) -> str:
    """Why nothing was found: what the promised rates need where that is proven too much, else the decision's reason."""
    need, budget = decision.needed_power_w, decision.problem.budget_w(decision.cell)
    if need is None or not budget < need.at_least < np.inf:
        return decision.reason
    least, most = (human(min(one, _MOST_TOLD_W), "W") for one in (need.at_least, need.at_most))
    key = "needs_found" if need.at_most <= _MOST_TOLD_W else "needs"
    return WORDS.say(language, key, least=least, most=most, budget=human(budget, "W"))


def paragraph(said: Sequence[str], language: str) -> str:
    """Sentences one after the other."""
    return ("" if language == "zh" else " ").join(one for one in said if one)

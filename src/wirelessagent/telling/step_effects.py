"""Finite steps in words, beside what the marginal price makes of them."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.reach import Reach
from wirelessagent.telling.facts.steps import Step
from wirelessagent.telling.parts import outcome_in_words, value_name
from wirelessagent.telling.reasons import reason_in_words

_NOTHING = 1e-9


def step_answer(case: Case, step: Step, kept: Reach | None, language: str) -> str:
    """What a step changes, and what power would keep the value, in a paragraph."""
    before, after = step.before, step.after
    said: list[str] = []
    if not (before.is_usable and after.is_usable):
        said.append(_unmet(case, step, language))
    elif step.of_power:
        said.append(_power(case, step, language))
    else:
        change = change_in_words(case, step, language)
        said.append(message(language, "step.rate", who=_who(case, step, language), level=_level(step), change=change))
    if before.is_usable and after.is_usable:
        budget = case.problem.budget_w(case.cell)
        said += [] if kept is None else [_reached(case, kept, "step.kept", language, before_w=budget)]
        said += _marginal(step, language)
        said += _bound(case, step, language)
    if after.is_usable and not np.isnan(step.limit_w):
        said.append(message(language, "step.limit", limit=human(step.limit_w, "W")))
    return joined(language, said)


def reach_answer(case: Case, found: Reach | None, now: float, step: float, spent_w: float, language: str) -> str:
    """What power it takes that a value is larger by ``step``, or what a smaller one saves; None if nothing is left."""
    unit, figure = case.decision.unit, value_name(case, language)
    more = message(language, "step.rate_more" if step > 0 else "step.rate_less", step=human(abs(step), unit))
    if found is None:
        return message(language, "step.nothing_left", step=more, figure=figure, before=human(now, unit))
    return _reached(case, found, "step.reached", language, before_w=spent_w, step=more)


def _reached(case: Case, found: Reach, key: str, language: str, *, before_w: float, step: str = "") -> str:
    figure, target = value_name(case, language), human(found.target, case.decision.unit)
    if np.isnan(found.power_w):
        out = "step.out_of_reach" if step else "step.not_kept"
        return message(language, out, figure=figure, target=target, step=step, power=human(found.tried_w, "W"))
    more = found.power_w - before_w
    said = message(
        language, key, figure=figure, target=target, step=step, power=human(found.power_w, "W"),
        before=human(before_w, "W"), size=human(abs(more), "W"), share=percent(abs(more) / before_w),
        way=message(language, "step.more" if more >= 0 else "step.less"),
    )  # fmt: skip
    beyond = [] if np.isnan(found.limit_w) else [message(language, "step.limit", limit=human(found.limit_w, "W"))]
    return joined(language, [said, *beyond])


def no_power_answer(case: Case, step_w: float, language: str) -> str:
    """What there is to say of a step that leaves no power."""
    budget = human(case.problem.budget_w(case.cell), "W")
    return message(language, "step.no_power", step=human(-step_w, "W"), before=budget)


def change_in_words(case: Case, step: Step, language: str) -> str:
    """How the value changes, as in "raise the total rate by 1 Mbit/s (3 %), to 34 Mbit/s"."""
    figure, change, before = value_name(case, language), step.change, step.before.value
    value = human(step.value_after, step.before.unit)
    if abs(change) <= _NOTHING * abs(before):
        return message(language, "step.keep", figure=figure, value=value)
    share = message(language, "step.share", share=percent(abs(change / before))) if before else ""
    size = human(abs(change), step.before.unit)
    return message(
        language, "step.raise" if change > 0 else "step.lower", figure=figure, size=size, share=share, value=value
    )


def _power(case: Case, step: Step, language: str) -> str:
    level, before = human(step.level, "W"), human(case.problem.budget_w(case.cell), "W")
    if abs(step.change) <= _NOTHING * abs(step.before.value) and not case.spends_all:
        key = "step.power_least" if case.objective.measure == "power" else "step.power_idle"
        spent = human(step.before.total_power_w, "W")
        return message(language, key, level=level, before=before, spent=spent)
    return message(
        language, "step.power", level=level, before=before, change=change_in_words(case, step, language)
    )  # fmt: skip


def _unmet(case: Case, step: Step, language: str) -> str:
    kind = "step.of_power" if step.of_power else "step.of_rate"
    told = message(language, kind, level=_level(step), who=_who(case, step, language))
    if step.before.is_usable:
        return message(language, "step.no_longer", step=told, reason=reason_in_words(step.after, language))
    if not step.after.is_usable:
        return message(language, "step.still_not", step=told, reason=reason_in_words(step.after, language))
    return message(language, "step.now_met", step=told, outcome=outcome_in_words(case, step.after, language))


def _marginal(step: Step, language: str) -> list[str]:
    if np.isnan(step.marginal) or abs(step.change) <= _NOTHING * abs(step.before.value):
        return []
    key = "step.marginal_power" if step.of_power else "step.marginal_rate"
    return [message(language, key, size=human(abs(step.marginal), step.before.unit))]


def _bound(case: Case, step: Step, language: str) -> list[str]:
    """What no allocation could do better, where the decision after the step is not proven optimal."""
    sign = 1.0 if case.objective.direction == "max" else -1.0
    most = sign * step.most_change
    worse = sign * step.change < 0
    if step.after.status == "optimal" or worse or not np.isfinite(most) or most <= 0:
        return []
    direction = message(language, "step.up" if sign > 0 else "step.down")
    return [message(language, "step.bound", direction=direction, size=human(most, step.before.unit))]


def _level(step: Step) -> str:
    return human(step.level, "W" if step.of_power else "bit/s")


def _who(case: Case, step: Step, language: str) -> str:
    if step.user is not None:
        return called(language, case.estimate.user_names[step.user])
    spread = np.ptp(case.promised_bps[case.served]) > 0
    return message(language, "step.everybody_more" if spread else "step.everybody", step=human(step.step, "bit/s"))

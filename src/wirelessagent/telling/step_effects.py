"""Finite steps in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.steps import (
    Reach,
    Step,
    for_the_total,
    has_reach,
    kept_by,
    power_step,
    rate_step,
    reach,
)  # fmt: skip
from wirelessagent.telling.parts import outcome_in_words, value_name
from wirelessagent.telling.reasons import reason_in_words

_NOTHING = 1e-9


def more_answer(
    case: Case,
    language: str,
    *,
    power_w: float | None = None,
    rate_bps: float | None = None,
    rate_share: float | None = None,
    each: bool = False,
    user: int | None = None,
) -> str:
    """What more power (1 W if nothing is named) or more rate would change; less where a figure is below zero.

    Args:
        case: the decision asked about.
        language: the operator's.
        power_w: how much more power.
        rate_bps: how much more rate: of ``user``, of ``each`` user, else of the value or in all.
        rate_share: how much more rate, as a share.
        each: whether the rate is every user's.
        user: whose the rate is, from 0.
    """
    if rate_share is not None or (rate_bps is not None and user is None and not each):
        return _more_rate(case, language, rate_bps, rate_share)
    if rate_bps is not None:
        return _stepped(case, rate_step(case, rate_bps, user), language)
    step_w = 1.0 if power_w is None else power_w
    step = power_step(case, step_w)
    if step is not None:
        return _stepped(case, step, language)
    budget = human(case.problem.budget_w(case.cell), "W")
    return message(language, "step.no_power", step=human(-step_w, "W"), before=budget)


def _more_rate(case: Case, language: str, rate_bps: float | None, share: float | None) -> str:
    """What more rate takes where nobody says whose: of the value where that is one, else of the promises and in all."""

    def step_of(whole: float) -> float:
        return (rate_bps or 0.0) if share is None else share * whole

    now, promised, usable = case.decision.value, float(case.promised_bps.max()), case.decision.is_usable
    if has_reach(case):
        return _more(case, now, step_of(now), case.problem.budget_w(case.cell), language)
    total = float(case.decision.rate_bps.sum()) if usable else 0.0
    said: list[str] = []
    if promised > 0 or not usable:
        said.append(_stepped(case, rate_step(case, step_of(promised)), language))
    if total > 0:
        said.append(_more(for_the_total(case), total, step_of(total), case.decision.total_power_w, language))
    return joined(language, said)


def _stepped(case: Case, step: Step, language: str) -> str:
    usable = step.before.is_usable and step.after.is_usable
    return step_answer(case, step, kept_by(case, step) if usable else None, language)


def step_answer(case: Case, step: Step, kept: Reach | None, language: str) -> str:
    """What a step changes, and what power would keep the value, in a paragraph."""
    said: list[str] = []
    if not (step.before.is_usable and step.after.is_usable):
        said.append(_unmet(case, step, language))
    else:
        if step.of_power:
            said.append(_power(case, step, language))
        else:
            change, who = change_in_words(case, step, language), _who(case, step, language)
            said.append(message(language, "step.rate", who=who, level=_level(step), change=change))
        budget = case.problem.budget_w(case.cell)
        said += [] if kept is None else [_reached(case, kept, "step.kept", language, before_w=budget)]
        said += _bound(case, step, language)
    if step.after.is_usable and not np.isnan(step.limit_w):
        said.append(message(language, "step.limit", limit=human(step.limit_w, "W")))
    return joined(language, said)


def _more(case: Case, now: float, step: float, spent_w: float, language: str) -> str:
    """What power it takes that a value is larger by ``step``, or what a smaller one saves."""
    unit, figure = case.decision.unit, value_name(case.decision, language)
    more = message(language, "step.rate_more" if step > 0 else "step.rate_less", step=human(abs(step), unit))
    if not now + step > 0:
        return message(language, "step.nothing_left", step=more, figure=figure, before=human(now, unit))
    return _reached(case, reach(case, now + step), "step.reached", language, before_w=spent_w, step=more)


def _reached(case: Case, found: Reach, key: str, language: str, *, before_w: float, step: str = "") -> str:
    figure, target = value_name(case.decision, language), human(found.target, case.decision.unit)
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


def change_in_words(case: Case, step: Step, language: str) -> str:
    """How the value changes, as in "raise the total rate by 1 Mbit/s (3 %), to 34 Mbit/s"."""
    figure, change, before = value_name(case.decision, language), step.change, step.before.value
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
    return message(language, "step.now_met", step=told, outcome=outcome_in_words(step.after, language))


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

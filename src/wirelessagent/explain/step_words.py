"""Finite steps in words, beside what the marginal price makes of them."""

from __future__ import annotations

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, outcome_in_words, paragraph, value_name
from wirelessagent.explain.prices import marginal_prices
from wirelessagent.explain.reaching import Reach, for_the_total, has_reach, reach
from wirelessagent.explain.reasons import reason_in_words
from wirelessagent.explain.steps import Step
from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called

_NOTHING = 1e-9

WORDS = Lexicon(
    english={
        "power": "A budget of {level} instead of {before}, solved anew, would {change}.",
        "power_idle": "With {level} instead of {before} nothing changes: only {spent} is used as it is.",
        "power_least": "With {level} instead of {before} nothing changes: the rates asked for take {spent} either way.",
        "rate": "Promising {who} {level}, solved anew, would {change}.",
        "everybody": "every user",
        "everybody_more": "every user {step} more, at least",
        "raise": "raise the {figure} by {size}{share}, to {value}",
        "lower": "lower the {figure} by {size}{share}, to {value}",
        "keep": "leave the {figure} as it is, at {value}",
        "share": " ({share})",
        "marginal_power": "At the marginal price it would be {size}: prices hold for small steps.",
        "marginal_rate": "At the marginal price it would be {size}: prices hold for small steps, and users' sets "
        "change by whole subcarriers.",
        "bound": "No allocation can {direction} it by more than {size}: that is proven.",
        "limit": "That is beyond the cell's limit of {limit}, which would have to be raised first.",
        "no_longer": "With {step}, the request can no longer be met: {reason}.",
        "now_met": "The request cannot be met now; with {step} it can: {outcome}.",
        "still_not": "The request cannot be met now, nor with {step}: {reason}.",
        "no_power": "{step} less leaves no power at all: the budget is {before}.",
        "of_power": "a budget of {level}",
        "of_rate": "{level} promised to {who}",
        "up": "raise",
        "down": "lower",
        "reached": "A {figure} of {target}, {step}, would take {power} instead of {before}: {size} {way} ({share}).",
        "kept": "To keep the {figure} at {target} all the same, it would take {power} instead of {before}: {size} "
        "{way} ({share}).",
        "out_of_reach": "A {figure} of {target}, {step}, is out of reach: not even {power} would do.",
        "nothing_left": "{step} leaves nothing of the {figure}, which is {before}.",
        "rate_more": "{step} more",
        "rate_less": "{step} less",
        "more": "more",
        "less": "less",
    },
    chinese={
        "power": "功率由 {before} 改为 {level}，重新求解，{change}。",
        "power_idle": "功率由 {before} 改为 {level} 不会有任何变化：现在只用了 {spent}。",
        "power_least": "功率由 {before} 改为 {level} 不会有任何变化：所要求的速率本来就只需 {spent}。",
        "rate": "向{who}承诺 {level}，重新求解，{change}。",
        "everybody": "每个用户",
        "everybody_more": "每个用户多 {step}，至少",
        "raise": "{figure}提高 {size}{share}，达到 {value}",
        "lower": "{figure}降低 {size}{share}，为 {value}",
        "keep": "{figure}保持 {value} 不变",
        "share": "（{share}）",
        "marginal_power": "按边际价格应为 {size}：价格只适用于微小变化。",
        "marginal_rate": "按边际价格应为 {size}：价格只适用于微小变化，而子载波只能整个改变。",
        "bound": "任何分配都不能使其{direction}超过 {size}：这已被证明。",
        "limit": "这超出小区上限 {limit}，须先提高该上限。",
        "no_longer": "若{step}，要求就无法满足：{reason}。",
        "now_met": "现在要求无法满足；若{step}则可以：{outcome}。",
        "still_not": "现在要求无法满足，若{step}也不行：{reason}。",
        "no_power": "减少 {step} 就没有功率了：预算为 {before}。",
        "of_power": "预算为 {level}",
        "of_rate": "向{who}承诺 {level}",
        "up": "提高",
        "down": "降低",
        "reached": "{figure}达到 {target}（{step}）需要 {power}，而不是 {before}：{way} {size}（{share}）。",
        "kept": "若要{figure}仍为 {target}，则需要 {power}，而不是 {before}：{way} {size}（{share}）。",
        "out_of_reach": "{figure}无法达到 {target}（{step}）：即使 {power} 也不够。",
        "nothing_left": "{figure}现为 {before}，{step}就什么也不剩了。",
        "rate_more": "多 {step}",
        "rate_less": "少 {step}",
        "more": "多",
        "less": "少",
    },
)


def step_answer(case: Case, step: Step, language: str) -> str:
    """What a step changes, in a paragraph."""
    before, after = step.before, step.after
    said: list[str] = []
    if not (before.is_usable and after.is_usable):
        said.append(_unmet(case, step, language))
    elif step.of_power:
        said.append(_power(case, step, language))
    else:
        change = change_in_words(case, step, language)
        said.append(WORDS.say(language, "rate", who=_who(case, step, language), level=_level(step), change=change))
    if before.is_usable and after.is_usable:
        said += _kept(case, step, language)
        said += _marginal(step, language)
        said += _bound(case, step, language)
    if after.is_usable and not np.isnan(step.limit_w):
        said.append(WORDS.say(language, "limit", limit=human(step.limit_w, "W")))
    return paragraph(said, language)


def reach_answer(case: Case, step: float, language: str) -> str:
    """What power it takes that the value is larger by ``step``, or what a smaller one saves."""
    return _reach(case, case.decision.value, step, case.problem.budget_w(case.cell), language)


def total_answer(case: Case, step_bps: float, language: str) -> str:
    """What power a total rate takes that is larger by ``step_bps``, whatever the aim is."""
    now, spent = float(case.decision.rate_bps.sum()), case.decision.total_power_w
    return _reach(for_the_total(case), now, step_bps, spent, language)


def _reach(case: Case, now: float, step: float, spent_w: float, language: str) -> str:
    unit, figure = case.decision.unit, value_name(case, language)
    more = WORDS.say(language, "rate_more" if step > 0 else "rate_less", step=human(abs(step), unit))
    if not now + step > 0:
        return WORDS.say(language, "nothing_left", step=more, figure=figure, before=human(now, unit))
    return _reached(case, reach(case, now + step), "reached", language, before_w=spent_w, step=more)


def _reached(case: Case, found: Reach, key: str, language: str, *, before_w: float, step: str = "") -> str:
    figure, target = value_name(case, language), human(found.target, case.decision.unit)
    if np.isnan(found.power_w):
        return WORDS.say(
            language, "out_of_reach", figure=figure, target=target, step=step, power=human(found.tried_w, "W")
        )
    more = found.power_w - before_w
    said = WORDS.say(
        language, key, figure=figure, target=target, step=step, power=human(found.power_w, "W"),
        before=human(before_w, "W"), size=human(abs(more), "W"), share=percent(abs(more) / before_w),
        way=WORDS.say(language, "more" if more >= 0 else "less"),
    )  # fmt: skip
    beyond = [] if np.isnan(found.limit_w) else [WORDS.say(language, "limit", limit=human(found.limit_w, "W"))]
    return paragraph([said, *beyond], language)


def _kept(case: Case, step: Step, language: str) -> list[str]:
    """What power would keep the value where it was in spite of what more is promised."""
    if step.of_power or not has_reach(case) or step.change >= -_NOTHING * abs(step.before.value):
        return []
    found = reach(case, step.before.value, step.problem)
    return (
        []
        if np.isnan(found.power_w)
        else [_reached(case, found, "kept", language, before_w=case.problem.budget_w(case.cell))]
    )


def no_power_answer(case: Case, step_w: float, language: str) -> str:
    """What there is to say of a step that leaves no power."""
    budget = human(case.problem.budget_w(case.cell), "W")
    return WORDS.say(language, "no_power", step=human(-step_w, "W"), before=budget)


def change_in_words(case: Case, step: Step, language: str) -> str:
    """How the value changes, as in "raise the total rate by 1 Mbit/s (3 %), to 34 Mbit/s"."""
    figure, change, before = value_name(case, language), step.change, step.before.value
    value = human(step.value_after, step.before.unit)
    if abs(change) <= _NOTHING * abs(before):
        return WORDS.say(language, "keep", figure=figure, value=value)
    share = WORDS.say(language, "share", share=percent(abs(change / before))) if before else ""
    size = human(abs(change), step.before.unit)
    return WORDS.say(language, "raise" if change > 0 else "lower", figure=figure, size=size, share=share, value=value)


def _power(case: Case, step: Step, language: str) -> str:
    level, before = human(step.level, "W"), human(case.problem.budget_w(case.cell), "W")
    if abs(step.change) <= _NOTHING * abs(step.before.value) and not marginal_prices(case).binds:
        key = "power_least" if case.objective.measure == "power" else "power_idle"
        spent = human(step.before.total_power_w, "W")
        return WORDS.say(language, key, level=level, before=before, spent=spent)
    return WORDS.say(
        language, "power", level=level, before=before, change=change_in_words(case, step, language)
    )  # fmt: skip


def _unmet(case: Case, step: Step, language: str) -> str:
    kind = "of_power" if step.of_power else "of_rate"
    told = WORDS.say(language, kind, level=_level(step), who=_who(case, step, language))
    if step.before.is_usable:
        return WORDS.say(language, "no_longer", step=told, reason=reason_in_words(step.after, language))
    if not step.after.is_usable:
        return WORDS.say(language, "still_not", step=told, reason=reason_in_words(step.after, language))
    return WORDS.say(language, "now_met", step=told, outcome=outcome_in_words(case, step.after, language))


def _marginal(step: Step, language: str) -> list[str]:
    if np.isnan(step.marginal) or abs(step.change) <= _NOTHING * abs(step.before.value):
        return []
    key = "marginal_power" if step.of_power else "marginal_rate"
    return [WORDS.say(language, key, size=human(abs(step.marginal), step.before.unit))]


def _bound(case: Case, step: Step, language: str) -> list[str]:
    """What no allocation could do better, where the decision after the step is not proven optimal."""
    sign = 1.0 if case.objective.direction == "max" else -1.0
    most = sign * step.most_change
    worse = sign * step.change < 0
    if step.after.status == "optimal" or worse or not np.isfinite(most) or most <= 0:
        return []
    direction = WORDS.say(language, "up" if sign > 0 else "down")
    return [WORDS.say(language, "bound", direction=direction, size=human(most, step.before.unit))]


def _level(step: Step) -> str:
    return human(step.level, "W" if step.of_power else "bit/s")


def _who(case: Case, step: Step, language: str) -> str:
    if step.user is not None:
        return called(language, case.estimate.user_names[step.user])
    spread = np.ptp(case.promised_bps[case.served]) > 0
    return WORDS.say(language, "everybody_more" if spread else "everybody", step=human(step.step, "bit/s"))

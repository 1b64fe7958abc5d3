"""What holds a decision back: the budget, the dearest promise, caps on users' rates, and who takes the most power."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, listed, paragraph, value_name
from wirelessagent.explain.prices import marginal_prices
from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called

_AT_THE_CAP = 1e-6
_WORTH_TELLING = 1e-3
_STEP_BPS = 100e3

WORDS = Lexicon(
    english={
        "caps": "The most that {names} may get holds the {figure} at {value}: without it, it would be {free}.",
        "caps_idle": "{names} may get no more, but without that the {figure} would stay at {value}.",
        "power": "All of the {budget} is used: one more watt would raise the {figure} by {price} at the margin.",
        "power_free": "Power does not: {spent} of {budget} is used.",
        "promise": "Of the promises that to {name} costs most: {price} of the {figure} for 100 kbit/s more.",
        "most_power": "{name} takes the most power: {power} ({share}) for {rate}.",
        "nothing": "Nothing but the channel and the aim does.",
    },
    chinese={
        "caps": "{names}的速率上限使{figure}停在 {value}：没有该上限则为 {free}。",
        "caps_idle": "{names}已达速率上限，但没有该上限{figure}仍为 {value}。",
        "power": "{budget} 的功率已用完：边际上再多一瓦，{figure}提高 {price}。",
        "power_free": "不是功率：{budget} 中用了 {spent}。",
        "promise": "承诺中以{name}的最贵：再多 100 kbit/s，{figure}的代价为 {price}。",
        "most_power": "{name}占用的功率最多：{power}（{share}），速率 {rate}。",
        "nothing": "除信道和目标外没有别的限制。",
    },
)


def limits_answer(case: Case, language: str) -> str:
    """What holds the value back, each with what it would be worth to have more of it."""
    said = [*_caps(case, language), *_power(case, language), *_promise(case, language), *_most_power(case, language)]
    return paragraph(said or [WORDS.say(language, "nothing")], language)


def _caps(case: Case, language: str) -> list[str]:
    """Who has all that it may have, and what the value would be if it might have more, solved anew."""
    decision, most = case.decision, case.problem.max_rates_bps(case.num_users)
    full = np.flatnonzero(case.served & np.isfinite(most) & (decision.rate_bps >= most * (1 - _AT_THE_CAP)))
    if not full.size:
        return []
    without = most.copy()
    without[full] = np.inf
    limited = bool(np.isfinite(without).any())
    free = case.otherwise(dataclasses.replace(case.problem, max_rate_bps=without if limited else None))
    names = listed([case.estimate.user_names[int(user)] for user in full], language)
    told = {"names": names, "figure": value_name(case, language), "value": human(decision.value, decision.unit)}
    gained = abs(free.value - decision.value) > _WORTH_TELLING * abs(decision.value)
    if not free.is_usable or not gained:
        return [WORDS.say(language, "caps_idle", **told)]
    return [WORDS.say(language, "caps", **told, free=human(free.value, decision.unit))]


def _power(case: Case, language: str) -> list[str]:
    if case.objective.measure == "power":
        return []
    prices, budget = marginal_prices(case), human(case.problem.budget_w(case.cell), "W")
    if prices.binds and prices.power > 0:
        price = human(prices.power, case.decision.unit)
        return [WORDS.say(language, "power", budget=budget, figure=value_name(case, language), price=price)]
    return [WORDS.say(language, "power_free", budget=budget, spent=human(case.decision.total_power_w, "W"))]


def _promise(case: Case, language: str) -> list[str]:
    cost = np.nan_to_num(np.abs(np.where(case.promised_bps > 0, marginal_prices(case).rate, 0.0)))
    if not cost.any():
        return []
    dearest = int(cost.argmax())
    return [
        WORDS.say(
            language, "promise", name=called(language, case.estimate.user_names[dearest]),
            figure=value_name(case, language), price=human(float(cost[dearest]) * _STEP_BPS, case.decision.unit),
        )
    ]  # fmt: skip


def _most_power(case: Case, language: str) -> list[str]:
    decision = case.decision
    used = decision.power_w > 0
    spent = np.bincount(decision.owner[used], weights=decision.power_w[used], minlength=case.num_users)
    if np.count_nonzero(spent) < 2:
        return []
    user = int(spent.argmax())
    return [
        WORDS.say(
            language, "most_power", name=called(language, case.estimate.user_names[user]),
            power=human(float(spent[user]), "W"), share=percent(float(spent[user] / spent.sum())),
            rate=human(float(case.rate_bps[user]), "bit/s"),
        )
    ]  # fmt: skip

"""Prices in words: of power and of promises, and what holds a decision back."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called, joined, listed, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.marginal_prices import MarginalPrices, marginal_prices
from wirelessagent.telling.facts.steps import WithoutCeilings, without_ceilings
from wirelessagent.telling.parts import value_name
from wirelessagent.telling.text_table import Table

_STEP_BPS = 100e3
_WORTH_TELLING = 1e-3


def prices_answer(case: Case, prices: MarginalPrices, language: str) -> str:
    """The prices of power and of the dearest promise."""
    figure = value_name(case.decision, language)
    said = [_power_price(case, prices, figure, language)]
    dearest = _dearest(case, prices)
    if dearest is not None:
        user, price = dearest
        direction = message(language, "step.up" if prices.rate[user] > 0 else "step.down")
        name = called(language, case.estimate.user_names[user])
        said.append(message(language, "price.dearest", user=name, direction=direction, figure=figure, price=price))
    elif case.promised_bps.any():
        said.append(message(language, "price.free"))
    if case.objective.measure != "power" and prices.power > 0:
        said.append(message(language, "price.slopes"))
    return joined(language, said)


def _dearest(case: Case, prices: MarginalPrices) -> tuple[int, str] | None:
    """Whose promise costs most, and what 100 kbit/s more of it would cost; None where none costs anything."""
    cost = np.nan_to_num(np.abs(np.where(case.promised_bps > 0, prices.rate, 0.0)))
    user = int(cost.argmax())
    return (user, human(float(cost[user]) * _STEP_BPS, case.decision.unit)) if cost[user] > 0 else None


def _power_price(case: Case, prices: MarginalPrices, figure: str, language: str) -> str:
    budget, spent = human(case.problem.budget_w(case.cell), "W"), human(case.decision.total_power_w, "W")
    if case.objective.measure == "power":
        return message(language, "price.power_least")
    if np.isnan(prices.power):
        return message(language, "price.power_unknown")
    if prices.power > 0 and prices.binds:
        price = human(prices.power, case.decision.unit)
        return message(language, "price.power", figure=figure, price=price, budget=budget)
    return message(language, "price.power_idle", spent=spent, budget=budget)


def prices_table(case: Case, prices: MarginalPrices, language: str) -> Table | None:
    """What 100 kbit/s more would cost for each user with a promise; None where nobody has one."""
    users = np.flatnonzero(case.promised_bps > 0)
    if not users.size:
        return None
    rate, unit = prices.rate, case.decision.unit
    rows = tuple(
        (
            called(language, case.estimate.user_names[user]),
            human(float(case.promised_bps[user]), "bit/s"),
            human(float(case.decision.rate_bps[user]), "bit/s"),
            human(float(rate[user]) * _STEP_BPS, unit),
        )
        for user in users.tolist()
    )
    heads = ("label.user", "price.promised", "price.gets", "price.price")
    columns = tuple(message(language, key) for key in heads)
    return Table(title=message(language, "price.promises"), columns=columns, rows=rows)


def limits_answer(case: Case, language: str) -> str:
    """What holds the value back, each with what it would be worth to have more of it."""
    prices, ceilings = marginal_prices(case), without_ceilings(case)
    said = [*_caps(case, ceilings, language), *_power_held(case, prices, language), *_promise(case, prices, language)]
    return joined(language, [*said, *_most_power(case, language)] or [message(language, "hindrance.nothing")])


def _caps(case: Case, found: WithoutCeilings | None, language: str) -> list[str]:
    """Who has all that it may have, and what the value would be if it might have more, solved anew."""
    if found is None:
        return []
    decision, free = case.decision, found.decision
    names, figure = listed(language, case.named(found.users)), value_name(case.decision, language)
    gained = abs(free.value - decision.value) > _WORTH_TELLING * abs(decision.value)
    told = {"names": names, "figure": figure, "value": human(decision.value, decision.unit)}
    if not free.is_usable or not gained:
        return [message(language, "hindrance.caps_idle", **told)]
    return [message(language, "hindrance.caps", **told, free=human(free.value, decision.unit))]


def _power_held(case: Case, prices: MarginalPrices, language: str) -> list[str]:
    if case.objective.measure == "power":
        return []
    budget = human(case.problem.budget_w(case.cell), "W")
    if prices.binds and prices.power > 0:
        price, figure = human(prices.power, case.decision.unit), value_name(case.decision, language)
        return [message(language, "hindrance.power", budget=budget, figure=figure, price=price)]
    return [message(language, "hindrance.power_free", budget=budget, spent=human(case.decision.total_power_w, "W"))]


def _promise(case: Case, prices: MarginalPrices, language: str) -> list[str]:
    dearest = _dearest(case, prices)
    if dearest is None:
        return []
    name, figure = case.estimate.user_names[dearest[0]], value_name(case.decision, language)
    return [message(language, "hindrance.promise", name=name, figure=figure, price=dearest[1])]


def _most_power(case: Case, language: str) -> list[str]:
    spent = case.spent_w
    if np.count_nonzero(spent) < 2:
        return []
    user = int(spent.argmax())
    return [
        message(
            language, "hindrance.most_power", name=called(language, case.estimate.user_names[user]),
            power=human(float(spent[user]), "W"), share=percent(float(spent[user] / spent.sum())),
            rate=human(float(case.rate_bps[user]), "bit/s"),
        )
    ]  # fmt: skip

"""The true optimum: every set that an optimal allocation may hold, listed by its reduced cost, and the best choice.

At column prices of bound D, an allocation worth L in a market holds no set that is worth more than D − L less than its
user's best (its reduced cost), since all the others together are worth at most what D says. So:

1. an allocation (given, improved by the sets that column generation has met) and column prices for its own level;
2. all sets whose reduced cost is within D − L, by branch and bound;
3. the best choice among them, which is the optimum. Where it reaches a higher level it is the next allocation of 3: the
   list holds for that as well, because what reaches a higher level reaches this one too.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.column_prices import ColumnPrices, column_prices, priced_bounds
from wirelessagent.deciding.core.goals import Goal
from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.set_packing import pack
from wirelessagent.model.arrays import FloatArray

_ROUNDING = 1e-9
"""Of the worth at stake, by which the limit on reduced costs is widened."""
_ACCURACY = 1e-10
_PRICE_ACCURACY = 1e-6
_ROUNDS = 30
_NODES = 30_000_000
_SHARE = 0.5
"""Of the time that is left, for each attempt at a better allocation before sets are listed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Exact:
    """What the search found.

    Attributes:
        sets: one for each user.
        x: the level that they reach (:mod:`.goals`).
        log_mu: ln μ there.
        bound: no allocation reaches more.
        price: π of the columns, in the market at x, shape (column,).
        listed: how many sets were listed.
        complete: whether these were all.
    """

    sets: Sets
    x: float
    log_mu: float
    bound: float
    price: FloatArray
    listed: int
    complete: bool


def search(
    goal: Goal, known: Sets, price: FloatArray, log_mu: float, *, deadline: float, most_sets: int
) -> Exact:
    """The best allocation from a ``known`` one that keeps every limit, and prices π and ln μ to start from."""
    x, own = goal.reached(known, log_mu)
    known, x, own, priced, market = _improved(goal, known, x, own, price, log_mu, deadline)
    gap = priced.bound - goal.target(x)
    scale = _scale(market, priced)
    found = Exact(
        sets=known, x=x, log_mu=own, bound=np.inf, price=priced.price, listed=len(priced.sets), complete=False
    )
    if gap <= _ACCURACY * scale:
        return _with(found, bound=x, complete=True)
    limit = goal.no_more_than(x, priced.price, priced.log_mu, priced.bound)
    if time.perf_counter() >= deadline:
        return _with(found, bound=limit)
    complete, listed = _listed(goal, market, priced, gap + _ROUNDING * scale, limit, most_sets)
    if not complete:
        listed = listed.with_others(priced.sets)
    for _ in range(_ROUNDS):
        market = goal.at(x)
        packed = pack(market, listed, known, max(own, market.least_log_mu), scale=scale, deadline=deadline)
        target = goal.target(x)
        proven = packed.bound <= max(target, packed.value) + 2.0 * _ACCURACY * scale
        if packed.sets is None or packed.value <= target + _ACCURACY * scale:
            break
        better, own_of_better = goal.reached(packed.sets, packed.log_mu)
        if not better > x:
            break
        known, x, own = packed.sets, better, own_of_better
        if goal.target(x) == packed.value:  # a sum: this was the best choice
            break
    else:
        proven = False
    bound = x if complete and proven else max(limit, x)
    return _with(found, sets=known, x=x, log_mu=own, bound=bound, listed=len(listed), complete=complete and proven)


def _with(found: Exact, **changes: object) -> Exact:
    from dataclasses import replace

    return replace(found, **changes)


def _scale(market: Market, priced: ColumnPrices) -> float:
    """What is at stake: the size of the users' worths together."""
    return max(abs(priced.bound - market.left_w(priced.log_mu)), abs(priced.bound), 1e-300)


def _improved(
    goal: Goal, known: Sets, x: float, own: float, price: FloatArray, log_mu: float, deadline: float
) -> tuple[Sets, float, float, ColumnPrices, Market]:
    """Column prices for an allocation's own level, and a better allocation from the sets met, while there is one."""
    sets = known
    while True:
        market = goal.at(x)
        log_mu = max(log_mu, market.least_log_mu)
        target = goal.target(x)
        priced = column_prices(
            market, price, log_mu, sets, value=lambda target=target: target, accuracy=_PRICE_ACCURACY, deadline=deadline
        )
        price, log_mu, sets = priced.price, priced.log_mu, priced.sets
        scale = _scale(market, priced)
        now = time.perf_counter()
        if priced.bound - target <= _ACCURACY * scale or now >= deadline:
            return known, x, own, priced, market
        tight = _near(market, priced, priced.bound - target)
        packed = pack(market, tight.with_others(known), known, log_mu, scale=scale, deadline=now + _SHARE * (deadline - now))
        if packed.sets is None or packed.value <= target + _ACCURACY * scale:
            return known, x, own, priced, market
        better, own_of_better = goal.reached(packed.sets, packed.log_mu)
        if not better > x:
            return known, x, own, priced, market
        known, x, own = packed.sets, better, own_of_better
        if goal.at(x) is market:  # a sum: the prices hold for the better allocation, too
            return known, x, own, priced, market


def _near(market: Market, priced: ColumnPrices, gap: float) -> Sets:
    """The sets met whose reduced cost is within ``gap``."""
    bound, _ = priced_bounds(market, priced.price, priced.log_mu)
    worth, _ = market.worths(priced.sets, priced.log_mu)
    paid = np.concatenate([[0.0], np.cumsum(priced.price[priced.sets.member])])
    net = worth - (paid[priced.sets.first[1:]] - paid[priced.sets.first[:-1]])
    return priced.sets.chosen(np.flatnonzero(bound[priced.sets.user] - net <= gap))


def _listed(
    goal: Goal, market: Market, priced: ColumnPrices, gap: float, limit: float, most_sets: int
) -> tuple[bool, Sets]:
    """All sets whose reduced cost is within ``gap``, and whether they are all."""
    from wirelessagent.deciding.core.columns_kernel import bundles_within

    bound, _ = priced_bounds(market, priced.price, priced.log_mu, _NODES)
    wettest = goal.wettest(limit) if np.isfinite(limit) else market.users
    complete, user, first, member = bundles_within(
        market.users, market.floor, market.inverse, market.ceiling, market.start, priced.price, priced.log_mu,
        bound - gap, np.ascontiguousarray(wettest), market.least_log_mu, market.budget_w, _NODES, most_sets,
    )  # fmt: skip
    return complete, Sets(user=user, first=first, member=member)

"""Prices of columns: the bound that stays tight where users share few subcarriers, and the sets that reach it.

For prices π ≥ 0 of the columns and μ ≥ q of power no joint choice of sets is worth more than

    D(π, μ) = Σ_j π_j + Σ_k max over S of [V_k(S; μ) − π(S)] + (μ − q) P,

the dual of the linear programme that gives every user a mixture of sets, no column more than once (Dantzig and Wolfe,
1960). Its least value is at most the bound by prices of rates alone, which lets users mix on every single subcarrier.

The programme is solved by column generation: the best sets at trial prices give D there, and enter the programme, whose
duals are the next trial. Duals of a programme that does not know all sets are wild, so they are held in a box around
the best prices so far, wider after a success and narrower after a failure (the box step, Marsten et al., 1975).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.deciding.core.market import NOTHING, Market, Sets
from wirelessagent.model.arrays import FloatArray

_NODES = 200_000
"""Sets looked at for a user's best."""
_NEAR_NODES = 2_000
"""Sets looked at for those that are nearly as good, which may be missed."""
_TIE = 1e-12
"""Of a user's part in the prices, by which a set must be better than another to be looked for."""
_FIRST_SETS, _LATER_SETS = 12, 4
"""Sets that enter the programme per user and round."""
_NEAR = 0.3
"""How far from a user's best, in units of the mean worth of a user, its sets enter the programme in the first round."""
_BOX = 1.0
"""Half-width of the box at first, in units of the mean price."""
_BOX_MU, _BOX_MU_MOST = 0.3, 3.0
"""The same of ln μ, at first and at most."""
_WIDENINGS = 2
_MOST_SETS, _KEPT_SETS = 40, 20
"""Sets in the programme per user before some are dropped, and after."""
_POWER_PRICES = 3
"""At how many prices of power the programme knows each set."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ColumnPrices:
    """What column generation found.

    Attributes:
        price: π, shape (column,).
        log_mu: ln μ.
        bound: D at these prices.
        sets: the sets that the programme knew at the end.
        taken: their shares in its solution, (set,), at most 1.
        rounds: how often it was solved.
    """

    price: FloatArray
    log_mu: float
    bound: float
    sets: Sets
    taken: FloatArray
    rounds: int


@dataclass(kw_only=True, eq=False)
class _Search:
    """The best prices so far and the box around them."""

    price: FloatArray
    log_mu: float
    bound: float = np.inf
    box: float = 0.0
    box_mu: float = _BOX_MU

    def take(self, price: FloatArray, log_mu: float, bound: float, promised: float) -> None:
        """Keep the prices of a smaller bound, and fit the box to how much of the ``promised`` fall came true.

        At a kink where many sets tie D hardly ever falls at once; there the box stays, and the sets come one by one.
        """
        fall = self.bound - bound
        if fall > 0.0:
            self.price, self.log_mu, self.bound = price, log_mu, bound
        if np.isfinite(fall):
            factor = 2.0 if fall > 0.5 * promised else 0.5 if fall < -3.0 * promised else 1.0
            self.box *= factor
            self.box_mu = min(self.box_mu * factor, _BOX_MU_MOST)


def start_prices(market: Market, log_rate_price: FloatArray, log_mu: float) -> FloatArray:
    """Each column at the most that it adds for any user whose rate costs λ_k W per nat, shape (column,)."""
    from wirelessagent.deciding.core.columns_kernel import dearest

    return np.exp(log_mu) * dearest(market.floor, market.inverse, market.ceiling, market.start, log_rate_price)


def column_prices(
    market: Market,
    price: FloatArray,
    log_mu: float,
    known: Sets,
    *,
    value: float = -np.inf,
    accuracy: float = 1e-9,
    deadline: float = np.inf,
    rounds: int = 200,
) -> ColumnPrices:
    """Minimise D from ``price`` and ``log_mu``.

    Args:
        market: users, columns and power.
        price: π to start from, shape (column,).
        log_mu: ln μ to start from; ln q where there is no budget.
        known: sets to start with, such as those of an allocation; may be empty.
        value: of the best allocation known; the search ends where the bound reaches it.
        accuracy: relative; the search also ends where the programme says that D falls by less.
        deadline: in seconds on ``time.perf_counter``; at least one bound is worked out.
        rounds: times that the programme is solved at most.
    """
    search = _Search(price=price, log_mu=log_mu, box=_BOX * float(price.mean()))
    sets, taken, promised = known, np.zeros(len(known)), np.inf
    watched: list[float] = []
    done = widened = 0
    while True:
        bound, found = _priced(market, price, log_mu, done == 0)
        search.take(price, log_mu, bound, promised)
        sets = sets.with_others(found)
        close = accuracy * abs(search.bound)
        if search.bound - value <= 1e-12 * abs(search.bound) or done >= rounds or time.perf_counter() >= deadline:
            break
        watched = _watched(watched, log_mu, search.log_mu)
        solved = _solve(market, sets, watched, search)
        if solved is None:
            search.box *= 0.5
            break
        price, log_mu, least, taken, free = solved
        done += 1
        promised = search.bound - least
        if promised <= close:  # nothing to gain in the box; D being convex, little outside
            if free or widened == _WIDENINGS:
                break
            widened += 1
            search.box *= 4.0
            search.box_mu = min(4.0 * search.box_mu, _BOX_MU_MOST)
        sets, taken = _trimmed(market, sets, taken, price, log_mu)
    if taken.size < len(sets):
        taken = np.concatenate([taken, np.zeros(len(sets) - taken.size)])
    return ColumnPrices(
        price=search.price, log_mu=search.log_mu, bound=search.bound, sets=sets, taken=taken, rounds=done
    )


def priced_bounds(market: Market, price: FloatArray, log_mu: float, nodes: int = _NODES) -> tuple[FloatArray, Sets]:
    """A bound on V_k(S; μ) − π(S) for each user, (user,), and a best set of each that has any."""
    from wirelessagent.deciding.core.column_search_kernel import best_bundles

    bound = np.empty(market.users.shape[0])
    tolerance = _TIE * (float(price.sum()) + abs(market.left_w(log_mu))) / bound.size
    worth, first, member = best_bundles(
        market.users, market.floor, market.inverse, market.ceiling, market.start, price, log_mu, tolerance, nodes, bound
    )  # fmt: skip
    sets = Sets(user=np.arange(worth.size), first=first, member=member)
    return bound, sets.chosen(np.flatnonzero(worth > NOTHING))


def total_bound(market: Market, price: FloatArray, log_mu: float, bound: FloatArray) -> float:
    """D from the users' bounds."""
    return float(price.sum() + bound.sum()) + market.left_w(log_mu)


def _priced(market: Market, price: FloatArray, log_mu: float, first_round: bool) -> tuple[float, Sets]:
    """D at some prices, and the sets that are best there or nearly so."""
    from wirelessagent.deciding.core.column_search_kernel import bundles_within

    bound, best = priced_bounds(market, price, log_mu)
    typical = (float(np.abs(bound).sum()) + float(price.sum())) / bound.size
    near = _NEAR * typical * (1.0 if first_round else 0.25)
    _, user, first, member = bundles_within(
        market.users, market.floor, market.inverse, market.ceiling, market.start, price, log_mu, bound - near,
        market.users, log_mu, np.inf, _NEAR_NODES, _FIRST_SETS if first_round else _LATER_SETS,
    )  # fmt: skip
    return total_bound(market, price, log_mu, bound), best.with_others(Sets(user=user, first=first, member=member))


def _trimmed(
    market: Market, sets: Sets, taken: FloatArray, price: FloatArray, log_mu: float
) -> tuple[Sets, FloatArray]:
    """The sets that are taken or best at the last prices, where there are too many."""
    users = market.users.shape[0]
    if len(sets) <= _MOST_SETS * users:
        return sets, taken
    net = np.where(taken > 0.0, np.inf, sets.net(market.worths(sets, log_mu)[0], price))
    order = np.lexsort((-net, sets.user))
    rank = np.arange(order.size) - np.searchsorted(sets.user[order], sets.user[order])
    kept = np.sort(order[(rank < _KEPT_SETS) | (taken[order] > 0.0)])
    return sets.chosen(kept), taken[kept]


def _watched(before: list[float], trial: float, best: float) -> list[float]:
    """The prices of power that the programme knows: the best, the last trial and the latest of the others."""
    kept = [best]
    for log_mu in (trial, *before):
        if all(abs(log_mu - other) > 1e-12 for other in kept):
            kept.append(log_mu)
    return kept[:_POWER_PRICES]


def _solve(
    market: Market, sets: Sets, watched: list[float], search: _Search
) -> tuple[FloatArray, float, float, FloatArray, bool] | None:
    """The programme in the box: its prices π and ln μ, its value, the sets' shares, and whether the box did not bind.

    A column, or power, may also be bought at the upper end of its box and sold at the lower one.
    """
    from scipy.sparse import block_array, coo_array, csc_array, eye_array

    users, columns, count = len(market.users), market.columns, len(sets)
    top = bottom = 0.0
    budgeted = bool(np.isfinite(market.budget_w))
    worths = [market.worths(sets, log_mu) for log_mu in watched]
    mus = np.exp(np.repeat(watched, count))
    value = np.concatenate([worth for worth, _ in worths])
    power = np.concatenate([watts for _, watts in worths])
    usable = np.flatnonzero(value > NOTHING)
    value, power = value[usable], power[usable]
    gain = value + (mus[usable] - market.cost_per_w) * power
    scale = max(float(np.abs(value).mean()), float(search.price.mean())) or 1.0
    incidence = csc_array((np.ones(sets.member.size), sets.member, sets.first), shape=(columns, count))
    packing = csc_array(incidence[:, usable % count])
    each = coo_array(
        (np.ones(usable.size), (sets.user[usable % count], np.arange(usable.size))), shape=(users, usable.size)
    )
    dear, cheap = search.price + search.box, np.maximum(search.price - search.box, 0.0)
    costs = [-gain, dear, -cheap]
    unit = eye_array(columns, format="csc")
    rows: list[list[Any]] = [[packing, -unit, unit]]
    limits = np.ones(columns)
    if budgeted:
        mu = np.exp(search.log_mu)
        top = max(mu * np.exp(search.box_mu), market.cost_per_w) - market.cost_per_w
        bottom = max(mu * np.exp(-search.box_mu), market.cost_per_w) - market.cost_per_w
        costs.append(market.budget_w * np.array([top, -bottom]))
        used = csc_array(power[np.newaxis] / market.budget_w)
        rows = [[packing, -unit, unit, None], [used, None, None, csc_array(np.array([[-1.0, 1.0]]))]]
        limits = np.ones(columns + 1)
    cost = np.concatenate(costs) / scale
    equal: Any = block_array([[each, coo_array((users, cost.size - usable.size))]], format="csc")
    at_most: Any = block_array(rows, format="csc")
    solution = _minimised(cost, at_most, limits, equal, users)
    if solution is None:
        return None
    least, amount, dual = solution[0] * scale, solution[1], solution[2] * scale
    price = np.clip(dual[:columns], cheap, dear)
    log_mu = search.log_mu
    if budgeted:
        mu = np.clip(dual[columns] / market.budget_w, bottom, top) + market.cost_per_w
        log_mu = float(np.log(mu)) if mu > 0.0 else log_mu
    share = np.minimum(np.bincount(usable % count, weights=amount[: usable.size], minlength=count), 1.0)
    traded = float(amount[usable.size :].sum())
    return price, log_mu, -least, share, traded <= 1e-7


def _minimised(
    cost: FloatArray, at_most: object, limits: FloatArray, equal: object, users: int
) -> tuple[float, FloatArray, FloatArray] | None:
    """The least cost of a linear programme, its amounts ≥ 0, and the prices of its limits; None if it fails."""
    from scipy.optimize import linprog

    solver: Any = linprog  # its types know no sparse arrays
    result: Any = solver(
        cost, A_ub=at_most, b_ub=limits, A_eq=equal, b_eq=np.ones(users), bounds=(0, None), method="highs-ds"
    )  # fmt: skip
    if result.status != 0:
        return None
    amounts = np.asarray(result.x, dtype=np.float64)
    return float(result.fun), amounts, -np.asarray(result.ineqlin.marginals, dtype=np.float64)

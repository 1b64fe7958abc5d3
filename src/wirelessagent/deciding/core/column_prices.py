"""Prices of columns: the bound that stays tight where users share few subcarriers, and the sets that reach it.

For prices π ≥ 0 of the columns and μ ≥ q of power no joint choice of sets is worth more than

    D(π, μ) = Σ_j π_j + Σ_k max over S of [V_k(S; μ) − π(S)] + (μ − q) P,

the dual of the linear programme that gives every user a mixture of sets, no column more than once (Dantzig and Wolfe,
1960). Its least value is at most the bound by prices of rates alone, which lets users mix on every single subcarrier.

D is convex and kinked. It is minimised by column generation with proximal steps (:mod:`.mixture_kernel`): the best sets
at trial prices give D there and are known from then on; the next trial is the best for all known sets that is not far
from the best prices so far. A few dozen trials do, where duals of the programme itself, which jump from corner to
corner, take hundreds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.market import NOTHING, Market, Sets
from wirelessagent.model.arrays import FloatArray, IntArray

_NODES = 200_000
"""Sets looked at for a user's best."""
_NEAR_NODES = 2_000
"""Sets looked at for those that are nearly as good, which may be missed."""
_TIE = 1e-12
"""Of a user's part in the prices, by which a set must be better than another to be looked for."""
_NEAR, _NEAR_SETS = 0.3, 12
"""How far from a user's best, in units of the mean worth of a user, sets are known from the beginning, and how many."""
_STEP = 0.1
"""Change of a price, in units of the mean price, where a column is taken once too often; at first."""
_LONGER, _SHORTER, _WIDER = 1.5, 0.8, 10.0
_SERIOUS, _WELL_FORETOLD = 0.1, 0.5
"""Parts of the fall that was foretold from which on a trial is the new centre, and steps become longer."""
_AGAIN = 3
_EXACTNESS, _SWEEPS = 0.05, 300
"""How exact a step is, in units of the fall that was foretold last, and how long it may take."""
_CHEAPEST = np.exp(-3.0)
"""Part of the price of power that a step leaves at least."""
_MOST_RATIO = 1e100
"""Of the price of power to that of a column, so that products stay within the range of numbers."""
_MOST_SETS, _KEPT_SETS = 60, 30
"""Known sets per user before some are dropped, and after."""


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
class _Known:
    """The sets that are known, sorted by user, what each is worth at the price of power where it was found, its weight.

    Attributes:
        sets: the sets; the same one may be there at several prices of power.
        utility, power, weight: U, P in W and x, shape (set,).
    """

    sets: Sets
    utility: FloatArray
    power: FloatArray
    weight: FloatArray

    @classmethod
    def at(cls, market: Market, sets: Sets, log_mu: float) -> _Known:
        """The sets as they are at the price μ, those left out that cannot carry what they must."""
        value, power = market.worths(sets, log_mu)
        usable = np.flatnonzero(value > NOTHING)
        return cls(
            sets=sets.chosen(usable),
            utility=value[usable] + np.exp(log_mu) * power[usable],
            power=power[usable],
            weight=np.zeros(usable.size),
        )

    def chosen(self, which: IntArray) -> _Known:
        return _Known(
            sets=self.sets.chosen(which),
            utility=self.utility[which],
            power=self.power[which],
            weight=self.weight[which],
        )

    def with_others(self, others: _Known) -> _Known:
        both = _Known(
            sets=self.sets.joined(others.sets),
            utility=np.concatenate([self.utility, others.utility]),
            power=np.concatenate([self.power, others.power]),
            weight=np.concatenate([self.weight, others.weight]),
        )
        return both.chosen(np.argsort(both.sets.user, kind="stable"))

    def begins(self, users: int) -> IntArray:
        """Where each user's sets begin, shape (user + 1,)."""
        return np.searchsorted(self.sets.user, np.arange(users + 1))

    def trimmed(self, users: int, price: FloatArray, mu: float) -> _Known:
        """Those with weight and the best ones at some prices, where there are too many."""
        if len(self.sets) <= _MOST_SETS * users:
            return self
        net = np.where(self.weight > 0.0, np.inf, self.sets.net(self.utility - mu * self.power, price))
        order = np.lexsort((-net, self.sets.user))
        rank = np.arange(order.size) - self.begins(users)[self.sets.user]
        return self.chosen(np.sort(order[(rank < _KEPT_SETS) | (self.weight[order] > 0.0)]))

    def worths(self, users: int, price: FloatArray, mu: float) -> FloatArray:
        """What each user's best set is worth at some prices at least, shape (user,)."""
        net = self.sets.net(self.utility - mu * self.power, price)
        return np.maximum.reduceat(net, self.begins(users)[:-1])

    def begin_at(self, users: int, price: FloatArray, mu: float) -> bool:
        """Give all weight to each user's best set; whether everybody has one."""
        net = self.sets.net(self.utility - mu * self.power, price)
        begin = self.begins(users)
        if not (np.diff(begin) > 0).all():
            return False
        order = np.lexsort((-net, self.sets.user))
        self.weight[:] = 0.0
        self.weight[order[begin[:-1]]] = 1.0
        return True

    def merged(self) -> tuple[Sets, FloatArray]:
        """Every set once, with its weight."""
        _, where, which = np.unique(self.sets.digest(), return_index=True, return_inverse=True)
        return self.sets.chosen(where), np.minimum(np.bincount(which, weights=self.weight), 1.0)


@dataclass(kw_only=True, eq=False)
class _Center:
    """The best prices so far, and how far from them the next trial may be."""

    price: FloatArray
    log_mu: float
    bound: float
    step: float

    def step_mu(self, market: Market) -> float:
        """The step in μ, with which the price of power may change by as much of itself as that of a column."""
        if np.isinf(market.budget_w):
            return 0.0
        typical = float(self.price.mean()) or 1.0
        return self.step * min(float(np.exp(self.log_mu)) / typical, _MOST_RATIO) ** 2

    def take(self, price: FloatArray, log_mu: float, bound: float, foretold: float) -> None:
        """Move to the prices of a bound that is as much smaller as ``foretold``, more or less, or come nearer."""
        fall = self.bound - bound
        if fall >= _SERIOUS * foretold:
            self.price, self.log_mu, self.bound = price, log_mu, bound
            self.step *= _LONGER if fall > _WELL_FORETOLD * foretold else 1.0
        elif -fall > foretold:
            self.step *= _SHORTER


def start_prices(market: Market, log_rate_price: FloatArray, log_mu: float) -> FloatArray:
    """Each column at the most that it adds for any user whose rate costs λ_k W per nat, shape (column,)."""
    from wirelessagent.deciding.core.columns_kernel import middle_terms

    return np.exp(log_mu) * middle_terms(market.floor, market.inverse, market.ceiling, market.start, log_rate_price)


def column_prices(
    market: Market,
    price: FloatArray,
    log_mu: float,
    known: Sets,
    *,
    value: float = -np.inf,
    accuracy: float = 1e-9,
    rounds: int = 200,
) -> ColumnPrices:
    """Minimise D from ``price`` and ``log_mu``.

    Args:
        market: users, columns and power, and the time that there is; one bound is worked out where that suffices.
        price: π to start from, shape (column,).
        log_mu: ln μ to start from; ln q where there is no budget.
        known: sets to start with, such as those of an allocation; may be empty.
        value: of the best allocation known; the search ends where the bound reaches it.
        accuracy: relative; the search also ends where D can hardly fall by more.
        rounds: trials at most.
    """
    users = market.users.shape[0]
    first_bound, found = _priced(market, price, log_mu)
    center = _Center(price=price, log_mu=log_mu, bound=first_bound, step=_STEP * _typical(price, first_bound))
    sets = _Known.at(market, known.with_others(found), log_mu)
    sets = sets.chosen(np.argsort(sets.sets.user, kind="stable"))
    everybody = sets.begin_at(users, price, float(np.exp(log_mu)))
    foretold, done, again = abs(first_bound), 0, 0
    while everybody and done < rounds and not market.limit.is_over():
        if center.bound - value <= 1e-12 * abs(center.bound):
            break
        close = accuracy * abs(center.bound)
        exactness = max(_EXACTNESS * min(foretold, center.bound - value), 0.1 * close)
        price, log_mu, model, inexact = _proximal(market, sets, center, exactness)
        foretold = center.bound - model
        if foretold <= close:  # nothing to gain near by: look more closely, then farther, and then it is done
            again += 1
            if again > _AGAIN:
                break
            if inexact <= close:
                center.step *= _WIDER
            continue
        again = 0
        bound, best = priced_bounds(market, price, log_mu, sets.worths(users, price, float(np.exp(log_mu))))
        center.take(price, log_mu, total_bound(market, price, log_mu, bound), foretold)
        sets = sets.trimmed(users, center.price, float(np.exp(center.log_mu)))
        sets = sets.with_others(_Known.at(market, best, log_mu))
        done += 1
    merged, taken = sets.merged()
    return ColumnPrices(
        price=center.price, log_mu=center.log_mu, bound=center.bound, sets=merged, taken=taken, rounds=done
    )  # fmt: skip


def _typical(price: FloatArray, bound: float) -> float:
    """The mean price; where nothing costs anything, what a column may be worth."""
    return float(price.mean()) or abs(bound) / price.size or 1.0


def _proximal(
    market: Market, known: _Known, center: _Center, exactness: float
) -> tuple[FloatArray, float, float, float]:
    """The next prices π and ln μ, the least that D may be there, and how exact that is."""
    from wirelessagent.deciding.core.mixture_kernel import mix

    price = np.empty(center.price.size)
    center_mu = float(np.exp(center.log_mu))
    least_mu = max(market.cost_per_w, _CHEAPEST * center_mu)
    sets = known.sets
    mu, model, inexact = mix(
        known.begins(market.users.shape[0]), sets.first, sets.member, known.utility, known.power, center.price,
        center_mu, center.step, center.step_mu(market), least_mu, market.budget_w, exactness, _SWEEPS, known.weight,
        price, market.limit.work,
    )  # fmt: skip
    if np.isfinite(market.budget_w):
        model += (least_mu - market.cost_per_w) * market.budget_w
    return price, float(np.log(mu)), model, inexact


def priced_bounds(
    market: Market, price: FloatArray, log_mu: float, least: FloatArray | None = None
) -> tuple[FloatArray, Sets]:
    """A bound on V_k(S; μ) − π(S) for each user, (user,), and a best set of each that has any.

    With ``least`` (user,), the worth of sets that are known, only better ones are looked for.
    """
    from wirelessagent.deciding.core.column_search_kernel import best_bundles

    users = market.users.shape[0]
    bound = np.empty(users)
    tolerance = _TIE * (float(price.sum()) + abs(market.left_w(log_mu))) / users
    sought = np.empty(users)
    sought[:] = 4.0 * NOTHING if least is None else least
    worth, first, member = best_bundles(
        market.users, market.floor, market.inverse, market.ceiling, market.start, price, log_mu,
        sought, tolerance, _NODES, bound, market.limit.work,
    )  # fmt: skip
    sets = Sets(user=np.arange(users, dtype=np.int64), first=first, member=member)
    return bound, sets.chosen(np.flatnonzero(worth > NOTHING))


def total_bound(market: Market, price: FloatArray, log_mu: float, bound: FloatArray) -> float:
    """D from the users' bounds."""
    return float(price.sum() + bound.sum()) + market.left_w(log_mu)


def _priced(market: Market, price: FloatArray, log_mu: float) -> tuple[float, Sets]:
    """D at the first prices, and the sets that are best there or nearly so."""
    from wirelessagent.deciding.core.column_search_kernel import bundles_within

    bound, best = priced_bounds(market, price, log_mu)
    if not np.isfinite(bound).all():  # time ran out
        return np.inf, best
    typical = (float(np.abs(bound).sum()) + float(price.sum())) / bound.size
    _, user, first, member = bundles_within(
        market.users, market.floor, market.inverse, market.ceiling, market.start, price, log_mu,
        bound - _NEAR * typical, market.users, log_mu, np.inf, _NEAR_NODES, _NEAR_SETS, market.limit.work,
    )  # fmt: skip
    return total_bound(market, price, log_mu, bound), best.with_others(Sets(user=user, first=first, member=member))

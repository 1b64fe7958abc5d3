"""The true optimum: column prices, the few sets that they leave to choose from, and branching where these are many.

At column prices of bound D, an allocation that is worth more than L in a market holds no set that is worth D − L less
than its user's best (its reduced cost), since all the others together are worth at most what D says. So:

1. an allocation (given, improved by the sets that column generation has met) and column prices at its own level;
2. all sets whose reduced cost is within D − L, by branch and bound, and the best choice among them. The list holds for
   higher levels as well, because what exceeds a higher level exceeds this one, too;
3. where these are too many, two problems instead: one in which some column is for one user alone, and one in which it
   is not for that user. Each has prices and a smaller D of its own; the larger D is always looked at first.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, replace

import numpy as np

from wirelessagent.deciding.core.column_prices import ColumnPrices, column_prices, priced_bounds
from wirelessagent.deciding.core.goals import Goal
from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.set_packing import pack
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

_ROUNDING = 1e-9
"""Of the worth at stake, by which the limit on reduced costs is widened."""
_ACCURACY = 1e-10
_PRICE_ACCURACY = 1e-6
_ROUNDS = 30
_NODES = 300_000
_FRACTION = 1e-6
_PACKED_SHARE = 0.3
"""Share of the time left that a search among the sets met may take."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Optimum:
    """What the search found.

    Attributes:
        sets: one for each user.
        x: the level that they reach (:mod:`.goals`).
        log_mu: ln μ there.
        bound: no allocation reaches more.
        price: π of the columns at the start of the search, shape (column,).
        nodes: how many problems were looked at.
    """

    sets: Sets
    x: float
    log_mu: float
    bound: float
    price: FloatArray
    nodes: int

    def allocation(self, goal: Goal) -> tuple[IntArray, FloatArray]:
        """The owner, −1 for nobody, and the power in W of each subcarrier, (subcarrier,); a column has one owner.

        Where rates are tiny, power may be lost to rounding, which its owner is not.
        """
        from wirelessagent.deciding.core.columns_kernel import spread

        market = goal.reaching(self.x)
        columns = self.sets.owner(market.columns)
        power_w: FloatArray = spread(
            market.users, market.floor, market.inverse, market.ceiling, market.start, self.log_mu, columns
        )  # fmt: skip
        return np.repeat(columns, np.diff(market.start)), power_w


@dataclass(kw_only=True, eq=False)
class _Best:
    """The best allocation so far, its level and its price of power."""

    sets: Sets
    x: float
    log_mu: float
    enough: float

    @property
    def is_enough(self) -> bool:
        """Whether no better one is wanted."""
        return self.x >= self.enough

    def offer(self, goal: Goal, sets: Sets, log_mu: float) -> bool:
        """Take an allocation that reaches more."""
        x, own = goal.reached(sets, log_mu)
        if x <= self.x:
            return False
        self.sets, self.x, self.log_mu = sets, x, own
        return True


@dataclass(frozen=True, kw_only=True, eq=False)
class _Node:
    """A problem with some pairs of user and column ruled out, and what is known of it.

    Attributes:
        allowed: shape (user, column).
        price, log_mu: where to start.
        sets: to start with.
        limit: no allocation of it reaches a higher level.
    """

    allowed: BoolArray
    price: FloatArray
    log_mu: float
    sets: Sets
    limit: float


def search(
    goal: Goal, known: Sets, price: FloatArray, log_mu: float, *, most_sets: int, enough: float = np.inf
) -> Optimum:
    """The best allocation from a ``known`` one that keeps every limit, and prices π and ln μ to start from.

    ``most_sets`` is how many sets are listed at most for one problem before it is divided; no allocation better than
    one that reaches ``enough`` is looked for.
    """
    limit = goal.market.limit
    x, own = goal.reached(known, log_mu)
    best = _Best(sets=known, x=x, log_mu=own, enough=enough)
    everything = np.ones((goal.market.users.shape[0], goal.market.columns), dtype=bool)
    root = _Node(allowed=everything, price=price, log_mu=log_mu, sets=known, limit=np.inf)
    first_price = price
    heap: list[tuple[float, int, _Node]] = [(-np.inf, 0, root)]
    nodes = made = 0
    most = -np.inf  # of the problems that were closed without proof
    while heap and not best.is_enough and not limit.is_over():
        node = heapq.heappop(heap)[2]
        if node.limit - best.x <= _ACCURACY * abs(best.x):
            most = max(most, node.limit)
            continue
        priced, left = _look(goal, node, best, most_sets)
        nodes += 1
        if nodes == 1:
            first_price = priced.price
        left = min(left, node.limit)
        if left <= best.x:
            continue
        children = [] if limit.is_over() else _children(node, priced, left)
        if not children:
            most = max(most, left)
        for child in children:
            made += 1
            heapq.heappush(heap, (-left, made, child))
    most = max([most, best.x, *(node.limit for _, _, node in heap)])
    return Optimum(sets=best.sets, x=best.x, log_mu=best.log_mu, bound=most, price=first_price, nodes=max(nodes, 1))


def _look(goal: Goal, node: _Node, best: _Best, most_sets: int) -> tuple[ColumnPrices, float]:
    """Prices of a problem, and the level that no allocation of it exceeds; at most ``best.x`` where it is closed."""
    price, log_mu, sets = node.price, node.log_mu, node.sets
    while True:
        x = best.x
        market = _masked(goal.at(x), node.allowed)
        target = goal.target(x)
        priced = column_prices(
            market,
            price,
            max(log_mu, market.least_log_mu),
            sets,
            value=target,
            accuracy=_PRICE_ACCURACY,
        )
        price, log_mu, sets = priced.price, priced.log_mu, priced.sets
        if not np.isfinite(priced.bound):  # time ran out before there was one
            return priced, np.inf
        scale = _scale(market, priced)
        if priced.bound - target <= _ACCURACY * scale:
            return priced, x
        limit = goal.no_more_than(x, market, price, log_mu, priced.bound)
        if market.limit.is_over():
            return priced, limit
        near = _near(market, priced, priced.bound - target)
        packed = pack(market, near, priced.log_mu, scale=scale, least=target, share=_PACKED_SHARE)
        if not (packed.sets is not None and best.offer(goal, packed.sets, packed.log_mu)):
            break
        if best.is_enough:
            return priced, limit
        if goal.at(best.x) is goal.at(x):  # a sum: the prices hold for the better allocation, too
            target = goal.target(best.x)
            if priced.bound - target <= _ACCURACY * scale:
                return priced, best.x
            break
    gap = priced.bound - target + _ROUNDING * scale
    complete, listed = _listed(goal, market, priced, gap, limit, most_sets)
    left = _settled(goal, node, listed, best, scale) if complete else limit
    return priced, left


def _settled(goal: Goal, node: _Node, listed: Sets, best: _Best, scale: float) -> float:
    """The level that no choice among all sets of a problem exceeds; ``best.x`` unless time runs out."""
    for _ in range(_ROUNDS):
        market = _masked(goal.at(best.x), node.allowed)
        target = goal.target(best.x)
        packed = pack(market, listed, max(best.log_mu, market.least_log_mu), scale=scale, least=target)
        if packed.bound <= target + 2.0 * _ACCURACY * scale:
            return best.x
        better = packed.sets is not None and best.offer(goal, packed.sets, packed.log_mu)
        if packed.bound <= goal.target(best.x) + 2.0 * _ACCURACY * scale:
            return best.x
        if not better:  # all of them are worth less, or some are worth so little more that it is rounding
            is_rounding = packed.bound <= packed.value + 2.0 * _ACCURACY * scale
            return best.x if is_rounding and not goal.market.limit.is_over() else np.inf
    return np.inf


def _scale(market: Market, priced: ColumnPrices) -> float:
    """What is at stake: the size of the users' worths together."""
    return max(abs(priced.bound - market.left_w(priced.log_mu)), abs(priced.bound), 1e-300)


def _masked(market: Market, allowed: BoolArray) -> Market:
    if allowed.all():
        return market
    usable = np.repeat(allowed, np.diff(market.start), axis=1)
    return replace(market, ceiling=np.where(usable, market.ceiling, 0.0))


def _near(market: Market, priced: ColumnPrices, gap: float) -> Sets:
    """The sets met whose reduced cost is within ``gap``."""
    bound, _ = priced_bounds(market, priced.price, priced.log_mu)
    net = priced.sets.net(market.worths(priced.sets, priced.log_mu)[0], priced.price)
    return priced.sets.chosen(np.flatnonzero(bound[priced.sets.user] - net <= gap))


def _listed(
    goal: Goal, market: Market, priced: ColumnPrices, gap: float, limit: float, most_sets: int
) -> tuple[bool, Sets]:
    """All sets whose reduced cost is within ``gap``, and whether they are all."""
    from wirelessagent.deciding.core.column_search_kernel import bundles_within

    bound, _ = priced_bounds(market, priced.price, priced.log_mu)
    wettest = goal.at(limit).users if np.isfinite(limit) else market.users
    complete, user, first, member = bundles_within(
        market.users, market.floor, market.inverse, market.ceiling, market.start, priced.price, priced.log_mu,
        bound - gap, np.ascontiguousarray(wettest), market.least_log_mu, market.budget_w, _NODES, most_sets,
        market.limit.work,
    )  # fmt: skip
    return complete, Sets(user=user, first=first, member=member)


def _children(node: _Node, priced: ColumnPrices, limit: float) -> list[_Node]:
    """The two problems that a column divides a problem into: for one user alone, and not for that user."""
    share = np.zeros(node.allowed.shape)
    np.add.at(
        share,
        (np.repeat(priced.sets.user, priced.sets.size), priced.sets.member),
        np.repeat(priced.taken, priced.sets.size),
    )
    open_pairs = node.allowed & (node.allowed.sum(axis=0) > 1)
    if not open_pairs.any():
        return []
    split = np.where(open_pairs, np.minimum(share, 1.0 - share) * priced.price, -1.0)
    if split.max() <= _FRACTION * priced.price.max(initial=0.0):  # nothing is shared: a column that somebody takes
        split = np.where(open_pairs, share * priced.price + 1e-12, -1.0)
    user, column = np.unravel_index(int(split.argmax()), split.shape)
    alone, without = node.allowed.copy(), node.allowed.copy()
    alone[:, column] = False
    alone[user, column] = True
    without[user, column] = False
    return [_child(priced, allowed, limit) for allowed in (alone, without)]


def _child(priced: ColumnPrices, allowed: BoolArray, limit: float) -> _Node:
    user = np.repeat(priced.sets.user, priced.sets.size)
    ruled_out = np.concatenate([[0], np.cumsum(~allowed[user, priced.sets.member])])
    kept = np.flatnonzero(ruled_out[priced.sets.first[1:]] == ruled_out[priced.sets.first[:-1]])
    return _Node(allowed=allowed, price=priced.price, log_mu=priced.log_mu, sets=priced.sets.chosen(kept), limit=limit)

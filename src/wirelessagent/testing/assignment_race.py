"""Which of many assignments reaches the largest sum of utilities, or the largest ratio of it to the power drawn.

At a price of power μ, with V and P_k of :class:`PricedSets` and U the sum of the utilities, every allocation of power P
on an assignment has

    U ≤ Σ_k V_k(μ) + μ P,

so that U is at most the right side at the budget, and U/(P/ξ + P_c), which is monotone in P then, at most the larger of
its values at the least power and at the budget. What an assignment reaches is met by allocations at prices on either
side of the best one; the rates in between, mixed so that the budget is spent, keep it too since power is convex in the
rates. Assignments drop out when their bound is no more than what another has reached.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.testing.priced_sets import PricedSets

_TOLERANCE = 3e-13
_ROUNDING = 2e-15
_PRICES = (1e-45, 1e45)
_ZOOMS = 40
_POINTS = 9
_PARTS = (1.0, 0.1, 0.01, 0.001)
_NEIGHBOURHOOD = 4.0 ** np.linspace(-1.0, 1.0, 11)


@dataclass(kw_only=True, eq=False)
class Race:
    """The assignments ``held`` (assignment, user), indices into the sets, that can carry the rates ``low``.

    Attributes:
        priced: the sets, leading axes (set, user).
        held: which set each user has, per assignment.
        needed_w: the power that the low rates need, per assignment.
        low: the low rates (user,) in nats.
        budget_w: the power budget.
        cell: for its circuit power and amplifier efficiency.
        is_ratio: whether the ratio is wanted.
        best: the best assignment met.
        nats: the rates (user,) on it.
        reached: the sum or ratio that they reach.
        ceiling: what no assignment exceeds, once the race is run.
    """

    priced: PricedSets
    held: IntArray
    needed_w: FloatArray
    low: FloatArray
    budget_w: float
    cell: Cell
    is_ratio: bool
    best: int = field(default=0, init=False)
    nats: FloatArray = field(default_factory=lambda: np.zeros(0), init=False)
    reached: float = field(default=-np.inf, init=False)
    ceiling: float = field(default=-np.inf, init=False)

    def run(self) -> tuple[int, FloatArray]:
        """The best assignment and the rates (user,) in nats on it.

        One promising assignment is solved, all are bounded at prices around its own, and those left are solved.
        """
        self.best, self.nats = int(self.needed_w.argmin()), self.low
        utility = self._total(self.priced.utility(self.priced.high))
        alive = np.flatnonzero(utility > -np.inf)
        if not alive.size:
            return self.best, self.nats
        first = alive[[int(self._guess()[alive].argmax())]]
        price = self._solve(first, np.full(1, _PRICES[0]), np.full(1, _PRICES[1]))
        self.ceiling = self.reached  # of the first alone; it runs again with all others
        left, lowest, highest = self._bounded(alive, price * _NEIGHBOURHOOD)
        self._solve(left, lowest, highest)
        return self.best, self.nats

    def _guess(self) -> FloatArray:
        """What assignments reach with equal parts of some of the budget for all users, a little more or less."""
        priced = self.priced
        values: list[FloatArray] = []
        for part in _PARTS if self.is_ratio else _PARTS[:1]:
            level = priced.sets.level_of_power(np.full(priced.low.shape, part * self.budget_w / self.low.size))
            nats = np.clip(priced.sets.rate_nats(level), priced.low, priced.high)
            power = priced.sets.power_w(priced.sets.level_of_rate(nats))
            values.append(self._value(self._total(priced.utility(nats)), self._total(power)))
        return np.max(values, axis=0)

    def _total(self, by_set: FloatArray) -> FloatArray:
        return by_set[..., self.held, np.arange(self.low.size)].sum(axis=-1)

    def _bounded(self, alive: IntArray, grid: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """The assignments that may beat what was reached, with brackets of their prices, from common prices."""
        worth = self.priced.at(grid[:, np.newaxis, np.newaxis])
        surplus, utility, power = (self._total(x)[:, alive] for x in (worth.surplus, worth.utility, worth.power_w))
        prices = grid[:, np.newaxis]
        fits = power <= self.budget_w
        value = np.where(fits, self._value(utility, power), -np.inf)
        point, which = np.unravel_index(int(value.argmax()), value.shape)
        sets = self.held[alive[which]]
        self._offer(alive[[which]], worth.nats[point, sets, np.arange(sets.size)][np.newaxis])
        most = self._bounds(prices, surplus, utility, power, self.needed_w[alive]).min(axis=0)
        short = self._short(prices, surplus, power).sum(axis=0)
        prices = np.concatenate([_PRICES[:1], grid, _PRICES[1:]])
        hopes = self._hopes(most)
        self._give_up(most[~hopes])
        return alive[hopes], prices[short][hopes], prices[short + 1][hopes]

    def _solve(self, left: IntArray, lowest: FloatArray, highest: FloatArray) -> float:
        """Narrow the brackets of the assignments' prices until none may beat what was reached; the first's price."""
        users = np.arange(self.low.size)
        steps = np.linspace(0.0, 1.0, _POINTS)[:, np.newaxis]
        most = np.full(left.size, np.inf)
        price = float(np.sqrt(lowest[0] * highest[0])) if left.size else np.nan
        for _ in range(_ZOOMS):
            if not left.size:
                break
            prices = lowest * (highest / lowest) ** steps
            worth = self.priced.pick((self.held[left], users)).at(prices[..., np.newaxis])
            surplus, utility, power = (x.sum(axis=-1) for x in (worth.surplus, worth.utility, worth.power_w))
            most = np.minimum(most, self._bounds(prices, surplus, utility, power, self.needed_w[left]).min(axis=0))
            short = self._short(prices, surplus, power)
            rank = np.maximum.accumulate(short[::-1], axis=0)[::-1].sum(axis=0)  # rounding may break the order
            self._offer_between(left, worth.nats, power, rank)
            column = np.arange(left.size)
            before, after = np.maximum(rank - 1, 0), np.minimum(rank, _POINTS - 1)
            lowest, highest = prices[before, column], prices[after, column]
            price = float(np.sqrt(lowest[0] * highest[0]))
            going = self._hopes(most) & (highest > lowest * (1 + 1e-15))
            self._give_up(most[~going])
            left, lowest, highest, most = left[going], lowest[going], highest[going], most[going]
        self._give_up(most)
        return price

    def _give_up(self, most: FloatArray) -> None:
        self.ceiling = max(self.ceiling, self.reached, float(most.max(initial=-np.inf)))

    def _offer_between(self, left: IntArray, nats: FloatArray, power_w: FloatArray, rank: IntArray) -> None:
        """Offer the rates at the prices before and after the best, and their mixture that spends the budget."""
        column = np.arange(left.size)
        before = np.maximum(rank - 1, 0)
        after = np.minimum(rank, _POINTS - 1)
        low = np.broadcast_to(self.low, (left.size, self.low.size))
        beyond = (rank == _POINTS)[:, np.newaxis]
        dear = np.where(beyond, low, nats[after, column])
        dear_w = np.where(beyond[:, 0], self.needed_w[left], power_w[after, column])
        cheap, cheap_w = nats[before, column], power_w[before, column]
        with np.errstate(all="ignore"):
            part = np.clip((self.budget_w - dear_w) / (cheap_w - dear_w), 0.0, 1.0)
        part = np.where(np.isnan(part), 0.0, part)[:, np.newaxis]
        self._offer(np.tile(left, 3), np.concatenate([dear, cheap, part * cheap + (1 - part) * dear]))

    def _offer(self, assignments: IntArray, nats: FloatArray) -> None:
        """Take the best of these rates (assignment, user) if it beats what was reached within the budget."""
        own = self.priced.pick((self.held[assignments], np.arange(self.low.size)))
        power = own.sets.power_w(own.sets.level_of_rate(nats)).sum(axis=-1)
        value = self._value(own.utility(nats).sum(axis=-1), power)
        value = np.where(power <= self.budget_w * (1 + 1e-14), value, -np.inf)
        found = int(value.argmax())
        if value[found] > self.reached:
            self.best, self.nats, self.reached = int(assignments[found]), nats[found], float(value[found])

    def _value(self, utility: FloatArray, power_w: FloatArray) -> FloatArray:
        if not self.is_ratio:
            return utility
        drawn = power_w / self.cell.amplifier_efficiency + self.cell.circuit_power_w
        return np.where(drawn > 0, utility / np.where(drawn > 0, drawn, 1.0), 0.0)

    def _bounds(
        self, price: FloatArray, surplus: FloatArray, utility: FloatArray, power_w: FloatArray, needed_w: FloatArray
    ) -> FloatArray:
        """What an assignment can reach at most, by its surplus at a price; rounding errors added."""
        size = np.where(np.isfinite(utility), np.abs(utility), 0.0) + price * power_w

        def most(spent_w: FloatArray) -> FloatArray:
            paid = price * spent_w
            return self._value(surplus + paid + _ROUNDING * (size + paid), np.broadcast_to(spent_w, size.shape))

        at_budget = most(np.asarray(self.budget_w))
        if not self.is_ratio:
            return at_budget
        nothing = needed_w + self.cell.circuit_power_w == 0.0
        return np.maximum(at_budget, np.where(nothing, np.inf, most(needed_w)))

    def _short(self, price: FloatArray, surplus: FloatArray, power_w: FloatArray) -> BoolArray:
        """Whether a price is below the best one."""
        if not self.is_ratio:
            return power_w > self.budget_w
        drawn = self.cell.amplifier_efficiency * self.cell.circuit_power_w
        return (power_w > self.budget_w) | (surplus > price * drawn)

    def _hopes(self, most: FloatArray) -> BoolArray:
        """Which bounds are above what was reached."""
        slack = _TOLERANCE * abs(self.reached) if np.isfinite(self.reached) else 0.0
        return most > self.reached + slack

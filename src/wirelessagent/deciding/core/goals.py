"""What is to be made largest, as a row of markets: one for a sum or a power, one for each level otherwise.

A level x (an efficiency, or a common rate) is exceeded by an allocation just where the allocation is worth more than
``target(x)`` in the market at x. So the largest x is found by improving an allocation in the market at its own x, until
none there is worth more than the target: Dinkelbach's method (1967) for efficiency, and the same for common rates.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.market import Market, Sets
from wirelessagent.deciding.core.program import promises
from wirelessagent.model.arrays import FloatArray

_STEPS = 100
_HALVINGS = 48
_HAIR = 1e-10
_LEAST_LEVEL = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Goal(ABC):
    """The largest x that some allocation reaches.

    Attributes:
        market: the market without its level: the channel, the users' rows, the budget.
    """

    market: Market

    @abstractmethod
    def at(self, x: float) -> Market:
        """The market at the level x."""

    def reaching(self, x: float) -> Market:
        """The market in which the allocation that reaches x has its powers."""
        return self.at(x)

    @abstractmethod
    def target(self, x: float) -> float:
        """What an allocation that reaches x is worth in the market at x; infinite where x is the most there is."""

    @abstractmethod
    def reached(self, sets: Sets, log_mu: float) -> tuple[float, float]:
        """The largest x that one set for each user reaches, −∞ where it keeps not every limit, and ln μ there."""

    @abstractmethod
    def no_more_than(self, x: float, market: Market, price: FloatArray, log_mu: float, bound: float) -> float:
        """A level that nothing exceeds, from prices of the market at x and their ``bound`` there."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Most(Goal):
    """The largest sum of utilities within the budget, or minus the least power: x is what the allocation is worth."""

    def at(self, x: float) -> Market:
        del x
        return self.market

    def target(self, x: float) -> float:
        return x

    def reached(self, sets: Sets, log_mu: float) -> tuple[float, float]:
        return self.market.value(sets, log_mu)

    def no_more_than(self, x: float, market: Market, price: FloatArray, log_mu: float, bound: float) -> float:
        del x, market, price, log_mu
        return bound


@dataclass(frozen=True, kw_only=True, eq=False)
class MostPerJoule(Goal):
    """The largest Σ U/(P + C).

    Attributes:
        circuit_w: C.
    """

    circuit_w: float

    def at(self, x: float) -> Market:
        return self.market.with_users(self.market.users, cost_per_w=max(x, 0.0))

    def target(self, x: float) -> float:
        return x * self.circuit_w

    def reached(self, sets: Sets, log_mu: float) -> tuple[float, float]:
        value, log_mu = self.market.value(sets, log_mu)
        if value == -np.inf:
            return value, log_mu
        best = -np.inf
        for _ in range(_STEPS):
            utility, power = self.market.totals(sets, log_mu)
            drawn = power + self.circuit_w
            x = utility / drawn if drawn > 0 else np.inf
            if not x > best * (1.0 + 1e-15):
                break
            best = x
            _, log_mu = self.at(x).value(sets, log_mu)
        return best, log_mu

    def no_more_than(self, x: float, market: Market, price: FloatArray, log_mu: float, bound: float) -> float:
        """From A(μ) = Σ π + Σ max [V(S; μ) − π(S)], which falls with μ: x is at most μ where A(μ) ≤ μ C.

        Then (A + μ P)/(P + C) is a bound as well; otherwise A(μ)/C is, being a price where the former holds.
        """
        mu = float(np.exp(log_mu))
        worth = bound - market.left_w(log_mu)
        if worth > mu * self.circuit_w:
            return worth / self.circuit_w if self.circuit_w > 0 else np.inf
        return min(mu, (worth + mu * self.market.budget_w) / (self.market.budget_w + self.circuit_w))


@dataclass(frozen=True, kw_only=True, eq=False)
class HighestLevel(Goal):
    """The largest t at which the rates t·share, kept within their limits, fit the budget.

    Attributes:
        share: share, least and most nats of each user, shape (user, 3).
        most_level: the t beyond which nothing is gained.
        power_w: the budget; the market itself has none.
    """

    share: FloatArray
    most_level: float
    power_w: float

    def at(self, x: float) -> Market:
        """The market a hair above the level x, since ceilings may leave power at the highest level."""
        return self._at(x + _HAIR * max(x, _LEAST_LEVEL))

    def reaching(self, x: float) -> Market:
        return self._at(x)

    def _at(self, level: float) -> Market:
        nats = np.clip(min(level, self.most_level) * self.share[:, 0], self.share[:, 1], self.share[:, 2])
        return self.market.with_users(promises(nats), cost_per_w=1.0)

    def target(self, x: float) -> float:
        return -self.power_w if x < self.most_level else np.inf

    def reached(self, sets: Sets, log_mu: float) -> tuple[float, float]:
        def fits(t: float) -> bool:
            return self._at(t).value(sets)[0] >= -self.power_w * (1.0 + 1e-13)

        if not fits(0.0):
            return -np.inf, 0.0
        return _largest(fits, self.most_level, _STEPS), 0.0

    def no_more_than(self, x: float, market: Market, price: FloatArray, log_mu: float, bound: float) -> float:
        from wirelessagent.deciding.core.column_prices import priced_bounds, total_bound

        def allowed(t: float) -> bool:
            there = market.with_users(self._at(t).users)
            return total_bound(there, price, log_mu, priced_bounds(there, price, log_mu)[0]) >= -self.power_w

        if x >= self.most_level or allowed(self.most_level):
            return self.most_level
        low, step = x, 1e-3
        high = x * (1.0 + step) if x > 0 else 1e-3
        while high < self.most_level and allowed(high):
            low, step = high, 4.0 * step
            high = high * (1.0 + step)
        for _ in range(_HALVINGS):
            if high - low <= 1e-7 * high:
                break
            middle = 0.5 * (low + high)
            low, high = (middle, high) if allowed(middle) else (low, middle)
        return min(high, self.most_level)


def _largest(fits: Callable[[float], bool], most: float, steps: int) -> float:
    """The largest t up to ``most`` that fits, where 0 does, to rounding."""
    if np.isfinite(most) and fits(most):
        return most
    low, high = 0.0, 1.0
    while fits(high):
        low, high = high, 2.0 * high
        if high > 1e6:
            return high
    if low == 0.0:
        while high > 1e-12 and not fits(0.5 * high):
            high *= 0.5
        low = 0.5 * high if high > 1e-12 else 0.0
    for _ in range(steps):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low

"""What sets of subcarriers are worth to their users at a price of power, for any utility that has a conjugate.

For a user of weight ω with the set S, rates boxed to [low, high] and a price μ of a watt,

    V(S; μ) = max over r of ω u(r) − μ P(r; S),    P the least power for r on S.

A marginal nat costs μ L at the water level L, so the rate is where what is asked for at the price π = μ L/(ω B′) of a
bit/s meets what the level carries. Demand comes from the objective's conjugate alone and may jump (a linear utility) or
bend (a logarithm); Ridders's method halves the bracket whatever it does. By weak duality every level tried bounds V
from above, so V is never too small, only the tighter the better the level.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.objective import Objective
from wirelessagent.testing.owned_sets import OwnedSets

_STEPS = 60
_STILL = 1e-8
_NARROW = 1e-12
_SHARP = 1e-14


class Worth(NamedTuple):
    """At a price: an upper bound on V, and a rate, its utility ω u and its power that come next to it; (…, user)."""

    surplus: FloatArray
    utility: FloatArray
    nats: FloatArray
    power_w: FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class PricedSets:
    """Sets with what their users want: low and high rates in nats and weights, all broadcast to (…, user).

    A pair with a low rate that its set cannot carry is ``hopeless``: its surplus is −inf.
    """

    objective: Objective
    sets: OwnedSets
    weight: FloatArray
    low: FloatArray
    high: FloatArray
    hopeless: BoolArray
    bps_per_nat: float

    @classmethod
    def of(
        cls, objective: Objective, sets: OwnedSets, weight: FloatArray, low: FloatArray, high: FloatArray, unit: float
    ) -> PricedSets:
        """``low`` and ``high`` (user,) in nats; ``unit`` is the bit/s of a nat."""
        most = sets.rate_nats(sets.top)
        hopeless = low > most * (1.0 + 1e-12)
        low = np.minimum(low, most)
        high = np.maximum(np.minimum(high, most), low)
        weight = np.broadcast_to(weight, most.shape)
        return cls(
            objective=objective, sets=sets, weight=weight, low=low, high=high, hopeless=hopeless, bps_per_nat=unit
        )  # fmt: skip

    def pick(self, index: object) -> PricedSets:
        """The same for an index into the leading axes, which keeps the user axis the last."""
        parts = {name: getattr(self, name)[index] for name in ("weight", "low", "high", "hopeless")}
        return PricedSets(
            objective=self.objective, sets=self.sets.pick(index), bps_per_nat=self.bps_per_nat, **parts
        )  # fmt: skip

    def utility(self, nats: FloatArray) -> FloatArray:
        """ω u(r), 0 for users of weight 0; (…, user)."""
        with np.errstate(all="ignore"):
            found = self.objective.utility(nats * self.bps_per_nat)
            return np.where(self.weight > 0, self.weight * found, 0.0)

    def at(self, price: FloatArray) -> Worth:
        """What they are worth at prices of power μ > 0 (…, 1)."""
        with np.errstate(all="ignore"):
            level, surplus = self._meeting(price)
            nats = np.clip(self.sets.rate_nats(level), self.low, self.high)
            nats = np.where(self.weight > 0, nats, self.low)
            power = self.sets.power_w(self.sets.level_of_rate(nats))
            utility = self.utility(nats)
            surplus = np.where(self.weight > 0, surplus, -price * power)
            lost = self.hopeless | (self.utility(self.high) == -np.inf)
            return Worth(np.where(lost, -np.inf, surplus), utility, nats, power)

    def _meeting(self, price: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The level where demand meets supply, and the least of the upper bounds met on the way."""
        weight = np.where(self.weight > 0, self.weight, 1.0)
        cost = price / (self.sets.best * weight * self.bps_per_nat)
        low_bps, high_bps = (np.broadcast_to(r * self.bps_per_nat, cost.shape) for r in (self.low, self.high))

        def excess(level: FloatArray) -> tuple[FloatArray, FloatArray]:
            per_bit = cost * np.exp(level)
            worth, wanted = self.objective.conjugate(per_bit, low_bps, high_bps)
            nats = self.sets.nats(level)
            margin = np.exp(level) / self.sets.best
            rent = (margin[..., np.newaxis] * nats - np.expm1(nats) * self.sets.inverse).sum(axis=-1)
            return wanted / self.bps_per_nat - nats.sum(axis=-1), weight * worth + price * rent

        def settles(level: FloatArray) -> BoolArray:
            """Whether the rates carried at the levels come next to the bounds."""
            nats = np.clip(self.sets.rate_nats(level), self.low, self.high)
            spent = price * self.sets.power_w(self.sets.level_of_rate(nats))
            reached = weight * self.objective.utility(nats * self.bps_per_nat)
            scale = np.abs(reached) + spent + np.abs(most)
            next_to = np.isfinite(reached) & (bound - (reached - spent) <= _SHARP * scale)
            return next_to | (self.weight <= 0)

        most = weight * self.objective.utility(high_bps)
        below, above = np.zeros(cost.shape), np.broadcast_to(self.sets.top, cost.shape)
        middle = np.clip(-np.log(cost), below, above)  # exact where the utility is the rate itself
        h_below, bound = excess(below)
        h_above, other = excess(above)
        h_middle, third = excess(middle)
        bound = np.fmin(np.fmin(bound, other), third)
        settled, level = settles(middle), middle
        for _ in range(_STEPS):
            if np.all(settled):
                break
            below, h_below, above, h_above = _halved(below, h_below, above, h_above, middle, h_middle)
            centre = 0.5 * (below + above)
            h_centre, found = excess(centre)
            bound = np.fmin(bound, found)
            root = np.sqrt(h_centre**2 - h_below * h_above)
            step = (centre - below) * np.where(root > 0, h_centre / root, 0.0)
            below, h_below, above, h_above = _halved(below, h_below, above, h_above, centre, h_centre)
            before, middle = middle, np.clip(centre + step, below, above)
            h_middle, found = excess(middle)
            bound = np.fmin(bound, found)
            level = np.where(settled, level, middle)
            narrow = above - below <= _NARROW * above
            if np.all(settled | narrow | (np.abs(middle - before) <= _STILL * middle)):
                settled = settled | narrow | settles(level)
        return level, bound


def _halved(
    below: FloatArray, h_below: FloatArray, above: FloatArray, h_above: FloatArray, at: FloatArray, h_at: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The bracket of a sign change from plus to minus after a look at a point in it."""
    short = h_at > 0
    return (
        np.where(short, at, below), np.where(short, h_at, h_below),
        np.where(short, above, at), np.where(short, h_above, h_at),
    )  # fmt: skip

"""What a user can do with a set of subcarriers: its rate and power at each water level, in closed form.

With a user's best gain a₁ on its set as reference, y = ln(L a₁) ≥ 0 measures the water level L = p + 1/a, and

    ρ_n(y) = clip(y − ln(a₁/a_n), 0, m_n)  nats,      p_n = (e^ρ_n − 1)/a_n  W,

with m_n the most nats that caps, link and budget leave to a subcarrier. Rate is piecewise linear in y and power between
two knots is linear in e^y, so both inversions are exact. y keeps its digits where p·a is far below one part in 10^16,
which L does not.

Written for exhaustive search on small problems, with plain NumPy and no kernels, so that it can judge them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class OwnedSets:
    """Sets of subcarriers in the hands of users, on leading axes (…, user).

    Attributes:
        best: a₁, the user's largest gain to noise on the set in 1/W; 1 where the set holds nothing usable, (…, user).
        start: ln(a₁/a_n), where the subcarrier starts to be used, (…, user, subcarrier); 0 outside the set.
        most: m_n, the most nats that it carries; 0 outside the set.
        inverse: 1/a_n in W; 0 outside the set.
        knots: y where a subcarrier starts or is full, sorted, (…, user, 2·subcarrier).
        active: number of subcarriers filling after each knot.
        knot_nats: rate at each knot.
        top: y at which the set is full or the budget spent on it, (…, user).
    """

    best: FloatArray
    start: FloatArray
    most: FloatArray
    inverse: FloatArray
    knots: FloatArray
    active: IntArray
    knot_nats: FloatArray
    top: FloatArray

    @classmethod
    def of(
        cls, snr_per_w: FloatArray, owned: BoolArray, *, budget_w: float, cap_w: FloatArray, max_nats: float
    ) -> OwnedSets:
        """Tables for gains a (user, subcarrier) in 1/W and sets (…, 1 or user, subcarrier)."""
        used = owned & (snr_per_w > 0)
        a = np.where(used, snr_per_w, 0.0)
        best = a.max(axis=-1)
        best = np.where(best > 0, best, 1.0)
        safe = np.where(used, a, best[..., np.newaxis])
        first = best[..., np.newaxis]
        behind = (first - safe) / first
        start = np.where(behind < 0.5, -np.log1p(-np.minimum(behind, 0.5)), np.log(first) - np.log(safe))
        most = np.minimum(np.log1p(np.minimum(cap_w, budget_w) * safe), max_nats)
        start, most, inverse = np.where(used, start, 0.0), np.where(used, most, 0.0), np.where(used, 1.0 / safe, 0.0)
        knots = np.concatenate([start, start + most], axis=-1)
        step = np.concatenate([np.ones(start.shape, dtype=np.int64), -np.ones(start.shape, dtype=np.int64)], axis=-1)
        order = knots.argsort(axis=-1, kind="stable")
        knots = np.take_along_axis(knots, order, axis=-1)
        active = np.take_along_axis(step, order, axis=-1).cumsum(axis=-1)
        filled = (active[..., :-1] * np.diff(knots, axis=-1)).cumsum(axis=-1)
        knot_nats = np.concatenate([np.zeros((*filled.shape[:-1], 1)), filled], axis=-1)
        found = cls(
            best=best, start=start, most=most, inverse=inverse, knots=knots, active=active, knot_nats=knot_nats,
            top=np.zeros(best.shape),
        )  # fmt: skip
        return replace(found, top=found.level_of_power(np.full(best.shape, budget_w)))

    def pick(self, index: Any) -> OwnedSets:
        """The tables at an index into the leading axes, which keeps the user axis the last."""
        tables: dict[str, Any] = {one.name: getattr(self, one.name)[index] for one in fields(self)}
        return OwnedSets(**tables)

    def nats(self, level: FloatArray) -> FloatArray:
        """ρ_n at the levels y (…, user); shape (…, user, subcarrier)."""
        return np.clip(level[..., np.newaxis] - self.start, 0.0, self.most)

    def power_w(self, level: FloatArray) -> FloatArray:
        """Power at the levels y (…, user), same shape."""
        return (np.expm1(self.nats(level)) * self.inverse).sum(axis=-1)

    def rate_nats(self, level: FloatArray) -> FloatArray:
        """Rate at the levels y (…, user), same shape."""
        return self.nats(level).sum(axis=-1)

    def level_of_rate(self, nats: FloatArray) -> FloatArray:
        """The level y that carries ``nats`` (…, user); the last knot where the set cannot."""
        piece = np.maximum((nats[..., np.newaxis] > self.knot_nats).sum(axis=-1) - 1, 0)
        knot, before, active = (self._at(table, piece) for table in (self.knots, self.knot_nats, self.active))
        level = knot + np.maximum(nats - before, 0.0) / np.maximum(active, 1)
        return np.where(nats > 0, np.minimum(level, self.knots[..., -1]), 0.0)

    def level_of_power(self, power_w: FloatArray) -> FloatArray:
        """The level y that spends ``power_w`` (…, user); the last knot where the set cannot."""
        nats = np.clip(self.knots[..., np.newaxis] - self.start[..., np.newaxis, :], 0.0, self.most[..., np.newaxis, :])
        knot_w = (np.expm1(nats) * self.inverse[..., np.newaxis, :]).sum(axis=-1)
        piece = np.maximum((power_w[..., np.newaxis] > knot_w).sum(axis=-1) - 1, 0)
        knot, before, active = (self._at(table, piece) for table in (self.knots, knot_w, self.active))
        rise = np.maximum(power_w - before, 0.0) * self.best / np.maximum(active, 1)
        level = knot + np.log1p(rise * np.exp(-knot))
        return np.minimum(level, self.knots[..., -1])

    @staticmethod
    def _at(table: Any, piece: IntArray) -> Any:
        wide = np.broadcast_to(table, (*piece.shape, table.shape[-1]))
        return np.take_along_axis(wide, piece[..., np.newaxis], axis=-1)[..., 0]

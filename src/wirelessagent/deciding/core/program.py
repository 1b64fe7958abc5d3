"""A problem as the kernels read it: a goal, and a row of six numbers for each user.

The rows stand for power laws (:mod:`.bundle_kernel`). An objective's utility is asked for three rates around a
reference and answers with the power law that has its slope and curvature there. Utilities that are power laws, as those
of all built-in objectives without past averages, are met exactly at every rate; others near the reference, so they are
asked again where the search ended until nothing changes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray

LEAST_POWER, MOST_UTILITY, MOST_EFFICIENCY, HIGHEST_LEVEL = 0, 1, 2, 3
"""The goals, as the kernels number them."""

_STEP = 0.01
"""Of ln r, between the rates that a utility is asked for."""
_STRAIGHT = 1e-7
"""A curvature this close to 0 or 1 is 0 or 1, and the rest is rounding."""
_LEAST_REFERENCE = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Program:
    """What the kernels are asked for.

    Attributes:
        goal: one of the goals above.
        rows: low, high, reference, slope, curvature and base of each user, shape (user, 6); nats.
        share: for the highest level, each user's share and its limits in nats, shape (user, 3).
        most_level: the level beyond which nothing is gained.
        scale: what a unit of utility in the rows is worth in the objective's.
    """

    goal: int
    rows: FloatArray
    share: FloatArray
    most_level: float
    scale: float

    @classmethod
    def of(cls, form: NormalForm, reference: FloatArray | None = None) -> Program:
        """The program of a problem; ``reference`` (user,) are the rates in nats around which utilities are met."""
        low, high = form.promised_nats, np.minimum(form.most_nats, _reach(form))
        high = np.maximum(low, high)
        share = np.stack([form.weight, low, high], axis=1)
        if form.objective.joined == "min" and form.objective.measure == "utility":
            counts = form.weight > 0
            most = float(np.min(high[counts] / form.weight[counts]))
            return cls(goal=HIGHEST_LEVEL, rows=promises(low), share=share, most_level=most, scale=1.0)
        if form.objective.measure == "power":
            return cls(goal=LEAST_POWER, rows=promises(low), share=share, most_level=0.0, scale=1.0)
        if reference is None:
            reference = _even_split(form)
        reference = np.clip(reference, np.maximum(low, _LEAST_REFERENCE), np.maximum(high, _LEAST_REFERENCE))
        slope, curvature, base = _power_law(form, reference)
        scale = float(slope.max())
        if not 0.0 < scale < np.inf:
            scale = 1.0
        rows = np.stack([low, high, reference, slope / scale, curvature, base / scale], axis=1)
        goal = MOST_EFFICIENCY if form.objective.measure == "efficiency" else MOST_UTILITY
        return cls(goal=goal, rows=rows, share=share, most_level=0.0, scale=scale)

    @classmethod
    def of_promises(cls, form: NormalForm) -> Program:
        """The least power that carries the promised rates, whatever the objective is."""
        share = np.zeros((form.promised_nats.size, 3))
        return cls(goal=LEAST_POWER, rows=promises(form.promised_nats), share=share, most_level=0.0, scale=1.0)

    def meets(self, form: NormalForm, nats: FloatArray) -> bool:
        """Whether the rows are the objective's utility at the rates ``nats`` (user,), too."""
        if self.goal in (LEAST_POWER, HIGHEST_LEVEL):
            return True
        found = np.maximum(nats, _LEAST_REFERENCE)
        slope, curvature, _ = _power_law(form, found)
        _, _, reference, here, bend, _ = self.rows.T
        with np.errstate(over="ignore"):
            expected = here * self.scale * (found / reference) ** -bend
        return bool(np.all(np.abs(slope - expected) <= 1e-7 * expected) and np.all(np.abs(curvature - bend) <= 1e-3))


def promises(nats: FloatArray) -> FloatArray:
    """Rows of users who want just ``nats``, shape (user, 6)."""
    zero = np.zeros(nats.shape)
    return np.stack([nats, nats, np.maximum(nats, _LEAST_REFERENCE), zero, zero, zero], axis=1)


def _reach(form: NormalForm) -> FloatArray:
    """A rate in nats that no user exceeds alone, shape (user,): N ln(1 + P max a/N), the caps aside."""
    size = form.snr_per_w.shape[1]
    most = size * np.log1p(form.budget_w / size * form.snr_per_w.max(axis=1))
    return np.minimum(most, size * form.max_nats) if np.isfinite(form.max_nats) else most


def _even_split(form: NormalForm) -> FloatArray:
    """Rates of users who each get their share of subcarriers and power, in nats, shape (user,)."""
    users, size = form.snr_per_w.shape
    return size / users * np.log1p(form.budget_w / size * form.snr_per_w.max(axis=1))


def _power_law(form: NormalForm, reference: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Slope per nat, curvature and value of the weighted utilities at ``reference`` (user,) in nats.

    With u₋, u₀, u₊ at r e^∓h a power law has (u₊ − u₀)/(u₀ − u₋) = e^((1 − α) h).
    """
    rate = reference * form.bps_per_nat * np.exp(_STEP * np.array([[-1.0], [0.0], [1.0]]))
    below, base, above = form.objective.utility(rate)
    fall, rise = base - below, above - base
    sloped = (fall > 0) & (rise > 0)
    exponent = np.log(np.where(sloped, rise, 1.0) / np.where(sloped, fall, 1.0)) / _STEP
    exponent = np.minimum(exponent, 1.0)
    curvature = 1.0 - exponent
    curvature[np.abs(curvature) < _STRAIGHT] = 0.0
    curvature[np.abs(exponent) < _STRAIGHT] = 1.0
    exponent = 1.0 - curvature
    bent = np.where(exponent == 0.0, _STEP, np.expm1(exponent * _STEP) / np.where(exponent == 0.0, 1.0, exponent))
    slope = np.where(rise > 0, rise, 0.0) / bent / reference
    counts = form.weight > 0
    weighted = np.where(counts, form.weight * slope, 0.0), np.where(counts, form.weight * base, 0.0)
    return weighted[0], curvature, weighted[1]

"""A problem as the kernels read it: a goal, and a row of six numbers for each user.

The rows stand for power laws (:mod:`.bundle_kernel`). An objective that declares one, as all built-in objectives
without past averages do, has exactly its rows at every rate. Any other utility is asked for three rates around a
reference and gets the power law that has its slope and curvature there, and is asked again where the search ended until
nothing changes. Such rows serve to search for allocations and prove nothing: what they miss may lie between any rates.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

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
        exact: whether the rows are the objective at every rate, so that what is proven of them is proven of it.
    """

    goal: int
    rows: FloatArray
    share: FloatArray
    most_level: float
    scale: float
    exact: bool

    @classmethod
    def of(cls, form: NormalForm, reference: FloatArray | None = None) -> Program:
        """The program of a problem; ``reference`` (user,) are the rates in nats around which utilities are met."""
        if form.objective.measure == "power":
            return cls.of_promises(form)
        asked = Programs.of(form, reference)
        most_level, scale = float(asked.most_level), float(asked.scale)
        return cls(
            goal=asked.goal, rows=asked.rows, share=asked.share, most_level=most_level, scale=scale, exact=asked.exact
        )  # fmt: skip

    @classmethod
    def of_promises(cls, form: NormalForm) -> Program:
        """The least power that carries the promised rates, whatever the objective is."""
        share = np.zeros((form.promised_nats.size, 3))
        rows = promises(form.promised_nats)
        return cls(goal=LEAST_POWER, rows=rows, share=share, most_level=0.0, scale=1.0, exact=True)

    def meets(self, form: NormalForm, nats: FloatArray) -> bool:
        """Whether the rows are the objective's utility at the rates ``nats`` (user,), too."""
        return self.exact or bool(_met(form, self.rows, np.asarray(self.scale), nats))


@dataclass(frozen=True, kw_only=True, eq=False)
class Programs:
    """:class:`Program` for problems that differ in their channel alone, the form's ``snr_per_w`` (…, user, subcarrier).

    Every array has the leading axes of the channel, but for promises, which are the same for all.
    """

    goal: int
    rows: FloatArray
    share: FloatArray
    most_level: FloatArray
    scale: FloatArray
    exact: bool

    @classmethod
    def of(cls, form: NormalForm, reference: FloatArray | None = None) -> Programs:
        """The programs of problems; ``reference`` (…, user) as in :meth:`Program.of`."""
        low, reach = form.promised_nats, _reach(form)
        high = np.maximum(low, np.minimum(form.most_nats, np.minimum(reach, form.cap_w.size * form.max_nats)))
        share, one, zero = _columns(form.weight, low, high), np.ones(high.shape[:-1]), np.zeros(high.shape[:-1])
        if form.objective.joined == "min" and form.objective.measure == "utility":
            counts = form.weight > 0
            most = np.asarray(np.min(high[..., counts] / form.weight[counts], axis=-1))
            return cls(goal=HIGHEST_LEVEL, rows=promises(low), share=share, most_level=most, scale=one, exact=True)
        if form.objective.measure == "power":
            return cls(goal=LEAST_POWER, rows=promises(low), share=share, most_level=zero, scale=one, exact=True)
        if reference is None:
            reference = reach / form.weight.size  # of users who each get their share of subcarriers and power
        reference = np.clip(reference, np.maximum(low, _LEAST_REFERENCE), np.maximum(high, _LEAST_REFERENCE))
        slope, curvature, base = _rows_at(form, reference)
        scale = slope.max(axis=-1)
        scale = np.where((scale > 0.0) & (scale < np.inf), scale, one)
        unit = scale[..., np.newaxis]
        rows = _columns(low, high, reference, slope / unit, curvature, base / unit)
        goal = MOST_EFFICIENCY if form.objective.measure == "efficiency" else MOST_UTILITY
        exact = form.objective.power_law() is not None
        return cls(goal=goal, rows=rows, share=share, most_level=zero, scale=scale, exact=exact)

    @classmethod
    def of_promises(cls, form: NormalForm) -> Programs:
        """The least power that carries the promised rates, as :meth:`Program.of_promises`."""
        one = Program.of_promises(form)
        zero = np.zeros(form.snr_per_w.shape[:-2])
        return cls(goal=one.goal, rows=one.rows, share=one.share, most_level=zero, scale=zero + 1.0, exact=True)

    def at(self, chosen: IntArray | BoolArray) -> Programs:
        """Those of the ``chosen`` problems of a batch."""
        rows = self.rows[chosen] if self.rows.ndim == self.share.ndim else self.rows
        most_level, scale = self.most_level[chosen], self.scale[chosen]
        return dataclasses.replace(self, rows=rows, share=self.share[chosen], most_level=most_level, scale=scale)

    def meet(self, form: NormalForm, nats: FloatArray) -> BoolArray:
        """:meth:`Program.meets` for each problem, shape (…)."""
        if self.exact:
            return np.ones(nats.shape[:-1], dtype=bool)
        return _met(form, self.rows, self.scale, nats)


def promises(nats: FloatArray) -> FloatArray:
    """Rows of users who want just ``nats``, shape (user, 6)."""
    rows = np.zeros((nats.size, 6))
    rows[:, 0] = rows[:, 1] = nats
    rows[:, 2] = np.maximum(nats, _LEAST_REFERENCE)
    return rows


def _columns(*columns: FloatArray | float) -> FloatArray:
    """Values of (…, user), broadcast together, side by side: shape (…, user, column)."""
    shape = np.broadcast(*columns).shape
    beside = np.empty((*shape, len(columns)))
    for number, column in enumerate(columns):
        beside[..., number] = column
    return beside


def _reach(form: NormalForm) -> FloatArray:
    """A rate in nats that no user exceeds alone, shape (…, user): N ln(1 + P max a/N), all caps aside."""
    size = form.cap_w.size
    return size * np.log1p(form.budget_w / size * form.snr_per_w.max(axis=-1))


def _rows_at(form: NormalForm, reference: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Slope per nat, curvature and value of the weighted utilities at ``reference`` (…, user) in nats."""
    law = form.objective.power_law()
    if law is None:
        return _fitted(form, reference)
    weight = np.where(form.weight > 0, form.weight, 0.0)
    rate = reference * form.bps_per_nat
    slope = weight * rate**-law * form.bps_per_nat
    value = np.log(rate) if law == 1.0 else rate ** (1.0 - law) / (1.0 - law)
    return slope, np.full(reference.shape, law), np.where(weight > 0, weight * value, 0.0)


def _met(form: NormalForm, rows: FloatArray, scale: FloatArray, nats: FloatArray) -> BoolArray:
    """Whether rows (…, user, 6) have the utilities' slopes and curvatures at ``nats`` (…, user), too; shape (…)."""
    found = np.maximum(nats, _LEAST_REFERENCE)
    slope, curvature, _ = _fitted(form, found)
    reference, here, bend = rows[..., 2], rows[..., 3], rows[..., 4]
    with np.errstate(over="ignore"):
        expected = here * scale[..., np.newaxis] * (found / reference) ** -bend
    met = (np.abs(slope - expected) <= 1e-7 * expected) & (np.abs(curvature - bend) <= 1e-3)
    return np.asarray(met.all(axis=-1))


def _fitted(form: NormalForm, reference: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """:func:`_rows_at` of the power law that is nearest around ``reference``.

    With u₋, u₀, u₊ at r e^∓h a power law has (u₊ − u₀)/(u₀ − u₋) = e^((1 − α) h).
    """
    around = np.exp(_STEP * np.array([-1.0, 0.0, 1.0])).reshape(3, *(1,) * reference.ndim)
    below, base, above = form.objective.utility(reference * form.bps_per_nat * around)
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

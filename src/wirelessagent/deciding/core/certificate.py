"""From an allocation and a bound to a decision that carries its certificate."""

from __future__ import annotations

import math
from typing import TypedDict, Unpack

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import OPTIMAL_GAP, Bracket, Decision, Prices, Status
from wirelessagent.model.objective import Objective
from wirelessagent.model.rates import user_rate_bps

_ROUNDING = 1e-12
"""Value and bound are sums of many terms; up to this a value on the wrong side of its bound is on the bound."""


class Figures(TypedDict, total=False):
    """What else a decision may carry; see :class:`Decision`."""

    reason: str
    price_of_power: float
    price_of_rate: FloatArray
    needed_power_w: Bracket | None
    rate_scaling: Bracket | None
    iterations: int
    restarts: int
    prices: Prices | None


def relative_gap(value: float, bound: float) -> float:
    """|value − bound| / |bound|; 0/0 is 0, and NaN where there is no bound.

    >>> relative_gap(0.0, 0.0), relative_gap(99.0, 100.0)
    (0.0, 0.01)
    """
    if value == bound:  # infinite ones, too
        return 0.0
    distance = abs(value - bound)
    if math.isnan(distance):
        return distance
    return distance / abs(bound) if bound != 0.0 else math.inf


def certified(
    form: NormalForm, owner: IntArray, power_w: FloatArray, bound: float, **figures: Unpack[Figures]
) -> Decision:
    """The decision for an allocation that keeps every constraint; ``bound`` in the objective's unit, NaN for none.

    The value counts the users of the form's weights, so the form is that of the whole problem (see :mod:`.unserved`).
    """
    rate_bps = user_rate_bps(form.estimate.gain, owner, power_w, form.cell)
    value = form.objective.value(rate_bps, float(power_w.sum()), form.cell, form.weight)
    bound, gap, status = judged(form.objective, value, bound)
    return _decision(form, owner, power_w, rate_bps, status, value, bound, gap, figures)


def judged(objective: Objective, value: float, bound: float) -> tuple[float, float, Status]:
    """The bound, which a value beyond it by rounding alone replaces, the gap and the status of a usable allocation."""
    beyond = value - bound if objective.direction == "max" else bound - value
    if 0.0 < beyond <= _ROUNDING * abs(bound):
        bound = value
    gap = relative_gap(value, bound)
    return bound, gap, "optimal" if gap <= OPTIMAL_GAP else "feasible"


def nothing(form: NormalForm, status: Status, bound: float, **figures: Unpack[Figures]) -> Decision:
    """The decision where nothing feasible was found: nobody owns anything, and the ``reason`` says why."""
    users, subcarriers = form.estimate.num_users, form.estimate.num_subcarriers
    owner = np.full(subcarriers, -1, dtype=np.int64)
    return _decision(form, owner, np.zeros(subcarriers), np.zeros(users), status, np.nan, bound, np.nan, figures)


def _decision(
    form: NormalForm,
    owner: IntArray,
    power_w: FloatArray,
    rate_bps: FloatArray,
    status: Status,
    value: float,
    bound: float,
    gap: float,
    figures: Figures,
) -> Decision:
    return Decision(
        owner=owner,
        power_w=power_w,
        rate_bps=rate_bps,
        status=status,
        value=value,
        bound=bound,
        gap=gap,
        unit=form.objective.unit,
        method=form.method,
        problem=form.problem,
        cell=form.cell,
        user_names=form.estimate.user_names,
        **figures,
    )

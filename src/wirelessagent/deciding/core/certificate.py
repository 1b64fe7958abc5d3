"""From an allocation and a bound to a decision that carries its certificate."""

from __future__ import annotations

import math
from typing import TypedDict, Unpack

import numpy as np

from wirelessagent.deciding.core.exact_powers import to_the_last_bit
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import OPTIMAL_GAP, Bracket, Decision, Prices, Status
from wirelessagent.model.errors import PluginError, WirelessAgentError
from wirelessagent.model.objective import Objective
from wirelessagent.model.rates import user_rate_bps

_ROUNDING = 1e-12
"""Value and bound are sums of many terms; up to this a value on the wrong side of its bound is on the bound."""
_BEATEN = 1e-6
"""From here on a value beyond its bound is no rounding. Constraints are kept within 1e-9, and power answers a change of
the rates with as many times that as a subcarrier carries nats, some dozens; a sum must cancel to 1e-10 of its terms for
its rounding to show.
"""
_TRIED_BPS = np.logspace(2, 10, 33)
_STEP = 1e-4
"""Relative, of a rate, for the slope of a utility."""


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
    power_w = to_the_last_bit(form, form.estimate.gain, owner, power_w)
    rate_bps = user_rate_bps(form.estimate.gain, owner, power_w, form.cell)
    value = form.objective.value(rate_bps, float(power_w.sum()), form.cell, form.weight)
    bound, gap, status = judged(form.objective, value, bound, form.method)
    return _decision(form, owner, power_w, rate_bps, status, value, bound, gap, figures)


def judged(objective: Objective, value: float, bound: float, method: str) -> tuple[float, float, Status]:
    """The bound, moved to the safe side of a value that rounding has put beyond it; the gap; the status.

    Raises:
        PluginError: the value is better than the bound proves possible, so the objective or the method is wrong.
        WirelessAgentError: the same, with an objective of this package.
    """
    beyond = value - bound if objective.direction == "max" else bound - value
    if 0.0 < beyond <= _ROUNDING * abs(bound):
        bound = value
    elif beyond > _BEATEN * max(abs(value), abs(bound)):
        raise _beaten(objective, value, bound, method)
    elif beyond > 0.0:  # as far as it was off on the one side it may be off on the other
        bound = value + beyond if objective.direction == "max" else value - beyond
    gap = relative_gap(value, bound)
    return bound, gap, "optimal" if gap <= OPTIMAL_GAP else "feasible"


def _beaten(objective: Objective, value: float, bound: float, method: str) -> WirelessAgentError:
    """What to tell where an allocation is better than proven possible: whose fault it is, and what shows it."""
    side = "above" if objective.direction == "max" else "below"
    told = (
        f"with the objective {objective.name!r} an allocation has the value {value:.6g}, {side} the bound "
        f"{bound:.6g} of the method {method!r}, which nothing can be"
    )
    if objective.is_built_in:
        return WirelessAgentError(f"{told}. The bound of {method!r} is wrong: please report it, with the input")
    shown = _wrong_conjugate(objective)
    blamed = (
        f"The conjugate of the objective {objective.name!r} is wrong: {shown}"
        if shown
        else (
            f"Either the conjugate of the objective {objective.name!r} is too small somewhere, "
            f"or its utility is not concave, or the bound of {method!r} is wrong"
        )
    )
    return PluginError(f"{told}. {blamed}; wa.testing.ObjectiveContract checks an objective")


def _wrong_conjugate(objective: Objective) -> str:
    """A rate that is worth more at its own price than the conjugate says that any is there; empty if none was found."""
    rate = _TRIED_BPS
    with np.errstate(all="ignore"):
        utility = objective.utility(rate)
        rise = objective.utility(rate * (1.0 + _STEP)) - objective.utility(rate * (1.0 - _STEP))
        price = np.maximum(rise / (2.0 * _STEP * rate), 0.0)
        left = utility - price * rate
        most = objective.conjugate(price, np.zeros(rate.shape), np.full(rate.shape, np.inf))[0]
        short = (left - most) / (np.abs(utility) + price * rate)
    worst = int(np.argmax(np.nan_to_num(short, nan=0.0, posinf=0.0, neginf=0.0)))
    if not short[worst] > _BEATEN:
        return ""
    return (
        f"at the price {price[worst]:.4g} it says that no rate is worth more than {most[worst]:.6g}, "
        f"but u(r) − price · r is {left[worst]:.6g} at r = {rate[worst]:.4g} bit/s"
    )


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
        steps=form.limit.steps,
        method=form.method,
        problem=form.problem,
        cell=form.cell,
        user_names=form.estimate.user_names,
        **figures,
    )

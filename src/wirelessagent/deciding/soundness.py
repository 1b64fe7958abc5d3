"""What every decision must be, whichever method made it: checked once, before it leaves.

Limits are kept but for rounding, figures follow from owners and powers, no value is better than its bound, and a
decision without an allocation says why. A method that breaks this is named in an error instead of being believed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.errors import PluginError, WirelessAgentError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import RATE_TOLERANCE
from wirelessagent.model.objective import Objective
from wirelessagent.model.rates import user_rate_bps

_TOLERANCE = RATE_TOLERANCE


def checked(decision: Decision, estimate: ChannelEstimate, method: type) -> Decision:
    """The decision for the channel ``estimate``, if it is sound.

    Raises:
        PluginError: it is not, and the method is not of this package.
        WirelessAgentError: it is not.
    """
    fault = next(unsound(decision, estimate), None)
    if fault is None:
        return decision
    told = f"the decision of the method {decision.method!r} is not sound: {fault}"
    if method.__module__.split(".")[0] == __name__.split(".")[0]:
        raise WirelessAgentError(f"{told}: please report it, with the input")
    raise PluginError(f"{told}; wa.testing.MethodContract checks a method")


def unsound(decision: Decision, estimate: ChannelEstimate) -> Iterator[str]:
    """What is wrong with a decision by itself, each fault as a phrase."""
    if decision.is_usable:
        yield from _broken_limits(decision, estimate)
    else:
        yield from _wrong_refusals(decision)
    yield from _wrong_certificate(decision)


def _broken_limits(decision: Decision, estimate: ChannelEstimate) -> Iterator[str]:
    problem, owner, power = decision.problem, decision.owner, decision.power_w
    users, count = estimate.gain.shape
    if owner.shape != (count,) or power.shape != (count,) or decision.rate_bps.shape != (users,):
        yield f"owners, powers and rates have the shapes {owner.shape}, {power.shape} and {decision.rate_bps.shape}"
        return
    if not (np.isfinite(power).all() and power.min() >= 0 and owner.min() >= -1 and owner.max() < users):
        yield f"powers {power} or owners {owner} make no sense"
        return
    budget, spent = problem.budget_w(decision.cell), float(power.sum())
    if spent > budget * (1.0 + _TOLERANCE):
        yield f"{spent!r} W are above the budget of {budget!r} W"
    if problem.subcarrier_max_power_w is not None:
        caps = np.asarray(problem.subcarrier_max_power_w)
        if (power > caps * (1.0 + _TOLERANCE)).any():
            yield f"powers {power} are above the caps {caps}"
    if power[owner < 0].any():
        yield "power goes to nobody"
    if problem.forbidden is not None or problem.users is not None:
        owned = np.flatnonzero(owner >= 0)
        if problem.forbidden is not None and problem.forbidden[owner[owned], owned].any():
            yield f"owners {owner} hold forbidden subcarriers"
        if not problem.serves(users)[owner[owned]].all():
            yield f"owners {owner} are not all served"
    size = problem.resource_block_group_size
    if size > 1 and any(np.ptp(owner[at : at + size]) for at in range(0, count, size)):
        yield f"owners {owner} split a group of {size}"
    yield from _broken_rates(decision, estimate)


def _broken_rates(decision: Decision, estimate: ChannelEstimate) -> Iterator[str]:
    """Rates that are not those of the allocation, or are not within their limits; the value that follows from them.

    With an outage probability the rates are what is promised, which is less than what the estimate carries.
    """
    problem, cell, rate = decision.problem, decision.cell, decision.rate_bps
    if not decision.outage.size:
        carried = user_rate_bps(estimate.gain, decision.owner, decision.power_w, cell)
        if (np.abs(rate - carried) > _TOLERANCE * carried).any():
            yield f"rates are {rate}, but owners and powers give {carried}"
    if problem.min_rate_bps is not None:
        least = np.where(problem.serves(rate.size), problem.min_rates_bps(rate.size), 0.0)
        if (rate < least * (1.0 - _TOLERANCE)).any():
            yield f"rates {rate} fall short of the promised {least}"
    if problem.max_rate_bps is not None and (rate > problem.max_rates_bps(rate.size) * (1.0 + _TOLERANCE)).any():
        yield f"rates {rate} are above {problem.max_rates_bps(rate.size)}"
    all_alike = problem.weights is None and problem.users is None
    weight = None if all_alike else problem.weights_of(rate.size)
    value = _objective(decision).value(rate, decision.total_power_w, cell, weight)
    if decision.value != value and not abs(decision.value - value) <= _TOLERANCE * abs(value):
        yield f"the value is {decision.value!r}, but the objective says {value!r}"


def _wrong_refusals(decision: Decision) -> Iterator[str]:
    if decision.power_w.any() or decision.rate_bps.any() or not np.isnan(decision.value):
        yield f"it is {decision.status}, but has the value {decision.value!r} and the powers {decision.power_w}"
    if not decision.reason:
        yield f"it is {decision.status} without a reason"


def _wrong_certificate(decision: Decision) -> Iterator[str]:
    value, bound, gap = decision.value, decision.bound, decision.gap
    beyond = bound - value if _objective(decision).direction == "min" else value - bound
    if beyond > _TOLERANCE * abs(bound):
        yield f"the value {value!r} is beyond its bound {bound!r}"
    if decision.is_usable and np.isnan(gap) and not np.isnan(bound):
        yield f"the gap from {value!r} to {bound!r} is NaN"
    if decision.status == "optimal" and not gap <= OPTIMAL_GAP:
        yield f"it is optimal with a gap of {gap!r}"
    needed = decision.needed_power_w
    if needed is not None and needed.at_least > needed.at_most * (1.0 + _TOLERANCE):
        yield f"at least {needed.at_least!r} W and at most {needed.at_most!r} W are said to be needed"


def _objective(decision: Decision) -> Objective:
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    return objective

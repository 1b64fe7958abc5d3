"""What is wrong with a decision on a small problem, in the light of exhaustive search.

case = random_problem(seed, objective)
decision = method.solve(case.estimate, case.problem, case.cell)
assert not faults(decision, case.estimate, verdict_on(case.estimate, case.problem, case.cell))
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.testing.contract import TOLERANCE
from wirelessagent.testing.exhaustive import BestAllocation, best_allocation, least_power_w

_LIMITS_SLACK = 1e-6
"""Relative; what the accepted 1e-9 of a promised rate is worth in value at most."""


class Verdict(NamedTuple):
    """What exhaustive search says of a problem: the best allocation, None if there is none, and the power needed."""

    best: BestAllocation | None
    needed_w: float


def verdict_on(estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Verdict:
    """The verdict of exhaustive search; see :func:`best_allocation` for what it refuses."""
    return Verdict(best_allocation(estimate, problem, cell), least_power_w(estimate, problem, cell))


def faults(decision: Decision, estimate: ChannelEstimate, verdict: Verdict | None = None) -> list[str]:
    """Every fault as one sentence: limits broken, bounds beaten, wrong statuses, values out of reach.

    Without a verdict, what the decision itself shows.
    """
    found = list(_broken_limits(decision, estimate) if decision.is_usable else _wrong_refusals(decision))
    found += _wrong_certificate(decision)
    return found if verdict is None else [*found, *_refuted(decision, verdict), *_wrong_brackets(decision, verdict)]


def shortfall(decision: Decision, verdict: Verdict) -> float:
    """How far the value is from the best one, relative to it; 0/0 is 0, NaN without a value."""
    if verdict.best is None or not decision.is_usable:
        return np.nan
    if decision.value == verdict.best.value:
        return 0.0
    away = abs(decision.value - verdict.best.value)
    return away / abs(verdict.best.value) if verdict.best.value else np.inf


def _better(decision: Decision, value: float, than: float, tolerance: float = TOLERANCE) -> bool:
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    gain = than - value if objective.direction == "min" else value - than
    return bool(gain > tolerance * abs(than))


def _broken_limits(decision: Decision, estimate: ChannelEstimate) -> Iterator[str]:
    """Limits not kept to one part in 10^9, and figures that do not follow from owners and powers."""
    problem, cell, owner, power = decision.problem, decision.cell, decision.owner, decision.power_w
    users, count = estimate.gain.shape
    if not (np.all(np.isfinite(power)) and np.all(power >= 0) and np.all((owner >= -1) & (owner < users))):
        yield f"powers {power} or owners {owner} make no sense"
        return
    budget = problem.budget_w(cell)
    if power.sum() > budget * (1 + TOLERANCE):
        yield f"{power.sum()!r} W are above the budget of {budget!r} W"
    caps = np.asarray(np.inf if problem.subcarrier_max_power_w is None else problem.subcarrier_max_power_w, dtype=float)
    if np.any(power > caps * (1 + TOLERANCE)):
        yield f"powers {power} are above the caps {caps}"
    owned = np.flatnonzero(owner >= 0)
    if power[owner < 0].any():
        yield "power goes to nobody"
    if problem.forbidden is not None and problem.forbidden[owner[owned], owned].any():
        yield f"owners {owner} hold forbidden subcarriers"
    if not problem.serves(users)[owner[owned]].all():
        yield f"owners {owner} are not all served"
    size = problem.resource_block_group_size
    if any(np.ptp(owner[at : at + size]) for at in range(0, count, size)):
        yield f"owners {owner} split a group of {size}"
    yield from _broken_rates(decision, estimate)


def _broken_rates(decision: Decision, estimate: ChannelEstimate) -> Iterator[str]:
    problem, cell = decision.problem, decision.cell
    users = estimate.num_users
    rate = user_rate_bps(estimate.gain, decision.owner, decision.power_w, cell)
    if not np.allclose(decision.rate_bps, rate, rtol=TOLERANCE, atol=0.0):
        yield f"rates are {decision.rate_bps}, but owners and powers give {rate}"
    least = np.where(problem.serves(users), problem.min_rates_bps(users), 0.0)
    if np.any(rate < least * (1 - TOLERANCE)):
        yield f"rates {rate} fall short of the promised {least}"
    if np.any(rate > problem.max_rates_bps(users) * (1 + TOLERANCE)):
        yield f"rates {rate} are above {problem.max_rates_bps(users)}"
    objective = problem.objective
    assert isinstance(objective, Objective)
    value = objective.value(rate, decision.total_power_w, cell, problem.weights_of(users))
    if decision.value != value and not abs(decision.value - value) <= TOLERANCE * abs(value):
        yield f"the value is {decision.value!r}, but the objective says {value!r}"


def _wrong_refusals(decision: Decision) -> Iterator[str]:
    if decision.power_w.any() or decision.rate_bps.any() or not np.isnan(decision.value):
        yield f"it is {decision.status}, but has the value {decision.value!r} and the powers {decision.power_w}"
    if not decision.reason:
        yield f"it is {decision.status} without a reason"


def _wrong_certificate(decision: Decision) -> Iterator[str]:
    value, bound, gap = decision.value, decision.bound, decision.gap
    if _better(decision, value, bound):
        yield f"the value {value!r} is beyond its bound {bound!r}"
    if decision.is_usable and np.isnan(gap) and not np.isnan(bound):
        yield f"the gap from {value!r} to {bound!r} is NaN"
    if decision.status == "optimal" and not gap <= OPTIMAL_GAP:
        yield f"it is optimal with a gap of {gap!r}"
    needed = decision.needed_power_w
    if needed is not None and needed.at_least > needed.at_most * (1 + TOLERANCE):
        yield f"at least {needed.at_least!r} W and at most {needed.at_most!r} W are said to be needed"


def _refuted(decision: Decision, verdict: Verdict) -> Iterator[str]:
    bound, value, budget = decision.bound, decision.value, decision.problem.budget_w(decision.cell)
    if decision.status == "infeasible" and verdict.needed_w <= budget * (1 - TOLERANCE):
        yield f"it is infeasible, but {verdict.needed_w!r} W carry the promised rates within {budget!r} W"
    if decision.is_usable and verdict.needed_w > budget * (1 + TOLERANCE):
        yield f"it is {decision.status}, but no allocation keeps the limits"
    if verdict.best is None:
        return
    best = verdict.best.value
    if _better(decision, best, bound):
        yield f"the bound {bound!r} is beaten by {best!r}, owners {verdict.best.owner}"
    if decision.status == "optimal" and _better(decision, best, value):
        yield f"the optimal {value!r} is beaten by {best!r}, owners {verdict.best.owner}"
    if decision.is_usable and _better(decision, value, verdict.best.at_best, _LIMITS_SLACK):
        yield f"the value {value!r} is better than that of every allocation, {best!r}"


def _wrong_brackets(decision: Decision, verdict: Verdict) -> Iterator[str]:
    """Needed powers that exhaustive search contradicts; it knows them near the budget and below."""
    needed = decision.needed_power_w
    if needed is None or not np.isfinite(verdict.needed_w):
        return
    if needed.at_least > verdict.needed_w * (1 + TOLERANCE):
        yield f"at least {needed.at_least!r} W are said to be needed, but {verdict.needed_w!r} W do"
    if needed.at_most < verdict.needed_w * (1 - _LIMITS_SLACK):
        yield f"at most {needed.at_most!r} W are said to be needed, but no less than {verdict.needed_w!r} W do"

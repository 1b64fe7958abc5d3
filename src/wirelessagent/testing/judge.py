"""What is wrong with a decision on a small problem, in the light of exhaustive search.

case = random_problem(seed, objective)
decision = method.solve(case.estimate, case.problem, case.cell)
assert not faults(decision, case.estimate, verdict_on(case.estimate, case.problem, case.cell))
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.soundness import unsound
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
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
    found = list(unsound(decision, estimate))
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

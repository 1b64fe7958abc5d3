"""What power a larger value takes: the least budget at which a problem is worth as much, by solving it again and again.

The value never falls with the budget, and is nearly straight in its logarithm, so few budgets have to be tried.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent import chain
from wirelessagent.model.decision import Decision
from wirelessagent.model.problem import Problem
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.steps import Step

_ACCURACY = 1e-3
_FARTHEST = 1e4
"""How many times more or less than the budget is tried."""
_STRIDE = 4.0
_NOTHING = 1e-9


@dataclass(frozen=True, kw_only=True)
class Reach:
    """The power that a value takes.

    Attributes:
        target: the value that is to be reached, in the decision's unit.
        power_w: the least budget, within 0.1 %, at which the method reaches it; NaN where none that was tried does.
        tried_w: the budget that was tried last.
        limit_w: the cell's limit where the power exceeds it; NaN elsewhere.
    """

    target: float
    power_w: float
    tried_w: float
    limit_w: float = np.nan


def has_reach(case: Case) -> bool:
    """Whether the value is a rate, which power buys."""
    return case.objective.direction == "max" and case.decision.unit == "bit/s" and case.decision.is_usable


def for_the_total(case: Case) -> Case:
    """The case of the highest total rate under the same limits: what a total takes at least, whatever the aim is."""
    problem = chain.resolve(dataclasses.replace(case.problem, objective="max_rate", weights=None))
    return dataclasses.replace(case, decision=case.otherwise(problem), method=None, options={})


def kept_by(case: Case, step: Step) -> Reach | None:
    """What power would keep the value where it was in spite of what more is promised; None where that is no matter."""
    if step.of_power or not has_reach(case) or step.change >= -_NOTHING * abs(step.before.value):
        return None
    found = reach(case, step.before.value, step.problem)
    return None if np.isnan(found.power_w) else found


def reach(case: Case, target: float, problem: Problem | None = None) -> Reach:
    """The power at which a case's problem, or another one on its channel, is worth ``target``."""
    problem, budget = problem or case.problem, case.problem.budget_w(case.cell)
    found: dict[float, float] = {}

    def short(log_power: float) -> float:
        if log_power not in found:
            decision = _with_budget(case, problem, float(np.exp(log_power)))
            found[log_power] = (decision.value if decision.is_usable else 0.0) / target - 1.0
        return found[log_power]

    from scipy.optimize import brentq  # a quarter of a second, and few ask for this

    low = high = float(np.log(budget))
    farthest, stride = float(np.log(_FARTHEST)), float(np.log(_STRIDE))
    while short(high) < 0.0:
        if high - np.log(budget) > farthest:
            return Reach(target=target, power_w=np.nan, tried_w=float(np.exp(high)))
        low, high = high, high + stride
    while short(low) >= 0.0:
        if np.log(budget) - low > farthest:
            break
        low, high = low - stride, low
    root = high if short(low) >= 0.0 else float(brentq(short, low, high, xtol=_ACCURACY, rtol=_ACCURACY))
    power, most = float(np.exp(root)), case.cell.max_power_w
    return Reach(target=target, power_w=power, tried_w=power, limit_w=most if power > most else np.nan)


def _with_budget(case: Case, problem: Problem, power_w: float) -> Decision:
    """The decision with another budget, which may be beyond the cell's limit."""
    cell = dataclasses.replace(case.cell, max_power_w=max(power_w, case.cell.max_power_w))
    return case.solved(dataclasses.replace(problem, max_power_w=power_w), cell)

"""Finite steps, by solving the problem anew: what a watt more, or a higher promise, really changes.

The marginal price is the slope of the bound at the problem as it is; sets change in whole subcarriers, so a finite step
is another decision with a bound of its own. As the old allocation still keeps a looser problem, the better of the two
counts there.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.problem import Problem
from wirelessagent.telling.facts.case import Case

_AT_THE_CEILING = 1e-6


@dataclass(frozen=True, kw_only=True)
class Step:
    """A problem that differs by a step, and its decision.

    Attributes:
        before, after: the decisions.
        step: what was added, in W or bit/s.
        level: what the step leads to: the budget in W, or the promised rate in bit/s (of the user, or the lowest).
        user: whom more is promised; None for the budget, or for everybody.
        of_power: whether it is one of the budget, or of what is promised.
        limit_w: the cell's limit where the budget would exceed it; NaN elsewhere. The step is solved all the same.
    """

    before: Decision
    after: Decision
    step: float
    level: float
    user: int | None
    of_power: bool
    limit_w: float = np.nan

    @property
    def problem(self) -> Problem:
        """What was solved after the step."""
        return self.after.problem

    @property
    def change(self) -> float:
        """Change of the value; NaN where either problem has no allocation."""
        return self.value_after - self.before.value

    @property
    def value_after(self) -> float:
        """The better of both values where the old allocation still keeps the new problem."""
        looser = self.step >= 0 if self.of_power else self.step <= 0
        if not looser or not self.before.is_usable:
            return self.after.value
        better = np.fmin if self._falls else np.fmax
        return float(better(self.before.value, self.after.value))

    @property
    def most_change(self) -> float:
        """The most that the value can improve by, proven by the bound after the step; NaN without one."""
        return self.after.bound - self.before.value

    @property
    def _falls(self) -> bool:
        objective = self.before.problem.objective
        return not isinstance(objective, str) and objective.direction == "min"


def power_step(case: Case, step_w: float) -> Step | None:
    """The budget raised by ``step_w``, or lowered; None where nothing is left of it.

    A budget beyond the cell's limit is solved as if the cell allowed it.
    """
    before = case.problem.budget_w(case.cell)
    budget = before + step_w
    if not budget > 0:
        return None
    cell, limit = case.cell, np.nan
    if budget > cell.max_power_w * (1 + 1e-12):
        cell, limit = dataclasses.replace(cell, max_power_w=budget), cell.max_power_w
    after = case.solved(dataclasses.replace(case.problem, max_power_w=budget), cell)
    return Step(
        before=case.decision,
        after=after,
        step=step_w,
        level=budget,
        user=None,
        of_power=True,
        limit_w=limit,
    )


def rate_step(case: Case, step_bps: float, user: int | None = None) -> Step:
    """``step_bps`` more promised to a user than it gets now or was promised, or than was promised to everybody."""
    users = np.flatnonzero(case.served) if user is None else np.array([user])
    now = case.promised_bps if user is None else np.maximum(case.promised_bps, case.decision.rate_bps)
    promised = case.promised_bps.copy()
    promised[users] = np.maximum(now[users] + step_bps, 0.0)
    return _promised(case, promised, users, step_bps)


def promise_step(case: Case, user: int, rate_bps: float) -> Step:
    """A minimum rate for a user, whatever was promised to it before."""
    promised = case.promised_bps.copy()
    step, promised[user] = rate_bps - float(promised[user]), rate_bps
    return _promised(case, promised, np.array([user]), step)


@dataclass(frozen=True, kw_only=True)
class WithoutCeilings:
    """Users who have all that they may have, and the decision if they might have more."""

    users: tuple[int, ...]
    decision: Decision


def without_ceilings(case: Case) -> WithoutCeilings | None:
    """What those who have all that they may have would get; None where nobody has."""
    decision, most = case.decision, case.problem.max_rates_bps(case.num_users)
    full = np.flatnonzero(case.served & np.isfinite(most) & (decision.rate_bps >= most * (1 - _AT_THE_CEILING)))
    if not full.size:
        return None
    without = most.copy()
    without[full] = np.inf
    limited = bool(np.isfinite(without).any())
    problem = dataclasses.replace(case.problem, max_rate_bps=without if limited else None)
    return WithoutCeilings(users=tuple(int(user) for user in full), decision=case.otherwise(problem))


def _promised(case: Case, promised: FloatArray, users: IntArray, step: float) -> Step:
    """The step to the rates ``promised`` (user,), of which ``users`` (number,) are promised ``step`` more."""
    after = case.solved(_carrying(case.problem, promised, case.num_users))
    return Step(
        before=case.decision,
        after=after,
        step=step,
        level=float(promised[users].min()),
        user=int(users[0]) if users.size == 1 else None,
        of_power=False,
    )


def _carrying(problem: Problem, promised: FloatArray, users: int) -> Problem:
    """The problem with these promises; a ceiling below a promise gives way to it."""
    most = problem.max_rates_bps(users)
    ceiling = None if problem.max_rate_bps is None else np.maximum(most, promised)
    return dataclasses.replace(problem, min_rate_bps=promised, max_rate_bps=ceiling)

"""What more of something changes: at the margin, by prices; and by finite steps, by solving the problem anew.

Marginal prices are the slopes of the dual bound: how the best value changes per watt more, and per bit/s more promised
to each user. A decision of a method that knows no prices is given those of the dual for the same problem: they speak of
the problem, not of the allocation. Sets change in whole subcarriers, so a finite step is another decision with a bound
of its own. As the old allocation still keeps a looser problem, the better of the two counts there.

What power a larger value takes is the least budget at which a problem is worth as much, by solving it again and again:
the value never falls with the budget, and is nearly straight in its logarithm, so few budgets have to be tried.
"""

from __future__ import annotations

import dataclasses
import functools
from dataclasses import dataclass

import numpy as np

from wirelessagent import chain
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.problem import Problem
from wirelessagent.telling.facts.case import Case, objective_of

_NOTHING = 1e-9
"""A share of the value that is no change of it."""
_AT_THE_CEILING = 1e-6
_ACCURACY = 1e-3
_FARTHEST = 1e4
"""How many times more or less than the budget is tried."""
_STRIDE = 4.0


@dataclass(frozen=True, kw_only=True, eq=False)
class MarginalPrices:
    """Slopes of the bound.

    Attributes:
        power: change of the best value per watt more, in the value's unit per W; NaN if not known.
        rate: change per bit/s more promised to each user, shape (user,), NaN if not known. Positive where what is to be
            small grows, negative where what is to be large shrinks, 0 for a promise that does not bind.
    """

    power: float
    rate: FloatArray


def marginal_prices(case: Case) -> MarginalPrices:
    """The prices of a case's problem on the channel that counts."""
    decision = case.decision
    power, rate = decision.price_of_power, decision.price_of_rate
    if np.isnan(power) or (not rate.size and case.promised_bps.any()):
        power = case.priced.price_of_power if np.isnan(power) else power
        rate = rate if rate.size else case.priced.price_of_rate
    if not rate.size:
        rate = np.full(case.num_users, np.nan if case.promised_bps.any() else 0.0)
    return MarginalPrices(power=power, rate=rate)


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
    user: int | None = None
    of_power: bool = False
    limit_w: float = np.nan

    @property
    def change(self) -> float:
        """Change of the value; NaN where either problem has no allocation."""
        return self.value_after - self.before.value

    @property
    def changes_nothing(self) -> bool:
        """Whether the value is the same after the step."""
        return abs(self.change) <= _NOTHING * abs(self.before.value)

    @property
    def value_after(self) -> float:
        """The better of both values where the old allocation still keeps the new problem."""
        looser = self.step >= 0 if self.of_power else self.step <= 0
        if not looser or not self.before.is_usable:
            return self.after.value
        better = np.fmin if objective_of(self.before).direction == "min" else np.fmax
        return float(better(self.before.value, self.after.value))

    @property
    def most_change(self) -> float:
        """The most that the value can improve by, proven by the bound after the step; NaN without one."""
        return self.after.bound - self.before.value


def power_step(case: Case, step_w: float) -> Step | None:
    """The budget raised by ``step_w``, or lowered; None where nothing is left of it.

    A budget beyond the cell's limit is solved as if the cell allowed it.
    """
    budget = case.problem.budget_w(case.cell) + step_w
    if not budget > 0:
        return None
    cell = case.radiating(budget)
    limit_w = np.nan if cell is case.cell else case.cell.max_power_w
    after = case.solved(case.but(max_power_w=budget), cell)
    return Step(before=case.decision, after=after, step=step_w, level=budget, of_power=True, limit_w=limit_w)


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


def _promised(case: Case, promised: FloatArray, users: IntArray, step: float) -> Step:
    """The step to the rates ``promised`` (user,), of which ``users`` (number,) are promised ``step`` more.

    A ceiling below a promise gives way to it.
    """
    most = case.problem.max_rates_bps(case.num_users)
    ceiling = None if case.problem.max_rate_bps is None else np.maximum(most, promised)
    after = case.solved(case.but(min_rate_bps=promised, max_rate_bps=ceiling))
    user = int(users[0]) if users.size == 1 else None
    return Step(before=case.decision, after=after, step=step, level=float(promised[users].min()), user=user)


def without_ceilings(case: Case) -> tuple[tuple[int, ...], Decision | None]:
    """Who has all that it may have, and the decision if they might have more; None where nobody has."""
    decision, most = case.decision, case.problem.max_rates_bps(case.num_users)
    full = np.flatnonzero(case.served & np.isfinite(most) & (decision.rate_bps >= most * (1 - _AT_THE_CEILING)))
    if not full.size:
        return (), None
    without = most.copy()
    without[full] = np.inf
    limited = bool(np.isfinite(without).any())
    return tuple(full.tolist()), case.otherwise(case.but(max_rate_bps=without if limited else None))


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
    return not case.falls and case.decision.unit == "bit/s" and case.decision.is_usable


def for_the_total(case: Case) -> Case:
    """The case of the highest total rate under the same limits: what a total takes at least, whatever the aim is."""
    problem = chain.resolve(case.but(objective="max_rate", weights=None))
    return dataclasses.replace(case, decision=case.otherwise(problem), method=None, options={})


def kept_by(case: Case, step: Step) -> Reach | None:
    """What power would keep the value where it was in spite of what more is promised; None where that is no matter."""
    if step.of_power or not has_reach(case) or step.change >= -_NOTHING * abs(step.before.value):
        return None
    found = reach(case, step.before.value, step.after.problem)
    return None if np.isnan(found.power_w) else found


def reach(case: Case, target: float, problem: Problem | None = None) -> Reach:
    """The power at which a case's problem, or another one on its channel, is worth ``target``."""

    @functools.cache
    def short(log_power: float) -> float:
        power_w = float(np.exp(log_power))
        at_power = dataclasses.replace(problem or case.problem, max_power_w=power_w)
        decision = case.solved(at_power, case.radiating(power_w))
        return (decision.value if decision.is_usable else 0.0) / target - 1.0

    from scipy.optimize import brentq  # a quarter of a second, and few ask for this

    low = high = budget = float(np.log(case.problem.budget_w(case.cell)))
    farthest, stride = float(np.log(_FARTHEST)), float(np.log(_STRIDE))
    while short(high) < 0.0:
        if high - budget > farthest:
            return Reach(target=target, power_w=np.nan, tried_w=float(np.exp(high)))
        low, high = high, high + stride
    while short(low) >= 0.0 and budget - low <= farthest:
        low, high = low - stride, low
    root = high if short(low) >= 0.0 else float(brentq(short, low, high, xtol=_ACCURACY, rtol=_ACCURACY))
    power, most = float(np.exp(root)), case.cell.max_power_w
    return Reach(target=target, power_w=power, tried_w=power, limit_w=most if power > most else np.nan)

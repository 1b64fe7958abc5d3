"""What the objective is to be better than: the current value, where that can be asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.decision import OPTIMAL_GAP
from wirelessagent.model.outcome import Outcome
from wirelessagent.standards.subject import ENERGY_CONSUMPTION, Metric, Subject

_ROUNDING = 1e-6
"""Share by which figures that were read back may be off."""


@dataclass(frozen=True, kw_only=True)
class Baseline:
    """What the objective's target is.

    Attributes:
        wanted: the figure to beat, in the metric's unit.
        strict: whether ``wanted`` itself does not do.
        called: what it stands for.
    """

    wanted: float
    strict: bool
    called: str


def baseline(subject: Subject, metric: Metric) -> Baseline:
    """Better than what was there before; than nothing, or than the budget drawn in full, where that is no measure.

    What was there before is no measure where it breaks a limit of the request: nothing might be better within it. Where
    it is what was decided on now, or where the bound proves nothing to be better, it is to be no worse.
    """
    before = subject.before() if subject.current is not None and keeps_limits(subject, subject.current) else None
    current = None if before is None else metric.of(subject, before, subject.served)
    if current is not None and np.isfinite(current):
        beaten = not _is_unchanged(subject) and not _is_unbeatable(subject, metric, current)
        return Baseline(wanted=current, strict=beaten, called="current value")
    if metric is ENERGY_CONSUMPTION:
        most = subject.energy_kwh(subject.decision.problem.budget_w(subject.cell))
        return Baseline(wanted=most, strict=True, called="the power budget in full")
    return Baseline(wanted=0.0, strict=True, called="nothing")


def keeps_limits(subject: Subject, outcome: Outcome) -> bool:
    """Whether an allocation that was read back breaks no limit of the request."""
    problem, users, subcarriers = subject.decision.problem, outcome.promised_bps.size, outcome.owner.size
    if (users, subcarriers) != (subject.decision.rate_bps.size, subject.decision.owner.size):
        return False
    used = np.flatnonzero((outcome.power_w > 0) & (outcome.owner >= 0))
    owner, loose = outcome.owner[used], 1.0 + _ROUNDING
    cap = np.inf if problem.subcarrier_max_power_w is None else np.asarray(problem.subcarrier_max_power_w)
    least = np.where(subject.served, problem.min_rates_bps(users), 0.0)
    return bool(
        outcome.power_w.sum() <= problem.budget_w(subject.cell) * loose
        and np.all(outcome.power_w <= cap * loose)
        and np.all(subject.served[owner])
        and np.all(problem.allows((users, subcarriers))[owner, used])
        and np.all(outcome.promised_bps * loose >= least)
        and np.all(outcome.promised_bps <= problem.max_rates_bps(users) * loose)
        and _whole_groups(outcome, problem.resource_block_group_size)
    )


def _whole_groups(outcome: Outcome, size: int) -> bool:
    """Whether no two users share a resource-block group."""
    start = np.arange(0, outcome.owner.size, size)
    in_use = outcome.power_w > 0
    highest = np.maximum.reduceat(np.where(in_use, outcome.owner, -1), start)
    lowest = np.minimum.reduceat(np.where(in_use, outcome.owner, np.iinfo(np.int64).max), start)
    return bool(np.all((highest < 0) | (highest == lowest)))


def _is_unchanged(subject: Subject) -> bool:
    """Whether what is in effect is what there was before."""
    now, before = subject.outcome, subject.current
    if now is None or before is None:
        return False
    same = np.allclose(now.power_w, before.power_w, rtol=0.0, atol=_ROUNDING * float(before.power_w.sum()))
    return same and np.array_equal(now.owner[now.power_w > 0], before.owner[now.power_w > 0])


def _is_unbeatable(subject: Subject, metric: Metric, current: float) -> bool:
    """Whether the decision's bound, in the metric's unit, proves that nothing is better than the current value.

    A bound is rounded outward, so that it proves this to the gap at which a decision counts as optimal.
    """
    decision = subject.decision
    if not np.isfinite(decision.bound):
        return False
    bound = metric.of_figure(subject, decision.bound)
    room = current - bound if metric is ENERGY_CONSUMPTION else bound - current
    return room <= OPTIMAL_GAP * abs(bound)

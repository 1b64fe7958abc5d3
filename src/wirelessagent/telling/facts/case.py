"""A decision with all that it was made from, to be asked "what if it were otherwise": every answer is solved anew.

And how it is proven, by what bound, and what that leaves open; how sure it is of the channel; what is expected of it on
the true channel, and what knowing every gain, or no groups, would have made.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.expected import counted_on
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import LinkMetrics, jain_index, metrics_of_rates
from wirelessagent.model.objective import Objective
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem

_ROUNDING = 1e-9

BAND = (0.05, 0.95)
"""The 90 % band of what is uncertain."""


def objective_of(decision: Decision) -> Objective:
    """What a decision was made for."""
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    return objective


def in_use(allocation: Decision | Outcome) -> IntArray:
    """The owner of each subcarrier that carries power, −1 elsewhere, shape (subcarrier,)."""
    return np.where(allocation.power_w > 0, allocation.owner, -1)


@dataclass(frozen=True, kw_only=True)
class Case:
    """What a decision was made from.

    Attributes:
        decision: the decision.
        estimate: the channel that it was made for.
        method: the method's name; None for the objective's own choice.
        options: the method's.
    """

    decision: Decision
    estimate: ChannelEstimate
    method: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict[str, Any])

    @property
    def problem(self) -> Problem:
        return self.decision.problem

    @property
    def cell(self) -> Cell:
        return self.decision.cell

    @property
    def objective(self) -> Objective:
        return objective_of(self.decision)

    @property
    def num_users(self) -> int:
        return self.estimate.num_users

    @functools.cached_property
    def served(self) -> BoolArray:
        """True for the users to serve, shape (user,)."""
        return self.problem.serves(self.num_users)

    @property
    def falls(self) -> bool:
        """Whether the value is to be small."""
        return self.objective.direction == "min"

    def named(self, users: Iterable[int]) -> tuple[str, ...]:
        """Users, given as indices, as a request names them."""
        return tuple(self.estimate.user_names[user] for user in users)

    @functools.cached_property
    def promised_bps(self) -> FloatArray:
        """The rate that each served user must get, shape (user,)."""
        return np.where(self.served, self.problem.min_rates_bps(self.num_users), 0.0)

    @property
    def spends_all(self) -> bool:
        """Whether the whole budget is used."""
        return self.decision.total_power_w >= self.problem.budget_w(self.cell) * (1 - _ROUNDING)

    def own(self, user: int) -> BoolArray:
        """True for the subcarriers that carry power of a user, shape (subcarrier,)."""
        return in_use(self.decision) == user

    @functools.cached_property
    def used(self) -> IntArray:
        """The subcarriers that carry power, from 0."""
        return np.flatnonzero(in_use(self.decision) >= 0)

    @functools.cached_property
    def spent_w(self) -> FloatArray:
        """The power that is radiated to each user, shape (user,)."""
        owner, power_w = self.decision.owner[self.used], self.decision.power_w[self.used]
        return np.asarray(np.bincount(owner, weights=power_w, minlength=self.num_users), dtype=np.float64)

    @property
    def rate_bps(self) -> FloatArray:
        """What each user gets as tables tell it, shape (user,): what is promised with an outage probability, else what
        the true channel is expected to carry.
        """
        decision = self.decision
        if decision.expected_rate_bps.size or decision.forecast is None:
            return decision.rate_bps
        return decision.forecast.mean_bps

    @functools.cached_property
    def counted(self) -> ChannelEstimate:
        """The channel that counts, as if it were certain.

        Uncertain gains count by their mean rates where nothing is promised, and with an outage probability by what they
        stay below with that probability: what a promise on one of them may rest on.
        """
        outage, estimate = self.problem.outage_probability, self.estimate
        if outage is None:
            return counted_on(estimate, self.problem, self.cell)
        unsure = estimate.gain_variance > 0
        gain = np.where(unsure, estimate.posterior.quantile(outage), estimate.gain)
        return dataclasses.replace(
            estimate, gain=np.maximum(gain, 0.0), gain_variance=np.zeros(gain.shape), joint_posterior=None
        )

    @functools.cached_property
    def plain(self) -> Problem:
        """The problem without its outage probability, for :attr:`counted`."""
        return self.but(outage_probability=None)

    @functools.cached_property
    def form(self) -> NormalForm:
        """The problem on the channel that counts, in the terms of the methods."""
        return NormalForm.of(Dual(), self.counted, self.plain, self.cell)

    @functools.cached_property
    def priced(self) -> Decision:
        """The decision of the dual on the channel that counts with nothing searched, for its bound and its prices."""
        return chain.decide(self.counted, self.plain, self.cell, "dual", restarts=0)

    def but(self, **changes: Any) -> Problem:
        """The problem with other fields."""
        return dataclasses.replace(self.problem, **changes)

    def radiating(self, power_w: float) -> Cell:
        """The cell, as if it allowed a power that is beyond its limit."""
        within = power_w <= self.cell.max_power_w * (1 + 1e-12)
        return self.cell if within else dataclasses.replace(self.cell, max_power_w=power_w)

    def solved(self, problem: Problem, cell: Cell | None = None) -> Decision:
        """The same method's decision on the same channel for another problem, or another cell.

        It is the default method's where that one does not solve the other problem.
        """
        try:
            return chain.decide(self.estimate, problem, cell or self.cell, self.method, **self.options)
        except UnsupportedProblemError:
            return self.otherwise(problem, cell)

    def otherwise(self, problem: Problem, cell: Cell | None = None, **options: Any) -> Decision:
        """The default method's decision on the same channel for another problem: it proves and prices the most."""
        return chain.decide(self.estimate, problem, cell or self.cell, "dual", **options)


Proof: TypeAlias = Literal["closed_form", "bound", "nothing", "infeasible", "undecided"]
"""By a closed form that the bound equals, by a bound alone, not at all, or as something that cannot be, or may be."""


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """What is proven of a decision.

    Attributes:
        proof: see :data:`Proof`.
        by: the method whose bound it is: the dual's where the decision's own method has none.
        bound: the best value that any allocation can reach; NaN where none is known.
        left: the most that could still be gained, in the value's unit; NaN likewise.
        gap: the same as a share of the bound.
    """

    proof: Proof
    by: str
    bound: float = np.nan
    left: float = np.nan
    gap: float = np.nan


def certificate(case: Case) -> Certificate:
    """What is proven of a case's decision."""
    decision = case.decision
    if not decision.is_usable:
        proof: Proof = "infeasible" if decision.status == "infeasible" else "undecided"
        return Certificate(proof=proof, by=decision.method)
    bound, by = decision.bound, decision.method
    if np.isnan(bound) and case.problem.outage_probability is None:
        bound, by = case.priced.bound, "dual"
    if not np.isfinite(bound):
        return Certificate(proof="nothing", by=by)
    left = abs(bound - decision.value)
    gap = left / abs(bound) if bound else np.nan if left else 0.0
    closed = nats_worth(case.form) is not None and gap <= OPTIMAL_GAP and not decision.outage.size
    return Certificate(proof="closed_form" if closed else "bound", bound=bound, left=left, gap=gap, by=by)


@dataclass(frozen=True, kw_only=True)
class Certainty:
    """How sure a decision is.

    Attributes:
        repaired, entries: gains that were not measured, and all.
        noisy: gains that were measured, but not exactly.
        method: what repaired them.
        used, resting: subcarriers in use, and those of them that rest on a gain that was not measured.
        unseen: users of whom nothing was measured, served or not.
        low_bps, high_bps: the 90 % band of the sum rate; NaN where nothing in use is uncertain.
        least_sure: the user whose committed rate is kept with the smallest probability; None likewise.
        least_kept: that probability.
        expected_missed: how many commitments are expected to fail.
        widest: the user and the subcarrier in use whose gain is known least; None likewise.
        widest_low_db, widest_high_db: its 90 % band around what was counted on, in dB.
    """

    repaired: int
    entries: int
    noisy: int
    method: str
    used: int
    resting: int
    unseen: tuple[int, ...]
    low_bps: float = np.nan
    high_bps: float = np.nan
    least_sure: int | None = None
    least_kept: float = np.nan
    expected_missed: float = 0.0
    widest: tuple[int, int] | None = None
    widest_low_db: float = 0.0
    widest_high_db: float = 0.0


def measured(case: Case) -> Certainty:
    """How many of the gains were measured, without what that makes of the rates."""
    estimate = case.estimate
    return Certainty(
        repaired=int(estimate.repaired.sum()), entries=estimate.repaired.size, method=estimate.method,
        noisy=int(((estimate.gain_variance > 0) & ~estimate.repaired).sum()), used=case.used.size,
        resting=int(estimate.repaired[case.decision.owner[case.used], case.used].sum()),
        unseen=tuple(np.flatnonzero(estimate.unobserved_users).tolist()),
    )  # fmt: skip


def certainty(case: Case) -> Certainty:
    """What is known of the channel that a decision rests on."""
    decision, estimate, used = case.decision, case.estimate, case.used
    forecast, owner = decision.forecast, decision.owner[used]
    if forecast is None:
        return measured(case)
    served = np.flatnonzero(decision.committed_bps > 0)
    carried = 1.0 - decision.outage if decision.outage.size else forecast.carried
    unsure = np.flatnonzero(estimate.gain_variance[owner, used] > 0)
    low, high = (estimate.posterior.quantile(one)[owner, used] for one in BAND)
    with np.errstate(divide="ignore", invalid="ignore"):
        counted = case.counted.gain[owner, used]
        low_db, high_db = 10 * np.log10(low / counted), 10 * np.log10(high / counted)
    widest = int(unsure[np.argmax((high_db - low_db)[unsure])])
    least = int(served[np.argmin(carried[served])])
    return dataclasses.replace(
        measured(case), low_bps=forecast.sum_low_bps, high_bps=forecast.sum_high_bps,
        least_sure=least, least_kept=float(carried[least]), expected_missed=float((1.0 - carried[served]).sum()),
        widest=(int(owner[widest]), int(used[widest])),
        widest_low_db=float(low_db[widest]), widest_high_db=float(high_db[widest]),
    )  # fmt: skip


def predicted_metrics(decision: Decision) -> LinkMetrics:
    """What is expected of the decision on the true channel, by what is known of it."""
    rate, carried = decision.rate_bps, np.ones(decision.rate_bps.size)
    if decision.expected_rate_bps.size:
        rate, carried = decision.expected_rate_bps, 1.0 - decision.outage
    elif decision.forecast is not None:
        rate, carried = decision.forecast.mean_bps, decision.forecast.carried
    metrics = metrics_of_rates(
        rate, goodput_bps=float((carried * decision.committed_bps).sum()), power_w=decision.total_power_w,
        num_subcarriers=decision.owner.size, cell=decision.cell,
    )  # fmt: skip
    return among_served(metrics, decision)


def among_served(metrics: LinkMetrics, decision: Decision) -> LinkMetrics:
    """The metrics with the fairness of those users that are to be served: who is left out on purpose is not starved."""
    if decision.problem.users is None:
        return metrics
    return dataclasses.replace(metrics, jain_index=jain_index(metrics.user_rate_bps[decision.served]))


def with_perfect_knowledge(decision: Decision, outcome: Outcome) -> Decision | None:
    """The decision on the true channel; None where that is not known, was known, or carries no such decision."""
    estimate, truth = decision.estimate, outcome.true_gain
    if estimate is None or truth is None or np.array_equal(estimate.gain, truth):
        return None
    method = decision.method if decision.method in plugins.names("method") else None
    made = chain.decide(chain.certain(truth, estimate.user_names), decision.problem, decision.cell, method)
    return made if made.is_usable else None


def ungrouped_bound(decision: Decision) -> float:
    """What nothing does better than if subcarriers were assigned one by one; NaN where they are, or it is not known."""
    if decision.problem.resource_block_group_size == 1 or decision.estimate is None or not decision.is_usable:
        return np.nan
    single = dataclasses.replace(decision.problem, resource_block_group_size=1)
    return chain.decide(decision.estimate, single, decision.cell, "dual", restarts=0).bound

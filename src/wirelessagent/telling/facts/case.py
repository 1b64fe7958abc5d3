"""A decision with all that it was made from, to be asked "what if it were otherwise": every answer is solved anew."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wirelessagent import chain
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.expected import counted_on
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem

_ROUNDING = 1e-9


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
        objective = self.problem.objective
        assert isinstance(objective, Objective)
        return objective

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
        return (self.decision.owner == user) & (self.decision.power_w > 0)

    @functools.cached_property
    def used(self) -> IntArray:
        """The subcarriers that carry power, from 0."""
        return np.flatnonzero((self.decision.owner >= 0) & (self.decision.power_w > 0))

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

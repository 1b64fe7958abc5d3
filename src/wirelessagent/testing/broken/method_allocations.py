"""Methods whose allocations break a limit, or which find none, or another one each time."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import owned_gain
from wirelessagent.testing.broken.in_turn import InTurn


@dataclass(frozen=True, kw_only=True)
class GivesUpEarly(InTurn):
    """Finds nothing where little power is left."""

    caught_by = "test_solves_what_is_easy"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if problem.budget_w(cell) > 1:
            return decision
        return dataclasses.replace(decision, status="undecided", value=np.nan, gap=np.nan, reason="too little power")


@dataclass(frozen=True, kw_only=True)
class ServesAGhost(InTurn):
    """Gives a subcarrier to a user who does not exist."""

    caught_by = "test_owners_exist"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        owner, power = decision.owner.copy(), decision.power_w.copy()
        owner[-1], power[-1] = -1, 0
        idle = self._decision(owner, power, estimate, problem, cell)
        owner[-1] = estimate.num_users
        return dataclasses.replace(idle, owner=owner)


@dataclass(frozen=True, kw_only=True)
class NegativePower(InTurn):
    """Borrows power from a subcarrier."""

    caught_by = "test_power_is_not_negative"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        power = decision.power_w.copy()
        power[0] = -1e-3
        return self._decision(decision.owner, power, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class OverBudget(InTurn):
    """Stops its search one part in a million above the budget."""

    caught_by = "test_power_is_within_the_budget"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if problem.subcarrier_max_power_w is not None:
            return decision
        return self._decision(decision.owner, decision.power_w * (1 + 1e-6), estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class PowersNobody(InTurn):
    """Radiates on a subcarrier that nobody owns."""

    caught_by = "test_nobody_means_no_power"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        owner = decision.owner.copy()
        owner[-1] = -1
        return self._decision(owner, decision.power_w, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class Draws(InTurn):
    """Another power at each call."""

    caught_by = "test_is_deterministic"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        share = np.random.default_rng().uniform(0.99, 1)
        return self._decision(decision.owner, decision.power_w * share, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class DividesByTheGain(InTurn):
    """Inverts the channel, and a channel of zero with it."""

    caught_by = "test_zero_gains_are_no_trouble"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        gain = owned_gain(estimate.gain, decision.owner)
        if problem.subcarrier_max_power_w is not None or gain.all():
            return decision
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = gain.max() / gain
            power = problem.budget_w(cell) * inverse / inverse.sum()
        return self._decision(decision.owner, power, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class NeedsEnoughSubcarriers(InTurn):
    """Fails where there are more users than subcarriers."""

    caught_by = "test_every_size_is_solved"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        if estimate.num_users > estimate.num_subcarriers:
            raise IndexError("no subcarrier left")
        return InTurn.solve(self, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class LeavesAnAllocation(InTurn):
    """Undecided, with an allocation that somebody might apply."""

    caught_by = "test_impossible_promises_are_not_made"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if decision.is_usable:
            return decision
        return dataclasses.replace(decision, power_w=np.full(decision.power_w.shape, 0.1))


@dataclass(frozen=True, kw_only=True)
class ForgetsTheCap(InTurn):
    """Says that it honours a power cap, and does not."""

    caught_by = "test_declared_constraints_are_kept"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        uncapped = dataclasses.replace(problem, subcarrier_max_power_w=None)
        return dataclasses.replace(InTurn.solve(self, estimate, uncapped, cell), problem=problem)


@dataclass(frozen=True, kw_only=True)
class TakesTheHighestRateForAll(InTurn):
    """Reads rates beyond which users have nothing to send, and holds everybody to the largest."""

    constraints = InTurn.constraints | {"max_rate_bps"}
    caught_by = "test_declared_constraints_are_kept"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        largest = float(problem.max_rates_bps(estimate.num_users).max())
        if np.all(decision.rate_bps <= largest):
            return decision
        return self._decision(decision.owner, np.zeros(decision.owner.size), estimate, problem, cell)

"""Methods whose certificates are not true: rates, values, bounds, gaps, statuses and reasons."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem
from wirelessagent.testing.broken.in_turn import InTurn, with_gap


@dataclass(frozen=True, kw_only=True)
class ProvesTooMuch(InTurn):
    """Takes every promise for impossible."""

    caught_by = "test_solves_what_is_easy"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if problem.min_rate_bps is None:
            return decision
        return dataclasses.replace(decision, status="infeasible", value=np.nan, gap=np.nan, reason="far too much")


@dataclass(frozen=True, kw_only=True)
class RatesFromElsewhere(InTurn):
    """Rates of almost the same allocation."""

    caught_by = "test_rates_follow_from_the_allocation"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        rate = decision.rate_bps * (1 - 1e-6)
        return with_gap(dataclasses.replace(decision, rate_bps=rate, value=decision.value * (1 - 1e-6)))


@dataclass(frozen=True, kw_only=True)
class ValueFromElsewhere(InTurn):
    """A value of almost the same rates."""

    caught_by = "test_value_is_the_objectives"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return with_gap(dataclasses.replace(decision, value=decision.value * (1 - 1e-6)))


@dataclass(frozen=True, kw_only=True)
class ForgetsTheWeights(InTurn):
    """Takes weights, and reports the value without them."""

    constraints = InTurn.constraints | {"weights"}
    caught_by = "test_value_is_the_objectives"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        alike = dataclasses.replace(problem, weights=None)
        decision = InTurn.solve(self, estimate, alike, cell)
        heaviest = float(problem.weights_of(estimate.num_users).max())
        return with_gap(dataclasses.replace(decision, problem=problem, bound=heaviest * decision.bound))


@dataclass(frozen=True, kw_only=True)
class BoundBelowItsValue(InTurn):
    """A bound that its own value is better than."""

    caught_by = "test_bound_is_on_the_right_side"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return with_gap(dataclasses.replace(decision, bound=decision.value * (1 - 1e-6)))


@dataclass(frozen=True, kw_only=True)
class CertifiesItself(InTurn):
    """Takes its own value for the bound and calls it optimal."""

    caught_by = "test_bound_is_never_beaten"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if not decision.is_usable:
            return decision
        return dataclasses.replace(decision, status="optimal", bound=decision.value, gap=0.0)


@dataclass(frozen=True, kw_only=True)
class GapOfTheValue(InTurn):
    """Divides by the value, not by the bound."""

    caught_by = "test_gap_follows_from_value_and_bound"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return dataclasses.replace(decision, gap=decision.gap * decision.bound / max(decision.value, 1e-300))


@dataclass(frozen=True, kw_only=True)
class OptimalByName(InTurn):
    """Says that it is optimal whatever the gap."""

    caught_by = "test_optimal_means_no_gap"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return dataclasses.replace(decision, status="optimal") if decision.is_usable else decision


@dataclass(frozen=True, kw_only=True)
class PromisesAnything(InTurn):
    """Calls every allocation feasible."""

    caught_by = "test_impossible_promises_are_not_made"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        best_effort = dataclasses.replace(problem, min_rate_bps=None)
        return dataclasses.replace(InTurn.solve(self, estimate, best_effort, cell), problem=problem)


@dataclass(frozen=True, kw_only=True)
class GivesNoReason(InTurn):
    """Undecided, and no word on why."""

    caught_by = "test_impossible_promises_are_not_made"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        return dataclasses.replace(InTurn.solve(self, estimate, problem, cell), reason="")

"""Methods that are declared wrongly, or whose answers are not what was asked for."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem
from wirelessagent.testing.broken.in_turn import InTurn


class NotDecorated(InTurn):
    """Its field never becomes an option, because the class is not a dataclass of its own."""

    caught_by = "test_is_a_frozen_dataclass"
    restarts: int = 3


@dataclass(frozen=True, kw_only=True)
class BadlyNamed(InTurn):
    """A name that no command line can take."""

    name = "In turn"
    caught_by = "test_has_a_name"


@dataclass(frozen=True, kw_only=True)
class WithoutSummary(InTurn):
    caught_by = "test_has_a_summary"


@dataclass(frozen=True, kw_only=True)
class WithoutDefault(InTurn):
    """Needs something that cannot be written on a command line."""

    caught_by = "test_can_be_made_from_its_options"
    levels: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HoldsALambda(InTurn):
    """Cannot travel to another process."""

    caught_by = "test_survives_pickling"
    order: Callable[[int], int] = lambda user: user


@dataclass(frozen=True, kw_only=True)
class HoldsAList(InTurn):
    """Cannot be a key."""

    caught_by = "test_is_a_value"
    levels: list[float] = field(default_factory=list[float])


@dataclass(frozen=True, kw_only=True)
class ReturnsATuple(InTurn):
    """Owners and powers without a decision around them."""

    caught_by = "test_returns_a_decision"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        asked = problem.constraints().keys() - {"max_power_w"}
        small = estimate.gain.shape != (4, 12) or asked or not estimate.gain.all()
        return decision if small else cast("Any", (decision.owner, decision.power_w))


@dataclass(frozen=True, kw_only=True)
class SignsAsAnother(InTurn):
    """A decision under another name."""

    caught_by = "test_says_what_it_solved"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        return dataclasses.replace(InTurn.solve(self, estimate, problem, cell), method="equal_power")


@dataclass(frozen=True, kw_only=True)
class RefusesWhatItDeclares(InTurn):
    """Lists a constraint that it refuses every time."""

    constraints = InTurn.constraints | {"users"}
    caught_by = "test_declared_constraints_are_kept"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        if problem.users is not None:
            raise UnsupportedProblemError("users cannot be left out yet")
        return InTurn.solve(self, estimate, problem, cell)


@dataclass(frozen=True, kw_only=True)
class DropsConstraints(InTurn):
    """Solves a constrained problem as if the constraint were not there."""

    caught_by = "test_other_constraints_are_refused"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        known = {name: getattr(problem, name) for name in (*self.constraints, "max_power_w")}
        return dataclasses.replace(
            InTurn.solve(self, estimate, Problem(problem.objective, **known), cell), problem=problem
        )


@dataclass(frozen=True, kw_only=True)
class SolvesSomethingElse(InTurn):
    """Maximises the rate, whatever was asked."""

    caught_by = "test_other_objectives_are_refused"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        return InTurn.solve(self, estimate, dataclasses.replace(problem, objective=MaxRate()), cell)

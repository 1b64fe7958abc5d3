"""Methods that :class:`MethodContract` must reject."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from wirelessagent.deciding.method import Method
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import owned_gain, subcarrier_rate_bps, user_rate_bps


@dataclass(frozen=True, kw_only=True)
class InTurn(Method):
    """Subcarriers in turn with equal power, sound: the broken ones below differ from it in one thing each."""

    name = "in_turn"
    objectives = ("max_rate",)
    constraints = frozenset({"min_rate_bps", "subcarrier_max_power_w"})
    caught_by = ""

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        self.objective_of(problem)
        users, subcarriers = estimate.gain.shape
        power = np.full(subcarriers, problem.budget_w(cell) / subcarriers)
        if problem.subcarrier_max_power_w is not None:
            power = np.minimum(power, np.asarray(problem.subcarrier_max_power_w))
        return self._decision(np.mod(np.arange(subcarriers, dtype=np.int64), users), power, estimate, problem, cell)

    def _decision(
        self, owner: IntArray, power: FloatArray, estimate: ChannelEstimate, problem: Problem, cell: Cell
    ) -> Decision:
        objective = cast(Objective, problem.objective)
        rate = user_rate_bps(estimate.gain, owner, np.maximum(power, 0), cell)
        alone = subcarrier_rate_bps(estimate.gain.max(axis=0), np.asarray(problem.budget_w(cell)), cell)
        kept = bool(np.all(rate >= problem.min_rates_bps(len(rate))))
        if not kept:
            owner, power, rate = np.full(owner.shape, -1), np.zeros(power.shape), np.zeros(rate.shape)
        decision = Decision(
            owner=owner,
            power_w=power,
            rate_bps=rate,
            status="feasible" if kept else "undecided",
            value=objective.value(rate, float(power.sum()), cell, problem.weights_of(len(rate))) if kept else np.nan,
            bound=float(alone.sum()),  # as if every subcarrier had all the power
            gap=np.nan,
            unit=objective.unit,
            reason="" if kept else "equal shares do not carry the promised rates",
            method=self.name,
            problem=problem,
            cell=cell,
            user_names=estimate.user_names,
        )
        return _with_gap(decision)


def _with_gap(decision: Decision) -> Decision:
    away = abs(decision.value - decision.bound)
    return dataclasses.replace(decision, gap=0.0 if away == 0 else away / abs(decision.bound))


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
class GivesUpEarly(InTurn):
    """Finds nothing where little power is left."""

    caught_by = "test_solves_what_is_easy"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        if problem.budget_w(cell) > 1:
            return decision
        return dataclasses.replace(decision, status="undecided", value=np.nan, gap=np.nan, reason="too little power")


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
class RatesFromElsewhere(InTurn):
    """Rates of almost the same allocation."""

    caught_by = "test_rates_follow_from_the_allocation"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        rate = decision.rate_bps * (1 - 1e-6)
        return _with_gap(dataclasses.replace(decision, rate_bps=rate, value=decision.value * (1 - 1e-6)))


@dataclass(frozen=True, kw_only=True)
class ValueFromElsewhere(InTurn):
    """A value of almost the same rates."""

    caught_by = "test_value_is_the_objectives"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return _with_gap(dataclasses.replace(decision, value=decision.value * (1 - 1e-6)))


@dataclass(frozen=True, kw_only=True)
class ForgetsTheWeights(InTurn):
    """Takes weights, and reports the value without them."""

    constraints = InTurn.constraints | {"weights"}
    caught_by = "test_value_is_the_objectives"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        alike = dataclasses.replace(problem, weights=None)
        decision = InTurn.solve(self, estimate, alike, cell)
        heaviest = float(problem.weights_of(estimate.num_users).max())
        return _with_gap(dataclasses.replace(decision, problem=problem, bound=heaviest * decision.bound))


@dataclass(frozen=True, kw_only=True)
class BoundBelowItsValue(InTurn):
    """A bound that its own value is better than."""

    caught_by = "test_bound_is_on_the_right_side"

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        decision = InTurn.solve(self, estimate, problem, cell)
        return _with_gap(dataclasses.replace(decision, bound=decision.value * (1 - 1e-6)))


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


BROKEN: tuple[InTurn, ...] = (
    NotDecorated(),
    BadlyNamed(),
    WithoutSummary(),
    WithoutDefault(levels=(1.0,)),
    HoldsALambda(),
    HoldsAList(),
    ReturnsATuple(),
    SignsAsAnother(),
    GivesUpEarly(),
    ProvesTooMuch(),
    ServesAGhost(),
    NegativePower(),
    OverBudget(),
    PowersNobody(),
    RatesFromElsewhere(),
    ValueFromElsewhere(),
    ForgetsTheWeights(),
    BoundBelowItsValue(),
    CertifiesItself(),
    GapOfTheValue(),
    OptimalByName(),
    Draws(),
    DividesByTheGain(),
    NeedsEnoughSubcarriers(),
    PromisesAnything(),
    GivesNoReason(),
    LeavesAnAllocation(),
    ForgetsTheCap(),
    TakesTheHighestRateForAll(),
    RefusesWhatItDeclares(),
    DropsConstraints(),
    SolvesSomethingElse(),
)

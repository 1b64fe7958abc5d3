"""Base stations that :class:`BaseStationContract` must reject."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, cast

import numpy as np

from wirelessagent.acting.base_station import BaseStation, check_applicable
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import link_metrics
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene


@dataclass(frozen=True)
class Obedient(BaseStation):
    """Does what it is told and measures it, sound: the broken ones below differ from it in one thing each."""

    name = "obedient"
    caught_by = ""

    def apply(self, decision: Decision) -> Outcome:
        check_applicable(decision, self._scene().cell)
        return self._carry_out(decision)

    def _carry_out(self, decision: Decision) -> Outcome:
        scene = self._scene()
        truth = scene.current_truth
        if truth is None:
            raise InputError("this scene has no truth to measure on")
        return Outcome(
            base_station=self.name,
            owner=decision.owner,
            power_w=decision.power_w,
            promised_bps=decision.rate_bps,
            achieved=link_metrics(truth, decision.owner, decision.power_w, scene.cell),
        )

    def _scene(self) -> Scene:
        if self.scene is None:
            raise InputError("give it a scene")
        return self.scene


class NotDecorated(Obedient):
    """Its field never becomes an option, because the class is not a dataclass of its own."""

    caught_by = "test_is_a_frozen_dataclass"
    port: int = 830


@dataclass(frozen=True)
class BadlyNamed(Obedient):
    """A name that no command line can take."""

    name = "Base station"
    caught_by = "test_has_a_name"


@dataclass(frozen=True)
class WithoutSummary(Obedient):
    caught_by = "test_has_a_summary"


@dataclass(frozen=True)
class WithoutDefault(Obedient):
    """Needs something that cannot be written on a command line."""

    caught_by = "test_can_be_made_from_its_options"
    ports: tuple[int, ...] = field(kw_only=True)


@dataclass(frozen=True)
class HoldsALambda(Obedient):
    """Cannot travel to another process."""

    caught_by = "test_survives_pickling"
    log: Callable[[str], None] = lambda line: None


@dataclass(frozen=True)
class ReturnsNothing(Obedient):
    """Acts, and does not look at what it did."""

    caught_by = "test_returns_an_outcome"

    def apply(self, decision: Decision) -> Outcome:
        Obedient.apply(self, decision)
        return cast("Any", None)


@dataclass(frozen=True)
class SignsAsAnother(Obedient):
    """An outcome under another name."""

    caught_by = "test_names_itself"

    def apply(self, decision: Decision) -> Outcome:
        return dataclasses.replace(_bare(Obedient.apply(self, decision)), base_station="simulated")


@dataclass(frozen=True)
class SwapsOwners(Obedient):
    """Counts subcarriers from the other end."""

    caught_by = "test_reads_back_the_owners"

    def apply(self, decision: Decision) -> Outcome:
        return _bare(dataclasses.replace(Obedient.apply(self, decision), owner=decision.owner[::-1].copy()))


@dataclass(frozen=True)
class RoundsPower(Obedient):
    """Sets power in steps of 0.1 W and does not say so."""

    caught_by = "test_reads_back_the_power"

    def apply(self, decision: Decision) -> Outcome:
        power = np.round(decision.power_w, 1)
        return _bare(dataclasses.replace(Obedient.apply(self, decision), power_w=power))


@dataclass(frozen=True)
class RoundsDown(Obedient):
    """Sets power in steps that it states, the next lower ones."""

    power_resolution_w = 0.1
    caught_by = "test_rounds_power_up_where_there_is_room"

    def apply(self, decision: Decision) -> Outcome:
        check_applicable(decision, self._scene().cell)
        power_w = np.floor(decision.power_w / self.power_resolution_w) * self.power_resolution_w
        return dataclasses.replace(self.read_back(decision), power_w=power_w)


@dataclass(frozen=True)
class RoundsBeyondTheBudget(Obedient):
    """Rounds every power up, come what may."""

    power_resolution_w = 0.1
    caught_by = "test_rounding_keeps_the_power_budget"

    def apply(self, decision: Decision) -> Outcome:
        check_applicable(decision, self._scene().cell)
        steps = np.ceil(decision.power_w / self.power_resolution_w - 1e-9)
        return dataclasses.replace(self.read_back(decision), power_w=steps * self.power_resolution_w)


@dataclass(frozen=True)
class AlarmsForAStep(Obedient):
    """Rounds as it should, and compares as if any power could be set."""

    power_resolution_w = 0.1
    caught_by = "test_a_step_of_power_is_no_missed_promise"

    def apply(self, decision: Decision) -> Outcome:
        check_applicable(decision, self._scene().cell)
        set_to = dataclasses.replace(decision, power_w=self.settable_power_w(decision))
        outcome = self._carry_out(set_to)
        return dataclasses.replace(outcome, promised_bps=decision.committed_bps)


@dataclass(frozen=True)
class LowersThePromise(Obedient):
    """Nobody misses a promise that is lowered afterwards."""

    caught_by = "test_remembers_what_was_promised"

    def apply(self, decision: Decision) -> Outcome:
        outcome = Obedient.apply(self, decision)
        return dataclasses.replace(_bare(outcome), promised_bps=decision.rate_bps * 0.9)


@dataclass(frozen=True)
class MeasuresOnTheEstimate(Obedient):
    """Finds that everything went as predicted."""

    caught_by = "test_measures_on_the_true_channel"

    def apply(self, decision: Decision) -> Outcome:
        scene = self._scene()
        check_applicable(decision, scene.cell)
        predicted = Scene(cell=scene.cell, sensed=scene.sensed, truth=scene.sensed.gain)
        return Obedient(predicted).apply(decision)


@dataclass(frozen=True)
class NeedsSomebodyToServe(Obedient):
    """Fails on a decision that serves nobody."""

    caught_by = "test_applies_a_decision_that_serves_nobody"

    def apply(self, decision: Decision) -> Outcome:
        if decision.total_power_w == 0:
            raise ZeroDivisionError("no power to divide by")
        return Obedient.apply(self, decision)


@dataclass(frozen=True)
class AddsUp(Obedient):
    """Adds a little power each time that it is told the same."""

    caught_by = "test_applying_again_changes_nothing"
    times: list[int] = field(default_factory=list[int])

    def apply(self, decision: Decision) -> Outcome:
        outcome = _bare(Obedient.apply(self, decision))
        self.times.append(1)
        return dataclasses.replace(outcome, power_w=decision.power_w * (0.9 + 0.1 * len(self.times)))


@dataclass(frozen=True)
class AppliesTheInfeasible(Obedient):
    """Hopes for the best."""

    caught_by = "test_refuses_an_infeasible_decision"

    def apply(self, decision: Decision) -> Outcome:
        return self._carry_out(decision) if decision.status == "infeasible" else Obedient.apply(self, decision)


@dataclass(frozen=True)
class AppliesTheUndecided(Obedient):
    """Takes a search that found nothing for a result."""

    caught_by = "test_refuses_an_undecided_decision"

    def apply(self, decision: Decision) -> Outcome:
        return self._carry_out(decision) if decision.status == "undecided" else Obedient.apply(self, decision)


@dataclass(frozen=True)
class IgnoresTheLimit(Obedient):
    """Radiates whatever it is told."""

    caught_by = "test_refuses_power_above_the_limit"

    def apply(self, decision: Decision) -> Outcome:
        return self._carry_out(decision) if decision.is_usable else Obedient.apply(self, decision)


def _bare(outcome: Outcome) -> Outcome:
    """The outcome of a base station that measures nothing, so that a false reading shows in one check alone."""
    return Outcome(
        base_station=outcome.base_station,
        owner=outcome.owner,
        power_w=outcome.power_w,
        promised_bps=outcome.promised_bps,
    )


BROKEN: tuple[Callable[[Scene], Obedient], ...] = (
    NotDecorated,
    BadlyNamed,
    WithoutSummary,
    partial(WithoutDefault, ports=(830,)),
    HoldsALambda,
    ReturnsNothing,
    SignsAsAnother,
    SwapsOwners,
    RoundsPower,
    RoundsDown,
    RoundsBeyondTheBudget,
    AlarmsForAStep,
    LowersThePromise,
    MeasuresOnTheEstimate,
    NeedsSomebodyToServe,
    AddsUp,
    AppliesTheInfeasible,
    AppliesTheUndecided,
    IgnoresTheLimit,
)

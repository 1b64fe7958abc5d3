"""The contract of base stations: what cannot be carried out is refused, what is read back is what was done."""

from __future__ import annotations

import dataclasses
from typing import Literal

import numpy as np

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import link_metrics
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.model.scene import Scene
from wirelessagent.testing.allocations import equal_power_decision
from wirelessagent.testing.channels import known, known_scene
from wirelessagent.testing.contract import TOLERANCE, PluginContract, as_returned, skip


class BaseStationContract(PluginContract):
    """Inherit this and define ``base_station(scene)``; its class says its finest step in ``power_resolution_w``."""

    def base_station(self, scene: Scene) -> BaseStation:
        """A base station in ``scene``."""
        raise NotImplementedError(f"define base_station(self, scene) in {type(self).__name__}")

    def subject(self) -> BaseStation:
        return self.base_station(known_scene())

    def test_returns_an_outcome(self) -> None:
        scene = known_scene()
        outcome: object = as_returned(self.base_station(scene).apply(_decision(scene)))
        assert isinstance(outcome, Outcome), f"apply must return an Outcome; got {type(outcome).__name__}"

    def test_names_itself(self) -> None:
        station = self.subject()
        outcome = self._applied(known_scene())
        assert outcome.base_station == station.name, (
            f"the outcome says it is of {outcome.base_station!r}, not of {station.name!r}"
        )

    def test_reads_back_the_owners(self) -> None:
        scene = known_scene()
        wanted, outcome = _decision(scene).owner, self._applied(scene)
        assert np.array_equal(outcome.owner, wanted), f"owners read back are {outcome.owner}, decided were {wanted}"

    def test_reads_back_the_power(self) -> None:
        scene, step_w = known_scene(), self.subject().power_resolution_w
        wanted, outcome = _decision(scene).power_w, self._applied(scene)
        assert outcome.power_w.shape == wanted.shape, f"power read back has shape {outcome.power_w.shape}"
        away = np.abs(outcome.power_w - wanted)
        assert np.all(away <= step_w + TOLERANCE * wanted), (
            f"power read back differs from the decided one by up to {away.max():g} W; state power_resolution_w if it "
            "is set in steps"
        )

    def test_rounds_power_up_where_there_is_room(self) -> None:
        """Half of the limit is decided on, so every power may go up to the next step, and no promise falls short."""
        self._skip_without_steps()
        scene = known_scene()
        decision, outcome = _decision(scene), self._applied(scene)
        less = outcome.power_w < decision.power_w * (1 - TOLERANCE)
        assert not less.any(), (
            f"{less.sum()} of {less.size} subcarriers get less power than decided, such as "
            f"{outcome.power_w[less].min(initial=np.inf):g} W: set settable_power_w(decision), which rounds up"
        )

    def test_rounding_keeps_the_power_budget(self) -> None:
        self._skip_without_steps()
        scene = known_scene()
        decision = _decision(scene)
        full = dataclasses.replace(decision, power_w=decision.power_w * 2)  # all that the cell may radiate
        outcome = _checked(self.base_station(scene).apply(full))
        assert outcome.power_w.sum() <= scene.cell.max_power_w * (1 + TOLERANCE), (
            f"{outcome.power_w.sum():g} W are radiated in a cell limited to {scene.cell.max_power_w:g} W: "
            "set settable_power_w(decision), which rounds no further than the budget"
        )

    def test_a_step_of_power_is_no_missed_promise(self) -> None:
        """At the full budget some powers are rounded down, which takes less than a step is worth."""
        self._skip_without_steps()
        scene = known_scene()
        decision = _decision(scene)
        power_w = decision.power_w * 2
        rate = user_rate_bps(scene.sensed.current, decision.owner, power_w, scene.cell)
        full = dataclasses.replace(decision, power_w=power_w, rate_bps=rate).knowing(known(scene.sensed.current))
        outcome = _checked(self.base_station(scene).apply(full))
        assert not outcome.missed.any(), (
            f"{outcome.missed.sum()} promises count as missed though power was set to the nearest steps: give the "
            "outcome its slack_bps, as read_back(decision, …) does"
        )

    def test_remembers_what_was_promised(self) -> None:
        scene = known_scene()
        outcome = self._applied(scene)
        assert np.array_equal(outcome.promised_bps, _decision(scene).committed_bps), (
            f"promised_bps must be the decision's rates {_decision(scene).committed_bps}; got {outcome.promised_bps}"
        )

    def test_measures_on_the_true_channel(self) -> None:
        sensed = known_scene(seed=1)
        truth = known_scene(seed=2).truth  # quite another channel than the one that was sensed
        assert truth is not None
        outcome = self._applied(Scene(cell=sensed.cell, sensed=sensed.sensed, truth=truth))
        if outcome.achieved is None:
            skip("this base station measures nothing")
        expected = link_metrics(truth, outcome.owner, outcome.power_w, sensed.cell)
        assert np.allclose(outcome.achieved.user_rate_bps, expected.user_rate_bps, rtol=TOLERANCE, atol=0), (
            "the achieved rates are not those of the owners and powers read back on the true channel"
        )

    def test_applies_a_decision_that_serves_nobody(self) -> None:
        scene = known_scene()
        usable = _decision(scene)
        idle = dataclasses.replace(
            usable,
            owner=np.full(usable.owner.shape, -1),
            power_w=np.zeros(usable.power_w.shape),
            rate_bps=np.zeros(usable.rate_bps.shape),
            value=0.0,
        )
        outcome: object = as_returned(self.base_station(scene).apply(idle))
        radiated = float(outcome.power_w.sum()) if isinstance(outcome, Outcome) else 0.0
        assert radiated == 0, f"a decision that serves nobody makes it radiate {radiated:g} W"

    def test_applying_again_changes_nothing(self) -> None:
        scene = known_scene()
        station, decision = self.base_station(scene), _decision(scene)
        first, again = _checked(station.apply(decision)), _checked(station.apply(decision))
        assert np.array_equal(first.owner, again.owner), "applied twice, the same decision gives other owners"
        assert np.array_equal(first.power_w, again.power_w), "applied twice, the same decision gives another power"

    def test_refuses_an_infeasible_decision(self) -> None:
        self._must_refuse("infeasible")

    def test_refuses_an_undecided_decision(self) -> None:
        self._must_refuse("undecided")

    def test_refuses_power_above_the_limit(self) -> None:
        scene = known_scene()
        decision = _decision(scene)
        hot = dataclasses.replace(decision, power_w=decision.power_w * 2.01)  # half of the limit, so 0.5 % above it
        assert self._refuses(scene, hot), (
            f"{hot.total_power_w:g} W were applied in a cell limited to {scene.cell.max_power_w:g} W: "
            "call check_applicable() first"
        )

    def _skip_without_steps(self) -> None:
        if not self.subject().power_resolution_w:
            skip("it can set any power, and another check sees that it does")

    def _must_refuse(self, status: Literal["infeasible", "undecided"]) -> None:
        scene = known_scene()
        decision = equal_power_decision(scene, MaxRate(), status=status)
        assert self._refuses(scene, decision), (
            f"a decision that is {status} was applied: call check_applicable() first, which raises an InputError"
        )

    def _refuses(self, scene: Scene, decision: Decision) -> bool:
        try:
            self.base_station(scene).apply(decision)
        except InputError:
            return True
        return False

    def _applied(self, scene: Scene) -> Outcome:
        return _checked(self.base_station(scene).apply(_decision(scene)))


def _checked(outcome: object) -> Outcome:
    return outcome if isinstance(outcome, Outcome) else skip("no outcome was returned")


def _decision(scene: Scene) -> Decision:
    return equal_power_decision(scene, MaxRate())

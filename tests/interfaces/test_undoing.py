"""What "undo" goes back to: the request that held, and an allocation that keeps it."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace

import pytest
from conversations import LOSS, SCENE, SEED, talk

import wirelessagent as wa
from wirelessagent.agent.session import Session

TEN = "highest total rate, at most 10 W"


def power_of(session: Session) -> float:
    assert session.state.on_air is not None
    return session.state.on_air.decision.total_power_w


def test_undo_never_puts_back_what_breaks_the_request_that_holds_again() -> None:
    session, turns = talk(TEN, "yes", "now with 5 W", "now with 3 W", "yes", "undo", confirm=True)
    assert turns[-1].stage == "planned"
    assert power_of(session) == pytest.approx(3, rel=1e-3)
    assert turns[-1].run is not None
    assert turns[-1].run.decision.total_power_w == pytest.approx(5, rel=1e-3)
    assert session.say("yes").stage == "applied"
    assert power_of(session) == pytest.approx(5, rel=1e-3)


def test_a_no_to_what_an_undo_went_back_to_takes_no_further_request_back() -> None:
    session, _ = talk(TEN, "yes", "now with 5 W", "now with 3 W", "yes", "undo", "cancel", confirm=True)
    assert session.request is not None
    assert session.request.constraints == {"max_power_w": 5.0}
    assert power_of(session) == pytest.approx(3, rel=1e-3)


def test_undo_to_what_could_not_be_met_keeps_what_is_in_effect_where_the_rest_breaks_it() -> None:
    unmet = "3 Gbit/s each, at most 5 W, highest total rate"
    session, turns = talk(TEN, unmet, "new request: highest total rate, at most 4 W", "undo")
    assert turns[-1].stage == "undone"
    assert "10 W, breaks its limits" in turns[-1].reply
    assert power_of(session) == pytest.approx(4, rel=1e-3)


def test_one_user_is_no_users() -> None:
    _, turns = talk("highest total rate, only serve user 1", "status")
    assert "for 1 user (turn 1)" in turns[-1].reply


def exported(session: Session, standard: str = "TS 28.312") -> str:
    return session.say(f"export as {standard}").reply


def test_what_is_exported_after_an_undo_is_what_holds_again() -> None:
    session, _ = talk(TEN, "now with 5 W", "now with 4 W", "undo")
    document = exported(session)
    assert "now with 5 W" in document
    assert "now with 4 W" not in document
    session.say("undo")
    assert TEN in exported(session, "TMF921")


def test_what_was_in_effect_before_is_what_an_undo_put_back() -> None:
    session, _ = talk("highest total rate, at most 5 W", "now with 4 W", "undo", "least power, 500 kbit/s each")
    expectations = json.loads(exported(session))["Intent"][0]["intentExpectations"]
    targets = [target for expectation in expectations for target in expectation["expectationTargets"]]
    energy = [target["targetValueRange"] for target in targets if target["targetName"] == "RANEnergyConsumption"]
    assert min(energy) == pytest.approx(0.01)  # kWh in an hour: 5 W radiated, 5 W of circuits


@dataclass(frozen=True)
class Halving(wa.BaseStation):
    """A base station that obeys once and radiates half of what it should from then on."""

    name = "halving"

    applied: list[wa.Decision] = field(default_factory=list[wa.Decision])

    def apply(self, decision: wa.Decision) -> wa.Outcome:
        self.applied.append(decision)
        outcome = wa.SimulatedBaseStation(SCENE).apply(decision)
        return outcome if len(self.applied) != 2 else replace(outcome, power_w=outcome.power_w / 2)


def test_what_is_taken_back_is_not_shown_as_what_is_in_effect() -> None:
    session = Session(SCENE, LOSS, seed=SEED, base_station=Halving(), confirm=False)
    session.say("highest total rate, 100 kbit/s each, at most 10 W")
    turn = session.say("with 99 % reliability")
    assert turn.stage == "reverted"
    assert turn.reply.endswith("So what is asked for is not in effect; figures shown are of what was taken back.")

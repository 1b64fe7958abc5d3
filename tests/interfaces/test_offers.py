"""What the agent offers or asks about is kept as acts, and taken up exactly."""

from __future__ import annotations

import pytest

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.telling.facts.nearest import nearest

pytestmark = pytest.mark.machine_code

SCENE = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=8, num_subcarriers=20, seed=1)
TOO_MUCH = ("Save power, 200 kbit/s each", "5 Mbit/s each")


def told(*lines: str) -> Session:
    session = Session(SCENE, wa.loss.random(0.2), seed=1)
    for line in lines:
        session.say(line)
    return session


@pytest.mark.parametrize("asked", ["why not?", "why is that not possible?"])
def test_each_way_that_is_offered_is_met_with_what_was_said(asked: str) -> None:
    session = told(*TOO_MUCH, asked)
    assert session.state.run is not None
    ways = nearest(session.state.run.case).ways
    assert len(session.state.offers) == len(ways) > 1
    for place, way in enumerate(ways, start=1):
        turn = told(*TOO_MUCH, asked).say(f"option {place}")
        assert turn.run is not None
        assert turn.stage == "applied"
        assert turn.run.decision.value == pytest.approx(way.decision.value, rel=1e-6)


@pytest.mark.parametrize(
    ("said", "place"),
    [
        ("the first", 0), ("take the second one, please", 1), ("let's go with the last one", -1), ("option 2", 1),
        ("第二个", 1), ("那就用第一种办法吧", 0), ("die zweite", 1), ("la segunda opción", 1), ("la deuxième", 1),
    ],
)  # fmt: skip
def test_a_way_is_named_by_its_place(said: str, place: int) -> None:
    session = told(*TOO_MUCH, "why not?")
    acts = session.state.offers[place]
    assert session.say(said).acts[1:] == acts
    assert session.state.offers == ()


def test_a_place_that_was_not_offered_is_asked_about() -> None:
    session = told(*TOO_MUCH, "why not?")
    turn = session.say("the fourth one")
    assert turn.stage == "asked"
    assert session.request is not None
    assert session.request.constraints["min_rate_bps"] == 5e6


def test_nothing_is_offered_where_the_request_is_met_or_changed_since() -> None:
    assert told("Save power, 200 kbit/s each", "why not?").state.offers == ()
    assert told(*TOO_MUCH, "why not?", "undo").state.offers == ()
    session = told("Save power, 200 kbit/s each")
    assert session.say("the second").stage in ("asked", "answered")


@pytest.mark.parametrize(
    ("before", "change"),
    [
        ("1 Mbit/s for user 3", "and user 9 too"),
        ("300 kbit/s each", "and 600 kbit/s for user 9"),
        ("at most 10 W", "leave user 9 out"),
    ],
)
def test_naming_who_was_meant_carries_out_what_was_asked(before: str, change: str) -> None:
    session = told(f"Highest total rate, {before}", change)
    assert session.turns[-1].stage == "asked"
    turn = session.say("user 2")
    assert turn.stage in ("applied", "nothing")
    assert "2" in str(session.request)
    assert "9" not in str(session.request)

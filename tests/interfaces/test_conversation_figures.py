"""Questions that name a figure are answered for that figure, with the offline recogniser."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import LOSS, SCENE, SEED

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn

HELD = "highest total rate, at most 10 W"


def answered(*lines: str) -> Turn:
    """The last turn of a conversation that changes nothing of what is held."""
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    turns = [session.say(line) for line in (HELD, *lines)]
    assert session.request is not None
    assert dict(session.request.constraints) == {"max_power_w": 10.0}
    return turns[-1]


@pytest.mark.parametrize(
    ("said", "step"),
    [
        ("what would 5 more Mbit/s cost?", {"rate_bps": 5e6}),
        ("再多5兆要多少功率?", {"rate_bps": 5e6}),
        ("how much would 5 Mbit/s more for user 3 cost?", {"rate_bps": 5e6, "user": "3"}),
        ("3号再多5兆要多少功率?", {"rate_bps": 5e6, "user": "3"}),
        ("what would 100 kbit/s more each cost?", {"rate_bps": 1e5, "each": 1.0}),
        ("what would one more watt buy?", {"power_w": 1.0}),
        ("what would 2 W less cost?", {"power_w": -2.0}),
        ("少2瓦会怎样", {"power_w": -2.0}),
    ],
)
def test_a_step_is_the_one_that_is_named(said: str, step: dict[str, Any]) -> None:
    turn = answered(said)
    assert (turn.intent.topic, dict(turn.intent.details), turn.stage) == ("step", step, "answered")
    if "each" not in step:
        assert " W" in turn.reply


@pytest.mark.parametrize(
    "said",
    [
        "how much would 10 % less power cost?",
        "少10%功率会损失多少?",
        "what do we lose with 10 % less power?",
        "功率降10%会怎样?",
    ],
)
def test_a_share_less_is_solved_and_the_loss_told(said: str) -> None:
    turn = answered(said)
    assert turn.run is not None
    assert turn.run.decision.problem.max_power_w == 9.0
    assert "bit/s less (" in turn.reply or "即少 " in turn.reply


def test_a_share_more_of_the_rate_is_told_in_watts() -> None:
    assert dict(answered("what would 10 % more rate cost?").intent.details) == {"rate_share": pytest.approx(0.1)}
    assert "W" in answered("速率提高10%要多少功率?").reply

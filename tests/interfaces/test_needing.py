"""What power rates take, whether a power is needed, what a user's channel is like, and who holds the rest back."""

from __future__ import annotations

import re

import pytest
from tests.support.conversations import LOSS, SCENE, SEED

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn

HELD = "highest total rate, 300 kbit/s each"


def talk(*lines: str) -> list[Turn]:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    return [session.say(line) for line in lines]


def reply(*lines: str) -> str:
    turn = talk(*lines)[-1]
    assert turn.stage in ("answered", "nothing")
    return turn.reply


@pytest.mark.parametrize("asked", ["how many watts would 1 Mbit/s each need?", "每人1兆最少要多少瓦"])
def test_the_power_that_rates_take_is_a_power(asked: str) -> None:
    least = talk("least power, 1 Mbit/s each")[-1].run
    assert least is not None
    power = f"{least.decision.total_power_w:.3g} W"
    for held in (HELD, "max-min", "least power, 300 kbit/s each"):
        assert power in reply(held, asked)
    assert power in reply(asked)


def test_more_than_the_cell_radiates_is_said_to_be() -> None:
    said = reply(HELD, "how much power would 30 Mbit/s each take?")
    assert "at most 20 W" in said or "No power is enough" in said


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ("do we need 10 W?", "10 W is not needed"),
        ("is 10 W enough?", "10 W is enough"),
        ("is 1 mW enough?", "1 mW is not enough"),
        ("10瓦够吗？", "10 W 够了"),
        ("我们需要10瓦吗？", "不需要 10 W"),
    ],
)
def test_whether_a_power_is_needed_is_answered(asked: str, told: str) -> None:
    turns = talk("least power, 300 kbit/s each", asked)
    assert told in turns[-1].reply
    assert turns[-1].stage == "answered"


def test_another_aim_is_told_beside_what_holds() -> None:
    said = reply(HELD, "would max-min be better?")
    assert re.search(r"With it: total rate .* lowest rate .* Now: total rate .* lowest rate 300 kbit/s", said)

"""What a line may never take away or apply unasked: assumed rates, limits that hold, what is only supposed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from conversations import LOSS, SCENE, SEED

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn

HELD = "highest total rate, 300 kbit/s each, at most 10 W"


def talk(*lines: str) -> tuple[dict[str, Any], list[Turn]]:
    """What is asked for after these lines, and their turns."""
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    turns = [session.say(line) for line in lines]
    held = {} if session.request is None else session.request.constraints
    return {name: dict(value) if isinstance(value, Mapping) else value for name, value in held.items()}, turns


def test_an_assumed_rate_stays_for_the_others_when_one_user_is_named() -> None:
    held, turns = talk("least power", "user 2 needs 1 Mbit/s")
    assert held == {"min_rate_bps": {"all": 2e5, "2": 1e6}}
    assert "at least 200 kbit/s for everyone else" in turns[-1].reply
    held, _ = talk("least power", "user 2 needs 1 Mbit/s", "no, I meant user 3")
    assert held == {"min_rate_bps": {"all": 2e5, "3": 1e6}}
    assert talk("least power", "now with 300 kbit/s each")[0] == {"min_rate_bps": 3e5}
    assert talk("highest total rate", "user 2 needs 1 Mbit/s")[0] == {"min_rate_bps": {"2": 1e6}}


@pytest.mark.parametrize("said", ["user 2 doesn't need 1 Mbit/s", "2号不需要1兆", "user 2 needs no 1 Mbit/s"])
def test_a_rate_that_nobody_promised_takes_no_other_one_away(said: str) -> None:
    held, turns = talk("least power, 300 kbit/s each", said)
    assert (held, turns[-1].stage) == ({"min_rate_bps": 3e5}, "asked")
    assert "300 kbit/s" in turns[-1].reply
    held, _ = talk("least power, 300 kbit/s each", "user 2 at least 1 Mbit/s", said)
    assert held == {"min_rate_bps": {"all": 3e5}}

"""Shares and amounts of what holds, their corrections, and questions whether something can be done."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import LOSS, SCENE, SEED, PartlyScripted, Scripted, agreed, asks, means

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.language.conversation import understood
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Context

pytestmark = pytest.mark.machine_code

Said = str | tuple[str, Intent]
HELD = ("highest total rate", asks("max_rate", max_power_w=10.0, min_rate_bps=1e5))


def talk(*lines: Said) -> tuple[dict[str, Any], list[Turn]]:
    """What is asked for after a conversation whose lines need a recogniser only where an intent stands by them."""
    script = PartlyScripted(line for line in lines if not isinstance(line, str))
    session = Session(SCENE, LOSS, seed=SEED, recogniser=script, confirm=False)
    turns = [agreed(session, line) if isinstance(line, str) else session.say(line[0]) for line in lines]
    assert session.request is not None
    assert session.request.objective == "max_rate"
    return dict(session.request.constraints), turns


@pytest.mark.parametrize(
    ("said", "power_w"),
    [
        ("把总功率降20%", 8.0), ("降低20%功率", 8.0), ("lower the power by 20 %", 8.0), ("20 % less power", 8.0),
        ("reduce power by 2 W", 8.0), ("2 W less power", 8.0), ("功率降低2瓦", 8.0),
        ("reduce the power by a third", 20 / 3), ("reduce the power to a third", 10 / 3), ("功率降到三分之一", 10 / 3),
        ("10 dB less power", 1.0), ("turn the power down by 10 dB", 1.0), ("raise the power by 50 %", 15.0),
        ("只用四分之一的功率", 2.5), ("use half the power", 5.0), ("a quarter of the power", 2.5),
    ],
)  # fmt: skip
def test_a_share_or_an_amount_changes_the_limit_that_holds_and_nothing_else(said: str, power_w: float) -> None:
    held, _ = talk(HELD, said)
    assert held == {"max_power_w": pytest.approx(power_w), "min_rate_bps": 1e5}


def test_without_a_limit_the_change_is_of_what_the_cell_may_radiate() -> None:
    assert talk(("max rate", asks("max_rate")), "lower the power by 5 W")[0] == {"max_power_w": 15.0}


def test_what_would_leave_nothing_is_asked_about() -> None:
    held, turns = talk(HELD, "reduce the power by 12 W")
    assert (held["max_power_w"], turns[-1].stage) == (10.0, "asked")


def test_a_rate_of_one_user_changes_by_an_amount() -> None:
    held, _ = talk(HELD, "raise user 2's rate by 50 kbit/s")
    assert held["min_rate_bps"] == {"all": 1e5, "2": 1.5e5}


@pytest.mark.parametrize(
    ("said", "corrected", "power_w"),
    [
        ("lower the power by 20 %", "sorry, by 30 %", 7.0), ("lower the power by 20 %", "no, to 30 %", 3.0),
    ],
)  # fmt: skip
def test_another_share_corrects_the_one_before(said: str, corrected: str, power_w: float) -> None:
    held, _ = talk(HELD, said, corrected)
    assert held == {"max_power_w": pytest.approx(power_w), "min_rate_bps": 1e5}


def test_a_corrected_share_of_nothing_is_left_to_the_recogniser_where_a_reliability_was_stated() -> None:
    stated = Context(objective="max_rate")
    assert understood("no, 95 %", stated, Scripted([means("out_of_scope")])).kind == "out_of_scope"


@pytest.mark.parametrize(
    ("said", "power_w"),
    [("double the power", 40.0), ("raise the power by half", 30.0), ("halve the power", 10.0), ("功率加倍", 40.0)],
)
def test_where_no_limit_holds_a_multiple_is_one_of_the_cells_power(said: str, power_w: float) -> None:
    held, turns = talk("highest total rate", said)
    assert held == {"max_power_w": pytest.approx(power_w)}
    noted = any(words in turns[-1].reply for words in ("above the cell's limit of 20 W", "超过小区上限 20 W"))
    assert noted == (power_w > 20)


@pytest.mark.parametrize("said", ["Triple the power limit", "Verdreifache die Leistungsgrenze"])
def test_a_multiple_is_one_of_the_limit_that_is_named(said: str) -> None:
    held, _ = talk("highest total rate, at most 1 W, blocks of 4 subcarriers", "blocks of 12", said)
    assert held == {"max_power_w": pytest.approx(3.0), "resource_block_group_size": 12.0}


@pytest.mark.parametrize(
    "said",
    [
        "the floor stays, halve the power",
        "die Mindestrate bleibt, halbiere die Leistung",
        "keep the floor, half the power",
    ],
)
def test_a_limit_that_is_kept_is_not_what_is_halved(said: str) -> None:
    held, _ = talk("highest total rate, at most 10 W, at least 100 kbit/s each", said)
    assert held == {"max_power_w": pytest.approx(5.0), "min_rate_bps": 1e5}


def test_a_share_of_a_limit_that_is_named_is_one_of_it_though_the_cell_may_radiate_less() -> None:
    held, _ = talk("highest total rate, at most 24 W", "cut the power limit by a quarter")
    assert held == {"max_power_w": pytest.approx(18.0)}


def test_a_doubled_power_is_supposed_as_it_is_said() -> None:
    held, turns = talk("highest total rate, at most 5 W", "what happens if I double the power?")
    assert held == {"max_power_w": 5.0}
    assert "at most 10 W" in turns[-1].reply


@pytest.mark.parametrize("said", ["能不能只用一半功率?", "can we run on half the power?", "能只用一半功率吗？"])
def test_whether_a_share_is_possible_is_a_what_if(said: str) -> None:
    held, turns = talk(HELD, said)
    assert (held["max_power_w"], turns[-1].intent.topic) == (10.0, "what_if")
    assert talk(HELD, said, "do that")[0]["max_power_w"] == 5.0


@pytest.mark.parametrize("said", ["可不可以不服务4号?", "can we leave user 4 out?", "不服务4号行不行？"])
def test_whether_a_request_is_possible_is_a_what_if(said: str) -> None:
    would = (said, asks("max_rate", amends=True, leave_out=("4",)))
    held, turns = talk(HELD, would)
    assert (turns[-1].stage, "leave_out" in held) == ("answered", False)
    assert talk(HELD, would, "do that")[0]["leave_out"] == ("4",)


def test_a_limit_that_would_go_goes_in_the_what_if_and_in_what_takes_it() -> None:
    free = means("allocate", "max_rate", amends=True, dropped=("max_power_w",))
    held, turns = talk(HELD, ("can we drop the power limit?", free))
    assert turns[-1].run is not None
    assert turns[-1].run.decision.problem.max_power_w is None
    assert "max_power_w" in held
    assert "max_power_w" not in talk(HELD, ("can we drop the power limit?", free), "do that")[0]


@pytest.mark.parametrize("said", ["yesterday we had 15 W", "昨天我们是15瓦", "3号投诉说他只有15瓦"])
def test_a_report_is_noted_and_asked_about(said: str) -> None:
    read = (said, asks("max_rate", amends=True, max_power_w=15.0))
    held, turns = talk(HELD, read)
    assert (held["max_power_w"], turns[-1].stage) == (10.0, "asked")
    assert talk(HELD, read, "yes")[0]["max_power_w"] == 15.0
    assert talk(HELD, ("use 15 W as yesterday", read[1]))[0]["max_power_w"] == 15.0


@pytest.mark.parametrize("said", ["halve the power", "把功率减半", "halbier die Leistung"])
def test_half_of_the_power_is_half_of_what_is_radiated_where_no_limit_holds(said: str) -> None:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    session.say("energy efficiency, circuit power 8 W")
    decided = session.state.run
    assert decided is not None
    radiated_w = decided.decision.total_power_w
    assert radiated_w < 10
    agreed(session, said)
    assert session.request is not None
    assert session.request.constraints["max_power_w"] == pytest.approx(radiated_w / 2, rel=1e-5)

"""What power rates take, whether a power is needed, what a user's channel is like, and who holds the rest back."""

from __future__ import annotations

import re

import numpy as np
import pytest
from conversations import LOSS, SEED, talk

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.model.units import human

HELD = "highest total rate, 300 kbit/s each"


def reply(*lines: str) -> str:
    turn = talk(*lines)[1][-1]
    assert turn.stage in ("answered", "nothing")
    return turn.reply


@pytest.mark.parametrize("asked", ["how many watts would 1 Mbit/s each need?", "每人1兆最少要多少瓦"])
def test_the_power_that_rates_take_is_a_power(asked: str) -> None:
    least = talk("least power, 1 Mbit/s each")[1][-1].run
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
    _, turns = talk("least power, 300 kbit/s each", asked)
    assert told in turns[-1].reply
    assert turns[-1].stage == "answered"


def test_another_aim_is_told_beside_what_holds() -> None:
    said = reply(HELD, "would max-min be better?")
    assert re.search(r"With it: total rate .* lowest rate .* Now: total rate .* lowest rate 300 kbit/s", said)


def test_the_gain_and_the_snr_of_a_user_are_told() -> None:
    _, (*_, overall, there, nowhere) = talk(
        HELD, "what is the SNR of user 3?", "用户3在第5个子载波上的增益多大", "gain on subcarrier 999?"
    )
    run = talk(HELD)[1][0].run
    assert run is not None
    gain_db = 10 * np.log10(run.estimate.gain[2])
    own = (run.decision.owner == 2) & (run.decision.power_w > 0)
    snr_db = 10 * np.log10(run.decision.power_w[own] * run.estimate.gain[2][own] / run.decision.cell.noise_power_w)
    for figure in (gain_db.min(), gain_db.max(), snr_db.min(), snr_db.max()):
        assert f"{figure:.1f}" in overall.reply
    assert f"{gain_db[4]:.1f} dB" in there.reply
    assert f"1 to {gain_db.size}" in nowhere.reply


@pytest.mark.parametrize("asked", ["how long did it take?", "算了多久？"])
def test_how_long_it_took_cannot_be_told(asked: str) -> None:
    assert "not recorded" in reply(HELD, asked) or "不记录" in reply(HELD, asked)


@pytest.mark.parametrize("asked", ["who limits us?", "which user is the bottleneck?", "瓶颈是什么？"])
def test_what_holds_the_result_back_is_told(asked: str) -> None:
    run = talk(HELD)[1][0].run
    assert run is not None
    said = reply(HELD, asked)
    assert human(run.decision.price_of_power, "bit/s") in said
    assert "20 W" in said
    spent = np.bincount(run.decision.owner, weights=run.decision.power_w)
    assert human(float(spent.max()), "W") in said


def test_a_cap_that_holds_everybody_back_is_named() -> None:
    scene = wa.simulate("cqi", wa.Cell.nr(), num_users=4, seed=1)
    session = Session(scene, LOSS, seed=SEED, confirm=False)
    said = [session.say(line).reply for line in ("max-min", "user 2 at most 1 Mbit/s", "who limits us?")][-1]
    assert re.search(
        r"The rate cap of user 2 holds the lowest rate at 1 Mbit/s: without it, it would be .* Mbit/s", said
    )

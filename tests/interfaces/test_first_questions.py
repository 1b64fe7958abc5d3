"""Questions that come first: answered for what they name, though nothing was asked for yet, and nothing is changed."""

from __future__ import annotations

import pytest
from conversations import talk

pytestmark = pytest.mark.machine_code


@pytest.mark.parametrize(
    ("said", "supposed"),
    [
        ("is 3 Mbit/s each possible?", "the least power: at least 3 Mbit/s for each user"),
        ("what's the highest total rate with 10 W?", "the highest total rate: at most 10 W"),
        ("what if we only had 5 W?", "the highest total rate: at most 5 W"),
        ("how fast can the slowest user be?", "the highest rate for the slowest user"),
        ("what would proportional fairness give?", "a fair share for everyone"),
        ("could user 3 get 4 Mbit/s?", "at least 4 Mbit/s for user 3"),
        ("What is the least power for 2 Mbps per user?", "the least power: at least 2 Mbit/s for each user"),
        ("how energy efficient can the cell be?", "the most bits per joule"),
        ("Combien de débit peut-on atteindre au total avec 5 W ?", "5 W"),
        ("5瓦够每人1M吗？", "总速率最高：发射功率不超过 5 W"),
    ],
)
def test_a_question_needs_no_request_before_it(said: str, supposed: str) -> None:
    session, (turn,) = talk(said)
    assert turn.stage == "answered"
    assert supposed in turn.reply
    assert session.request is None


def test_what_was_asked_first_is_taken_up() -> None:
    session, turns = talk("what if we only had 5 W?", "do that")
    assert turns[-1].stage == "applied"
    assert session.request is not None
    assert (session.request.objective, dict(session.request.constraints)) == ("max_rate", {"max_power_w": 5.0})


def test_a_question_of_what_is_has_nothing_to_tell_of_yet() -> None:
    assert "nothing yet" in talk("why does user 3 get nothing?")[1][0].reply

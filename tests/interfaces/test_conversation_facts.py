"""Questions about what is: answered for what is in effect, with what they take for granted put right."""

from __future__ import annotations

import pytest
from conversations import LOSS, SCENE, SEED

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn

HELD = "highest total rate, 300 kbit/s each, at most 10 W"
UNMET = "30 Mbit/s each"


def talk(*lines: str) -> list[Turn]:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    return [session.say(line) for line in lines]


@pytest.mark.parametrize(
    "said",
    ["why did user 3 get nothing?", "what is the total rate now?", "who gets the least?", "第3个子载波给了谁",
     "现在总速率是多少？", "how much does it cost me"],
)  # fmt: skip
def test_what_is_in_effect_is_told_also_after_what_cannot_be_met(said: str) -> None:
    answer, before = talk(HELD, UNMET, said)[-1].reply, talk(HELD, said)[-1].reply
    assert before in answer
    assert "cannot be met: " in answer or "无法满足，以下" in answer
    assert "nobody does" not in answer


@pytest.mark.parametrize("said", ["why not?", "what would one more watt buy?"])
def test_why_it_cannot_be_met_is_of_the_request(said: str) -> None:
    assert "The request cannot be met" in talk(HELD, UNMET, said)[-1].reply


@pytest.mark.parametrize(
    ("aim", "said", "told"),
    [
        ("highest total rate", "why does user 1 get the least?", "user 1 does not get the least"),
        ("highest total rate", "为什么1号什么都没有", "用户1并非什么都没有"),
        ("max-min", "为什么2号分到的最少？", "4 个用户得到的速率一样多"),
        ("highest total rate", "why does user 2 get the most?", "user 1 gets the most"),
    ],
)
def test_what_is_not_so_is_put_right(aim: str, said: str, told: str) -> None:
    assert told in talk(aim, said)[-1].reply


@pytest.mark.parametrize("said", ["why does user 3 get nothing?", "why does user 1 get the most?", "为什么3号最少"])
def test_what_is_so_is_only_explained(said: str) -> None:
    assert "does not get" not in talk("highest total rate", said)[-1].reply
    assert "并非" not in talk("highest total rate", said)[-1].reply
    assert "并不是" not in talk("highest total rate", said)[-1].reply

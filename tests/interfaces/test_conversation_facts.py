"""Questions about what is: answered for what is in effect, with what they take for granted put right."""

from __future__ import annotations

import pytest
from conversations import talk

pytestmark = pytest.mark.machine_code

HELD = "highest total rate, 300 kbit/s each, at most 10 W"
UNMET = "30 Mbit/s each"


@pytest.mark.parametrize(
    "said",
    ["why did user 3 get nothing?", "what is the total rate now?", "who gets the least?", "第3个子载波给了谁",
     "现在总速率是多少？", "how much does it cost me"],
)  # fmt: skip
def test_what_is_in_effect_is_told_also_after_what_cannot_be_met(said: str) -> None:
    answer, before = talk(HELD, UNMET, said)[1][-1].reply, talk(HELD, said)[1][-1].reply
    assert before in answer
    assert "cannot be met: " in answer or "无法满足，以下" in answer
    assert "nobody does" not in answer


@pytest.mark.parametrize("said", ["why not?", "what would one more watt buy?"])
def test_why_it_cannot_be_met_is_of_the_request(said: str) -> None:
    assert "The request cannot be met" in talk(HELD, UNMET, said)[1][-1].reply


@pytest.mark.parametrize(
    ("aim", "said", "told"),
    [
        ("highest total rate", "why does user 1 get the least?", "user 1 does not get the least"),
        ("highest total rate", "为什么1号什么都没有", "用户1并非什么都没有"),
        ("max-min", "为什么2号分到的最少？", "4 个用户得到的速率一样多"),
        ("highest total rate", "why does user 2 get the most?", "User 1 gets the most"),
    ],
)
def test_what_is_not_so_is_put_right(aim: str, said: str, told: str) -> None:
    assert told in talk(aim, said)[1][-1].reply


@pytest.mark.parametrize("said", ["why does user 3 get nothing?", "why does user 1 get the most?", "为什么3号最少"])
def test_what_is_so_is_only_explained(said: str) -> None:
    assert "does not get" not in talk("highest total rate", said)[1][-1].reply
    assert "并非" not in talk("highest total rate", said)[1][-1].reply
    assert "并不是" not in talk("highest total rate", said)[1][-1].reply


@pytest.mark.parametrize(
    "said",
    ["what limits hold now?", "which limits apply", "what are the current limits?", "what did I ask for?",
     "what have I asked for so far?", "我刚才要求了什么", "现在有哪些限制？"],
)  # fmt: skip
def test_what_was_asked_for_is_restated(said: str) -> None:
    turn = talk(HELD, said)[1][-1]
    assert (turn.intent.topic, turn.stage) == ("status", "answered")
    assert "10 W" in turn.reply.split("\n")[0]


@pytest.mark.parametrize(
    "said",
    [
        "how sure is this?",
        "how reliable are the rates?",
        "how sure are you about these rates",
        "are you sure?",
        "结果有多可靠？",
    ],
)
def test_how_sure_it_is_is_of_the_channel_and_the_promises(said: str) -> None:
    turn = talk(HELD, said)[1][-1]
    assert turn.intent.topic == "uncertainty"
    assert "20 %" in turn.reply
    assert "95 %" in turn.reply
    assert talk(HELD, "how do you know it is the best?")[1][-1].intent.topic == "certificate"


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("is that ok for the others?", "get nothing"),
        ("did anyone lose out?", "get nothing"),
        ("who should I leave out?", "user 2 takes the most power for its rate"),
        ("应该放弃谁？", "用户2用的功率最多"),
        ("what did turn 1 say?", "highest total rate, at most 10 W"),
        ("what if the delay spread were 1 us?", "as it was sensed"),
        ("how much do we lose to missing CSI?", "0 % of the gains"),
        ("compare with foo", "No method or repairer called foo"),
        ("和foo比较", "foo 既不是"),
        ("export as foo", "got foo"),
        ("save this as csv", "got csv"),
        ("导出为pdf", "收到 pdf"),
        ("export as TMF921", "Intent"),
        ("export as json", "SubNetwork"),
        ("compare with before", "no earlier decision"),
        ("how fair is this", "Jain's fairness index: 0."),
        ("is that fair?", "Jain's fairness index: 0."),
        ("what is max-min fair?", "smallest rate"),
        ("what's the energy efficiency", "Energy efficiency: "),
        ("how much power do we use", "Radiated power: 10 W."),
        ("用了多少功率？", "发射功率：10 W"),
        ("how many users are served", "2 of 4 users are served. User 3 and user 4 get nothing. User 1 gets the most"),
        ("is anyone left out?", "2 of 4 users are served."),
    ],
)
def test_a_question_has_its_own_answer(said: str, told: str) -> None:
    assert told in talk("highest total rate, at most 10 W", said)[1][-1].reply


def test_better_is_compared_and_wasted_is_worked_out() -> None:
    _, turns = talk(
        HELD, "now with 5 W", "was that better?", "are we wasting energy?", UNMET, "who should I leave out?"
    )
    assert turns[2].tables
    assert "turn 1" in turns[2].reply
    assert "319 mW" in turns[3].reply
    assert "What can be met" in turns[5].reply

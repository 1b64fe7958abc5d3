"""Lines that only the conversation gives a meaning: whatever the recogniser, none of them ever reaches it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from conversations import LOSS, SCENE, SEED, PartlyScripted, Scripted, agreed, asked_for, asks, means
from hypothesis import given, settings
from hypothesis import strategies as st

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.language.conversation import understood
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Question
from wirelessagent.language.request import Request

pytestmark = pytest.mark.machine_code

Said = str | tuple[str, Intent]
TOTAL = "highest total rate"
WONDERED = ("what if 5 W?", means("question", topic="what_if", details={"constraints": {"max_power_w": 5.0}}))


def talk(*lines: Said, confirm: bool = False) -> tuple[Session, list[Turn]]:
    """A conversation in which a line alone may not need the recogniser, which knows only those with an intent."""
    script = PartlyScripted(line for line in lines if not isinstance(line, str))
    session = Session(SCENE, LOSS, seed=SEED, recogniser=script, confirm=confirm)
    turns = [agreed(session, line) if isinstance(line, str) else session.say(line[0]) for line in lines]
    assert not script.left
    return session, turns


def request(**constraints: Any) -> tuple[str, Intent]:
    return TOTAL, asks("max_rate", **constraints)


def change(**constraints: Any) -> tuple[str, Intent]:
    return "and so on", asks("max_rate", amends=True, **constraints)


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("No, I meant user 3.", {"3": 1e6}),
        ("sorry, for user 3", {"3": 1e6}),
        ("no, user 3, not user 2", {"3": 1e6}),
        ("不对，应该是3号", {"3": 1e6}),
        ("不是2号，是3号", {"3": 1e6}),
        ("no, I meant 1.5 Mbit/s", {"2": 1.5e6}),
        ("make it 1.5 Mbit/s", {"2": 1.5e6}),
        ("不，我是说1.5 Mbit/s", {"2": 1.5e6}),
        ("改为1.5 Mbit/s", {"2": 1.5e6}),
        ("user 3 too", {"2": 1e6, "3": 1e6}),
        ("the same for user 3", {"2": 1e6, "3": 1e6}),
        ("3号也一样", {"2": 1e6, "3": 1e6}),
        ("user 2 no longer needs a minimum rate", {}),
        ("drop user 2's minimum rate", {}),
        ("2号不需要保证速率了", {}),
        ("取消2号的最低速率", {}),
        ("nobody needs a guarantee any more", {}),
        ("double the rate", {"2": 2e6}),
        ("halve user 2's rate", {"2": 5e5}),
        ("raise the rates by 50 %", {"2": 1.5e6}),
        ("速率提高一倍", {"2": 2e6}),
        ("把最低速率降低20%", {"2": 8e5}),
    ],
)
def test_changes_of_a_users_rate(said: str, left: dict[str, float]) -> None:
    session, _ = talk(request(max_power_w=10.0, min_rate_bps={"2": 1e6}), said)
    expected = {"max_power_w": 10.0} | ({"min_rate_bps": left} if left else {})
    held = asked_for(session)
    assert held.get("min_rate_bps", {}) == pytest.approx(left)
    assert held.keys() == expected.keys()


def test_a_correction_after_a_question_back_keeps_its_user() -> None:
    session, turns = talk(request(), "user 3, please", "no, I meant 1.5 Mbit/s")
    assert [turn.stage for turn in turns] == ["applied", "asked", "applied"]
    assert "user 3" in turns[1].reply
    assert "aim" not in turns[1].reply
    assert asked_for(session) == {"min_rate_bps": {"3": 1.5e6}}


def test_a_correction_corrects_what_was_stated_last_and_nothing_else() -> None:
    session, _ = talk(
        request(min_rate_bps={"2": 1e6, "4": 3e5}), change(min_rate_bps={"1": 2e5}), "no, user 3", "I meant 400 kbit/s"
    )
    assert asked_for(session) == {"min_rate_bps": {"2": 1e6, "4": 3e5, "3": 4e5}}
    session, _ = talk(request(min_rate_bps={"2": 1e6}), change(min_rate_bps={"2": 1e6}), "no, user 3")
    assert asked_for(session) == {"min_rate_bps": {"3": 1e6}}
    session, _ = talk(request(), change(leave_out=("1",)), "sorry, user 3")
    assert asked_for(session) == {"leave_out": ("3",)}
    session, _ = talk(request(), change(max_power_w=10.0), "actually 5 W")
    assert asked_for(session) == {"max_power_w": 5.0}


@pytest.mark.parametrize(
    ("line", "power_w"),
    [
        ("power minus 4 W", 6.0),
        ("minus 4 W", 6.0),
        ("it's 8 actually", 8.0),
        ("at most -4 W", 10.0),
        ("max -3 W", 10.0),
    ],
)
def test_what_is_taken_off_lowers_a_limit_and_no_limit_is_negative(line: str, power_w: float) -> None:
    session, _ = talk(request(max_power_w=10.0), line)
    assert asked_for(session) == {"max_power_w": power_w}


def test_one_users_limit_goes_where_a_limit_for_all_holds() -> None:
    session, (_, turn, other) = talk(
        request(min_rate_bps=1e6, max_rate_bps=5e6), "drop user 2's floor", "3号不用限速了"
    )
    assert asked_for(session) == {
        "min_rate_bps": {"all": 1e6, "2": 0.0}, "max_rate_bps": {"1": 5e6, "2": 5e6, "4": 5e6},
    }  # fmt: skip
    assert "each user but user 2" in turn.reply
    assert other.intent.language == "zh"


def test_what_was_taken_off_one_user_can_be_corrected() -> None:
    capped = request(max_rate_bps=2e6)
    session, _ = talk(capped, "lift the cap on user 2", "sorry, user 3", "no, user 1")
    assert asked_for(session) == {"max_rate_bps": {"2": 2e6, "3": 2e6, "4": 2e6}}
    session, _ = talk(request(min_rate_bps={"2": 1e6}), "user 2 needs no minimum rate any more", "I meant 300 kbit/s")
    assert asked_for(session) == {"min_rate_bps": {"2": 3e5}}


def test_it_is_what_was_stated_last() -> None:
    session, _ = talk(request(max_power_w=4.0, min_rate_bps=1e5), change(min_rate_bps={"2": 4e5}), "double it")
    assert asked_for(session) == {"max_power_w": 4.0, "min_rate_bps": {"all": 1e5, "2": 8e5}}
    session, _ = talk(request(min_rate_bps=1e5), change(max_power_w=4.0), "double it")
    assert asked_for(session) == {"max_power_w": 8.0, "min_rate_bps": 1e5}


def test_half_the_power_is_half_of_what_may_be_radiated() -> None:
    session, _ = talk(request(max_power_w=30.0), "at most half the power")
    assert asked_for(session) == {"max_power_w": 10.0}


@pytest.mark.parametrize("said", ["also serve user 2", "add user 2", "include user 2 too", "再加上2号", "2号也加上"])
def test_a_user_more_is_taken_in(said: str) -> None:
    session, _ = talk(request(users=("1", "3")), said)
    assert asked_for(session) == {"users": ("1", "3", "2")}
    session, _ = talk(request(leave_out=("2", "4")), said)
    assert asked_for(session) == {"leave_out": ("4",)}
    session, _ = talk(request())
    session.say(said)
    assert asked_for(session) == {}


@pytest.mark.parametrize(
    ("said", "factor"),
    [
        ("要是功率减半呢", 0.5), ("what if the power were halved", 0.5), ("what if we had half the power?", 0.5),
        ("what if the power was 20 % lower?", 0.8),
        ("假如功率只有一半", 0.5),
    ],
)  # fmt: skip
def test_what_if_of_a_share_of_what_holds(said: str, factor: float) -> None:
    session, (_, turn) = talk(request(max_power_w=8.0), said)
    assert turn.run is not None
    problem = turn.run.decision.problem
    assert problem.max_power_w == pytest.approx(8.0 * factor)
    assert getattr(problem.objective, "name", "") == "max_rate"
    assert asked_for(session) == {"max_power_w": 8.0}
    _, (_, free) = talk(request(), said)
    assert free.run is not None
    assert free.run.decision.problem.max_power_w == pytest.approx(min(20.0, 20.0 * factor))


@pytest.mark.parametrize(
    ("said", "again", "limit_w"),
    [("3 W less", "again", 6.0), ("3 W less", "do that again", 6.0), ("halve that limit", "again", 3.0)],
)
def test_a_step_is_taken_again(said: str, again: str, limit_w: float) -> None:
    assert asked_for(talk(request(max_power_w=12.0), said, again)[0]) == {"max_power_w": limit_w}


def test_double_the_power_and_a_rate_that_nobody_promised() -> None:
    session, (_, _, turn) = talk(request(max_power_w=4.0), "double the power", "double the rates")
    assert asked_for(session) == {"max_power_w": 8.0}
    assert turn.stage in ("asked", "nothing")


@pytest.mark.parametrize(
    ("said", "power_w"),
    [
        ("undo twice", 5.0), ("undo the last 2 changes", 5.0), ("go back two steps", 5.0), ("撤销两次", 5.0),
        ("退回2步", 5.0), ("go back to turn 1", 10.0), ("revert to turn 2", 5.0), ("回到第1轮", 10.0),
        ("恢复到第二轮", 5.0), ("undo everything", None), ("undo all changes", None), ("全部撤销", None),
        ("undo 9 times", None),
    ],
)  # fmt: skip
def test_undo_goes_as_far_back_as_is_said(said: str, power_w: float | None) -> None:
    session, turns = talk(
        request(max_power_w=10.0), change(max_power_w=5.0), change(max_power_w=4.0), change(max_power_w=3.0), said
    )
    if power_w is None:
        assert session.request is None
        assert ("3" in turns[-1].reply or "4" in turns[-1].reply) == ("9" in said)
        return
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": power_w})
    assert session.state.on_air is not None
    assert session.state.on_air.decision.total_power_w == pytest.approx(power_w)


def test_what_was_gone_back_from_can_be_had_again() -> None:
    undo = ("undo", means("command", topic="undo"))
    session, (*_, back, _) = talk(request(max_power_w=10.0), change(max_power_w=5.0), "go back to turn 1", undo)
    assert back.intent.kind == "allocate"
    assert "turn 1" in back.reply
    assert asked_for(session) == {"max_power_w": 5.0}


@pytest.mark.parametrize("said", ["cancel", "cancel that", "never mind", "取消", "算了"])
def test_cancel_drops_what_waits_and_undoes_nothing(said: str) -> None:
    session, turns = talk(request(max_power_w=10.0), "yes", change(max_power_w=5.0), said, said, confirm=True)
    assert [turn.stage for turn in turns[-2:]] == ["nothing", "asked"]
    assert session.state.planned is None
    assert asked_for(session) == {"max_power_w": 10.0}
    assert session.state.on_air is not None
    assert session.state.on_air.decision.total_power_w == pytest.approx(10.0)
    unclear = ("hm", means("clarify", reply="What?", pending={"min_rate_bps": 1e6}))
    session, turns = talk(request(max_power_w=10.0), unclear, said)
    assert (turns[-1].stage, session.state.awaits) == ("nothing", "nothing")
    assert asked_for(session) == {"max_power_w": 10.0}


def test_undo_goes_on_from_where_an_undo_or_a_cancel_left_it() -> None:
    undo = ("undo", means("command", topic="undo"))
    session, _ = talk(
        request(max_power_w=10.0), change(max_power_w=5.0), change(max_power_w=4.0), change(max_power_w=3.0),
        "undo twice", undo,
    )  # fmt: skip
    assert asked_for(session) == {"max_power_w": 10.0}
    session, _ = talk(request(max_power_w=10.0), "yes", change(max_power_w=5.0), "cancel", undo, confirm=True)
    assert session.request is None


def test_cancel_keeps_a_request_whose_allocation_was_to_be_put_back() -> None:
    undo = ("undo", means("command", topic="undo"))
    lines = (request(max_power_w=10.0), "yes", change(max_power_w=5.0), "yes", undo, "cancel")
    session, turns = talk(*lines, confirm=True)
    assert [turn.stage for turn in turns[-2:]] == ["planned", "nothing"]
    assert asked_for(session) == {"max_power_w": 10.0}


def test_yes_behind_a_what_if_is_for_the_plan_which_is_named() -> None:
    session, turns = talk(request(max_power_w=10.0), WONDERED, "yes", confirm=True)
    assert "'yes' applies the highest total rate: at most 10 W" in turns[1].reply
    assert turns[2].stage == "applied"
    assert "at most 10 W" in turns[2].reply
    assert asked_for(session) == {"max_power_w": 10.0}


@pytest.mark.parametrize("said", [
    "do that", "Let's do that!", "apply that", "就这么办", "那就这么办吧", "ja, mach das", "d'accord, fais-le",
    "vale, hazlo",
])  # fmt: skip
def test_do_that_behind_a_what_if_asks_for_it(said: str) -> None:
    session, turns = talk(request(max_power_w=10.0), WONDERED, said, "yes", confirm=True)
    assert [turn.stage for turn in turns] == ["planned", "answered", "planned", "applied"]
    assert asked_for(session) == {"max_power_w": 5.0}
    status = ("status", means("command", topic="status"))
    session, turns = talk(request(max_power_w=10.0), WONDERED, status, said, confirm=True)
    assert turns[-1].stage == "applied"
    assert asked_for(session) == {"max_power_w": 10.0}


def test_apply_it_behind_a_what_if_is_for_the_plan_where_one_waits() -> None:
    session, _ = talk(request(max_power_w=10.0), WONDERED, "apply it", confirm=True)
    assert asked_for(session) == {"max_power_w": 10.0}
    session, turns = talk(request(max_power_w=10.0), "yes", WONDERED, "apply it", confirm=True)
    assert turns[-1].stage == "planned"
    assert asked_for(session) == {"max_power_w": 5.0}


def test_turns_are_compared_explained_and_shown_by_number() -> None:
    ask = (request(max_power_w=10.0), change(max_power_w=5.0), change(max_power_w=3.0))
    _, turns = talk(
        *ask, "compare with turn 2", "compare turn 1 and turn 2", "compare with turn 3", "explain turn 1",
        "what was said in turn 2",
        "和第2轮比较", "解释第一轮", "第2轮",
    )  # fmt: skip
    one, two, itself, explained, shown, zh, zh_explained, zh_shown = turns[3:]
    assert one.tables[0].columns[1:] == ("now", "turn 2")
    assert two.tables[0].columns[1:] == ("turn 1", "turn 2")
    assert "turn 3" in itself.reply
    assert not itself.tables
    assert "10 W" in explained.reply
    assert turns[1].reply in shown.reply
    assert zh.tables[0].columns[2] == "第 2 轮"
    assert "10 W" in zh_explained.reply
    assert turns[1].reply in zh_shown.reply


@pytest.mark.parametrize(
    "said",
    ["turn foo", "turn 99", "history -1", "compare with turn 99", "explain turn 0", "go back to turn 99",
     "compare with turn foo", "第99轮", "历史 -1", "和第99轮比较", "回到第99轮"],
)  # fmt: skip
def test_a_turn_that_there_is_not_is_told_in_one_sentence(said: str) -> None:
    session, turns = talk(request(max_power_w=10.0), ("status", means("command", topic="status")), said)
    assert turns[-1].stage == "asked"
    assert "1 to 2" in turns[-1].reply or "1 至 2" in turns[-1].reply
    assert len(turns[-1].reply) < 60
    assert asked_for(session) == {"max_power_w": 10.0}


def test_a_turn_without_a_decision_is_told() -> None:
    lines = (("status", means("command", topic="status")), request(), "explain turn 1", "go back to turn 1")
    session, turns = talk(*lines)
    assert [turn.stage for turn in turns[2:]] == ["asked", "asked"]
    assert "turn 1" in turns[2].reply
    assert session.request is not None


def test_an_answer_keeps_the_aim_and_the_users_of_what_was_asked_about() -> None:
    unclear = means("clarify", reply="Bits or bytes?", pending={"max_power_w": 10.0})
    session, _ = talk(("least power with 10 W and 1 MB for user 3", unclear), "8 Mbit/s")
    assert session.request == Request(
        objective="min_power", constraints={"max_power_w": 10.0, "min_rate_bps": {"3": 8e6}}
    )
    session, _ = talk(
        request(max_power_w=5.0), ("what about user 3?", means("clarify", reply="What?")), "at most 1 Mbit/s"
    )
    assert asked_for(session) == {"max_power_w": 5.0, "max_rate_bps": {"3": 1e6}}


def test_a_second_question_keeps_what_led_to_the_first() -> None:
    first = means("clarify", language="zh", reply="？", pending={"max_power_w": 10.0})
    again = means("clarify", language="zh", reply="？", pending={"outage_probability": 0.1})
    session, turns = talk(("功率最低，10 W，3号1兆字节", first), ("90 %", again), "8 Mbit/s")
    assert session.request == Request(
        objective="min_power",
        constraints={"max_power_w": 10.0, "outage_probability": 0.1, "min_rate_bps": {"3": 8e6}},
    )
    assert turns[-1].intent.language == "zh"


def test_an_answer_about_one_user_leaves_the_others_what_was_read() -> None:
    question = Question(pending={"min_rate_bps": {"3": 1e6}})
    asked = Context(awaits="clarification", objective="max_rate", question=question)
    intent = OfflineRecogniser().recognise("user 4 at least 2 Mbit/s", asked)
    assert intent.constraints["min_rate_bps"] == {"3": 1e6, "4": 2e6}


def test_figures_that_answer_stay_with_their_users_while_the_aim_is_open() -> None:
    pending = means("clarify", reply="Which aim?", pending={"min_rate_bps": {"3": 1.6e7}, "max_power_w": 4.0})
    aim = ("highest total rate", asks("max_rate"))
    session, turns = talk(("2 MB per second for user 3, 4 W", pending), "no, 1.6 Mbit/s", aim)
    assert "for user 3" in turns[1].reply
    assert session.request == Request(objective="max_rate")
    assert plain_question(turns[1]) == {"min_rate_bps": {"3": 1.6e6}, "max_power_w": 4.0}


def plain_question(turn: Turn) -> dict[str, Any]:
    return {name: dict(value) if isinstance(value, Mapping) else value for name, value in turn.intent.pending.items()}


def test_yes_to_did_you_mean_does_what_was_meant() -> None:
    session, turns = talk(
        request(max_power_w=10.0), change(max_power_w=5.0), ("hm", means("clarify", reply="?", offered="undo")), "yes"
    )
    assert turns[-1].stage == "undone"
    assert asked_for(session) == {"max_power_w": 10.0}
    unclear = means("clarify", reply="?", offered="min_power", pending={"min_rate_bps": 1e5})
    session, _ = talk(("hm", unclear), "yes")
    assert session.request == Request(objective="min_power", constraints={"min_rate_bps": 1e5})
    _, turns = talk(("hm", means("clarify", reply="Bits or bytes?")), ("yes", means("command", topic="confirm")))
    assert turns[-1].stage == "answered"


@pytest.mark.parametrize(
    ("said", "asked"), [("user 4", "user 4"), ("hmm", "change"), ("4号", "用户4"), ("随便", "更改")]
)
def test_what_to_change_is_asked_without_the_aim(said: str, asked: str) -> None:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    session.say(TOTAL)
    reply = session.say(said).reply
    assert asked in reply
    assert "aim for" not in reply
    assert "为目标" not in reply


def test_what_was_left_open_of_one_user_does_not_stick_to_another() -> None:
    unclear = means("clarify", language="zh", reply="3号要怎样？", pending={"weights": {"1": 3.0}})
    script = Scripted([asks("max_rate"), unclear, asks("max_rate", amends=True, min_rate_bps=1e6, leave_out=("4",))])
    session = Session(SCENE, LOSS, seed=SEED, recogniser=script, confirm=False)
    for text in (TOTAL, "3号重要性是1号的三倍", "保证速率1兆，除了4号"):
        session.say(text)
    context = script.contexts[-1]
    assert context is not None
    assert (context.awaits, dict(context.question.pending)) == ("nothing", {})


@pytest.mark.parametrize(
    ("said", "topic"),
    [
        ("信道怎么样", "uncertainty"), ("信道质量如何？", "uncertainty"), ("how is the channel?", "uncertainty"),
        ("channel quality", "uncertainty"), ("how's the result?", "explain"), ("结果如何", "explain"),
    ],
)  # fmt: skip
def test_the_channel_and_the_result_are_told_of(said: str, topic: str) -> None:
    _, (_, turn) = talk(request(), said)
    assert (turn.intent.topic, turn.stage) == (topic, "answered")


@pytest.mark.parametrize(
    ("said", "topic"),
    [("why is user 3 so slow", "why_user"), ("why is 3 so slow", "why_user"),
     ("warum kriegt die 3 so wenig", "why_user"), ("pourquoi le 3 est-il si lent", "why_user"),
     ("wie läuft die 3", "why_user")],
)  # fmt: skip
def test_a_question_about_a_user_needs_no_mark_and_no_word_for_one(said: str, topic: str) -> None:
    _, (_, turn) = talk("highest total rate", said)
    assert (turn.intent.topic, turn.intent.details, turn.stage) == (topic, {"user": "3"}, "answered")


@pytest.mark.parametrize(
    ("said", "topic"),
    [("用户的速率怎么样", "users"), ("Is the link of user 2 any good?", "users"), ("方案怎么样呢", "other")],
)
def test_a_question_does_not_ask_for_the_aim_again(said: str, topic: str) -> None:
    aim = means("clarify", reply="What should the cell aim for?")
    _, (_, turn) = talk(request(), (said, aim))
    assert (turn.intent.topic, turn.stage) == (topic, "answered")
    _, (first,) = talk((said, aim))
    assert first.stage == "asked"
    _, (_, limits) = talk(request(), (said, means("clarify", reply="Which?", pending={"min_rate_bps": 1e6})))
    assert limits.stage == "asked"


@pytest.mark.parametrize("said", ["same requirements, but least power", "同样的要求，功耗最小", "要求不变，功率最低"])
def test_the_same_requirements_keep_the_limits(said: str) -> None:
    held = Context(objective="max_rate", constraints={"min_rate_bps": 1e6})
    intent = OfflineRecogniser().recognise(said, held)
    assert (intent.kind, intent.objective, intent.amends) == ("allocate", "min_power", True)


@pytest.mark.parametrize("said", ["green but quick"])
def test_efficient_and_fast_is_the_energy_efficiency(said: str) -> None:
    assert OfflineRecogniser().recognise(said).objective == "max_energy_efficiency"
    clear = OfflineRecogniser().recognise("fair but not slow")
    assert clear.objective == "proportional_fairness"


def test_who_read_a_line_is_told_in_plain_words() -> None:
    why = "(Read by the offline recogniser; the LLM did not answer: HTTP 500.)"
    other = Intent(
        kind="allocate", objective="max_rate", constraints={}, language="en", confidence=1.0, evidence={},
        reply=f"The highest total rate. {why}", recogniser="offline (the LLM did not answer: HTTP 500)",
    )  # fmt: skip
    _, (turn,) = talk((TOTAL, other))
    assert turn.reply.endswith(why)
    assert turn.reply.count("HTTP 500") == 1
    _, (turn,) = talk((TOTAL, Intent(**{**_fields(other), "recogniser": "mine", "reply": "A wish (of mine)"})))
    assert turn.reply.endswith("(Read by the mine recogniser.)")


def _fields(intent: Intent) -> dict[str, Any]:
    return {name: getattr(intent, name) for name in intent.__dataclass_fields__}


_WORDS = (
    "不是", "应该是", "改成", "的", "给", "no", "sorry", ",", "user 3", "3号", "再", "加上", "增加", "also", "in",
    "then", "double", "half", "the", "rate", "power", "be", "been", "速率", "功率", "提高", "一倍", "一半", "取消",
    "第1轮", "turn", "compare", "with", "is", "channel", "信道", "what if", "had", "10 W", "1 Mbit/s", "至少", "那就",
    "照", "这么", "不再", "需要", "限制", "needs no", "limit", "20 %", "undo", "2", "all",
)  # fmt: skip
_OPEN = Context(
    user_names=SCENE.sensed.user_names, objective="max_rate", constraints={"min_rate_bps": 1e6}, awaits="clarification",
    question=Question(objective="max_rate", users=("3",), offered="undo"),
    supposed_objective="max_rate",
)  # fmt: skip


@given(st.lists(st.sampled_from(_WORDS), min_size=1, max_size=4), st.sampled_from(["", " "]), st.booleans())
@settings(max_examples=150)
def test_any_line_is_read_at_once_and_nothing_is_raised(words: list[str], between: str, repeated: bool) -> None:
    text = between.join(words * (40 if repeated else 1))[:199]
    assert isinstance(understood(text, _OPEN, Scripted([means("out_of_scope")])), Intent)


@pytest.mark.parametrize(
    "said",
    [
        "turn it off", "turn the power down to 5 W", "use the power better", "serve only user 2", "drop user 2",
        "user 3", "user 2 needs 2 Mbit/s", "make it fast", "undo", "cancel the power limit", "取消功率限制",
        "highest total rate for user 3 instead", "只服务2号", "降低功率",
        "compare with greedy", "history", "explain the result", "do more for user 2", "what if user 3 were gone?",
        "double the rate with half the power", "取消上一次改动", "是", "no",
    ],
)  # fmt: skip
def test_sentences_of_their_own_are_left_to_the_recogniser(said: str) -> None:
    context = Context(
        user_names=SCENE.sensed.user_names, objective="max_rate", constraints={"min_rate_bps": {"2": 1e6}},
        supposed_objective="max_rate",
    )  # fmt: skip
    assert understood(said, context, Scripted([means("question")])).kind == "question"


@pytest.mark.parametrize(
    ("first", "line", "language"),
    [
        ("máxima tasa, al menos 500 kbit/s cada uno", "mejor 800 kbit/s", "es"), ("highest total rate", "plus 6", "en"),
        ("höchste Gesamtrate", "Nutzer 8 weglassen", "de"), ("总速率最高", "10 W", "zh"),
        ("highest total rate", "ja, bitte", "de"), ("débit total maximal", "and what does user 3 get?", "en"),
    ],
)  # fmt: skip
def test_a_short_line_is_answered_in_the_language_of_its_talk(first: str, line: str, language: str) -> None:
    session = Session(SCENE, LOSS, seed=SEED)
    session.say(first)
    assert session.say(line).intent.language == language

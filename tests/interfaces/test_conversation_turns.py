"""What a line asks for, keeps or leaves alone because of the lines before it, with the offline recogniser."""

from __future__ import annotations

import pytest
from conversations import talked_into as talk

HELD = "highest total rate, at most 10 W"


def test_reports_do_not_add_up() -> None:
    assert "15 W" not in talk(HELD, "昨天我们是15瓦", "3号投诉说他只有1兆")[1][-1].reply


def test_another_aim_keeps_the_limits_and_starting_over_tells_which_go() -> None:
    held, turns = talk(HELD, "proportional fairness")
    assert held == {"max_power_w": 10.0}
    assert "at most 10 W of radiated power" in turns[-1].lines.decided
    assert "No longer" not in turns[-1].lines.changed
    held, turns = talk(HELD, "new request: least power with 200 kbit/s each")
    assert held == {"min_rate_bps": 2e5}
    assert "No longer: at most 10 W of radiated power." in turns[-1].reply


def test_the_promise_to_who_is_left_out_rests() -> None:
    held, turns = talk(HELD, "user 3 at least 100 kbit/s", "leave user 3 out")
    assert held == {"max_power_w": 10.0, "min_rate_bps": {"3": 1e5}, "leave_out": ("3",)}
    assert "100 kbit/s promised to it rest" in turns[-1].reply
    held, turns = talk(HELD, "user 3 at least 100 kbit/s", "leave user 3 out", "user 3 is back")
    assert held == {"max_power_w": 10.0, "min_rate_bps": {"3": 1e5}}


def test_nobody_is_promised_a_rate_and_left_out_at_once() -> None:
    first = "highest total rate, user 3 at least 1 Mbit/s, leave user 3 out"
    assert "leave_out" not in talk(first, HELD)[0]


@pytest.mark.parametrize(
    "said", ["what holds now?", "what's in effect?", "what did you understand?", "现在要求是什么?"]
)
def test_what_holds_is_restated(said: str) -> None:
    assert "10 W" in talk(HELD, said)[1][-1].reply.split("\n")[0]


def test_why_not_is_of_what_could_not_be_met() -> None:
    _, turns = talk(HELD, "what if we had 1 mW and 50 Mbit/s for each user?", "why not?", "do that")
    assert "50 Mbit/s" in turns[2].reply
    assert turns[3].stage == "asked"
    assert "which of the ways" in turns[3].reply.lower()
    _, turns = talk(HELD, "what if 5 W?", "go on, do that")
    assert turns[-1].stage == "applied"


@pytest.mark.parametrize(("said", "rate"), [("I meant 600k", 6e5), ("make it 600", 6e5), ("sorry, 450", 4.5e5)])
def test_a_bare_number_has_the_unit_of_what_it_corrects(said: str, rate: float) -> None:
    assert talk(HELD, "user 3 at least 500 kbit/s", said)[0]["min_rate_bps"] == {"3": rate}
    assert talk(HELD, "user 3 at least 5 Mbit/s", "make it 600")[0]["min_rate_bps"] in ({"3": 5e6}, {"3": 6e5})


@pytest.mark.parametrize(
    ("said", "reply"),
    [
        ("thanks, that's it", "You're welcome."), ("thank you, that will be all for today", "You're welcome."),
        ("danke, das wär's", "Gern geschehen."), ("vielen Dank", "Gern geschehen."), ("gracias, nada más", "De nada."),
        ("ok, gracias", "De nada."), ("merci, ce sera tout", "De rien."), ("谢谢，就这样", "不客气。"),
    ],
)  # fmt: skip
def test_thanks_end_a_talk_and_order_nothing(said: str, reply: str) -> None:
    held, turns = talk(HELD, said)
    assert (held, turns[-1].reply) == ({"max_power_w": 10.0}, reply)


def test_the_first_one_thanks_and_nothing_to_stop() -> None:
    _, turns = talk(HELD, "now with 5 W", "compare with the first one", "和第一次比一比", "this or turn 1?")
    assert all(turn.tables[0].columns[2] in ("turn 1", "第 1 轮") for turn in turns[2:])
    held, turns = talk(HELD, "thanks", "谢谢", "don't change anything", "stop")
    assert [turn.reply for turn in turns[1:]] == ["You're welcome.", "不客气。", *["All stays as it is."] * 2]
    assert held == {"max_power_w": 10.0}


@pytest.mark.parametrize("said", ["never mind, serve everyone", "都恢复服务"])
def test_users_are_taken_back(said: str) -> None:
    assert talk(HELD, "leave user 3 out", said)[0] == {"max_power_w": 10.0}
    assert talk(HELD, said)[1][-1].stage == "asked"


def test_a_correction_after_a_question_is_of_the_line_that_led_to_it() -> None:
    held, turns = talk(HELD, "leave user 3 out", "user 2 at least 1 MB", "oops, I meant user 4")
    assert (held, turns[-1].stage) == ({"max_power_w": 10.0, "leave_out": ("3",)}, "asked")


def test_a_user_who_is_not_there_is_named_at_once() -> None:
    _, turns = talk("user 9 gets 1 Mbit/s", "user 2", "highest total rate")
    assert "no user 9" in turns[0].reply
    held, _ = talk("user 9 gets 1 Mbit/s", "user 2", "highest total rate")
    assert held == {"min_rate_bps": {"2": 1e6}}
    assert talk(HELD, "user 9 gets 1 Mbit/s", "leave user 3 out")[0] == {"max_power_w": 10.0, "leave_out": ("3",)}


def test_that_rates_are_promised_at_95_percent_is_told_once_until_it_changes() -> None:
    lines = (
        "least power with 100 kbit/s each", "now with 200 kbit/s each", HELD, "每个用户至少100k",
        "what if 150 kbit/s each?", "promises kept with 99 %", "without the reliability",
    )  # fmt: skip
    _, turns = talk(*lines)
    told = ["No probability was named" in turn.reply or "未指定概率" in turn.reply for turn in turns]
    assert told == [True, *[False] * 5, True]
    assert all(turn.run is not None and turn.run.notes for turn in (turns[1], turns[3]))


def test_what_if_is_answered_for_the_figure_that_is_named() -> None:
    turn = talk(HELD, "what if at least 300 kbit/s for everyone?")[1][-1]
    assert turn.run is not None
    assert turn.run.decision.problem.min_rate_bps == 3e5
    assert "300 kbit/s" in turn.reply


@pytest.mark.parametrize(
    ("said", "echoed"), [("33 dBm", "33 dBm (1.995 W)"), ("30 dBm", "1 W"), ("2.34567 W", "2.346 W")]
)
def test_figures_are_echoed_as_people_read_them(said: str, echoed: str) -> None:
    held, turns = talk(f"highest total rate, at most {said}")
    assert f"at most {echoed} of radiated power" in turns[-1].reply
    assert held["max_power_w"] == pytest.approx({"33 dBm": 10**0.3, "30 dBm": 1.0}.get(said, 2.34567), rel=1e-12)


@pytest.mark.parametrize(
    ("line", "answer", "language"),
    [
        ("le débit total maximal", "non", "fr"),
        ("höchste Gesamtrate", "nein", "de"),
        ("la mayor velocidad total", "no", "es"),
    ],
)
def test_a_word_is_answered_in_the_language_of_the_talk(line: str, answer: str, language: str) -> None:
    _, turns = talk(line, answer)
    assert [turn.intent.language for turn in turns] == [language, language]

"""Lines that say of another user what was said last, that go back, that deny, and those behind a question back."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import talk, talked_into

from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context

pytestmark = pytest.mark.machine_code

LEAST_POWER = "least power, 200 kbit/s for everybody"


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        ((LEAST_POWER, "leave user 2 out", "user 3 too"), {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        ((LEAST_POWER, "without user 2", "and three as well"), {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        (("kleinste Leistung, 200 kbit/s für alle", "ohne Nutzer 2", "Nutzer 3 auch nicht"),
         {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        (("puissance minimale, 200 kbit/s chacun", "sans l'utilisateur 2", "le 3 non plus"),
         {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        (("mínima potencia, 200 kbit/s para todos", "sin el usuario 2", "y al tres también"),
         {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        (("功率最低，每人200k", "2号不服务", "3号也一样"), {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        ((LEAST_POWER + ", users 2 and 3 not served", "let 2 back in", "3 as well"), {"min_rate_bps": 2e5}),
        (("mínima potencia, 200 kbit/s para todos", "no sirvas al usuario 2", "tampoco al 3"),
         {"min_rate_bps": 2e5, "leave_out": ("2", "3")}),
        (("proportional fair", "user 2 counts double", "3 likewise"), {"weights": {"2": 2.0, "3": 2.0}}),
        (("highest total rate", "serve only user 2", "user 3 too"), {"users": ("2", "3")}),
        (("proportional fairness, 10 W, leave out user 2", "and three as well"),
         {"max_power_w": 10.0, "leave_out": ("2", "3")}),
    ],
)  # fmt: skip
def test_what_was_said_last_is_said_of_another_user(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert talked_into(*lines)[0] == held


@pytest.mark.parametrize("said", ["user 3 too", "user 3 neither"])
def test_what_was_said_of_the_cell_is_said_of_no_user(said: str) -> None:
    held, turns = talked_into("highest total rate", "at most 10 W", said)
    assert (held, turns[-1].stage) == ({"max_power_w": 10.0}, "asked")


@pytest.mark.parametrize("said", ["user 3 too?", "3 as well?", "not user 3"])
def test_a_question_takes_nobody_out(said: str) -> None:
    assert talked_into("highest total rate", "leave user 2 out", said)[0] == {"leave_out": ("2",)}


def test_one_user_stands_for_another() -> None:
    assert talked_into("highest total rate, user 2 out", "not user 2 but user 3")[0] == {"leave_out": ("3",)}


def test_an_answer_keeps_what_the_question_holds() -> None:
    _, turns = talked_into("highest total rate", "one of the users gets 1 Mbit/s", "user 3, and 8 W")
    assert [turn.stage for turn in turns] == ["applied", "asked", "asked"]


@pytest.mark.parametrize("said", ["user 3 neither", "3 not either"])
def test_a_promise_is_not_said_of_another_user_by_neither(said: str) -> None:
    assert talked_into("highest total rate", "user 2 at least 1 Mbit/s", said)[0] == {"min_rate_bps": {"2": 1e6}}


@pytest.mark.parametrize(
    "said",
    [
        "don't leave user 3 out",
        "don't cut user 3 off",
        "don't throw user 3 out",
        "never exclude user 3",
        "3号不要停",
        "别把3号去掉",
    ],
)
def test_whoever_is_not_to_go_stays(said: str) -> None:
    assert talked_into(LEAST_POWER, said)[0] == {"min_rate_bps": 2e5}


@pytest.mark.parametrize(
    ("first", "back"),
    [
        ("top sum rate, 300 kbit/s for everybody", "first version again"),
        ("débit total maximal, 300 kbit/s pour tous", "reviens à la toute première version"),
        ("höchste Gesamtrate, 300 kbit/s für alle", "zurück zur allerersten Version"),
        ("máxima tasa total, 300 kbit/s para todos", "vuelve a la primera versión"),
        ("总速率最大，每人300k", "恢复成第一个命令"),
        ("top sum rate, 300 kbit/s for everybody", "the first order again"),
    ],
)
def test_the_first_version_comes_back(first: str, back: str) -> None:
    assert talked_into(first, "10 W", "8 W", back)[0] == {"min_rate_bps": 3e5}


@pytest.mark.parametrize("said", ["调低一点", "少一点"])
def test_a_little_is_no_figure(said: str) -> None:
    held, turns = talked_into("总速率最大，16瓦以内", said)
    assert (held, turns[-1].stage) == ({"max_power_w": 16.0}, "asked")


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (("按比例公平来，功率上限12瓦", "上海那边说用9瓦就够了", "功率减半"), {"max_power_w": 6.0}),
        (("highest total rate, at most 12 W", "Finance would love 6 W", "halve the power"), {"max_power_w": 6.0}),
    ],
)
def test_a_line_behind_a_question_turns_to_something_else(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    held_in_fact, turns = talked_into(*lines)
    assert (turns[1].stage, held_in_fact) == ("asked", held)


HELD = Context(
    user_names=tuple(f"user {number}" for number in range(1, 9)), objective="proportional_fairness",
    constraints={"max_power_w": 16.0}, language="en",
)  # fmt: skip


def test_no_figure_of_a_line_goes_unused_unasked() -> None:
    """One of two powers would be set, and the other one lost; part by part all is meant."""
    said = "Proportional fair mit 36 dBm, Blöcke zu vier Unterträgern, pro Unterträger maximal 200 mW."
    found = understood(said, HELD, OfflineRecogniser())
    assert found.objective == "proportional_fairness"
    assert found.constraints["max_power_w"] == pytest.approx(3.981, rel=1e-3)
    assert found.constraints["subcarrier_max_power_w"] == 0.2


@pytest.mark.parametrize(
    ("said", "asks"),
    [
        ("least power, user 2 at least 5 Mbit/s, user 2 at most 1 Mbit/s", "rates_crossed"),
        ("max rate, 10 W or 12 W, user 4 at least 1 Mbit/s", "conflict"),
        ("lowest power, user 3 either 1 or 2 Mbit/s, user 4 500 kbit/s", "unit_missing"),
    ],
)
def test_a_request_of_its_own_that_is_doubted_is_not_guessed_at(said: str, asks: str) -> None:
    """What the talk makes of its figures would leave out its aim, or one of them."""
    found = understood(said, HELD, OfflineRecogniser())
    assert (found.kind, found.asks, found.guess) == ("clarify", asks, None)


def test_a_name_does_not_change_the_language() -> None:
    _, turns = talk("proportional fair, at most 16 W", "give Anna 1 Mbit/s")
    assert turns[-1].reply.startswith("There is no Anna here")


def test_a_number_word_has_its_accent() -> None:
    held = talked_into("kleinste Leistung, 200 kbit/s für alle", "Nutzer 2 braucht 300 kbit/s", "zwei genauso")[0]
    assert held == {"min_rate_bps": {"all": 2e5, "2": 3e5}}
    assert talked_into("höchste Gesamtrate, 9 W", "mach fünf draus")[0] == {"max_power_w": 5.0}


@pytest.mark.parametrize("said", ["double it", "verdoppeln", "duplícalo", "翻倍"])
def test_what_may_be_scaled_is_asked_where_a_line_said_several_limits(said: str) -> None:
    held, turns = talked_into("highest total rate, at most 5 W, at least 100 kbit/s each", said)
    assert (held, turns[-1].stage) == ({"max_power_w": 5.0, "min_rate_bps": 1e5}, "asked")


def test_more_for_the_others_is_no_more_for_who_was_named_last() -> None:
    held, turns = talked_into(
        "highest total rate", "user 3 at least 3 Mbit/s", "plus 500 kbit/s for each of the others"
    )
    assert (held, turns[-1].stage) == ({"min_rate_bps": {"3": 3e6}}, "asked")

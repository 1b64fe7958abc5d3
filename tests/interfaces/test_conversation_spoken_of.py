"""Lines that lean on who was spoken of: a user just asked about, a clause that tells of one, users by their numbers."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import agreed_into as talk
from conversations import talked_into

pytestmark = pytest.mark.machine_code

HELD = "highest total rate, 300 kbit/s each"
MAX = "highest total rate"


@pytest.mark.parametrize(
    ("asked", "said"),
    [("why is user 3 so slow?", "then give them 1 Mbit/s"), ("how is user 3 doing?", "promise her 1 Mbit/s"),
     ("用户3为什么这么慢？", "那就给他1兆"), ("用户3的速率是多少？", "至少给他1兆"),
     ("¿por qué el usuario 3 va tan lento?", "dale 1 Mbit/s"),
     ("pourquoi l'utilisateur 3 est-il si lent ?", "donne-lui 1 Mbit/s"),
     ("warum ist Nutzer 3 so langsam?", "gib ihm 1 Mbit/s")],
)  # fmt: skip
def test_a_pronoun_is_the_user_just_asked_about(asked: str, said: str) -> None:
    assert talk(HELD, asked, said)[0] == {"min_rate_bps": {"all": 3e5, "3": 1e6}}


@pytest.mark.parametrize(
    ("lines", "held"),
    [(("highest total rate without users 2 and 3", "user 2 has paid. Let him back in."), {"leave_out": ("3",)}),
     ((MAX, "user 3's phone is dead, leave him out"), {"leave_out": ("3",)}),
     (("highest total rate without users 2 and 3", "2 is back from repair, include her again"), {"leave_out": ("3",)}),
     ],
)  # fmt: skip
def test_an_order_behind_what_is_told_of_a_user_is_about_that_user(
    lines: tuple[str, ...], held: dict[str, Any]
) -> None:
    assert talk(*lines)[0] == held


@pytest.mark.parametrize(
    ("said", "users"),
    [("odd-numbered users at least 500 kbit/s", "13"), ("and the even-numbered ones at least 500 kbit/s", "24"),
     ("双号用户至少500kbit/s", "24"), ("Nutzer mit ungerader Nummer mindestens 500 kbit/s", "13"),
     ("al menos 500 kbit/s para los usuarios pares", "24")],
)  # fmt: skip
def test_users_by_odd_and_even_numbers(said: str, users: str) -> None:
    assert talk(MAX, said)[0] == {"min_rate_bps": dict.fromkeys(users, 5e5)}


@pytest.mark.parametrize(
    ("lines", "held"),
    [((MAX, "at most 12 W", "user 2 at least 1 Mbit/s", "go back to how it was before the guarantee"),
      {"max_power_w": 12.0}),
     ((HELD, "user 2 needs double", "no sorry, I meant user 3"), {"min_rate_bps": {"all": 3e5, "3": 6e5}}),
     ((HELD, "except for user 3, who gets 600"), {"min_rate_bps": {"all": 3e5, "3": 6e5}}),
     ((HELD, "a bit more for everyone, say 350"), {"min_rate_bps": 3.5e5}),
     ((HELD, "user 2 at least 1 Mbit/s", "bump her up to 2 Mbit/s"), {"min_rate_bps": {"all": 3e5, "2": 2e6}}),
     ((HELD, "users 2 and 3 count double", "make it triple for 3"),
      {"min_rate_bps": 3e5, "weights": {"2": 2.0, "3": 3.0}}),
     (("highest total rate, at most 4 Mbit/s each, at most 12 W", "the power limit can go", "the cap too"), {}),
     ((HELD, "user 2 is the fire brigade, 1.8 Mbit/s guaranteed."), {"min_rate_bps": {"all": 3e5, "2": 1.8e6}})],
)  # fmt: skip
def test_lines_that_talks_leave_short(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert talk(*lines)[0] == held


def test_an_order_under_a_condition_is_asked_about() -> None:
    held, turns = talked_into(MAX, "once user 3 has paid, let him have 1 Mbit/s")
    assert (held, turns[-1].stage) == ({}, "asked")


def test_a_question_about_another_aim_changes_none() -> None:
    _, turns = talk("max-min, at most 10 W", "would proportional fairness be faster overall?")
    assert turns[-1].diff.objective == ("max_min_rate", "max_min_rate")
    assert turns[-1].intent.kind == "question"

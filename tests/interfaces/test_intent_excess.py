"""Long lines of figures, users and words: refused or read, but never for seconds."""

from __future__ import annotations

import cProfile

import pytest

from wirelessagent.language.conversation import unanswered
from wirelessagent.language.offline import recognise
from wirelessagent.language.recogniser import Context


@pytest.mark.parametrize(
    "text",
    [
        "1 " * 1000,
        "5 W " * 500,
        "user 7 " * 250,
        "user 3 1 Mbit/s, " * 100,
        "9" * 2000,
        "twenty " * 280,
        "max rate, 5 W. " * 90,
    ],
)
def test_too_many_figures_are_refused(text: str):
    intent = recognise(text)
    assert intent.kind == "clarify"
    assert "at most 40" in intent.reply


def test_too_many_figures_are_refused_in_chinese():
    assert "最多给出 40 个" in recognise("一号用户和二号用户，" * 100).reply


def test_a_long_list_is_read():
    users = ", ".join(str(user) for user in range(1, 39))
    intent = recognise(f"Leave users {users} out and maximise the rate")
    assert intent.objective == "max_rate"
    assert intent.constraints["leave_out"] == tuple(str(user) for user in range(1, 39))


@pytest.mark.parametrize(
    "text", ["速率最大功率" * 333, "not " * 500, "half of the cap " * 125, "max rate please " * 125]
)
def test_a_long_line_of_words_is_read_in_so_many_steps(text: str):
    recognise("max rate")  # what loads once is no step
    profile = cProfile.Profile()
    profile.runcall(recognise, text)
    assert sum(each.callcount for each in profile.getstats()) < 3_000_000


def test_a_question_back_to_too_many_figures_holds_nothing():
    text = "1 " * 900
    held = unanswered(text, recognise(text), Context())
    assert (held.objective, held.users, dict(held.pending)) == (None, (), {})

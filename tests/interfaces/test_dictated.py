"""Lines as dictation spells them."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.as_meant import heard
from wirelessagent.language.sentence import Sentence, own_words

NAMES = tuple(f"user {number}" for number in range(1, 9))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("lift the slowest user as far as you can with thirty dee bee em in total", {"max_power_w": 1.0}),
        ("max throughput total power twenty what's", {"max_power_w": 20.0}),
        ("no more than fifty milli what's on a subcarrier", {"subcarrier_max_power_w": 0.05}),
        ("highest some rate and keep user for under one and a half megabits", {"max_rate_bps": {"4": 1.5e6}}),
        ("max min and leave out user ate", {"leave_out": ("8",)}),
        ("maximise the sum with eighteen watts and drop user won", {"max_power_w": 18.0, "leave_out": ("1",)}),
        ("puissance minimale et cinq sans kilobits par seconde pour chacun au minimum", {"min_rate_bps": 5e5}),
    ],
)
def test_what_dictation_misspells_is_read_as_it_was_said(text: str, values: dict[str, Any]) -> None:
    assert dict(Sentence(text, own_words(), names=NAMES).reading.values) == values


@pytest.mark.parametrize(
    "text",
    ["limit user to 2 Mbit/s", "limit users to at most 2 Mbit/s", "users to drop: 3", "drop user for now",
     "user won the lottery", "each user to get 1 Mbit/s", "the slowest user for now", "what's the rate of user 3",
     "sans limite pour 3", "some rate for user 3"],
)  # fmt: skip
def test_what_is_spelt_as_it_is_meant_stays(text: str) -> None:
    assert heard(text) == text

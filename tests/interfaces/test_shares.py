"""Shares and multiples of figures that a sentence says, worked out before it is read."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.shares import worked_out

NAMES = tuple(f"user {number}" for number in range(1, 9))


def reading(text: str) -> dict[str, Any]:
    found = Sentence(text, own_words(), names=NAMES).reading
    assert not found.doubts
    return dict(found.values)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("Total power at most 80 % of 25 W, max rate", {"max_power_w": 20.0}),
        ("max rate with a third of the 36 W", {"max_power_w": 12.0}),
        ("Of our 40 W use no more than a quarter, max rate", {"max_power_w": 10.0}),
        ("Von den 36 W nur ein Drittel nutzen, Summenrate maximieren", {"max_power_w": 12.0}),
        ("功放额定40瓦，最多只许用到四分之一，总速率最大", {"max_power_w": 10.0}),
        ("Der Verstärker kann 80 W, wir nehmen davon maximal ein Viertel; höchste Summenrate", {"max_power_w": 20.0}),
        ("L'ampli fait 50 W, n'en prends que 40 % au maximum, débit total maximal", {"max_power_w": 20.0}),
        ("max rate, 5 W below our full 25 W at most", {"max_power_w": 20.0}),
        ("总功率取30W的六成，吞吐量最大", {"max_power_w": 18.0}),
        ("总功率10W，每个子载波最多占其中的1%，让最慢用户最快", {"max_power_w": 10.0, "subcarrier_max_power_w": 0.1}),
        ("least power, user 1 at least 250 kbit/s, user 2 twice that", {"min_rate_bps": {"1": 2.5e5, "2": 5e5}}),
        ("Minimale Leistung, Nutzer 8 mindestens 1,5 Mbit/s, Nutzer 1 mindestens ein Drittel davon",
         {"min_rate_bps": {"8": 1.5e6, "1": 5e5}}),
    ],
)  # fmt: skip
def test_a_share_of_a_figure_is_what_it_comes_to(text: str, values: dict[str, Any]) -> None:
    found = reading(text)
    assert found.keys() == values.keys()
    for name, value in values.items():
        assert found[name] == (pytest.approx(value) if not isinstance(value, dict) else value)


@pytest.mark.parametrize(
    "text",
    ["99 % of the time at least 1 Mbit/s for user 3", "98 percent of 400 kbit/s for all", "5 % outage and 20 W",
     "user 3 counts double, 12 W", "twice as much as now", "fiabilidad del 99 %, circuito de 3 W",
     "cada uno con una media de 300 kbit/s", "1 Mbit/s for 2, twice as much as the best for 3",
     "half of the users at 1 Mbit/s", "a power of 20 W and 5 % outage",
     "users at 2 Mbit/s, below 5 W", "20 W less 5 W for the electronics", "user 3 counts on 50 % more",
     "what counts is 10 % less power", "15 W less 200 kbit/s"],
)  # fmt: skip
def test_what_is_no_share_of_a_figure_stays(text: str) -> None:
    assert worked_out(text) == text


@given(st.sampled_from(["W", "mW", "kbit/s", "Mbit/s"]), st.integers(1, 999), st.integers(11, 89))
def test_all_else_stays_at_its_place_and_the_figure_is_the_product(unit: str, figure: int, share: int) -> None:
    said = f"max rate, at most {share} % of {figure} {unit} for user 3, please"
    found = worked_out(said)
    assert len(found) == len(said)
    assert found.startswith("max rate, at most ")
    assert found.endswith(" for user 3, please")
    [value] = [each.value for each in Sentence(said, own_words()).quantities]
    one = {"W": 1.0, "mW": 1e-3, "kbit/s": 1e3, "Mbit/s": 1e6}[unit]
    assert value == pytest.approx(share / 100 * figure * one, rel=1e-4)

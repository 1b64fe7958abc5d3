"""Figures that limits are changed to, from what they were: words that set a limit wish for nothing."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.as_meant import as_meant
from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context

NAMES = tuple(f"user {number}" for number in range(1, 9))
HOLDS = Context(user_names=NAMES, objective="proportional_fairness", constraints={"max_power_w": 16.0}, language="en")


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("Raise user 3's guaranteed rate from 1 to 2 Mbit/s.", {"min_rate_bps": {"3": 2e6}}),
        ("Raise user 3 to 2 Mbit/s from 500 kbit/s.", {"min_rate_bps": {"3": 2e6}}),
        ("Increase the floor from 1 Mbit/s to 2.", {"min_rate_bps": 2e6}),
        ("Change user 3's cap from 1 to 2 Mbit/s.", {"max_rate_bps": {"3": 2e6}}),
        ("Cut the power limit from 20 W to 12 W.", {"max_power_w": 12.0}),
        ("Baisse le plafond de puissance de 20 à 12 W.", {"max_power_w": 12.0}),
        ("Erhöhe die Mindestrate von Nutzer 3 von 1 auf 2 Mbit/s.", {"min_rate_bps": {"3": 2e6}}),
        ("Senk die Leistungsgrenze von 20 auf 12 W.", {"max_power_w": 12.0}),
        ("Baja el límite de potencia de 20 a 12 W.", {"max_power_w": 12.0}),
        ("把3号的保底从1兆提到2兆", {"min_rate_bps": {"3": 2e6}}),
        ("功率上限从20瓦降到12瓦", {"max_power_w": 12.0}),
        ("Raise user 3 from 1 to 2 Mbit/s and user 4 from 2 to 3 Mbit/s", {"min_rate_bps": {"3": 2e6, "4": 3e6}}),
        ("Tighten the outage probability from 10 % down to 1 %", {"outage_probability": 0.01}),
        ("instead of 4 W use 6", {"max_power_w": 6.0}),
        ("Statt 10 W nimm 8 W", {"max_power_w": 8.0}),
        ("En lugar de 2 Mbit/s, el usuario 5 alcanza ahora 3,2 Mbit/s como máximo.", {"max_rate_bps": {"5": 3.2e6}}),
        ("功率原来是10瓦，现在改成8瓦", {"max_power_w": 8.0}),
    ],
)
def test_what_a_figure_was_before_is_no_limit(text: str, values: dict[str, Any]) -> None:
    intent = understood(text, HOLDS, OfflineRecogniser())
    intent = intent.guess or intent  # what a yes would do
    assert (intent.objective, dict(intent.constraints)) == (HOLDS.objective, values)


@pytest.mark.parametrize(
    "text",
    [
        "user 3 from 1 to 2 Mbit/s",
        "erhöhe die Rate von 3 auf 2 Mbit/s",
        "serve users from 1 to 4",
        "everyone from 500 kbit/s up to 3 Mbit/s",
        "每个设备从1兆到2兆",
        "reduce the power from 10 W to 20 W",
        "change user 3 to a rate from 1 to 2 Mbit/s",
        "pasa una tasa de 2 Mbit/s a 3",
    ],
)
def test_ranges_and_users_are_left_as_they_are(text: str) -> None:
    assert as_meant(text) == text


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("The total power budget was 8 W, make it 6.5.", "The total power budget was 6.5 W."),
        ("Replace the 10 W limit by 8 W", "Replace the limit 8 W"),
        ("user 3 had 2 Mbit/s, now give user 4 1 Mbit/s", "user 3 had 2 Mbit/s, now give user 4 1 Mbit/s"),
        ("Replace user 3 by user 4", "Replace user 3 by user 4"),
    ],
)
def test_a_figure_gives_way_to_the_one_in_its_place(text: str, left: str) -> None:
    assert " ".join(as_meant(text).split()) == left


@pytest.mark.parametrize(
    ("text", "user"),
    [
        ("Raise the minimum rate of user 3 to 2 Mbit/s.", "3"),
        ("Erhöhe die Mindestrate von Nutzer 3 auf 2 Mbit/s.", "3"),
        ("Aumenta la tasa mínima del usuario 3 a 2 Mbit/s.", "3"),
        ("最低速率提高到2兆", ""),
        ("Raise everybody to 2 Mbit/s.", ""),
    ],
)
def test_a_limit_that_is_raised_is_no_aim(text: str, user: str) -> None:
    intent = understood(text, HOLDS, OfflineRecogniser())
    assert intent.objective == HOLDS.objective
    assert dict(intent.constraints) == {"min_rate_bps": {user: 2e6} if user else 2e6}


def test_an_aim_beside_a_limit_that_is_set_stays() -> None:
    said = {
        "Maximise the sum rate with user 3 raised to 2 Mbit/s.": "max_rate",
        "Maximise the minimum rate, 12 W at most.": "max_min_rate",
        "Cut power to 12 W, as fair as possible.": "proportional_fairness",
    }
    assert {text: understood(text, HOLDS, OfflineRecogniser()).objective for text in said} == said

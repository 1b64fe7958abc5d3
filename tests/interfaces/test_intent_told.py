"""Orders beside sentences of the same text that only tell or ask."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context

CELL = Context(user_names=tuple(f"user {number}" for number in range(1, 9)))


@pytest.mark.parametrize(
    ("text", "objective", "constraints"),
    [
        ("It crawled all evening yesterday. Give me the highest total rate.", "max_rate", {}),
        ("Anoche iba lento. Maximiza la tasa total.", "max_rate", {}),
        ("Hier soir c'était très lent pour tout le monde. Maximise le débit total.", "max_rate", {}),
        ("Gestern Abend lief alles zäh. Bitte die höchste Gesamtrate.", "max_rate", {}),
        ("昨天晚上大家都说卡得不行。请把总速率拉到最高。", "max_rate", {}),
        ("Last week user 3 had 5 Mbit/s. Today promise user 3 2 Mbit/s, with the least power.",
         "min_power", {"min_rate_bps": {"3": 2e6}}),
        ("Last night user 3 was crawling. Give user 3 at least 2 Mbit/s and use the least power.",
         "min_power", {"min_rate_bps": {"3": 2e6}}),
    ],
)  # fmt: skip
def test_what_is_only_told_beside_an_order_is_left_aside(
    text: str, objective: str, constraints: dict[str, Any]
) -> None:
    intent = understood(text, CELL, OfflineRecogniser())
    assert (intent.kind, intent.objective, dict(intent.constraints)) == ("allocate", objective, constraints)


def test_figures_that_are_left_aside_are_said() -> None:
    said = "Last week user 3 had 5 Mbit/s. Today promise user 3 2 Mbit/s, with the least power."
    assert "5 Mbit/s" in understood(said, CELL, OfflineRecogniser()).evidence["not_used"]


@pytest.mark.parametrize(
    "text",
    [
        "Our contract promised everyone 1 Mbit/s. Maximum total rate.",
        "The limit was 12 W. No more. Highest sum rate.",
        "Since Monday the limit has been 12 W. Highest sum rate.",
        "Depuis hier la limite est de 12 W. Débit total maximal.",
        "Blocks of 4 were agreed. Highest sum rate.",
        "领导说最多12瓦。总速率最高。",
    ],
)
def test_a_limit_that_is_told_and_may_hold_is_not_dropped(text: str) -> None:
    intent = understood(text, CELL, OfflineRecogniser())
    assert intent.kind != "allocate" or intent.constraints


@pytest.mark.parametrize(
    "text",
    [
        "Users 1 to 4. 2 Mbit/s each. Max rate.",
        "Max rate. User 3: 2 Mbit/s. User 5: off.",
        "Everybody must have 500 kbit/s. Each subcarrier carries at most 50 mW. Max-min.",
        "Le 3 doit avoir 2 Mbit/s. Le reste se débrouille. Débit total maximal.",
    ],
)
def test_terse_orders_in_several_sentences_stay_whole(text: str) -> None:
    intent = understood(text, CELL, OfflineRecogniser())
    assert intent.kind == "allocate"
    assert "not_used" not in intent.evidence


def test_a_sentence_that_the_next_refers_to_stays() -> None:
    intent = understood("Le 5 se plaignait encore à midi. Garantis-lui 2 Mbit/s et maximise le débit total.", CELL,
                        OfflineRecogniser())  # fmt: skip
    assert intent.kind != "allocate" or intent.constraints == {"min_rate_bps": {"5": 2e6}}


@pytest.mark.parametrize(
    ("text", "user"),
    [
        ("Die 1 ist seit heute früh in Wartung, sagt der Kollege. Lass sie weg und verteil proportional fair.", "1"),
        ("Dicen que el 2 ya no vive aquí. Exclúyelo y reparte con equidad proporcional.", "2"),
    ],
)
def test_a_pronoun_is_whoever_was_told_of_by_number(text: str, user: str) -> None:
    intent = understood(text, CELL, OfflineRecogniser())
    assert (intent.objective, intent.constraints) == ("proportional_fairness", {"leave_out": (user,)})


@pytest.mark.parametrize(
    "text",
    [
        "Last night user 4 had 1 Mbit/s and it should stay so. Max rate, user 3 at least 2 Mbit/s.",
        "Pon la máxima eficiencia energética. O mejor no, retiro lo dicho.",
        "The boss ordered the highest total rate. Power at most 12 W.",
    ],
)
def test_what_is_taken_back_or_referred_to_is_asked_about(text: str) -> None:
    assert understood(text, CELL, OfflineRecogniser()).kind == "clarify"

"""Figures that are called wrong or unwanted, users at odds with themselves, and wishes for fairness as such."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.intent import same_constraints
from wirelessagent.language.offline import recognise
from wirelessagent.language.recogniser import Context

HELD = Context(objective="max_rate", constraints={"max_power_w": 10.0}, max_power_w=20.0)
REFUSED = [
    "5 W is too much", "12 W is not enough", "8 W won't do", "I don't want 500 kbit/s each",
    "3 Mbit/s each isn't enough",
    "5瓦太多了", "我不要每人500k", "5 W es demasiado", "5 W c'est trop", "12 W reichen nicht",
]  # fmt: skip


@pytest.mark.parametrize("said", REFUSED)
@pytest.mark.parametrize("context", [None, HELD])
def test_a_figure_that_is_refused_is_asked_about(said: str, context: Context | None) -> None:
    intent = recognise(said, context)
    assert (intent.kind, dict(intent.constraints)) == ("clarify", {})


@pytest.mark.parametrize(
    ("said", "constraints"),
    [
        ("max rate, but 20 W is too much, use 12 W", {"max_power_w": 12.0}),
        ("300 kbit/s is not enough for user 3, give him 1 Mbit/s, max rate", {"min_rate_bps": {"3": 1e6}}),
        ("总速率最高,10瓦太大,用6瓦", {"max_power_w": 6.0}),
        ("不要超过10瓦,总速率最高", {"max_power_w": 10.0}),
    ],
)
def test_what_is_wanted_instead_is_read(said: str, constraints: dict[str, Any]) -> None:
    intent = recognise(said)
    assert (intent.kind, intent.objective) == ("allocate", "max_rate")
    assert same_constraints(dict(intent.constraints), constraints)


@pytest.mark.parametrize(
    "said",
    [
        "user 3 needs 2 Mbit/s and drop user 3, max rate",
        "user 3 needs 2 Mbit/s but user 3 must get nothing, max rate",
        "user -1 needs 1 Mbit/s, max rate", "用户-2至少1兆,总速率最高",
    ],
)  # fmt: skip
def test_users_at_odds_and_users_with_a_sign_are_asked_about(said: str) -> None:
    assert recognise(said).kind == "clarify"


@pytest.mark.parametrize("said", ["make it fairly fast", "share it fairly fast"])
def test_fairness_as_such_is_asked_about_in_its_own_words(said: str) -> None:
    assert recognise(said).reply.startswith("Fair in which way: a fair share for everyone (proportional fairness) or")


@pytest.mark.parametrize("said", ["fair, at most 6 W", "最多5瓦,公平"])
def test_a_wish_beside_a_limit_is_not_dropped_in_a_conversation(said: str) -> None:
    held = Context(objective="min_power", constraints={"min_rate_bps": 2e5}, max_power_w=20.0)
    intent = recognise(said, held)
    limit_w = 6.0 if "6" in said else 5.0
    assert (intent.objective, dict(intent.constraints)) == ("proportional_fairness", {"max_power_w": limit_w})

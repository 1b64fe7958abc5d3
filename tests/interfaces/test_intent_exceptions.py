"""Users who are exceptions: nobody is left out, and nobody promised a rate, by a word that says the opposite."""

from __future__ import annotations

import pytest

from wirelessagent.language.exceptions import exception_of
from wirelessagent.language.mentions import mentions
from wirelessagent.language.offline import recognise

KEPT = [
    "don't kick user 3 out", "please don't drop user 2", "do not leave out user 4", "user 3 stays in", "别把3号踢掉",
    "不要不服务2号", "不要把5号排除", "3号不用踢", "no dejes fuera al usuario 3", "Nutzer 3 nicht rauswerfen",
]  # fmt: skip
EXCEPTED = [
    "everybody but user 1 gets 500 kbps", "at least 300 kbps apart from users 2 and 3", "1号以外每人至少400k",
    "除1号外每人至少1兆", "at most 2 Mbps each, except user 3 who is unlimited", "每人至少1兆,3号除外",
    "tous sauf l'utilisateur 3 ont 1 Mbit/s", "alle außer Nutzer 3 bekommen 1 Mbit/s",
]  # fmt: skip
NEITHER = [
    "leave user 3 out",
    "ohne Nutzer 3",
    "不要3号",
    "forget user 3",
    "only user 3",
    "user 3 gets 1 Mbit/s",
    "3号1兆",
]


def standing(text: str) -> str:
    named = next(mention for mention in mentions(text) if mention.role == "named")
    return exception_of(text, named.start, named.end)


@pytest.mark.parametrize(
    ("text", "expected"),
    [*((t, "kept") for t in KEPT), *((t, "excepted") for t in EXCEPTED), *((t, "") for t in NEITHER)],
)
def test_what_an_exception_is(text: str, expected: str) -> None:
    assert standing(text) == expected


@pytest.mark.parametrize("text", [*KEPT, *(f"max rate, {text}" for text in KEPT)])
def test_whoever_is_kept_is_not_left_out(text: str) -> None:
    constraints = recognise(text).constraints
    assert not constraints.keys() & {"leave_out", "users"}


@pytest.mark.parametrize("text", EXCEPTED)
def test_whoever_is_excepted_from_a_rate_is_asked_about(text: str) -> None:
    intent = recognise(f"max rate, {text}")
    assert intent.kind == "clarify", intent
    assert intent.reply.endswith(("?", "\uff1f"))


@pytest.mark.parametrize(
    "text", ["max rate for everyone except user 3", "除了3号，总速率最高", "save power, all but user 3"]
)
def test_a_wish_for_all_but_somebody_leaves_them_out(text: str) -> None:
    assert recognise(text).constraints.get("leave_out") == ("3",)


def test_somebody_may_leave() -> None:
    assert recognise("总速率最高，让8号离开").constraints["leave_out"] == ("8",)

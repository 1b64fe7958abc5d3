"""What the agent says: every message in English and Chinese, with the same places, used somewhere."""

from __future__ import annotations

import functools
import re
import string
from pathlib import Path

import pytest

from wirelessagent.telling.catalogue import called, has_message, joined, languages, message, messages

PACKAGE = Path(__file__).parents[2] / "src" / "wirelessagent"
KEYS = sorted(messages("en"))

_BY_NAME = {key for key in KEYS if key.startswith(("name.", "term."))}
"""Said for whatever has that name, or is asked about."""


def places(text: str) -> dict[str, str]:
    """The places of a message with how they show their figures."""
    parts = string.Formatter().parse(text)
    return {name: shown or "" for _, name, shown, _ in parts if name is not None}


@functools.cache
def code() -> str:
    return "\n".join(path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))


@functools.cache
def strings() -> frozenset[str]:
    """What stands in quotation marks."""
    return frozenset({"", *re.findall(r'"([\w.]+)"', code())})


@functools.cache
def frames() -> tuple[re.Pattern[str], ...]:
    """What is put together, as in f"status.{decision.status}"."""
    found = re.findall(r'f"([\w.]*(?:\{[^"{}]+\}[\w.]*)+)"', code())
    known = {
        re.sub(r"\\\{.*?\\\}", r"([\\w.]*)", re.escape(frame))
        for frame in found
        if re.search(r"[a-z]{3}", re.sub(r"\{.*?\}", "", frame))
    }
    return tuple(re.compile(frame) for frame in known)


def is_used(text: str, within: int = 2) -> bool:
    """Whether a key, or a part of one, stands in the code or is put together there of parts that do."""
    if text in strings():
        return True
    found = [frame.fullmatch(text) for frame in frames()] if within else []
    return any(all(is_used(part, within - 1) for part in one.groups()) for one in found if one is not None)


def test_english_and_chinese_say_the_same() -> None:
    english, chinese = messages("en"), messages("zh")
    assert english.keys() == chinese.keys()
    assert [key for key in KEYS if set(places(english[key])) != set(places(chinese[key]))] == []


@pytest.mark.parametrize("language", sorted(languages() - {"en", "zh"}))
def test_other_languages_say_nothing_that_english_does_not(language: str) -> None:
    own, english = messages(language), messages("en")
    assert own.keys() <= english.keys()
    assert [key for key in own if set(places(own[key])) != set(places(english[key]))] == []


@pytest.mark.parametrize("language", sorted(languages()))
def test_every_message_can_be_said(language: str) -> None:
    for key in messages(language):
        given = {name: 1.0 if shown else f"<{name}>" for name, shown in places(messages(language)[key]).items()}
        said = message(language, key, **given)
        assert [name for name, value in given.items() if isinstance(value, str) and value not in said] == []
        assert "{" not in said


@pytest.mark.parametrize("key", KEYS)
def test_every_message_is_said_somewhere(key: str) -> None:
    assert is_used(key) or key in _BY_NAME


def test_a_language_that_has_no_message_falls_back_to_english() -> None:
    assert message("xx", "status.optimal") == "optimal"
    assert message("../../en", "status.optimal") == "optimal"
    assert has_message("xx", "status.optimal")
    assert not has_message("en", "status.excellent")
    with pytest.raises(KeyError):
        message("zh", "status.excellent")


def test_names_are_told_as_the_language_calls_them() -> None:
    assert message("zh", "stage.repaired", missing=3, method="nncf") == "最近邻协同过滤修复了 3 个增益"
    assert (
        message("zh", "ask_back.unknown_user", user="user 9", known="Ada") == "这里没有用户9，有Ada。您指的是哪一个？"
    )
    assert [called("en", name) for name in ("User 3", "dual", "x\ny")] == ["User 3", "dual", "x\\u000ay"]
    assert joined("en", ["One.", "", "Two."]) == "One. Two."
    assert joined("zh", ["一。", "", "二。"]) == "一。二。"

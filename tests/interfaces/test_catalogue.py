"""What the agent says: every message in English and Chinese, with the same places, used somewhere."""

from __future__ import annotations

import functools
import re
import string
from pathlib import Path

import pytest

import wirelessagent as wa
from wirelessagent.agent.session import Session
from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.telling.catalogue import called, has_message, joined, languages, message, messages

PACKAGE = Path(__file__).parents[2] / "src" / "wirelessagent"
KEYS = sorted(messages("en"))

_BY_NAME = {key for key in KEYS if key.startswith(("name.", "legend.", "term."))}
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


_QUOTED = {"zh": "“([^”]+)”", "es": "«([^»]+)»", "fr": "« ([^»]+) »", "de": "„([^“]+)“", "en": "'([^']{2,60})'"}
"""What the agent tells people that they may say."""
_NOT_FOR_THE_READER = {"quit"}
_HELD = Context(
    objective="max_rate",
    constraints={"max_power_w": 10.0},
    user_names=tuple(f"user {number}" for number in range(1, 9)),
)


@pytest.mark.parametrize("language", sorted(languages()))
def test_what_people_are_told_to_say_is_understood(language: str) -> None:
    texts = [
        text for key, text in messages(language).items() if key.startswith(("assumed", "plan", "reply", "refused"))
    ]
    texts.append(messages(language)["about.help"])
    offered = {said for text in texts for said in re.findall(_QUOTED[language], text) if "{" not in said}
    assert len(offered) >= 5
    read = {said: understood(said, _HELD, OfflineRecogniser()) for said in offered}
    unclear = {said for said, intent in read.items() if intent.kind in ("clarify", "out_of_scope")}
    assert unclear <= _NOT_FOR_THE_READER


@pytest.mark.parametrize(
    ("language", "wish", "change"),
    [
        ("es", "máxima tasa total, como máximo 10 W", "al menos 100 Mbit/s para cada usuario"),
        ("fr", "débit total maximal, au plus 10 W", "au moins 100 Mbit/s pour chaque utilisateur"),
        ("de", "höchste Gesamtrate, höchstens 10 W", "mindestens 100 Mbit/s für jeden Nutzer"),
    ],
)
def test_spanish_french_and_german_operators_are_answered_in_their_language(
    language: str, wish: str, change: str
) -> None:
    scene = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=4, num_subcarriers=8, seed=6)
    session = Session(scene, seed=1)
    replies = [session.say(line).reply for line in (wish, change)]
    assert message(language, "certificate.best", value="") in replies[0]
    assert message(language, "status.infeasible") in replies[1].lower()
    for reply in replies:
        assert not re.search(r"\b(?:the|of|and|is|with|radiated|users?|rates?)\b", reply), reply


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
    assert [called("zh", name) for name in ("user", "users", "Users 3")] == ["user", "users", "Users 3"]
    assert joined("en", ["One.", "", "Two."]) == "One. Two."
    assert joined("zh", ["一。", "", "二。"]) == "一。二。"

"""What the agent says: every message in every language, with the same places, used somewhere, nothing in English."""

from __future__ import annotations

import functools
import re
import string
from pathlib import Path

import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.agent.session import Session
from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.topics import tools_named
from wirelessagent.telling.catalogue import called, has_message, joined, languages, listed, message, messages

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
    kinds = ("*.py", "*.js", "*.html")
    return "\n".join(path.read_text(encoding="utf-8") for kind in kinds for path in PACKAGE.rglob(kind))


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


OTHERS = sorted(languages() - {"en"})


def test_there_are_five_languages_or_more() -> None:
    assert {"de", "es", "fr", "zh"} <= set(OTHERS)


@pytest.mark.parametrize("language", OTHERS)
def test_every_language_says_all_that_english_does(language: str) -> None:
    own, english = messages(language), messages("en")
    assert list(own) == list(english), "the same keys, in the same order"
    assert {key: places(own[key]) for key in own} == {key: places(english[key]) for key in english}


@pytest.mark.parametrize("language", sorted(languages()))
def test_every_message_can_be_said(language: str) -> None:
    for key in KEYS:
        given = {name: 1.0 if shown else f"<{name}>" for name, shown in places(messages(language)[key]).items()}
        said = message(language, key, **given)
        assert [name for name, value in given.items() if isinstance(value, str) and value not in said] == []
        assert "{" not in said


_ALIKE: frozenset[str] = frozenset()
"""Messages of more than three words that another language says in the very words of English."""
_ENGLISH = re.compile(r"(?<![A-Za-zß-ÿ])(?:the|of|and|is|are|with|by|for|not|that|it|its|to)(?![a-zß-ÿ])")
"""Words that stand in nearly every English sentence, and in none of the other languages."""


def words(text: str) -> list[str]:
    """The words of a message without its places and without what people are told to say."""
    plain = re.sub(r"“[^”]*”|„[^“]*“|«[^»]*»", " ", re.sub(r"\{[^{}]*\}", " ", text))
    return re.findall(r"[^\W\d_]+", plain)


@pytest.mark.parametrize("language", OTHERS)
def test_nothing_is_left_in_english(language: str) -> None:
    own, english = messages(language), messages("en")
    alike = {key for key in KEYS if len(words(english[key])) > 3 and words(own[key]) == words(english[key])}
    assert alike - _ALIKE == set()
    assert {key: own[key] for key in KEYS if _ENGLISH.search(" ".join(words(own[key])))} == {}


@pytest.mark.parametrize(
    ("language", "one", "several", "following"),
    [
        ("en", "User 3 gets the least power: 1 W.", "User 1 and user 2 get nothing.",
         "Next are user 1 and user 2 with 2 W."),
        ("zh", "用户3得到的功率最少：1 W。", "用户1和用户2什么也没有得到。", "其次是用户1和用户2：2 W。"),
        ("de", "Nutzer 3 erhält am wenigsten an Leistung: 1 W.", "Nutzer 1 und Nutzer 2 erhalten nichts.",
         "Es folgen Nutzer 1 und Nutzer 2 mit 2 W."),
        ("es", "Usuario 3 recibe menos potencia que nadie: 1 W.", "Usuario 1 y usuario 2 no reciben nada.",
         "Después vienen usuario 1 y usuario 2 con 2 W."),
        ("fr", "Utilisateur 3 reçoit le moins de puissance : 1 W.", "Utilisateur 1 et utilisateur 2 ne reçoivent rien.",
         "Ensuite viennent utilisateur 1 et utilisateur 2 avec 2 W."),
    ],
)  # fmt: skip
def test_sentences_of_several_parts_are_put_together_rightly(
    language: str, one: str, several: str, following: str
) -> None:
    say = functools.partial(message, language)
    names = listed(language, ["user 1", "user 2"])
    first = say(
        "roster.least", names=listed(language, ["user 3"]), gets=say("roster.one"), what=say("roster.of_power"),
        size="1 W", further="",
    )  # fmt: skip
    assert first == one
    assert say("roster.nothing", names=names, gets=say("roster.several")) == several
    assert say("roster.next", is_=say("roster.is_several"), names=names, size="2 W") == following


@pytest.mark.parametrize("key", KEYS)
def test_every_message_is_said_somewhere(key: str) -> None:
    assert is_used(key) or key in _BY_NAME


_QUOTED = {"zh": "“([^”]+)”", "es": "«([^»]+)»", "fr": "« ([^»]+) »", "de": "„([^“]+)“", "en": "'([^']{2,60})'"}
"""What the agent tells people that they may say."""
_TELLING = ("assumed", "plan", "reply", "refused", "turn", "price", "certainty")
_NOT_FOR_THE_READER = {"quit"}
_HELD = Context(
    objective="max_rate",
    constraints={"max_power_w": 10.0},
    user_names=tuple(f"user {number}" for number in range(1, 9)),
)


@pytest.mark.parametrize("language", sorted(languages()))
def test_what_people_are_told_to_say_is_understood(language: str) -> None:
    texts = [text for key, text in messages(language).items() if key.startswith(_TELLING)]
    texts.append(messages(language)["about.help"])
    offered = {said for text in texts for said in re.findall(_QUOTED[language], text) if "{" not in said}
    assert len(offered) >= 5
    read = {said: understood(said, _HELD, OfflineRecogniser()) for said in offered}
    unclear = {said for said, intent in read.items() if intent.kind in ("clarify", "out_of_scope")}
    assert unclear <= _NOT_FOR_THE_READER


@pytest.mark.parametrize("language", sorted(languages()))
def test_methods_and_repairers_are_understood_as_they_are_told(language: str) -> None:
    names = [name for kind in ("method", "repairer") for name in plugins.names(kind)]
    told = {name: tools_named(f"compare with {called(language, name)}", "method", "repairer") for name in names}
    assert told == {name: (name,) for name in names}


_TALKS = {
    "es": (
        "máxima tasa total, como máximo 10 W", "¿por qué el usuario 3 no recibe nada?", "¿qué daría un vatio más?",
        "¿cuán seguro es esto?", "¿y si faltara el 40 %?", "¿qué es la cota?", "historial", "comparar con el último",
        "al menos 100 Mbit/s para cada usuario",
    ),
    "fr": (
        "débit total maximal, au plus 10 W", "pourquoi l'utilisateur 3 ne reçoit-il rien ?",
        "que donnerait un watt de plus ?", "est-ce sûr ?", "et si 40 % manquaient ?", "qu'est-ce que la borne ?",
        "historique", "comparer avec le dernier", "au moins 100 Mbit/s pour chaque utilisateur",
    ),
    "de": (
        "höchste Gesamtrate, höchstens 10 W", "warum bekommt Nutzer 3 nichts?", "was brächte ein Watt mehr?",
        "wie sicher ist das?", "was wäre, wenn 40 % fehlten?", "was heißt Schranke?", "Verlauf",
        "mit dem letzten vergleichen", "mindestens 100 Mbit/s für jeden Nutzer",
    ),
}  # fmt: skip


@pytest.mark.parametrize("language", sorted(_TALKS))
def test_spanish_french_and_german_operators_are_answered_in_their_language(language: str) -> None:
    scene = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=4, num_subcarriers=8, seed=6)
    session = Session(scene, wa.loss.random(0.2), seed=1)
    turns = [session.say(line) for line in _TALKS[language]]
    assert message(language, "certificate.best", value="") in turns[0].reply
    assert message(language, "status.infeasible") in turns[-1].reply.lower()
    for turn in turns:
        tables = [text for table in turn.tables for text in (table.title, *table.columns, *sum(table.rows, ()))]
        for text in (turn.reply, *tables):
            assert not re.search(r"\b(?:the|of|and|is|with|radiated|users?|rates?)\b", text), (turn.text, text)


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

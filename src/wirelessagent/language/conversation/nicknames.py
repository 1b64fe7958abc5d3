"""What operators call users in a talk: once "user 3 is the ambulance" was said, "the ambulance" is user 3.

Only what is said with an article, or in Chinese with no more than a few signs, names somebody: "user 3 is slow" does
not. A name holds for the rest of the talk, or until it is given to somebody else. Words are data by language
(``talk_forms/<language>.toml``, ``[nicknames]``).
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.base_words import language_of, languages_of
from wirelessagent.language.mentions import mentions
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import normalise, replaced
from wirelessagent.language.word_tables import table, written

Span = tuple[int, int]


def called(texts: Sequence[str]) -> Mapping[str, str]:
    """The numbers of users by what lines of a talk call them, the later ones holding.

    >>> called(["User 3 is the ambulance, just so you know", "users 1 and 2 are the slow ones"])
    {'ambulance': '3'}
    """
    return {name: number for text in texts for _, name, number in _given(normalise(text))}


def with_users(text: str, names: Mapping[str, str]) -> str:
    """A line with users in the places of what they are called; the place where a name is given keeps it.

    >>> with_users("the ambulance needs 2 Mbit/s", {"ambulance": "3"})
    'user 3 needs 2 Mbit/s'
    """
    plain, language = normalise(text), language_of(text)
    given = _given(plain)
    known = {**names, **{name: number for _, name, number in given}}
    kept = [span for span, *_ in given]
    spans = [
        (*match.span(), _user(match["before"], number, language))
        for name, number in known.items()
        if name in plain.lower()
        for match in _called(name, language).finditer(plain)
        if not any(first < match.end() and match.start() < last for first, last in kept)
    ]
    return replaced(text, sorted(spans))


def only_called(text: str) -> Mapping[str, str]:
    """What a line calls users, where it says nothing else.

    >>> only_called("user 3 is the ambulance, just so you know"), only_called("user 3 is the ambulance: 2 Mbit/s")
    ({'ambulance': '3'}, {})
    """
    plain = normalise(text)
    given = _given(plain)
    rest = "".join(" " if any(a <= at < b for (a, b), *_ in given) else sign for at, sign in enumerate(plain))
    for language in languages_of(text) if given else ():
        for words in table("talk_forms", language)["nicknames"]["aside"]:
            rest = re.sub(rf"(?i)(?<![^\W_]){re.escape(words)}(?![^\W_])", "", rest)
    return {} if any(map(str.isalnum, rest)) else {name: number for _, name, number in given}


@functools.lru_cache(maxsize=256)
def _given(plain: str) -> tuple[tuple[Span, str, str], ...]:
    """Where a name is given, the name, and the number of the user who gets it; each line of a talk is asked often."""
    return tuple(
        (match.span(), name, str(int(match["user"])))
        for language in languages_of(plain)
        for pattern in _patterns(language)
        for match in pattern.finditer(plain)
        if plain[match.end() :].lstrip()[:1] not in ("?", "？")
        and _names_somebody(name := match["name"].lower().strip(), language)
    )


def _names_somebody(name: str, language: str) -> bool:
    """Whether words are no words of a request or of talking: "the slowest", "the others", "the one" name nobody."""
    never = set(table("talk_forms", language)["nicknames"]["never"].split())
    return not (never.intersection((name, *name.split())) or Sentence(name, own_words()).concepts or mentions(name))


@functools.cache
def _patterns(language: str) -> tuple[re.Pattern[str], ...]:
    given = table("talk_forms", language)["nicknames"]["given"]
    return tuple(re.compile(written("talk_forms", language, pattern), re.IGNORECASE) for pattern in given)


@functools.lru_cache(maxsize=256)
def _called(name: str, language: str) -> re.Pattern[str]:
    """A name with the words before it that belong to it, in any case of its language."""
    words = table("talk_forms", language)["nicknames"]
    leading: Mapping[str, str] = words["before"]
    before = "|".join(sorted(map(re.escape, leading), key=len, reverse=True))
    edge = "" if language == "zh" else r"(?<![^\W_])", "" if language == "zh" else rf"(?:{words['endings']})?(?![^\W_])"
    return re.compile(rf"{edge[0]}(?P<before>(?:{before}))?{re.escape(name)}{edge[1]}", re.IGNORECASE)


def _user(before: str | None, number: str, language: str) -> str:
    words = table("talk_forms", language)["nicknames"]
    return words["before"].get((before or "").lower(), words["user"]) + number

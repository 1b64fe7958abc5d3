"""Vocabulary as data: one folder a subject, one TOML file a language, read once; and the patterns made of it.

Patterns are compiled when they are first used: there are more than two hundred, a quarter of the time that a first
sentence takes to compile, and a sentence needs a fifth of them.
"""

from __future__ import annotations

import functools
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast


class _Deferred:
    """Stands for the compiled expression and hands on its methods, which it keeps once they were asked for."""

    def __init__(self, pattern: str) -> None:
        self.pattern = pattern

    @functools.cached_property
    def _compiled(self) -> re.Pattern[str]:
        return re.compile(self.pattern)

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._compiled, name)
        setattr(self, name, found)
        return found


def deferred(pattern: str) -> re.Pattern[str]:
    """A regular expression for its methods and its text; what wants the compiled object itself needs re.compile.

    >>> deferred(r"[0-9]+ W").findall("10 W and 5 W"), deferred("a+").pattern
    (['10 W', '5 W'], 'a+')
    """
    return cast("re.Pattern[str]", _Deferred(pattern))


_FOLDER = Path(__file__).parent
_PART = re.compile(r"\{([a-z_]+)\}")


@functools.cache
def table(subject: str, language: str) -> Mapping[str, Any]:
    """What the file of a language says on a subject.

    >>> table("figures", "en")["shares"]["double"]
    2
    """
    return tomllib.loads((_FOLDER / subject / f"{language}.toml").read_text(encoding="utf-8"))


@functools.cache
def languages_with(subject: str) -> tuple[str, ...]:
    """The languages that have a file on a subject, in the order of their names."""
    return tuple(sorted(file.stem for file in (_FOLDER / subject).glob("*.toml")))


@functools.cache
def words_of(subject: str, section: str, *names: str) -> tuple[str, ...]:
    """The words that the files of all languages list on a subject by these names, each once, the longest first.

    >>> words_of("figures", "bounds", "power")[:2]
    ('consumption', 'wattage')
    """
    tables = [table(subject, language).get(section, {}) for language in languages_with(subject)]
    found = dict.fromkeys(word for each in tables for name in names for word in each.get(name, ()))
    return tuple(sorted(found, key=len, reverse=True))


def any_word(subject: str, section: str, *names: str) -> str:
    """A regular expression for any of the words that the files of all languages list by these names, the longest first.

    A space is any blanks; whether words are whole, the pattern around says.

    >>> any_word("figures", "users", "as_far_as")
    "(?:hasta\\\\s+el|jusqu'au|jusqu'à|bis\\\\s+zu|up\\\\s+to|au)"
    """
    return f"(?:{'|'.join(words_of(subject, section, *names))})".replace(" ", r"\s+")


def either(subject: str, section: str, name: str, **parts: str) -> str:
    """A regular expression for any of those that the files of all languages list by a name, words being whole.

    Each of ``parts`` stands in the place of its ``{name}``.

    >>> either("figures", "users", "articles").startswith(r"\\b(?:der|"), either("figures", "users", "unheard of")
    (True, '(?!)')
    """
    listed = {language: table(subject, language).get(section, {}).get(name, ()) for language in languages_with(subject)}
    spaced = "|".join(dict.fromkeys(each for language, found in listed.items() if language != "zh" for each in found))
    found = "|".join([*([rf"\b(?:{spaced})\b"] if spaced else []), *listed.get("zh", ())]) or "(?!)"
    return _PART.sub(lambda part: parts[part[1]], found)


def written(subject: str, language: str, pattern: str) -> str:
    """A regular expression with what ``[parts]`` of a file says in the place of each ``{part}``."""
    return _PART.sub(lambda part: written(subject, language, table(subject, language)["parts"][part[1]]), pattern)

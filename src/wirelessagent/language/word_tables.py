"""Vocabulary as data: one folder a subject, one TOML file a language, read once."""

from __future__ import annotations

import functools
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

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

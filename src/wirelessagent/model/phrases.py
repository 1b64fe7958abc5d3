"""What an operator may say to mean an objective: a few phrases per language, brought by the objective itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TypeAlias

Phrases: TypeAlias = Mapping[str, tuple[str, ...]]


def phrases(**by_language: Iterable[str]) -> Phrases:
    """Phrases by language code.

    >>> phrases(en=["share alpha-fairly"], zh=["α公平"])["en"]
    ('share alpha-fairly',)
    """
    return MappingProxyType({language: tuple(words) for language, words in by_language.items()})

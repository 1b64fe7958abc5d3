"""The words of a line that leans on its conversation: figures, users, and words of closed classes, or no such line."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.mentions import mentions
from wirelessagent.language.numerals import numbers
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.text import CJK, languages_of, normalise, unaccented
from wirelessagent.language.word_tables import table

_CLASS = {"power": "figure", "rate": "figure"}
"""What a figure with a unit is called, beside nouns."""

_SPACE = re.compile(r"[\s,，.。!！?？;；:：'\"“”()（）…-]+")
_WORD = re.compile(r"[^\W\d_]+")
_ONES = frozenset(
    {
        "one", "a", "an", "un", "uno", "una", "une", "ein", "eine", "einen", "eins", "一", "两", "half", "demi",
        "medio", "halb",
    }
)  # fmt: skip
"""Number words that mostly count nothing."""


@dataclass(frozen=True)
class Token:
    """A word, a figure or users, and the classes that it is in."""

    classes: frozenset[str]
    figure: Quantity | None = None
    users: tuple[str, ...] = ()
    factor: float | None = None


def speaks_of_one(plain: str) -> bool:
    """Whether a pronoun of one user is among the words."""
    words = set(_WORD.findall(_unmarked(plain.lower())))
    return any(
        word in words if word.isascii() else word in plain
        for language in languages_of(plain)
        for word, token in _table(language)[0].items()
        if "pronoun" in token.classes and " " not in word
    )


def tokens_of(line: Line, language: str) -> list[Token] | None:
    """The line as words that are known here; None where one is not."""
    plain = _unmarked(normalise(line.text).lower())
    figures = [figure for figure in parse_quantities(line.text) if figure.kind != "bare"]
    taken = [(figure.start, figure.end) for figure in figures]
    found = mentions(normalise(line.text), line.context.user_names, taken)
    named = [each for each in found if each.role == "named"]
    spans: dict[int, tuple[int, Token]] = {
        each.start: (each.end, Token(frozenset({"users"}), users=each.users)) for each in named
    }
    taken += [(each.start, each.end) for each in named]
    for number in numbers(plain):
        clear = not any(start < number.end and number.start < end for start, end in taken)
        text = plain[number.start : number.end]
        if number.value is not None and clear and text not in _ONES:
            bare = Quantity(
                value=float(number.value), kind="bare", text=text, start=number.start, end=number.end,
                phrase_start=number.start, phrase_end=number.end,
            )  # fmt: skip
            figures.append(bare)
    for figure in figures:
        spans[figure.start] = (figure.end, Token(frozenset({_CLASS.get(figure.kind, figure.kind)}), figure=figure))
    return _segmented(plain, spans, language)


def _segmented(plain: str, spans: Mapping[int, tuple[int, Token]], language: str) -> list[Token] | None:
    found: list[Token] = []
    words, longest = _table(language)
    place = 0
    while place < len(plain):
        space = _SPACE.match(plain, place)
        if space is not None:
            place = space.end()
        else:
            ends = range(min(len(plain), place + longest), place, -1)
            end = next((end for end in ends if plain[place:end] in words and _is_whole(plain, place, end)), None)
            if place in spans and (end is None or words[plain[place:end]].factor is None or end <= spans[place][0]):
                place, token = spans[place]
                found.append(token)
                continue
            if end is None or (place not in spans and any(place < start < end for start in spans)):
                return None
            found.append(words[plain[place:end]])
            place = end
    return found


def _unmarked(text: str) -> str:
    """The text without marks on its letters; as many letters as before."""
    return "".join(unaccented(letter)[:1] or letter for letter in text)


def _is_whole(plain: str, start: int, end: int) -> bool:
    """Whether no word goes on at either end; in Chinese words are not parted."""
    if re.match(f"[{CJK}]", plain[end - 1]):
        return True
    return not (end < len(plain) and plain[end].isalnum() and not re.match(f"[{CJK}]", plain[end]))


@functools.cache
def _table(language: str) -> tuple[Mapping[str, Token], int]:
    """The words of a language with their classes, and the length of the longest."""
    listed = table("fragment_words", language)
    factors = cast("dict[str, float]", listed["factors"])
    classes: dict[str, set[str]] = {}
    for name in listed.keys() - {"factors"}:
        for word in cast("list[str]", listed[name]):
            classes.setdefault(_unmarked(word), set()).add(name)
    factors = {_unmarked(word): factor for word, factor in factors.items()}
    for word in factors:
        classes.setdefault(word, set()).add("factor")
    tokens = {word: Token(frozenset(names), factor=factors.get(word)) for word, names in classes.items()}
    return tokens, max(map(len, tokens))

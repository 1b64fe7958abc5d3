"""Closed classes of words by language, and where they stand: data in ``moods/<language>.toml``."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping, Sequence

from wirelessagent.language.base_words import languages_of
from wirelessagent.language.text import Span, clause_start
from wirelessagent.language.word_tables import table

_LETTER = r"[0-9A-Za-zÀ-ɏ]"


def table_of(language: str) -> Mapping[str, Mapping[str, Sequence[str]]]:
    """The classes of a language: words by class and by how far they reach."""
    return table("moods", language)


def places(words: Sequence[str], plain: str) -> Iterator[Span]:
    """Where any of these words stand, the longest where several begin; "*" is any ending, "#" a number.

    Only words of which a part is in the text are made patterns: a language has hundreds.

    >>> list(places(("so far", "so", "complain*"), "so far they complained"))
    [(0, 6), (12, 22)]
    """
    small, end = plain.lower(), 0
    found = [match.span() for word in words if _stem(word) in small for match in _pattern(word).finditer(plain)]
    for span in sorted(found, key=lambda span: (span[0], -span[1])):
        if span[0] >= end:
            end = span[1]
            yield span


def without(words: Sequence[str], plain: str) -> str:
    """A text without these words.

    >>> without(("the", "any"), "not the limit")
    'not  limit'
    """
    gone = list(places(words, plain))
    return "".join(sign for at, sign in enumerate(plain) if not any(start <= at < end for start, end in gone))


@functools.cache
def _stems(language: str) -> Sequence[tuple[str, Sequence[tuple[str, str]]]]:
    """A language's classes with how far they reach, and each word with the part of it that is always written so."""
    return [
        (f"{name}:{reach}", [(_stem(word), word) for word in words])
        for name, classes in table_of(language).items()
        for reach, words in classes.items()
    ]


@functools.lru_cache(maxsize=16)
def classes_in(plain: str) -> tuple[tuple[str, Span], ...]:
    """The classes whose words stand in a text, with how far they reach, and where they stand, from left to right.

    >>> classes_in("if only it were 5 W")[0]
    ('condition:sentence', (0, 7))
    """
    small, found = plain.lower(), list[tuple[str, Span]]()
    for language in languages_of(plain):
        for name, words in _stems(language):
            able = [word for stem, word in words if stem in small]
            found += [(name, span) for span in places(able, plain)]
    return tuple(sorted(found, key=lambda each: (each[1][0], -each[1][1])))


def is_ordered(plain: str) -> bool:
    """Whether a clause begins with a word of order, perhaps behind words that lead up to it.

    >>> is_ordered("he is only testing, so leave user 3 out"), is_ordered("user 3 is left out")
    (True, False)
    """
    for language in languages_of(plain):
        classes = table_of(language)
        for start, _ in places(classes["imperative"]["words"], plain):
            first = clause_start(plain, start)
            if not any(map(str.isalnum, without(classes["lead"]["words"], plain[first:start]))):
                return True
    return False


def is_supposed(plain: str) -> bool:
    """Whether a word of a condition stands anywhere.

    >>> is_supposed("what if it were 5 W"), is_supposed("nothing above 5 W")
    (True, False)
    """
    reaches = (table_of(language)["condition"].items() for language in languages_of(plain))
    words = (listed for classes in reaches for reach, listed in classes if reach != "first")
    return any(any(True for _ in places(listed, plain)) for listed in words)


_GAP = (  # between words of an expression: "he'd also like"
    r"\s+(?:(?:also|really|very much|just|rather|only|even|still|dearly|much|auch|gern|sehr|eben|aussi|"
    r"bien|encore|también|mucho|solo)\s+)?"
)


@functools.cache
def _stem(word: str) -> str:
    """The longest part of a word that is always written so."""
    return max(re.split(r"[*# ]+", word.lower()), key=len)


@functools.cache
def _pattern(word: str) -> re.Pattern[str]:
    return re.compile(_written(word), re.IGNORECASE)


def _written(word: str) -> str:
    body = re.escape(word).replace(r"\ ", _GAP).replace(r"\*", r"\w*").replace(r"\#", r"\s?\d+\s?")
    if "\u3400" <= word[-1] <= "\u9fff" or "\u3400" <= word[0] <= "\u9fff":
        return body
    return (rf"(?<!{_LETTER})" if word[0].isalnum() else "") + body + (rf"(?!{_LETTER})" if word[-1].isalnum() else "")

"""Spelling made uniform without moving a single character, so that every finding can be quoted from the original.

Deliberately not NFKC: that would turn "10² W" into "102 W".
"""

from __future__ import annotations

import bisect
import functools
import re
import sys
import unicodedata
import zlib
from collections.abc import Iterable, Iterator
from typing import TypeAlias

from wirelessagent.language.deferred import deferred
from wirelessagent.language.word_tables import table, words_of

_SAME_LENGTH = {
    # Full-width ASCII, but for the comma and the semicolon: they never stand inside a number.
    **{chr(code): chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F) if code not in (0xFF0C, 0xFF1B)},
    **dict.fromkeys("\u3000\u00a0\u2009\u202f\t\r", " "),
    **dict.fromkeys("\u2018\u2019\u02bc", "'"),
    "\u00b5": "\u03bc",  # the micro sign and the Greek letter
    "\u2212": "-",
    "〜": "~",
    "≦": "≤",
    "≧": "≥",
    "⩽": "≤",
    "⩾": "≥",
}

_TABLE = str.maketrans(_SAME_LENGTH)

Span: TypeAlias = tuple[int, int]
"""Characters [start, end) of a text."""

CJK = "\u3400-\u9fff\uf900-\ufaff"
WORD_OR_SIGN = deferred(rf"[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:['’](?:(?![{CJK}])[^\W_])+)?|[^\w\s\ud800-\udfff]")
"""A word, a Chinese character, or a sign."""

_TELLING = 2
"""Small words by which a language is told from the others."""
_WORD = deferred(r"[^\W\d_]+")
_SMALL_WORDS = {language: frozenset(table("figures", language)["small_words"]) for language in ("en", "es", "fr", "de")}
_LETTERS = {"es": "ñ¿¡", "fr": "çêœàùèîû", "de": "ßäöü"}

USER_NOUN = (
    rf"(?:{'|'.join(words_of('figures', 'users', 'nouns'))})"
    r"(?:\s*(?:number|nummer|número|numéro|no\.?|nr\.?|n°|nº|#))?"
)

NUMBERED_USERS = rf"\b{USER_NOUN}\s*(?:[0-9]{{1,2}}\s*(?:,|and|or|y|et|und|oder|ou|o|&|/)\s*)*$"
"""What stands before a number that names a user: "user ", "users 1 and "."""

CLAUSE_END = r"[,;:!?()\n\uff0c\uff1b。、…—]|\.(?![0-9])"
_CUT = deferred(CLAUSE_END)


def normalise(text: str) -> str:
    """The text with full-width forms, odd spaces, minus signs and apostrophes made plain; same length.

    >>> normalise("\uff11\uff10\u00a0\u00b5W")
    '10 μW'
    """
    return text.translate(_TABLE)


@functools.lru_cache(maxsize=64)
def lowered(text: str) -> str:
    """The text in small letters; same length, so that letters stay whose small form is longer."""
    small = text.lower()
    if len(small) == len(text):
        return small
    return "".join(low if len(low := letter.lower()) == 1 else letter for letter in text)


def unaccented(text: str) -> str:
    """The text without the marks on its letters, which quick fingers leave out.

    >>> unaccented("máximo"), unaccented("über")
    ('maximo', 'uber')
    """
    if text.isascii():
        return text
    return "".join(sign for sign in unicodedata.normalize("NFD", text) if unicodedata.category(sign) != "Mn")


def hashed(text: str) -> int:
    """A number for a text, the same everywhere."""
    return zlib.crc32(text.encode("utf-8", "replace"))


def is_chinese(word: str) -> bool:
    """Whether a text is a Chinese character, or begins with one."""
    return "\u3400" <= word < "\ua000" or "\uf900" <= word < "\ufb00"


def replaced(text: str, spans: Iterable[tuple[int, int, str]]) -> str:
    """A text with others in the places of spans from left to right; one that begins within another is left out.

    >>> replaced("user 3 gets 1 W", [(0, 6, "@"), (5, 6, "3"), (12, 15, "#")])
    '@ gets #'
    """
    parts, place = list[str](), 0
    for start, end, other in spans:
        if start >= place:
            parts += [text[place:start], other]
            place = end
    return "".join([*parts, text[place:]])


def overlaps(span: Span, others: Iterable[Span]) -> bool:
    """Whether a span shares a character with any of the others.

    >>> overlaps((0, 3), [(3, 5)]), overlaps((0, 3), [(7, 9), (2, 5)])
    (False, True)
    """
    return any(start < span[1] and span[0] < end for start, end in others)


def is_within(span: Span, other: Span) -> bool:
    """Whether a span lies within another, or is the same."""
    return other[0] <= span[0] and span[1] <= other[1]


def has_chinese(text: str) -> bool:
    """Whether a Chinese character stands in a text; a pattern with so wide a range takes milliseconds to compile.

    >>> has_chinese("boost 速度"), has_chinese("más de 2 μW")
    (True, False)
    """
    return not text.isascii() and any(map(is_chinese, text))


@functools.lru_cache(maxsize=64)
def language_of(text: str) -> str:
    """The language of a sentence: "zh" where a Chinese character stands, else "es", "fr" or "de" where its small words
    or letters outweigh those of English, else "en".

    >>> language_of("boost 速度"), language_of("boost the speed"), language_of("la potencia más baja")
    ('zh', 'en', 'es')
    """
    if has_chinese(text):
        return "zh"
    counts = _counts(text)
    best = max(counts, key=lambda language: counts[language])
    return best if counts[best] > counts["en"] else "en"


def language_in_a_talk(text: str, before: str) -> str:
    """The language of a line: that of the talk before it, "" at its start, unless its own words tell another clearly.

    >>> language_in_a_talk("plus 6", "en"), language_in_a_talk("mejor 2 Mbit/s", "es"), language_in_a_talk("10 W", "zh")
    ('en', 'es', 'zh')
    >>> language_in_a_talk("and what is the rate of user 3?", "es"), language_in_a_talk("no", "")
    ('en', 'en')
    """
    own = language_of(text)
    if not before or own == "zh":
        return own
    counts, words = _counts(text), sum(len(word) > 1 for word in _WORD.findall(text))
    if before == "zh":
        return own if words > 1 else before
    ahead = counts[own] - counts[before]
    return own if ahead >= _TELLING or (ahead > 0 and words > 1) else before


def languages_of(text: str) -> tuple[str, ...]:
    """The languages that a sentence may be in: all of them where its small words hardly tell.

    >>> languages_of("save the power"), languages_of("10 W")
    (('en',), ('en', 'es', 'fr', 'de'))
    """
    if has_chinese(text):
        return ("zh",)
    counts = _counts(text)
    best = max(counts.values())
    return tuple(language for language, count in counts.items() if count == best or best < _TELLING)


def _counts(text: str) -> dict[str, int]:
    """How much the small words and letters of a sentence speak for each language."""
    small = text.lower()
    words = _WORD.findall(small)
    counts = {language: sum(word in known for word in words) for language, known in _SMALL_WORDS.items()}
    for language, letters in _LETTERS.items():
        counts[language] += 2 * sum(small.count(letter) for letter in letters)
    return counts


class Phrases:
    """A pattern in small letters of normalised texts in whatever letters; matches hold small letters.

    ``marks`` are pieces of words, an underscore being a space, one of which stands in every match: a text that holds
    none need not be searched. No marks: search any text.

    >>> quarters = Phrases(r"\\bquarters? of\\b", "quarter")
    >>> quarters.search("A Quarter of it").span(), quarters.search("half of it")
    ((2, 12), None)
    """

    def __init__(self, pattern: str, marks: str = "") -> None:
        self.compiled = deferred(pattern)
        self.marks = tuple(mark.replace("_", " ") for mark in marks.split())

    def search(self, plain: str, start: int = 0, end: int = sys.maxsize) -> re.Match[str] | None:
        text = lowered(plain)
        return self.compiled.search(text, start, end) if self.may_match(text) else None

    def finditer(self, plain: str, start: int = 0, end: int = sys.maxsize) -> Iterator[re.Match[str]]:
        text = lowered(plain)
        return self.compiled.finditer(text, start, end) if self.may_match(text) else iter(())

    def may_match(self, text: str) -> bool:
        """Whether a text in small letters holds any of the marks."""
        return not self.marks or any(mark in text for mark in self.marks)


def clause_start(plain: str, place: int, from_: int = 0) -> int:
    """Where the clause that ``place`` lies in begins, no farther ahead than ``from_``.

    >>> clause_start("leave 3 out, max rate", 17)
    12
    """
    if place > from_ and plain[place - 1] == ".":
        return place
    cuts = _cuts(plain)
    before = bisect.bisect_left(cuts, place)
    return cuts[before - 1] + 1 if before and cuts[before - 1] >= from_ else from_


def clause_end(plain: str, place: int, to: int | None = None) -> int:
    """Where the clause that goes on at ``place`` ends, no farther behind than ``to``.

    >>> clause_end("leave 3 out, max rate", 7)
    11
    """
    to = len(plain) if to is None else to
    cuts = _cuts(plain)
    after = bisect.bisect_left(cuts, place)
    if after < len(cuts) and cuts[after] < to:
        return cuts[after]
    return to - 1 if to > place and plain[to - 1] == "." else to


@functools.lru_cache(maxsize=64)
def _cuts(plain: str) -> tuple[int, ...]:
    return tuple(cut.start() for cut in _CUT.finditer(plain))

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
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

from wirelessagent.language.word_tables import any_word, deferred

_SIMPLIFIED = Path(__file__).with_name("traditional.txt").read_text(encoding="utf-8").split()
"""Traditional characters, each with the simplified one that all Chinese words here are written in."""
_TABLE = str.maketrans(
    {
        **{pair[0]: pair[1] for pair in _SIMPLIFIED},
        # Full-width ASCII, but for the comma and the semicolon: they never stand inside a number.
        **{chr(code): chr(code - 0xFEE0) for code in range(0xFF01, 0xFF5F) if code not in (0xFF0C, 0xFF1B)},
        **dict.fromkeys("\u3000\u00a0\u2009\u202f\t\r", " "),
        **dict.fromkeys("\u2018\u2019\u02bc", "'"),
        "\u00b5": "\u03bc",  # the micro sign and the Greek letter
        **dict(zip("\u2212〜≦≧⩽⩾", "-~≤≥≤≥", strict=True)),
    }
)

Span: TypeAlias = tuple[int, int]
"""Characters [start, end) of a text."""

CJK = "\u3400-\u9fff\uf900-\ufaff"
WORD = rf"[{CJK}]|(?:(?![{CJK}])[^\W_])+(?:['’](?:(?![{CJK}])[^\W_])+)?"
"""A word, or a Chinese character."""
WORD_OR_SIGN = deferred(rf"{WORD}|[^\w\s\ud800-\udfff]")

USER_NOUN = any_word("figures", "users", "nouns") + r"(?:\s*(?:number|nummer|número|numéro|no\.?|nr\.?|n°|nº|#))?"

AND = any_word("figures", "numbers", "joins")
"""What joins two of a kind, in the languages that write it apart."""
AND_ALONE = deferred(rf"(?i)\b(?:{AND})\b")

_BREATH = deferred(rf"(?<=[{CJK}]{{3}}) (?=[{CJK}]{{3}})")
CLAUSE_END = r"[,;:!?()\n\uff0c\uff1b。、…—]|\.(?![0-9])"
_CUT = deferred(CLAUSE_END)


def normalise(text: str) -> str:
    """The text with full-width forms, odd spaces, minus signs, apostrophes and traditional characters made plain.

    It is of the same length. What is dictated in Chinese has blanks where commas should be.

    >>> normalise("\uff11\uff10\u00a0\u00b5W"), normalise("用戶3"), normalise("总速率最高 二号不服务")
    ('10 μW', '用户3', '总速率最高，二号不服务')
    """
    plain = text.translate(_TABLE)
    return plain if plain.isascii() else _BREATH.sub("\uff0c", plain)


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


def written_over(text: str, start: int, end: int, instead: str) -> str:
    """A text with other words at the end of a span, the rest of which is blank: all else stays at its place.

    >>> written_over("half of 20 W, please", 0, 12, "10W")
    '         10W, please'
    """
    return text[:start] + instead.rjust(end - start) + text[end:]


def blanked(text: str, spans: Iterable[Span], sign: str = " ") -> str:
    """A text with nothing but a sign in spans: all else stays at its place.

    >>> blanked("user 3 gets 1 W", [(0, 6)], "@")
    '@@@@@@ gets 1 W'
    """
    for start, end in spans:
        text = text[:start] + sign * (end - start) + text[end:]
    return text


def overlaps(span: Span, others: Iterable[Span]) -> bool:
    """Whether a span shares a character with any of the others.

    >>> overlaps((0, 3), [(3, 5)]), overlaps((0, 3), [(7, 9), (2, 5)])
    (False, True)
    """
    return any(start < span[1] and span[0] < end for start, end in others)


class Beside(NamedTuple):
    """Words right ahead of a span of a normalised text, and words right behind."""

    ahead: re.Pattern[str]
    behind: re.Pattern[str]

    def is_at(self, plain: str, start: int, end: int, from_: int = 0) -> bool:
        """Whether such words stand on either side of a span, those ahead no farther than ``from_``."""
        return bool(self.ahead.search(plain, from_, start) or self.behind.match(plain, end))

    def widened(self, plain: str, span: Span) -> Span:
        """The span with such words."""
        ahead, behind = self.ahead.search(plain, 0, span[0]), self.behind.match(plain, span[1])
        return ahead.start() if ahead else span[0], behind.end() if behind else span[1]


def is_within(span: Span, other: Span) -> bool:
    """Whether a span lies within another, or is the same."""
    return other[0] <= span[0] and span[1] <= other[1]


def has_chinese(text: str) -> bool:
    """Whether a Chinese character stands in a text; a pattern with so wide a range takes milliseconds to compile.

    >>> has_chinese("boost 速度"), has_chinese("más de 2 μW")
    (True, False)
    """
    return not text.isascii() and any(map(is_chinese, text))


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


_SENTENCE_END = re.compile(r"(?<=[.!?…])\s+(?=[A-ZÀ-Þ¿¡\"«„“(])|(?<=[。！？])(?=\S)")


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


def clauses(plain: str, whole: Sequence[Span] = ()) -> list[Span]:
    """The spans of the clauses of a text, from left to right; spans that are ``whole`` are cut nowhere.

    >>> clauses("leave 3,4 out, max rate", [(6, 9)])
    [(0, 13), (14, 23)]
    """
    cuts = [cut for cut in _cuts(plain) if not any(start < cut < end for start, end in whole)]
    spans = zip((0, *(cut + 1 for cut in cuts)), (*cuts, len(plain)), strict=True)
    return [(start, end) for start, end in spans if plain[start:end].strip()]


def sentences(text: str) -> list[Span]:
    """The spans of the sentences of a text, from left to right.

    >>> text = "It was slow. Max rate, 1.5 W max. per user"
    >>> [text[start:end] for start, end in sentences(text)]
    ['It was slow. ', 'Max rate, 1.5 W max. per user']
    """
    ends = [match.end() for match in _SENTENCE_END.finditer(text)]
    return [(start, end) for start, end in zip((0, *ends), (*ends, len(text)), strict=True) if text[start:end].strip()]


@functools.lru_cache(maxsize=64)
def _cuts(plain: str) -> tuple[int, ...]:
    return tuple(cut.start() for cut in _CUT.finditer(plain))

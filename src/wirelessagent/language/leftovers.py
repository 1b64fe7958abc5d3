"""Numbers that no rule has read: each leads to a question, because a figure that is dropped is a wish ignored.

Every digit, fraction and superscript of a sentence is either part of a quantity, of a count that describes the cell
("8 users"), of a name ("P1", "5G") or left over ("10^5", "3 dB", "10 joules"). The same holds for number words that
cannot be mere idiom ("half of", "ten volts"; not "a", "one", "十分").
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence

from wirelessagent.language.numerals import Number, numbers
from wirelessagent.language.units import unit_at

Span = tuple[int, int]

# Generations, picture sizes and the like: they look like figures and describe.
_NAMES = re.compile(
    r"(?i)(?<![A-Za-z0-9.])(?:[2-6]G|[248]K|(?:720|1080|1440|2160)p|wi-?fi\s?[4-7]|24/7)(?![A-Za-z0-9])"
    r"(?!\s*(?:each|per|apiece|every|for (?:each|every))\b)"
)
_VAGUE = re.compile(
    r"(?i)(?<!as )\b(?:few|several|couple|handful|pair|dozens?|hundreds|thousands|some|many|lots|plenty|"
    r"number)\s+(?:of\s+)?"
)
_IDIOMS = ("a", "an", "one")
_CHINESE_FIGURE = re.compile(r"[二三四五六七八九]|十(?!分)|两(?=\s*[个名位台倍])")
_TO_THE_RIGHT = re.compile(r"[^\s,;:!?\uff0c\uff1b。、)]*(?:\s*[\^*×·/+÷x]\s*[^\s,;]+)*(?:\s?(?:of\s+)?[A-Za-zμΩ/]+)?")


def unread(plain: str, covered: Sequence[Span]) -> Span | None:
    """The first number of a normalised text that lies in none of the covered spans, with the word that follows it.

    >>> text = "max rate, 43 dB"
    >>> start, end = unread(text, [])
    >>> text[start:end]
    '43 dB'
    """
    known = [*covered, *((match.start(), match.end()) for match in _NAMES.finditer(plain))]
    places = sorted(place for place in _numbers_at(plain) if not _inside(place, known))
    if not places:
        return None
    match = _TO_THE_RIGHT.match(plain, places[0])
    end = match.end() if match is not None else places[0]
    return places[0], max(end, places[0] + 1)


def _numbers_at(plain: str) -> Iterator[int]:
    yield from (place for place, letter in enumerate(plain) if unicodedata.category(letter).startswith("N"))
    yield from (number.start for number in numbers(plain) if _is_figure(plain, number))
    for match in _VAGUE.finditer(plain):
        if unit_at(plain, match.end()) is not None:
            yield match.start()


def _is_figure(plain: str, number: Number) -> bool:
    """Whether a number in words stands for an amount, not for a turn of phrase."""
    if number.value is None:
        return False
    if number.form == "words":
        return plain[number.start : number.end].lower() not in _IDIOMS
    return number.form == "chinese" and _CHINESE_FIGURE.search(plain, number.start, number.end + 1) is not None


def _inside(place: int, spans: Sequence[Span]) -> bool:
    return any(start <= place < end for start, end in spans)

"""Numbers that no rule has read: each leads to a question, because a figure that is dropped is a wish ignored.

Every digit, fraction and superscript of a sentence is either part of a quantity, of a count that describes the cell
("8 users"), of a name ("P1", "5G") or left over ("10^5", "3 dB", "10 joules"). The same holds for number words that
cannot be mere idiom ("half of", "ten volts"; not "a", "one", "十分").
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from decimal import Decimal

from wirelessagent.language.factors import factors
from wirelessagent.language.numerals import Number, numbers
from wirelessagent.language.units import unit_at

Span = tuple[int, int]

# Generations, picture sizes and the like: they look like figures and describe.
_NAMES = re.compile(
    r"(?i)(?<![A-Za-z0-9.])(?:[2-6]G|[248]K|(?:720|1080|1440|2160)p|wi-?fi\s?[4-7]|24/7)(?![A-Za-z0-9])"
    r"(?!\s*(?:each|per|apiece|every|for (?:each|every))\b)"
)
_TIMES = re.compile(
    r"(?i)(?<![\w.,])[0-9]{1,2}(?::[0-9]{2})?\s?(?:a\.?m\.?|p\.?m\.?|o'clock|uhr)(?![A-Za-z])|"
    r"(?<![\w.,])[0-9]{1,2}:[0-9]{2}(?![0-9])|"
    r"\b(?:for|in|within|after|until|during|next|last|past|every)\s+(?:the\s+)?(?:next\s+|last\s+)?(?:[0-9]{1,3}|"
    r"two|three|four|five|six|ten|twelve|thirty)\s+"
    r"(?:hours?|minutes?|mins?|days?|weeks?|months?|years?)\b|[0-9一二两三四五六七八九十半]{1,3}(?:点钟?|小时|分钟|"
    r"个小时|天|周|个月|年)(?!\s*[W瓦])|"
    r"(?:周|星期|礼拜)[一二三四五六日天]|[一二三四五六七八九十0-9]{1,2}月|[一二三四五六七八九十0-9]{1,2}[日]"
)
_OF_THE_YEAR = re.compile(r"(?i)\b(?:this|last|next|each|every|per|the) (?:first |last )?quarter\b(?! of)")
_PAIRS = re.compile(
    r"(?i)\b(?:between|of|the|these|those|either|in|both|or|my|our|by)\s+(?:the\s+)?(?:two|three)(?=\s*(?:$|"
    r"[.,;:!?)]|of\s+(?:them|us)|sides?|extremes?|ends?|goals?|things?|worlds?|"
    r"aims?|plans?|results?|wishes|objectives))|[两]者|两个都|两头|两全|两边|一举两得|三心二意|四面八方|十足|"
    r"第[一二三]|万一|一二"
)
_VAGUE = re.compile(
    r"(?i)(?<!as )\b(?:few|several|couple|handful|pair|dozens?|hundreds|thousands|some|lots|plenty|"
    r"(?<=a )number)\s+(?:of\s+)?"
)
_SETS_A_LIMIT = re.compile(
    r"(?i)(?:\b(?:power|rate|rates|speed|limit|cap|budget|max|min|maximum|minimum|exactly|potencia|puissance|débit|leistung|rmin|pmax)|[=:<>≤≥])\s*$"
)
_UNIT_OF_ANOTHER_KIND = re.compile(
    r"(?i)\s?(?:[kMG](?![^\W\d_])|dB|[km]?Wh|[km]?V|J|[km]?A|[kMG]?Hz|joules?|julios?|volts?|voltios?|amps?|amperes?|"
    r"decibels?|hertz|(?:kilo|mega|giga)hertz)(?![^\W\d_])|\s*[千兆毫]?(?:伏|焦|安培|赫|分贝)"
)
_WHOLE = re.compile(r"[0-9]+")
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
    known = [*covered, *idioms(plain)]
    places = sorted(place for place in _numbers_at(plain) if not _inside(place, known))
    if not places:
        return None
    match = _TO_THE_RIGHT.match(plain, places[0])
    end = match.end() if match is not None else places[0]
    return places[0], max(end, places[0] + 1)


def idioms(plain: str) -> list[Span]:
    """Where numbers are part of a name, a time or a turn of phrase."""
    return [match.span() for pattern in (_NAMES, _TIMES, _PAIRS, _OF_THE_YEAR) for match in pattern.finditer(plain)]


def loose_numbers(plain: str, covered: Sequence[Span]) -> list[Number]:
    """The numbers and multiplying words of a normalised text that lie in none of the covered spans.

    Names ("5G") and mere idiom ("one") are none.
    """
    taken = [*covered, *idioms(plain)]
    found: list[Number] = []
    candidates = [*factors(plain), *(n for n in numbers(plain) if n.form == "digits" or _is_figure(plain, n))]
    for number in sorted(candidates, key=lambda each: each.start - each.end):  # "one and a half" before "half"
        number = _cut(plain, number, taken)
        if not any(start < number.end and number.start < end for start, end in taken):
            found.append(number)
            taken.append((number.start, number.end))
    return sorted(found, key=lambda number: number.start)


def _cut(plain: str, number: Number, taken: Sequence[Span]) -> Number:
    """The number without a part that belongs to somebody's name: "权重3,9号用户" holds 3, not 3.9."""
    match = _WHOLE.match(plain, number.start)
    if match is None or not any(match.end() < start < number.end for start, _ in taken):
        return number
    return Number(value=Decimal(match.group()), start=number.start, end=match.end(), form=number.form)


def may_be_a_limit(plain: str, number: Number) -> bool:
    """Whether a number stands where a limit would, or before a unit that no limit here has ("43 dB", "10 joules")."""
    after = _UNIT_OF_ANOTHER_KIND.match(plain, number.end) is not None
    return after or _SETS_A_LIMIT.search(plain, 0, number.start) is not None


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

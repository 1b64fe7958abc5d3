"""Numbers that no rule has read: each leads to a question, because a figure that is dropped is a wish ignored.

Every digit, fraction and superscript of a sentence is either part of a quantity, of a count that describes the cell
("8 users"), of a name ("P1", "5G") or left over ("10^5", "3 dB", "10 joules"). The same holds for number words that
cannot be mere idiom ("half of", "ten volts"; not "a", "one", "十分").
"""

from __future__ import annotations

import functools
import unicodedata
from collections.abc import Iterator, Sequence
from decimal import Decimal

from wirelessagent.language.deferred import deferred
from wirelessagent.language.numerals import Number, factors, numbers
from wirelessagent.language.text import Phrases, Span, overlaps
from wirelessagent.language.units import unit_at
from wirelessagent.language.word_tables import either

# Generations, picture sizes and the like: they look like figures and describe.
_NAMES = deferred(
    r"(?i)(?<![A-Za-z0-9.])(?:[2-6]G|[248]K|(?:720|1080|1440|2160)p|wi-?fi\s?[4-7]|24/7)(?![A-Za-z0-9])"
    r"(?!\s*(?:each|per|apiece|every|for (?:each|every))\b)"
)
_SPELL = (
    r"(?:h|hours?|minutes?|seconds?|days?|nights?|weeks?|months?|years?|horas?|minutos?|segundos?|d[ií]as?|noches?|"
    r"semanas?|mes(?:es)?|años?|heures?|secondes?|jours?|nuits?|semaines?|mois|ans|années?|uhr|stunden?|minuten?|"
    r"sekunden?|tage?n?|nächten?|wochen?|monate?n?|jahre?n?|a\.?m\.?|p\.?m\.?|o'clock)(?![A-Za-zÀ-ÿ/])"
)
_MONTH = (
    r"(?:jan(?:uary|vier|uar)|enero|février|feb(?:ruary|ruar|rero)|märz|mar(?:ch|s|zo)|april|avril|"
    r"abril|may|mai|mayo|june?|juin|juni|junio|july|juillet|juli|julio|august|août|agosto|sept?(?:ember|embre|"
    r"iembre)|oct(?:ober|obre|ubre)|oktober|nov(?:ember|embre|iembre)|de[cz]ember|"
    r"diciembre|décembre)(?![A-Za-zÀ-ÿ])"
)
_TIMES = Phrases(
    rf"(?<![\w.,])[0-9]{{1,3}}(?::[0-9]{{2}}|[.,]5)?\s?{_SPELL}|(?<![\w.,])[0-9]{{1,2}}[:：][0-9]{{2}}(?![0-9])|"
    rf"(?<![\w.,])[0-9]{{1,2}}(?:\.|st|nd|rd|th|er)?\s+(?:de\s+|of\s+)?{_MONTH}|"
    r"(?<![\w.,])(?:19|20)[0-9]{2}(?=\s*(?:$|[,.;:!?)]|年))|"
    rf"\b(?:von|zwischen|entre|between|from) [0-9]{{1,2}}(?=(?: h)? (?:bis|und|y|et|and|to|à) [0-9]{{1,2}}\s?{_SPELL})|"
    r"\b(?:half an?|a half|next half) hour\b|\blas? [0-9]{1,2} de la (?:mañana|tarde|noche|madrugada)|"
    r"\b(?:for|in|within|after|until|during|next|last|past|every)\s+(?:the\s+)?(?:next\s+|last\s+)?"
    r"(?:two|three|four|five|six|ten|twelve|thirty)\s+"
    r"(?:hours?|minutes?|mins?|days?|weeks?|months?|years?)\b|[0-9一二两三四五六七八九十半]{1,3}(?:点钟?|小时|分钟|"
    r"个小时|天|周|个月|年)(?!\s*[w瓦])|"
    r"(?:周|星期|礼拜)[一二三四五六日天]|[一二三四五六七八九十0-9]{1,2}月|[一二三四五六七八九十0-9]{1,2}[日]"
)
_OF_THE_YEAR = Phrases(r"\b(?:this|last|next|each|every|per|the) quarter\b", "quarter")
_VAGUE = deferred(
    r"(?i)(?<!as )\b(?:few|several|couple|handful|pair|dozens?|hundreds|thousands|some|lots|plenty|"
    r"(?<=a )number)\s+(?:of\s+)?"
)
_SETS_A_LIMIT = deferred(rf"(?i)(?:{either('figures', 'bounds', 'names')}|[=:<>≤≥])\s*$")
_IS_GIVEN = deferred(r"\s*(?:→|[-=]>|[=:])\s*[0-9.]")  # "floors: 1 → 300k, 2 → 1M"
_UNIT_OF_ANOTHER_KIND = deferred(
    r"(?i)\s?(?:[kMG](?![^\W\d_])|dB|J|[km]?A|joules?|julios?|amps?|amperes?|decibels?)(?![^\W\d_])|\s*[千兆毫]?(?:焦|安培|分贝)"
)
_ALONE_AHEAD = deferred(r"(?i)(?:^|[,;:.!?\uff0c\uff1b。])\s*(?:with|at|on|con|a|avec|à|mit|bei|用)?\s*$|\bwith\s+$")
_ALONE_BEHIND = deferred(r"\s*(?:$|[,;:.!?\uff0c\uff1b。])")
_ALL_IDIOMS = (_NAMES, _TIMES, _OF_THE_YEAR)
_RATING = deferred(  # what a device has, and a limit only where nothing else is said; abbreviations, "43 dbx"
    r"\s?-?(?:(?![A-Z]{1,4}s\b)(?i:[bcdfghjklmnpqrstvwxz]{2,5})|"
    r"(?i:[km]?V|volts?|voltios?|[km]?Wh|[kMG]?Hz|hertz|(?:kilo|mega|giga)hertz))(?![^\W\d_])|\s*[千兆毫]?(?:伏|赫)"
)
FOREIGN_UNIT = deferred(  # no user's number stands before one
    r"(?i)\s?-?(?:[kMG]?Hz|hertz|[km]?V|volts?|voltios?|(?-i:[km]?A)|[km]?Wh|J|joules?|julios?|dB|°|[kMGT]?B|bits?|bytes?|"
    r"kilo\w+|mega\w+|giga\w+|cm|mm|km|m²|ms|s|secs?|se[cg]\w{3,6}|sekunden?|min|minut\w+|h|grad|degrees?|percent)"
    r"(?![^\W\d_])"
)
_WHOLE = deferred(r"[0-9]+")
_IDIOMS = frozenset(
    (
        "a", "an", "one", "un", "une", "uno", "una", "ein", "eins", "eine", "einen", "einem", "einer", "eines", "cero",
        "medio", "media", "medios", "medias", "demi", "demie", "halb", "halbe", "halben", "halbes", "halber",
    )
)  # fmt: skip
POWER_NOUNS = "power|potencia|puissance|leistung|sendeleistung"
_OF_POWER = deferred(rf"(?i)[\s-](?:{POWER_NOUNS})\b")  # "halbe Leistung"
_CHINESE_FIGURE = deferred(r"[二三四五六七八九]|十(?!分)|两(?=\s*[个名位台倍])")
_TO_THE_RIGHT = deferred(r"[^\s,;:!?\uff0c\uff1b。、)]*(?:\s*[\^*×·/+÷x]\s*[^\s,;]+)*(?:\s?(?:of\s+)?[A-Za-zμΩ/]+)?")


def unread(plain: str, covered: Sequence[Span]) -> Span | None:
    """The first number of a normalised text that lies in none of the covered spans, with the word that follows it.

    >>> text = "max rate, 43 dB"
    >>> start, end = unread(text, [])
    >>> text[start:end]
    '43 dB'
    """
    known = [*covered, *idioms(plain)]
    places = sorted(place for place in _numbers_at(plain) if not overlaps((place, place + 1), known))
    if not places:
        return None
    match = _TO_THE_RIGHT.match(plain, places[0])
    end = match.end() if match is not None else places[0]
    return places[0], max(end, places[0] + 1)


@functools.lru_cache(maxsize=64)
def idioms(plain: str) -> tuple[Span, ...]:
    """Where numbers are part of a name, a time or a turn of phrase."""
    return tuple(
        match.span()
        for pattern in _ALL_IDIOMS
        for match in pattern.finditer(plain)
        if not (pattern is _TIMES and "may" in plain[slice(*match.span())])  # no month
    )


def is_all_said(plain: str, start: int, end: int) -> bool:
    """Whether a clause says nothing but the figure at [start, end), as limits are said: "max rate, 10 Wh"."""
    return _ALONE_AHEAD.search(plain, 0, start) is not None and _ALONE_BEHIND.match(plain, end) is not None


def loose_numbers(plain: str, covered: Sequence[Span]) -> list[Number]:
    """The numbers and multiplying words of a normalised text that lie in none of the covered spans.

    Names ("5G") and mere idiom ("one") are none.
    """
    taken = [*covered, *idioms(plain)]
    found: list[Number] = []
    candidates = [*factors(plain), *(n for n in numbers(plain) if n.form == "digits" or _is_figure(plain, n))]
    for number in sorted(candidates, key=lambda each: each.start - each.end):  # "one and a half" before "half"
        number = _cut(plain, number, taken)
        if not overlaps((number.start, number.end), taken):
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
    rating = _RATING.match(plain, number.end)
    if rating is not None and is_all_said(plain, number.start, rating.end()):
        return True
    if _UNIT_OF_ANOTHER_KIND.match(plain, number.end) is not None:
        return True
    return _SETS_A_LIMIT.search(plain, 0, number.start) is not None and _IS_GIVEN.match(plain, number.end) is None


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
    if number.form in ("words", "foreign"):
        return plain[number.start : number.end].lower() not in _IDIOMS or _OF_POWER.match(plain, number.end) is not None
    return number.form == "chinese" and _CHINESE_FIGURE.search(plain, number.start, number.end + 1) is not None

"""The quantity parser: the only source of figures. Every recogniser, offline or not, takes its numbers from here.

A figure is a number, a unit and what bounds it, in SI: "at most 200 mW" is 0.2 W, a ceiling. Counts and names
("8 users", "user 3", "5G", "20 MHz") are none. A bound that cannot be read ("below 10 ms", "at most a few watts") is
reported with the kind "other", as is a share for each user ("1 MB each"), so that nobody drops it unseen.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.language.comparators import Comparator, comparison
from wirelessagent.language.deferred import deferred
from wirelessagent.language.mentions import is_of_each
from wirelessagent.language.numerals import numbers
from wirelessagent.language.readings import GENERATION, Reading
from wirelessagent.language.readings import readings as read_numbers
from wirelessagent.language.text import NUMBERED_USERS, has_chinese, normalise
from wirelessagent.language.units import unit_of_another_time
from wirelessagent.language.word_tables import either

QuantityKind: TypeAlias = Literal["power", "rate", "ratio", "bare", "other"]

_NO_UNITS = (("users", "joins"), ("users", "articles"), ("users", "takes"), ("bounds", "at_least_behind"),
             ("bounds", "at_most_behind"))  # fmt: skip
# A bare number may be followed by these; any other word makes it a count of that word or an unknown unit.
_AFTER_BARE = deferred(
    r"\s*(?:$|[,;:!?。\uff0c\uff1b、)\]]|\.(?![0-9])|(?i:(?:please|for|each|per|max|min|with|at|but|then|now|thanks|to|in|"
    r"on|while|when|apiece|für|an|bei|mit|je|pro|aber|para|por|con|a|en|cada|pero|pour|avec|à|par|mais|chac\w+|"
    r"como)\b|(?:de\s+)?(?:probabilit|outage|wahrscheinlich)|"
    rf"{'|'.join(either('figures', *each) for each in _NO_UNITS)}))"
)
_NAMES = deferred(rf"(?i)(?:{either('figures', 'named', 'numbered')}|\bno\.|[#№])\s*$")
_USERS = deferred(rf"(?i){NUMBERED_USERS}")
_CHINESE_COUNTED = deferred(
    r"\s*(?:[千兆]?瓦时|[千兆毫微]?(?:赫|米|秒|焦)|个|号|名|位|路|台|人|用户|小时|分钟|点|月|日|年|公里|次|倍|度|成)"
)
_VARIABLE = deferred(r"\s+[A-Za-z]{1,3}_?[0-9]")  # "R6=700k R7=900k"
_FOREIGN_UNIT = deferred(r"\s?[A-Za-zμ][A-Za-zμ/]*")
_FOREIGN_APIECE = deferred(
    r"(?i)\s?(?!users?\b|ues?\b)[A-Za-zμ][A-Za-zμ/]*\s*(?:each\b|apiece\b|per\s+(?:user|person|head)\b|每)"
)
_RANGE = deferred(r"\s*(?:-|–|—|~|(?i:to\b|and\b|through\b|y\b|et\b|à\b|und\b|bis\b)|到|至)\s*$")
_OWN_NOUN = deferred(  # "each user's rate no lower than" bounds the rate, and wishes for none
    r"(?:用户|每人|人均|每个|每户|各|UE|终端|大家|的)的?(?P<noun>(?:下行|数据)?(?:速率|速度|网速|吞吐量?))(?:都|"
    r"也)?(?:要|得|必须|应|须)?$"
)
_AGAIN = deferred(
    rf"(?i)(?:\s*(?P<open>[(\uff08])\s*(?:(?:[=≈]|{either('figures', 'one', 'again')})[\s.]*)?|\s*[=≈]\s*|"
    rf"\s*[,\uff0c]?\s*(?:{either('figures', 'one', 'again')})(?![a-z])[\s.,\uff0c:]*)"
)
_CLOSED, _DIGITS = (
    deferred(r"(?i)\s*(?:$|[,.;:!?)\uff0c。；、)]|(?:at most|max|tops|and|or less|au plus)\b)"),
    deferred(r"[\d\s.,]+"),
)
_ROUNDED = 0.01
"""By how much a figure and the same in another unit may differ: 33 dBm are 1.995 W."""
_PRICE_BEFORE, _STEP_BEFORE = (
    deferred(rf"(?i)(?:{either('figures', 'one', name)})\s*$") for name in ("price_before", "step_before")
)
_PRICE_AFTER, _STEP_AFTER = (
    deferred(rf"(?i)\s*(?:{either('figures', 'one', name)})") for name in ("price_after", "step_after")
)


def amount_of_another_time(plain: str) -> tuple[int, int] | None:
    """The first amount of bits of a normalised text that is no rate, such as "300 Mbit an hour"; it needs an answer."""
    for number in numbers(plain):
        end = unit_of_another_time(plain, number.end)
        if end is not None:
            return number.start, end
    return None


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A figure in a sentence.

    Attributes:
        value: in SI units: W, bit/s, or a ratio to 1; may be zero, negative, or inf where it is beyond any figure.
        kind: power, rate, ratio, bare (no unit) or other (a bound that is not understood; its value is 0).
        text: the words of number and unit, as they stand at [start, end) of the sentence.
        comparator: at_least, at_most, exactly, or None.
        phrase_start, phrase_end: the span with the comparator and the noun between them.
        doubtful: the spelling leaves bits or bytes open.
    """

    value: float
    kind: QuantityKind
    text: str
    start: int
    end: int
    comparator: Comparator | None = None
    phrase_start: int
    phrase_end: int
    doubtful: bool = False


def parse_quantities(text: str) -> tuple[Quantity, ...]:
    """Every quantity of a sentence, from left to right, not overlapping.

    >>> [(q.kind, q.value, q.comparator) for q in parse_quantities("at least 1 Mbit/s each, at most 20 dBm")]
    [('rate', 1000000.0, 'at_least'), ('power', 0.1, 'at_most')]
    """
    plain = normalise(text)
    readings = read_numbers(plain)
    found: list[Quantity] = []
    after = 0
    for index, reading in enumerate(readings):
        following = readings[index + 1] if index + 1 < len(readings) else None
        if following is not None and following.unit is not None and _joined(plain, reading, following):
            continue  # the lower end of a range: read together with the upper one
        lower = readings[index - 1] if index and _joined(plain, readings[index - 1], reading) else None
        if lower is not None and reading.unit is not None:
            found.extend(_range(text, lower, reading))
        else:
            until = following.start if following is not None else len(plain)
            quantity = _bounded(text, plain, reading, after=after, until=until)
            if quantity is None:
                continue
            found.append(quantity)
        if found[-1].kind != "bare" or found[-1].comparator is not None:  # "neither 3 nor 4 below 1 Mbit/s"
            after = found[-1].phrase_end
    return tuple(_said_once(text, plain, found))


def _said_once(text: str, plain: str, found: Iterable[Quantity]) -> list[Quantity]:
    """A power and right behind it the same in another unit as one: "40 dBm, that is 10 W", "33 dBm (1.995 W)"."""
    once: list[Quantity] = []
    for each in found:
        first = once[-1] if once else each
        again = _AGAIN.fullmatch(plain, first.phrase_end, each.start)
        end = each.end + 1 if again and again["open"] else each.end
        closed = (
            _CLOSED.match(plain, max(end, each.phrase_end)) if plain[each.end : end] in ("", ")", "\uff09") else None
        )
        bounds = {first.comparator, each.comparator} - {None}
        units = {_DIGITS.sub("", figure.text) for figure in (first, each)}
        same = math.isclose(first.value, each.value, rel_tol=_ROUNDED) and {first.kind, each.kind} == {"power"}
        if again and closed and same and len(units) > 1 and len(bounds) < 2:
            each = dataclasses.replace(
                once.pop(), text=text[first.start : end], end=end, comparator=first.comparator or each.comparator,
                phrase_end=max(end, each.phrase_end),
            )  # fmt: skip
        once.append(each)
    return once


def _joined(plain: str, lower: Reading, upper: Reading) -> bool:
    """Whether two readings are the ends of one range, "1 to 2 Mbit/s"."""
    gap = plain[lower.end : upper.start]
    if lower.number.value is None or upper.number.value is None or _RANGE.match(gap) is None:
        return False
    if lower.unit is None and lower.factor == 1 and lower.number.value >= upper.number.value:
        return False  # "users 1 to 4 to 3 Mbit/s"
    if lower.unit is not None and (upper.unit is None or upper.unit.kind != lower.unit.kind):
        return False
    if re.fullmatch(r"\s*(?:and|y|et|und)\s*", gap.lower()) is None:
        return upper.unit is not None and not (lower.unit is None and _is_name(plain, lower.start))
    return re.search(r"(?i)(?:between|entre|zwischen)\s*$", plain[max(0, lower.start - 12) : lower.start]) is not None


def _range(text: str, lower: Reading, upper: Reading) -> list[Quantity]:
    assert upper.unit is not None
    assert lower.number.value is not None
    assert upper.number.value is not None
    low, high = (lower.unit or upper.unit).value(lower.number.value), upper.unit.value(upper.number.value)
    if lower.unit is None and lower.factor != 1:
        low = float(lower.number.value * lower.factor)  # "between 500k and 2M each"
    spans: tuple[tuple[Reading, float, Comparator], ...] = ((lower, low, "at_least"), (upper, high, "at_most"))
    return [
        Quantity(
            value=value, kind=upper.unit.kind, text=text[part.start : part.end], start=part.start, end=part.end,
            comparator=comparator, phrase_start=part.start, phrase_end=part.end, doubtful=upper.unit.doubtful,
        )
        for part, value, comparator in spans
    ]  # fmt: skip


def _bounded(text: str, plain: str, reading: Reading, *, after: int, until: int) -> Quantity | None:
    """The quantity of one reading; its words lie between ``after`` and ``until``."""
    number, unit = reading.number, reading.unit
    kind: QuantityKind = unit.kind if unit is not None and number.value is not None else "other"
    bounds = comparison(plain, reading.start, reading.end, kind=kind, after=after)
    if kind == "other" and number.value is not None:
        kind_or_none = _kind_without_unit(plain, reading, bounded=bounds.comparator is not None)
        if kind_or_none is None:
            return None
        kind = kind_or_none
    elif number.value is None and bounds.comparator is None and unit is None:
        return None
    if kind == "power" and number.value == 1 and bounds.comparator is None and _is_price(plain, reading):
        return None
    if number.value == 1 and number.form != "digits" and bounds.comparator is None and _is_step(plain, reading):
        return None
    article = plain[number.start : number.end].lower() in ("a", "an")
    if article and not (unit is not None and (bounds.comparator or unit.kind == "rate")):
        return None
    value = 0.0
    if number.value is not None and kind != "other":
        value = unit.value(number.value) if unit is not None else float(number.value * reading.factor)
    end = reading.end
    bounded_rate = bounds.comparator and kind == "rate"
    own = _OWN_NOUN.search(plain, max(0, bounds.start - 12), bounds.start) if bounded_rate else None
    foreign = _FOREIGN_UNIT.match(plain, end, until) if kind == "other" and unit is None else None
    if foreign is not None:
        end = foreign.end()
    return Quantity(
        value=value, kind=kind, text=text[reading.start : end], start=reading.start, end=end,
        comparator=bounds.comparator, phrase_start=max(after, own.start("noun")) if own else bounds.start,
        phrase_end=max(end, bounds.end), doubtful=unit is not None and unit.doubtful,
    )  # fmt: skip


def _is_price(plain: str, reading: Reading) -> bool:
    """Whether one watt is what bits are counted for: "the most out of one watt", 一瓦换多少比特."""
    before, after = plain[max(0, reading.start - 16) : reading.start], plain[reading.end : reading.end + 12]
    return _PRICE_BEFORE.search(before) is not None or _PRICE_AFTER.match(after) is not None


def _is_step(plain: str, reading: Reading) -> bool:
    """Whether one unit is the least step, not a figure: "not a watt more", "every megabit"."""
    before = _STEP_BEFORE.search(plain, max(0, reading.start - 12), reading.start)
    return before is not None or _STEP_AFTER.match(plain, reading.end) is not None


def _kind_without_unit(plain: str, reading: Reading, *, bounded: bool) -> QuantityKind | None:
    """A number without a known unit: bare, a bound that is not understood, or nothing (a count, a name)."""
    if reading.number.form != "digits" and not bounded:
        return None
    if reading.number.form == "chinese" or _CHINESE_COUNTED.match(plain, reading.end):
        return None
    glued = (
        GENERATION.match(plain, reading.start) is not None or plain[max(0, reading.start - 1) : reading.start] == "/"
    )
    if glued or plain[reading.end : reading.end + 1] == "/":
        return "other" if bounded else None
    if _is_name(plain, reading.start, bounded=bounded):
        return None
    if _AFTER_BARE.match(plain, reading.end) or has_chinese(plain[reading.end :].lstrip()[:1]):
        return "bare"
    if reading.factor != 1 and _VARIABLE.match(plain, reading.end):
        return "bare"
    apiece = _FOREIGN_APIECE.match(plain, reading.end) is not None
    return "other" if bounded or apiece else None


def _is_name(plain: str, start: int, *, bounded: bool = False) -> bool:
    """Whether a number names what stands before it: "user 3", "users 1 and 2", "slot 5"; not "at 2 or more"."""
    patterns = (_USERS,) if bounded else (_NAMES, _USERS)
    named = any(pattern.search(plain, max(0, start - 40), start) is not None for pattern in patterns)
    return named and not is_of_each(plain, start)

"""The quantity parser: the only source of figures. Every recogniser, offline or not, takes its numbers from here.

A figure is a number, a unit and what bounds it, in SI: "at most 200 mW" is 0.2 W, a ceiling. Counts and names
("8 users", "user 3", "5G", "20 MHz") are none. A bound that cannot be read ("below 10 ms", "at most a few watts") is
reported with the kind "other", as is a share for each user ("1 MB each"), so that nobody drops it unseen.

Numbers with the units that follow them are measures, before anybody asks what bounds them. Odds ("one miss in twenty")
are ratios like a percentage; whether of what fails or of what holds, the model of roles says. A reliability without a
percent sign is one where nothing else can be meant: so many nines, a number of nines alone ("…, 99.999") or a number
above fifty right beside a word for reliability.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal, TypeAlias

from wirelessagent.language.comparators import Comparator, comparison
from wirelessagent.language.mentions import is_of_each
from wirelessagent.language.number_words import cardinals, listed
from wirelessagent.language.numerals import Number, and_part, chinese_value, numbers
from wirelessagent.language.text import AND, NUMBERED_USERS, USER_NOUN, Phrases, has_chinese, normalise, overlaps
from wirelessagent.language.units import Unit, unit_at, unit_of_another_time
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

_SUFFIX = deferred(r"\s?(?P<suffix>[kKMG])(?![A-Za-z0-9]|/(?!\s?(?:users?|ue|person|head)\b))|m(?![A-Za-z0-9/])")
_CHINESE_SUFFIX = deferred(
    r"\s?(?P<suffix>[kKM])(?!\s*[A-Za-z0-9/瓦赫焦伏安米克])"
)  # "每人2M": so are rates written there
_WHO = f"(?:{any_word('figures', 'users', 'each')}|people|one)"
_APIECE_AFTER = deferred(  # what is given to each with a mere "k" or "M" is a rate
    rf"(?i)\s*(?:{any_word('figures', 'users', 'apiece')}|"
    rf"(?:(?:per|a|/)\s*|{any_word('figures', 'users', 'by')}\s+){_WHO})(?![\w-])"
)
_APIECE_BEFORE = deferred(
    rf"(?i)(?:{either('figures', 'users', 'given')})\s*(?:(?:{either('figures', 'users', 'gets')}|:)\s*)*$|"
    rf"\b{any_word('figures', 'bounds', 'sets')}\s+{USER_NOUN}\s*[0-9]{{1,3}}\s+"
    rf"{any_word('figures', 'bounds', 'sets_at')}?\s*$|\br_?(?:min|max)\s*(?:[:=]|of|is|≥|≤|<=|>=)?\s*$"
)
_PRICE = deferred(r"[€$£¥]\s?$")
_SUFFIXES = {"k": Decimal(10**3), "K": Decimal(10**3), "M": Decimal(10**6), "G": Decimal(10**9)}
GENERATION = deferred(r"[2-7]G(?![A-Za-z/])|[248]K(?![A-Za-z/])")
_PICTURE = deferred(r"[248]K")
_TRAILING_HALF = deferred(r"半(?!小时)")
_TRAILING_DIGIT = deferred(
    r"(?P<digit>[一二三四五六七八九])(?![零〇一二三四五六七八九十百千万亿点半个号户位人台家成兆瓦毫kKM])"
)
_FRACTION = deferred(r"(?P<below>[0-9]+|[一二三四五六七八九十百千万两]+)分之$")
_TENTHS = deferred(r"成(?P<more>[一二三四五六七八九半]{0,3})(?![员立为本交绩效长了就品]|功(?!率)|不变)")
_COUNTED = deferred(rf"(?i)\s+(?:of\s+(?:the|our|my)\s+)?(?:{USER_NOUN}|people|persons|personas|personnes|sensor\w*)\b")


# Odds, "one miss in twenty", 十次里有九次, and reliabilities, "five nines", 四个九.
_PARTS = {
    **{word: count for word, count in cardinals(1, 19).items() if count < 10 or count == 19},
    **{f"{word}mal": count for word, count in cardinals(2, 9, ("de",)).items()},
    **listed("part", "odds"),
}
_WHOLES = {
    **{word: count for word, count in cardinals(10, 100).items() if count in (10, 20, 50, 100)},
    **{word: scale for word, scale in listed("scales").items() if scale in (100, 1000)},
    **listed("whole", "odds"),
}
_ORDINALS = listed("ordinal", "odds")
_EVENT = f"{any_word('figures', 'odds', 'events')}s?"
_PART = rf"(?P<part>[0-9]{{1,3}}|{'|'.join(sorted(_PARTS, key=len, reverse=True))})"
_WHOLE = rf"(?P<whole>10|20|25|40|50|100|200|500|1[ .,']?000|{'|'.join(sorted(_WHOLES, key=len, reverse=True))})"
_NUMERAL = "[0-9一二两三四五六七八九十百千]+"
_ODDS = deferred(
    rf"(?i)(?<![\w.,]){_PART}(?:[\s-]+{_EVENT}[\s-]+of|(?:[\s-]+{_EVENT})?[\s-]+{any_word('figures', 'odds', 'among')})"
    rf"[\s-]+(?:every\s+|each\s+|je\s+)?{_WHOLE}(?![\w%]|[.,][0-9]|\s?(?:[kmM]?W|dB\w*|[kKMG]?bit\S*|[kMG]bps)\b)|"
    rf"\bjede[rsnm]?\s+(?P<ordinal>{'|'.join(_ORDINALS)})[nrsm]?\b|"
    rf"(?P<zhwhole>{_NUMERAL})(?P<unit>次|回)(?:里|中|之中|当中)?[^,，。;；0-9一二两三四五六七八九十百千]{{0,6}}(?P<zhpart>{_NUMERAL})(?P=unit)"
)

_HOW_MANY = cardinals(2, 7)
_LATIN = "|".join([*_HOW_MANY, "[2-7]"])
_RELIABLE = rf"(?:{any_word('figures', 'odds', 'reliable')}\w*|sicherheit)"
_LINK = rf"(?:\s+{any_word('figures', 'odds', 'reliable_at')})*\s*[:=]?\s*"
_PERCENT = r"(?P<{}>[5-9][0-9](?:[.,][0-9]{{1,6}})?)(?![0-9.,]*[0-9])"
_NINES = Phrases(
    rf"(?<![\w.,])(?P<count>{_LATIN})[\s-]+{any_word('figures', 'odds', 'nines')}(?![\w%])|"
    r"(?P<zh>[二两三四五六七2-7])\s?个\s?[九9](?![0-9一二三四五六七八九十百千万])|"
    r"(?:(?<=^)|(?<=[,;:\uff0c；、(。]\s)|(?<=[,;:\uff0c；、(。]))(?P<alone>99[.,]9{1,5})(?=\s*(?:$|[,;!?)\uff0c；。]|\.(?![0-9])))|"
    rf"\b{_RELIABLE}{_LINK}{_PERCENT.format('behind')}|(?<![\w.,]){_PERCENT.format('ahead')}\s+{_RELIABLE}|"
    rf"可靠[性度率]?(?:要?达?到|要|为|是|不低于|至少|>=|≥|=|:)?\s*{_PERCENT.format('zhbehind')}",
    marks=" ".join([*words_of("figures", "odds", "nines", "reliable"), "sicherheit 9 九 可靠"]),
)


@dataclass(frozen=True, kw_only=True)
class Measure:
    """A number with the unit that follows it; ``factor`` is that of a bare "k" or "M"."""

    number: Number
    unit: Unit | None
    start: int
    end: int
    factor: Decimal = Decimal(1)


def measures(plain: str) -> list[Measure]:
    """Every number of a normalised text with its unit, from left to right, not overlapping."""
    shares = (each for each in odds(plain) if _COUNTED.match(plain, each[2]) is None)
    found = [
        Measure(
            number=Number(value=value, start=start, end=end, form="words"),
            unit=Unit(kind="ratio", end=end), start=start, end=end,
        )
        for value, start, end in (*nines(plain), *shares)
    ]  # fmt: skip
    for number in numbers(plain):
        if not overlaps((number.start, number.end), [(each.start, each.end) for each in found]):
            found.append(_read(plain, number))
    return sorted(found, key=lambda measure: measure.start)


def _read(plain: str, number: Number) -> Measure:
    unit = unit_at(plain, number.end)
    if unit is not None:
        return _with_half(plain, number, unit)
    share = _share(plain, number)
    if share is not None:
        return share
    suffix = _SUFFIX.match(plain, number.end) if number.form == "digits" else None
    spoken = number.form == "chinese" and number.value is not None and number.end - number.start > 1
    written = (number.form == "digits" or spoken) and has_chinese(plain)
    chinese = _CHINESE_SUFFIX.match(plain, number.end) if written else None
    if chinese is not None and not _PICTURE.match(plain, number.start):
        unit = Unit(kind="rate", end=chinese.end(), factor=_SUFFIXES[chinese["suffix"]])
        return Measure(number=number, unit=unit, start=number.start, end=chinese.end())
    if suffix is not None and not GENERATION.match(plain, number.start):
        end, factor = suffix.end(), _SUFFIXES[suffix["suffix"] or "M"]
        if suffix["suffix"] != "G" and _is_apiece(plain, number.start, end):
            unit = Unit(kind="rate", end=end, factor=factor)
            return Measure(number=number, unit=unit, start=number.start, end=end)
        if suffix["suffix"]:
            return Measure(number=number, unit=None, start=number.start, end=end, factor=factor)
    return Measure(number=number, unit=None, start=number.start, end=number.end)


def _is_apiece(plain: str, start: int, end: int) -> bool:
    """Whether a number with a "k" or an "M" is said of each user: "500k each", "everyone gets at least 2M"."""
    each = _APIECE_AFTER.match(plain, end) or _APIECE_BEFORE.search(plain, max(0, start - 60), start)
    return each is not None and _PRICE.search(plain, 0, start) is None


def _with_half(plain: str, number: Number, unit: Unit) -> Measure:
    """A figure with what is said behind its unit: 两兆半, 一兆五, "dos megas y medio"."""
    end, value = unit.end, number.value
    if value is not None and unit.level_dbm is None and value == int(value):
        half, digit = _TRAILING_HALF.match(plain, end), _TRAILING_DIGIT.match(plain, end)
        part = and_part(plain, end)
        if half is not None:
            value, end = value + Decimal("0.5"), half.end()
        elif part is not None and unit_at(plain, part[1]) is None:
            value, end = value + part[0], part[1]
        elif digit is not None and number.form == "chinese":
            value, end = value + Decimal(chinese_value(digit["digit"]) or 0) / 10, digit.end()
    number = dataclasses.replace(number, value=value)
    return Measure(number=number, unit=unit, start=number.start, end=end)


def _share(plain: str, number: Number) -> Measure | None:
    """A share as Chinese says it: 百分之五, 千分之一, 九成五."""
    if number.value is None:
        return None
    start, end, value = number.start, number.end, number.value
    over = _FRACTION.search(plain, max(0, start - 8), start)
    tenths = _TENTHS.match(plain, end)
    if over is not None:
        below = Decimal(over["below"]) if over["below"].isdigit() else chinese_value(over["below"])
        if not below:
            return None
        start, value = over.start(), value / below
    elif tenths is not None and 0 < value < 10:
        more = "".join("5" if letter == "半" else str(chinese_value(letter)) for letter in tenths["more"])
        end, value = tenths.end(), Decimal(f"{value}{'' if value != int(value) else '.'}{more or 0}") / 10
    else:
        return None
    number = dataclasses.replace(number, value=value)
    return Measure(number=number, unit=Unit(kind="ratio", end=end), start=start, end=end)


def odds(plain: str) -> Iterator[tuple[Decimal, int, int]]:
    """The odds of a normalised text as ratios, and where they stand.

    >>> [value for value, *_ in odds("one miss in twenty is fine")]
    [Decimal('0.05')]
    """
    for match in _ODDS.finditer(plain):
        part = _counted(match["part"] or match["zhpart"] or "1", _PARTS)
        whole = _counted(match["whole"] or match["zhwhole"] or match["ordinal"], {**_WHOLES, **_ORDINALS})
        if 0 < part < whole:
            yield part / whole, *match.span()


def _counted(word: str, words: Mapping[str, int | Decimal]) -> Decimal:
    digits = re.sub(r"[ .,']", "", word)
    return Decimal(
        digits if digits.isdigit() else words.get(" ".join(word.lower().split())) or chinese_value(word) or 0
    )


def nines(plain: str) -> Iterator[tuple[Decimal, int, int]]:
    """The reliabilities of a normalised text that are no percentages, as ratios, and where they stand.

    >>> [float(value) for text in ("five nines", "reliability 99.9", "四个九") for value, *_ in nines(text)]
    [0.99999, 0.999, 0.9999]
    """
    for match in _NINES.finditer(plain):
        group = match.lastgroup or ""
        counted = group in ("count", "zh")
        start, end = match.span() if counted else match.span(group)
        if unit_at(plain, end) is not None:
            continue
        if counted:
            yield 1 - Decimal(10) ** -int(_counted(match[group], _HOW_MANY)), start, end
        else:
            yield Decimal(match[group].replace(",", ".")) / 100, start, end


QuantityKind: TypeAlias = Literal["power", "rate", "ratio", "bare", "other"]

_NO_UNITS = (("users", "joins"), ("users", "articles"), ("users", "takes"), ("bounds", "at_least_behind"),
             ("bounds", "at_most_behind"))  # fmt: skip
# A bare number may be followed by these; any other word makes it a count of that word or an unknown unit.
_AFTER_BARE = deferred(
    rf"\s*(?:$|[,;:!?。\uff0c\uff1b、)\]]|\.(?![0-9])|(?i:(?:{any_word('figures', 'bounds', 'bare_behind')}|chac\w+)\b|"
    r"(?:de\s+)?(?:probabilit|outage|wahrscheinlich)|"
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
_RANGE = deferred(rf"\s*(?:-|–|—|~|(?i:(?:to|through|à|bis|{AND})\b)|到|至)\s*$")
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
    read = measures(plain)
    found: list[Quantity] = []
    after = 0
    for index, measure in enumerate(read):
        following = read[index + 1] if index + 1 < len(read) else None
        if following is not None and following.unit is not None and _joined(plain, measure, following):
            continue  # the lower end of a range: read together with the upper one
        lower = read[index - 1] if index and _joined(plain, read[index - 1], measure) else None
        if lower is not None and measure.unit is not None:
            found.extend(_range(text, lower, measure))
        else:
            until = following.start if following is not None else len(plain)
            quantity = _bounded(text, plain, measure, after=after, until=until)
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


def _joined(plain: str, lower: Measure, upper: Measure) -> bool:
    """Whether two measures are the ends of one range, "1 to 2 Mbit/s"."""
    gap = plain[lower.end : upper.start]
    if lower.number.value is None or upper.number.value is None or _RANGE.match(gap) is None:
        return False
    if lower.unit is None and lower.factor == 1 and lower.number.value >= upper.number.value:
        return False  # "users 1 to 4 to 3 Mbit/s"
    if lower.unit is not None and (upper.unit is None or upper.unit.kind != lower.unit.kind):
        return False
    if re.fullmatch(rf"\s*{AND}\s*", gap.lower()) is None:
        return upper.unit is not None and not (lower.unit is None and _is_name(plain, lower.start))
    return re.search(r"(?i)(?:between|entre|zwischen)\s*$", plain[max(0, lower.start - 12) : lower.start]) is not None


def _range(text: str, lower: Measure, upper: Measure) -> list[Quantity]:
    assert upper.unit is not None
    assert lower.number.value is not None
    assert upper.number.value is not None
    low, high = (lower.unit or upper.unit).value(lower.number.value), upper.unit.value(upper.number.value)
    if lower.unit is None and lower.factor != 1:
        low = float(lower.number.value * lower.factor)  # "between 500k and 2M each"
    spans: tuple[tuple[Measure, float, Comparator], ...] = ((lower, low, "at_least"), (upper, high, "at_most"))
    return [
        Quantity(
            value=value, kind=upper.unit.kind, text=text[part.start : part.end], start=part.start, end=part.end,
            comparator=comparator, phrase_start=part.start, phrase_end=part.end, doubtful=upper.unit.doubtful,
        )
        for part, value, comparator in spans
    ]  # fmt: skip


def _bounded(text: str, plain: str, measure: Measure, *, after: int, until: int) -> Quantity | None:
    """The quantity of one measure; its words lie between ``after`` and ``until``."""
    number, unit = measure.number, measure.unit
    kind: QuantityKind = unit.kind if unit is not None and number.value is not None else "other"
    bounds = comparison(plain, measure.start, measure.end, kind=kind, after=after)
    if kind == "other" and number.value is not None:
        kind_or_none = _kind_without_unit(plain, measure, bounded=bounds.comparator is not None)
        if kind_or_none is None:
            return None
        kind = kind_or_none
    elif number.value is None and bounds.comparator is None and unit is None:
        return None
    if kind == "power" and number.value == 1 and bounds.comparator is None and _is_price(plain, measure):
        return None
    if number.value == 1 and number.form != "digits" and bounds.comparator is None and _is_step(plain, measure):
        return None
    article = plain[number.start : number.end].lower() in ("a", "an")
    if article and not (unit is not None and (bounds.comparator or unit.kind == "rate")):
        return None
    value = 0.0
    if number.value is not None and kind != "other":
        value = unit.value(number.value) if unit is not None else float(number.value * measure.factor)
    end = measure.end
    bounded_rate = bounds.comparator and kind == "rate"
    own = _OWN_NOUN.search(plain, max(0, bounds.start - 12), bounds.start) if bounded_rate else None
    foreign = _FOREIGN_UNIT.match(plain, end, until) if kind == "other" and unit is None else None
    if foreign is not None:
        end = foreign.end()
    return Quantity(
        value=value, kind=kind, text=text[measure.start : end], start=measure.start, end=end,
        comparator=bounds.comparator, phrase_start=max(after, own.start("noun")) if own else bounds.start,
        phrase_end=max(end, bounds.end), doubtful=unit is not None and unit.doubtful,
    )  # fmt: skip


def _is_price(plain: str, measure: Measure) -> bool:
    """Whether one watt is what bits are counted for: "the most out of one watt", 一瓦换多少比特."""
    before, after = plain[max(0, measure.start - 16) : measure.start], plain[measure.end : measure.end + 12]
    return _PRICE_BEFORE.search(before) is not None or _PRICE_AFTER.match(after) is not None


def _is_step(plain: str, measure: Measure) -> bool:
    """Whether one unit is the least step, not a figure: "not a watt more", "every megabit"."""
    before = _STEP_BEFORE.search(plain, max(0, measure.start - 12), measure.start)
    return before is not None or _STEP_AFTER.match(plain, measure.end) is not None


def _kind_without_unit(plain: str, measure: Measure, *, bounded: bool) -> QuantityKind | None:
    """A number without a known unit: bare, a bound that is not understood, or nothing (a count, a name)."""
    if measure.number.form != "digits" and not bounded:
        return None
    if measure.number.form == "chinese" or _CHINESE_COUNTED.match(plain, measure.end):
        return None
    glued = (
        GENERATION.match(plain, measure.start) is not None or plain[max(0, measure.start - 1) : measure.start] == "/"
    )
    if glued or plain[measure.end : measure.end + 1] == "/":
        return "other" if bounded else None
    if _is_name(plain, measure.start, bounded=bounded):
        return None
    if _AFTER_BARE.match(plain, measure.end) or has_chinese(plain[measure.end :].lstrip()[:1]):
        return "bare"
    if measure.factor != 1 and _VARIABLE.match(plain, measure.end):
        return "bare"
    apiece = _FOREIGN_APIECE.match(plain, measure.end) is not None
    return "other" if bounded or apiece else None


def _is_name(plain: str, start: int, *, bounded: bool = False) -> bool:
    """Whether a number names what stands before it: "user 3", "users 1 and 2", "slot 5"; not "at 2 or more"."""
    patterns = (_USERS,) if bounded else (_NAMES, _USERS)
    named = any(pattern.search(plain, max(0, start - 40), start) is not None for pattern in patterns)
    return named and not is_of_each(plain, start)

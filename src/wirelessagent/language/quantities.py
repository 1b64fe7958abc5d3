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
import functools
import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal, TypeAlias

from wirelessagent.language.comparators import Comparator, comparison
from wirelessagent.language.mentions import GIVEN_TO, is_of_each
from wirelessagent.language.number_words import cardinals, listed
from wirelessagent.language.numerals import NUMBERED, Number, and_part, chinese_value, numbers
from wirelessagent.language.text import AND, USER_NOUN, Phrases, Span, has_chinese, normalise, overlaps
from wirelessagent.language.units import Unit, unit_at, unit_of_another_time
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

_SUFFIX = deferred(r"\s?(?P<suffix>[kKMG])(?![A-Za-z0-9]|/(?!\s?(?:users?|ue|person|head)\b))|m(?![A-Za-z0-9/])")
_CHINESE_SUFFIX = deferred(r"\s?(?P<suffix>[kKM])(?!\s*[A-Za-z0-9/瓦赫焦伏安米克])")  # "每人2M": so are rates written
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
_GENERATION = deferred(r"[2-7]G(?![A-Za-z/])|[248]K(?![A-Za-z/])")
_TRAILING_HALF = deferred(r"半(?!小时)")
_TRAILING_DIGIT = deferred(
    r"(?P<digit>[一二三四五六七八九])(?![零〇一二三四五六七八九十百千万亿点半个号户位人台家成兆瓦毫kKM])"
)
_FRACTION = deferred(r"(?P<below>[0-9]+|[一二三四五六七八九十百千万两]+)分之$")
_TENTHS = deferred(r"成(?:(?P<more>[一二三四五六七八九半]{1,3})|(?![员立为本交绩效长了就品]|功(?!率)|不变))")
_NOTHING_COUNTED = deferred(r"(?i)\s*(?:$|[,.;:!?)])|\s+(?:par|pou?r|para|por|cada|chaque|chacune?|de|à|a|au|al)\b")
_COUNTED = deferred(rf"(?i)\s+(?:of\s+(?:the|our|my)\s+)?(?:{USER_NOUN}|people|persons|personas|personnes|sensor\w*)\b")


# Odds, "one miss in twenty", 十次里有九次, and reliabilities, "five nines", 四个九.
_ONCE = {**listed("once", "odds"), **{f"{word}mal": count for word, count in cardinals(2, 9, ("de",)).items()}}
_A_SINGLE = listed("part", "odds")
_ORDINALS = listed("ordinal", "odds")
_EVENT, _AMONG = f"{any_word('figures', 'odds', 'events')}s?", any_word("figures", "odds", "among")
_AMONG_AHEAD = deferred(
    rf"(?i)[\s-]+(?:(?P<event>{_EVENT})[\s-]+(?:of|{_AMONG})|{_AMONG})[\s-]+(?:(?:every|each|je|an?)\s+)?$"
)
_PART_AHEAD = deferred(rf"(?i)(?<![\w.,-])(?:{'|'.join(sorted({**_ONCE, **_A_SINGLE}, key=len, reverse=True))})$")
_ROUND, _FEWEST, _NEAR = (10, 20, 25, 40, 50, 100, 200, 500, 1000), 10, 40
"""Of how many parts a share is said by no more than a word for "of", and of how many at least by what happens; how
far the words for that reach."""
_NUMERAL = "[0-9一二两三四五六七八九十百千]+"
_ODDS = deferred(
    rf"(?i)\bjede[rsnm]?\s+(?P<ordinal>{'|'.join(_ORDINALS)})[nrsm]?\b|"
    rf"(?P<zhwhole>{_NUMERAL})(?P<unit>次|回|[个条项](?=承诺|保证|保障))(?:里|中|之中|当中)?[^,，。;；0-9一二两三四五六七八九十百千]{{0,6}}(?P<zhpart>{_NUMERAL})(?P=unit)"
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

    @property
    def value(self) -> float:
        """In SI units; zero where the number is not understood."""
        number = self.number.value or Decimal(0)
        return self.unit.value(number) if self.unit is not None else float(number * self.factor)


@functools.lru_cache(maxsize=16)
def measures(plain: str) -> tuple[Measure, ...]:
    """Every number of a normalised text with its unit, from left to right, not overlapping.

    >>> [float(each.number.value) for each in measures("one miss in twenty, five nines, 四个九")]
    [0.05, 0.99999, 0.9999]
    """
    found = [*_nines(plain), *_odds(plain)]
    for number in numbers(plain):
        if not overlaps((number.start, number.end), [(each.start, each.end) for each in found]):
            found.append(_read(plain, number))
    return tuple(sorted(found, key=lambda measure: measure.start))


def _read(plain: str, number: Number) -> Measure:
    unit, share = unit_at(plain, number.end), _share(plain, number)
    if unit is not None and share is not None:  # 四分之一瓦
        return Measure(number=share.number, unit=unit, start=share.start, end=unit.end)
    if unit is not None:
        return _with_half(plain, number, unit)
    if share is not None:
        return share
    if _GENERATION.match(plain, number.start):
        return Measure(number=number, unit=None, start=number.start, end=number.end)
    unit, end, factor = None, number.end, Decimal(1)
    suffix = _SUFFIX.match(plain, end) if number.form == "digits" else None
    spoken = number.form == "chinese" and number.value is not None and end - number.start > 1
    written = (number.form == "digits" or spoken) and has_chinese(plain)
    chinese = _CHINESE_SUFFIX.match(plain, end) if written else None
    if chinese is not None:
        end = chinese.end()
        unit = Unit(kind="rate", end=end, factor=_SUFFIXES[chinese["suffix"]])
    elif suffix is not None:
        scale = _SUFFIXES[suffix["suffix"] or "M"]
        if suffix["suffix"] != "G" and _is_apiece(plain, number.start, suffix.end()):
            end = suffix.end()
            unit = Unit(kind="rate", end=end, factor=scale)
        elif suffix["suffix"]:
            end, factor = suffix.end(), scale
    return Measure(number=number, unit=unit, start=number.start, end=end, factor=factor)


def _is_apiece(plain: str, start: int, end: int) -> bool:
    """Whether a number with a "k" or an "M" is said of each user: "500k each", "everyone gets at least 2M"."""
    each = _APIECE_AFTER.match(plain, end) or _APIECE_BEFORE.search(plain, max(0, start - 60), start)
    return each is not None and _PRICE.search(plain, 0, start) is None


def _with_half(plain: str, number: Number, unit: Unit) -> Measure:
    """A figure with what is said behind its unit: 两兆半, 一兆五, "dos megas y medio", "un méga huit"."""
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
        elif number.form != "digits" and value < 10 and unit.kind == "rate":
            tenths = next((each for each in numbers(plain) if plain[end : each.start] == " "), None)
            if tenths is not None and tenths.value is not None and _is_tenths(plain, tenths):
                value, end = value + tenths.value / 10, tenths.end
    return Measure(number=dataclasses.replace(number, value=value), unit=unit, start=number.start, end=end)


_GIVEN = deferred(rf"(?i)\s*(?:{GIVEN_TO}\s*)+")


def _is_tenths(plain: str, number: Number) -> bool:
    """Whether a number behind a unit says its tenths, as French and Spanish do, and nothing of its own.

    Where several units have a number behind, somebody has to stand beside one of them: "un méga quatre au deux".
    """
    if number.form != "foreign" or number.value not in range(1, 10) or language_of(plain) not in ("es", "fr"):
        return False
    found = numbers(plain)
    ends = [unit.end if (unit := unit_at(plain, each.end)) is not None else len(plain) for each in found]
    rows = [place for place in range(1, len(found)) if plain[ends[place - 1] : found[place].start] == " "]

    def leads_on(place: int) -> bool:  # to somebody
        given = _GIVEN.match(plain, found[place].end)
        return given is not None and any(each.start == given.end() for each in found[place + 1 : place + 2])

    ahead = (place > 1 and plain[found[place - 2].end : found[place - 1].start].isspace() for place in rows)
    alone = leads_on(found.index(number)) or _NOTHING_COUNTED.match(plain, number.end) is not None
    return alone and (len(rows) == 1 or any(ahead) or any(map(leads_on, rows)))


def _share(plain: str, number: Number) -> Measure | None:
    """A share as Chinese says it: 百分之五, 千分之一, 九成五."""
    if number.value is None:
        return None
    start, end, value = number.start, number.end, number.value
    over = _FRACTION.search(plain, max(0, start - 8), start)
    tenths = _TENTHS.match(plain, end)
    if over is not None:
        below = _counted(over["below"], {})
        if not below:
            return None
        return _ratio(value / below, over.start(), end, form=number.form)
    if tenths is not None and 0 < value < 10:
        more = "".join("5" if letter == "半" else str(chinese_value(letter)) for letter in tenths["more"] or "")
        return _ratio((value + Decimal(f"0.{more or 0}")) / 10, start, tenths.end(), form=number.form)
    return None


def _ratio(value: Decimal, start: int, end: int, form: str = "words") -> Measure:
    number, unit = Number(value=value, start=start, end=end, form=form), Unit(kind="ratio", end=end)
    return Measure(number=number, unit=unit, start=start, end=end)


def _odds(plain: str) -> Iterator[Measure]:
    """The odds of a normalised text as ratios, "one miss in twenty", but for counts of users."""
    for match in _ODDS.finditer(plain):
        part, whole = (_counted(match[name] or "1", {}) for name in ("zhpart", "zhwhole"))
        yield from _in_all(plain, part, Decimal(_ORDINALS.get((match["ordinal"] or "").lower(), whole)), match.span())
    found = list(numbers(plain))
    for whole in found:
        ahead = _AMONG_AHEAD.search(plain, max(0, whole.start - _NEAR), whole.start)
        if ahead is None or whole.value is None or unit_at(plain, whole.end) is not None:
            continue
        word = _PART_AHEAD.search(plain, max(0, ahead.start() - _NEAR), ahead.start())
        part = next((each for each in found if each.end == ahead.start()), None)
        if part is None and word is not None:
            count = Decimal(_ONCE.get(word[0].lower(), 1))
            part = Number(value=count, start=word.start(), end=word.end(), form="words")
        if part is not None and NUMBERED.search(plain, 0, part.start):  # "usuario 8 entre 200 y 900 kbit/s"
            continue
        if part is not None and (whole.value >= _FEWEST if ahead["event"] else whole.value in _ROUND):
            yield from _in_all(plain, part.value, whole.value, (part.start, whole.end))


def _in_all(plain: str, part: Decimal | None, whole: Decimal, span: Span) -> Iterator[Measure]:
    """What a part is of a whole, where that is no count of users."""
    if part is not None and 0 < part < whole and _COUNTED.match(plain, span[1]) is None:
        yield _ratio(part / whole, *span)


def _counted(word: str, words: Mapping[str, int | Decimal]) -> Decimal:
    digits = re.sub(r"[ .,']", "", word)
    return Decimal(
        digits if digits.isdigit() else words.get(" ".join(word.lower().split())) or chinese_value(word) or 0
    )


def _nines(plain: str) -> Iterator[Measure]:
    """The reliabilities of a normalised text that are no percentages, as ratios: "five nines", "reliability 99.9"."""
    for match in _NINES.finditer(plain):
        group = match.lastgroup or ""
        if group in ("count", "zh"):
            start, end = match.span()
            value = 1 - Decimal(10) ** -int(_counted(match[group], _HOW_MANY))
        else:
            start, end = match.span(group)
            value = Decimal(match[group].replace(",", ".")) / 100
        if unit_at(plain, end) is None:
            yield _ratio(value, start, end)


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
_CHINESE_COUNTED = deferred(
    r"\s*(?:[千兆]?瓦时|[千兆毫微]?(?:赫|米|秒|焦)|个|号|名|位|路|台|人|用户|小时|分钟|点|月|日|年|公里|次|倍|度|成)"
)
_FOREIGN_UNIT = deferred(r"\s?[A-Za-zμ][A-Za-zμ/]*")
_FOREIGN_APIECE_AFTER = deferred(
    r"(?i)\s?(?!users?\b|ues?\b)[A-Za-zμ][A-Za-zμ/]*\s*(?:each\b|apiece\b|per\s+(?:user|person|head)\b|每)"
)
_RANGE = deferred(rf"\s*(?:-|–|—|~|(?i:(?:to|through|à|bis|{AND})\b)|到|至)\s*$")
_NOR = deferred(rf"(?i)[^.;:]*?(?:{either('figures', 'bounds', 'nor')})[^,.;:]*")
_SOMEBODY = deferred(rf"(?i)\b{any_word('figures', 'users', 'single')}\s+$")
_AGAIN = deferred(
    rf"(?i)(?:\s*[(\uff08]\s*(?:(?:[=≈]|{either('figures', 'one', 'again')})[\s.]*)?|\s*[=≈]\s*|"
    rf"\s*[,\uff0c]?\s*(?:{either('figures', 'one', 'again')})(?![a-z])[\s.,\uff0c:]*)"
)
_CLOSED = deferred(r"(?i)\s*(?:$|[,.;:!?)\uff0c。；、)]|(?:at most|max|tops|and|or less|au plus)\b)")
_DIGITS = deferred(r"[\d\s.,]+")
_ROUNDED = 0.01
"""By how much a figure and the same in another unit may differ: 33 dBm are 1.995 W."""
_ONE = {  # what makes one of a unit a price or the least step, by what stands before and behind
    name: (
        deferred(rf"(?i)(?:{either('figures', 'one', f'{name}_before')})\s*$"),
        deferred(rf"(?i)\s*(?:{either('figures', 'one', f'{name}_after')})"),
    )
    for name in ("price", "step")
}


def amount_of_another_time(plain: str) -> tuple[int, int] | None:
    """The first amount of bits of a normalised text that is no rate, such as "300 Mbit an hour"; it needs an answer."""
    ends = ((number.start, unit_of_another_time(plain, number.end)) for number in numbers(plain))
    return next(((start, end) for start, end in ends if end is not None), None)


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
    ranges = {upper.start: lower for lower, upper in itertools.pairwise(read) if _joined(plain, lower, upper)}
    found: list[Quantity] = []
    after = 0
    for measure, until in zip(read, [*(each.start for each in read[1:]), len(plain)], strict=False):
        if measure in ranges.values():
            continue  # the lower end of a range: read together with the upper one
        if measure.start in ranges:
            found.extend(_range(text, ranges[measure.start], measure))
        elif (quantity := _bounded(text, plain, measure, after=after, until=until)) is not None:
            found.append(_as_denied(plain, found, quantity))
        else:
            continue
        if found[-1].kind != "bare" or found[-1].comparator is not None:  # "neither 3 nor 4 below 1 Mbit/s"
            after = found[-1].phrase_end
    return tuple(_said_once(text, plain, found))


def _as_denied(plain: str, found: Sequence[Quantity], figure: Quantity) -> Quantity:
    """A figure bounded as the one before where one verb denies both: "no user above 4 Mbit/s nor the power 13 W"."""
    nor = _NOR.fullmatch(plain, found[-1].phrase_end, figure.start) if found and figure.comparator is None else None
    return dataclasses.replace(figure, comparator=found[-1].comparator) if nor else figure


def _said_once(text: str, plain: str, found: Iterable[Quantity]) -> list[Quantity]:
    """A power and right behind it the same in another unit as one: "40 dBm, that is 10 W", "33 dBm (1.995 W)"."""
    once: list[Quantity] = []
    for each in found:
        first = once[-1] if once else each
        again = _AGAIN.fullmatch(plain, first.phrase_end, each.start)
        same = math.isclose(first.value, each.value, rel_tol=_ROUNDED) and {first.kind, each.kind} == {"power"}
        units = {_DIGITS.sub("", figure.text) for figure in (first, each)}
        if again and same and len(units) > 1 and _CLOSED.match(plain, each.phrase_end):
            each = dataclasses.replace(
                once.pop(), text=text[first.start : each.end], end=each.end,
                comparator=first.comparator or each.comparator, phrase_end=each.phrase_end,
            )  # fmt: skip
        once.append(each)
    return once


def _joined(plain: str, lower: Measure, upper: Measure) -> bool:
    """Whether two measures are the ends of one range, "1 to 2 Mbit/s"."""
    gap = plain[lower.end : upper.start]
    if lower.number.value is None or upper.number.value is None or upper.unit is None or _RANGE.match(gap) is None:
        return False
    bare = lower.unit is None and lower.factor == 1
    if bare and (lower.number.value >= upper.number.value or _SOMEBODY.search(plain, 0, lower.start)):
        return False  # "users 1 to 4 to 3 Mbit/s", "le 2 à 3 Mbit/s"
    if lower.unit is not None and upper.unit.kind != lower.unit.kind:
        return False
    if re.fullmatch(rf"\s*{AND}\s*", gap.lower()) is None:
        return lower.unit is not None or not _is_name(plain, lower.start)
    return re.search(r"(?i)(?:between|entre|zwischen)\s*$", plain[max(0, lower.start - 12) : lower.start]) is not None


def _range(text: str, lower: Measure, upper: Measure) -> list[Quantity]:
    assert upper.unit is not None
    if lower.unit is None and lower.factor == 1:  # not "between 500k and 2M each"
        lower = dataclasses.replace(lower, unit=upper.unit)
    bounds: tuple[tuple[Measure, Comparator], ...] = ((lower, "at_least"), (upper, "at_most"))
    return [
        Quantity(
            value=part.value, kind=upper.unit.kind, text=text[part.start : part.end], start=part.start, end=part.end,
            comparator=comparator, phrase_start=part.start, phrase_end=part.end, doubtful=upper.unit.doubtful,
        )
        for part, comparator in bounds
    ]  # fmt: skip


def _bounded(text: str, plain: str, measure: Measure, *, after: int, until: int) -> Quantity | None:
    """The quantity of one measure; its words lie between ``after`` and ``until``."""
    number, unit = measure.number, measure.unit
    kind: QuantityKind | None = unit.kind if unit is not None and number.value is not None else None
    bounds = comparison(plain, measure.start, measure.end, kind=kind or "other", after=after)
    kind = kind or _kind_not_understood(plain, measure, bounded=bounds.comparator is not None)
    if kind is None or (bounds.comparator is None and _is_no_figure(plain, measure, kind)):
        return None
    word = plain[number.start : number.end].lower()
    if word in ("a", "an") and bounds.comparator is None and kind != "rate":
        return None
    foreign = _FOREIGN_UNIT.match(plain, measure.end, until) if kind == "other" and unit is None else None
    end = measure.end if foreign is None else foreign.end()
    return Quantity(
        value=measure.value if kind != "other" else 0.0, kind=kind, text=text[measure.start : end],
        start=measure.start, end=end,
        comparator=bounds.comparator, phrase_start=bounds.start, phrase_end=max(end, bounds.end),
        doubtful=unit is not None and unit.doubtful,
    )  # fmt: skip


def _is_no_figure(plain: str, measure: Measure, kind: QuantityKind) -> bool:
    """Whether one watt is what bits are counted for, "the most out of one watt", 一瓦换多少比特; or one unit in words
    the least step, "not a watt more", "every megabit".
    """
    able = {"price": kind == "power", "step": measure.number.form != "digits"}
    return measure.number.value == 1 and any(
        before.search(plain, max(0, measure.start - 16), measure.start) or behind.match(plain, measure.end)
        for name, (before, behind) in _ONE.items()
        if able[name]
    )


def _kind_not_understood(plain: str, measure: Measure, *, bounded: bool) -> QuantityKind | None:
    """Without a known value or unit: bare, a bound that is not understood, or nothing (a count, a name)."""
    if measure.number.value is None:
        return "other" if bounded or measure.unit is not None else None
    if measure.number.form != "digits" and not bounded:
        return None
    if measure.number.form == "chinese" or _CHINESE_COUNTED.match(plain, measure.end):
        return None
    if _GENERATION.match(plain, measure.start) or "/" in (plain[measure.end :][:1], plain[: measure.start][-1:]):
        return "other" if bounded else None
    if _is_name(plain, measure.start, bounded=bounded):
        return None
    if _AFTER_BARE.match(plain, measure.end) or has_chinese(plain[measure.end :].lstrip()[:1]):
        return "bare"
    return "other" if bounded or _FOREIGN_APIECE_AFTER.match(plain, measure.end) else None


def _is_name(plain: str, start: int, *, bounded: bool = False) -> bool:
    """Whether a number names what stands before it: "user 3", "users 1 and 2", "slot 5"; not "at 2 or more"."""
    patterns = (NUMBERED,) if bounded else (_NAMES, NUMBERED)
    named = any(pattern.search(plain, max(0, start - 40), start) is not None for pattern in patterns)
    return named and not is_of_each(plain, start)

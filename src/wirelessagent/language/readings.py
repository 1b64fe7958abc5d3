"""Numbers with the units that follow them, shares and odds included, before anybody asks what bounds them.

Odds ("one miss in twenty") are ratios like a percentage; whether of what fails or of what holds, the model of roles
says. A reliability without a percent sign is one where nothing else can be meant: so many nines, a number of nines
alone ("…, 99.999") or a number above fifty right beside a word for reliability.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal

from wirelessagent.language.deferred import deferred
from wirelessagent.language.number_words import cardinals, listed
from wirelessagent.language.numerals import Number, and_part, chinese_value, numbers
from wirelessagent.language.text import USER_NOUN, Phrases, has_chinese, overlaps
from wirelessagent.language.units import Unit, unit_at
from wirelessagent.language.word_tables import either, words_of

_SUFFIX = deferred(r"\s?(?P<suffix>[kKMG])(?![A-Za-z0-9]|/(?!\s?(?:users?|ue|person|head)\b))|m(?![A-Za-z0-9/])")
_CHINESE_SUFFIX = deferred(
    r"\s?(?P<suffix>[kKM])(?!\s*[A-Za-z0-9/瓦赫焦伏安米克])"
)  # "每人2M": so are rates written there
_WHO = f"(?:{'|'.join(words_of('figures', 'users', 'each'))}|people|one)"
_APIECE_AFTER = deferred(  # what is given to each with a mere "k" or "M" is a rate
    rf"(?i)\s*(?:each|apiece|a\s+(?:head|piece)|(?:for|to)\s+(?:everyone|everybody|all|each|every)|(?:per|a|/)\s*{_WHO}|"
    rf"para\s+(?:todos|cada)|cada\s+uno|por\s+{_WHO}|pour\s+(?:tous|chacun|chaque|tout\s+le\s+monde)|chacun|par\s+{_WHO}|"
    rf"für\s+(?:alle|jeden?)|(?:pro|je)\s+{_WHO})(?![\w-])"
)
_APIECE_BEFORE = deferred(
    rf"(?i)(?:{either('figures', 'users', 'given')})\s*(?:(?:{either('figures', 'users', 'gets')}|:)\s*)*$|"
    rf"\b(?:cap|limit|throttle|hold|keep|give|grant|guarantee|promise)\s+{USER_NOUN}\s*[0-9]{{1,3}}\s+(?:at|to|below|under|"
    r"above|over|a|at\s+least|at\s+most)?\s*$|\br_?(?:min|max)\s*(?:[:=]|of|is|≥|≤|<=|>=)?\s*$"
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
    **dict.fromkeys(("once", "a single", "un", "une", "una", "ein", "eine", "einen", "einer", "einmal"), 1),
    "twice": 2,
    "dix-neuf": 19,
}
_WHOLES = {
    **{word: count for word, count in cardinals(10, 100).items() if count in (10, 20, 50, 100)},
    **{word: int(scale) for word, scale in listed("scales").items() if scale in (100, 1000)},
    **dict.fromkeys(("a hundred", "one hundred"), 100),
    "a thousand": 1000,
}
_ORDINALS = {"zehnte": 10, "zwanzigste": 20, "fünfzigste": 50, "hundertste": 100, "tausendste": 1000}
_EVENT = (
    r"(?:time|miss(?:es)?|fail(?:ure)?|outage|drop|packet|transmission|attempt|slot|night|day|case|coupure|raté|perte|"
    r"échec|fois|panne|paquet|fallo|corte|vez|veces|pérdida|error|interrupción|ausfall|ausfälle|aussetzer|fehler|mal|"
    r"paket|pakete|fälle|fällen)s?"
)
_PART = rf"(?P<part>[0-9]{{1,3}}|{'|'.join(sorted(_PARTS, key=len, reverse=True))})"
_WHOLE = rf"(?P<whole>10|20|25|40|50|100|200|500|1[ .,']?000|{'|'.join(sorted(_WHOLES, key=len, reverse=True))})"
_NUMERAL = "[0-9一二两三四五六七八九十百千]+"
_ODDS = deferred(
    rf"(?i)(?<![\w.,]){_PART}(?:[\s-]+{_EVENT}[\s-]+of|(?:[\s-]+{_EVENT})?[\s-]+(?:in|out\s+of|por\s+cada|de\s+cada|cada|entre|sur|von|aus|auf))"
    rf"[\s-]+(?:every\s+|each\s+|je\s+)?{_WHOLE}(?![\w%]|[.,][0-9]|\s?(?:[kmM]?W|dB\w*|[kKMG]?bit\S*|[kMG]bps)\b)|"
    rf"\bjede[rsnm]?\s+(?P<ordinal>{'|'.join(_ORDINALS)})[nrsm]?\b|"
    rf"(?P<zhwhole>{_NUMERAL})(?P<unit>次|回)(?:里|中|之中|当中)?[^,，。;；0-9一二两三四五六七八九十百千]{{0,6}}(?P<zhpart>{_NUMERAL})(?P=unit)"
)

_HOW_MANY = cardinals(2, 7)
_LATIN = "|".join([*_HOW_MANY, "[2-7]"])
_RELIABLE = (
    r"(?:reliab\w*|availab\w*|dependab\w*|fiab\w*|confiab\w*|disponib\w*|zuverlässig\w*|verfügbar\w*|sicherheit)"
)
_LINK = r"(?:\s+(?:of|at|is|be|to|de|del|von|bei|à|al|a|at\s+least|mindestens|au\s+moins))*\s*[:=]?\s*"
_PERCENT = r"(?P<{}>[5-9][0-9](?:[.,][0-9]{{1,6}})?)(?![0-9.,]*[0-9])"
_NINES = Phrases(
    rf"(?<![\w.,])(?P<count>{_LATIN})[\s-]+(?:nines|9'?s|nueves|neufs|neunen|neuner)(?![\w%])|"
    r"(?P<zh>[二两三四五六七2-7])\s?个\s?[九9](?![0-9一二三四五六七八九十百千万])|"
    r"(?:(?<=^)|(?<=[,;:\uff0c；、(。]\s)|(?<=[,;:\uff0c；、(。]))(?P<alone>99[.,]9{1,5})(?=\s*(?:$|[,;!?)\uff0c；。]|\.(?![0-9])))|"
    rf"\b{_RELIABLE}{_LINK}{_PERCENT.format('behind')}|(?<![\w.,]){_PERCENT.format('ahead')}\s+{_RELIABLE}|"
    rf"可靠[性度率]?(?:要?达?到|要|为|是|不低于|至少|>=|≥|=|:)?\s*{_PERCENT.format('zhbehind')}",
    marks="nine 9 nueve neuf neun 九 reliab availab dependab fiab disponib zuverlässig verfügbar sicherheit 可靠",
)


@dataclass(frozen=True, kw_only=True)
class Reading:
    """A number with the unit that follows it; ``factor`` is that of a bare "k" or "M"."""

    number: Number
    unit: Unit | None
    start: int
    end: int
    factor: Decimal = Decimal(1)


def readings(plain: str) -> list[Reading]:
    """Every number of a normalised text with its unit, from left to right, not overlapping."""
    shares = (each for each in odds(plain) if _COUNTED.match(plain, each[2]) is None)
    found = [
        Reading(
            number=Number(value=value, start=start, end=end, form="words"),
            unit=Unit(kind="ratio", end=end), start=start, end=end,
        )
        for value, start, end in (*nines(plain), *shares)
    ]  # fmt: skip
    for number in numbers(plain):
        if not overlaps((number.start, number.end), [(each.start, each.end) for each in found]):
            found.append(_read(plain, number))
    return sorted(found, key=lambda reading: reading.start)


def _read(plain: str, number: Number) -> Reading:
    unit = unit_at(plain, number.end)
    share = _share(plain, number) if unit is None else None
    if share is not None:
        return share
    if unit is not None:
        return _with_half(plain, number, unit)
    suffix = _SUFFIX.match(plain, number.end) if number.form == "digits" else None
    spoken = number.form == "chinese" and number.value is not None and number.end - number.start > 1
    written = (number.form == "digits" or spoken) and has_chinese(plain)
    chinese = _CHINESE_SUFFIX.match(plain, number.end) if written else None
    if chinese is not None and not _PICTURE.match(plain, number.start):
        unit = Unit(kind="rate", end=chinese.end(), factor=_SUFFIXES[chinese["suffix"]])
        return Reading(number=number, unit=unit, start=number.start, end=chinese.end())
    if suffix is not None and not GENERATION.match(plain, number.start):
        end, factor = suffix.end(), _SUFFIXES[suffix["suffix"] or "M"]
        if suffix["suffix"] != "G" and _is_apiece(plain, number.start, end):
            unit = Unit(kind="rate", end=end, factor=factor)
            return Reading(number=number, unit=unit, start=number.start, end=end)
        if suffix["suffix"]:
            return Reading(number=number, unit=None, start=number.start, end=end, factor=factor)
    return Reading(number=number, unit=None, start=number.start, end=number.end)


def _is_apiece(plain: str, start: int, end: int) -> bool:
    """Whether a number with a "k" or an "M" is said of each user: "500k each", "everyone gets at least 2M"."""
    each = _APIECE_AFTER.match(plain, end) or _APIECE_BEFORE.search(plain, max(0, start - 60), start)
    return each is not None and _PRICE.search(plain, 0, start) is None


def _with_half(plain: str, number: Number, unit: Unit) -> Reading:
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
    number = Number(value=value, start=number.start, end=number.end, form=number.form)
    return Reading(number=number, unit=unit, start=number.start, end=end)


def _share(plain: str, number: Number) -> Reading | None:
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
    number = Number(value=value, start=number.start, end=number.end, form=number.form)
    return Reading(number=number, unit=Unit(kind="ratio", end=end), start=start, end=end)


def odds(plain: str) -> Iterator[tuple[Decimal, int, int]]:
    """The odds of a normalised text as ratios, and where they stand.

    >>> [value for value, *_ in odds("one miss in twenty is fine")]
    [Decimal('0.05')]
    """
    for match in _ODDS.finditer(plain):
        part = _counted(match["part"] or match["zhpart"] or "1", _PARTS)
        whole = _counted(match["whole"] or match["zhwhole"] or match["ordinal"], _WHOLES | _ORDINALS)
        if 0 < part < whole:
            yield part / whole, *match.span()


def _counted(word: str, words: Mapping[str, int]) -> Decimal:
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

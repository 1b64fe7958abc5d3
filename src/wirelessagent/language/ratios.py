"""Ratios without a percent sign: odds ("one miss in twenty", 十次里有九次) and reliabilities ("five nines", 四个九).

Odds are ratios like a percentage; whether of what fails or of what holds, the model of roles says. A reliability is one
where nothing else can be meant: so many nines, a number of nines alone ("…, 99.999") or a number above fifty right
beside a word for reliability.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

from wirelessagent.language.deferred import deferred
from wirelessagent.language.number_words import cardinals, listed
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.text import Phrases
from wirelessagent.language.units import unit_at

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
    "a hundred": 100,
    "one hundred": 100,
    "a thousand": 1000,
}
_ORDINALS = {
    "zehnte": 10, "zwanzigste": 20, "fünfzigste": 50, "hundertste": 100, "tausendste": 1000, "tenth": 10,
    "twentieth": 20, "fiftieth": 50, "hundredth": 100, "thousandth": 1000,
}  # fmt: skip
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
_NUMBER = r"(?P<{}>[5-9][0-9](?:[.,][0-9]{{1,6}})?)(?![0-9.,]*[0-9])"
_NINES = Phrases(
    rf"(?<![\w.,])(?P<count>{_LATIN})[\s-]+(?:nines|9'?s|nueves|neufs|neunen|neuner)(?![\w%])|"
    r"(?P<zh>[二两三四五六七2-7])\s?个\s?[九9](?![0-9一二三四五六七八九十百千万])|"
    r"(?:(?<=^)|(?<=[,;:\uff0c；、(。]\s)|(?<=[,;:\uff0c；、(。]))(?P<alone>99[.,]9{1,5})(?=\s*(?:$|[,;!?)\uff0c；。]|\.(?![0-9])))|"
    rf"\b{_RELIABLE}{_LINK}{_NUMBER.format('behind')}|(?<![\w.,]){_NUMBER.format('ahead')}\s+{_RELIABLE}|"
    rf"可靠[性度率]?(?:要?达?到|要|为|是|不低于|至少|>=|≥|=|:)?\s*{_NUMBER.format('zhbehind')}",
    marks="nine 9 nueve neuf neun 九 reliab availab dependab fiab disponib zuverlässig verfügbar sicherheit 可靠",
)


def odds(plain: str) -> Iterator[tuple[Decimal, int, int]]:
    """The odds of a normalised text as ratios, and where they stand.

    >>> [value for value, *_ in odds("one miss in twenty is fine")]
    [Decimal('0.05')]
    """
    for match in _ODDS.finditer(plain):
        part, whole = _of(match)
        if 0 < part < whole:
            yield part / whole, *match.span()


def _of(match: re.Match[str]) -> tuple[Decimal, Decimal]:
    """How many of how many."""
    if match["ordinal"]:
        return Decimal(1), Decimal(_ORDINALS[match["ordinal"].lower()])
    if match["zhwhole"]:
        return _chinese(match["zhpart"]), _chinese(match["zhwhole"])
    return _number(match["part"], _PARTS), _number(match["whole"], _WHOLES)


def _number(word: str, words: dict[str, int]) -> Decimal:
    digits = re.sub(r"[ .,']", "", word)
    return Decimal(digits if digits.isdigit() else words.get(" ".join(word.lower().split()), 0))


def _chinese(word: str) -> Decimal:
    return Decimal(word) if word.isdigit() else Decimal(chinese_value(word) or 0)


def nines(plain: str) -> Iterator[tuple[Decimal, int, int]]:
    """The reliabilities of a normalised text that are no percentages, as ratios, and where they stand.

    >>> [float(value) for text in ("five nines", "reliability 99.9", "四个九") for value, *_ in nines(text)]
    [0.99999, 0.999, 0.9999]
    """
    for match in _NINES.finditer(plain):
        group = match.lastgroup or ""
        counted = group in ("count", "zh")
        start, end = match.span() if counted else match.span(group)
        if unit_at(plain, end) is None:
            yield _reliability(match[group].lower(), counted=counted), start, end


def _reliability(word: str, *, counted: bool) -> Decimal:
    if counted:
        return 1 - Decimal(10) ** -int(_HOW_MANY.get(word) or chinese_value(word) or word)
    return Decimal(word.replace(",", ".")) / 100

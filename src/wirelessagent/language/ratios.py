"""Reliabilities without a percent sign: "five nines", 四个九.

A number is one where nothing else can be meant: so many nines, a number of nines alone ("…, 99.999") or a number above
fifty right beside a word for reliability.
"""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from wirelessagent.language.number_words import cardinals
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.text import Phrases
from wirelessagent.language.units import unit_at

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

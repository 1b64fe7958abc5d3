"""Amounts by which something changes: "20 %", "a third", "三分之一", "两成", "10 dB".

>>> with_amount("reduce the power by a third")
('reduce the power by ~', Amount(value=0.3333333333333333, decibels=False))
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from wirelessagent.language.deferred import deferred
from wirelessagent.language.numerals import chinese_value

_PARTS = {
    "half": 2,
    "halves": 2,
    "third": 3,
    "quarter": 4,
    "fourth": 4,
    "fifth": 5,
    "sixth": 6,
    "eighth": 8,
    "tenth": 10,
}
_COUNTS = {"a": 1, "one": 1, "two": 2, "three": 3, "four": 4}
_DIGITS = r"\d+(?:\.\d+)?|[一二两三四五六七八九十百]+"
_AMOUNT = deferred(
    r"(?P<percent>\d+(?:\.\d+)?)\s*(?:%|percent\b|per\s+cent\b|个百分点)|"
    rf"(?P<below>{_DIGITS})分之(?P<over>{_DIGITS})|(?P<tenths>[1-9]|[一二两三四五六七八九])成(?P<more>半)?|(?P<zh_half>一半|半数)|"
    rf"(?:(?P<count>\d+|{'|'.join(_COUNTS)})\s+)(?P<part>{'|'.join(_PARTS)})s?\b|(?P<half>\bhalf)\b|"
    rf"(?P<decibels>\d+(?:\.\d+)?)\s*(?:db\b|decibels?\b|分贝)"
)


@dataclass(frozen=True, kw_only=True)
class Amount:
    """A share from 0 (0.2 is 20 %), or a ratio in dB where ``decibels``."""

    value: float
    decibels: bool = False

    def factor(self, how: str) -> float:
        """What a figure is multiplied with that becomes this much "less" or "more", or this share "of" itself."""
        if self.decibels:
            return float(10 ** ((-self.value if how == "less" else self.value) / 10))
        return {"of": self.value, "less": 1 - self.value, "more": 1 + self.value}[how]


def with_amount(said: str) -> tuple[str, Amount | None]:
    """The same words with "~" for their only share or "^" for their only decibels; None for no or several."""
    found = list(_AMOUNT.finditer(said))
    if len(found) != 1:
        return said, None
    amount, (start, end) = _amount(found[0]), found[0].span()
    return f"{said[:start]}{'^' if amount.decibels else '~'}{said[end:]}", amount


def _amount(match: re.Match[str]) -> Amount:
    if match["decibels"]:
        return Amount(value=float(match["decibels"]), decibels=True)
    if match["percent"]:
        return Amount(value=float(match["percent"]) / 100)
    if match["below"]:
        below = _number(match["below"])
        return Amount(value=_number(match["over"]) / below if below else 0.0)
    if match["tenths"]:
        return Amount(value=(_number(match["tenths"]) + (0.5 if match["more"] else 0.0)) / 10)
    if match["part"]:
        count = _COUNTS.get(match["count"]) or float(match["count"])
        return Amount(value=count / _PARTS[match["part"]])
    return Amount(value=0.5)


def _number(said: str) -> float:
    return float(said) if said[0].isdigit() and said.isascii() else float(chinese_value(said) or 0)

"""Words that multiply: "double", "three times", "算两份"; what they multiply is not decided here."""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

from wirelessagent.language.numerals import Number

_TIMES = re.compile(
    r"(?i)\b(?P<two>twice|double[ds]?|doubly|el doble|doble|le double|doppelt\w*|compte(?:r)? pour deux)\b|"
    r"\b(?P<three>three ?times|triple[ds]?|thrice|"
    r"threefold|el triple|trois fois|dreifach|tres veces|dreimal|compte(?:r)? pour trois)\b|\b(?P<four>four ?times|"
    r"fourfold|quadruple|cuatro veces|quatre fois|vierfach)\b|"
    r"\b(?P<five>five ?times|fivefold|fünffach|cinco veces|cinq fois)\b|\b(?P<ten>ten ?times|tenfold|zehnfach|"
    r"diez veces|dix fois)\b|\b(?P<half>half|halb|la mitad|la moitié|mitad)\b|"
    r"(?<![\w.])(?P<n>[0-9]+(?:\.[0-9]+)?)\s*(?:times|x\b|-fold|veces|fois|mal|倍)|(?P<zh2>翻倍|加倍|双倍|[两二]倍|"
    r"[两二]份|顶[两二]个|当[两二]个|算[两二]个|翻一番)|"
    r"(?P<zh3>三倍|三份|顶三个|当三个)|(?P<zh4>四倍)|(?P<zh5>五倍)|(?P<zh10>十倍)|(?P<zhhalf>减半|一半|半份)"
)
_FACTORS = {
    "two": 2.0, "three": 3.0, "four": 4.0, "five": 5.0, "ten": 10.0, "half": 0.5, "zh2": 2.0, "zh3": 3.0, "zh4": 4.0,
    "zh5": 5.0, "zh10": 10.0, "zhhalf": 0.5,
}  # fmt: skip


def factors(plain: str) -> Iterator[Number]:
    """The words of a normalised text that multiply, from left to right, as numbers of the form "times".

    >>> [(factor.value, factor.start) for factor in factors("user 3 counts twice")]
    [(Decimal('2'), 14)]
    """
    for match in _TIMES.finditer(plain):
        group = match.lastgroup or ""
        value = Decimal(match["n"]) if group == "n" else Decimal(str(_FACTORS[group])).normalize()
        yield Number(value=value, start=match.start(), end=match.end(), form="times")

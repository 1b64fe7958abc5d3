"""Words that multiply: "double", "three times", "算两份"; what they multiply is not decided here."""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

from wirelessagent.language.number_words import cardinals, listed
from wirelessagent.language.numerals import Number, chinese_value
from wirelessagent.language.phrases import Phrases

_ONE_AND_A_HALF = ("uno y medio", "un et demi", "one and a half", "una y media", "une fois et demie", "una vez y media")
_COUNTS = {
    **cardinals(2, 10),
    **listed("fold"),
    **dict.fromkeys(_ONE_AND_A_HALF, Decimal("1.5")),
    **dict.fromkeys(("dos y medio", "deux et demi", "two and a half", "deux fois et demie"), Decimal("2.5")),
}
_WORD = "(?:" + "|".join(sorted(_COUNTS, key=len, reverse=True)) + ")"
_TIMES = Phrases(
    rf"\b(?P<named>{'|'.join(listed('fold'))})\b|\b(?P<german>doppelt|dreifach|vierfach|fünffach|zehnfach)\w*|"
    rf"\b(?P<compound>{_WORD})(?:fach|mal)\w*|(?P<phrase>(?:une\s+fois\s+et\s+demie|deux\s+fois\s+et\s+demie|"
    rf"una\s+vez\s+y\s+media))|"
    rf"\b(?P<word>{_WORD})[\s-]?(?:times|veces|fois|mal|fold)\b|"
    rf"\b(?:compt\w+|val\w+|pes\w+|p[eè]s\w+|cuent\w+|cont\w+|counts?|counting|count|zähl\w+)\s+(?:(?:al?|el|le|"
    rf"l'|usuario|utilisateur|abonné|abonado|cliente?|user|[0-9]+)\s*){{0,4}}(?:pour|por|como|comme|for|as|für)\s+"
    rf"(?P<counted>{_WORD})\b|"
    r"(?<![\w.])(?:x\s?(?P<x>[0-9]+(?:\.[0-9]+)?)(?![\w.])|(?P<n>[0-9]+(?:[.,][0-9]+)?)\s*(?:times\b|x\b|-?fold\b|"
    r"veces\b|fois\b|mal\b|-?fach\w*))|(?P<zhn>[0-9]+(?:\.[0-9]+)?)\s*倍|"
    r"(?P<zhtwo>翻倍|加倍|双倍|双份|翻一番|顶[两二]个|当[两二]个|算[两二]个)|(?P<zhhalf>减半|一半|半份|半倍)|"
    r"(?P<zh>[一二两三四五六七八九十](?:点[一二三四五六七八九])?)(?P<zhmore>[倍份]半?)"
)
_GERMAN = {"doppelt": 2, "dreifach": 3, "vierfach": 4, "fünffach": 5, "zehnfach": 10}
_HALF = Decimal("0.5")


def factors(plain: str) -> Iterator[Number]:
    """The words of a normalised text that multiply, from left to right, as numbers of the form "times".

    >>> [(factor.value, factor.start) for factor in factors("user 3 counts twice")]
    [(Decimal('2'), 14)]
    """
    for match in _TIMES.finditer(plain):
        group = "zh" if match["zh"] else match.lastgroup or ""
        start = match.start(group) if group == "counted" else match.start()
        value = _value(match, group)
        if value is not None:
            yield Number(value=value, start=start, end=match.end(), form="times")


def _value(match: re.Match[str], group: str) -> Decimal | None:
    word = " ".join(match[group].lower().split())
    if group in ("n", "x", "zhn"):
        return Decimal(word.replace(",", "."))
    if group == "zh":
        value = chinese_value(word)
        return None if value is None else Decimal(str(value)) + (_HALF if match["zhmore"].endswith("半") else 0)
    known = {"german": _GERMAN, "zhtwo": {word: 2}, "zhhalf": {word: _HALF}}.get(group, _COUNTS)
    return Decimal(known[word])

"""The units that may follow a number, and what one of them is in SI.

Capitals count where they tell prefixes or bits and bytes apart: mW is a thousandth and MW a million watts, Mb/s are
bits and MB/s bytes. Where they cannot (nobody means milli-bits), they are forgiven: "mbps" and "MBPS" are Mbit/s. A
spelling that leaves bits or bytes open ("MB/S") is marked doubtful. A bit or byte without a prefix needs its "per
second", and bytes always do: "10 GB" is a file, "a bit faster" is no rate.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, replace
from decimal import Decimal
from typing import Literal, TypeAlias

from wirelessagent.language.vocabulary import one_edit
from wirelessagent.language.word_tables import any_word, deferred, words_of
from wirelessagent.model.units import dbm_to_w

UnitKind: TypeAlias = Literal["power", "rate", "ratio"]

_PREFIXES = {
    "": 0, "n": -9, "nano": -9, "纳": -9, "u": -6, "μ": -6, "micro": -6, "微": -6, "m": -3, "milli": -3, "mili": -3,
    "毫": -3,
    "k": 3, "K": 3, "kilo": 3, "千": 3, "M": 6, "mega": 6, "méga": 6, "兆": 6, "G": 9, "g": 9, "giga": 9, "吉": 9,
    "T": 12, "t": 12, "tera": 12, "太": 12,
}  # fmt: skip

_PER_SECOND = (
    rf"(?:\s*(?:/|\b{any_word('figures', 'units', 'per', 'per_second')}\b|每)\s*"
    rf"(?:{any_word('figures', 'units', 'second')}(?![A-Za-z0-9_])|秒钟?)|ps(?![A-Za-z0-9_]))"
)
_END = r"(?![A-Za-z0-9])"

_LEVEL = deferred(
    rf"(?P<of_a_watt>(?i:dbw){_END}|分贝瓦)|分贝毫瓦|毫瓦分贝|"
    rf"(?i:(?:dbmw|dbms?|(?:decibels?|d[ée]cibel(?:io)?s|dezibel)[ -](?:milli-?watts?|milivatios?)){_END})"
)
_WATT = deferred(
    rf"(?P<symbol>[nuμmkKMG]?)[wW]{_END}|(?i:(?P<word>nano|micro|milli|mili|kilo|mega|giga)?[ -]?(?:watts?|vatios?|"
    rf"watios?){_END})"
    r"|(?P<zh>[纳微毫千兆]?)(?:瓦特?(?!时|分贝)|哇(?!塞))"
)
_BIT = deferred(
    rf"(?P<prefix>[kKmMgGtT]?)(?P<binary>i?)(?:(?P<short>[bB])(?P<ps>[pP][sS]){_END}"
    rf"|(?P<core>(?i:bits?|bytes?|octets?)|[bB]|o(?=/s))(?:(?P<per>(?i:{_PER_SECOND}))|{_END}))"
)
_BIT_WORD = deferred(
    rf"(?i:(?P<prefix>kilo|mega|méga|giga|tera)[ -]?(?P<core>bits?|bytes?|octets?)(?:(?P<per>{_PER_SECOND})|{_END}))"
)
_SPOKEN = deferred(  # "two megs", "3 megas"; gigas are files unless there is a second
    rf"(?i:(?:(?P<mega>megs?|m[eé]gas?)|(?P<kilo>kays?)|(?P<giga>gigs?|gigas?)(?={_PER_SECOND})){_END}"
    rf"(?:{_PER_SECOND})?(?!\s?-?(?:bits?|bytes?|octets?|watts?|vatios?|hertz|hz|pixels?|p[ií]xel|joules?|julios?|"
    rf"ohms?|euros?)\b))"
)
_BIT_ZH = deferred(
    rf"(?:(?P<prefix>[千兆吉太kKmMgG]?)\s?(?P<core>比特|字节)|(?P<mega>兆)(?P<latin>(?i:bits?|b|"
    rf"(?=ps))?)(?![瓦赫焦]|\s*(?i:hz|w|b)))"
    rf"(?P<per>(?i:{_PER_SECOND}|ps{_END}))?"
)
_RATIO = deferred(
    rf"%|(?i:{any_word('figures', 'units', 'percent')}{_END})|"
    rf"(?P<thousandth>‰|(?i:{any_word('figures', 'units', 'thousandth')}{_END}))"
)
_NOT_A_RATE_OR_POWER = deferred(
    rf"(?i)(?:/|每)\s?(?!{any_word('figures', 'units', 'per_whom')}|sc\b|ch\b|子载波)(?=[A-Z子])"
    r"|\s*(?:/|(?:per|pro|par|por)\s)\s*(?:\w?hz|hertz|megahertz|kilohertz|joules?|j|watts?|w|hours?|symbol|bit|"
    r"m2|m²|kg)\b"
    r"|[\s·-]*(?:h|hrs?|hours?|horas?|heures?|stunden?)\b|小时|\s*/?每?(?:赫兹?|焦耳?)"
)

_MISSPELT = deferred(r"[A-Za-zÀ-ÿ]{3,12}(?:/s(?![A-Za-z]))?(?![A-Za-z0-9])")
_CORES = ("bit", "bits", "byte", "bytes")
_PREFIXED = [f"{prefix}{core}" for prefix in ("kilo", "mega", "giga") for core in _CORES]
_A_SECOND = [f"{prefix}{core}/s" for prefix in "kmg" for core in _CORES]
_SHORT = ("kbps", "mbps", "gbps", "dbm", "dbw")
_POWERS = [f"{prefix}{core}" for prefix in ("", "milli", "kilo", "mega") for core in ("watt", "watts")]
_SPELT = (*_POWERS, "vatio", "vatios", *_PREFIXED, *_A_SECOND, *_SHORT)
_OF_THEIR_OWN = frozenset(("wait", "waits", "want", "wants", "wart", "warts", "waft", "wafts"))
_NEXT_KEY = {"dbn": "dbm"}
_ANOTHER_TIME = ("pm", "ph", "pd")


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A unit found in a text: multiply by ``factor``, or take ``level_dbm`` as the dBm of 0 of it."""

    kind: UnitKind
    end: int
    factor: Decimal = Decimal(1)
    level_dbm: float | None = None
    doubtful: bool = False

    def value(self, number: Decimal) -> float:
        """The SI value of a number of this unit; inf where it is beyond any figure."""
        if self.level_dbm is None:
            return float(number * self.factor)
        try:
            return dbm_to_w(float(number) + self.level_dbm)
        except OverflowError:
            return float("inf")


_PER_ANOTHER_TIME = deferred(
    rf"(?i)\s*(?:/|{any_word('figures', 'units', 'per', 'per_other')})\s*"
    rf"{any_word('figures', 'units', 'other_times')}\b|\s*[/每]?每(?:分钟?|小时|天|周|月)"
)
_OF_ANOTHER_TIME = deferred(r"每个?(?:分钟?|小时|天|周|月)[^,\uff0c。;]{0,6}$")
_GAP = deferred(r"\s?个\s?|-|\+?(?: {3,}|\s{0,2})")


def _starts(text: str, position: int) -> list[int]:
    """Where a unit may begin: behind a space or a hyphen, or at once."""
    gap = _GAP.match(text, position)
    return sorted({gap.end() if gap else position, position}, reverse=True)


@functools.lru_cache(maxsize=512)
def unit_at(text: str, position: int) -> Unit | None:
    """The unit that begins at this place of a plain text, behind a hyphen or blanks (many where words are gone)."""
    found, is_of_another_time = _found(text, position)
    if found is None:
        return _misspelt(text, _starts(text, position)[0])
    strange = found.kind != "ratio" and _NOT_A_RATE_OR_POWER.match(text, found.end)
    return None if strange or is_of_another_time else found


def unit_of_another_time(text: str, position: int) -> int | None:
    """Where a unit of rate ends that is per minute or per day, after at most a space; None where there is none."""
    found, is_of_another_time = _found(text, position)
    return found.end if found is not None and is_of_another_time else None


def _found(text: str, position: int) -> tuple[Unit | None, bool]:
    """The unit, and whether it is per minute or per day: "1 Mbit per minute" is no rate of 1 Mbit/s."""
    for start in _starts(text, position):
        found = _unit(text, start)
        if found is not None:
            before = _OF_ANOTHER_TIME.search(text, max(0, start - 24), start)
            slow = before is not None or _PER_ANOTHER_TIME.match(text, found.end) is not None
            return found, found.kind == "rate" and slow
    return None, False


def _misspelt(text: str, start: int) -> Unit | None:
    """The unit that a word with one slip of the pen stands for."""
    match = _MISSPELT.match(text, start)
    word = unit_meant(match.group()) if match is not None else ""
    if match is None or not word:
        return None
    found = unit_at(f"{text[:start]}{word}{text[match.end() :]}", start)
    return None if found is None else replace(found, end=found.end + len(match.group()) - len(word))


def _unit(text: str, start: int) -> Unit | None:
    """What begins at this very place: a level, a power, a rate or a share, whose patterns exclude each other."""
    if match := _LEVEL.match(text, start):
        return Unit(kind="power", end=match.end(), level_dbm=30.0 if match["of_a_watt"] else 0.0)
    if match := _WATT.match(text, start):
        prefix = match["symbol"] or (match["word"] or "").lower() or match["zh"] or ""
        return Unit(kind="power", end=match.end(), factor=Decimal(10) ** _PREFIXES[prefix])
    if match := _BIT_ZH.match(text, start) or _BIT_WORD.match(text, start) or _BIT.match(text, start):
        return _unit_of_bits(match)
    if match := _SPOKEN.match(text, start):
        return Unit(kind="rate", end=match.end(), factor=_scale(match.lastgroup or ""))
    if match := _RATIO.match(text, start):
        return Unit(kind="ratio", end=match.end(), factor=Decimal("0.001" if match["thousandth"] else "0.01"))
    return None


_SCALE_AHEAD = deferred(
    rf"(?i)(?:[千万]|\b(?:{'|'.join(words_of('figures', 'numbers', 'scales'))})(?:\s+(?:de|d'))?)\s*$"
)


def _unit_of_bits(match: re.Match[str]) -> Unit | None:
    """The rate that bits or bytes are; None for an amount of them."""
    said, ahead = match.groupdict(""), match.string[max(0, match.start() - 12) : match.start()]
    core, second = said.get("short") or said["core"], said.get("ps")
    prefix = said.get("mega") or said["prefix"].lower()
    shouted = core == "B" and second == "PS"  # in capitals throughout: the usual bps
    is_bytes = not shouted and (core == "B" or core.lower().startswith(("byte", "o", "字节")))
    per_second = second or said["per"] or "每秒" in ahead
    if not per_second and (is_bytes or not (prefix or _SCALE_AHEAD.search(ahead))):  # "a million bits", "800千比特"
        return None
    factor = _scale(prefix, binary=bool(said.get("binary"))) * (8 if is_bytes else 1)
    doubtful = said["core"] == "B" and match.group().endswith("S")
    return Unit(kind="rate", end=match.end(), factor=factor, doubtful=doubtful)


def _scale(prefix: str, *, binary: bool = False) -> Decimal:
    power = _PREFIXES["M" if prefix == "m" else prefix]
    return Decimal(1024) ** (power // 3) if binary else Decimal(10) ** power


@functools.lru_cache(maxsize=1024)
def unit_meant(word: str) -> str:
    """The unit that a word with one slip stands for, "" where it is none or several.

    >>> unit_meant("wats"), unit_meant("kbis/s"), unit_meant("megabites"), unit_meant("want")
    ('watts', 'kbits/s', '', '')
    """
    small = word.lower()
    if small in _NEXT_KEY:
        return _NEXT_KEY[small]
    if small in _OF_THEIR_OWN or small in _SPELT or small.endswith(_ANOTHER_TIME):
        return ""
    near = [unit for unit in _SPELT if unit[0] == small[0] and one_edit(small, unit)]
    near = [unit for unit in near if unit not in _SHORT or len(small) >= len(unit)]  # "mbs" may as well be bytes
    meanings = {unit.replace("/s", "").rstrip("s") for unit in near}
    return max(near, key=lambda unit: (len(unit) == len(small) + 1, unit)) if len(meanings) == 1 else ""

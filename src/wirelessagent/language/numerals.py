"""Numbers as people write them: digits, English words and Chinese numerals, exact as decimals.

Missing on purpose: ordinals, fractions other than halves and quarters, and vague amounts ("a few"), which are reported
as numbers without a value so that nobody acts on half of one ("a few hundred" is not 100).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal

from wirelessagent.language.text import language_of

_ONES = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen "
    "eighteen nineteen"
)
_TENS = "twenty thirty forty fifty sixty seventy eighty ninety"
_SMALL = {
    **{word: Decimal(value) for value, word in enumerate(_ONES.split())},
    **{word: Decimal(10 * value) for value, word in enumerate(_TENS.split(), start=2)},
    "a": Decimal(1),
    "an": Decimal(1),
}
_SCALES = {"hundred": Decimal(100), "thousand": Decimal(10**3), "million": Decimal(10**6), "billion": Decimal(10**9)}
_VAGUE = ("few", "several", "couple", "dozen", "dozens", "hundreds", "thousands", "third", "tenth")
_PARTS = {"half": Decimal("0.5"), "quarter": Decimal("0.25"), "quarters": Decimal("0.25")}

# Number words of other languages, which count only in front of a unit: "once" is also English.
_FOREIGN = {
    "en_es": "uno dos tres cuatro cinco seis siete ocho nueve diez once doce trece catorce quince dieciséis diecisiete "
    "dieciocho diecinueve veinte",
    "en_fr": "un deux trois quatre cinq six sept huit neuf dix onze douze treize quatorze quinze seize dix-sept "
    "dix-huit dix-neuf vingt",
    "en_de": "ein zwei drei vier fünf sechs sieben acht neun zehn elf zwölf dreizehn vierzehn fünfzehn sechzehn "
    "siebzehn achtzehn neunzehn zwanzig",
}
_FOREIGN_WORDS = {
    **{word: Decimal(place) for listing in _FOREIGN.values() for place, word in enumerate(listing.split(), start=1)},
    "una": Decimal(1), "une": Decimal(1), "eine": Decimal(1), "einen": Decimal(1), "eins": Decimal(1),
    "medio": Decimal("0.5"), "media": Decimal("0.5"), "demi": Decimal("0.5"), "halbes": Decimal("0.5"),
    "anderthalb": Decimal("1.5"), "eineinhalb": Decimal("1.5"), "zweieinhalb": Decimal("2.5"),
    "treinta": Decimal(30), "trente": Decimal(30), "dreißig": Decimal(30), "cuarenta": Decimal(40),
    "quarante": Decimal(40), "vierzig": Decimal(40), "cincuenta": Decimal(50), "cinquante": Decimal(50),
    "fünfzig": Decimal(50), "cien": Decimal(100), "cent": Decimal(100), "hundert": Decimal(100),
    "veinticinco": Decimal(25), "vingt-cinq": Decimal(25), "fünfundzwanzig": Decimal(25),
    "doscientos": Decimal(200), "quinientos": Decimal(500), "zweihundert": Decimal(200), "fünfhundert": Decimal(500),
}  # fmt: skip
_FOREIGN_UNIT = (
    r"(?=[\s-]+(?:mili|milli|kilo|mega|méga|giga)?-?(?:vatios?|watts?|bits?|mbit|kbit|mbps|kbps|mb/s|"
    r"kb/s|gbit|mw|kw|w|dbm|dbw|prozent|por\s+ciento|pour\s+cent|%)(?![a-z]))"
)

_CHINESE_DIGITS = {c: d for d, c in enumerate("零一二三四五六七八九")} | {"〇": 0, "两": 2}
_CHINESE_SCALES = {"十": 10, "百": 100, "千": 1000}
_CHINESE_BIG = {"万": 10**4, "亿": 10**8}

_DIGITS = (
    r"(?:(?:[1-9][0-9]{0,2}(?:,[0-9]{3})+|[1-9][0-9]{0,2}(?: [0-9]{3})+(?![0-9]))(?:\.[0-9]+)?(?![0-9]|[.,][0-9])"
    r"|[0-9]+[.,][0-9]+(?![0-9]|[.,][0-9])|[0-9]+(?:[.,][0-9]+){2,}|\.[0-9]+|[0-9]+)(?:[eE][+-]?[0-9]{1,3}(?![0-9]))?"
)
_WORD = (
    r"(?:" + "|".join(sorted([*_SMALL, *_SCALES, *_PARTS, *_VAGUE, "and", "point", "of"], key=len, reverse=True)) + r")"
)
_NUMBER = re.compile(
    rf"(?P<minus>(?<![A-Za-z0-9_)])-(?=[0-9.])|(?i:\b(?:minus|negative)\s+)|负\s*)?"
    rf"(?:(?P<digits>(?<![A-Za-z0-9_.]){_DIGITS})(?:\s?(?P<scale>(?i:hundred|thousand|million|billion)\b|[百千]?万|"
    rf"百|亿|千(?!瓦时|赫|米)))?"
    rf"|(?P<foreign>(?i:\b(?:{'|'.join(sorted(_FOREIGN_WORDS, key=len, reverse=True))}){_FOREIGN_UNIT}))"
    rf"|(?P<words>(?i:(?!(?<=\bas\s)(?:an?|one|few|several)\b)\b{_WORD}(?:[\s-]+{_WORD})*\b))"
    rf"|(?P<chinese>[几零〇一二两三四五六七八九十百千万亿半][零〇一二两三四五六七八九十百千万亿点半]*))"
)


@dataclass(frozen=True, kw_only=True)
class Number:
    """A number and where it stands; ``value`` is None where the amount is vague or not understood."""

    value: Decimal | None
    start: int
    end: int
    form: str


def numbers(text: str) -> Iterator[Number]:
    """Every number in normalised text, from left to right, not overlapping."""
    position, points_group = 0, language_of(text) in ("es", "de")
    while match := _NUMBER.search(text, position):
        position = match.end()
        form = next(name for name in ("digits", "foreign", "words", "chinese") if match[name])
        start, end, value = match.start(), match.end(), _value_of(match, form, points_group=points_group)
        if form == "words":
            start, end, value = _trim_words(match)
        if value is not None and match["minus"]:
            value = -value
        if end > start:
            yield Number(value=value, start=start, end=end, form=form)


def _value_of(match: re.Match[str], form: str, *, points_group: bool) -> Decimal | None:
    if form == "chinese":
        return chinese_value(match["chinese"])
    if form == "foreign":
        return _FOREIGN_WORDS[match["foreign"].lower()]
    if form == "words":
        return None
    digits = match["digits"]
    if re.match(r"[1-9][0-9]{0,2}(?:,[0-9]{3})+(?![0-9])", digits):
        digits = digits.replace(",", "")
    elif re.match(rf"[1-9][0-9]{{0,2}}(?:\.[0-9]{{3}}){{{1 if points_group else 2},}}(?![0-9])", digits):
        digits = digits.replace(".", "")
    if len(re.findall(r"[.,]", digits)) > 1:
        return None  # "1,23,456": what the marks mean is anybody's guess
    value = Decimal(digits.replace(" ", "").replace(",", "."))
    for letter in match["scale"] or "" if not (match["scale"] or "").isascii() else ():
        value *= _CHINESE_SCALES.get(letter) or _CHINESE_BIG[letter]
    return value * _SCALES.get((match["scale"] or "").lower(), 1)


def _trim_words(match: re.Match[str]) -> tuple[int, int, Decimal | None]:
    """Where the number stands once "and", "of" or "point" at its ends are cut off, and its value."""
    words = list(re.finditer(r"[A-Za-z]+", match["words"]))
    names = [word.group().lower() for word in words]
    loose = ("and", "of", "point")
    first = next((i for i, name in enumerate(names) if name not in loose), None)
    if first is None:
        return match.start(), match.start(), None
    last = max(i for i, name in enumerate(names) if name not in loose)
    start = match.start() if match["minus"] else match.start("words") + words[first].start()
    value = None if first and names[first - 1] == "of" else words_value(names[first : last + 1])
    return start, match.start("words") + words[last].end(), value


def words_value(words: list[str]) -> Decimal | None:
    """The value of a number in English words; None where they do not make one.

    >>> words_value("three hundred and fifty".split()), words_value("one and a half".split())
    (Decimal('350'), Decimal('1.5'))
    """
    whole, group, fraction = Decimal(0), None, ""
    for index, word in enumerate(words):
        if word == "point":
            fraction = "."
        elif fraction and word in _SMALL and _SMALL[word] < 10:
            fraction += str(_SMALL[word])
        elif word in _VAGUE:
            return None
        elif word in ("and", "of") or (word in ("a", "an") and index):
            continue
        elif word in _PARTS:
            times = word == "quarters" or words[:index] in (["a"], ["an"])  # "three quarters", "a quarter of a megabit"
            group = group * _PARTS[word] if times and group is not None else (group or 0) + _PARTS[word]
        elif word in _SCALES:
            group = (Decimal(1) if group is None else group) * _SCALES[word]
            if _SCALES[word] > 100:
                whole, group = whole + group, None
        elif group is not None and not (group % 10 == 0 and _SMALL[word] < 10) and group % 100 != 0:
            return None  # "two three" is not a number
        else:
            group = (group or Decimal(0)) + _SMALL[word]
    return whole + (group or 0) + (Decimal("0" + fraction) if len(fraction) > 1 else 0)


def chinese_value(numeral: str) -> Decimal | None:
    """The value of a Chinese numeral, colloquial endings included; None where it is not one.

    >>> chinese_value("一百零五"), chinese_value("一千五"), chinese_value("三点五"), chinese_value("半")
    (Decimal('105'), Decimal('1500'), Decimal('3.5'), Decimal('0.5'))
    """
    if numeral == "半":
        return Decimal("0.5")
    whole, _, fraction = numeral.partition("点")
    if "几" in numeral or "半" in numeral or any(c not in _CHINESE_DIGITS for c in fraction):
        return None
    total, section, digit, scale, lowest = 0, 0, 0, 1, 10**9
    previous = ""
    for letter in whole:
        if letter in _CHINESE_DIGITS:
            if previous in _CHINESE_DIGITS and previous not in "零〇":
                return None  # "三五" means three to five
            digit, scale = _CHINESE_DIGITS[letter], (1 if previous in ("", "零", "〇", "十") else scale)
        elif letter in _CHINESE_SCALES:
            if previous in _CHINESE_DIGITS and section and _CHINESE_SCALES[letter] >= lowest:
                return None  # 一百零五千: 5100, or 105 kilo-?
            scale = lowest = _CHINESE_SCALES[letter]
            multiplies = previous in _CHINESE_SCALES  # 三百千: three hundred kilo-
            section, digit = section * scale if multiplies else section + (digit or 1) * scale, 0
            scale //= 10
        else:
            scale = _CHINESE_BIG[letter]
            total, section, digit, lowest = total + (section + digit or 1) * scale, 0, 0, scale
            scale //= 10
        previous = letter
    value = Decimal(total + section + digit * max(scale, 1))
    return value + Decimal("0." + "".join(str(_CHINESE_DIGITS[c]) for c in fraction)) if fraction else value

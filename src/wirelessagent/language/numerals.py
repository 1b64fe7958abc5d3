"""Numbers as people write and say them, in digits, words and Chinese numerals, exact as decimals.

Missing on purpose: ordinals, and vague amounts ("a few", 三十来), which are reported as numbers without a value so that
nobody acts on half of one ("a few hundred" is not 100).
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from decimal import Decimal

from wirelessagent.language.number_words import Spoken, cardinals, languages_of, listed, spoken
from wirelessagent.language.text import USER_NOUN, Phrases
from wirelessagent.language.units import unit_at
from wirelessagent.language.vocabulary import language_of
from wirelessagent.language.word_tables import any_word, deferred, table, words_of

_HALF = Decimal("0.5")
_SCALES = {word: int(value) for word, value in listed("scales").items() if word != "cent"}  # of money
_PARTS = {
    **{word: value for word, value in listed("parts").items() if value in (_HALF, Decimal("0.25"))},
    "½": _HALF, "¼": Decimal("0.25"), "¾": Decimal("0.75"),
}  # fmt: skip

_CHINESE_DIGITS = {c: d for d, c in enumerate("零一二三四五六七八九")} | {"〇": 0, "两": 2}
_CHINESE_SCALES = {"十": 10, "百": 100, "千": 1000, "万": 10**4, "亿": 10**8}

_DIGITS = (
    r"(?:[1-9][0-9]{0,2}(?:(?:,[0-9]{3})+|(?:'[0-9]{3})+|(?: [0-9]{3}){1,3}(?! ?[0-9]|[kK]\b))"  # "7 400k" are two
    r"(?:[.,][0-9]+)?(?![0-9]|[.,][0-9])"
    r"|[0-9]+[.,][0-9]+(?![0-9]|[.,][0-9])|[0-9]+(?:[.,][0-9]+){2,}|\.[0-9]+|[0-9]+)(?:[eE][+-]?[0-9]{1,3}(?![0-9]))?"
)
TIGHT_LIST = r"[1-9][0-9]?(?:,[1-9][0-9]?)+(?![0-9.,]*[0-9%]|[A-Za-z])"
"""Users without a space between: "6,7,8"; two of them may be a decimal."""
_TIGHT_LIST, _ITEM = deferred(TIGHT_LIST), deferred("[0-9]+")
_GOES_ON = deferred(r"\s*(?:-|–|~|to\b|or\b|[到至或])\s*[0-9]")
_LETTERS = "A-Za-zÀ-ÖØ-öø-ÿ"
_NUMBER = deferred(
    rf"(?P<minus>(?<![A-Za-z0-9_)])-(?=[0-9.])|(?i:\b(?:minus|negative)\s+)|负\s*)?"
    rf"(?:(?P<digits>(?<![A-Za-z0-9_.]){_DIGITS})(?P<power>\s?[×x*·]\s?10\^(?P<exponent>[+-]?[0-9]{{1,2}})(?![0-9]))?"
    rf"(?:\s?(?P<scale>(?i:{'|'.join(sorted(_SCALES, key=len, reverse=True))})\b(?:\s+(?:de\b|d'))?|[百千]?万|百|亿|"
    rf"千(?!瓦时|赫|米)))?"
    rf"|(?P<fraction>(?<![0-9])[½¼¾])|(?P<word>(?<![{_LETTERS}0-9_])[{_LETTERS}]+(?![0-9_]))"
    rf"|(?P<chinese>(?<=用户)[一二三四五六七八九](?=[一二两三四五六七八九半][兆千百点瓦kM])|"  # 用户六一兆二
    rf"(?!一点(?![零〇一二两三四五六七八九]))[几零〇一二两三四五六七八九十百千万亿半][零〇一二两三四五六七八九十百千万亿点半]*))"
)
_WORDS = deferred(rf"[{_LETTERS}]+(?:(?:[\s-]{{1,2}}|'|\s?(?:\.{{3}}|…)\s?)[{_LETTERS}]+){{0,11}}")
_WORD = deferred(rf"[{_LETTERS}]+")
_AND_PART = deferred(
    rf"(?i)(?:\s+(?:and\s+an?|y|et|und\s+ein)\s+(?P<part>{'|'.join(part for part in _PARTS if part.isalpha())})\b|"
    r"\s?(?P<sign>[½¼¾]))"
)
_OVER = deferred(r"/(?P<below>[1-9][0-9]?)(?![0-9/])(?:\s+(?:of\s+an?|de|d'un))?")
_VAGUELY = deferred(r"[来多余几]")
_GROUPED_AHEAD = deferred(  # "en bloques de four"
    rf"(?i)\b{any_word('figures', 'grouped', 'groups')}\s+{any_word('figures', 'grouped', 'joints')}\s+$"
)
_AS_FEW = deferred(rf"(?i)\b{any_word('figures', 'numbers', 'degrees')}\s+$")
NUMBERED = deferred(
    rf"(?i)\b{USER_NOUN}\s*(?:[0-9]{{1,2}}\s*(?:,|{any_word('figures', 'numbers', 'joins', 'ors')}|&|/)\s*)*$"
)
"""What stands before a number that names a user: "user ", "users 1 and "."""
_RANGED = deferred(rf"(?i)\b{USER_NOUN}\s*[0-9]{{1,2}}\s*(?:[–-]|{any_word('figures', 'users', 'to')})\s*$")
_EACH = "".join(f"(?<!{word} )" for word in words_of("figures", "users", "of_each"))
_NAMED = deferred(f"(?i){_EACH}{NUMBERED.pattern.removeprefix('(?i)')}")
_PLURAL = deferred(rf"(?i)\b{any_word('figures', 'users', 'plurals')}\s*$")
_BELOW_ZERO = deferred(r"(?i)(?<!al )(?<!lo )(?<!au )(?<!ou )\b(?:menos|moins)\s+$")

MOST_FIGURES = 40
_MOST_DIGITS = 200
_FIGURE = deferred(
    r"[0-9]+(?:[.,'][0-9]+)*|[零〇一二两三四五六七八九十百千万亿半几]+|"
    rf"\b(?:{'|'.join([*cardinals(2, 99), *listed('scales')])})\b"
)

_FOLDS = {**cardinals(2, 10), **listed("fold"), **listed("halves"), **listed("half_folds")}
_MANY = "(?:" + "|".join(sorted(_FOLDS, key=len, reverse=True)) + ")"
_CHINESE_FOLDS = table("figures", "zh")["folds"]
_TIMES_WORDS = any_word("figures", "numbers", "times")
_TIMES = Phrases(
    rf"\b(?P<named>{'|'.join(listed('fold'))})\b|\b(?P<german>doppelt)\w*|"
    rf"\b(?P<compound>{_MANY})(?:fach|mal)\w*|(?P<phrase>{any_word('figures', 'numbers', 'half_folds')})|"
    rf"\b(?P<word>{_MANY})[\s-]?{_TIMES_WORDS}\b|"
    rf"\b(?:compt\w+|val\w+|pes\w+|p[eè]s\w+|cuent\w+|cont\w+|counts?|counting|count|zähl\w+)\s+"
    rf"(?:(?:{any_word('figures', 'numbers', 'counted')}|[0-9]+)\s*){{0,4}}"
    rf"{any_word('figures', 'numbers', 'counts_as')}\s+(?P<counted>{_MANY})\b|"
    r"(?<![\w.])(?:x\s?(?P<x>[0-9]+(?:\.[0-9]+)?)(?![\w.])|(?P<n>[0-9]+(?:[.,][0-9]+)?)\s*"
    rf"(?:(?:{_TIMES_WORDS}|x|-fold)\b|-?fach\w*))|(?P<zhn>[0-9]+(?:\.[0-9]+)?)\s*倍|"
    rf"(?P<zhfold>{'|'.join(_CHINESE_FOLDS)})|"
    r"(?P<zh>[一二两三四五六七八九十](?:点[一二三四五六七八九])?)(?P<zhmore>[倍份]半?)"
)


@dataclass(frozen=True, kw_only=True)
class Number:
    """A number and where it stands; ``value`` is None where the amount is vague or not understood.

    ``form`` is "digits", "words" (English), "foreign" (words of another language) or "chinese".
    """

    value: Decimal | None
    start: int
    end: int
    form: str


@functools.lru_cache(maxsize=64)
def numbers(text: str, language: str = "") -> tuple[Number, ...]:
    """Every number in normalised text, from left to right, not overlapping; of the language that its words tell, or of
    the one given.

    >>> [number.value for number in numbers("siete", "es")]
    [Decimal('7')]
    """
    return tuple(_numbers(text, language or language_of(text)))


def _numbers(text: str, language: str) -> Iterator[Number]:
    own, position = "en" if language == "zh" else language, 0
    while match := _NUMBER.search(text, position):
        position = match.end()
        if match["digits"] and _is_list(text, match, language):
            for item in _ITEM.finditer(match["digits"]):
                start = match.start("digits") + item.start()
                yield Number(value=Decimal(item[0]), start=start, end=start + len(item[0]), form="digits")
            continue
        if match["word"]:
            number, spoken_in = _in_words(text, match, own)
            own = spoken_in if own == "en" else own  # "dix watts, pardon, douze"
        elif match["digits"] or match["fraction"]:
            number = _in_digits(text, match, language)
        else:
            number = _in_chinese(text, match)
        if number is not None:
            number = _qualified(text, match, number)
            position = max(number.end, match.start() + 1)
            yield number


def _is_list(text: str, match: re.Match[str], language: str) -> bool:
    """Whether digits are several numbers: "6,7,8", or "1,5" without a unit where a decimal has a point."""
    if _TIGHT_LIST.fullmatch(match["digits"]) is None or match.end() != match.end("digits"):
        return False
    several = match["digits"].count(",") > 1
    alone = unit_at(text, match.end()) is None and _GOES_ON.match(text, match.end()) is None
    return several or (language in ("en", "zh") and alone)


def too_many_figures(plain: str) -> bool:
    """Whether a normalised text holds more figures, users' numbers among them, or longer ones than a request can have.

    A pasted table or a log is refused before anybody reads it.

    >>> too_many_figures("users 1 to 40, 20 W"), too_many_figures("1 2 3 " * 20), too_many_figures("9" * 300)
    (False, True, True)
    """
    sizes = [match.end() - match.start() for match in _FIGURE.finditer(plain.lower())]
    return len(sizes) > MOST_FIGURES or sum(sizes) > _MOST_DIGITS


def and_part(text: str, position: int) -> tuple[Decimal, int] | None:
    """The half or quarter that follows a figure, "y medio", and where it ends."""
    match = _AND_PART.match(text, position)
    return (_PARTS[(match["part"] or match["sign"]).lower()], match.end()) if match is not None else None


def _is_name(text: str, start: int) -> bool:
    """Whether a number that begins here names a user."""
    return _NAMED.search(text, max(0, start - 40), start) is not None


def _qualified(text: str, match: re.Match[str], number: Number) -> Number:
    """The number without a value where it is vague, 三十来瓦, and below zero where a minus stands before it; words
    need a unit for that, and "menos" one of which it cannot mean "less".
    """
    unit = unit_at(text, number.end)
    if _VAGUELY.match(text, number.end) and unit_at(text, number.end + 1) is not None:
        return replace(number, value=None, end=number.end + 1)
    minus = match["minus"] and (unit is not None or not match["word"])
    if not minus and _BELOW_ZERO.search(text, max(0, number.start - 12), number.start):
        minus = unit is not None and unit.level_dbm is not None
    if not minus or number.value is None:
        return number
    return replace(number, value=-number.value, start=match.start())


def _in_digits(text: str, match: re.Match[str], language: str) -> Number:
    group = "digits" if match["digits"] else "fraction"
    digits, start, end = match[group], match.start(group), match.end()
    is_name = _is_name(text, start)
    ranged = _RANGED.search(text, max(0, start - 40), start) is not None  # "users 1 to 4 500 kbit/s"
    if " " in digits and (is_name or ranged):
        digits = digits.split(" ")[0]  # "UE 2 750 kbit/s": a name, then a figure
        return Number(value=Decimal(digits), start=start, end=start + len(digits), form="digits")
    value = _PARTS.get(digits) or _digits_value(digits, language)
    if value is None:
        return Number(value=None, start=start, end=end, form="digits")
    if match["exponent"]:
        value = value.scaleb(int(match["exponent"]))
    if match["scale"]:
        scale = match["scale"].lower().removesuffix("d'").removesuffix("de").strip()
        value *= _SCALES.get(scale) or math.prod(_CHINESE_SCALES[letter] for letter in scale)
    over, part = _OVER.match(text, end), and_part(text, end)
    if over is not None and unit_at(text, over.end()) is not None:
        value, end = value / int(over["below"]), over.end()
    elif part is not None and not is_name and unit_at(text, part[1]) is not None:
        value, end = value + part[0], part[1]
    return Number(value=value, start=start, end=end, form="digits")


def _digits_value(digits: str, language: str) -> Decimal | None:
    """The value of digits; what a single mark before three of them means depends on the language."""
    least = {"'": 1, ",": 2 if language in ("de", "fr") else 1, ".": 1 if language in ("es", "de") else 2}
    for mark, groups in least.items():
        if re.match(rf"[1-9][0-9]{{0,2}}(?:[{mark}][0-9]{{3}}){{{groups},}}(?![0-9])", digits):
            digits = digits.replace(mark, "")
    if len(re.findall(r"[.,]", digits)) > 1:
        return None  # "1,23,456": what the marks mean is anybody's guess
    return Decimal(digits.replace(" ", "").replace(",", "."))


def _in_words(text: str, match: re.Match[str], own: str) -> tuple[Number | None, str]:
    """The number that begins with a word, in this language or in another where a unit follows; and its language."""
    word = match["word"]
    for language in sorted(languages_of(word), key=lambda language: language != own):
        run = _WORDS.match(text, match.start("word"))
        assert run is not None
        places = list(_WORD.finditer(run.group()))
        said = spoken([place.group() for place in places], language)
        if said is None:
            continue
        number = _placed(text, match, said, places, language)
        if number is None:
            continue
        measured = unit_at(text, number.end) is not None or _GROUPED_AHEAD.search(text, 0, number.start) is not None
        alone = text[number.start : number.end].lower() == "eines" if said.is_article else said.value is not None
        if (language == own and alone) or (measured and not (said.is_article and language == "en" != own)):
            return number, language
    return None, own


def _placed(text: str, match: re.Match[str], said: Spoken, places: list[re.Match[str]], language: str) -> Number | None:
    start, form = match.start("word"), "words" if language == "en" else "foreign"
    if said.value is None and _AS_FEW.search(text, max(0, start - 8), start):
        return None  # "as few watts as possible"
    end, linked = start + places[said.words - 1].end(), start + places[said.linked - 1].end()
    if linked > end and unit_at(text, linked) is not None:
        end = linked
    is_name = said.words > 1 and _is_name(text, start) and _PLURAL.search(text, max(0, start - 40), start) is None
    if is_name and unit_at(text, end) is not None:
        first = spoken([places[0].group()], language)  # "user one hundred kilobits": a name, then a figure
        return first and Number(value=first.value, start=start, end=start + places[0].end(), form=form)
    return Number(value=said.value, start=start, end=end, form=form)


def _in_chinese(text: str, match: re.Match[str]) -> Number:
    numeral, end = match["chinese"], match.end()
    value = chinese_value(numeral)
    if value is None and numeral.endswith("千"):
        value, end = chinese_value(numeral[:-1]), end - 1  # 一百二十八千比特: 千比特 is the unit
    return Number(value=value, start=match.start("chinese"), end=end, form="chinese")


def chinese_value(numeral: str) -> Decimal | None:
    """The value of a Chinese numeral, colloquial endings included; None where it is not one.

    >>> chinese_value("一百零五"), chinese_value("一千五"), chinese_value("三点五"), chinese_value("半")
    (Decimal('105'), Decimal('1500'), Decimal('3.5'), Decimal('0.5'))
    """
    if numeral == "半":
        return _HALF
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
        elif _CHINESE_SCALES[letter] < 10**4:
            if previous in _CHINESE_DIGITS and section and _CHINESE_SCALES[letter] >= lowest:
                return None  # 一百零五千: 5100, or 105 kilo-?
            scale = lowest = _CHINESE_SCALES[letter]
            multiplies = previous in _CHINESE_SCALES  # 三百千: three hundred kilo-
            section, digit = section * scale if multiplies else section + (digit or 1) * scale, 0
            scale //= 10
        else:
            scale = _CHINESE_SCALES[letter]
            total, section, digit, lowest = total + (section + digit or 1) * scale, 0, 0, scale
            scale //= 10
        previous = letter
    value = Decimal(total + section + digit * max(scale, 1))
    return value + Decimal("0." + "".join(str(_CHINESE_DIGITS[c]) for c in fraction)) if fraction else value


def factors(plain: str) -> Iterator[Number]:
    """The words of a normalised text that multiply, from left to right, as numbers of the form "times".

    >>> [(factor.value, factor.start) for factor in factors("user 3 counts twice")]
    [(Decimal('2'), 14)]
    """
    for match in _TIMES.finditer(plain):
        group = "zh" if match["zh"] else match.lastgroup or ""
        word = " ".join(match[group].split())
        if group in ("n", "x", "zhn"):
            value = Decimal(word.replace(",", "."))
        elif group == "zh":
            value = chinese_value(word)
            if value is not None and match["zhmore"].endswith("半"):
                value += _HALF
        else:
            value = Decimal((_CHINESE_FOLDS if group == "zhfold" else _FOLDS)[word])
        if value is not None:
            start = match.start(group) if group == "counted" else match.start()
            yield Number(value=value, start=start, end=match.end(), form="times")

"""Numbers in words, by one grammar with a table for each language (``figures``): "forty-five hundred", "eineinhalb".

What adds (twenty, five), what multiplies (hundred, million) and what divides (half, quarter) is all that a table says;
each word added must fit into the room that the one before leaves, so that "two three" and "vingt cinquante" are no
numbers. Vague amounts ("a few hundred", "quelques", "una treintena") are numbers without a value.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from wirelessagent.language.word_tables import table

_PLAIN = str.maketrans("áàâäéèêëíîïóôöúùûüñç", "aaaaeeeeiiiooouuuunc")
_GERMAN_PLAIN = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_ONE, _HALF = Decimal(1), Decimal("0.5")


def plain_word(word: str, language: str) -> str:
    """A word as the tables spell it: small letters, no accents; German umlauts as two letters."""
    return word.lower().translate(_GERMAN_PLAIN if language == "de" else _PLAIN)


def _values(language: str) -> dict[str, int]:
    """The words that mean a whole number, as they are spelt."""
    words = table("figures", language)["numbers"]
    counted = ((words["ones"], 0, 1), (words["tens"], 20, 10))
    return {word: start + step * i for each, start, step in counted for i, word in enumerate(each)} | words["values"]


class _Grammar:
    """The number words of a language, without accents: what each adds, multiplies by or takes a part of."""

    def __init__(self, language: str) -> None:
        words = table("figures", language)["numbers"]
        plain = functools.partial(plain_word, language=language)
        self.values = {plain(word): value for word, value in _values(language).items()}
        self.scales: dict[str, int] = {plain(word): value for word, value in words["scales"].items()}
        self.parts = {plain(word): Decimal(str(value)) for word, value in words["parts"].items()}
        self.articles, self.joins, self.points, self.links, self.vague, self.dozens = (
            frozenset(map(plain, words[name])) for name in ("articles", "joins", "points", "links", "vague", "dozens")
        )
        ordinals = set(map(plain, words["ordinals"])) - set(map(plain, words.get("alone", ())))
        self.alone = self.parts.keys() - ordinals  # "half", but "a third"
        self.beginnings = self.alone.union(
            self.values, self.scales, self.vague, self.articles, self.dozens, self.points
        )
        self.linking = self.parts.keys() | self.scales.keys() | self.dozens


LANGUAGES = ("en", "es", "fr", "de")
_GRAMMARS = {language: _Grammar(language) for language in LANGUAGES}
# What stresses an article, which is then a number: "a full megabit", "un seul".
_STRESS = frozenset(word for language in LANGUAGES for word in table("figures", language)["numbers"]["stress"])

_GERMAN_TENS = {word: value for word, value in _GRAMMARS["de"].values.items() if value >= 20}
_GERMAN_ONES = {
    word: value
    for word, value in _GRAMMARS["de"].values.items()
    if value < 20 and word not in table("figures", "de")["numbers"]["articles"][1:]
}
_GERMAN_BELOW_100 = {
    **_GERMAN_ONES, **_GERMAN_TENS, **dict.fromkeys(("anderthalb", "anderthalbe", "anderthalbes"), Decimal("1.5")),
    **{
        f"{one}und{ten}": ones + tens
        for one, ones in _GERMAN_ONES.items() for ten, tens in _GERMAN_TENS.items() if ones < 10
    },
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Spoken:
    """A number that begins a list of words: its value, how many words it takes, and how many with "of a" behind it."""

    value: Decimal | None
    words: int
    linked: int
    is_article: bool


@functools.cache
def listed(name: str, section: str = "numbers") -> Mapping[str, Decimal]:
    """The words of all languages that stand for a number, as they are spelt, by a list of their tables.

    >>> listed("ordinals")["fifth"], listed("scales")["tausend"], listed("fold")["twice"]
    (Decimal('5'), Decimal('1000'), Decimal('2'))
    """
    tables = [table("figures", language)[section].get(name, {}) for language in LANGUAGES]
    return {word: Decimal(str(value)) for words in tables for word, value in words.items()}


def cardinals(least: int, most: int, languages: Sequence[str] = LANGUAGES) -> Mapping[str, int]:
    """The single words that mean a whole number from ``least`` to ``most`` and are no articles, as they are spelt.

    >>> cardinals(2, 3, ("fr", "de"))
    {'deux': 2, 'trois': 3, 'zwei': 2, 'drei': 3, 'zwo': 2}
    """
    return {
        word: value
        for language in languages
        for word, value in _values(language).items()
        if least <= value <= most and word not in table("figures", language)["numbers"]["articles"]
    }


def tens_and_ones() -> str:
    """A pattern of numbers from 21 to 99 that are said by two words or a compound: "twenty-one", "treinta y uno"."""

    def either(language: str, least: int, most: int) -> str:
        return "|".join(cardinals(least, most, (language,)))

    between = {"en": "[ -]", "es": " y ", "fr": "(?:-| et |-et-| )"}
    said = [f"(?:{either(each, 20, 90)}){joint}(?:{either(each, 1, 19)}|une?)" for each, joint in between.items()]
    return "|".join([*said, f"(?:ein|{either('de', 1, 9)})und(?:{either('de', 20, 90)})"])


def whole(word: str) -> int | None:
    """The value of a whole number in words, whatever their language; None where they say none.

    >>> whole("twenty-one"), whole("treinta y uno"), whole("siebenundzwanzig"), whole("a few")
    (21, 31, 27, None)
    """
    words = word.replace("-", " ").split()
    for language in languages_of(words[0]) if words else ():
        said = spoken(words, language)
        if said is not None and said.words == len(words) and said.value is not None and said.value % 1 == 0:
            return int(said.value)
    return None


@functools.lru_cache(maxsize=4096)
def languages_of(word: str) -> tuple[str, ...]:
    """The languages in which a number may begin with a word.

    >>> languages_of("six"), languages_of("vatios")
    (('en', 'fr'), ())
    """
    spelt = {language: plain_word(word, language) for language in LANGUAGES}
    known = {language for language, plain in spelt.items() if plain in _GRAMMARS[language].beginnings}
    return tuple(each for each in spelt if each in known or (each == "de" and german_value(spelt[each]) is not None))


def spoken(words: Sequence[str], language: str) -> Spoken | None:
    """The number that a list of words begins with; None where it begins with none.

    >>> spoken("three hundred and fifty watts".split(), "en").value, spoken(["siebzehneinhalb"], "de").value
    (Decimal('350'), Decimal('17.5'))
    """
    return _Reader([plain_word(word, language) for word in words], language).read()


@functools.lru_cache(maxsize=512)
def german_value(word: str) -> Decimal | None:
    """The value of a German number in one word, umlauts as two letters; None where it is none.

    >>> german_value("siebenundzwanzig"), german_value("hunderttausend"), german_value("anderthalb")
    (Decimal('27'), Decimal('100000'), Decimal('1.5'))
    """
    if word.endswith("einhalb"):
        whole = german_value(word.removesuffix("einhalb"))
        return None if whole is None else whole + _HALF
    for name, scale in (("tausend", 1000), ("hundert", 100)):
        left, found, right = word.partition(name)
        if found:
            times, rest = german_value(left or "ein"), german_value(right.removeprefix("und") or "null")
            if times is None or rest is None or times >= 1000 or rest >= scale:
                return None
            return times * scale + rest
    value = _GERMAN_BELOW_100.get(word)
    return None if value is None else Decimal(value)


class _Reader:
    """One reading of a list of words from its beginning."""

    def __init__(self, words: Sequence[str], language: str) -> None:
        self._words, self._language, self._grammar = words, language, _GRAMMARS[language]
        self._place = 0

    def read(self) -> Spoken | None:
        if self._is_vague():
            return self._result(None, linked=True)
        value = self._cardinal()
        is_article = self._place == 1 and self._words[0] in self._grammar.articles
        if is_article and self._word() in _STRESS:
            self._place, is_article = self._place + 1, False
        value, linked = self._decimals(value), False
        value = self._with_parts(value)
        if value is None:
            return None
        if self._place > 1 or not is_article:
            linked = self._words[self._place - 1] in self._grammar.linking
        value, linked = self._scaled(value, linked=linked)
        return self._result(value, linked=linked, is_article=is_article and self._place == 1)

    def _result(self, value: Decimal | None, *, linked: bool, is_article: bool = False) -> Spoken:
        end = self._place + (self._links() if linked else 0)
        return Spoken(value=value, words=self._place, linked=end, is_article=is_article)

    def _links(self) -> int:
        """How many words stand here that link a part with its unit: "of a"."""
        ahead = 0
        while self._word(ahead) in self._grammar.links:
            ahead += 1
        return ahead

    def _word(self, ahead: int = 0) -> str:
        place = self._place + ahead
        return self._words[place] if place < len(self._words) else ""

    def _value(self, word: str) -> Decimal | None:
        if word in self._grammar.values:
            return Decimal(self._grammar.values[word])
        return german_value(word) if self._language == "de" else None

    def _is_vague(self) -> bool:
        """Step over a vague amount, the numbers that it makes vague included: "a few hundred"."""
        first = 1 if self._word() in self._grammar.articles else 0
        if self._word(first) not in self._grammar.vague:
            return False
        self._place = first
        while self._word() in self._grammar.vague or self._word() in self._grammar.scales:
            self._place += 1
        return True

    def _cardinal(self) -> Decimal | None:
        total, room, outer = Decimal(0), Decimal(0), Decimal(10**12)
        group: Decimal | None = None
        start = self._place
        while word := self._word():
            value = self._value(word)
            scale, times = self._grammar.scales.get(word, 0), _ONE if group is None else group
            if value is None and word in self._grammar.articles and self._place == start:
                value = _ONE
            if value is not None and self._fits(value, group, room, outer):
                group, room = (group or Decimal(0)) + value, self._room(value)
            elif group is not None and self._language == "fr" and word in ("vingt", "vingts") and group % 10 == 4:
                group, room = group + 76, Decimal(20)
            elif word in self._grammar.dozens and not total and times < 100:
                self._place += 1
                return times * 12
            elif scale == 100 and 0 < times < 100:
                group, room = times * 100, Decimal(100)
            elif 100 < scale < outer and times != 0:
                outer = Decimal(scale)
                total, group = total + times * outer, None
            elif word in self._grammar.joins and self._joins(group, room, outer if total else None):
                pass
            else:
                break
            self._place += 1
        return None if self._place == start else total + (group or 0)

    def _fits(self, value: Decimal, group: Decimal | None, room: Decimal, outer: Decimal) -> bool:
        if group is None:
            return value < outer
        if self._language == "fr" and self._words[self._place - 1] == "dix" and value < 7:
            return False  # "dix-sept", but not "dix deux"
        return 0 < value < room and group + value < outer

    def _room(self, value: Decimal) -> Decimal:
        """What may still be added after a word: less than ten after "twenty", nothing after "five"."""
        if self._language == "de" or value == 0:
            return Decimal(0)
        if value % 100 == 0:
            return Decimal(100)
        if self._language == "fr" and value == 60:
            return Decimal(20)
        ten_takes = self._language == "fr" and value == 10
        return Decimal(10) if value % 10 == 0 and (value >= 20 or ten_takes) else Decimal(0)

    def _joins(self, group: Decimal | None, room: Decimal, outer: Decimal | None) -> bool:
        """Whether "and" stands inside the number: after hundreds in English, after tens in Spanish and French."""
        value = self._value(self._word(1))
        if value is None or self._language == "de" or self._is_part(2):
            return False
        if self._language == "en":
            return value < 100 and (room == 100 if group is not None else outer is not None)
        able = value in (1, 11) if self._language == "fr" else value > 0  # "vingt et un", not "vingt et huit cents"
        return group is not None and room in (10, 20) and able and value < room

    def _is_part(self, ahead: int) -> bool:
        return self._word(ahead) in self._grammar.parts

    def _decimals(self, whole: Decimal | None) -> Decimal | None:
        """The value with what follows a spoken point: "two point five", "dos coma veinticinco"."""
        if self._word() not in self._grammar.points or self._value(self._word(1)) is None:
            return whole
        self._place += 1
        digits = ""
        while (value := self._value(self._word())) is not None and value < 10 and value == int(value):
            digits += str(value)
            self._place += 1
        if not digits:
            value = self._cardinal()
            digits = str(value) if value is not None and value == int(value) else ""
        return (whole or 0) + Decimal(f"0.{digits or 0}")

    def _with_parts(self, value: Decimal | None) -> Decimal | None:
        """The value with its halves and quarters: "three quarters", "two and a half"."""
        if self._is_part(0) and (value is not None or self._word() in self._grammar.alone):
            share = self._grammar.parts[self._word()]
            if self._language == "es" and (value or 0) > 1 and self._word() in ("medio", "media"):
                return value  # "al dos medio mega"
            self._place += 1
            return share if value is None else value * share
        if value is None or self._word() not in self._grammar.joins:
            return value
        count = self._word(1)
        is_part = count in self._grammar.parts
        times = _ONE if is_part or count in self._grammar.articles else self._value(count)
        ahead = 1 if is_part else 2
        if times is None or not self._is_part(ahead):
            return value
        self._place += ahead + 1
        return value + times * self._grammar.parts[self._word(-1)]

    def _scaled(self, value: Decimal, *, linked: bool) -> tuple[Decimal, bool]:
        """The value times a scale behind it: "half a million", "two and a half thousand", "half a dozen"."""
        ahead = self._links() if linked else 0
        word = self._word(ahead)
        scale = 12 if word in self._grammar.dozens else self._grammar.scales.get(word)
        if scale is None or (value == int(value) and not linked):
            return value, linked
        self._place += ahead + 1
        return value * scale, True

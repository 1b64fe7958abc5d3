"""The anchors of a line: its figures, shares, numbers and users, with the words between them."""

from __future__ import annotations

import functools
import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias, cast

from wirelessagent.language.mentions import JOINT, ORDINALS, mentions
from wirelessagent.language.moods import named_in
from wirelessagent.language.numerals import Number, and_part, factors, numbers
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.request import numbered
from wirelessagent.language.text import WORD, Span, is_chinese, lowered, normalise, overlaps, unaccented
from wirelessagent.language.word_tables import deferred, table

AnchorKind: TypeAlias = Literal[
    "rate", "power", "ratio", "factor", "number", "users", "ordinal", "others", "everybody", "pronoun"
]

FIGURES = ("rate", "power", "ratio", "factor", "number")
_SCALE = re.compile(r"[kKMG](?![^\W_])")
_DECIBEL = deferred(r"(?i)\s*(?:db(?![a-z\d])|decibel(?:io)?s?(?!\w)|dezibel(?!\w)|décibels?(?!\w)|分贝)")
_MOST_DECIBELS = 100.0
_SCALES = {"K": 1e3, "M": 1e6, "G": 1e9}
_ORDINALS = {unaccented(word): place for word, place in ORDINALS.items() if word.isalpha()}
_WITH = deferred("[跟和与]")
_QUOTIENT = deferred(r"(?<![\d.,/])([1-9])\s?/\s?(1\d|[2-9])(?![\d/]|[.,]\d)")
_INTEGER = deferred(r"(?<![\d.,])\d{1,4}(?![\d.,]*\d)")
_LARGEST_NUMBER = 1e4
"""From where on a number without a unit is a rate."""
_WORD = deferred(rf"{WORD}|[^\w\s]")


@dataclass(frozen=True, eq=False)
class Anchor:
    """A part of a line at characters [start, end): a figure in SI units or without one, or ``users``."""

    kind: AnchorKind
    start: int
    end: int
    value: float = 0.0
    users: tuple[str, ...] = ()
    is_bounded: bool = False
    """Whether the line says that it is a bound: "at most 5 W"."""
    is_negative: bool = False

    @property
    def whom(self) -> tuple[str, ...]:
        """The users whom it names, or whom its number may name."""
        return self.users or ((f"{self.value:g}",) if self.kind == "number" else ())


@dataclass(frozen=True, kw_only=True)
class Anchored:
    """A line as its anchors and its words.

    Attributes:
        plain: the normalised text.
        anchors: from left to right.
        others: what parts of them may be as well: a user and a figure in "user 2 to 5".
        words: in lower case and without accents, anchors as "@rate", "@users" and so on.
        places: of each anchor among the words; a pronoun is a word.
        becoming: figures to which the words lead, or that bound: "down to a third" is no third less.
    """

    plain: str
    anchors: tuple[Anchor, ...]
    others: tuple[Anchor, ...]
    words: tuple[str, ...]
    places: Mapping[Anchor, int]
    becoming: frozenset[Anchor]

    @classmethod
    def of(cls, text: str, language: str, names: Sequence[str]) -> Anchored:
        """The line of a text in a language, in a cell of users with these names."""
        plain = normalise(text)
        found = (each for each in _anchors(text, plain, language, names) if math.isfinite(each.value))
        anchors = tuple(sorted(found, key=lambda anchor: (anchor.start, -anchor.end)))
        words, places, begin = list[str](), dict[Anchor, int](), 0
        for anchor in anchors:
            if anchor.kind == "pronoun" or anchor.start < begin:
                continue
            words += _words(plain, begin, anchor.start)
            places[anchor] = len(words)
            words.append(f"@{anchor.kind}")
            begin = anchor.end
        words += _words(plain, begin, len(plain))
        leads = {*table("figures", language)["becoming"]["words"]}
        becoming = frozenset(anchor for anchor, place in places.items()
                             if anchor.is_bounded or (place and words[place - 1] in leads))  # fmt: skip
        others = tuple(part for anchor in anchors for part in _parts(plain, anchor, len(names)))
        holding = ((part, anchor) for part in others for anchor in places if anchor.start <= part.start < anchor.end)
        places |= {part: places[anchor] for part, anchor in holding}
        return cls(plain=plain, anchors=anchors, others=others, words=tuple(words), places=places, becoming=becoming)

    @property
    def figures(self) -> list[Anchor]:
        return [anchor for anchor in (*self.anchors, *self.others) if anchor.kind in FIGURES]

    def groups(self, most: int) -> Iterator[tuple[tuple[str, ...], tuple[Anchor, ...]]]:
        """The users who are named alone, in a list, in a range, or as two; a number up to ``most`` may be a user."""
        named, parts = ([anchor for anchor in each if anchor.users or _counts(anchor, most)]
                        for each in (self.anchors, self.others))  # fmt: skip
        yield from ((anchor.whom, (anchor,)) for anchor in (*named, *parts))
        for run in _lists(self.plain, named):
            for begin, end in itertools.combinations(range(len(run)), 2):
                yield _together(run[begin : end + 1])
        for one, other in itertools.pairwise(named):
            first, last = (int(users[0]) if users[0].isdecimal() else 0 for users in (one.whom, other.whom))
            alone = len(one.whom) == len(other.whom) == 1
            if alone and 0 < first < last <= most and _RANGE.fullmatch(self.plain, one.end, other.start):
                yield tuple(str(user) for user in range(first, last + 1)), (one, other)
        if len(named) == 2 and JOINT.fullmatch(self.plain, named[0].end, named[1].start) is None:
            yield _together(named)

    def named(self, most: int) -> tuple[str, ...]:
        """Whoever is named, by numbers alone where nobody is by more."""
        users = [user for anchor in self.anchors if anchor.kind == "users" for user in anchor.users]
        alone = [f"{anchor.value:g}" for anchor in self.anchors if _counts(anchor, most)]
        return tuple(dict.fromkeys(users or alone))


_RANGE = deferred(r"(?i)\s*(?:-|–|~|\.{2,}|to|thru|through|bis|à|al?|到|至)\s*(?:(?:la|le|el|zur?)\s+)?")
_SEVERAL = deferred(r"(?i)[a-zé]+s\b")  # "users 1 to 4" are no user 1


def _parts(plain: str, anchor: Anchor, most: int) -> Iterator[Anchor]:
    """What parts of an anchor may be: "user 2 to 5" a user and a figure, "le 3 à 2 W" the same, "1 auf 10" figures.

    A user whom the cell does not have may be a figure: "all users 700".
    """
    found = _INTEGER.finditer(plain, anchor.start, anchor.end)
    digits = [(each.start(), each.end(), int(each[0])) for each in found]
    range_of_one = anchor.kind == "users" and len(digits) == 2 and _SEVERAL.match(plain, anchor.start) is None
    if range_of_one and _RANGE.fullmatch(plain, digits[0][1], digits[1][0]):
        (_, middle, user), (start, end, value) = digits
        yield Anchor("users", anchor.start, middle, users=(str(user),))
        yield Anchor("number", start, end, float(value))
    elif anchor.kind == "users" and len(digits) == len(anchor.users) == 1 and digits[0][2] > most:
        yield Anchor("number", *digits[0][:2], float(digits[0][2]))
    elif len(digits) == 2 and (
        (anchor.kind == "ratio" and "%" not in plain[anchor.start : anchor.end])
        or (anchor.kind == "number" and plain[digits[0][1]] == " ")  # "4 900"
    ):
        yield from (Anchor("number", start, end, float(value)) for start, end, value in digits)
    elif anchor.kind in ("rate", "power") and len(digits) == 1 and plain[anchor.start : anchor.end].isdecimal():
        yield Anchor("number", anchor.start, anchor.end, float(digits[0][2]))


def _words(plain: str, begin: int, end: int) -> list[str]:
    return [unaccented(word[0].lower()) or word[0] for word in _WORD.finditer(plain, begin, end)]


def _counts(anchor: Anchor, most: int) -> bool:
    return anchor.kind == "number" and anchor.value in range(1, most + 1)


def _together(named: Sequence[Anchor]) -> tuple[tuple[str, ...], tuple[Anchor, ...]]:
    return tuple(dict.fromkeys(user for anchor in named for user in anchor.whom)), tuple(named)


def _lists(plain: str, named: Sequence[Anchor]) -> list[list[Anchor]]:
    """The runs of users that only joints part."""
    runs = list[list[Anchor]]()
    for anchor in named:
        if runs and JOINT.fullmatch(plain, runs[-1][-1].end, anchor.start) is not None:
            runs[-1].append(anchor)
        else:
            runs.append([anchor])
    return runs


def _anchors(text: str, plain: str, language: str, names: Sequence[str]) -> Iterator[Anchor]:
    taken = list[Span]()
    for figure in parse_quantities(text):
        if figure.kind in ("rate", "power", "ratio"):
            taken.append((figure.start, figure.end))
            said = plain[figure.phrase_start : figure.start] + plain[figure.end : figure.phrase_end]
            bounded = figure.comparator is not None and figure.value > 0 and not named_in(said)  # and no "limit"
            yield Anchor(figure.kind, figure.start, figure.end, abs(figure.value), is_bounded=bounded,
                         is_negative=figure.value < 0)  # fmt: skip
    for mention in mentions(plain, names, taken):
        if mention.role != "pronoun":
            taken.append((mention.start, mention.end))
        kind: AnchorKind = "users" if mention.role == "named" else mention.role
        users, joint = tuple(map(numbered, mention.users)), _WITH.search(plain, mention.start, mention.end)
        if joint is not None and len(users) == 2:  # "5号跟3号一样"
            yield Anchor(kind, mention.start, joint.start(), users=users[:1])
            yield Anchor(kind, joint.end(), mention.end, users=users[1:])
        else:
            yield Anchor(kind, mention.start, mention.end, users=users)
    low = "".join(unaccented(letter)[:1] or letter for letter in plain.lower())
    shares, pattern = _shares(language)
    found = [(share.start(), share.end(), shares[share[0]]) for share in pattern.finditer(low)]
    found += [(each.start, each.end, float(each.value)) for each in factors(low) if each.value is not None]
    accented = numbers(lowered(plain), language)  # "fünf" has its accent
    counted = [_with_its_part(low, each) for each in accented if each.value is not None]
    for start, end, value in found:
        part = any(first < start and end <= last and number >= 1 for first, last, number in counted)
        if not part and not overlaps((start, end), taken):  # "two and a half"
            taken.append((start, end))
            yield Anchor("factor", start, end, abs(value))
    for each in _QUOTIENT.finditer(low):  # "3/4", or users 3 and 4
        if not overlaps(each.span(), taken):
            yield Anchor("factor", *each.span(), int(each[1]) / int(each[2]))
    for word in _WORD.finditer(low):
        place = _ORDINALS.get(word[0])
        if place is not None and not overlaps(word.span(), taken):  # "the third"
            taken.append(word.span())
            yield Anchor("ordinal", *word.span(), users=(place,))
    for start, end, signed in counted:
        value, scale, decibel = abs(signed), _SCALE.match(plain, end), _DECIBEL.match(plain, end)
        if overlaps((start, end), taken) or (decibel is not None and value > _MOST_DECIBELS):
            continue
        if decibel is not None:  # "3 dB less"
            yield Anchor("factor", start, decibel.end(), 10 ** (signed / 10))
        elif value < 1 and not low[start].isdigit():  # "a quarter"
            yield Anchor("factor", start, end, value)
        else:
            value *= 1.0 if scale is None else _SCALES[scale[0].upper()]
            is_rate = scale is not None or value >= _LARGEST_NUMBER
            yield Anchor("rate" if is_rate else "number", start, end if scale is None else scale.end(), value)


def _with_its_part(low: str, number: Number) -> tuple[int, int, float]:
    """Where a number stands, and its value: "11 y medio" is one."""
    part = and_part(low, number.end)
    value = float(number.value or 0)
    return (number.start, number.end, value) if part is None else (number.start, part[1], value + float(part[0]))


@functools.cache
def _shares(language: str) -> tuple[Mapping[str, float], re.Pattern[str]]:
    """Words for shares and multiples with what they are worth, and the pattern that finds them."""
    listed = cast("dict[str, float]", table("figures", language)["shares"])
    shares = {own: share for word, share in listed.items() for own in (word, unaccented(word))}
    parts = (rf"(?<!\w){re.escape(word)}(?!\w)" if not is_chinese(word) else re.escape(word)
             for word in sorted(shares, key=len, reverse=True))  # fmt: skip
    return shares, re.compile("|".join(parts))

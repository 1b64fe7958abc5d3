"""What a sentence states: its constraints, the words that each came from, and what is in doubt.

What it says of the whole cell in words is read here: blocks ("in pairs"), shares of the power ("half"), how many users.
Counts describe the channel where all users are meant ("for our 8 users"); a part of the users, and a half of something,
raise a doubt.

So does a number that no rule has read, because a figure that is dropped is a wish ignored: every digit, fraction and
superscript is either part of a quantity, of a count that describes the cell, of a name ("P1", "5G") or left over
("10^5", "3 dB", "10 joules"). The same holds for number words that cannot be mere idiom ("half of", "ten volts"; not
"a", "one", "十分").
"""

from __future__ import annotations

import functools
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from typing import NamedTuple

from wirelessagent.language.comparators import Comparison, comparison
from wirelessagent.language.intent import Constraint
from wirelessagent.language.mentions import BY_PLACE, PLACED, listed_users
from wirelessagent.language.moods import named_in
from wirelessagent.language.number_words import cardinals, german_value, plain_word
from wirelessagent.language.numerals import Number, factors, numbers
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.shares import OF_SOMEBODY
from wirelessagent.language.text import Beside, Phrases, Span, clause_end, clause_start, is_chinese, is_within, overlaps
from wirelessagent.language.units import unit_at
from wirelessagent.language.word_tables import deferred, either, languages_with, table, words_of

# Generations, picture sizes and the like: they look like figures and describe.
_NAMES = deferred(
    r"(?i)(?<![A-Za-z0-9.])(?:[2-6]G|[248]K|(?:720|1080|1440|2160)p|wi-?fi\s?[4-7]|24/7)(?![A-Za-z0-9])"
    r"(?!\s*(?:each|per|apiece|every|for (?:each|every))\b)"
)
_SPELL, _MONTH = (
    rf"(?:{'|'.join(words_of('figures', 'times', name))})(?![A-Za-zÀ-ÿ{end}])"
    for name, end in (("units", "/"), ("months", ""))
)
_TIMES = Phrases(
    rf"(?<![\w.,])[0-9]{{1,3}}(?::[0-9]{{2}}|[.,]5)?\s?{_SPELL}|(?<![\w.,])[0-9]{{1,2}}[:：][0-9]{{2}}(?![0-9])|"
    rf"(?<![\w.,])[0-9]{{1,2}}(?:\.|st|nd|rd|th|er)?\s+(?:de\s+|of\s+)?{_MONTH}|"
    r"(?<![\w.,])(?:19|20)[0-9]{2}(?=\s*(?:$|[,.;:!?)]|年))|"
    rf"(?:{either('figures', 'times', 'from')}) [0-9]{{1,2}}"
    rf"(?=(?: h)? (?:{either('figures', 'times', 'to')}) [0-9]{{1,2}}\s?{_SPELL})|{either('figures', 'times', 'said')}"
)
_VAGUE = deferred(
    r"(?i)(?<!as )\b(?:few|several|couple|handful|pair|dozens?|hundreds|thousands|some|lots|plenty|"
    r"(?<=a )number)\s+(?:of\s+)?"
)
_SETS_A_LIMIT = deferred(rf"(?i)(?:{either('figures', 'bounds', 'names')}|[=:<>≤≥])\s*$")
_UNIT_OF_ANOTHER_KIND = deferred(
    r"(?i)\s?(?:[kMG](?![^\W\d_])|dB|J|[km]?A|joules?|julios?|amps?|amperes?|decibels?)(?![^\W\d_])|\s*[千兆毫]?(?:焦|安培|分贝)"
)
_BEGINS = deferred(r"(?i)(?:^|[,;:.!?\uff0c\uff1b。])\s*(?:with|at|on|con|a|avec|à|mit|bei|用)?\s*$|\bwith\s+$")
_ENDS = deferred(r"\s*(?:$|[,;:.!?\uff0c\uff1b。])")
_ELECTRIC = r"[km]?V|volts?|voltios?|[km]?Wh|[kMG]?Hz|hertz"
_RATING = deferred(  # what a device has, and a limit only where nothing else is said; abbreviations, "43 dbx"
    r"\s?-?(?:(?![A-Z]{1,4}s\b)(?i:[bcdfghjklmnpqrstvwxz]{2,5})|"
    rf"(?i:{_ELECTRIC}|(?:kilo|mega|giga)hertz))(?![^\W\d_])|\s*[千兆毫]?(?:伏|赫)"
)
FOREIGN_UNIT = deferred(  # no user's number stands before one
    rf"(?i)\s?-?(?:{_ELECTRIC}|(?-i:[km]?A)|J|joules?|julios?|dB|°|[kMGT]?B|bits?|bytes?|"
    r"kilo\w+|mega\w+|giga\w+|cm|mm|km|m²|ms|s|secs?|se[cg]\w{3,6}|sekunden?|min|minut\w+|h|grad|degrees?|percent)"
    r"(?![^\W\d_])"
)
_WHOLE = deferred(r"[0-9]+")
_IDIOMS = frozenset(words_of("figures", "numbers", "idioms"))
POWER_NOUNS = "|".join(words_of("figures", "shared", "power"))
_OF_POWER = deferred(rf"(?i)[\s-](?:{POWER_NOUNS})\b")  # "halbe Leistung"
_CHINESE_FIGURE = deferred(r"[二三四五六七八九]|十(?!分)|两(?=\s*[个名位台倍])")
_TO_THE_RIGHT = deferred(r"[^\s,;:!?\uff0c\uff1b。、)]*(?:\s*[\^*×·/+÷x]\s*[^\s,;]+)*(?:\s?(?:of\s+)?[A-Za-zμΩ/]+)?")


def unread(plain: str, covered: Sequence[Span]) -> Span | None:
    """The first number of a normalised text that lies in none of the covered spans, with the word that follows it.

    >>> text = "max rate, 43 dB"
    >>> start, end = unread(text, [])
    >>> text[start:end]
    '43 dB'
    """
    known = [*covered, *idioms(plain)]
    first = min((place for place in _numbers_at(plain) if not overlaps((place, place + 1), known)), default=None)
    if first is None:
        return None
    match = _TO_THE_RIGHT.match(plain, first)
    return first, max(match.end() if match is not None else 0, first + 1)


@functools.lru_cache(maxsize=64)
def idioms(plain: str) -> tuple[Span, ...]:
    """Where numbers are part of a name, a time or a turn of phrase."""
    return tuple(match.span() for pattern in (_NAMES, _TIMES) for match in pattern.finditer(plain))


def loose_numbers(plain: str, covered: Sequence[Span]) -> list[Number]:
    """The numbers and multiplying words of a normalised text that lie in none of the covered spans.

    Names ("5G") and mere idiom ("one") are none.
    """
    taken = [*covered, *idioms(plain)]
    found: list[Number] = []
    candidates = [*factors(plain), *(n for n in numbers(plain) if n.form == "digits" or _is_figure(plain, n))]
    for number in sorted(candidates, key=lambda each: each.start - each.end):  # "one and a half" before "half"
        number = _cut(plain, number, taken)
        if not overlaps((number.start, number.end), taken):
            found.append(number)
            taken.append((number.start, number.end))
    return sorted(found, key=lambda number: number.start)


def _cut(plain: str, number: Number, taken: Sequence[Span]) -> Number:
    """The number without a part that belongs to somebody's name: "权重3,9号用户" holds 3, not 3.9."""
    match = _WHOLE.match(plain, number.start)
    if match is None or not any(match.end() < start < number.end for start, _ in taken):
        return number
    return Number(value=Decimal(match.group()), start=number.start, end=match.end(), form=number.form)


def may_be_a_limit(plain: str, number: Number) -> bool:
    """Whether a number stands where a limit would, or before a unit that no limit here has ("43 dB", "10 joules")."""
    rating = _RATING.match(plain, number.end)
    if rating is not None and _BEGINS.search(plain, 0, number.start) and _ENDS.match(plain, rating.end()):
        return True  # a clause says nothing else, as limits are said: "max rate, 10 Wh"
    if _UNIT_OF_ANOTHER_KIND.match(plain, number.end) is not None:
        return True
    return _SETS_A_LIMIT.search(plain, 0, number.start) is not None


def _numbers_at(plain: str) -> Iterator[int]:
    yield from (place for place, letter in enumerate(plain) if unicodedata.category(letter).startswith("N"))
    yield from (number.start for number in numbers(plain) if _is_figure(plain, number))
    for match in _VAGUE.finditer(plain):
        if unit_at(plain, match.end()) is not None:
            yield match.start()


def _is_figure(plain: str, number: Number) -> bool:
    """Whether a number in words stands for an amount, not for a turn of phrase."""
    if number.value is None:
        return False
    if number.form in ("words", "foreign"):
        return plain[number.start : number.end].lower() not in _IDIOMS or _OF_POWER.match(plain, number.end) is not None
    return number.form == "chinese" and _CHINESE_FIGURE.search(plain, number.start, number.end + 1) is not None


CHANGED_BY = Beside(
    deferred(rf"(?i)(?:{either('figures', 'one', 'changed_by')})\s*(?:about|around|roughly)?\s*$"),
    deferred(rf"(?i)\s*(?:{either('figures', 'one', 'changed_behind')})(?!\w)"),
)
_ALL = deferred(r"(?i)\b(?:all|all of|all the|every one of)\s*(?:the\s+|our\s+|these\s+)?$|(?:所有|全部)的?\s*$")
_DESCRIBED_BEFORE = deferred(rf"(?i)(?:^|{either('figures', 'users', 'ahead_of_all')})\s*$")
_DESCRIBED_AFTER = deferred(rf"(?i)\s*(?:$|(?:{either('figures', 'users', 'behind_all')}))")
_COUNT = rf"(?:[0-9]+|{'|'.join(cardinals(2, 10))})"
COUNTED_USERS = deferred(
    rf"(?i)(?<![\w.,/^*-]){_COUNT} (?:{either('figures', 'users', 'counted')})|"
    r"(?:[0-9]+|[两二三四五六七八九十]+)\s*个(?:用户|设备|传感器|子载波)"
)
CARRIERS = Phrases(either("figures", "bounds", "carriers"))
_SOME_USERS, _ONE_OF = (Phrases(either("figures", "users", name, **PLACED)) for name in ("some", "one_of"))
_OF_OURS = r"(?:\w+\s+){0,3}?(?:power|watts?|wattage|rates?|speeds?|throughput|bandwidth|budget|limit)\b"
_HALVED = Phrases(
    either("figures", "one", "halved", ours=_OF_OURS),
    marks="half halve third quarter doub dopp triple twice dupli dobl 减半 一半 翻倍",
)
_OTHERS_HALVED = Phrases(
    r"(?:其余|其他|别人|剩下|剩余|旁人|另外)[^,\uff0c。0-9]{0,5}(?:一半|减半|翻倍|双倍|加倍)",
    marks="一半 减半 翻倍 双倍 加倍",
)
_LIMITED, _TO, _FULL = ("|".join(words_of("figures", "shared", name)) for name in ("limited", "to", "full"))
_MOST = rf"(?:(?:max|máx)\w*\.?|{_LIMITED}|=|<=|≤|:)?\s*(?:(?:max|{_TO})\.?\s*)?"
_BUDGET = "|".join(words_of("figures", "shared", "power", "budgets"))
_OF_THE_BUDGET = deferred(
    rf"(?i)\s*(?:{_FULL})(?:\s++|{_FULL})*+(?:{_BUDGET})\b|的(?:发射|总)?(?:功率|预算)(?!最|放大)"
)
_SHARED = Beside(
    deferred(
        rf"(?i)(?:\b(?:p_?max|(?:max\w*\.?\s+)?(?:{POWER_NOUNS}))\s*{_MOST}|功率(?:用|压|降|限制|上限)?[到在为是]?)$"
    ),
    deferred(rf"(?i)(?:\s++|{_FULL})*+(?:{_BUDGET})\b(?:\s+(?:budget|limit))?|的?(?:发射|总)?(?:功率|预算)(?!放大)"),
)
EACH_CARRIER = rf"(?:{either('figures', 'shared', 'per')})\s*子?(?:{either('figures', 'bounds', 'carriers')})"
_PER_CARRIER = Beside(
    deferred(rf"(?i){EACH_CARRIER}[^,;.\uff0c。0-9]{{0,16}}$"), deferred(rf"(?i)\s*(?:\w+\s+)?{EACH_CARRIER}")
)
_IS_SHARED = deferred(rf"(?i)\b(?:{_BUDGET})\b|功率|预算")
_UNUSED = deferred(
    rf"(?i)\s*(?:(?:{either('figures', 'shared', 'stays')})\s+)?(?:{either('figures', 'shared', 'unused')})"
)


def shares_power(plain: str, figure: Quantity) -> bool:
    """Whether a share is said to be one of the power: "90 % of the power budget", not "outage 5 %, power 10 W"."""
    ahead = plain[clause_start(plain, figure.phrase_start) : figure.phrase_start]
    promises = any(name == "outage_probability" for _, name in named_in(ahead))
    return not promises and _OF_THE_BUDGET.match(plain, figure.phrase_end) is not None


def is_spared(plain: str, figure: Quantity) -> bool:
    """Whether a share of the budget is said to be left unused: 预算留两成不动."""
    ahead = plain[clause_start(plain, figure.phrase_start) : figure.phrase_start]
    end = _SHARED.widened(plain, (figure.phrase_start, figure.phrase_end))[1]
    shared = end > figure.phrase_end or _IS_SHARED.search(ahead) is not None
    return shared and _UNUSED.match(plain, end) is not None


_TOGETHER: dict[str, int] = {
    word: size
    for language in languages_with("figures")
    for word, size in table("figures", language).get("together", {}).items()
}
_TOGETHER_WORDS = "|".join(word if is_chinese(word) else rf"\b{word}\b" for word in _TOGETHER)
_CARRIER = "|".join(words_of("figures", "grouped", "carriers"))
_BLOCKS = Phrases(
    rf"(?P<ahead>{_TOGETHER_WORDS})(?=\s*(?:(?:of|de|von|的)\s*)?(?:{_CARRIER}|子载波))|"
    rf"(?:{_CARRIER}|子载波)(?:\s+\w+){{0,6}}?\s*(?P<behind>{_TOGETHER_WORDS})"
    r"|\b(?P<fold>[a-zäöüß]{3,})er[-\s]?(?:gruppen?|blöcken?|blöcke|päckchen|packs?|bündeln?)\b",
    marks=" ".join({word.split()[-1] for word in _TOGETHER} | {"gruppe", "blöck", "päck", "pack", "bündel"}),
)
_GROUP = f"(?:{'|'.join(words_of('figures', 'grouped', 'carriers', 'groups'))})"
_JOINT = f"(?:{'|'.join(words_of('figures', 'grouped', 'joints'))})"
_GROUPED = Beside(
    deferred(
        rf"(?i)\b(?:in\s+)?{_GROUP}\b(?:[\s:=-]+(?:{_GROUP}|{_JOINT})\b)*[\s:=-]*$|(?:[每按以]|资源块|子载波|块|大小|[为是=])+$"
    ),
    deferred(
        rf"(?i)(?:[\s-]+(?:{_JOINT}[\s-]+)*{_GROUP}\b)+|个?(?:子载波|资源块)?(?:[为成]?一[组块个]|捆绑|绑定|分组|[组构]成一个|"
        r"资源块|块|组)*"
    ),
)


OF_WEIGHTS = Phrases(either("figures", "users", "weighs"))


class Multiple(NamedTuple):
    """So many times what another user gets: "half as much as user 1"."""

    times: float
    user: str
    start: int
    end: int
    said: Comparison


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A question that must be asked before acting: the key of its sentence, and what it names."""

    key: str
    names: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(kw_only=True)
class Reading:
    """The constraints of a sentence, the words that each came from, and what is in doubt, as they are being read.

    Attributes:
        text: the sentence as it stands; ``plain`` is the same normalised.
        masked: the spans that are used up, so that their words do not count as wishes again.
        not_used: figures that describe the channel rather than ask for something.
        counted: the spans of numbers that only count or describe.
        exact: the constraints of the whole cell that are to be met exactly.
        missing: a share of the channel that is said to be missing.
        steps: amounts to add, by detail name.
        back: users to be taken in again.
        named: everybody who is named.
        strangers: spans of names that no user has.
        marks: the spans of figures and users, each with what it was read as, "+" behind it for several users.
        spoken_for: spans whose figures are used up before any figure is looked at.
        turns: where words stand that take back what is said ahead of them: "no, wait", "更正".
        ends: where the figure of each constraint of the whole cell ends.
        multiples: rates that are said by those of others.
    """

    text: str
    plain: str
    quantities: Sequence[Quantity]
    values: dict[str, Constraint] = field(default_factory=dict[str, Constraint])
    evidence: dict[str, str] = field(default_factory=dict[str, str])
    doubts: list[Doubt] = field(default_factory=list[Doubt])
    not_used: list[str] = field(default_factory=list[str])
    masked: list[Span] = field(default_factory=list[Span])
    counted: list[Span] = field(default_factory=list[Span])
    exact: set[str] = field(default_factory=set[str])
    missing: float | None = None
    steps: dict[str, float] = field(default_factory=dict[str, float])
    back: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    strangers: Sequence[Span] = ()
    marks: list[tuple[int, int, str]] = field(default_factory=list[tuple[int, int, str]])
    spoken_for: list[Span] = field(default_factory=list[Span])
    turns: Sequence[Span] = ()
    ends: dict[str, int] = field(default_factory=dict[str, int])
    multiples: list[Multiple] = field(default_factory=list[Multiple])

    def doubt(self, key: str, **names: str) -> None:
        """Note a question."""
        self.doubts.append(Doubt(key=key, names=names))

    def put(self, name: str, value: float, span: Span) -> None:
        """Take a value of a constraint; two different ones are a doubt."""
        words = self.text[slice(*span)]
        if self.values.get(name, value) != value and not self.takes_back(self.ends[name], span[0]):
            self.doubt("conflict", one=self.evidence[name], other=words)
        else:
            self.values[name], self.evidence[name], self.ends[name] = value, words, span[1]

    def takes_back(self, start: int, end: int) -> bool:
        """Whether words between two figures of one thing take back the first: "2 W at most, no, sorry, make it 3 W"."""
        between = [each for each in self.turns if start <= each[0] and each[1] <= end]
        self.masked += between
        return bool(between)

    def take(self, name: str, value: float, figure: Quantity) -> None:
        """Take the value of a figure."""
        self.put(name, value, (figure.start, figure.end))
        if figure.comparator == "exactly":
            self.exact.add(name)

    def take_share(self, figure: Quantity, max_power_w: float) -> None:
        """Take a share of the power, with the words beside that say so: of all of it or of each subcarrier's.

        What is to be left unused leaves the rest: "20 % of the power in reserve".
        """
        start, end = _SHARED.widened(self.plain, (figure.phrase_start, figure.phrase_end))
        unused = _UNUSED.match(self.plain, end)
        span = start, unused.end() if unused else end
        self.masked.append(span)
        self.spoken_for.append(span)
        carriers = _PER_CARRIER.is_at(self.plain, start, end, clause_start(self.plain, start))
        name = "subcarrier_max_power_w" if carriers else "max_power_w"
        if unused and figure.comparator == "at_most":
            self.doubt("share", text=figure.text)  # what is radiated at least
        self.take(name, max_power_w * (1 - figure.value if unused else figure.value), figure)

    def changes_by(self, figure: Quantity) -> bool:
        """Whether something is to become more or less by a share: "half the power less"."""
        span = _SHARED.widened(self.plain, (figure.phrase_start, figure.phrase_end))
        return "减" in figure.text or CHANGED_BY.is_at(self.plain, *span)  # 减半

    def take_group(self, size: float, span: Span) -> None:
        """Take how many subcarriers go together, with the words beside that say so."""
        span = _GROUPED.widened(self.plain, span)
        self.spoken_for.append(span)
        self.masked.append(span)
        if size < 1 or not size.is_integer():
            self.doubt("impossible", text=self.text[slice(*span)].strip())
        else:
            self.put("resource_block_group_size", size, span)


def take_blocks(reading: Reading) -> None:
    """How many subcarriers go together, where the number is a part of a word: "in pairs", "Viererblöcke"."""
    match = _BLOCKS.search(reading.plain)
    word = next(filter(None, match.groups())).lower() if match is not None else ""
    size = _TOGETHER.get(word) or german_value(plain_word(word, "de"))
    if match is not None and size:
        reading.take_group(float(size), match.span())


def take_multiples(reading: Reading) -> None:
    """What is so many times another user's rate, and no weight: "user 2 half as much as user 1", 用户8是用户1的三倍."""
    plain = reading.plain
    if OF_WEIGHTS.search(plain):
        return
    for factor in factors(plain):
        said = OF_SOMEBODY.behind.match(plain, factor.end) or OF_SOMEBODY.ahead.search(plain, 0, factor.start)
        users = listed_users(said["one"]) if said is not None else ()
        if said is not None and len(users) == 1:
            start, end = min(said.start(), factor.start), max(said.end(), factor.end)
            bound = comparison(plain, start, end, kind="rate", after=0)
            reading.multiples.append(Multiple(float(factor.value or 0), users[0], start, end, bound))
            reading.spoken_for.append((factor.start, factor.end))
            reading.masked.append((start, end))


def take_counts(reading: Reading, allotted: Sequence[Span], of_all: int) -> None:
    """How many users there are is the channel's affair; to pick some of them without naming them is a doubt.

    ``allotted`` are spans that speak of named users, and so many users are ``of_all``.
    """
    taken = [*((figure.start, figure.end) for figure in reading.quantities), *reading.spoken_for, *allotted]
    measured = [(figure.start, figure.end) for figure in reading.quantities if figure.kind not in ("bare", "other")]
    for match in COUNTED_USERS.finditer(reading.plain):
        if any(start <= match.start() < end for start, end in taken):
            continue
        words = reading.text[slice(*match.span())]
        reading.counted.append(match.span())
        counts = [n for n in numbers(reading.plain) if not overlaps((n.start, n.end), measured)]
        alone = len(counts) == 1 and bool(of_all)  # not "3 of 8 users"
        if counts[0].value == of_all if alone else _describes_all(reading, *match.span()):
            reading.not_used.append(words)
        else:
            reading.doubt("not_understood" if CARRIERS.search(words) else "some_users", text=words)


def doubt_parts(reading: Reading, allotted: Sequence[Span]) -> None:
    """Some of the users, half of something, nobody at all: each a question."""
    settled = [*reading.spoken_for, *allotted, *reading.counted]
    asked = {_SOME_USERS: "some_users", BY_PLACE: "some_users", _ONE_OF: "one_of", _HALVED: "change",
             _OTHERS_HALVED: "change"}  # fmt: skip
    for pattern, key in asked.items():
        match = pattern.search(reading.plain)
        if match is None or (pattern is _HALVED and overlaps(match.span(), settled)):
            continue
        if pattern is BY_PLACE and any(is_within(span, match.span()) for span in reading.counted):
            continue  # "users 1, 2 and 3: all three"
        if pattern is not _ONE_OF and any(is_within(match.span(), span) for span in allotted):
            continue  # "odd-numbered users"
        reading.doubt(key, text=reading.text[slice(*match.span())])


def _describes_all(reading: Reading, start: int, end: int) -> bool:
    """Whether a count of users tells how many there are, rather than picking some: "for 3 users" picks."""
    plain = reading.plain
    before, after = plain[clause_start(plain, start) : start], plain[end : clause_end(plain, end)]
    described = _DESCRIBED_BEFORE.search(before) and _DESCRIBED_AFTER.match(after)
    return described is not None or _ALL.search(before) is not None

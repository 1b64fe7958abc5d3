"""What the numbers of a sentence are: users, figures by the unit of another, weights, sizes of blocks, descriptions.

The model says which are users ("al 6"), which borrow the unit of another figure ("the others only one"), which weigh
and which only describe; thresholds decide, and what a number in its place can be at all: a bounded number is no user.

So a sentence is looked at twice: before anybody asks what its numbers are, and with those settled that turned out to be
users or to borrow a unit, which get their unit and their value then ("user 3 needs 2 Mbit/s, the others only one").
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from typing import TypeVar

from wirelessagent.language.figure_roles import SCALED, Look, View, answers
from wirelessagent.language.mentions import (
    COUNTS_OTHERS,
    GIVEN_TO,
    JOINT,
    JOINT_WORDS,
    LISTED,
    WORD_NUMBER,
    Mention,
    mentions,
    merged,
)
from wirelessagent.language.moods import named_in
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Measure, Quantity, QuantityKind, measures
from wirelessagent.language.stated import COUNTED_USERS, FOREIGN_UNIT, OF_WEIGHTS, idioms, loose_numbers, may_be_a_limit
from wirelessagent.language.text import (
    AND,
    USER_NOUN,
    WORD_OR_SIGN,
    Phrases,
    Span,
    blanked,
    clause_end,
    clause_start,
    is_within,
    overlaps,
)  # fmt: skip
from wirelessagent.language.units import unit_at
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

BORROWING: Mapping[str, QuantityKind] = {
    "rate": "rate", "power": "power", "multiple": "rate", "outage": "ratio", "reliability": "ratio",
    "share": "ratio",
}  # fmt: skip
_SCALES = {"k": 10**3, "K": 10**3, "M": 10**6, "G": 10**9}
_DECLARING = frozenset(words_of("figures", "one", "declares"))
_DENIED = deferred(f"(?i){either('moods', 'negation', 'clause')}")
_FAR = 200  # no two rates of one sentence are farther apart: another unit is meant
_ALONE, _BEHIND = (either("figures", "one", name) for name in ("alone", "behind_alone"))
_ONE = Phrases(  # "the others only one", "one two and four", against "one user"
    rf"(?<![\w'-])(?:{_ALONE})(?!\w)(?=\s*(?:$|[,.;:!?)]|{_BEHIND})|\s+{WORD_NUMBER}\b)"
)


def first_look(
    plain: str, quantities: Sequence[Quantity], names: Sequence[str] = (), taken: Sequence[Span] = ()
) -> Look:
    """A sentence before anybody asked what its numbers are; ``taken`` spans are read elsewhere."""
    clear = [q for q in quantities if not overlaps((q.start, q.end), taken)]
    stated = [q for q in clear if q.kind not in ("bare", "other")]
    spans = [(q.start, q.end) for q in stated]
    found = mentions(plain, names, [*spans, *taken])
    covered = [*spans, *taken, *((mention.start, mention.end) for mention in found)]
    loose = loose_numbers(plain, covered)
    able = any(figure.kind in ("rate", "power") for figure in stated)
    alone = list(ones(plain, [*covered, *((n.start, n.end) for n in loose)])) if able else []
    unread = [q for q in clear if q.kind == "other"]
    return Look(
        plain=plain, quantities=quantities, figures=stated, unread=unread, mentions=found, loose=loose, ones=alone
    )


def second_look(look: Look, users: Sequence[Number], roles: Mapping[Number, str]) -> Look:
    """The same with the numbers that are ``users`` among those, and those that borrow a unit among the figures."""
    borrowed = figures_of(look.plain, roles, look.quantities, look.figures)
    if not users and not borrowed:
        return look
    figures = sorted([*look.figures, *borrowed.values()], key=lambda figure: figure.start)
    settled = [(number.start, number.end) for number in [*borrowed, *users]]
    return dataclasses.replace(
        look, figures=figures, mentions=_with_named(look, ((str(int(n.value or 0)), (n.start, n.end)) for n in users)),
        unread=[q for q in look.unread if not overlaps((q.start, q.end), settled)],
        loose=[number for number in look.loose if number not in borrowed and number not in users], ones=[],
    )  # fmt: skip


def _with_named(look: Look, named: Iterable[tuple[str, Span]]) -> list[Mention]:
    """The mentions, and users where they are named as well, from left to right, the items of a list made one."""
    more = [Mention(role="named", users=(user,), start=start, end=end) for user, (start, end) in named]
    return merged(look.plain, sorted([*look.mentions, *more], key=lambda mention: mention.start))


def ones(plain: str, taken: Sequence[Span]) -> Iterator[Number]:
    """Every "one" of a normalised text that stands alone, where no ``taken`` span is: no article is one."""
    for match in _ONE.finditer(plain):
        if not overlaps(match.span(), taken):
            yield Number(value=Decimal(1), start=match.start(), end=match.end(), form="words")


def figures_of(
    plain: str, roles: Mapping[Number, str], quantities: Sequence[Quantity], stated: Sequence[Quantity]
) -> dict[Number, Quantity]:
    """The numbers that borrow a unit or a value, as quantities; those are missing that find none to borrow.

    ``roles`` says what each number is, ``quantities`` hold their bounds, ``stated`` are the figures with a unit.
    """
    if not roles:
        return {}
    stated_units = [each for each in measures(plain) if each.unit is not None and each.number.value is not None]
    units = sorted([*stated_units, *_declared(plain, stated_units)], key=lambda measure: measure.start)
    found: dict[Number, Quantity] = {}
    for number, role in roles.items():
        scaled = SCALED.match(plain, number.end) if BORROWING[role] == "rate" else None
        said = [figure for other, figure in found.items() if roles[other] != "multiple"]  # "3 the double, 6 the half"
        value = _value(number, role, scaled, units, sorted([*stated, *said], key=lambda figure: figure.start))
        if value is None:
            continue
        own = [q for q in quantities if q.start <= number.start < q.end]
        end = scaled.end() if scaled is not None else number.end  # "400k"
        found[number] = Quantity(
            value=value, kind=BORROWING[role], text=plain[number.start : end], start=number.start, end=end,
            comparator=own[0].comparator if own else None,
            phrase_start=own[0].phrase_start if own else number.start,
            phrase_end=max(end, own[0].phrase_end if own else end),
        )  # fmt: skip
    return found


def _declared(plain: str, measured: Sequence[Measure]) -> Iterator[Measure]:
    """Each unit that is said to be that of all figures: "en megas: 6 para el 2", "1.2 for 3, 2 for 4, all in Mbit/s".

    It ends its clause, behind "in" or with nothing beside that says more.
    """
    taken = [(each.start, each.end) for each in measured]
    for match in WORD_OR_SIGN.finditer(plain):
        unit = None if overlaps(match.span(), taken) else unit_at(plain, match.start())
        if unit is None or unit.kind == "ratio":
            continue
        start, taken = match.start(), [*taken, (match.start(), unit.end)]
        first, last = clause_start(plain, start), clause_end(plain, unit.end)
        ahead, behind = (
            WORD_OR_SIGN.findall(plain[slice(*span)].lower()) for span in ((first, start), (unit.end, last))
        )
        bracketed = plain[start - 1 : start] == "[" and plain[unit.end : unit.end + 1] == "]"  # "floors [kbps]: …"
        said_in = ahead[-1:] in (["in"], ["en"]) and not behind and _DENIED.search(plain, first, start) is None
        if said_in or bracketed or {*ahead, *behind} <= _DECLARING:
            number = Number(value=Decimal(1), start=start, end=start, form="words")
            yield Measure(number=number, unit=unit, start=start, end=unit.end)


def _value(
    number: Number, role: str, scaled: re.Match[str] | None, units: Sequence[Measure], stated: Sequence[Quantity]
) -> float | None:
    """What a number is worth in SI units, ``scaled`` by a letter or not; None where there is nothing to borrow from."""
    if number.value is None:
        return None
    kind = BORROWING[role]
    if kind == "ratio":
        return float(number.value) if 0 < number.value < 1 else None
    if role == "multiple":
        earlier = [figure.value for figure in stated if figure.kind == "rate" and figure.end <= number.start]
        return float(number.value) * earlier[-1] if earlier else None
    if scaled is not None:
        return float(number.value * _SCALES[scaled.group().strip()])
    able = [(each.end, each.unit) for each in units if each.unit is not None and each.unit.kind == kind]
    before = [unit for end, unit in able if end <= number.start][::-1]
    alike = [figure.value for figure in stated if figure.kind == kind]
    for unit in (*before, *(unit for _, unit in able)):
        value = unit.value(number.value)
        if not alike or any(1 / _FAR <= value / other <= _FAR for other in alike if other > 0):
            return value
    return None


_Answer = TypeVar("_Answer")
_Item = TypeVar("_Item", bound=Quantity | Number | Mention)
_ONE_OF_A_LIST = 0.3
_MOST_WEIGHT = 10**6
ITEMS = deferred(rf"{LISTED.pattern}|\s*[:/]\s*")  # "weights 2:1:1"
_BESIDE = deferred(  # between the figures of users one after the other, "@" for these
    rf"(?i)(?=[^@]*@)(?:[\s,;:、\uff0c\uff1b\uff1a/&=→>()\[\]@-]|"
    rf"{GIVEN_TO}|{JOINT_WORDS}|{either('figures', 'users', 'given_with')})*"
)
_AND_THE = deferred(rf"(?i)\s*(?:{AND}|al|au|bis)\s*(?:\s{GIVEN_TO}\s*)*")  # "al uno y al cuatro"
GIVEN_ON = deferred(rf"(?i)\s*(?:{GIVEN_TO}\s*)+(?:l')?")
_SEVERAL = deferred(rf"(?i)\b{any_word('figures', 'users', 'several')}\s*$")
_BOTH = deferred(rf"(?i)(?=.*[^\W\d_])(?:{JOINT.pattern.removeprefix('(?i)')})")  # by more than a comma
_TO_SOMEBODY = deferred(rf"(?i)\s*(?:{GIVEN_TO}\s*)+{USER_NOUN}")
_WITH_A_JOINT = deferred(rf"(?i)(?=\s*\S)(?:{LISTED.pattern.removeprefix('(?i)')})")
_WEIGHTS = deferred(  # what follows are weights, whatever else they may look like
    rf"(?i)(?:(?:{either('figures', 'users', 'weights')})(?:\s+(?:of|are|is|being|de|von|sind))?|"
    r"权重(?:分别|依次|各)?[是为]?)\s*[:=]?\s*$"
)
_NEAR_BY, _ENDS = 40, deferred(r"[0-9.;!?。；]")  # of a list and its users, and what stands between neither
_MOST_BARE_USERS = 100  # who is called by a number alone has a small one
_SURE_OF_A_USER, _SURE_OF_A_WEIGHT, _SURE_OF_NOTHING, _SURE_OF_A_FIGURE = 0.6, 0.6, 0.6, 0.6
_CERTAIN_OF_A_USER, _SURE_OF_A_GROUP, _LIKELY, _PERHAPS = 0.8, 0.5, 0.4, 0.2
_Roles = Mapping[Number, Mapping[str, float]]
"""How likely each number has each role."""


class Numbers:
    """The numbers of a sentence, each settled, and the sentence as it looks with them.

    Attributes:
        look: the figures, with those that borrow a unit, the users and what is left; ``view`` is how models see it.
        chances: how likely each number has each role.
        weights: numbers and words that say how much somebody counts.
        groups: numbers that say how many subcarriers go together.
        multiplied: words that multiply the figure behind them, "twice 1 Mbit/s".
        recounted: the spans of numbers that only count the users of a mention again ("users 2 and 5, those two").
        doubtful: the spans of words such as "one" that may be figures and may be nothing.
        harmless: the spans of numbers that describe and limit nothing, such as a time of day.
        strangers: the spans of names that no user is known by; they are mentions, too.
    """

    def __init__(self, plain: str, quantities: Sequence[Quantity], names: Sequence[str], taken: Sequence[Span]) -> None:
        first = first_look(plain, quantities, names, taken)
        view = first.view()
        self.strangers = _without_limits(plain, view.strangers())
        if self.strangers:
            called = _with_named(first, ((plain[slice(*span)], span) for span in self.strangers))
            first = dataclasses.replace(first, mentions=called)
            view = first.view()
        self.chances = chances = _chances(first, view)
        weighing, rates = _weighing_lists(first, chances), _rates_of_lists(first, chances)
        plausible = _no_limits(first, [*weighing, *rates])
        users = _users_of(first, plausible, [*weighing, *rates], taken, chances)
        borrowing = _borrowing(first, chances, [*users, *weighing]) | dict.fromkeys(rates, "rate")
        self.look = look = second_look(first, users, borrowing)
        self.view = view if look is first else look.view()
        self.weights = [n for n in look.loose if n in weighing or _weighs(plain, n, chances[n])]
        self.groups = [n for n in look.loose if n.value is not None and chances[n]["group"] > _SURE_OF_A_GROUP]
        starts = {figure.start for figure in look.figures}
        perhaps = [n for n in first.ones if chances[n]["rate"] + chances[n]["power"] > _PERHAPS]
        self.doubtful = [(n.start, n.end) for n in perhaps if n.start not in starts]
        multiplying = (n for n in look.loose if n.form == "times")
        self.multiplied = [n for n in multiplying if any(plain[n.end : start].isspace() for start in starts)]
        unread = [number for number in plausible if number in look.loose]
        together = _sizes(look.mentions)
        self.recounted = [(n.start, n.end) for n in unread if n.value in together]
        named = {user for mention in look.mentions for user in mention.users}
        self.harmless = [
            *idioms(plain),
            *self.recounted,
            *((mention.start, mention.end) for mention in look.mentions if mention.role != "named"),
            *((n.start, n.end) for n in unread if _says_nothing(n, chances[n], named)),
        ]

    @property
    def perhaps_weights(self) -> list[Number]:
        """Numbers that may say how much somebody counts, and do not surely."""
        loose = (number for number in self.look.loose if number not in self.weights)
        return [number for number in loose if self.chances[number]["weight"] > _PERHAPS]


def _chances(first: Look, view: View) -> _Roles:
    """How likely each number has each role; those of a row have the same, and what doubles a rate is no weight."""
    plain = first.plain
    chances: _Roles = {
        number: answers("number", view.number(number, first.bound(number))) for number in (*first.loose, *first.ones)
    }
    likely_users = [n for n in first.loose if chances[n]["user"] > _LIKELY]
    spans = [(each.start, each.end) for each in (*everybody_named(first.mentions), *likely_users)]
    for each in series(plain, [n for n in first.loose if n not in likely_users and n.form != "times"], spans):
        if len(each) > 1:
            chances |= dict.fromkeys(each, jointly([chances[n] for n in each]))
    if OF_WEIGHTS.search(plain) is None:  # what doubles there is a rate that was said before
        first_rate = min((figure.end for figure in first.figures if figure.kind == "rate"), default=len(plain))
        doubles = [n for n in chances if n.form == "times" and n.start >= first_rate]
        for number in doubles:  # "anderthalb für Nutzer 3" may be a rate
            whole = number.value is not None and number.value % 1 == 0
            chances[number] = moved(chances[number], ("weight", "rate") if whole else ("weight",), "multiple")
    return chances


def _users_of(
    first: Look, plausible: Sequence[Number], else_read: Sequence[Number], taken: Sequence[Span], chances: _Roles
) -> list[Number]:
    """The numbers that are users, of those that plausibly are and of those that surely are though limits may be."""
    others = [n for n in first.loose if n not in {*plausible, *else_read}]
    likely = [n for n in plausible if chances[n]["user"] > _SURE_OF_A_USER]
    pairs = ((n, other) for n, other in itertools.pairwise(first.loose) if other in likely)
    listed = [n for n, other in pairs if JOINT.fullmatch(first.plain, n.end, other.start)]  # "cap 1, 2 and 3"
    named = [each for each in first.mentions if each.role == "named"]
    listed += [n for n in others for each in named if _BOTH.fullmatch(first.plain, each.end, n.start)]
    able = [*plausible, *(n for n in others if n in listed or _is_surely_a_user(first, n, chances))]
    together = _sizes(named)  # "user 3 and user 7, the two …"
    able = [n for n in able if n.value not in together or not _SEVERAL.search(first.plain, 0, n.start)]
    read = [*first.figures, *first.loose, *first.mentions]
    alone = list(ones(first.plain, [*taken, *((each.start, each.end) for each in read)])) if able else []
    return _users(first.plain, able, alone, named, chances)


def _sizes(found: Sequence[Mention]) -> set[int]:
    """How many users are named together, where several are."""
    return {len(mention.users) for mention in found if len(mention.users) > 1}


def everybody_named(found: Sequence[Mention]) -> list[Mention]:
    """Users who are named, and the others beside them."""
    return [mention for mention in found if mention.role in ("named", "others")]


def _without_limits(plain: str, strangers: Sequence[Span]) -> list[Span]:
    """Names that no user is known by, without those of limits."""
    known = [span for span, _ in named_in(plain)] if strangers else []
    return [each for each in strangers if not any(is_within(each, span) for span in known)]


def moved(chances: Mapping[str, float], roles: Sequence[str], to: str) -> Mapping[str, float]:
    """Chances in which those of some roles are all of one."""
    total = sum(chances[role] for role in dict.fromkeys((*roles, to)))
    return {**chances, **dict.fromkeys(roles, 0.0), to: total}


def shares(chances: Mapping[_Answer, float]) -> dict[_Answer, float]:
    """Chances that add up to one."""
    total = sum(chances.values()) or 1.0
    return {answer: chance / total for answer, chance in chances.items()}


def jointly(chances: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """How likely several have a role that they all have."""
    joint = {role: math.prod(each[role] for each in chances) ** (1 / len(chances)) for role in chances[0]}
    return shares(joint)


def series(plain: str, items: Sequence[_Item], named: Sequence[Span]) -> Iterator[list[_Item]]:
    """Items of rows that say of one user after the other the same: "cap 1 at 1.5, 4 at 2 and 6 at 2.5 Mbit/s"."""
    apart = blanked(plain, named, "@")
    ends = {item.start: last.end for last, item in itertools.pairwise(items)}
    for each in runs(apart, items, _BESIDE):
        first = each[0].start  # a user stands ahead of it, and no figure of the same user between
        begins = first not in ends or "@" in apart[ends[first] : first]
        yield from [each] if begins else [[item] for item in each]


def runs(plain: str, items: Sequence[_Item], joint: re.Pattern[str]) -> list[list[_Item]]:
    """Items in rows, the neighbours of a row with nothing but a joint between; the ends of a range are apart."""
    found: list[list[_Item]] = []
    for item in items:
        last = found[-1][-1] if found else item
        bounds = [each.comparator for each in (last, item) if isinstance(each, Quantity)]
        if found and bounds != ["at_least", "at_most"] and joint.fullmatch(plain, last.end, item.start):
            found[-1].append(item)
        else:
            found.append([item])
    return found


def _no_limits(look: Look, else_read: Sequence[Number]) -> list[Number]:
    """The numbers that may be users or mere descriptions: not bounded, scaled ("2M"), a part of one, or with a unit."""
    bounded = [(q.start, q.end) for q in look.quantities if q.kind in ("bare", "other") and q.comparator is not None]
    bounded += [
        (figure.start - look.plain[: figure.start].endswith(" "), figure.end)
        for figure in look.figures  # "2 9 watts"
    ]
    return [
        number
        for number in look.loose
        if number not in else_read
        and not any(start <= number.end and number.start < end for start, end in bounded)
        and not (number.value is not None and 0 < number.value < 1)
        and not may_be_a_limit(look.plain, number)
    ]


def _is_surely_a_user(look: Look, number: Number, chances: _Roles) -> bool:
    """Whether a number is somebody, though it stands where a limit may: "cap 12 at 2 Mbit/s", "18 W: 2 and 3 …"."""
    digits = [figure for figure in look.figures if look.plain[figure.start].isdigit()]
    measured = any(figure.start - 1 <= number.end and number.start < figure.end for figure in digits)
    scaled = SCALED.match(look.plain, number.end) is not None
    return chances[number]["user"] > _CERTAIN_OF_A_USER and not measured and not scaled


def _borrowing(look: Look, roles: _Roles, users: Sequence[Number]) -> dict[Number, str]:
    """The numbers that are figures by the unit of another, each with its role."""
    found: dict[Number, str] = {}
    for number, chances in roles.items():
        value = number.value or Decimal(0)
        multiplies = value < 1 or (number.form == "times" and value % 1 == 0)  # not "die acht bei zweieinhalb"
        role = max(BORROWING, key=lambda each: chances[each] * (multiplies or each != "multiple"))
        scaled = SCALED.match(look.plain, number.end) is not None
        foreign = FOREIGN_UNIT.match(look.plain, number.end) is not None
        if number not in users and (scaled or not foreign) and _is_a_figure(look, number, chances, role):
            found[number] = role
    return found


def _is_a_figure(look: Look, number: Number, chances: Mapping[str, float], role: str) -> bool:
    """Whether a number that most likely has ``role`` may be read as a figure."""
    if role == "multiple":
        return chances[role] > _SURE_OF_A_FIGURE
    sure = sum(chances[each] for each in BORROWING if BORROWING[each] == BORROWING[role] and each != "multiple")
    if look.bound(number) not in ("", "None") and chances["user"] < _LIKELY:  # which nobody is
        given = _TO_SOMEBODY.match(look.plain, number.end) is not None  # "maximum of five for user 7"
        sure /= 1 - chances["user"] - given * chances["harmless"]
    if SCALED.match(look.plain, number.end):
        return role == "rate" and sure > _LIKELY
    return sure > (_LIKELY if BORROWING[role] == "ratio" else _SURE_OF_A_FIGURE)


def _says_nothing(number: Number, chances: Mapping[str, float], named: set[str]) -> bool:
    """Whether a number describes, weighs nothing ("the others 1"), or is somebody named before."""
    again = number.value is not None and number.value == int(number.value) and str(int(number.value)) in named
    return chances["harmless"] + (number.value == 1) * chances["weight"] + again * chances["user"] > _SURE_OF_NOTHING


def _weighs(plain: str, number: Number, chances: Mapping[str, float]) -> bool:
    """Whether a number says how much somebody counts."""
    able = number.value is not None and 0 <= number.value < _MOST_WEIGHT
    return able and chances["weight"] > _SURE_OF_A_WEIGHT


def _weighing_lists(look: Look, chances: _Roles) -> list[Number]:
    """The numbers of lists as long as a list of users, of which one surely says how much somebody counts."""
    plain, lengths = look.plain, {len(mention.users) for mention in look.mentions}
    able = [n for n in look.loose if n.value is not None and 0 <= n.value < _MOST_WEIGHT and n.form != "times"]
    lists = [each for each in runs(plain, able, ITEMS) if len(each) > 1 and len(each) in lengths]
    return [
        number for each in lists for number in each
        if _WEIGHTS.search(plain, 0, each[0].start) or any(_weighs(plain, n, chances[n]) for n in each)
    ]  # fmt: skip


def _rates_of_lists(look: Look, chances: _Roles) -> list[Number]:
    """The numbers of lists that end with a rate, next to as many users: "2, 3 and 5 Mbit/s for 1, 4 and 6".

    Of two, the first has to be no likely user.
    """
    plain = look.plain
    able = [n for n in look.loose if n.value is not None and n.value > 0 and n.form != "times"]
    rates = [figure for figure in look.figures if figure.kind == "rate"]
    items: list[Number | Quantity] = sorted([*able, *rates], key=lambda item: item.start)
    users = [each for each in runs(plain, able, JOINT) if all(chances[n]["user"] > _ONE_OF_A_LIST for n in each)]
    named = [(m.start, m.end, len(m.users)) for m in look.mentions if m.users]
    named += [(each[0].start, each[-1].end, len(each)) for each in users]
    found = list[Number]()
    for each in runs(plain, items, _WITH_A_JOINT):
        numbers, figure = [item for item in each[:-1] if isinstance(item, Number)], each[-1]
        if len(numbers) < len(each) - 1 or not numbers or not isinstance(figure, Quantity):
            continue
        likely_users = len(numbers) == 1 and chances[numbers[0]]["user"] > _PERHAPS
        for_each = any(m.role == "everybody" and plain[figure.end : m.start].isspace() for m in look.mentions)
        if likely_users or for_each:
            continue
        as_many = [(start, end) for start, end, count in named if count == len(each)]
        gaps = [(end, each[0].start) if end <= each[0].start else (figure.end, start) for start, end in as_many]
        if any(0 <= end - start <= _NEAR_BY and not _ENDS.search(plain, start, end) for start, end in gaps):
            found += numbers
    return found


def _users(
    plain: str, numbers: Sequence[Number], singles: Sequence[Number], named: Sequence[Mention], chances: _Roles
) -> list[Number]:
    """The numbers that are users: surely, or likelier than not beside one that surely is ("2, 5 and 7").

    One of the ``singles`` ("one") is a user in a list with others: "for the one and the three".
    """
    able = [
        n
        for n in numbers
        if n.value is not None
        and 0 <= n.value == int(n.value) < _MOST_BARE_USERS
        and n.form != "times"
        and COUNTED_USERS.match(plain, n.start) is None
        and FOREIGN_UNIT.match(plain, n.end) is None
        and COUNTS_OTHERS.match(plain, n.end) is None
    ]
    given = [n for n in able if any(GIVEN_ON.fullmatch(plain, n.end, mention.start) for mention in named)]
    found = list[Number]()
    for each in runs(plain, sorted([*able, *singles, *named], key=lambda item: item.start), JOINT):
        own = [item for item in each if isinstance(item, Number)]
        judged = [n for n in own if n not in singles]
        apart = len({n.value for n in own}) == len(own)  # not "w = [2, 1, 1]"
        pairs = [(one, other) for one, other in itertools.pairwise(each) if isinstance(one, Mention)]
        pairs = [(one, other) for one, other in pairs if isinstance(other, Number) and other not in (*singles, *given)]
        beside = any(_BOTH.fullmatch(plain, one.end, other.start) for one, other in pairs)
        called = [other for one, other in pairs if _AND_THE.fullmatch(plain, one.end, other.start)]
        sure = beside or any(chances[n]["user"] > _SURE_OF_A_USER for n in judged)
        if sure and apart:
            found += [n for n in own if n in singles or chances[n]["user"] > _ONE_OF_A_LIST or n in called]
    return found

"""Every figure, number and user of one sentence, each with what it most likely is.

Numbers come first: the model says which are users ("al 6"), which borrow the unit of another figure ("the others only
one"), which weigh and which only describe. Then it is asked what the users and the figures are there for, with all of
them in sight.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wirelessagent.language.borrowed import BORROWING, figures_of, ones
from wirelessagent.language.figure_roles import LABELS, SCALED, View, likely, shipped_roles
from wirelessagent.language.figure_words import CORRECTION, COUNTED_USERS
from wirelessagent.language.leftovers import FOREIGN_UNIT, idioms, loose_numbers, may_be_a_limit
from wirelessagent.language.mentions import JOINT, LISTED, Mention, mentions, merged
from wirelessagent.language.nines import nines
from wirelessagent.language.numerals import Number
from wirelessagent.language.odds import odds
from wirelessagent.language.quantities import Quantity

_ONE_OF_A_LIST, _NEAR = 0.3, 24
_MOST_WEIGHT = 10**6
_ITEMS = re.compile(rf"{LISTED.pattern}|\s*[:/]\s*")  # "weights 2:1:1"
_WEIGHED = re.compile(
    r"(?i)weigh|count|priorit|import|prefer|peso|pesa|cuent|poids|pèse|compt|gewicht|zähl|wichtig|vale|权|优先|重要|比重|算|当"
)
_HEADS = re.compile(r"\s*(?::|=|->|→)\s*[0-9]")
_COUNTS = re.compile(  # "3 waiting users"
    r"(?i)\s+(?!(?:for|to|of|from|with|at|and|or|is|are|other|as|than|our|the)\b)[a-z]+(?:\s+[a-z]+)?\s+(?:users|ues|people|"
    r"subscribers|customers|clients|devices|phones|sensors|terminals)\b"
)
_WEIGHTS = re.compile(  # what follows are weights, whatever else they may look like
    r"(?i)(?:\b(?:weights?|weigh(?:s|ing|ed)?|pesos?|poids|gewichten?)(?:\s+(?:of|are|is|being|de|von|sind))?|权重(?:分别|依次|各)?[是为]?)\s*[:=]?\s*$"
)
_MOST_BARE_USERS = 100  # who is called by a number alone has a small one
_SURE_OF_A_USER, _SURE_OF_A_WEIGHT, _SURE_OF_NOTHING = 0.7, 0.6, 0.6
_SURE_OF_A_FIGURE = 0.6
_SURE_OF_ONE = 0.5
_LIKELY = 0.4
_PERHAPS = 0.2
# The share of those who have a rate or a weight, among all users named and among those of each role.
_OWN, _OWNS = 0.7, {"leave_out": 0.02, "users": 0.4, "none": 0.95}


@dataclass(frozen=True, kw_only=True)
class Look:
    """What a sentence holds: figures with a unit, everybody mentioned, the numbers that are neither.

    ``ones`` are words such as "one", which are figures or nothing; ``unread`` bounds whose unit nobody knows.
    """

    plain: str
    quantities: Sequence[Quantity]
    figures: list[Quantity]
    unread: list[Quantity]
    mentions: list[Mention]
    loose: list[Number]
    ones: list[Number]

    def view(self) -> View:
        return View(self.plain, self.figures, self.mentions, self.loose, self.ones)

    def bound(self, number: Number) -> str:
        """How a number is bounded: "at_most", "None" without a comparator, "" where it is nothing but a number."""
        found = [str(q.comparator) for q in self.quantities if q.start <= number.start < q.end]
        return found[0] if found else ""


def first_look(
    plain: str, quantities: Sequence[Quantity], names: Sequence[str] = (), taken: Sequence[tuple[int, int]] = ()
) -> Look:
    """A sentence before anybody asked what its numbers are; ``taken`` spans are read elsewhere."""
    sure = [q for q in nines(plain) if not any(start < q.end and q.start < end for start, end in taken)]
    settled = [*taken, *((q.start, q.end) for q in sure)]
    clear = [q for q in quantities if not any(start < q.end and q.start < end for start, end in settled)]
    stated = [*sure, *(q for q in clear if q.kind not in ("bare", "other"))]
    stated += odds(plain, [*((q.start, q.end) for q in stated), *taken])
    stated.sort(key=lambda figure: figure.start)
    spans = [(q.start, q.end) for q in stated]
    found = mentions(plain, names, [*spans, *taken])
    covered = [*spans, *taken, *((mention.start, mention.end) for mention in found)]
    loose = loose_numbers(plain, covered)
    able = any(figure.kind in ("rate", "power") for figure in stated)
    alone = list(ones(plain, [*covered, *((n.start, n.end) for n in loose)])) if able else []
    unread = [
        q for q in clear if q.kind == "other" and not any(q.start < end and start < q.end for start, end in spans)
    ]
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
    return Look(
        plain=look.plain,
        quantities=look.quantities,
        figures=figures,
        unread=[q for q in look.unread if not any(q.start < end and start < q.end for start, end in settled)],
        mentions=with_numbers(look.plain, look.mentions, users) if users else look.mentions,
        loose=[number for number in look.loose if number not in borrowed and number not in users],
        ones=[],
    )


class Judged:
    """A sentence's figures with units, its users, its weights, and the numbers that mean nothing for the request.

    Attributes:
        figures: the quantities with a unit that lie outside ``taken``, those with a bound of unknown unit among them.
        mentions: everybody spoken of, from left to right.
        weights: numbers and words that say how much somebody counts.
        recounted: the spans of numbers that only count the users of a mention again ("users 2 and 5, those two").
        lists: where the rates or the weights of each list begin.
        doubtful: the spans of words such as "one" that may be figures and may be nothing.
        harmless: the spans of numbers that describe and limit nothing, such as a time of day.
    """

    def __init__(
        self, plain: str, quantities: Sequence[Quantity], names: Sequence[str], taken: Sequence[tuple[int, int]]
    ) -> None:
        first = first_look(plain, quantities, names, taken)
        view = first.view()
        roles = {
            number: _answers("number", view.number(number, first.bound(number)))
            for number in (*first.loose, *first.ones)
        }
        spans = [(figure.start, figure.end) for figure in first.figures]
        bounded = [(q.start, q.end) for q in quantities if q.kind in ("bare", "other") and q.comparator is not None]
        bounded += [(start - 1, end) for start, end in spans]  # "2 9 watts"
        superseded = _superseded(plain, first)
        weighing = _weighing_lists(plain, first, roles)
        plausible = [
            number
            for number in first.loose
            if not _is_a_limit(plain, number, bounded)
            and (number.start, number.end) not in superseded
            and number not in weighing
        ]
        users = _users(plain, plausible, {number: roles[number]["user"] for number in plausible})
        look = second_look(first, users, _borrowing(first, roles, [*users, *weighing]))
        self._look, self._view = look, look.view() if look is not first else view
        self.mentions = look.mentions
        self.figures = sorted([*look.figures, *look.unread], key=lambda figure: figure.start)
        self._said: dict[Mention, Mapping[str, float]] = {}
        self._means: dict[int, Mapping[str, float]] = {}
        self._places = {figure.start: place for place, figure in enumerate(look.figures)}
        self.doubtful = [
            (number.start, number.end)
            for number in first.ones
            if number.start not in {figure.start for figure in look.figures}
            and roles[number]["rate"] + roles[number]["power"] > _PERHAPS
        ]
        self.weights = [
            n for n in look.loose if n in weighing or (_weighs(plain, n, roles[n]) and not _may_be_a_multiple(look, n))
        ]
        together = {len(mention.users) for mention in self.mentions if len(mention.users) > 1}
        others = [number for number in plausible if number in look.loose]
        self.recounted = [(number.start, number.end) for number in others if number.value in together]
        self.harmless = [*idioms(plain), *self.recounted, *superseded]
        self.harmless += [(mention.start, mention.end) for mention in self.mentions if mention.role != "named"]
        self.harmless += [
            (number.start, number.end)
            for number in others
            if _says_nothing(number, roles[number], {user for mention in self.mentions for user in mention.users})
        ]
        self.lists = [
            *_lists(plain, [f for f in look.figures if f.kind == "rate"]),
            *_lists(plain, [number for number in self.weights if number.form != "times"]),
        ]
        self._owners = {figure.start: self._owners_of(figure.start) for figure in look.figures if figure.kind == "rate"}
        self._owners |= {number.start: self._owners_of(number.start) for number in self.weights}
        self._owned = [(chances, 1.0) for chances in self._owners.values()]
        self._owned += [
            (self._owners_of(number.start), roles[number]["weight"])
            for number in look.loose
            if number not in self.weights and roles[number]["weight"] > _PERHAPS
        ]

    def _owners_of(self, start: int) -> Mapping[Mention | None, float]:
        everyone = [*self.mentions, None]
        model = shipped_roles()
        scores = [model.scores("link", features)[0] for features in self._view.owners(start, everyone)]
        return likely(scores, everyone)

    def figure(self, index: int) -> Mapping[str, float]:
        """How likely a power, a rate or a ratio has each role; all figures of one list have the same."""
        figure = self.figures[index]
        if figure.start not in self._means:
            together = next((each for each in self.lists if figure.start in each), [figure.start])
            each = [_answers(figure.kind, self._view.figure(self._places[start])) for start in together]
            joint = {role: math.prod(chances[role] for chances in each) ** (1 / len(each)) for role in each[0]}
            total = sum(joint.values())
            chances = {role: chance / total for role, chance in joint.items()}
            self._means |= dict.fromkeys(together, chances)
        return self._means[figure.start]

    def said_of(self, mention: Mention) -> Mapping[str, float]:
        """The same by the words alone."""
        if mention not in self._said:
            self._said[mention] = _answers("user", self._view.user(mention))
        return self._said[mention]

    def user(self, mention: Mention) -> Mapping[str, float]:
        """How likely somebody named is left out, served alone, or neither: by the words, and by what is theirs."""
        owning, by_words = self._owning(mention), self.said_of(mention)
        if self._look.unread:  # a figure that may be theirs
            return by_words
        joint = {
            role: chance * (_OWNS[role] * owning / _OWN + (1 - _OWNS[role]) * (1 - owning) / (1 - _OWN))
            for role, chance in by_words.items()
        }
        total = sum(joint.values())
        return {role: chance / total for role, chance in joint.items()}

    def _owning(self, mention: Mention) -> float:
        """How likely some rate or weight is meant for somebody mentioned."""
        same = [other for other in self.mentions if other == mention or not set(other.users).isdisjoint(mention.users)]
        return 1 - math.prod(1 - sure * sum(chances[other] for other in same) for chances, sure in self._owned)

    def owners(self, start: int, candidates: Sequence[Mention]) -> Mapping[Mention | None, float]:
        """How likely the figure at ``start`` is for each of the candidates, or, as None, for everybody."""
        chances = self._owners[start]
        able = {mention: chances[mention] for mention in (*candidates, None)}
        total = sum(able.values()) or 1.0
        return {mention: chance / total for mention, chance in able.items()}


def _lists(plain: str, items: Sequence[Quantity] | Sequence[Number]) -> list[list[int]]:
    """Where the items of each list begin, "2, 1 and 0.5 Mbit/s"; a range is none."""
    found: list[list[int]] = []
    last: Quantity | Number | None = None
    for item in items:
        joined = last is not None and _ITEMS.fullmatch(plain, last.end, item.start) is not None
        if joined and not (isinstance(item, Quantity) and isinstance(last, Quantity) and _is_range(last, item)):
            found[-1].append(item.start)
        else:
            found.append([item.start])
        last = item
    return [each for each in found if len(each) > 1]


def _is_range(one: Quantity, other: Quantity) -> bool:
    return (one.comparator, other.comparator) == ("at_least", "at_most")


def _answers(question: str, features: set[str]) -> Mapping[str, float]:
    return likely(shipped_roles().scores(question, features), LABELS[question])


def _borrowing(look: Look, roles: Mapping[Number, Mapping[str, float]], users: Sequence[Number]) -> dict[Number, str]:
    """The numbers that are figures by the unit of another, each with its role."""
    found: dict[Number, str] = {}
    for number, chances in roles.items():
        role = max(BORROWING, key=lambda each: chances[each])
        if number not in users and _is_a_figure(look, number, chances, role):
            found[number] = role
    return found


def _is_a_figure(look: Look, number: Number, chances: Mapping[str, float], role: str) -> bool:
    """Whether a number that most likely has ``role`` may be read as a figure."""
    if role == "multiple":
        return chances[role] > _SURE_OF_A_FIGURE
    sure = sum(chances[each] for each in BORROWING if BORROWING[each] == BORROWING[role] and each != "multiple")
    if number in look.ones:
        return sure > _SURE_OF_ONE
    if SCALED.match(look.plain, number.end):
        return role == "rate" and sure > _LIKELY
    if look.bound(number) not in ("", "None"):  # nobody bounds a user or a description
        sure /= sure + sum(
            chances[each] for each in ("rate", "power", "weight", "limit") if BORROWING.get(each) != BORROWING[role]
        )
    return sure > (_LIKELY if BORROWING[role] == "ratio" else _SURE_OF_A_FIGURE)


def _says_nothing(number: Number, chances: Mapping[str, float], named: set[str]) -> bool:
    """Whether a number describes, weighs nothing ("the others 1"), or is somebody named before."""
    again = number.value is not None and number.value == int(number.value) and str(int(number.value)) in named
    return chances["harmless"] + (number.value == 1) * chances["weight"] + again * chances["user"] > _SURE_OF_NOTHING


def _weighs(plain: str, number: Number, chances: Mapping[str, float]) -> bool:
    """Whether a number says how much somebody counts."""
    able = number.value is not None and 0 <= number.value < _MOST_WEIGHT and SCALED.match(plain, number.end) is None
    return able and chances["weight"] > _SURE_OF_A_WEIGHT


def _weighing_lists(plain: str, look: Look, roles: Mapping[Number, Mapping[str, float]]) -> list[Number]:
    """The numbers of lists as long as a list of users, of which one surely says how much somebody counts."""
    lengths = {len(mention.users) for mention in look.mentions}
    lists: list[list[Number]] = []
    for number in look.loose:
        able = number.value is not None and 0 <= number.value < _MOST_WEIGHT and number.form != "times"
        if lists and lists[-1] and able and _ITEMS.fullmatch(plain, lists[-1][-1].end, number.start):
            lists[-1].append(number)
        else:
            lists.append([number] if able else [])
    sure = [each for each in lists if len(each) > 1 and len(each) in lengths]
    return [
        number
        for each in sure
        if _WEIGHTS.search(plain, 0, each[0].start) or any(_weighs(plain, n, roles[n]) for n in each)
        for number in each
    ]


def _may_be_a_multiple(look: Look, number: Number) -> bool:
    """Whether a "double" may as well be of the rate before it: "1 Mbit/s each, double for user 3"."""
    after_a_rate = any(figure.kind == "rate" and figure.end <= number.start for figure in look.figures)
    return number.form == "times" and after_a_rate and _WEIGHED.search(look.plain) is None


def _users(plain: str, numbers: Sequence[Number], chances: Mapping[Number, float]) -> list[Number]:
    """The numbers that are users: surely, or likelier than not beside one that surely is ("2, 5 and 7")."""
    able = [n for n in numbers if n.value is not None and 0 <= n.value == int(n.value) < _MOST_BARE_USERS]
    able = [n for n in able if _COUNTS.match(plain, n.end) is None]
    able = [n for n in able if COUNTED_USERS.match(plain, n.start) is None and FOREIGN_UNIT.match(plain, n.end) is None]
    lists: list[list[Number]] = []
    for number in able:
        if lists and JOINT.fullmatch(plain, lists[-1][-1].end, number.start):
            lists[-1].append(number)
        else:
            lists.append([number])
    lists = [each for each in lists if _WEIGHTS.search(plain, 0, each[0].start) is None]
    sure = [each for each in lists if max(chances[number] for number in each) > _SURE_OF_A_USER]
    found = [number for each in sure for number in each if chances[number] > _ONE_OF_A_LIST]
    if any(_HEADS.match(plain, number.end) for number in found):  # "1: 1 Mbit/s, 2: 2 Mbit/s"
        found += [number for number in able if number not in found and _HEADS.match(plain, number.end)]
    return found


def _is_a_limit(plain: str, number: Number, bounded: Sequence[tuple[int, int]]) -> bool:
    """Whether a number can be no mere description: it is bounded, scaled ("2M"), a part of one, or has a unit."""
    within = any(start <= number.end and number.start < end for start, end in bounded)
    corrects = CORRECTION.search(plain, max(0, number.start - _NEAR), number.start) is not None
    part = number.value is not None and 0 < number.value < 1
    return within or part or corrects or may_be_a_limit(plain, number)


def _superseded(plain: str, look: Look) -> list[tuple[int, int]]:
    """The numbers that the figure after them corrects: "make it 20, no, 22 W"."""
    return [
        (number.start, number.end)
        for number in look.loose
        for figure in look.figures
        if 0 < figure.start - number.end <= _NEAR and CORRECTION.search(plain, number.end, figure.start) is not None
    ]


def with_numbers(plain: str, found: Sequence[Mention], users: Sequence[Number]) -> list[Mention]:
    """Mentions, and numbers that are users as well, from left to right, the items of a list made one."""
    bare = [
        Mention(role="named", users=(str(int(number.value or 0)),), start=number.start, end=number.end)
        for number in users
    ]
    return merged(plain, sorted([*found, *bare], key=lambda mention: mention.start))

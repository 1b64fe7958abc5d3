"""Every figure, number and user of one sentence, each with what it most likely is.

Numbers come first: the model says which are users ("al 6"), which weigh and which only describe. Then it is asked what
the users and the figures are there for, with all of them in sight.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language.figure_roles import LABELS, SCALED, View, likely, shipped_roles
from wirelessagent.language.figure_words import CORRECTION, COUNTED_USERS
from wirelessagent.language.leftovers import idioms, loose_numbers, may_be_a_limit
from wirelessagent.language.mentions import JOINT, Mention, mentions, merged
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity

_ONE_OF_A_LIST, _NEAR = 0.3, 24
_MOST_WEIGHT = 10**6
_SURE_OF_A_USER, _SURE_OF_A_WEIGHT, _SURE_OF_AN_OUTAGE, _SURE_OF_NOTHING = 0.7, 0.8, 0.6, 0.7


class Judged:
    """A sentence's figures with units, its users, its weights, and the numbers that mean nothing for the request.

    Attributes:
        figures: the quantities with a unit that lie outside ``taken``.
        mentions: everybody spoken of, from left to right.
        weights: numbers and words that say how much somebody counts.
        outages: where numbers stand that are an outage or a reliability, and which of the two.
        recounted: the spans of numbers that only count the users of a mention again ("users 2 and 5, those two").
        harmless: the spans of numbers that describe and limit nothing, such as a time of day.
    """

    def __init__(
        self, plain: str, quantities: Sequence[Quantity], names: Sequence[str], taken: Sequence[tuple[int, int]]
    ) -> None:
        self.figures = [
            figure
            for figure in quantities
            if figure.kind != "bare" and not any(start < figure.end and figure.start < end for start, end in taken)
        ]
        spans = [(figure.start, figure.end) for figure in self.figures]
        found = mentions(plain, names, [*spans, *taken])
        loose = loose_numbers(plain, [*spans, *taken, *((mention.start, mention.end) for mention in found)])
        view = View(plain, self.figures, found, loose)
        roles = {number: _answers("number", view.number(number)) for number in loose}
        bounded = [(q.start, q.end) for q in quantities if q.kind == "bare" and q.comparator is not None]
        bounded += [(start - 1, end) for start, end in spans]  # "2 9 watts"
        plausible = [number for number in loose if not _is_a_limit(plain, number, bounded)]
        users = _users(plain, plausible, {number: roles[number]["user"] for number in plausible})
        self.weights = [
            number
            for number in loose
            if roles[number]["weight"] > _SURE_OF_A_WEIGHT
            and number.value is not None
            and 0 <= number.value < _MOST_WEIGHT
            and SCALED.match(plain, number.end) is None
        ]
        self.outages = {
            number.start: "outage" if roles[number]["outage"] > roles[number]["reliability"] else "reliability"
            for number in loose
            if roles[number]["outage"] + roles[number]["reliability"] > _SURE_OF_AN_OUTAGE
        }
        self.harmless = idioms(plain)
        self.mentions = with_numbers(plain, found, users) if users else found
        together = {len(mention.users) for mention in self.mentions if len(mention.users) > 1}
        others = [number for number in plausible if number not in users]
        self.recounted = [(number.start, number.end) for number in others if number.value in together]
        self.harmless += self.recounted
        self.harmless += [
            (number.start, number.end)
            for number in others
            if roles[number]["harmless"] + (number.value == 1) * roles[number]["weight"] > _SURE_OF_NOTHING
        ]
        rest = [number for number in loose if number not in users]
        self._view = View(plain, self.figures, self.mentions, rest) if users else view

    def figure(self, index: int) -> Mapping[str, float]:
        """How likely a power, a rate or a ratio has each role."""
        return _answers(self.figures[index].kind, self._view.figure(index))

    def user(self, mention: Mention) -> Mapping[str, float]:
        """How likely somebody named is left out, served alone, or neither."""
        return _answers("user", self._view.user(mention))

    def owners(self, start: int, candidates: Sequence[Mention]) -> Mapping[Mention | None, float]:
        """How likely the figure at ``start`` is for each of the candidates, or, as None, for everybody."""
        everyone = [*candidates, None]
        model = shipped_roles()
        scores = [model.scores("link", features)[0] for features in self._view.owners(start, everyone)]
        return likely(scores, everyone)


def _answers(question: str, features: set[str]) -> Mapping[str, float]:
    return likely(shipped_roles().scores(question, features), LABELS[question])


def _users(plain: str, numbers: Sequence[Number], chances: Mapping[Number, float]) -> list[Number]:
    """The numbers that are users: surely, or likelier than not beside one that surely is ("2, 5 and 7")."""
    able = [n for n in numbers if n.value is not None and n.value == int(n.value) >= 0]
    able = [number for number in able if COUNTED_USERS.match(plain, number.start) is None]
    lists: list[list[Number]] = []
    for number in able:
        if lists and JOINT.fullmatch(plain, lists[-1][-1].end, number.start):
            lists[-1].append(number)
        else:
            lists.append([number])
    sure = [each for each in lists if max(chances[number] for number in each) > _SURE_OF_A_USER]
    return [number for each in sure for number in each if chances[number] > _ONE_OF_A_LIST]


def _is_a_limit(plain: str, number: Number, bounded: Sequence[tuple[int, int]]) -> bool:
    """Whether a number can be no mere description: it is bounded, scaled ("2M"), a part of one, or has a unit."""
    within = any(start <= number.end and number.start < end for start, end in bounded)
    corrects = CORRECTION.search(plain, max(0, number.start - _NEAR), number.start) is not None
    part = number.value is not None and 0 < number.value < 1
    return within or part or corrects or number.form == "times" or may_be_a_limit(plain, number)


def with_numbers(plain: str, found: Sequence[Mention], users: Sequence[Number]) -> list[Mention]:
    """Mentions, and numbers that are users as well, from left to right, the items of a list made one."""
    bare = [
        Mention(role="named", users=(str(int(number.value or 0)),), start=number.start, end=number.end)
        for number in users
    ]
    return merged(plain, sorted([*found, *bare], key=lambda mention: mention.start))

"""Every figure, number and user of one sentence, each with what it most likely is.

Numbers come first: the model says which are users ("al 6"), which weigh and which only describe. Then it is asked what
the users and the figures are there for, with all of them in sight.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language.figure_roles import LABELS, SCALED, View, likely, shipped_roles
from wirelessagent.language.figure_words import COUNTED_USERS
from wirelessagent.language.leftovers import idioms, loose_numbers, may_be_a_limit
from wirelessagent.language.mentions import Mention, mentions, merged
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity

_SURE_OF_A_USER, _SURE_OF_A_WEIGHT, _SURE_OF_AN_OUTAGE, _SURE_OF_NOTHING = 0.7, 0.8, 0.6, 0.7


class Judged:
    """A sentence's figures with units, its users, its weights, and the numbers that mean nothing for the request.

    Attributes:
        figures: the quantities with a unit that lie outside ``taken``.
        mentions: everybody spoken of, from left to right.
        weights: numbers and words that say how much somebody counts.
        outages: where numbers stand that are an outage or a reliability, and which of the two.
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
        users = [
            number
            for number in plausible
            if _is_user(number, roles[number]["user"]) and COUNTED_USERS.match(plain, number.start) is None
        ]
        self.weights = [
            number
            for number in loose
            if SCALED.match(plain, number.end) is None and roles[number]["weight"] > _SURE_OF_A_WEIGHT
        ]
        self.outages = {
            number.start: "outage" if roles[number]["outage"] > roles[number]["reliability"] else "reliability"
            for number in loose
            if roles[number]["outage"] + roles[number]["reliability"] > _SURE_OF_AN_OUTAGE
        }
        self.harmless = idioms(plain)
        self.harmless += [
            (number.start, number.end)
            for number in plausible
            if roles[number]["harmless"] + (number.value == 1) * roles[number]["weight"] > _SURE_OF_NOTHING
        ]
        self.mentions = with_numbers(plain, found, users) if users else found
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


def _is_user(number: Number, chance: float) -> bool:
    return chance > _SURE_OF_A_USER and number.value is not None and number.value == int(number.value) >= 0


def _is_a_limit(plain: str, number: Number, bounded: Sequence[tuple[int, int]]) -> bool:
    """Whether a number can be no mere description: it is bounded, scaled ("2M"), a part of one, or has a unit."""
    within = any(start <= number.end and number.start < end for start, end in bounded)
    part = number.value is not None and 0 < number.value < 1
    return within or part or number.form == "times" or may_be_a_limit(plain, number)


def with_numbers(plain: str, found: Sequence[Mention], users: Sequence[Number]) -> list[Mention]:
    """Mentions, and numbers that are users as well, from left to right, the items of a list made one."""
    bare = [
        Mention(role="named", users=(str(int(number.value or 0)),), start=number.start, end=number.end)
        for number in users
    ]
    return merged(plain, sorted([*found, *bare], key=lambda mention: mention.start))

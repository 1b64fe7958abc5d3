"""Every figure, number and user of one sentence, each with what it most likely is.

Numbers come first: the model says which are users ("al 6"), which borrow the unit of another figure ("the others only
one"), which weigh and which only describe. Then it is asked what the users and the figures are there for, with all of
them in sight.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TypeVar

from wirelessagent.language.figure_roles import answers, likely, shipped_roles
from wirelessagent.language.lifted import is_part, named_in
from wirelessagent.language.looks import first_look, second_look, with_strangers
from wirelessagent.language.mentions import Mention
from wirelessagent.language.number_roles import ITEMS, PERHAPS, NumberRoles
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity

_Answer = TypeVar("_Answer")
# The share of those who have a rate or a weight, among all users named and among those of each role.
_OWN, _OWNS = 0.7, {"users": 0.4, "given": 0.95, "unclear": 0.2}
_OWNS_ELSE = 0.02
_ONCE, _MOST_POWERS, _HARDLY = ("max_power_w", "circuit_power_w"), 4, 0.01


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
        strangers: the spans of names that no user is known by; they are mentions, too.
    """

    def __init__(
        self, plain: str, quantities: Sequence[Quantity], names: Sequence[str], taken: Sequence[tuple[int, int]]
    ) -> None:
        first = first_look(plain, quantities, names, taken)
        view = first.view()
        limits = [span for span, _ in named_in(plain)]
        self.strangers = [each for each in view.strangers() if not any(is_part(each, limit) for limit in limits)]
        if self.strangers:
            first = with_strangers(first, self.strangers)
            view = first.view()
        numbers = NumberRoles(first, view)
        look = second_look(first, numbers.users, numbers.borrowing)
        self._look, self._view = look, numbers.view if look is first else look.view()
        self.mentions = look.mentions
        self.figures = sorted([*look.figures, *look.unread], key=lambda figure: figure.start)
        self.doubtful = numbers.doubtful(look)
        self.weights = numbers.weights(look)
        self.recounted = numbers.recounted(look)
        self.harmless = numbers.harmless(look)
        self.lists = [
            *_lists(plain, [f for f in look.figures if f.kind == "rate"]),
            *_lists(plain, [number for number in self.weights if number.form != "times"]),
        ]
        self._said: dict[Mention, Mapping[str, float]] = {}
        self._owners = {figure.start: self._owners_of(figure.start) for figure in look.figures if figure.kind == "rate"}
        self._owners |= {number.start: self._owners_of(number.start) for number in self.weights}
        self._means = self._meanings()
        self._owned = [(chances, 1.0) for chances in self._owners.values()]
        self._owned += [
            (self._owners_of(number.start), numbers.chances[number]["weight"])
            for number in look.loose
            if number not in self.weights and numbers.chances[number]["weight"] > PERHAPS
        ]

    def _owners_of(self, start: int) -> Mapping[Mention | None, float]:
        everyone = [*self.mentions, None]
        model = shipped_roles()
        scores = [model.scores("link", features)[0] for features in self._view.owners(start, everyone)]
        return likely(scores, everyone)

    def figure(self, index: int) -> Mapping[str, float]:
        """How likely a power, a rate or a ratio has each role."""
        return self._means[self.figures[index].start]

    def role(self, index: int) -> str:
        """The likeliest role of a power, a rate or a ratio."""
        chances = self.figure(index)
        return max(chances, key=lambda role: chances[role])

    def _meanings(self) -> dict[int, Mapping[str, float]]:
        """By place, how likely each figure has each role: those of a list have the same, and a cell has one limit."""
        means: dict[int, Mapping[str, float]] = {}
        for place, figure in enumerate(self._look.figures):
            means[figure.start] = answers(figure.kind, self._view.figure(place))
        for starts in self.lists:
            each = [means[start] for start in starts if start in means]
            if each:
                joint = {role: math.prod(chances[role] for chances in each) ** (1 / len(each)) for role in each[0]}
                means |= dict.fromkeys(starts, _shares(joint))
        powers = [figure.start for figure in self._look.figures if figure.kind == "power"][:_MOST_POWERS]
        return means | dict(zip(powers, _each_once([means[start] for start in powers]), strict=True))

    def said_of(self, mention: Mention) -> Mapping[str, float]:
        """How likely somebody named has each role, by the words alone."""
        if mention not in self._said:
            self._said[mention] = answers("user", self._view.user(mention))
        return self._said[mention]

    def user(self, mention: Mention) -> Mapping[str, float]:
        """The same by the words, and by what is theirs."""
        owning, by_words = self._owning(mention), self.said_of(mention)
        if self._look.unread:  # a figure that may be theirs
            return by_words
        joint = {
            role: chance * (owns * owning / _OWN + (1 - owns) * (1 - owning) / (1 - _OWN))
            for role, chance in by_words.items()
            for owns in [_OWNS.get(role, _OWNS_ELSE)]
        }
        return _shares(joint)

    def telling(self, mention: Mention, role: str) -> tuple[int, int]:
        """The span of somebody named and of the words beside that say what they are there for."""
        return self._view.telling(mention, role)

    def _owning(self, mention: Mention) -> float:
        """How likely some rate or weight is meant for somebody mentioned."""
        same = [other for other in self.mentions if other == mention or not set(other.users).isdisjoint(mention.users)]
        return 1 - math.prod(1 - sure * sum(chances[other] for other in same) for chances, sure in self._owned)

    def owners(self, start: int, candidates: Sequence[Mention]) -> Mapping[Mention | None, float]:
        """How likely the figure at ``start`` is for each of the candidates, or, as None, for everybody."""
        chances = self._owners[start]
        return _shares({mention: chances[mention] for mention in (*candidates, None)})


def _each_once(chances: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """How likely each power has each role where none of ``_ONCE`` is had twice."""
    able = [[role for role, chance in each.items() if chance > _HARDLY] for each in chances]
    found = [dict.fromkeys(each, 0.0) for each in chances]
    for roles in itertools.product(*able):
        if all(roles.count(role) < 2 for role in _ONCE):
            share = math.prod(each[role] for each, role in zip(chances, roles, strict=True))
            for each, role in zip(found, roles, strict=True):
                each[role] += share
    return [_shares(each) if sum(each.values()) else one for each, one in zip(found, chances, strict=True)]


def _shares(chances: Mapping[_Answer, float]) -> dict[_Answer, float]:
    """Chances that add up to one."""
    total = sum(chances.values()) or 1.0
    return {answer: chance / total for answer, chance in chances.items()}


def _lists(plain: str, items: Sequence[Quantity] | Sequence[Number]) -> list[list[int]]:
    """Where the items of each list begin, "2, 1 and 0.5 Mbit/s"; a range is none."""
    found: list[list[int]] = []
    last: Quantity | Number | None = None
    for item in items:
        joined = last is not None and ITEMS.fullmatch(plain, last.end, item.start) is not None
        if joined and not (isinstance(item, Quantity) and isinstance(last, Quantity) and _is_range(last, item)):
            found[-1].append(item.start)
        else:
            found.append([item.start])
        last = item
    return [each for each in found if len(each) > 1]


def _is_range(one: Quantity, other: Quantity) -> bool:
    return (one.comparator, other.comparator) == ("at_least", "at_most")

"""Every figure and user of one sentence, each with what it most likely is there for.

Its numbers are settled first (:mod:`.number_roles`); then the model is asked what the users and the figures are there
for, with all of them in sight.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from wirelessagent.language.as_meant import CHANGES, LEADS, RAISES
from wirelessagent.language.figure_roles import answers, likely, shipped_roles
from wirelessagent.language.intent import RATES
from wirelessagent.language.mentions import ARTICLES, EXCEPTED, GIVEN_TO, JOINT_WORDS, NOBODY, WHO, Mention
from wirelessagent.language.number_roles import ITEMS, Numbers, everybody_named, jointly, moved, runs, series, shares
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.request import numbered
from wirelessagent.language.stated import CARRIERS, EACH_CARRIER, POWER_NOUNS, is_spared, shares_power
from wirelessagent.language.text import Beside, Phrases, Span, clause_start, is_chinese
from wirelessagent.language.word_tables import any_word, deferred, either, words_of

# The share of those who have a rate or a weight, among all users named and among those of each role.
_OWN, _OWNS = 0.7, {"users": 0.4, "given": 0.95, "unclear": 0.2}
_OWNS_ELSE = 0.02
_AS = either("figures", "bounds", "as_bounds")
_HEADS = {
    bound: Beside(
        deferred(rf"(?i){said}[^.:;\uff1a。；]{{0,20}}[:\uff1a]\s*(?:[^\s.;]*\s){{0,4}}(?:[0-9]+号|[^\s.;0-9])*$"),
        deferred(rf"(?i)\s*(?:{_AS})\s*{said}(?!\w)"),
    )
    for bound, name in (("min_rate_bps", "floors_of"), ("max_rate_bps", "caps_of"))
    for said in [any_word("figures", "bounds", name)]
}
"""What may stand ahead of the first of a series, "floors in Mbit/s: u1 0.5, u2 0.75", or behind its last, "as caps"."""
_HEAD = any_word("figures", "bounds", "floors_of", "caps_of")
_UNBOUND = deferred(rf"(?i)\s*(?:$|[^\w\s]|{GIVEN_TO}|{JOINT_WORDS}|(?:{_AS})\s*{_HEAD}(?!\w))")
_CEILINGS = ("max_power_w", "subcarrier_max_power_w")
BOUNDED = {"at_least": "min_rate_bps", "at_most": "max_rate_bps"}
_DENIED = Phrases(either("moods", "negation", "clause"))
_CARRIER_AHEAD = deferred(
    rf"(?i){EACH_CARRIER}\w*\s*(?:(?:{either('figures', 'users', 'takes')}|{POWER_NOUNS}|功率|上限|[:=])\s*)*$"
)
_CARRIER_BEHIND = deferred(rf"(?i)\s*(?:(?:on|in|for|auf|bei|en|sur|dans|pour|para)\s+)?{EACH_CARRIER}")
_RAISED = deferred(rf"(?i)(?:{RAISES})\W.*(?:{LEADS}|\b{any_word('figures', 'users', 'as_far_as')})\s*$")
_CAPS = deferred(
    rf"(?i)\b(?:{'|'.join(words_of('figures', 'bounds', 'caps'))})|m[aá]x|上限|限速|封顶|最高|"
    rf"{any_word('figures', 'lifted', 'ceilings')}|{any_word('figures', 'bounds', 'caps_of')}"
)
_OF_CIRCUITS = either("figures", "bounds", "circuit")
_CIRCUIT = deferred(  # "the static power to 3 W", but not, behind a figure, "2 W static power, 10 W …"
    rf"(?i)(?:^|\w.*|[,;.、，；。])\s*(?:{_OF_CIRCUITS})(?:[\s:=]|{CHANGES}|{LEADS}|为|{ARTICLES})*$"
)
_SURE = 0.8
_ONCE, _MOST_POWERS, _HARDLY = ("max_power_w", "circuit_power_w", "subcarrier_max_power_w"), 4, 0.01

_Means: TypeAlias = dict[int, Mapping[str, float]]
"""By the place of a figure, how likely it has each role."""
_Same: TypeAlias = tuple[Sequence[int], Mapping[str, float]]
"""The places of figures, and how likely each of them has each role."""


class Judged:
    """A sentence's figures with units and its users.

    Attributes:
        numbers: what its numbers are.
        figures: the quantities with a unit that lie outside ``taken``, those with a bound of unknown unit among them.
        mentions: everybody spoken of, from left to right.
        lists: where the rates or the weights of each list begin.
        users_of_the_cell: as they are referred to, "3" being "user 3".
    """

    def __init__(self, plain: str, quantities: Sequence[Quantity], names: Sequence[str], taken: Sequence[Span]) -> None:
        self.users_of_the_cell = [numbered(name) for name in names]
        self.numbers = numbers = Numbers(plain, quantities, names, taken)
        self._look = look = numbers.look
        self.view = numbers.view
        self.mentions = look.mentions
        self.figures = sorted([*look.figures, *look.unread], key=lambda figure: figure.start)
        rates = [figure for figure in look.figures if figure.kind == "rate"]
        lists: list[Sequence[Quantity | Number]] = [
            *runs(plain, rates, ITEMS),
            *runs(plain, [number for number in numbers.weights if number.form != "times"], ITEMS),
        ]
        self.lists = [[item.start for item in each] for each in lists if len(each) > 1]
        named_at = [(mention.start, mention.end) for mention in everybody_named(look.mentions)]
        self._series = list(series(plain, rates, named_at))
        self._said: dict[Mention, Mapping[str, float]] = {}
        self._owners = {item.start: self._owners_of(item.start) for item in (*rates, *numbers.weights)}
        self._means = self._meanings()
        self._owned = [(each, 1.0) for each in self._owners.values()]
        self._owned += [(self._owners_of(n.start), numbers.chances[n]["weight"]) for n in numbers.perhaps_weights]

    def _owners_of(self, start: int) -> Mapping[Mention | None, float]:
        named = [each for each in self.mentions if each.role == "named" and each.end <= start]
        between = [each for each in self.mentions if each.role != "pronoun" and each.start < start]
        others = not named or between[-1] != named[-1]
        if not others and WHO.fullmatch(self._look.plain, named[-1].end, start):
            return {named[-1]: 1.0}  # "except user 5, who needs 1 Mbit/s"
        last = between[-1] if between else None
        if last and NOBODY.search(self._look.plain[last.start : last.end]):
            return {last: 1.0}  # "the others at least 1 Mbit/s, and nobody goes above 6 Mbit/s"
        everyone = [*(each for each in self.mentions if not self._is_aside(each)), None]
        seen = self.view.owners(start, everyone)
        return likely([shipped_roles().scores("link", features)[0] for features in seen], everyone)

    def _is_aside(self, mention: Mention) -> bool:
        """Whether more is said of somebody excepted than that: "all but user 5, who needs 1 Mbit/s, get …"."""
        who = WHO.match(self._look.plain, mention.end)
        return who is not None and EXCEPTED.search(self._look.plain, 0, mention.start) is not None

    def figure(self, index: int) -> Mapping[str, float]:
        """How likely a power, a rate or a ratio has each role."""
        return self._means[self.figures[index].start]

    def role(self, index: int) -> str:
        """The likeliest role of a power, a rate or a ratio."""
        chances = self.figure(index)
        return max(chances, key=lambda role: chances[role])

    def _meanings(self) -> _Means:
        """How likely each figure has each role; what those have that stand for the same kind of thing is found then."""
        means: _Means = {}
        for find in (self._of_each, self._of_series, self._of_those_excepted, self._of_powers):
            for starts, chances in find(means):
                means |= dict.fromkeys(starts, chances)
        return means

    def _of_each(self, means: _Means) -> Iterator[_Same]:
        carriers, figures = CARRIERS.search(self._look.plain) is not None, self._look.figures
        for place, figure in enumerate(figures):
            before = figures[place - 1].phrase_end if place else 0
            next_ = next((each.phrase_start for each in figures[place + 1 :]), len(self._look.plain) + 1)
            chances = answers(figure.kind, self.view.figure(place))
            yield [figure.start], _as_bounded(self._look.plain, figure, chances, (before, next_), carriers=carriers)

    def _of_series(self, means: _Means) -> Iterator[_Same]:
        """One bound for all of a row: "cap 1 at 1.5, 4 at 2 and 6 at 2.5 Mbit/s"."""
        plain = self._look.plain
        for row in self._series:
            first, *behind = row
            starts = [first.start, *(each.start for each in itertools.takewhile(self._has_no_bound, behind))]
            if first.comparator is None:
                yield starts, jointly([means[start] for start in starts])
            bound = BOUNDED.get(first.comparator or "") if first.phrase_start < first.start else None
            if first.comparator is None:
                bound = next(
                    (name for name, head in _HEADS.items() if head.is_at(plain, first.start, row[-1].end)), None
                )
            if bound is not None:  # not "2 Mbit/s max, user 3 1 Mbit/s"
                yield starts, moved(means[first.start], (*RATES, "both"), bound)

    def _of_those_excepted(self, means: _Means) -> Iterator[_Same]:
        """What bounds all the others: "at most 2 Mbit/s, but for user 2, who is at 1 Mbit/s"."""
        for last, figure in itertools.pairwise(each for each in self._look.figures if each.kind == "rate"):
            open_ = figure.comparator is None and max(means[figure.start].values()) < _SURE
            ahead = [each.start for each in self.mentions if each.end <= figure.start]
            if open_ and any(EXCEPTED.search(self._look.plain, last.end, start) for start in ahead):
                yield [figure.start], jointly([means[last.start], means[figure.start]])

    def _of_powers(self, means: _Means) -> Iterator[_Same]:
        """A cell has one limit of each kind."""
        powers = [each.start for each in self._look.figures if each.kind == "power"][:_MOST_POWERS]
        for start, chances in zip(powers, _each_once([means[start] for start in powers]), strict=True):
            yield [start], chances

    def _has_no_bound(self, figure: Quantity) -> bool:
        """Whether a figure leaves open how it bounds: "user 2 1 Mbit/s guaranteed" does not."""
        plain, end = self._look.plain, figure.end
        somebody = any(plain[end : each.start].isspace() for each in self.mentions)
        return figure.comparator is None and (somebody or _UNBOUND.match(plain, end) is not None)

    def said_of(self, mention: Mention) -> Mapping[str, float]:
        """How likely somebody named has each role, by the words alone."""
        if mention not in self._said:
            said = answers("user", self.view.user(mention))
            surely = any(owners == {mention: 1.0} for owners in self._owners.values())
            self._said[mention] = dict.fromkeys(said, 0.0) | {"given": 1.0} if surely else said
        return self._said[mention]

    def user(self, mention: Mention) -> Mapping[str, float]:
        """The same by the words, and by how likely some rate or weight is theirs."""
        by_words = self.said_of(mention)
        same = [other for other in self.mentions if other == mention or not set(other.users).isdisjoint(mention.users)]
        theirs = ((sum(chances.get(other, 0.0) for other in same), sure) for chances, sure in self._owned)
        owning = 1 - math.prod(1 - sure * share for share, sure in theirs)
        joint = {
            role: chance * (owns * owning / _OWN + (1 - owns) * (1 - owning) / (1 - _OWN))
            for role, chance in by_words.items()
            for owns in [_OWNS.get(role, _OWNS_ELSE)]
        }
        return shares(joint)

    def owners(self, start: int, candidates: Sequence[Mention]) -> Mapping[Mention | None, float]:
        """How likely the figure at ``start`` is for each of the candidates, or, as None, for everybody."""
        chances = self._owners[start]
        return shares({mention: chances.get(mention, 0.0) for mention in (*candidates, None)})


def _as_bounded(
    plain: str, figure: Quantity, chances: Mapping[str, float], beside: Span, *, carriers: bool
) -> Mapping[str, float]:
    """How likely a figure has each role, a limit being the one that its bound says: what is "at least" is no ceiling.

    ``beside`` is where the figure ahead ends and the next begins. No power is one of a subcarrier where nothing speaks
    of ``carriers``, and what is "of the power budget" is no promise.
    """
    if figure.kind == "power" and figure.comparator == "at_least":
        return moved(chances, _CEILINGS, "floor")
    if figure.kind == "ratio" and is_spared(plain, figure):
        return moved(chances, tuple(chances), "share")
    if figure.kind == "ratio" and shares_power(plain, figure):
        return moved(chances, ("outage", "reliability"), "share")
    if figure.kind == "power" and _is_of_a_carrier(plain, figure, beside):
        return moved(chances, tuple(chances), "subcarrier_max_power_w")
    if figure.kind == "power" and _CIRCUIT.search(plain, beside[0], figure.start):
        return moved(chances, ("max_power_w", "subcarrier_max_power_w", "change", "unclear"), "circuit_power_w")
    if figure.kind == "power" and _lead_on(plain, _CARRIER_BEHIND.match(plain, figure.phrase_end), beside[1]):
        return moved(chances, ("stale", "subcarrier_max_power_w"), "max_power_w")
    if figure.kind == "power" and not carriers:
        return moved(chances, ("subcarrier_max_power_w",), "max_power_w")
    bound = BOUNDED.get(figure.comparator or "") if figure.kind == "rate" else None
    ahead = plain[clause_start(plain, figure.phrase_start, beside[0]) : figure.phrase_start]
    raised = _RAISED.search(ahead) if figure.kind == "rate" and figure.comparator is None else None
    if raised and _CAPS.search(ahead, raised.start()) is None:  # not "raise the cap of user 3 to …"
        bound = "min_rate_bps"
    return chances if bound is None else moved(chances, (*RATES, "both"), bound)


def _is_of_a_carrier(plain: str, figure: Quantity, beside: Span) -> bool:
    """Whether a power is said to be one of each subcarrier, behind it or ahead, between the figures ``beside``.

    What is denied is none: "not 10 W per subcarrier".
    """
    before, next_ = beside
    clause = plain[max(before, clause_start(plain, figure.phrase_start)) : figure.phrase_start]
    taken = before and _CARRIER_BEHIND.match(plain, before)  # "0.1 W per subcarrier and 10 W in total"
    ahead = None if taken else _CARRIER_AHEAD.search(clause)
    behind = _CARRIER_BEHIND.match(plain, figure.phrase_end)
    own = behind is not None and not _lead_on(plain, behind, next_)
    return (own or ahead is not None) and _DENIED.search(clause) is None


def _lead_on(plain: str, words: re.Match[str] | None, start: int) -> bool:
    """Whether words behind a figure are of the next, right ahead of which they stand: 14瓦每个子载波最多60毫瓦."""
    return words is not None and words.end() == start and is_chinese(plain[start - 1])


def _each_once(chances: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """How likely each power has each role where none of ``_ONCE`` is had twice."""
    able = [[role for role, chance in each.items() if chance > _HARDLY] for each in chances]
    found = [dict.fromkeys(each, 0.0) for each in chances]
    for roles in itertools.product(*able):
        if all(roles.count(role) < 2 for role in _ONCE):
            share = math.prod(each[role] for each, role in zip(chances, roles, strict=True))
            for each, role in zip(found, roles, strict=True):
                each[role] += share
    return [shares(each) if sum(each.values()) else one for each, one in zip(found, chances, strict=True)]

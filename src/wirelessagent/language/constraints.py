"""Which constraint each figure of a sentence means, or the question that it raises; who gets it: ``allotments``.

What a power, a rate or a percentage is there for a small model judges from the words beside it (``judged``); where it
is not sure, and where a figure does not fit in whatever role (a total rate, an amount to save, no unit, zero watts), a
doubt is raised instead of dropping or bending the figure.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from wirelessagent.language.allotments import Allotments, Target
from wirelessagent.language.as_meant import CHANGES, LEADS, taking_back
from wirelessagent.language.comparators import WITH, nouns_of
from wirelessagent.language.intent import RATES
from wirelessagent.language.judged import Judged
from wirelessagent.language.mentions import ARTICLES, GIVEN_TO
from wirelessagent.language.moods import named_in
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.stated import (
    Reading,
    doubt_parts,
    take_blocks,
    take_counts,
    take_multiples,
)
from wirelessagent.language.text import AND, Beside, Phrases, Span, blanked, clause_start, overlaps
from wirelessagent.language.word_tables import any_word, deferred, either

_STEP = Phrases(either("figures", "one", "watt_more"), marks="watt vatio 一瓦")
_SET = deferred(rf"(?i)(?:{CHANGES})(?:\s+(?!{AND})\w+){{0,3}}?\s*$")
_AT = rf"(?:{LEADS}|(?<![A-Za-zÀ-ÿ]){any_word('figures', 'becoming', 'at')}(?![A-Za-zÀ-ÿ])|[:=])"
_SET_TO = deferred(
    rf"(?i)(?:[\s@]|{CHANGES}|{GIVEN_TO}|(?:{ARTICLES})|\b[ld]'|\b{any_word('figures', 'shares_of', 'of')}\b|{_AT})*"
    rf"(?:@|{_AT})\s*"
)
_MINIMUM = deferred(rf"(?i){either('figures', 'becoming', 'minimum')}")
_NOUNS = "|".join(either("figures", "bounds", name) for name in ("between", "rate", "power"))
_FOR = deferred(r"(?i)\s*(?:\b(?:for|to|für|para|pour|à)\b|给)\s*(?:the\s+|l'\s?|el\s+|los\s+|les\s+)?")
_TAKES = either("figures", "users", "takes")
_ONE = either("figures", "users", "singly")
_SINGLY = Beside(
    deferred(rf"(?i)(?:{_ONE})\s*(?:(?:{_TAKES})\s*)?$"),
    deferred(rf"(?i)\s*(?:(?:for|für|para|pour)\s+)?(?:{_ONE})"),
)
_NEITHER = deferred(rf"(?i)(?:{either('figures', 'users', 'neither')})\s*$")
_LIMITS = (
    *RATES, "both", "max_power_w", "circuit_power_w", "subcarrier_max_power_w", "outage",
    "reliability", "share",
)  # fmt: skip
_ASKED = {
    "change": "change", "part": "calculated", "total": "total_rate", "floor": "power_floor",
    "per_user": "power_per_user",
}  # fmt: skip
_UNSURE = {"rate": "status", "power": "whose_power", "ratio": "share"}
_HUGE_POWER_W = 1e5  # no cell radiates this much: a megawatt is a misspelt milliwatt
_TINY_POWER_W = 1e-8  # nor so little: that is noise
_MOST_OUTAGE, _SURE_OF_A_PROMISE = 0.3, 0.9
"""A promise that is kept so seldom is a share of something else, unless the words surely say so."""

_SURE, _SURE_OF_A_LIMIT = 0.6, {"power": 0.75, "rate": 0.6, "ratio": 0.6}
"""Most figures are limits, so that the model takes a strange one for one too easily."""


def _said_of(name: str) -> Beside:
    """Words of a list beside a figure."""
    words = either("figures", "bounds", name)
    return Beside(
        deferred(rf"(?i)(?:{words})(?:[\s:=]*(?!\b{WITH})(?:{_NOUNS}))*[\s:=]*$"),
        deferred(rf"(?i)\s*(?:(?:each|apiece|per \w+)\s+)?(?:{words})"),
    )


_OF_ANOTHER_KIND, _OF_SEVERAL, _OF_ANOTHER_SHARE = map(_said_of, ("of_another_kind", "of_several", "of_another_share"))


def read_constraints(
    text: str, plain: str, quantities: Sequence[Quantity], *, names: Sequence[str] = (), max_power_w: float = 20.0
) -> Reading:
    """The constraints in a sentence: its original text, the same normalised, and its quantities.

    ``names`` are the channel's users, ``max_power_w`` what shares of the power refer to.
    """
    reading = Reading(text=text, plain=plain, quantities=quantities, turns=list(taking_back(plain, figures=True)))
    take_blocks(reading)
    take_multiples(reading)
    reader = _Reader(reading, names, max_power_w)
    reader.take_numbers()
    reader.take_figures()
    reader.take_users()
    return reading


class _Reader:
    """One pass over the figures of a sentence."""

    def __init__(self, reading: Reading, names: Sequence[str], max_power_w: float) -> None:
        self._reading, self._max_power_w = reading, max_power_w
        self._judged = Judged(reading.plain, reading.quantities, names, reading.spoken_for)
        for number in self._judged.numbers.groups:
            reading.take_group(float(number.value or 0), (number.start, number.end))
        if self._judged.numbers.groups:  # which are no figures to calculate with
            self._judged = Judged(reading.plain, reading.quantities, names, reading.spoken_for)
        self._allotments = Allotments(reading, self._judged)

    def take_numbers(self) -> None:
        """Numbers without a unit: users, weights, descriptions and what borrows a unit are settled."""
        reading, judged = self._reading, self._judged
        reading.counted += judged.numbers.harmless
        named = [(m.start, m.end) for m in judged.mentions if m.role == "named"]
        read = [(figure.start, figure.end) for figure in judged.figures]
        settled = [*reading.counted, *named, *read, *self._allotments.spans, *reading.spoken_for]
        for figure in reading.quantities:
            if figure.kind != "bare" or overlaps((figure.start, figure.end), settled):
                continue
            reading.masked.append((figure.phrase_start, figure.phrase_end))
            reading.doubt("unit_missing", text=figure.text)
        for number in judged.numbers.multiplied:
            reading.doubt("calculated", text=reading.text[number.start : number.end])
        for start, end in judged.numbers.doubtful:
            reading.doubt("unit_missing", text=reading.text[start:end])

    def take_figures(self) -> None:
        """Powers, rates and percentages, from left to right."""
        for index, figure in enumerate(self._judged.figures):
            self._reading.masked.append((figure.phrase_start, figure.phrase_end))
            doubt = self._taken(index, figure)
            self._reading.marks.append((figure.start, figure.end, self._mark(index, figure)))
            if doubt:
                self._reading.doubt(doubt, text=figure.text)

    def _mark(self, index: int, figure: Quantity) -> str:
        """What a figure was read as, and whose a rate is; a share of the power limits it as any other figure does."""
        if figure.kind not in _SURE_OF_A_LIMIT:
            return figure.kind
        whose = self._allotments.target_of(figure.start).role if figure.kind == "rate" else ""
        role = self._judged.role(index)
        return f"{'max_power_w' if role == 'share' else role} {whose}".strip()

    def _taken(self, index: int, figure: Quantity) -> str:
        """Take a figure for what it is there for; the key of the question that it raises, "" for none."""
        if figure.kind == "other":
            return "not_understood"
        if figure.doubtful:
            return "bits_or_bytes"
        if figure.kind != "ratio" and not 0 < figure.value < math.inf:
            return "impossible"
        if figure.kind == "ratio" and self._reading.changes_by(figure):
            return "change"
        reading, chances = self._reading, self._judged.figure(index)
        role = self._judged.role(index)
        following = [other for other in self._judged.figures[index + 1 : index + 2] if other.kind == figure.kind]
        limits = sum(chances.get(name, 0.0) for name in _LIMITS)
        if role in _ASKED:
            if role == "change":
                reading.steps["power_w" if figure.kind == "power" else "rate_bps"] = figure.value
            return _ASKED[role]
        if role == "unclear" and following:  # nobody could say which holds: "10 W or 12 W"
            reading.doubt("conflict", one=figure.text, other=following[0].text)
            return ""
        if role == "unclear":
            return _UNSURE[figure.kind]
        if role not in _LIMITS:
            if 1 - limits < _SURE:
                return _UNSURE[figure.kind]
            if role == "refused" and len(self._judged.figures) == 1:
                return "refused"
            if role == "stale":  # the words by which the next figure takes its place wish and deny nothing
                reading.masked += [(figure.end, other.start) for other in following]
            if role == "missing":
                reading.missing = figure.value
                reading.not_used.append(figure.text)
            else:
                reading.counted.append((figure.start, figure.end))
            return ""
        if limits < _SURE_OF_A_LIMIT[figure.kind] or chances[role] < _SURE * limits:
            return _UNSURE[figure.kind]
        if figure.kind == "ratio" and not (0 < figure.value < 1 or (role == "share" and figure.value == 1)):
            return "impossible"
        return self._limited(index, figure)

    def _limited(self, index: int, figure: Quantity) -> str:
        """Take a figure as a limit, or say what is to be asked."""
        role = self._judged.role(index)
        self._reading.masked += self._setting(figure, role)
        another = self._with(_OF_ANOTHER_KIND, figure)
        if another:
            self._reading.doubt("another_figure", text=another)
        elif role == "share":
            self._reading.take_share(figure, self._max_power_w)
        elif figure.kind == "ratio":
            if self._with(_OF_ANOTHER_SHARE, figure):
                return "share"
            outage = figure.value if role == "outage" else round(1 - figure.value, 15)
            if outage > _MOST_OUTAGE and self._judged.figure(index)[role] < _SURE_OF_A_PROMISE:
                return "share"
            self._reading.take("outage_probability", outage, figure)
        elif figure.kind == "power":
            if role != "subcarrier_max_power_w" and (self._with(_SINGLY, figure) or self._is_for_a_user(figure)):
                return "power_per_user"
            if figure.value > _HUGE_POWER_W:
                return "huge"
            if figure.value < _TINY_POWER_W:
                return "whose_power"
            self._reading.take(role, figure.value, figure)
        else:
            target = self._allotments.target_of(figure.start)
            if len(target.users) != 1 and self._with(_OF_SEVERAL, figure):  # "sum rate with 1 Mbit/s for user 7"
                return "total_rate"
            denied = target.mention and _NEITHER.search(self._reading.plain, 0, target.mention.start)
            if not target.sure or (denied and figure.comparator is None):  # "neither 3 nor 4 gets 1 Mbit/s"
                return "whose_rate"
            for name in RATES if role == "both" else (role,):
                self._give(name, target, figure)
        return ""

    def _setting(self, figure: Quantity, role: str) -> Iterator[Span]:
        """Where words set a limit to a figure, and wish for nothing: "raise the minimum rate of user 3 to 2 Mbit/s"."""
        plain = blanked(self._reading.plain, ((each.start, each.end) for each in self._judged.mentions), "@")
        start = clause_start(plain, len(plain[: figure.phrase_start].rstrip(" :")))
        start = max([start, *(each.end for each in self._judged.figures if each.end <= figure.start)])
        nouns = [span for span, name in named_in(plain) if name == role]
        nouns += nouns_of(figure.kind, plain)
        nouns += [each.span() for each in _MINIMUM.finditer(plain) if role == "min_rate_bps"]
        for first, last in nouns:
            if start <= first and last <= figure.start and _SET_TO.fullmatch(plain, last, figure.start):
                verb = _SET.search(plain, start, first)
                yield verb.start() if verb else first, figure.end

    def _give(self, name: str, target: Target, figure: Quantity) -> None:
        earlier = self._allotments.give(name, target, figure)
        if earlier is not None:
            self._reading.doubt("conflict", one=earlier, other=figure.text)

    def _with(self, said: Beside, figure: Quantity) -> str:
        """A figure with such words ahead or behind, at most its users between: "1 Mbit/s on average"; "" for none."""
        plain, start, end = self._reading.plain, figure.phrase_start, figure.phrase_end
        users = [each for each in self._judged.mentions if each.role == "named"]
        starts = [start, *(each.start for each in users if not plain[each.end : start].strip() and each.end <= start)]
        ends = [end, *(each.end for each in users if _FOR.fullmatch(plain, end, each.start))]
        ahead = [match.start() for at in starts if (match := said.ahead.search(plain, clause_start(plain, at), at))]
        behind = [match.end() for at in ends if (match := said.behind.match(plain, at))]
        spans = [*((first, end) for first in ahead), *((start, last) for last in behind)]
        return self._reading.text[slice(*spans[0])].strip() if spans else ""

    def _is_for_a_user(self, figure: Quantity) -> bool:
        """Whether a power is said to be somebody's: "2 W for user 3"."""
        return any(_FOR.fullmatch(self._reading.plain, figure.phrase_end, each.start) for each in self._judged.mentions)

    def take_users(self) -> None:
        """What users are given, and those who are counted, some of them, or named for nothing: each is a doubt."""
        reading, allotted = self._reading, self._allotments
        for start, end in allotted.take_users():
            reading.doubt("named_user", text=reading.text[start:end])
        take_counts(reading, allotted.spans, len(self._judged.users_of_the_cell))
        doubt_parts(reading, allotted.spans)
        if _STEP.search(reading.plain) is not None:
            reading.steps.setdefault("power_w", 1.0)
        reading.strangers = self._judged.numbers.strangers
        allotted.settle()

"""Which constraint each figure of a sentence means, or the question that it raises.

What a power, a rate or a percentage is there for, and for whom, a small model judges from the words beside it
(``judged``); where it is not sure, and where a figure does not fit in whatever role (a total rate, an amount to save,
no unit, zero watts), a doubt is raised instead of dropping or bending the figure.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from wirelessagent.language.allotments import Allotments
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Constraint
from wirelessagent.language.judged import Judged
from wirelessagent.language.powers import Powers
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.rates import Rates
from wirelessagent.language.ratios import nines
from wirelessagent.language.stated import Notes, Reading
from wirelessagent.language.surroundings import Neighbours, is_calculated, is_change, is_refused
from wirelessagent.language.text import Phrases
from wirelessagent.language.whole_cell import doubt_parts, take_blocks, take_counts, take_share

_MISSING = deferred(
    r"(?ia)\b(?:missing|lost|loss|unknown|holes?|absent|gone|faltar\w*|falta\w*|perd\w*|manqu\w*|fehl\w*|"
    r"verloren)\b|缺失|丢失|缺少|丢包|未知|缺|丢"
)
_STEP = Phrases(
    r"\b(?:one|an?|another)\s+(?:more\s+)?watt(?:\s+more)?\b|(?:再?多|再加|加)一瓦|"
    r"\bun vatio más\b|\bun watt de plus\b|\bein watt mehr\b",
    marks="watt vatio 一瓦",
)

_SURE = 0.6


def read_constraints(
    text: str, plain: str, quantities: Sequence[Quantity], *, names: Sequence[str] = (), max_power_w: float = 20.0
) -> Reading:
    """The constraints in a sentence: its original text, the same normalised, and its quantities.

    ``names`` are the channel's users, ``max_power_w`` what shares of the power refer to.
    """
    notes = Notes(text, plain, quantities)
    take_blocks(notes)
    take_share(notes, max_power_w)
    reader = _Reader(notes, names)
    reader.take_numbers()
    reader.take_figures()
    reader.take_users()
    return reader.result()


class _Reader:
    """One pass over the figures of a sentence."""

    def __init__(self, notes: Notes, names: Sequence[str]) -> None:
        self._notes = notes
        self._judged = Judged(notes.plain, notes.quantities, names, notes.spoken_for)
        self._allotments = Allotments(notes.text, notes.plain, self._judged)
        self._neighbours = Neighbours(notes.plain, self._judged.figures, self._judged.mentions)
        self._powers = Powers(notes, self._judged, self._neighbours)
        self._rates = Rates(notes, self._judged, self._neighbours, self._allotments)

    def result(self) -> Reading:
        notes, allotted = self._notes, self._allotments
        for one, other, key in allotted.crossed():
            notes.doubt(
                key, **({"low": one, "high": other} if key == "rates_crossed" else {"one": one, "other": other})
            )
        values: dict[str, Constraint] = {**notes.values, **allotted.values()}
        return Reading(
            values=values, evidence=notes.evidence | allotted.evidence(), doubts=notes.doubts, not_used=notes.not_used,
            masked=[*notes.masked, *allotted.spans], counted=notes.counted,
            exact=frozenset(notes.exact | allotted.exact), missing=notes.missing, steps=notes.steps,
            back=allotted.back, named=allotted.named,
        )  # fmt: skip

    def take_numbers(self) -> None:
        """Numbers without a unit: users, weights, descriptions and what borrows a unit are settled."""
        notes, judged = self._notes, self._judged
        notes.counted += judged.harmless
        named = [(m.start, m.end) for m in judged.mentions if m.role == "named"]
        read = [(figure.start, figure.end) for figure in judged.figures]
        settled = [*notes.counted, *named, *read, *self._allotments.spans, *notes.spoken_for]
        for figure in notes.quantities:
            if figure.kind != "bare" or any(start < figure.end and figure.start < end for start, end in settled):
                continue
            notes.masked.append((figure.phrase_start, figure.phrase_end))
            notes.doubt("unit_missing", text=figure.text)
        for start, end in judged.doubtful:
            notes.doubt("unit_missing", text=notes.text[start:end])

    def take_figures(self) -> None:
        """Powers, rates and percentages, from left to right."""
        for index, figure in enumerate(self._judged.figures):
            self._notes.masked.append((figure.phrase_start, figure.phrase_end))
            doubt = self._doubt_about(figure, *self._neighbours.beside(index))
            if doubt:
                self._notes.doubt(doubt, text=figure.text)
            elif is_refused(*self._neighbours.beside(index)):
                self._refuse(figure)
            elif figure.kind == "ratio":
                self._take_ratio(index)
            elif figure.kind == "power":
                self._powers.take(index)
            elif self._neighbours.is_replaced(index):
                self._notes.counted.append((figure.start, figure.end))
            else:
                self._rates.take(index)
        for one, other in itertools.pairwise(self._judged.figures):
            self._rates.doubt_a_choice(one, other)

    def _doubt_about(self, figure: Quantity, before: str, after: str) -> str:
        """The key of the question that a figure raises in whatever role; "" for none."""
        if figure.kind == "other":
            return "not_understood"
        if figure.doubtful:
            return "bits_or_bytes"
        if is_calculated(before, after):
            return "calculated"
        return "" if figure.kind == "ratio" or 0 < figure.value < math.inf else "impossible"

    def _refuse(self, figure: Quantity) -> None:
        """A figure that is not wanted describes what another one mends; without one it is asked for."""
        if any(other.kind == figure.kind and other is not figure for other in self._judged.figures):
            self._notes.counted.append((figure.start, figure.end))
        else:
            self._notes.doubt("refused", text=figure.text)

    def _take_ratio(self, index: int) -> None:
        """A share of the channel that is missing, an outage or a reliability."""
        notes, figure, (before, after) = self._notes, self._judged.figures[index], self._neighbours.beside(index)
        if _MISSING.search(before + " " + after):
            notes.missing = figure.value
            notes.not_used.append(figure.text)
            return
        certain = any(figure.start == each.start for each in nines(notes.plain))
        chances = {"reliability": 1.0} if certain else self._judged.figure(index)
        role = max(chances, key=lambda name: chances[name])
        changes = is_change(before, after)
        if role == "none" and chances[role] > _SURE and not changes:
            notes.counted.append((figure.start, figure.end))
        elif role == "none" or chances[role] < _SURE or changes:
            notes.doubt("share", text=figure.text)
        elif not 0 < figure.value < 1:
            notes.doubt("impossible", text=figure.text)
        else:
            outage = figure.value if role == "outage" else round(1 - figure.value, 15)
            notes.take("outage_probability", outage, figure)

    def take_users(self) -> None:
        """Users who are counted, some of them, and those named who get nothing, of whom each raises a doubt."""
        notes, allotted = self._notes, self._allotments
        take_counts(notes, self._judged.recounted, allotted.spans)
        doubt_parts(notes, allotted.spans)
        for start, end in allotted.take_users():
            notes.doubt("named_user", text=notes.text[start:end])
        if _STEP.search(notes.plain) is not None:
            notes.steps.setdefault("power_w", 1.0)

"""The figures that an LLM may use: those that the parser found, what follows from them, and the conversation's own.

The LLM refers to them by label or repeats their value; it brings none of its own. What follows from a figure (99 %
reliability is an outage of 1 %, 40 % of the power is 8 W) is worked out here, so that the LLM only says which is meant.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.language.comparators import Comparator
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.language.numerals import numbers
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.text import normalise

FigureKind: TypeAlias = Literal["power", "rate", "ratio", "number", "unusable"]

UNITS: dict[FigureKind, str] = {"power": "W", "rate": "bit/s", "ratio": "", "number": "", "unusable": ""}
KINDS: dict[str, FigureKind] = {
    "max_power_w": "power",
    "circuit_power_w": "power",
    "subcarrier_max_power_w": "power",
    "min_rate_bps": "rate",
    "max_rate_bps": "rate",
    "outage_probability": "ratio",
    "weights": "number",
    "resource_block_group_size": "number",
}
"""Which kind of figure each constraint takes."""

DETAIL_KINDS: dict[str, FigureKind] = {
    "power_w": "power",
    "rate_bps": "rate",
    "missing_share": "ratio",
    "number": "number",
}
"""Which kind of figure each detail of a question or command takes."""

_MULTIPLES: tuple[tuple[float, str], ...] = (
    (2.0, r"\b(?:twice|doubled?|doubles|doubling|doble|doppelt\w*|deux fois|dos veces)\b|翻倍|翻一番|加倍|双倍"),
    (3.0, r"\b(?:thrice|tripled?|triples|triple|dreifach\w*|trois fois|tres veces)\b|三倍"),
    (0.5, r"\b(?:half|halved?|halves|halb\w*|mitad|moitié)\b|减半|一半"),
)


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A figure with a label.

    Attributes:
        label: F1 for the sentence's own, F1b for what follows from it, N1 for a count or a multiple, S1 for one of the
            conversation.
        value: in SI units.
        words: the operator's words for it, or where it comes from.
        comparator: how the sentence bounds it.
        quantity: whether the sentence states it and something must become of it.
        stands_for: the constraint that a figure of the conversation or of the rules belongs to, and no other; "" for
            the sentence's own.
    """

    label: str
    value: float
    kind: FigureKind
    words: str
    comparator: Comparator | None = None
    quantity: bool = False
    stands_for: str = ""

    @property
    def parent(self) -> str:
        """The label of the sentence's own figure that this one follows from."""
        return self.label.rstrip("bcd")


def figures_of(text: str, context: Context, offline: Intent) -> tuple[Figure, ...]:
    """Every figure that may be used for a sentence.

    >>> from wirelessagent.language.offline import OfflineRecogniser
    >>> sentence = "at most 10 W"
    >>> [(f.label, f.value) for f in figures_of(sentence, Context(), OfflineRecogniser().recognise(sentence))]
    [('F1', 10.0), ('S1', 20.0)]
    """
    quantities = parse_quantities(text)
    found: list[Figure] = []
    for place, quantity in enumerate(quantities, start=1):
        found.extend(_stated(f"F{place}", quantity, context))
    found.extend(_numbers(text, quantities))
    own = _of_session(context)
    known = [*found, *own]
    return (*known, *_read_by_rules(offline, known, start=len(own) + 1))


def matching(figures: Iterable[Figure], given: str | float, kind: FigureKind, name: str = "") -> Figure | None:
    """The figure of this kind that a label or a value refers to; the sentence's own before others.

    ``name`` is the constraint that it is for: a figure that belongs to another one is not taken.
    """
    number = _number(given)
    label = given.strip().casefold() if isinstance(given, str) else ""
    for figure in figures:
        means = figure.label.casefold() == label if number is None else math.isclose(figure.value, number, rel_tol=1e-6)
        own = not name or figure.stands_for in ("", name)
        if (
            means
            and own
            and (figure.kind == kind or (kind == "number" and figure.kind == "unusable" and figure.value > 0))
        ):
            return figure
    return None


def _number(given: str | float) -> float | None:
    if not isinstance(given, str):
        return float(given)
    try:
        return float(given)
    except ValueError:
        return None


def _stated(label: str, quantity: Quantity, context: Context) -> Iterator[Figure]:
    sound = 0 < quantity.value < math.inf and not quantity.doubtful
    kind: FigureKind = "unusable"
    if sound and (quantity.kind == "power" or quantity.kind == "rate" or quantity.kind == "ratio"):
        kind = quantity.kind
    yield Figure(
        label=label, value=quantity.value, kind=kind, words=quantity.text, comparator=quantity.comparator, quantity=True
    )
    if kind == "ratio" and quantity.value < 1:
        rest = round(1 - quantity.value, 12)
        limit = context.max_power_w
        yield Figure(label=f"{label}b", value=rest, kind="ratio", words=f"what {quantity.text} leaves of the whole")
        yield Figure(
            label=f"{label}c", value=quantity.value * limit, kind="power", words=f"{quantity.text} of {limit:g} W"
        )
        yield Figure(
            label=f"{label}d", value=rest * limit, kind="power", words=f"{limit:g} W reduced by {quantity.text}"
        )


def _numbers(text: str, quantities: Sequence[Quantity]) -> Iterator[Figure]:
    """Counts, names and multiples: the numbers that are no quantities."""
    plain = normalise(text)
    found: list[tuple[int, float, str]] = []
    for number in numbers(plain):
        inside = any(quantity.start <= number.start < quantity.end for quantity in quantities)
        if number.value is not None and math.isfinite(number.value) and not inside:
            found.append((number.start, float(number.value), plain[number.start : number.end]))
    for value, words in _MULTIPLES:
        found.extend((match.start(), value, match.group()) for match in re.finditer(f"(?i:{words})", plain))
    for place, (_, value, words) in enumerate(sorted(found), start=1):
        yield Figure(label=f"N{place}", value=value, kind="number", words=words)


def _of_session(context: Context) -> list[Figure]:
    """The cell's limit and the figures of the current request."""
    limit = context.max_power_w
    found = [Figure(label="S1", value=limit, kind="power", words="the cell's limit", stands_for="max_power_w")]
    sources = (("current request", context.constraints), ("before the question", context.pending))
    for where, constraints in sources:
        for name, value in _values(constraints):
            words = f"{name} of the {where}" if where == "current request" else f"{name}, said {where}"
            label = f"S{len(found) + 1}"
            found.append(Figure(label=label, value=value, kind=KINDS[name], words=words, stands_for=name))
    return found


def _read_by_rules(offline: Intent, known: Sequence[Figure], *, start: int) -> Iterator[Figure]:
    """What the rules work out from the sentence and nothing above holds, such as a rate that is to be doubled."""
    place = start
    stated = _values({**offline.pending, **offline.constraints})
    read: list[tuple[str, FigureKind, object]] = [(name, KINDS[name], value) for name, value in stated]
    read.extend((name, kind, offline.details.get(name)) for name, kind in DETAIL_KINDS.items())
    for name, kind, value in read:
        limit = name if name in KINDS else ""
        if isinstance(value, int | float) and matching(known, value, kind, limit) is None:
            words = offline.evidence.get(name) or name
            yield Figure(label=f"S{place}", value=float(value), kind=kind, words=words, stands_for=limit)
            place += 1


def _values(constraints: Mapping[str, Constraint]) -> Iterator[tuple[str, float]]:
    for name, value in constraints.items():
        if name not in KINDS:
            continue
        for each in value.values() if isinstance(value, Mapping) else [value]:
            if isinstance(each, int | float):
                yield name, float(each)

"""What a sentence holds: figures with a unit, everybody mentioned, and the numbers that are neither.

It is looked at twice: before anybody asks what the numbers are, and with those settled that turned out to be users or
to borrow the unit of another figure ("user 3 needs 2 Mbit/s, the others only one", "twice that"). Which numbers borrow,
the model of roles says (``judged``); here they get their unit and their value.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from wirelessagent.language.deferred import deferred
from wirelessagent.language.figure_roles import SCALED, View
from wirelessagent.language.leftovers import loose_numbers
from wirelessagent.language.mentions import Mention, mentions, merged
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity, QuantityKind
from wirelessagent.language.readings import Reading, readings
from wirelessagent.language.text import Span, overlaps
from wirelessagent.language.units import unit_at

BORROWING: Mapping[str, QuantityKind] = {
    "rate": "rate", "power": "power", "multiple": "rate", "outage": "ratio", "reliability": "ratio",
    "share": "ratio",
}  # fmt: skip
_SCALES = {"k": 10**3, "K": 10**3, "M": 10**6, "G": 10**9}
_DECLARED = deferred(r"(?i)\b(?:in|en)\s+")
_FAR = 200  # no two rates of one sentence are farther apart: another unit is meant
_PARTS = {"half": "0.5", "medi": "0.5", "demi": "0.5", "halb": "0.5", "quar": "0.25", "cuar": "0.25", "vier": "0.25"}
_ONE = deferred(  # "the others only one", against "one user"
    r"(?i)(?<![\w'-])(?:(?:one|uno|una|une?|ein(?:s|e[nmr]?)?)|"
    r"(?P<part>(?:an?\s+|une?\s+|ein(?:e[nr]?)?\s+)?(?:half|quarter|medio|cuarto|demie?|quart|halbe[sn]?|viertel)))"
    r"(?!\w)(?=\s*(?:$|[,.;:!?)]|(?:each|apiece|for|at|max|maximum|out|and|only|on|per|to|para|al?|el|y|como|con|seul|pour|au|"
    r"à|l'|seulement|et|chacun|für|bei|und|der|die|dem|pro|je|als|höchstens|mindestens)\b))"
)


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
    unread = [q for q in clear if q.kind == "other" and not overlaps((q.start, q.end), covered)]
    return Look(
        plain=plain, quantities=quantities, figures=stated, unread=unread, mentions=found, loose=loose, ones=alone
    )


def with_strangers(look: Look, names: Sequence[Span]) -> Look:
    """The same with those among the users mentioned who are called by ``names`` that nobody is known by."""
    found = _with_named(look, ((look.plain[start:end], (start, end)) for start, end in names))
    return dataclasses.replace(look, mentions=found)


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
    """Every "one" or "half" of a normalised text that stands alone, where no ``taken`` span is: no article is one."""
    for match in _ONE.finditer(plain):
        if not overlaps(match.span(), taken):
            part = match["part"]
            value = Decimal(1) if part is None else Decimal(_PARTS[part.lower().split()[-1][:4]])
            yield Number(value=value, start=match.start(), end=match.end(), form="words")


def figures_of(
    plain: str, roles: Mapping[Number, str], quantities: Sequence[Quantity], stated: Sequence[Quantity]
) -> dict[Number, Quantity]:
    """The numbers that borrow a unit or a value, as quantities; those are missing that find none to borrow.

    ``roles`` says what each number is, ``quantities`` hold their bounds, ``stated`` are the figures with a unit.
    """
    if not roles:
        return {}
    units = [reading for reading in readings(plain) if reading.unit is not None and reading.number.value is not None]
    units = units or list(_declared(plain))
    found: dict[Number, Quantity] = {}
    for number, role in roles.items():
        scaled = SCALED.match(plain, number.end) if BORROWING[role] == "rate" else None
        value = _value(number, role, scaled, units, [*stated, *found.values()])
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


def _declared(plain: str) -> Iterator[Reading]:
    """The unit that is said before all figures, as that of one: "en megas: 6 para el usuario 2"."""
    for match in _DECLARED.finditer(plain):
        unit = unit_at(plain, match.end())
        if unit is not None:
            number = Number(value=Decimal(1), start=match.end(), end=match.end(), form="words")
            yield Reading(number=number, unit=unit, start=match.end(), end=unit.end)


def _value(
    number: Number, role: str, scaled: re.Match[str] | None, units: Sequence[Reading], stated: Sequence[Quantity]
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
    able = [reading for reading in units if reading.unit is not None and reading.unit.kind == kind]
    before = [reading for reading in able if reading.end <= number.start][::-1]
    after = [reading for reading in able if reading.end > number.start]
    alike = [figure.value for figure in stated if figure.kind == kind]
    for reading in (*before, *after):
        value = reading.unit.value(number.value) if reading.unit is not None else 0.0
        if not alike or any(1 / _FAR <= value / other <= _FAR for other in alike if other > 0):
            return value
    return None

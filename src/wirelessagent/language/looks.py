"""What a sentence holds: figures with a unit, everybody mentioned, and the numbers that are neither.

It is looked at twice: before anybody asks what the numbers are, and with those settled that turned out to be users or
to borrow the unit of another figure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wirelessagent.language.borrowed import figures_of, ones
from wirelessagent.language.figure_roles import View
from wirelessagent.language.leftovers import loose_numbers
from wirelessagent.language.mentions import Mention, mentions, merged
from wirelessagent.language.nines import nines
from wirelessagent.language.numerals import Number
from wirelessagent.language.odds import odds
from wirelessagent.language.quantities import Quantity


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
        mentions=_with_numbers(look.plain, look.mentions, users) if users else look.mentions,
        loose=[number for number in look.loose if number not in borrowed and number not in users],
        ones=[],
    )


def _with_numbers(plain: str, found: Sequence[Mention], users: Sequence[Number]) -> list[Mention]:
    """Mentions, and numbers that are users as well, from left to right, the items of a list made one."""
    bare = [
        Mention(role="named", users=(str(int(number.value or 0)),), start=number.start, end=number.end)
        for number in users
    ]
    return merged(plain, sorted([*found, *bare], key=lambda mention: mention.start))

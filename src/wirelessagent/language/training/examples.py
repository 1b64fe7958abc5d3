"""The sentences that the network learns from: what they want, whether they order it, and how much each counts.

Drawn from templates (:mod:`.compose`), written down as people say them (:mod:`.spoken`), lines of talks, and frames
that are filled (:mod:`.orders`).
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from wirelessagent.language.sentence_model import TOLD
from wirelessagent.language.training.compose import OBJECTIVES, mistyped, sentences
from wirelessagent.language.training.orders import FILLED, FRAME, MILD, TALK, framed, in_talks
from wirelessagent.language.training.spoken import spoken

_DRAWN, _NEAR, _FILLING = 0.5, 0.3, 0.5
"""What the kind of a drawn aim counts, of a sentence that only orders or does not, and of the wish in a frame that
orders it, beside one that is known."""

_SLIPS = 0.15
"""How much of what people wrote of aims is read with a slip as well."""

_ASKED = ("?", "？", "吗")
"""How most questions end."""


class Example(NamedTuple):
    """A sentence, and what it teaches.

    Attributes:
        kind: the label that is right, or what all right ones begin with; "order" and "none" for any that does or not.
        kind_counts, order_counts: how much that teaches of its kind, and of whether it orders something.
        turns: in what share of the passes it is read.
        bent: whether it means something else than can be read of it; None where nobody knows.
        constraints: that it states, where it is known not to be ``bent``.
    """

    text: str
    kind: str
    kind_counts: float
    orders: bool
    order_counts: float
    turns: float
    bent: bool | None = None
    constraints: Mapping[str, Any] | None = None


def examples() -> Iterator[Example]:
    """All of them; the same each time.

    Raises:
        InputError: the sentences are not here; an installed package leaves them out.
    """
    for text, label in sorted(set(sentences(Path(__file__).parent))):
        aim, tells = label in OBJECTIVES, label.startswith(("command", "question"))
        yield Example(
            text, label, _DRAWN if aim else 1.0, label.startswith("command"), MILD if tells else 0.0,
            0.3 if aim else 0.6,
        )  # fmt: skip
    yield from _spoken()
    for text, does, kind in framed():
        taught, counts = (kind, _FILLING) if does else (_nothing(text), _NEAR)
        yield Example(text, taught, counts, does, FRAME / FILLED, 0.5)
    for text, does in in_talks():
        yield Example(text, "", 0.0, does, TALK, 0.5)


def _spoken() -> Iterator[Example]:
    slips = random.Random(1)
    for each in spoken():
        limits, asked = each.constraints, each.label == "clarify" and each.constraints is None
        kind = "clarify.limits" if each.label == "clarify" and limits else each.label
        counts = 0.0 if asked and each.turned else _NEAR if kind in ("order", "none") else 1.0
        kind, does = _nothing(each.text) if kind == "none" else kind, each.is_order
        tells = 0.0 if does is None else 1.0 if each.near else MILD
        bent = True if asked else None if limits is None else False
        example = Example(each.text, kind, counts, bool(does), tells, 1.0, bent, limits)
        yield example
        if (kind in OBJECTIVES or limits) and slips.random() < _SLIPS:
            yield example._replace(text=mistyped(each.text, slips))


def _nothing(text: str) -> str:
    """The kind of what orders nothing: most of it tells of an aim, some asks."""
    return "none" if text.rstrip(" .。!！").endswith(_ASKED) else TOLD

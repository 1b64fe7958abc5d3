"""The sentences that the network and the judge of orders learn from: what they want, and whether they order it.

They are drawn from templates (:mod:`.compose`), written down as people say them, ``spoken/<language>.tsv``, lines of
talks (:mod:`.talk_notation`), and frames that are filled, ``frames/<language>.tsv``.

Each line of the spoken ones is a label, a sentence, and for a request its constraints as JSON in SI units, where they
are known. Labels are objectives, kinds of intents, and topics of questions and commands; "none" is a question, a remark
or a report, all that orders nothing now, and "order" is what orders something that nobody wrote down. They were written
for training, by authors who saw no test set; those in ``<language>_near.tsv`` so that what orders something and what
does not are easily mistaken for each other; those in ``<language>_turned.tsv`` so that what means what its figures and
users look like and what does not are, too: groups of orders, and between them what has to be asked about, "clarify"
without constraints.

A line of the frames is "order" or "none" and a sentence with ``{}`` in the place of its wish.
"""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from wirelessagent.language.deferred import deferred
from wirelessagent.language.sentence_model import TOLD
from wirelessagent.language.training.compose import OBJECTIVES, mistyped, sentences, wishes
from wirelessagent.language.training.talk_notation import talks
from wirelessagent.model.errors import InputError

SPOKEN, FRAMES = Path(__file__).with_name("spoken"), Path(__file__).with_name("frames")

FILLED, _LONGEST, _CHOICE = 4, 60, 3_000
"""How often each frame is filled, in turns with what people said, in so many letters, and with one of so many drawn."""

MILD, FRAME, TALK = 0.6, 3.0, 0.8
"""What a sentence counts that was not written to be mistaken, a frame, and a line of a talk, beside one that was."""

_LINE = deferred(r"(?:\w+\W+){4}\w|[\u3400-\u9fff]{6}")
"""A line of a talk that says by itself whether it orders something: five words, or six Chinese characters."""

_DRAWN, _NEAR, _FILLING = 0.5, 0.3, 0.5
"""What the kind of a drawn aim counts, of a sentence that only orders or does not, and of the wish in a frame that
orders it, beside one that is known."""

_SLIPS = 0.15
"""How much of what people wrote of aims is read with a slip as well."""

_ASKED = ("?", "？", "吗")
"""How most questions end."""


@dataclass(frozen=True, kw_only=True)
class Spoken:
    """A sentence with its label; ``constraints`` are None where nobody wrote them down.

    Attributes:
        near: whether it was written to be mistaken.
        turned: whether it was written so that something else is read of it than it means, or nearly so.
    """

    text: str
    label: str
    language: str
    constraints: Mapping[str, Any] | None = None
    near: bool = False
    turned: bool = False

    @property
    def is_order(self) -> bool | None:
        """Whether it orders something now; None where it may or may not."""
        if self.label.startswith(("order", "command", *OBJECTIVES)) or (self.label == "clarify" and self.constraints):
            return True
        return False if self.label.startswith(("none", "question", "out_of_scope")) else None


def spoken(folder: Path = SPOKEN) -> Iterator[Spoken]:
    """The sentences of all languages.

    Raises:
        InputError: they are not here; an installed package leaves them out.
    """
    paths = sorted(folder.glob("*.tsv"))
    if not paths:
        raise InputError(f"no sentences in {folder}: train from a checkout of the sources, which has them")
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            label, text, *more = line.split("\t")
            language, _, near = path.stem.partition("_")
            yield Spoken(
                text=text, label=label, language=language, near=bool(near), turned=near == "turned",
                constraints=json.loads(more[0]) if more else None,
            )  # fmt: skip


def framed(folder: Path = FRAMES) -> Iterator[tuple[str, bool, str]]:
    """Each frame, filled with wishes, whether it orders something, and the kind of its wish.

    Raises:
        InputError: there are no frames; an installed package leaves them out.
    """
    paths = sorted(folder.glob("*.tsv"))
    if not paths:
        raise InputError(f"no frames in {folder}: train from a checkout of the sources, which has them")
    spoken_ones = [each for each in spoken() if each.label in OBJECTIVES and len(each.text) <= _LONGEST]
    for path in paths:
        drawn = list(itertools.islice(wishes(path.stem, random.Random(1)), _CHOICE))
        by_people = [(each.text, each.label) for each in spoken_ones if each.language == path.stem]
        for line in path.read_text(encoding="utf-8").splitlines():
            label, frame = line.split("\t")
            chance = random.Random(f"1 {frame}")  # what one is filled with hangs on no other
            for turn in range(FILLED):
                wish, kind = chance.choice(drawn if turn % 2 else by_people)
                wish = wish.rstrip(".!。！")
                yield frame.replace("{}", wish[:1].lower() + wish[1:]), label == "order", kind


def in_talks() -> Iterator[tuple[str, bool]]:
    """Every other line of the talks, where it is long enough, and whether it changes something."""
    said = itertools.chain.from_iterable(lines for _, lines, _ in talks())
    for text, does in itertools.islice(said, 0, None, 2):
        if _LINE.search(text):
            yield text, not does.startswith(("nothing", "ask", "suppose"))


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
    for text, label in sorted(set(sentences())):
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

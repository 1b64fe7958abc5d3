"""Make the judge of orders anew: ``python -m wirelessagent.language.training.orders [FILE]``; ten minutes.

It learns from the sentences of :mod:`.spoken` that are known to order something or nothing, and from frames: lines of
``frames/<language>.tsv``, "order" or "none" and a sentence with ``{}`` in the place of its wish, which is filled with
wishes of all kinds, and from the lines of talks. Those that were written to be mistaken for each other count most.
"""

from __future__ import annotations

import itertools
import logging
import random
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from wirelessagent.language.deferred import deferred
from wirelessagent.language.order_model import (
    BUCKETS,
    ORDER_FILE,
    Frame,
    OrderModel,
    features,
    word_hashes,
)  # fmt: skip
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.training.compose import OBJECTIVES, wishes
from wirelessagent.language.training.fit import fit, in_parallel, known_words, matrix_of
from wirelessagent.language.training.spoken import spoken
from wirelessagent.language.training.talk_notation import talks
from wirelessagent.model.errors import InputError

FRAMES = Path(__file__).with_name("frames")
FILLED, _LONGEST, _DRAWN = 4, 60, 3_000
"""How often each frame is filled, in turns with what people said, in so many letters, and with one of so many drawn."""

MILD, FRAME, TALK = 0.6, 3.0, 0.8
"""What a sentence counts that was not written to be mistaken, a frame, and a line of a talk, beside one that was."""

_LINE = deferred(r"(?:\w+\W+){4}\w|[\u3400-\u9fff]{6}")
"""A line of a talk that says by itself whether it orders something: five words, or six Chinese characters."""

_PASSES, _STEP = 6, 0.15
"""More of them tell these sentences apart better, and frames in other words worse."""


def framed(folder: Path = FRAMES, seed: int = 1) -> Iterator[tuple[str, bool, str]]:
    """Each frame, filled with wishes, whether it orders something, and the kind of its wish.

    Raises:
        InputError: there are no frames; an installed package leaves them out.
    """
    paths = sorted(folder.glob("*.tsv"))
    if not paths:
        raise InputError(f"no frames in {folder}: train from a checkout of the sources, which has them")
    spoken_ones = [each for each in spoken() if each.label in OBJECTIVES and len(each.text) <= _LONGEST]
    for path in paths:
        drawn = wishes(path.parent.parent, path.stem, random.Random(seed))
        drawn_ones = list(itertools.islice(drawn, _DRAWN))
        by_people = [(each.text, each.label) for each in spoken_ones if each.language == path.stem]
        for line in path.read_text(encoding="utf-8").splitlines():
            label, frame = line.split("\t")
            chance = random.Random(f"{seed} {frame}")  # what one is filled with hangs on no other
            for turn in range(FILLED):
                wish, kind = chance.choice(drawn_ones if turn % 2 else by_people)
                wish = wish.rstrip(".!。！")
                yield frame.replace("{}", wish[:1].lower() + wish[1:]), label == "order", kind


def in_talks() -> Iterator[tuple[str, bool]]:
    """Every other line of the talks, where it is long enough, and whether it changes something."""
    said = itertools.chain.from_iterable(lines for _, lines, _ in talks())
    for text, does in itertools.islice(said, 0, None, 2):
        if _LINE.search(text):
            yield text, not does.startswith(("nothing", "ask", "suppose"))


def main(path: Path) -> None:
    """Read, fit, write, and say how well the sentences are told apart that were written to be mistaken."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    log, start = logging.getLogger(__name__), time.perf_counter()
    said = [(each.text, each.is_order, 1.0 if each.near else MILD) for each in spoken() if each.is_order is not None]
    said += [(text, orders, FRAME / FILLED) for text, orders, _ in framed()]
    said += [(text, orders, TALK) for text, orders in in_talks()]
    frames = in_parallel(_frame, [text for text, *_ in said])
    log.info("%d sentences (%.0f s)", len(said), time.perf_counter() - start)
    labels, weight = ["yes" if orders else "no" for _, orders, _ in said], np.array([each[2] for each in said])
    model = made(frames, labels, weight)
    model.save(path)
    right = [(model.score(each) > 0) == (label == "yes") for each, label in zip(frames, labels, strict=True)]
    log.info("%.1f %% of them told apart; %s: %d kB (%.0f s)", 100 * np.average(right, weights=weight), path.name,
             path.stat().st_size // 1000, time.perf_counter() - start)  # fmt: skip


def _frame(text: str) -> Frame:
    return Sentence(text, own_words()).frame


def made(frames: Sequence[Frame], labels: Sequence[str], weight: npt.NDArray[np.float64]) -> OrderModel:
    """A model of what orders something ("yes") and what does not ("no")."""
    words = known_words(map(word_hashes, frames))
    known = frozenset(words.tolist())
    rows = matrix_of([features(frame, known) for frame in frames], BUCKETS)
    found, intercepts = fit(rows, labels, ("no", "yes"), weight, _PASSES, _STEP)
    weights = found[:, 1] - found[:, 0]
    scale = float(np.abs(weights).max()) / 127
    return OrderModel(
        weights=np.asarray(np.rint(weights / scale), dtype=np.int8), scale=scale,
        intercept=float(intercepts[1] - intercepts[0]), known=known,
    )  # fmt: skip


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ORDER_FILE)

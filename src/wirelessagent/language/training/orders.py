"""Make the judge of orders anew: ``python -m wirelessagent.language.training.orders [FILE]``; ten minutes.

It learns from the sentences that people wrote down and that are known to order something or nothing, from frames, which
are filled with wishes of all kinds, and from the lines of talks (:mod:`.examples`). Those that were written to be
mistaken for each other count most.
"""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from wirelessagent.language.order_model import BUCKETS, ORDER_FILE, Frame, OrderModel, features, word_hashes
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.training.examples import FILLED, FRAME, MILD, TALK, framed, in_talks, spoken
from wirelessagent.language.training.fit import fit, in_parallel, matrix_of


def main(path: Path) -> None:
    """Read, fit, write, and say how well the sentences are told apart that were written to be mistaken."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    log, start = logging.getLogger(__name__), time.perf_counter()
    said = [(each.text, each.is_order, 1.0 if each.near else MILD) for each in spoken() if each.is_order is not None]
    said += [(text, orders, FRAME / FILLED) for text, orders, _ in framed()]
    said += [(text, orders, TALK) for text, orders in in_talks()]
    frames = in_parallel(_frame, [text for text, *_ in said])
    log.info("%d sentences (%.0f s)", len(said), time.perf_counter() - start)
    orders, weight = np.array([orders for _, orders, _ in said]), np.array([each[2] for each in said])
    model = made(frames, orders, weight)
    model.save(path)
    right = (np.array([model.score(each) for each in frames]) > 0) == orders
    log.info("%.1f %% of them told apart; %s: %d kB (%.0f s)", 100 * np.average(right, weights=weight), path.name,
             path.stat().st_size // 1000, time.perf_counter() - start)  # fmt: skip


def _frame(text: str) -> Frame:
    return Sentence(text, own_words()).frame


def made(frames: Sequence[Frame], orders: npt.NDArray[np.bool_], weight: npt.NDArray[np.float64]) -> OrderModel:
    """A model of what orders something and what does not; it knows the words that stand in at least two sentences."""
    words, counts = np.unique([word for frame in frames for word in set(word_hashes(frame))], return_counts=True)
    known = frozenset[int](words[counts > 1].tolist())
    rows = matrix_of([features(frame, known) for frame in frames], BUCKETS)
    found, intercepts = fit(rows, np.stack([~orders, orders], axis=1), weight)
    weights = found[:, 1] - found[:, 0]
    scale = float(np.abs(weights).max()) / 127
    return OrderModel(
        weights=np.asarray(np.rint(weights / scale), dtype=np.int8), scale=scale,
        intercept=float(intercepts[1] - intercepts[0]), known=known,
    )  # fmt: skip


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ORDER_FILE)

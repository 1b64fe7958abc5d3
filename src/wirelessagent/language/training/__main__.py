"""Teach the network anew: ``python -m wirelessagent.language.training [FILE]``; 45 minutes on two cores.

The same file for the same sentences on one machine. It needs JAX and Optax, of the development group.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from wirelessagent.language.intent import checked_constraints, same_constraints
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.sentence_model import KNOWN, SENTENCES_FILE, SentenceModel, hashes_of, places_of, rows_of
from wirelessagent.language.training.examples import OBJECTIVES, Example, examples
from wirelessagent.language.training.fit import in_parallel, write
from wirelessagent.language.training.network import LENGTHS, PASSES, Shown, fit

Hashes: TypeAlias = tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]
OFTEN = 6
"""How often something has to be seen to be known: else it falls into the bucket of anything else."""

_ORDERS = (*OBJECTIVES, "clarify.limits", "command")
_RARE, _LEAST, _MOST = -0.2, 0.5, 3.0
"""How much more the examples of a rare kind count: its share to this power, within these bounds."""

_CLOSE = 1e-4
"""A third of a megabit may be written with few digits."""

_LOG = logging.getLogger(__name__)


class Seen(NamedTuple):
    """What is seen of a sentence, and of one whose wish is left with what it means alone; and how it was read.

    Attributes:
        faithful: whether it says what was read of it; None where nobody knows, or it is asked about anyway.
        doubted: whether it is asked about, whatever it wants.
    """

    words: Hashes
    bare: Hashes
    faithful: bool | None
    doubted: bool


def seen(example: Example) -> Seen:
    """What an example shows."""
    sentence = Sentence(example.text, own_words())
    words, reading = sentence.words[: LENGTHS[-1]], sentence.reading
    faithful = None if example.bent is None or reading.doubts or reading.strangers else not example.bent
    if faithful:
        faithful = same_constraints(reading.values, checked_constraints(example.constraints or {}), _CLOSE)
    return Seen(hashes_of(words), hashes_of(words, bare=True), faithful, bool(reading.doubts))


def taught(every: Sequence[Example], passes: float = PASSES, processes: int = 2) -> SentenceModel:
    """The network, taught by these sentences."""
    shown = in_parallel(seen, every, processes)
    found, times = np.unique(np.concatenate([each.words[0] for each in shown]), return_counts=True)
    known = np.zeros(KNOWN, np.bool_)
    known[places_of(found[times >= OFTEN])] = True
    kinds = [each.kind for each in every]
    labels = sorted({kind for kind in kinds if "." in kind or kind in (*OBJECTIVES, "out_of_scope")})
    meant = {kind: [bool(kind) and f"{label}.".startswith(f"{kind}.") for label in labels] for kind in set(kinds)}
    meant["order"] = [label.startswith(_ORDERS) for label in labels]
    meant["none"] = [not each for each in meant["order"]]
    right = np.array([meant[kind] for kind in kinds])
    doubted = np.array([each.doubted for each in shown]) & (np.array(kinds) == "clarify")
    counts = np.where(doubted, 0, [each.kind_counts for each in every]).astype(np.float32)
    even = right / np.maximum(1, right.sum(axis=1, keepdims=True))
    share = even @ (counts @ even / counts.sum())
    rare = np.where(counts > 0, (len(labels) * np.maximum(share, 1e-6)) ** _RARE, 0)
    judged = [each.faithful for each in shown if each.faithful is not None]
    _LOG.info("%d sentences, %d labels; %d read, %d as meant", len(every), len(labels), len(judged), sum(judged))
    weights = fit(Shown(
        rows=[rows_of(*each.words, known) for each in shown], bare=[rows_of(*each.bare, known) for each in shown],
        known={
            "right": right,
            "kind_counts": counts * np.clip(rare / rare[counts > 0].mean(), _LEAST, _MOST).astype(np.float32),
            "order": np.array([each.orders for each in every], np.float32),
            "order_counts": np.array([each.order_counts for each in every], np.float32),
            "faithful": np.array([bool(each.faithful) for each in shown], np.float32),
            "faithful_counts": np.array([each.faithful is not None for each in shown], np.float32),
        },
        turns=np.array([each.turns for each in every]),
    ), len(labels), passes)  # fmt: skip
    return SentenceModel(labels=tuple(labels), weights=weights, known=known)


if __name__ == "__main__":
    write(SENTENCES_FILE, lambda path: taught(list(examples())).save(path))

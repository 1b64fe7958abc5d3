"""Make the model anew: ``python -m wirelessagent.language.training [FILE]``; the same file for the same templates."""

from __future__ import annotations

import logging
import sys
import time
from pathlib import Path

import numpy as np

from wirelessagent.language.linear_model import BUCKETS, MODEL_FILE, buckets, word_hashes
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.training.compose import sentences
from wirelessagent.language.training.fit import fit, known_words, matrix_of, read, save
from wirelessagent.language.training.spoken import Spoken, spoken

SPOKEN_WEIGHT = 30.0
"""What a spoken sentence counts beside one that was drawn."""


def main(path: Path) -> None:
    """Draw, fit, write, and say how well the drawn sentences are told apart."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    log = logging.getLogger(__name__)
    start = time.perf_counter()
    folder = Path(__file__).parent
    drawn = sorted(set(sentences(folder)))
    said = [(each.text, label) for each in spoken() if (label := _kind(each)) and not _asked_about_anyway(each)]
    names = sorted({label for _, label in drawn})
    texts, labels = [text for text, _ in (*drawn, *said)], [label for _, label in (*drawn, *said)]
    weight = np.array([1.0] * len(drawn) + [SPOKEN_WEIGHT] * len(said))
    log.info("%d sentences, %d labels (%.0f s)", len(texts), len(names), time.perf_counter() - start)
    seen = read(texts)
    rows = matrix_of([buckets(*each) for each in seen], BUCKETS)
    log.info("%d n-grams (%.0f s)", rows.nnz, time.perf_counter() - start)
    weights, intercepts = fit(rows, labels, names, weight)
    told: list[int] = np.argmax(np.asarray(rows @ weights) + intercepts, axis=1).tolist()
    right = sum(
        names[guess].partition(".")[0] == label.partition(".")[0] for guess, label in zip(told, labels, strict=True)
    ) / len(labels)
    save(path, names, weights, intercepts, known_words(word_hashes(text) for text, *_ in seen))
    log.info("%.1f %% of them told apart; %s: %d kB (%.0f s)", 100 * right, path.name, path.stat().st_size // 1000,
             time.perf_counter() - start)  # fmt: skip


def _kind(each: Spoken) -> str:
    """The label that a sentence teaches; "" where it was only written to be mistaken for an order, or for none."""
    if each.label == "clarify" and each.constraints:
        return "clarify.limits"
    return "" if each.label in ("none", "order") else each.label


def _asked_about_anyway(each: Spoken) -> bool:
    """Whether an impossible figure or the like is asked about whatever the model says: it is to learn wishes alone."""
    doubtful = each.label == "clarify" and not each.constraints
    return doubtful and bool(Sentence(each.text, own_words()).reading.doubts)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else MODEL_FILE)

"""Make the judge of orders anew: ``python -m wirelessagent.language.training.orders [FILE]``; ten minutes.

It learns from the sentences that people wrote down and that are known to order something or nothing, from frames, which
are filled with wishes of all kinds, and from the lines of talks (:mod:`.examples`). Those that were written to be
mistaken for each other count most.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy import sparse

from wirelessagent.kernels.supply import foreground
from wirelessagent.language.order_model import BUCKETS, ORDER_FILE, Frame, OrderModel, features, word_hashes
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.training.examples import FILLED, FRAME, MILD, TALK, framed, in_talks, spoken
from wirelessagent.language.training.fit import in_parallel, matrix_of, rounded, write
from wirelessagent.language.training.fit_kernel import one_pass

_PASSES, _STEP = 6, 0.15
"""More of them tell sentences apart better that may be orders, and frames in other words worse."""

_AVERAGED, _EPSILON = 2, 1e-3
"""Passes whose weights are averaged, and what squares begin at."""

_LOG = logging.getLogger(__name__)


def trained() -> OrderModel:
    """The model; how well it tells the sentences apart is logged, those counting most that may be mistaken."""
    said = [(each.text, each.is_order, 1.0 if each.near else MILD) for each in spoken() if each.is_order is not None]
    said += [(text, orders, FRAME / FILLED) for text, orders, _ in framed()]
    said += [(text, orders, TALK) for text, orders in in_talks()]
    frames = in_parallel(lambda text: Sentence(text, own_words()).frame, [text for text, *_ in said])
    orders, weight = np.array([orders for _, orders, _ in said]), np.array([each[2] for each in said])
    model = made(frames, orders, weight)
    right = (np.array([model.score(each) for each in frames]) > 0) == orders
    _LOG.info("%.1f %% of %d sentences told apart", 100 * np.average(right, weights=weight), len(said))
    return model


def made(frames: Sequence[Frame], orders: npt.NDArray[np.bool_], weight: npt.NDArray[np.float64]) -> OrderModel:
    """A model of what orders something and what does not; it knows the words that stand in at least two sentences."""
    words, counts = np.unique([word for frame in frames for word in set(word_hashes(frame))], return_counts=True)
    known = frozenset[int](words[counts > 1].tolist())
    rows = matrix_of([features(frame, known) for frame in frames], BUCKETS).astype(np.float32)
    found, intercepts = fit(rows, np.stack([~orders, orders], axis=1), weight)
    weights, scale = rounded(found[:, 1] - found[:, 0])
    intercept = float(intercepts[1] - intercepts[0])
    return OrderModel(weights=weights, scale=float(scale), intercept=intercept, known=known)


@foreground()
def fit(
    rows: sparse.csr_matrix, right: npt.NDArray[np.bool_], weight: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Weights (bucket, label) and intercepts (label,) that make the ``right`` (sentence, label) labels likely.

    A multinomial logistic regression by adaptive gradient steps. ``weight`` (sentence,) says how much each counts. The
    order of the sentences is drawn with a fixed seed: equal sentences make equal weights.
    """
    sentences, labels = right.shape
    share = right @ (weight @ right) / weight.sum()
    importance = weight * (labels * share) ** -0.4  # rare labels count more, though not equally
    importance = np.asarray(importance / importance.mean(), dtype=np.float32)
    weights = np.zeros((rows.shape[1] + 1, labels), np.float32)
    squares, mean, chance = np.full_like(weights, _EPSILON), np.zeros_like(weights), np.random.default_rng(1)
    for turn in range(_PASSES):
        order = chance.permutation(sentences)
        lost = one_pass(order, rows.indptr, rows.indices, rows.data, right, importance, weights, squares, _STEP)
        _LOG.info("pass %d, loss %.3f", turn + 1, lost / sentences)
        if turn >= _PASSES - _AVERAGED:
            mean += weights / _AVERAGED
    return mean[:-1], mean[-1]


if __name__ == "__main__":
    write(ORDER_FILE, lambda path: trained().save(path))

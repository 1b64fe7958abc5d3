"""The fit: multinomial logistic regression by adaptive gradient steps, weights rounded to eight bits."""

from __future__ import annotations

import logging
import multiprocessing
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt
from scipy import sparse

from wirelessagent.kernels.supply import foreground
from wirelessagent.language.training.fit_kernel import one_pass

Item = TypeVar("Item")
Made = TypeVar("Made")
_PASSES, _STEP = 6, 0.15
"""More of them tell sentences apart better that may be orders, and frames in other words worse."""

_AVERAGED, _EPSILON = 2, 1e-3
"""Passes whose weights are averaged, and what squares begin at."""

_LOG = logging.getLogger(__name__)


def matrix_of(columns: Sequence[npt.NDArray[np.int64]], width: int) -> sparse.csr_matrix:
    """(sentence, bucket) of the buckets that sentences fall into: every row has length one."""
    sizes = np.array([len(each) for each in columns])
    values = np.repeat(1 / np.sqrt(sizes), sizes)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return sparse.csr_matrix((values.astype(np.float32), np.concatenate(columns), starts), shape=(len(columns), width))


def in_parallel(
    do: Callable[[Item], Made], items: Sequence[Item], processes: int = 2, at_once: int = 500
) -> list[Made]:
    """What some processes make of each item, in order; one process is this one."""
    if processes == 1:
        return list(map(do, items))
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        return pool.map(do, items, chunksize=at_once)


@foreground()
def fit(
    rows: sparse.csr_matrix, right: npt.NDArray[np.bool_], weight: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Weights (bucket, label) and intercepts (label,) that make the ``right`` (sentence, label) labels likely.

    ``weight`` (sentence,) says how much each counts. The order of the sentences is drawn with a fixed seed: equal
    sentences make equal weights.
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


def rounded(weights: npt.NDArray[np.float32], faint: int) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float32]]:
    """Weights as int8, those of at most so many 127ths of the largest as none, and a scale per label."""
    scales = np.asarray(np.abs(weights).max(axis=0) / 127, dtype=np.float32)
    found = np.asarray(np.rint(weights / scales), dtype=np.int8)
    return np.where(np.abs(found) > faint, found, np.int8(0)), scales

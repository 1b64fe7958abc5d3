"""The fit: multinomial logistic regression by L-BFGS, weights rounded to eight bits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy import optimize, sparse

from wirelessagent.language.sentence import Sentence, own_words

ForModel: TypeAlias = tuple[str, list[str], str]
_RIDGE = 5e-7
_STEPS = 500
_FAINT = 1


def matrix_of(columns: Sequence[npt.NDArray[np.int64]], width: int) -> sparse.csr_matrix:
    """(sentence, bucket) of the buckets that sentences fall into: every row has length one."""
    sizes = np.array([len(each) for each in columns])
    values = np.repeat(1 / np.sqrt(sizes), sizes)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return sparse.csr_matrix((values.astype(np.float32), np.concatenate(columns), starts), shape=(len(columns), width))


def read_by_rules(texts: Sequence[str]) -> list[ForModel]:
    """What the parsers and the lexicon make of each sentence, as the model gets it at run time."""
    own = own_words()
    return [Sentence(text, own).for_model() for text in texts]


def known_words(said: Iterable[Iterable[int]]) -> npt.NDArray[np.uint32]:
    """The hashes of the words that stand in at least two sentences, ascending."""
    words, counts = np.unique([word for words in said for word in set(words)], return_counts=True)
    return np.asarray(words[counts > 1], dtype=np.uint32)


def fit(
    rows: sparse.csr_matrix, labels: Sequence[str], names: Sequence[str], weight: npt.NDArray[np.float64],
    ridge: float = _RIDGE,
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:  # fmt: skip
    """Weights (bucket, label) and intercepts (label,) that make the labels likeliest, with a ridge.

    A label such as "question" stands for all that begin with it. ``weight`` (sentence,) says how much each counts.
    """
    classes, width = len(names), rows.shape[1]
    meant = {label: [name == label or name.startswith(label + ".") for name in names] for label in set(labels)}
    target = np.array([meant[label] for label in labels], dtype=np.float64)
    even = target / target.sum(axis=1, keepdims=True)
    share = even @ (weight @ even) / weight.sum()
    importance = weight * (classes * share) ** -0.4  # rare labels count more, though not equally
    importance /= importance.sum()
    columns = rows.T.tocsr()

    def loss(flat: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        weights = flat[: width * classes].reshape(width, classes)
        score = np.asarray(rows @ weights.astype(np.float32), dtype=np.float64) + flat[width * classes :]
        score -= score.max(axis=1, keepdims=True)
        likely = np.exp(score)
        likely /= likely.sum(axis=1, keepdims=True)
        right = likely * target
        total = right.sum(axis=1, keepdims=True) + 1e-300
        value = -float(importance @ np.log(total[:, 0]))
        likely -= right / total
        likely *= importance[:, None]
        slope = np.asarray(columns @ likely.astype(np.float32), dtype=np.float64) + 2 * ridge * weights
        return value + ridge * float((weights**2).sum()), np.concatenate([slope.ravel(), likely.sum(axis=0)])

    start = np.zeros((width + 1) * classes)
    found = optimize.minimize(loss, start, jac=True, method="L-BFGS-B", options={"maxiter": _STEPS, "maxcor": 5})
    flat = np.asarray(found.x, dtype=np.float32)
    return flat[: width * classes].reshape(width, classes), flat[width * classes :]


def rounded(weights: npt.NDArray[np.float32], faint: int) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float32]]:
    """Weights as int8, those of at most so many 127ths of the largest as none, and a scale per label."""
    scales = np.asarray(np.abs(weights).max(axis=0) / 127, dtype=np.float32)
    found = np.asarray(np.rint(weights / scales), dtype=np.int8)
    return np.where(np.abs(found) > faint, found, np.int8(0)), scales


def save(
    path: Path, names: Sequence[str], weights: npt.NDArray[np.float32], intercepts: npt.NDArray[np.float32],
    known: npt.NDArray[np.uint32],
) -> None:  # fmt: skip
    """Write the model, the weights as int8 with a scale per label."""
    found, scales = rounded(weights, _FAINT)
    np.savez_compressed(path, labels=np.array(names), weights=found, scales=scales, intercepts=intercepts, known=known)

"""One pass of gradient steps over sentences, for a multinomial logistic regression.

Of a sentence the buckets are ``columns[starts[i]] … columns[starts[i + 1]]`` with their ``values``; ``right`` marks the
labels that are meant, of which one is enough. A step is −s g/√(Σ g²), summed over all steps before (AdaGrad, Duchi et
al. 2011).
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from wirelessagent.kernels import kernel

Places: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.int32 | np.int64]]
Marks: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
Floats: TypeAlias = np.ndarray[tuple[int, ...], np.dtype[np.float32]]


@kernel
def one_pass(
    order: Places, starts: Places, columns: Places, values: Floats, right: Marks, importance: Floats, weights: Floats,
    squares: Floats, step: float,
) -> float:  # fmt: skip
    """Step along each sentence in ``order``, and say how much likelihood they lack in all.

    The last row of ``weights`` (bucket, label) and of ``squares`` is that of the intercepts.
    """
    classes, last = weights.shape[1], weights.shape[0] - 1
    likely, slope, lost = np.zeros(classes, np.float32), np.zeros(classes, np.float32), 0.0
    for i in order:
        for c in range(classes):
            likely[c] = weights[last, c]
        for at in range(starts[i], starts[i + 1]):
            for c in range(classes):
                likely[c] += values[at] * weights[columns[at], c]
        most, total, meant = likely.max(), np.float32(0.0), np.float32(0.0)
        for c in range(classes):
            likely[c] = np.exp(likely[c] - most)
            total += likely[c]
            if right[i, c]:
                meant += likely[c]
        meant = max(meant, np.float32(1e-30))
        lost -= importance[i] * np.log(meant / total)
        for c in range(classes):
            share = likely[c] / meant if right[i, c] else np.float32(0.0)
            slope[c] = importance[i] * (likely[c] / total - share)
            squares[last, c] += slope[c] * slope[c]
            weights[last, c] -= step * slope[c] / np.sqrt(squares[last, c])
        for at in range(starts[i], starts[i + 1]):
            row, value = columns[at], values[at]
            for c in range(classes):
                down = slope[c] * value
                squares[row, c] += down * down
                weights[row, c] -= step * down / np.sqrt(squares[row, c])
    return lost

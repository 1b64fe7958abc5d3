"""Cholesky factors of many small matrices side by side: one in each lane, the innermost axis.

So the processor's vectors are full, however small the matrices. Lower triangles are packed row by row: entry (i, j) of
the matrices is row ``packed(i, j)`` of an array of shape (n(n + 1)/2, lane). Factors hold the inverse of their diagonal
there. The number of lanes had best be a multiple of eight, so that rows begin where vectors do; and rows had best be
indexed where they lie, since a view costs as much as the arithmetic on it (Numba counts references to each).
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

JITTER = 1e-10
"""Added to each variance, so that no matrix is singular."""
TOGETHER = 64
"""Most lanes: as many as the cache holds."""


@kernel
def packed(i: int, j: int) -> int:
    """The row of entry (i, j), j ≤ i.

    >>> [packed(i, j) for i in range(3) for j in range(i + 1)]
    [0, 1, 2, 3, 4, 5]
    """
    return i * (i + 1) // 2 + j


@kernel
def width_of(count: int) -> int:
    """How many lanes to lay for ``count`` matrices."""
    return (min(count, TOGETHER) + 7) // 8 * 8


@kernel
def factorise(low: FloatArray, size: int) -> None:
    """Overwrite the matrices by their factors L, M = L Lᵀ."""
    count = low.shape[1]
    for i in range(size):
        for j in range(i + 1):
            here, diagonal = packed(i, j), packed(j, j)
            for m in range(j):
                left, right = packed(i, m), packed(j, m)
                for c in range(count):
                    low[here, c] -= low[left, c] * low[right, c]
            if j < i:
                for c in range(count):
                    low[here, c] *= low[diagonal, c]
            else:
                for c in range(count):
                    low[here, c] = 1.0 / np.sqrt(max(low[here, c], JITTER))


@kernel
def forward(low: FloatArray, side: FloatArray, count: int) -> None:
    """Overwrite b by L⁻¹b in the first ``count`` lanes; ``side`` is of shape (n, lane)."""
    for i in range(side.shape[0]):
        for m in range(i):
            left = packed(i, m)
            for c in range(count):
                side[i, c] -= low[left, c] * side[m, c]
        diagonal = packed(i, i)
        for c in range(count):
            side[i, c] *= low[diagonal, c]


@kernel
def backward(low: FloatArray, side: FloatArray, count: int) -> None:
    """Overwrite b by L⁻ᵀb in the first ``count`` lanes; ``side`` is of shape (n, lane)."""
    size = side.shape[0]
    for i in range(size - 1, -1, -1):
        for m in range(i + 1, size):
            left = packed(m, i)
            for c in range(count):
                side[i, c] -= low[left, c] * side[m, c]
        diagonal = packed(i, i)
        for c in range(count):
            side[i, c] *= low[diagonal, c]


@kernel
def invert(low: FloatArray, size: int) -> None:
    """Overwrite factors by the lower triangles of M⁻¹."""
    count = low.shape[1]
    total = np.empty(count)
    for j in range(size):
        for i in range(j + 1, size):
            here, diagonal = packed(i, j), packed(i, i)
            total[:] = 0.0
            for m in range(j, i):
                left, right = packed(i, m), packed(m, j)
                for c in range(count):
                    total[c] -= low[left, c] * low[right, c]
            for c in range(count):
                low[here, c] = total[c] * low[diagonal, c]
    for i in range(size):
        for j in range(i + 1):
            here = packed(i, j)
            total[:] = 0.0
            for m in range(i, size):
                left, right = packed(m, i), packed(m, j)
                for c in range(count):
                    total[c] += low[left, c] * low[right, c]
            for c in range(count):
                low[here, c] = total[c]

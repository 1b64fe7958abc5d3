"""SoftImpute: a matrix completed by one of small nuclear norm, the field's usual low-rank competitor.

Minimises ½ Σ over observed entries of (x − z)² + λ ‖Z‖_* by the iteration Z ← S_λ(P_Ω(X) + P_Ω⊥(Z)), where S_λ lowers
every singular value by λ; along a falling grid of λ, each start from the last solution. Mazumder, Hastie and
Tibshirani, *Spectral regularization algorithms for learning large incomplete matrices*, JMLR 11 (2010), algorithm 1.
λ is chosen by the error on observed entries held out, and the whole grid down to it is run again with all of them.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray

_STEPS = 16
"""Values of λ, from the one at which all is zero down to ``_SMALLEST`` of it."""
_SMALLEST = 1e-2
_TOLERANCE = 1e-3
"""Relative change of Z below which an iteration ends."""
_MOST_ROUNDS = 100
_HELD_OUT = 0.15
"""Share of the observed entries by which λ is chosen."""


def soft_impute(matrix: FloatArray, *, seed: int = 0) -> FloatArray:
    """A complete matrix from one whose missing entries are NaN, same shape; zeros where nothing at all is observed.

    Entries should vary about zero, for that is where what is not known is drawn to.
    """
    seen = ~np.isnan(matrix)
    held_out = seen & (np.random.default_rng(seed).random(matrix.shape) < _HELD_OUT)
    largest = _largest_singular_value(np.where(seen, matrix, 0.0))
    if largest == 0.0:
        return np.zeros(matrix.shape)
    grid = largest * np.geomspace(1.0, _SMALLEST, _STEPS)
    if held_out.any():
        errors = [float(np.square((path - matrix)[held_out]).sum()) for path in _path(matrix, seen & ~held_out, grid)]
        grid = grid[: int(np.argmin(errors)) + 1]
    return _path(matrix, seen, grid)[-1]


def _path(matrix: FloatArray, seen: BoolArray, grid: FloatArray) -> list[FloatArray]:
    """The solutions along a falling grid of λ."""
    found = np.zeros(matrix.shape)
    path: list[FloatArray] = []
    for penalty in grid.tolist():
        for _ in range(_MOST_ROUNDS):
            last, found = found, _shrunk(np.where(seen, matrix, found), penalty)
            if np.square(found - last).sum() <= _TOLERANCE**2 * max(float(np.square(last).sum()), 1e-300):
                break
        path.append(found)
    return path


def _shrunk(matrix: FloatArray, penalty: float) -> FloatArray:
    """S_λ: every singular value lowered by ``penalty``, not below zero."""
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    return (left * np.maximum(values - penalty, 0.0)) @ right


def _largest_singular_value(matrix: FloatArray) -> float:
    return float(np.linalg.norm(matrix, 2))

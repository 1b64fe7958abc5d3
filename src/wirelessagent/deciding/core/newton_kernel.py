"""A step of Newton's method: −H⁻¹ g for the variables that may move, by Cholesky's method."""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

RIDGE, SLIGHT = 1e-12, 1e-6
"""Next to the largest curvature what is added to all, and how much a slope counts where there is no curvature."""


@kernel
def newton_step(
    hessian: FloatArray, gradient: FloatArray, free: IntArray, size: int, factor: FloatArray, step: FloatArray
) -> float:
    """Write the step, 0 where a variable is not among the first ``size`` of ``free``; returns −gradient·step.

    Of ``hessian`` the lower half is read; ``free`` rises; ``factor`` is scratch of the same shape.
    """
    largest = 0.0
    for i in range(size):
        largest = max(largest, hessian[free[i], free[i]], SLIGHT * abs(gradient[free[i]]))
        for j in range(i + 1):
            factor[j, i] = hessian[free[i], free[j]]
    least = RIDGE * largest + 1e-300
    solution = np.empty(size)
    for i in range(size):
        solution[i] = -gradient[free[i]]
    for j in range(size):
        row = factor[j]
        pivot = np.sqrt(max(row[j] + least, least))
        solution[j] /= pivot
        row[j:size] /= pivot
        row[j] = pivot
        for i in range(j + 1, size):
            pull, below = row[i], factor[i]
            solution[i] -= pull * solution[j]
            if pull != 0.0:
                for m in range(i, size):
                    below[m] -= pull * row[m]
    step[:] = 0.0
    promised = 0.0
    for j in range(size - 1, -1, -1):
        rest = solution[j]
        for i in range(j + 1, size):
            rest -= factor[j, i] * solution[i]
        solution[j] = rest / factor[j, j]
        step[free[j]] = solution[j]
        promised -= gradient[free[j]] * solution[j]
    return promised

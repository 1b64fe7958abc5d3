"""P1 and P3 by the project's kernels, by NumPy and by cvxpy with Clarabel; all get the same gains and return powers.

All three are given the same normalised gains (batch, user, subcarrier) and do the whole problem: best user on each
subcarrier, then power. NumPy is the same task without compilation, on the first of the batch; cvxpy is given the best
users and solves the convex rest, with the gains as parameter so that a program is compiled once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from wirelessagent.deciding.core.fractional_kernel import max_efficiency
from wirelessagent.deciding.core.water_filling_kernel import max_rate
from wirelessagent.model.arrays import FloatArray

SHAPES = ((8, 20), (64, 273), (256, 3276))
CVXPY_SHAPES = SHAPES[:2]
BUDGET_W, CIRCUIT_W = 20.0, 5.0


def kernel_p1(snr: FloatArray) -> Callable[[], FloatArray]:
    cap_w, budget_w = np.full(snr.shape[2], np.inf), np.full(len(snr), BUDGET_W)
    return lambda: max_rate(snr, cap_w, np.inf, budget_w)[1]


def kernel_p3(snr: FloatArray) -> Callable[[], FloatArray]:
    cap_w, budget_w = np.full(snr.shape[2], np.inf), np.full(len(snr), BUDGET_W)
    return lambda: max_efficiency(snr, cap_w, np.inf, budget_w, CIRCUIT_W)[1]


def numpy_level(best: FloatArray, budget_w: float) -> float:
    """Water-filling by sorting: the level of the most subcarriers that all stay wet."""
    inverse = np.sort(1.0 / best)
    level = (budget_w + np.cumsum(inverse)) / np.arange(1, inverse.size + 1)
    return float(level[np.flatnonzero(level > inverse)[-1]])


def numpy_p1(snr: FloatArray) -> FloatArray:
    owner = snr.argmax(axis=0)
    best = snr[owner, np.arange(owner.size)]
    return np.maximum(numpy_level(best, BUDGET_W) - 1.0 / best, 0.0)


def numpy_p3(snr: FloatArray) -> FloatArray:
    owner = snr.argmax(axis=0)
    best = snr[owner, np.arange(owner.size)]
    inverse = 1.0 / best
    full = numpy_level(best, BUDGET_W)
    power = np.maximum(full - inverse, 0.0)
    efficiency = np.log1p(power * best).sum() / (power.sum() + CIRCUIT_W)
    while True:
        power = np.maximum(min(1.0 / efficiency, full) - inverse, 0.0)
        better = np.log1p(power * best).sum() / (power.sum() + CIRCUIT_W)
        if better <= efficiency * (1 + 1e-15):
            return power
        efficiency = better


def cvxpy_p1(snr: FloatArray) -> Callable[[], float]:
    """max Σ ln(1 + p a), Σ p ≤ P, with a as parameter."""
    import cvxpy as cp

    power, gain = cp.Variable(snr.shape[1], nonneg=True), cp.Parameter(snr.shape[1], nonneg=True)
    problem = cp.Problem(cp.Maximize(cp.sum(cp.log1p(cp.multiply(gain, power)))), [cp.sum(power) <= BUDGET_W])

    def solve() -> float:
        gain.value = snr.max(axis=0)
        return float(problem.solve(solver=cp.CLARABEL))

    return solve


def cvxpy_p3(snr: FloatArray) -> Callable[[], float]:
    """P3 after Charnes and Cooper: y = p t, max Σ t ln(1 + a y/t), Σ y + C t ≤ 1, Σ y ≤ P t."""
    import cvxpy as cp

    scaled, gain = cp.Variable(snr.shape[1], nonneg=True), cp.Parameter(snr.shape[1], nonneg=True)
    t = cp.Variable(nonneg=True)
    rate = cp.sum(-cp.rel_entr(t * np.ones(snr.shape[1]), t + cp.multiply(gain, scaled)))
    limits = [cp.sum(scaled) + CIRCUIT_W * t <= 1, cp.sum(scaled) <= BUDGET_W * t]
    problem = cp.Problem(cp.Maximize(rate), limits)

    def solve() -> float:
        gain.value = snr.max(axis=0)
        return float(problem.solve(solver=cp.CLARABEL))

    return solve


CONTENDERS: dict[str, dict[str, Callable[[FloatArray], Callable[[], Any]]]] = {
    "P1 max rate": {
        "kernel": kernel_p1,
        "numpy": lambda snr: lambda: numpy_p1(snr[0]),
        "cvxpy": lambda snr: cvxpy_p1(snr[0]),
    },
    "P3 max energy efficiency": {
        "kernel": kernel_p3,
        "numpy": lambda snr: lambda: numpy_p3(snr[0]),
        "cvxpy": lambda snr: cvxpy_p3(snr[0]),
    },
}

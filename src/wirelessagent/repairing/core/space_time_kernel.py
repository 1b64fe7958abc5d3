"""Linear minimum-mean-square-error estimates of one slot's gains from those of all slots.

The correlation of two gains of a user is the product of that over frequency and that over time. Observations are means
over bins of slots, narrow ones near the last slot and wider ones before, so that a few stand for a long history:
their covariance is the mean over the slots of both bins. Where m of a bin's M slots were observed, their mean is off
that of all by a variance of (1/m − 1/M)(1 − r̄), for a mean correlation r̄ of the bin's slots, which counts like noise.
Formulas are those of :mod:`.kriging_kernel` for one window, with the bins' observations side by side.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.repairing.core.side_by_side_kernel import JITTER

SERVED, MARGIN, SHORT = 8, 8, 24
"""Subcarriers that a window of a long band serves, those more that it holds on each side, the longest short band."""
LEAST = 1e-13


@kernel
def factorise(matrix: FloatArray, size: int) -> None:
    """Overwrite the lower half of a positive definite matrix by its Cholesky factor."""
    for i in range(size):
        row = matrix[i]
        for j in range(i):
            other = matrix[j]
            total = row[j]
            for m in range(j):
                total -= row[m] * other[m]
            row[j] = total / other[j]
        total = row[i]
        for m in range(i):
            total -= row[m] * row[m]
        row[i] = np.sqrt(max(total, JITTER))


@kernel
def substitute(factor: FloatArray, size: int, side: FloatArray) -> None:
    """Solve for a right-hand side (n,) in place."""
    for i in range(size):
        total = side[i]
        row = factor[i]
        for j in range(i):
            total -= row[j] * side[j]
        side[i] = total / row[i]
    for i in range(size - 1, -1, -1):
        side[i] /= factor[i, i]
        value, row = side[i], factor[i]
        for j in range(i):
            side[j] -= row[j] * value


@kernel
def estimate_user(
    mean: FloatArray,
    mean_noise: FloatArray,
    count: IntArray,
    slots_of: IntArray,
    place: IntArray,
    over_frequency: FloatArray,
    noise: float,
    grown: float,
    between: FloatArray,
    towards: FloatArray,
    level: FloatArray,
    chance: FloatArray,
    found: FloatArray,
) -> None:
    """Write mean, variance from fading and other variance of each subcarrier of a user, shape (subcarrier, 3).

    Args:
        mean, mean_noise, count, slots_of: ``mean``, ``noise``, ``count`` and ``reports`` of :class:`.bins.Binned`.
        place: of the subcarriers, shape (subcarrier,).
        over_frequency: |ρ|² at each distance, shape (distance,).
        noise, grown: η of one slot, and 1 + η where measured gains are conditional means, else 1.
        between: correlation of two bins over time, shape (hypothesis, bin, bin).
        towards: of the bins with the slot that is asked for, shape (hypothesis, bin).
        level, chance: of each hypothesis, shape (hypothesis,).
    """
    bins, subcarriers = mean.shape
    short = subcarriers <= SHORT
    most = bins * (subcarriers if short else SERVED + 2 * MARGIN)
    matrix, side, target = np.empty((most, most)), np.empty(most), np.empty(most)
    member = np.empty((most, 2), np.int64)
    step = subcarriers if short else SERVED
    shared = grown * grown
    found[:] = 0.0
    for begin in range(0, subcarriers, step):
        end = min(begin + step, subcarriers)
        first, last = max(begin - MARGIN, 0), min(end + MARGIN, subcarriers)
        if short:
            first, last = 0, subcarriers
        size = 0
        for b in range(bins):
            for n in range(first, last):
                if count[b, n] > 0:
                    member[size, 0], member[size, 1] = b, n
                    size += 1
        for h in range(chance.size):
            for i in range(size):
                b, n = member[i]
                for j in range(i + 1):
                    c, m = member[j]
                    matrix[i, j] = shared + between[h, b, c] * over_frequency[abs(place[n] - place[m])]
                gaps = 0.0
                if slots_of[b] > 1:
                    gaps = (slots_of[b] / count[b, n] - 1.0) * (1.0 - between[h, b, b]) / (slots_of[b] - 1.0)
                matrix[i, i] += noise / count[b, n] + gaps + JITTER
            factorise(matrix, size)
            for n in range(begin, end):
                for i in range(size):
                    at = member[i, 1]
                    target[i] = shared + grown * towards[h, member[i, 0]] * over_frequency[abs(place[at] - place[n])]
                    side[i] = target[i]
                substitute(matrix, size, side)
                value, error, known = 0.0, 2.0 * shared, 0.0
                for i in range(size):
                    b, at = member[i]
                    w = side[i]
                    value += w * mean[b, at]
                    error -= w * (target[i] + w * noise / count[b, at])
                    known += w * w * mean_noise[b, at]
                error = max(error / shared, LEAST)
                a = level[h]
                unknown = (1.0 - np.sqrt(1.0 - min(error, 1.0))) * a
                value = max(value, unknown)
                spread = 2.0 * value * unknown - unknown * unknown + max(error - 1.0, 0.0) * a * a
                found[n, 0] += chance[h] * value
                found[n, 1] += chance[h] * spread
                found[n, 2] += chance[h] * (known + value * value)
    for n in range(subcarriers):
        found[n, 2] = max(found[n, 2] - found[n, 0] * found[n, 0], 0.0)

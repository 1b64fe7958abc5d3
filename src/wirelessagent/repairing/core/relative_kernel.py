"""Gains in units of each user's own mean, with the measurement noise that they carry."""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

LARGEST_SHARE = 0.9
"""Largest share of a level that can be noise."""


@kernel
def relate(
    gain: FloatArray,
    noise_variance: FloatArray,
    relative: FloatArray,
    known: BoolArray,
    noise: FloatArray,
    level: FloatArray,
    noise_share: FloatArray,
    seen: IntArray,
) -> None:
    """Write everything but the first two; shapes (user, subcarrier), the last three (user,).

    Args:
        gain: linear, NaN where missing.
        noise_variance: of the true gain about the measured one; NaN where unknown.
        relative, known, noise: gain and variance in units of the level, and whether there is a gain. Entries of users
            whose gains are all missing or all zero are not known.
        level: mean of the observed gains, 0 without any.
        noise_share: η, the variance of the measurement error in units of the level squared. Of a coefficient measured
            in complex noise the share c = 1 − √(1 − v/g²) of the power is noise, on average 1 − 1/√(1 + η).
        seen: how many gains are known.
    """
    users, subcarriers = gain.shape
    for k in range(users):
        largest, count = 0.0, 0
        for n in range(subcarriers):
            if not np.isnan(gain[k, n]):
                count += 1
                largest = max(largest, gain[k, n])
        total = 0.0
        for n in range(subcarriers):
            if not np.isnan(gain[k, n]) and largest > 0.0:
                total += gain[k, n] / largest
        mean = largest * (total / max(count, 1))
        level[k] = mean
        seen[k] = count if mean > 0.0 else 0
        part = 0.0
        for n in range(subcarriers):
            known[k, n] = mean > 0.0 and not np.isnan(gain[k, n])
            relative[k, n], noise[k, n] = 0.0, 0.0
            if known[k, n]:
                own = gain[k, n] / mean
                variance = noise_variance[k, n] / mean / mean
                relative[k, n], noise[k, n] = own, variance
                part += own - np.sqrt(max(own * own - variance, 0.0)) if variance > 0.0 else 0.0
        share = min(part / max(count, 1), LARGEST_SHARE)
        noise_share[k] = 1.0 / (1.0 - share) ** 2 - 1.0

"""By how much all promised rates could rise on given sets of subcarriers, within the budget."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.least_power_kernel import owned_power
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

STEPS = 12
ACCURACY = 1e-6
NEAREST = 0.02
"""Part of the range that a step leaves at either end."""


@kernel
def carried_scaling(
    snr_per_w: FloatArray,
    cap_w: FloatArray,
    max_nats: float,
    nats: FloatArray,
    owner: IntArray,
    budget_w: float,
    spent_w: float,
    most: float,
) -> float:
    """The largest factor on ``nats`` (user,), up to ``most``, that the sets carry: ln P over ln s by false position.

    ``snr_per_w`` is a, shape (user, subcarrier), and ``spent_w`` what the sets need for the factor 1. Where that is
    above the budget the search goes downwards, from the share that the budget has of it: the power is convex in the
    factor, so that much is carried for certain.
    """
    snr, ceiling = np.zeros(owner.size), np.zeros(owner.size)
    for n in range(owner.size):
        if owner[n] >= 0 and snr_per_w[owner[n], n] > 0.0:
            snr[n] = snr_per_w[owner[n], n]
            ceiling[n] = min(np.log1p(cap_w[n] * snr[n]), max_nats)
    power_w, log_price = np.empty(owner.size), np.empty(nats.size)
    low, high, high_excess = 1.0, most, np.inf
    low_excess = np.log(max(spent_w, 1e-300) / budget_w)
    if low_excess > ACCURACY:
        low, high, high_excess = budget_w / spent_w, 1.0, low_excess
        least_w = owned_power(snr, ceiling, low * nats, owner, power_w, log_price)
        low_excess = min(np.log(max(least_w, 1e-300) / budget_w), 0.0)
    for step in range(STEPS):
        if high - low <= ACCURACY * high or low_excess >= -ACCURACY:
            break
        if high_excess < np.inf:
            factor = low + (high - low) * low_excess / (low_excess - high_excess)
            margin = NEAREST * (high - low)
            factor = min(max(factor, low + margin), high - margin)
        else:
            factor = high if step == 0 else np.sqrt(low * high)
        needed_w = owned_power(snr, ceiling, factor * nats, owner, power_w, log_price)
        excess = np.log(max(needed_w, 1e-300) / budget_w)
        if needed_w <= budget_w:
            low, low_excess = factor, excess
        else:
            high, high_excess = factor, excess
    return low

"""By how much all promised rates could rise on given sets of subcarriers, within the budget."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.least_power_kernel import owned_power
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

STEPS = 12
ACCURACY = 1e-4
NEAREST = 0.02
"""Part of the range that a step leaves at either end."""


@kernel
def full_factor(snr: FloatArray, nats: FloatArray, owner: IntArray, budget_w: float) -> float:
    """The factor on ``nats`` (user,) that takes the budget if all owned subcarriers carry something and none is full.

    A user whose m subcarriers have the SNR per watt a then needs m e^((factor·nats − Σ ln a)/m) − Σ 1/a. Newton's
    method on the logarithm of the sum of the first parts, which is convex, comes down from where one of them takes all.
    """
    users = nats.size
    size, log_snr, total = np.zeros(users), np.zeros(users), budget_w
    for n in range(owner.size):
        if snr[n] > 0.0:
            size[owner[n]] += 1.0
            log_snr[owner[n]] += np.log(snr[n])
            total += 1.0 / snr[n]
    factor, goal = np.inf, np.log(total) - 0.5 * ACCURACY * budget_w / total
    for k in range(users):
        if nats[k] > 0.0 and size[k] > 0.0:
            factor = min(factor, (size[k] * (goal - np.log(size[k])) + log_snr[k]) / nats[k])
    for _ in range(STEPS):
        needed, rising = 0.0, 0.0
        for k in range(users):
            if nats[k] > 0.0 and size[k] > 0.0:
                part = size[k] * np.exp((factor * nats[k] - log_snr[k]) / size[k])
                needed += part
                rising += part * nats[k] / size[k]
        step = (np.log(needed) - goal) * needed / rising
        factor -= step
        if not abs(step) > 1e-9 * abs(factor):
            break
    return factor


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
    """The largest factor on ``nats`` (user,), up to ``most``, that the sets carry, by Newton's method on ln P.

    ``snr_per_w`` is a, shape (user, subcarrier), and ``spent_w`` what the sets need for the factor 1. The power is
    convex in the factor, so where that is beyond the budget, the share that the budget has of it is carried.
    """
    snr, ceiling = np.zeros(owner.size), np.zeros(owner.size)
    for n in range(owner.size):
        if owner[n] >= 0 and snr_per_w[owner[n], n] > 0.0:
            snr[n] = snr_per_w[owner[n], n]
            ceiling[n] = min(np.log1p(cap_w[n] * snr[n]), max_nats)
    power_w, log_price = np.empty(owner.size), np.empty(nats.size)
    low, high = min(1.0, budget_w / max(spent_w, 1e-300)), most
    factor = full_factor(snr, nats, owner, budget_w)
    factor = factor if low < factor < high else 1.0
    for _ in range(STEPS):
        needed_w = owned_power(snr, ceiling, factor * nats, owner, power_w, log_price)
        excess = np.log(max(needed_w, 1e-300) / budget_w)
        if excess <= 0.0:
            low = factor
        else:
            high = factor
        if -ACCURACY <= excess <= 0.0 or high - low <= ACCURACY * high:
            break
        slope = 0.0
        for k in range(nats.size):
            if nats[k] > 0.0:
                slope += np.exp(log_price[k]) * nats[k] / needed_w
        margin = NEAREST * (high - low)
        if 0.0 < slope < np.inf:
            factor = min(max(factor - (excess + 0.5 * ACCURACY) / slope, low + margin), high - margin)
        else:  # beyond what the sets can carry
            factor = np.sqrt(low * high)
    return low

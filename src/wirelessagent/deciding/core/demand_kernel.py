"""What users demand at the prices of their rates: their utilities' conjugates, and the highest common level.

A user takes the rate between low and high at which U′ falls to its price w. Where U is straight that is low above the
slope and high below it; at the slope, a kink, any rate between will do.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import CURVATURE, HIGH, LOW, REFERENCE, SLOPE, utility
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

STRAIGHT = 1e-4
"""A curvature below this is none to the climb."""


@kernel
def kink_of(user: FloatArray) -> float:
    """ln w at which a straight utility's demand jumps; NaN where none does."""
    if user[LOW] < user[HIGH] and user[SLOPE] > 0.0 and user[CURVATURE] < STRAIGHT:
        return float(np.log(user[SLOPE]))
    return np.nan


@kernel
def demand(user: FloatArray, log_w: float) -> tuple[float, float]:
    """The rate that a user takes at the price e^``log_w``, and minus its change per unit of ``log_w``."""
    low, high = user[LOW], user[HIGH]
    if user[SLOPE] <= 0.0 or low >= high:
        return low, 0.0
    dearness = log_w - np.log(user[SLOPE])
    if user[CURVATURE] < STRAIGHT:
        return (low if dearness >= 0.0 else high), 0.0
    rate = np.exp(min(np.log(user[REFERENCE]) - dearness / user[CURVATURE], 700.0))
    if rate <= low:
        return low, 0.0
    if rate >= high:
        return high, 0.0
    return rate, rate / user[CURVATURE]


@kernel
def conjugate(user: FloatArray, log_w: float) -> float:
    """u*(w) = max over low ≤ r ≤ high of U(r) − w r."""
    taken, _ = demand(user, log_w)
    return utility(user, taken) - np.exp(log_w) * taken


@kernel
def level_bound(share: FloatArray, log_price: FloatArray, worth_w: float, most: float) -> float:
    """The largest level t whose rates r(t) cost no more than ``worth_w`` = Σ max t_kg + P at the prices λ."""
    price = np.exp(log_price)
    low, high = 0.0, most
    paid = 0.0
    slope = 0.0
    for k in range(price.size):
        paid += price[k] * min(max(high * share[k, 0], share[k, 1]), share[k, 2])
        slope += price[k] * share[k, 0]
    if paid <= worth_w:
        return most
    if slope > 0.0:
        plain = worth_w / slope
        held = True
        for k in range(price.size):
            if share[k, 0] > 0.0 and price[k] > 0.0:
                held = held and share[k, 1] <= plain * share[k, 0] <= share[k, 2]
            elif share[k, 1] > 0.0:
                held = False
        if held:
            return min(plain, most)
    for _ in range(200):
        middle = 0.5 * (low + high) if low > 0.0 or high < 1e-3 else np.sqrt(max(low, 1e-12 * high) * high)
        paid = 0.0
        for k in range(price.size):
            paid += price[k] * min(max(middle * share[k, 0], share[k, 1]), share[k, 2])
        if paid <= worth_w:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * high:
            break
    return high

"""What the groups of subcarriers are worth at prices of the users' rates, exactly: the part of every bound that counts.

    Σ_g max(0, max_k t_kg),    t_kg = Σ over n in g of max over p in [0, u_kn] of λ_k ln(1 + p a_kn) − p,

with λ in W per nat. The search has the same sum in a form that is fast and loses digits where rates are tiny; bounds
are worked out here, where none are lost.

Only few users can have the largest term of a group. They are found by a logarithm that costs next to nothing: read as
an integer, a number x = 2^e (1 + m) is its exponent and mantissa, e + m in units of 2^52, and e + m ≤ log2 x ≤ e + m +
0.0861 (Mitchell 1962, "Computer multiplication and division using binary logarithms").
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

SHALLOW = 1e-4
BIT, BIAS, LN_2 = 2.0**-52, 1023.0, np.log(2.0)
BELOW, ABOVE = 1e-6, 0.0598
"""By how much the quick logarithm may be too large, by rounding, and too small: 0.0861 ln 2."""


@kernel
def quick_terms(snr_per_w: FloatArray, price: float, reached: FloatArray, least: FloatArray, most: FloatArray) -> None:
    """Write what a user's terms without caps are at least and at most, in W, shape (subcarrier,) each.

    ``snr_per_w`` (subcarrier,) is a; ``reached`` is scratch of that shape.
    """
    bits = reached.view(np.int64)
    for n in range(reached.size):
        reached[n] = price * snr_per_w[n]
    for n in range(reached.size):
        log = LN_2 * (bits[n] * BIT - BIAS)
        term = price * (log - 1.0) + price / reached[n]
        wet = reached[n] > 1.0
        most[n] = term + price * ABOVE if wet else 0.0
        least[n] = max(term - price * BELOW, 0.0) if wet else 0.0


@kernel
def add_up(low: FloatArray, high: FloatArray, start: IntArray, most: FloatArray) -> None:
    """Write a user's terms of each group, the least into the first of ``low``, the most into ``most`` (group,)."""
    if most.size == high.size:  # each group is a subcarrier
        most[:] = high
        return
    for g in range(most.size):
        total, most[g] = 0.0, 0.0
        for n in range(start[g], start[g + 1]):
            most[g] += high[n]
            total += low[n]
        low[g] = total


@kernel
def term_of(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, price: float, k: int, first: int, last: int
) -> float:
    """t of user k for the subcarriers from ``first`` to before ``last``, in W."""
    worth = 0.0
    for n in range(first, last):
        snr = snr_per_w[k, n]
        reached = price * snr
        if reached <= 1.0:
            continue
        depth = reached - 1.0
        most = min(cap_w[n] * snr, max_snr)
        if depth >= most:
            worth += price * np.log1p(most) - most / snr
        elif depth < SHALLOW:
            # (1 + d) ln(1 + d) − d without the difference
            worth += depth * depth * (0.5 - depth * (1.0 / 6.0 - depth / 12.0)) / snr
        else:
            worth += ((1.0 + depth) * np.log1p(depth) - depth) / snr
    return worth


@kernel
def worth_of_groups(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, start: IntArray, price: FloatArray
) -> float:
    """The sum of the module's docstring in W.

    Args:
        snr_per_w: a, shape (user, subcarrier), in 1/W; 0 where a pair may not be used.
        cap_w: power cap of each subcarrier, shape (subcarrier,), infinite where there is none.
        max_snr: SNR beyond which the rate stays the same, infinite where there is none.
        start: first subcarrier of each group, shape (group + 1,).
        price: λ, shape (user,), in W per nat.
    """
    groups, (users, subcarriers) = start.size - 1, snr_per_w.shape
    capped = max_snr < np.inf or cap_w.min() < np.inf
    least, best, most = np.zeros(groups), np.zeros(groups), np.zeros((users, groups))
    reached, low, high = np.empty(subcarriers), np.empty(subcarriers), np.empty(subcarriers)
    for k in range(users):
        if price[k] > 0.0:
            quick_terms(snr_per_w[k], price[k], reached, low, high)
            add_up(low, high, start, most[k])
            for g in range(groups):
                least[g] = max(least[g], 0.0 if capped else low[g])
    for k in range(users):
        for g in range(groups):
            if most[k, g] > best[g] and most[k, g] >= least[g]:
                worth = term_of(snr_per_w, cap_w, max_snr, price[k], k, start[g], start[g + 1])
                best[g] = max(best[g], worth)
    return best.sum()

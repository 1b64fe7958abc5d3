"""The least power that carries given rates on given sets of subcarriers.

Within its set S a user reaches its rate R at least power by water-filling in rates: r_n = min(max(z + ln a_n, 0), c_n)
with Σ r_n = R and p_n = (e^r_n − 1)/a_n. So the level comes from the same kernel as P1's, on floors −ln a.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.water_filling_kernel import settle, water_level
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

SLACK = 1.0 - 1e-12
"""Share of a promised rate that the ceilings of a set must reach; the rest is rounding."""


@kernel
def fill_rate(
    snr_per_w: FloatArray,
    log_snr: FloatArray,
    ceiling: FloatArray,
    members: IntArray,
    size: int,
    nats: float,
    floor: FloatArray,
    cap: FloatArray,
) -> tuple[float, float]:
    """Level and least power for ``nats`` on the first ``size`` of ``members`` (row arrays of one user).

    The level is that of r_n = min(max(level − ln(max a/a_n), 0), ceiling). The power is infinite where the set cannot
    carry the rate. ``floor`` and ``cap`` are scratch.
    """  # fmt: skip
    capacity = 0.0
    top = best_member(snr_per_w, members, size)
    for i in range(size):
        capacity += ceiling[members[i]]
    if size == 0 or capacity < nats * SLACK:
        return 0.0, np.inf
    for i in range(size):
        floor[i] = log_ratio(snr_per_w, log_snr, top, members[i])
        cap[i] = ceiling[members[i]]
    level = water_level(floor, cap, size, nats)
    power = 0.0
    for i in range(size):
        n = members[i]
        rate = min(level - log_ratio(snr_per_w, log_snr, top, n), ceiling[n])
        if rate > 0.0:
            power += float(np.expm1(rate) / snr_per_w[n])
    return level, power


@kernel
def best_member(snr_per_w: FloatArray, members: IntArray, size: int) -> int:
    """The subcarrier with the best gain among the first ``size`` members; −1 if there are none."""
    top = -1
    for i in range(size):
        if top < 0 or snr_per_w[members[i]] > snr_per_w[top]:
            top = members[i]
    return top


@kernel
def log_ratio(snr_per_w: FloatArray, log_snr: FloatArray, top: int, n: int) -> float:
    """ln(a_top/a_n), also where the two are so close that the difference of their logarithms is only rounding."""
    difference = log_snr[top] - log_snr[n]
    if difference > 0.1:
        return difference
    return np.log1p((snr_per_w[top] - snr_per_w[n]) / snr_per_w[n])


@kernel
def least_power(
    snr_per_w: FloatArray,
    ceiling: FloatArray,
    nats: FloatArray,
    owner: IntArray,
    power_w: FloatArray,
    log_price: FloatArray,
) -> float:
    """Per-user water-filling to the promised rates on given sets: the total power, infinite where it cannot be.

    Writes ``power_w`` (subcarrier,) and ``log_price`` (user,), ln of dP_k/dR_k in W per nat, which is the water level
    v with r_n = ln(a_n v): NaN for users that are not served.
    """  # fmt: skip
    users, subcarriers = snr_per_w.shape
    snr = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    rate = np.empty(subcarriers)
    total = 0.0
    power_w[:] = 0.0
    for k in range(users):
        log_price[k] = np.nan
        if nats[k] <= 0.0:
            continue
        capacity = 0.0
        last = -1
        for n in range(subcarriers):
            mine = owner[n] == k
            snr[n] = snr_per_w[k, n] if mine else 0.0
            cap[n] = ceiling[k, n] if mine else 0.0
            capacity += cap[n]
            if snr[n] > 0.0 and (last < 0 or snr[n] > snr[last]):
                last = n
        if capacity < nats[k] * SLACK:
            total = np.inf
            continue
        log_price[k] = settle(snr, cap, nats[k], True, last, rate)
        for n in range(subcarriers):
            if rate[n] > 0.0:
                power_w[n] = np.expm1(rate[n]) / snr[n]
                total += power_w[n]
    return total

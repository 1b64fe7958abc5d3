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
def keep_budget(budget_w: float, power_w: FloatArray) -> None:
    """Scale powers down to the budget that they exceed: levels, which are logarithms, lose the digits of tiny rates."""
    spent_w = power_w.sum()
    if budget_w < spent_w < np.inf:
        power_w *= budget_w / spent_w


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
    subcarriers = owner.size
    snr = np.zeros(subcarriers)
    most = np.zeros(subcarriers)
    for n in range(subcarriers):
        if owner[n] >= 0:
            snr[n] = snr_per_w[owner[n], n]
            most[n] = ceiling[owner[n], n]
    return owned_power(snr, most, nats, owner, power_w, log_price)


@kernel
def owned_power(
    snr_per_w: FloatArray,
    ceiling: FloatArray,
    nats: FloatArray,
    owner: IntArray,
    power_w: FloatArray,
    log_price: FloatArray,
) -> float:
    """:func:`least_power` from the owners' own a and ceilings, shape (subcarrier,)."""
    users, subcarriers = nats.size, owner.size
    size = np.zeros(users + 1, dtype=np.int64)
    for n in range(subcarriers):
        if owner[n] >= 0 and snr_per_w[n] > 0.0:
            size[owner[n] + 1] += 1
    first = np.cumsum(size)
    member = np.empty(subcarriers, dtype=np.int64)
    filled = first[:users].copy()
    for n in range(subcarriers):
        if owner[n] >= 0 and snr_per_w[n] > 0.0:
            member[filled[owner[n]]] = n
            filled[owner[n]] += 1
    snr, cap, rate = snr_per_w[member[: first[users]]], ceiling[member[: first[users]]], np.empty(subcarriers)
    total = 0.0
    power_w[:] = 0.0
    for k in range(users):
        log_price[k] = np.nan
        if nats[k] <= 0.0:
            continue
        low, high = first[k], first[k + 1]
        if cap[low:high].sum() < nats[k] * SLACK or low == high:
            total = np.inf
            continue
        best = int(np.argmax(snr[low:high]))
        log_price[k] = settle(snr[low:high], cap[low:high], nats[k], True, best, rate[low:high])
        for i in range(low, high):
            if rate[i] > 0.0:
                power_w[member[i]] = np.expm1(rate[i]) / snr[i]
                total += power_w[member[i]]
    return float(total)

"""Water-filling, exact: the power (or the rate) that fills a vessel of uneven floors up to one level.

For floors f, caps u and a total t the level τ solves

    Σ_n min(max(τ − f_n, 0), u_n) = t.

With f = 1/a and t a power this is problem P1; with f = −ln a and t a rate in nats, the same level is that of the least
power for the rate. Floors are shifted so that the lowest is 0, which keeps every figure exact to a few rounding errors
however far the gains lie apart; Michelot (1986) for the projection on a simplex, Bitran and Hax (1981) with caps.
Textbook methods that drop the worst subcarrier first, or bisect to an absolute tolerance, fail there.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray


@kernel
def water_level(floor: FloatArray, cap: FloatArray, size: int, total: float) -> float:
    """The level τ over the first ``size`` floors (the lowest is 0); infinite where the caps hold at most ``total``.

    Each round fills the floors that are left as if there were neither caps nor dry floors, and then fixes for good
    whichever of the two was violated by more. ``floor`` and ``cap`` are used up.
    """
    capacity = 0.0
    for i in range(size):
        capacity += cap[i]
    if capacity <= total:
        return np.inf
    level = np.inf
    while size > 0:
        level = total
        for i in range(size):
            level += floor[i]
        level /= size
        dry = 0.0
        spill = 0.0
        for i in range(size):
            dry += max(floor[i] - level, 0.0)
            spill += max(level - floor[i] - cap[i], 0.0)
        if dry == spill:
            break
        kept = 0
        for i in range(size):
            full = spill > dry and floor[i] + cap[i] <= level
            if full:
                total -= cap[i]
            elif spill > dry or floor[i] < level:
                floor[kept] = floor[i]
                cap[kept] = cap[i]
                kept += 1
        size = kept
    return level


@kernel
def best_users(snr_per_w: FloatArray, best: FloatArray, owner: IntArray) -> None:
    """The largest entry of each column of ``snr_per_w`` (user, subcarrier) and the first user that has it."""
    users, subcarriers = snr_per_w.shape
    best[:] = snr_per_w[0]
    owner[:] = 0
    for k in range(1, users):
        row = snr_per_w[k]
        for n in range(subcarriers):
            better = row[n] > best[n]
            best[n] = row[n] if better else best[n]
            owner[n] = k if better else owner[n]


@kernel
def vessel(snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, floor: FloatArray, cap: FloatArray) -> float:
    """Write the shifted floors 1/a − min 1/a and the caps min(``cap_w``, max_snr/a); returns the largest a.

    The shift is done on a, where it does not cancel. A subcarrier that cannot be used has an infinite floor.
    """
    top = snr_per_w.max()
    for n in range(snr_per_w.size):
        snr = snr_per_w[n]
        floor[n] = (top - snr) / top / snr if snr > 0.0 else np.inf
        cap[n] = min(cap_w[n], max_snr / snr) if floor[n] < np.inf else 0.0
    return top


@kernel
def fill_power(floor: FloatArray, cap: FloatArray, budget_w: float) -> float:
    """The level to which ``budget_w`` fills a :func:`vessel`; infinite where every cap is reached."""
    wet_floor = np.empty(floor.size)
    wet_cap = np.empty(floor.size)
    size = 0
    roomy = False
    for n in range(floor.size):
        # Once a subcarrier on the lowest floor can take the whole budget, nothing above the budget gets wet.
        if floor[n] < (budget_w if roomy else np.inf):
            wet_floor[size] = floor[n]
            wet_cap[size] = cap[n]
            size += 1
            roomy = roomy or (floor[n] == 0.0 and cap[n] >= budget_w)
    return water_level(wet_floor, wet_cap, size, budget_w)


@kernel
def set_power(floor: FloatArray, cap: FloatArray, level: float, owner: IntArray, power_w: FloatArray) -> None:
    """Write the power min(max(τ − f, 0), u) of each subcarrier; one that gets none has no owner."""
    for n in range(floor.size):
        power_w[n] = min(level - floor[n], cap[n]) if level > floor[n] else 0.0
        if power_w[n] == 0.0:
            owner[n] = -1


@kernel
def max_rate(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, budget_w: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Problem P1 for a batch: the best user on each subcarrier and water-filling of the budget; eqs. (8) and (9).

    Args:
        snr_per_w: a = g/(Γ N0 B), shape (batch, user, subcarrier), in 1/W.
        cap_w: power cap of each subcarrier, shape (subcarrier,), infinite where there is none.
        max_snr: SNR beyond which the rate stays the same, infinite where there is none.
        budget_w: power budget, shape (batch,).

    Returns:
        owner (batch, subcarrier), −1 where no power is spent; power in W, (batch, subcarrier); the price of power
        1/(τ + min 1/a) in nats per W, (batch,), 0 where the budget is more than can be used.
    """
    batch, _, subcarriers = snr_per_w.shape
    owner = np.empty((batch, subcarriers), dtype=np.int64)
    power = np.empty((batch, subcarriers))
    price = np.empty(batch)
    best = np.empty(subcarriers)
    floor = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    for b in range(batch):
        best_users(snr_per_w[b], best, owner[b])
        top = vessel(best, cap_w, max_snr, floor, cap)
        level = fill_power(floor, cap, budget_w[b])
        set_power(floor, cap, level, owner[b], power[b])
        price[b] = top / (1.0 + level * top) if top > 0.0 else 0.0
    return owner, power, price

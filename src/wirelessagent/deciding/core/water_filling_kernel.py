"""Water-filling, exact: the power (or the rate) that fills a vessel of uneven floors up to one level.

For floors f, caps u and a total t the level τ solves

    Σ_n min(max(τ − f_n, 0), u_n) = t.

With f = 1/a and t a power this is problem P1; with f = −ln a and t a rate in nats, the same level is that of the least
power for the rate. Textbook methods that drop the worst subcarrier first, or bisect to an absolute tolerance, fail
where the gains lie far apart. Here the level is found by projection (Michelot 1986; with caps Bitran and Hax 1981), and
depths are measured from a floor that is itself wet and not full, with differences of floors taken on the gains, where
they do not cancel. So every power is exact to a few rounding errors of the total.
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
    """The largest entry of each column of ``snr_per_w`` (user, subcarrier) and the first user that has it.

    Four rows meet each other before the best so far, which is then read and written a quarter as often.
    """
    users, subcarriers = snr_per_w.shape
    best[:] = snr_per_w[0]
    owner[:] = 0
    fours = 1 + (users - 1) // 4 * 4
    for k in range(1, fours, 4):
        first, second, third, fourth = snr_per_w[k], snr_per_w[k + 1], snr_per_w[k + 2], snr_per_w[k + 3]
        for n in range(subcarriers):
            left = second[n] if second[n] > first[n] else first[n]
            right = fourth[n] if fourth[n] > third[n] else third[n]
            left_user = k + 1 if second[n] > first[n] else k
            right_user = k + 3 if fourth[n] > third[n] else k + 2
            winner = right if right > left else left
            winner_user = right_user if right > left else left_user
            better = winner > best[n]
            best[n] = winner if better else best[n]
            owner[n] = winner_user if better else owner[n]
    for k in range(fours, users):
        row = snr_per_w[k]
        for n in range(subcarriers):
            better = row[n] > best[n]
            best[n] = row[n] if better else best[n]
            owner[n] = k if better else owner[n]


@kernel
def vessel(snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, floor: FloatArray, cap: FloatArray) -> None:
    """Write the shifted floors 1/a − min 1/a and the caps min(``cap_w``, max_snr/a).

    The shift is done on a, where it does not cancel. A subcarrier that cannot be used has an infinite floor.
    """
    top = snr_per_w.max()
    for n in range(snr_per_w.size):
        snr = snr_per_w[n]
        floor[n] = (top - snr) / top / snr if snr > 0.0 else np.inf
        cap[n] = min(cap_w[n], max_snr / snr) if floor[n] < np.inf else 0.0


@kernel
def rise(high: float, low: float, in_logs: bool) -> float:
    """How much higher the floor of the SNR ``low`` is than that of ``high``: ln(high/low), or 1/low − 1/high."""
    if in_logs:
        return np.log1p((high - low) / low)
    return (high - low) / high / low


@kernel
def settle(snr: FloatArray, cap: FloatArray, total: float, in_logs: bool, last: int, amount: FloatArray) -> float:
    """Fill up to the floor of the subcarrier ``last``, and spread the rest of ``total`` above it; exact with caps.

    ``last`` is a guess at the worst subcarrier that gets wet; it is moved until it is right. Writes the amounts
    (subcarrier,) and returns the price of one more unit: 1/level for powers, ln(level) for rates in nats.
    """
    size = snr.size
    zero = np.empty(size)
    room = np.empty(size)
    too_high = False
    while True:
        volume = 0.0
        count = 0
        better = -1
        worse = -1
        for n in range(size):
            amount[n] = 0.0
            if snr[n] >= snr[last]:
                amount[n] = min(rise(snr[n], snr[last], in_logs), cap[n])
                volume += amount[n]
                zero[count] = 0.0
                room[count] = cap[n] - amount[n]
                count += 1
                if snr[n] > snr[last] and (better < 0 or snr[n] < snr[better]):
                    better = n
            elif snr[n] > 0.0 and (worse < 0 or snr[n] > snr[worse]):
                worse = n
        if volume > total and better >= 0:
            last = better
            too_high = True
            continue
        depth = water_level(zero, room, count, max(total - volume, 0.0))
        ceiling = np.inf if worse < 0 else rise(snr[last], snr[worse], in_logs)
        if depth <= ceiling or too_high:
            depth = min(depth, ceiling)
            break
        last = worse
    for n in range(size):
        if snr[n] >= snr[last]:
            amount[n] = min(amount[n] + depth, cap[n])
    if in_logs:
        return depth - np.log(snr[last])
    return snr[last] / (1.0 + depth * snr[last])


@kernel
def fill_power(
    snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, budget_w: float, power_w: FloatArray
) -> tuple[float, float]:
    """Fill a :func:`vessel` with ``budget_w``: writes the power, returns the level and the price of power, 1/(τ + 1/a).

    The level is infinite and the price 0 where every cap is reached, or there is nothing to fill.
    """
    wet_floor = np.empty(floor.size)
    wet_cap = np.empty(floor.size)
    size = 0
    roomy = False
    top = -1
    for n in range(floor.size):
        # Once a subcarrier on the lowest floor can take more than the budget, nothing above the budget gets wet.
        if floor[n] < (budget_w if roomy else np.inf):
            wet_floor[size] = floor[n]
            wet_cap[size] = cap[n]
            size += 1
            if floor[n] == 0.0 and (top < 0 or cap[n] > cap[top]):
                top = n
                roomy = cap[n] > budget_w
    level = water_level(wet_floor, wet_cap, size, budget_w)
    set_power(floor, cap, level, power_w)
    if level == np.inf:
        return level, 0.0
    if level <= cap[top]:
        return level, snr_per_w[top] / (1.0 + level * snr_per_w[top])
    last = top  # the best subcarrier is full: measure from one that is not
    for n in range(floor.size):
        if floor[n] < level and snr_per_w[n] < snr_per_w[last]:
            last = n
    return level, settle(snr_per_w, cap, budget_w, False, last, power_w)


@kernel
def set_power(floor: FloatArray, cap: FloatArray, level: float, power_w: FloatArray) -> None:
    """Write the power min(max(τ − f, 0), u) of each subcarrier."""
    for n in range(floor.size):
        power_w[n] = min(level - floor[n], cap[n]) if level > floor[n] else 0.0


@kernel
def disown_idle(power_w: FloatArray, owner: IntArray) -> None:
    """A subcarrier without power has no owner."""
    for n in range(power_w.size):
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
        vessel(best, cap_w, max_snr, floor, cap)
        _, price[b] = fill_power(best, floor, cap, budget_w[b], power[b])
        disown_idle(power[b], owner[b])
    return owner, power, price

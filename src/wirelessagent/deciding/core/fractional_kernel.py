"""Problem P3, the most nats per joule: Dinkelbach's method, whose inner problem is closed here.

With the best user on each subcarrier the problem is max R(P)/(P + C), R the water-filling rate and C = ξ P_c. For an
efficiency q the best power is p_n = min(max(1/q − 1/a_n, 0), u_n), and q ← R/(P + C) climbs to the optimum at least
linearly and, near it, quadratically; Dinkelbach (1967). No search over the power is needed: R(P)/(P + C) rises with
P for as long as the price of power is above it, so the budget binds just where it is so at the budget.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.water_filling_kernel import best_users, fill_power, set_power, vessel
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MAX_ITERATIONS = 100
LOWEST_SNR = 1e-12
"""Without circuit power the efficiency is a supremum, approached as P → 0. Stopping at this SNR loses half of it."""


@kernel
def rate_and_power(snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, level: float) -> tuple[float, float]:
    """Rate in nats and power in W of the water level τ (above the best subcarrier's floor).

    Logarithms of large SNRs are taken of their product, which saves most of them; small ones one by one, because
    1 + x would lose them.
    """
    rate = 0.0
    power = 0.0
    product = 1.0
    for n in range(snr_per_w.size):
        if level > floor[n]:
            spent = min(level - floor[n], cap[n])
            snr = spent * snr_per_w[n]
            power += spent
            if 0.5 < snr < 1e100:
                product *= 1.0 + snr
                if product > 1e200:
                    rate += np.log(product)
                    product = 1.0
            else:
                rate += np.log1p(snr)
    return rate + np.log(product), power


@kernel
def efficient_level(
    snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, budget_level: float, circuit_w: float
) -> tuple[float, float, int]:
    """The water level of the best efficiency, that efficiency in nats/J and the iterations done.

    ``budget_level`` is the level that spends the budget, which is returned if spending it all is best.
    """
    top = snr_per_w.max()
    level = budget_level
    rate, power = rate_and_power(snr_per_w, floor, cap, level)
    efficiency = rate / (power + circuit_w)
    if level < np.inf and top / (1.0 + level * top) >= efficiency:
        return level, efficiency, 0
    for iteration in range(1, MAX_ITERATIONS + 1):
        wanted = min(max((top - efficiency) / efficiency, LOWEST_SNR) / top, budget_level)
        rate, power = rate_and_power(snr_per_w, floor, cap, wanted)
        better = rate / (power + circuit_w)
        if better > efficiency:
            level = wanted
        if better <= efficiency * (1.0 + 4e-16):
            return level, max(better, efficiency), iteration
        efficiency = better
    return level, efficiency, MAX_ITERATIONS


@kernel
def max_efficiency(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, budget_w: FloatArray, circuit_w: float
) -> tuple[IntArray, FloatArray, FloatArray, IntArray]:
    """Problem P3 for a batch: the best user on each subcarrier and the power of the best efficiency; eq. (11).

    Args:
        snr_per_w: a = g/(Γ N0 B), shape (batch, user, subcarrier), in 1/W.
        cap_w: power cap of each subcarrier, shape (subcarrier,), infinite where there is none.
        max_snr: SNR beyond which the rate stays the same, infinite where there is none.
        budget_w: power budget, shape (batch,).
        circuit_w: amplifier efficiency times circuit power, ξ P_c, in W.

    Returns:
        owner (batch, subcarrier), −1 where no power is spent; power in W, (batch, subcarrier); the price of power in
        nats per W, (batch,), which is the efficiency R/(P + ξ P_c) where the budget does not bind and no less where
        it does; iterations (batch,).
    """
    batch, _, subcarriers = snr_per_w.shape
    owner = np.empty((batch, subcarriers), dtype=np.int64)
    power = np.empty((batch, subcarriers))
    price = np.zeros(batch)
    iterations = np.zeros(batch, dtype=np.int64)
    best = np.empty(subcarriers)
    floor = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    for b in range(batch):
        best_users(snr_per_w[b], best, owner[b])
        top = vessel(best, cap_w, max_snr, floor, cap)
        full = fill_power(floor, cap, budget_w[b])
        level = full
        if cap.max() > 0.0:
            level, efficiency, iterations[b] = efficient_level(best, floor, cap, full, circuit_w)
            price[b] = max(efficiency, top / (1.0 + level * top)) if level == full else efficiency
        set_power(floor, cap, level, owner[b], power[b])
    return owner, power, price, iterations

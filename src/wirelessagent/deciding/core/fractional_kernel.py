"""Problem P3, the most nats per joule: Dinkelbach's method, whose inner problem is closed here.

With the best user on each subcarrier the problem is max R(P)/(P + C), R the water-filling rate and C = ξ P_c. For an
efficiency q the best power is p_n = min(max(1/q − 1/a_n, 0), u_n), and q ← R/(P + C) climbs to the optimum at least
linearly and, near it, quadratically; Dinkelbach (1967). No search over the power is needed: R(P)/(P + C) rises with
P for as long as the price of power is above it, so the budget binds just where it is so at the budget.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.water_filling_kernel import best_users, disown_idle, fill_power, set_power, vessel
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MAX_STEPS = 100
LOWEST_SNR = 1e-12
"""Without circuit power the efficiency is a supremum, approached as P → 0. Stopping at this SNR loses half of it."""


@kernel
def efficiency_of(snr_per_w: FloatArray, power_w: FloatArray, circuit_w: float) -> float:
    """R/(P + C) in nats per J.

    Logarithms of large SNRs are taken of their product, which saves most of them; small ones one by one, because
    1 + x would lose them.
    """
    rate = 0.0
    power = 0.0
    product = 1.0
    for n in range(snr_per_w.size):
        power += power_w[n]
        snr = power_w[n] * snr_per_w[n]
        if 0.5 < snr < 1e100:
            product *= 1.0 + snr
            if product > 1e200:
                rate += np.log(product)
                product = 1.0
        else:
            rate += np.log1p(snr)
    return (rate + np.log(product)) / (power + circuit_w)


@kernel
def climb_efficiency(
    snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, full: float, circuit_w: float, power_w: FloatArray
) -> tuple[float, int]:
    """Dinkelbach's method from the power ``power_w``, which is overwritten with the best; the efficiency and the steps.

    ``full`` is the level that spends the budget, which no step exceeds.
    """
    top = snr_per_w.max()
    efficiency = efficiency_of(snr_per_w, power_w, circuit_w)
    for step in range(1, MAX_STEPS + 1):
        level = max((top - efficiency) / efficiency, LOWEST_SNR) / top
        set_power(floor, cap, min(level, full), power_w)
        better = efficiency_of(snr_per_w, power_w, circuit_w)
        if better <= efficiency * (1.0 + 4e-16):
            return better, step
        efficiency = better
    return efficiency, MAX_STEPS


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
        it does; Dinkelbach's steps (batch,), 0 where the budget binds.
    """
    batch, _, subcarriers = snr_per_w.shape
    owner = np.empty((batch, subcarriers), dtype=np.int64)
    power = np.empty((batch, subcarriers))
    price = np.zeros(batch)
    steps = np.zeros(batch, dtype=np.int64)
    best = np.empty(subcarriers)
    floor = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    for b in range(batch):
        best_users(snr_per_w[b], best, owner[b])
        vessel(best, cap_w, max_snr, floor, cap)
        full, price[b] = fill_power(best, floor, cap, budget_w[b], power[b])
        if cap.max() > 0.0 and price[b] < efficiency_of(best, power[b], circuit_w):
            price[b], steps[b] = climb_efficiency(best, floor, cap, full, circuit_w, power[b])
        disown_idle(power[b], owner[b])
    return owner, power, price, steps

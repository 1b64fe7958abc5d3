"""Problem P3, the most nats per joule: Dinkelbach's method, sped up by the closed form of each active set.

With the best user on each subcarrier the problem is max R(P)/(P + C), R the water-filling rate and C = ξ P_c. For an
efficiency q the best power is p_n = min(max(1/q − 1/a_n, 0), u_n), and q ← R/(P + C) climbs to the optimum at least
linearly and, near it, quadratically; Dinkelbach (1967). As long as the same m subcarriers stay between empty and full,
R grows by m ln x and P by mτ(x − 1) when the level τ is multiplied by x, so that the best x solves one equation, whose
root Lambert's W gives; a few Newton steps are quicker. These are tried first. What ends the search is always a step of
Dinkelbach's that gains nothing, so the answer is as exact as without them.

No search over the power is needed: R(P)/(P + C) rises with P for as long as the price of power is above it, so the
budget binds just where the best power without a budget is beyond it.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.water_filling_kernel import best_users, disown_idle, fill_power, vessel
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MAX_STEPS = 100
NEWTON_STEPS = 8
LOWEST_SNR = 1e-12
"""Without circuit power the efficiency is a supremum, approached as P → 0. Stopping at this SNR loses half of it."""


@kernel
def pour(
    snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, level: float, power_w: FloatArray
) -> tuple[float, float, int]:
    """Write the power of each subcarrier at a level; the rate in nats, the power, how many are neither dry nor full.

    Logarithms of large SNRs are taken of their product, which saves most of them, in two halves that do not wait for
    each other; small ones one by one, because 1 + x would lose them.
    """
    rate = 0.0
    power = 0.0
    between = 0
    even = 1.0
    odd = 1.0
    for n in range(floor.size):
        poured = min(level - floor[n], cap[n]) if level > floor[n] else 0.0
        power_w[n] = poured
        power += poured
        between += 0.0 < poured < cap[n]
        snr = poured * snr_per_w[n]
        if 0.5 < snr < 1e100:
            even, odd = odd * (1.0 + snr), even
            if even > 1e200:
                rate += np.log(even)
                even = 1.0
        elif snr > 0.0:
            rate += np.log1p(snr)
    return rate + np.log(even) + np.log(odd), power, between


@kernel
def best_stretch(rate: float, power: float, between: int, level: float, circuit_w: float) -> float:
    """The x that makes (R + m ln x)/(P + C + mτ(x − 1)) largest: R + m ln x − m = (P + C − mτ)/(τ x); NaN for none.

    ``level`` is the level τ from zero power, not from the lowest floor.
    """
    excess = (power + circuit_w) / level - between
    stretch = 0.0  # ln x
    for _ in range(NEWTON_STEPS):
        drop = excess * np.exp(-stretch)
        step = (rate + between * (stretch - 1.0) - drop) / (between + drop)
        stretch -= step
        if abs(step) < 1e-9:
            break
    return float(np.exp(stretch))


@kernel
def climb_efficiency(
    snr_per_w: FloatArray, floor: FloatArray, cap: FloatArray, level: float, circuit_w: float, power_w: FloatArray
) -> tuple[float, float, int]:
    """The best efficiency without a budget in nats per J, its power and the steps done; writes the powers.

    The search starts from any ``level`` at which some subcarrier has power. It stretches the level for as long as that
    gains and the wet subcarriers change, and then takes Dinkelbach's steps.
    """
    top = snr_per_w.max()
    rate, power, between = pour(snr_per_w, floor, cap, level, power_w)
    efficiency = rate / (power + circuit_w)
    stretching = True
    for step in range(1, MAX_STEPS + 1):
        set_before = between
        if stretching:
            from_zero = level + 1.0 / top
            level = from_zero * best_stretch(rate, power, between, from_zero, circuit_w) - 1.0 / top
            stretching = 0.0 < level < np.inf
        if not stretching:
            level = max((top - efficiency) / efficiency, LOWEST_SNR) / top
        rate, power, between = pour(snr_per_w, floor, cap, level, power_w)
        better = rate / (power + circuit_w)
        if not stretching and better <= efficiency * (1.0 + 4e-16):
            return better, power, step
        stretching = stretching and better > efficiency and between != set_before
        efficiency = max(better, efficiency)
    return efficiency, power, MAX_STEPS


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
        it does; steps of the search (batch,), 0 where the budget binds.
    """
    batch, _, subcarriers = snr_per_w.shape
    owner = np.empty((batch, subcarriers), dtype=np.int64)
    power = np.zeros((batch, subcarriers))
    price = np.zeros(batch)
    steps = np.zeros(batch, dtype=np.int64)
    best = np.empty(subcarriers)
    floor = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    for b in range(batch):
        best_users(snr_per_w[b], best, owner[b])
        vessel(best, cap_w, max_snr, floor, cap)
        spent = 0.0
        roomiest = cap.argmax()
        if cap[roomiest] > 0.0:
            start = floor[roomiest] + budget_w[b]
            price[b], spent, steps[b] = climb_efficiency(best, floor, cap, start, circuit_w, power[b])
        if spent > budget_w[b]:
            _, price[b] = fill_power(best, floor, cap, budget_w[b], power[b])
            steps[b] = 0
        disown_idle(power[b], owner[b])
    return owner, power, price, steps

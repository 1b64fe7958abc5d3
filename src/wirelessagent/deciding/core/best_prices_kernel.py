"""The dual's best prices for each goal: climbs of :mod:`.prices_kernel`, repeated where the goal moves with them.

Least power and most utility take one climb. The highest common level is what the prices prove; each level is a new
promise to climb for. The most utility per joule is Dinkelbach's method: the price of power at which F is worth what
the circuits take.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import EFFICIENCY, LEVEL, POWER, SUM, Ask
from wirelessagent.deciding.core.bundle_kernel import CURVATURE, HIGH, LOW, SLOPE
from wirelessagent.deciding.core.prices_kernel import FARTHEST, climb, price_terms
from wirelessagent.deciding.core.sets_kernel import Channel
from wirelessagent.deciding.core.settle_kernel import set_level
from wirelessagent.deciding.core.start_kernel import equal_price, even_split, typical_snr
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

COLD = np.array([0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3])
PROMISED = np.array([0.1, 0.02, 5e-3, 1.5e-3])
WARM = np.array([5e-3, 1.5e-3])
LAST = np.array([1e-3])
"""Temperatures of a climb from afar, from a start for promises alone, from the slot before, and from near prices."""
ROUNDS = 20
SETTLED = 1e-7


@kernel
def find_prices(
    snr_per_w: FloatArray,
    channel: Channel,
    ask: Ask,
    rows: FloatArray,
    log_price: FloatArray,
    log_mu: float,
    warm: bool,
    term: FloatArray,
) -> tuple[float, float, int]:
    """Climb to the dual's best prices; returns F (for the level its bound), ln μ and the Newton steps.

    ``log_price`` (user,) holds ln λ of the slot before where ``warm``, and receives the best; ``term`` (group, user)
    the groups' terms at them. ``rows`` is overwritten for the level.
    """  # fmt: skip
    users, subcarriers = snr_per_w.shape
    groups = ask.start.size - 1
    log_snr = np.empty((subcarriers, users))
    inverse = np.empty((subcarriers, users))
    for k in range(users):
        scale = np.exp(-channel.log_best[k])
        for n in range(subcarriers):
            log_snr[n, k] = channel.log_best[k] - channel.floor[k, n]
            inverse[n, k] = channel.inverse[k, n] * scale
    ceiling = np.ascontiguousarray(channel.ceiling.T)
    full_w = np.full((subcarriers, users), np.inf)
    if ceiling.max() < np.inf:
        full_w = np.expm1(ceiling) * inverse
    rate = np.empty((groups, users))
    rising = np.empty((groups, users))
    supplied = np.empty(users)
    moving = ask.goal == SUM or ask.goal == EFFICIENCY
    budget = ask.budget_w if moving else 0.0
    level = 1.0
    if not warm:
        typical = np.empty(users)
        typical_snr(snr_per_w, typical)
        if ask.goal == LEVEL:
            level = first_level(typical, ask, subcarriers)
            set_level(rows, ask.share, level)
        equal_price(rows, typical, subcarriers, log_price)
        if ask.goal != POWER and ask.goal != LEVEL:
            log_mu = even_split(rows, typical, subcarriers, ask.budget_w, log_price)
    elif ask.goal == LEVEL:
        level = np.exp(log_mu)
        set_level(rows, ask.share, level)
    if ask.goal == POWER or ask.goal == LEVEL:
        log_mu = 0.0
    dual, steps, iterations = np.inf, 0, 0
    low, high = -np.inf, np.inf
    for i in range(ROUNDS):
        temperatures = LAST if i > 0 else WARM if warm else COLD if moving else PROMISED
        if ask.goal == EFFICIENCY and i > 0:
            temperatures = COLD
        dual, log_mu, steps = climb(
            log_snr, inverse, ceiling, full_w, ask.start, rows, budget, moving, temperatures, log_price, log_mu,
            rate, term, rising, supplied,
        )  # fmt: skip
        iterations += steps
        if ask.goal == POWER or ask.goal == SUM:
            break
        total = price_terms(log_snr, inverse, ceiling, full_w, ask.start, log_price, rate, term, rising)
        if ask.goal == LEVEL:
            higher = level_bound(ask.share, log_price, total + ask.budget_w, ask.most_level)
            done = abs(higher - level) <= SETTLED * level
            level = higher
            dual = level
            if done or level <= 0.0:
                break
            set_level(rows, ask.share, level)
            continue
        # Efficiency: with the budget spent F/(P + C) is at least what can be had; it is that if the price is above it.
        if moving:
            reached = dual / (ask.budget_w + ask.circuit_w)
            if reached <= np.exp(log_mu) or not reached > 0.0 or ask.circuit_w <= 0.0:
                break
            moving, budget = False, 0.0
            low, high = log_mu, np.inf
            keep_worths(rows, log_price, log_mu, np.log(reached))
            log_mu = np.log(reached)
            continue
        surplus = dual / np.exp(log_mu) - ask.circuit_w  # falls with the price; the efficiency is where it is 0
        if surplus > 0.0:
            low = log_mu
        else:
            high = log_mu
        worth_w = total + ask.circuit_w
        if abs(surplus) <= SETTLED * worth_w or high - low <= SETTLED:
            break
        trial = log_mu + surplus / max(worth_w - surplus, 0.1 * worth_w)
        if not low < trial < high:
            trial = 0.5 * (low + high) if high < np.inf else low + 1.0
        keep_worths(rows, log_price, log_mu, trial)
        log_mu = trial
    price_terms(log_snr, inverse, ceiling, full_w, ask.start, log_price, rate, term, rising)
    if ask.goal == LEVEL:
        log_mu = np.log(level) if level > 0.0 else -FARTHEST
    return dual, log_mu, iterations


@kernel
def keep_worths(rows: FloatArray, log_price: FloatArray, log_mu: float, new_log_mu: float) -> None:
    """Keep the prices of rates that are what their straight utility pays where the price of power changes."""
    for k in range(log_price.size):
        straight = rows[k, SLOPE] > 0.0 and rows[k, CURVATURE] == 0.0 and rows[k, LOW] < rows[k, HIGH]
        if straight and abs(log_price[k] + log_mu - np.log(rows[k, SLOPE])) < 1e-6:
            log_price[k] -= new_log_mu - log_mu


@kernel
def first_level(typical: FloatArray, ask: Ask, subcarriers: int) -> float:
    """A level to start from: that of the user with the least for its share of an even split."""
    users = typical.size
    level = ask.most_level
    for k in range(users):
        if ask.share[k, 0] > 0.0:
            rate = subcarriers / users * np.log1p(ask.budget_w / subcarriers * typical[k])
            level = min(level, max(rate / ask.share[k, 0], 1e-250))
    return level


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

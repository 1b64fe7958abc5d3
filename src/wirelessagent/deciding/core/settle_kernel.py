"""The best powers on given sets, for each goal: the price of power that spends the budget, and its relatives.

With the sets fixed a problem is convex, and one number settles it:

- least power: nothing, each user's rate is given;
- most utility: the price of power μ at which Σ P_k(μ) meets the budget;
- most utility per joule: the efficiency q with q = U/(P + C) at the price max(q, μ), by Dinkelbach's method;
- highest common level: the t at which the rates t·share (kept within their limits) take the budget.

The score is minus the power, the utility, the efficiency or the level; sets that keep not every limit score less than
any that do, the less the further they are from it.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import EFFICIENCY, POWER, SUM, Ask
from wirelessagent.deciding.core.bundle_kernel import HIGH, LOW, REFERENCE, UNREACHABLE, utility
from wirelessagent.deciding.core.sets_kernel import RATE, SCALE, SPENT, WORTH, Sets, evaluate, set_price
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

HIGHEST_LOG_PRICE = 90.0
"""ln μ lies within ±90 of the utility's slopes, so that no priced power exceeds the cost of what is unreachable."""
OVERSPENT = 1e100
"""What a budget exceeded by its own size costs."""
SETTLED = 1e-13
STEPS = 80
LEAST_LEVEL = 1e-250


@kernel
def totals(sets: Sets, log_mu: float) -> tuple[float, float, int]:
    """Σ U, Σ P and the number of users without a rate that they must have, at the price e^``log_mu``."""
    user = sets.user
    set_price(user, log_mu)
    joint, power, missing = 0.0, 0.0, 0
    for k in range(user.shape[0]):
        evaluate(sets, k)
        if user[k, WORTH] <= -UNREACHABLE:
            missing += 1
        else:
            joint += utility(user[k], user[k, RATE])
            power += user[k, SPENT] * user[k, SCALE]
    return joint, power, missing


@kernel
def settle_budget(sets: Sets, budget_w: float, log_mu: float) -> tuple[float, float, float]:
    """Σ U, ln μ and Σ P at the price of power that spends the budget, from a first guess of ln μ.

    Where the promised rates alone exceed the budget the price is the highest and Σ U is minus the excess.
    """
    low, high = -HIGHEST_LOG_PRICE, HIGHEST_LOG_PRICE  # power exceeds the budget at low, and does not at high
    log_mu = min(max(log_mu, low), high)
    low_excess, high_excess = np.nan, np.nan
    joint, power, missing = totals(sets, log_mu)
    reach = 0.25
    stuck = 0
    for _ in range(STEPS):
        excess = np.log(max(power, 1e-300) / budget_w)
        if excess > SETTLED:
            low, low_excess = log_mu, excess
            stuck = stuck + 1 if stuck > 0 else 1
        else:
            high, high_excess = log_mu, excess
            stuck = stuck - 1 if stuck < 0 else -1
            if excess > -SETTLED:
                break
        if high - low <= SETTLED:
            break
        if np.isnan(low_excess) or np.isnan(high_excess):
            trial = log_mu + reach if excess > 0.0 else log_mu - reach
            reach *= 2.0
            if not low < trial < high:
                if (excess > 0.0 and log_mu >= HIGHEST_LOG_PRICE) or (excess <= 0.0 and log_mu <= -HIGHEST_LOG_PRICE):
                    break
                trial = min(max(trial, -HIGHEST_LOG_PRICE), HIGHEST_LOG_PRICE)
        elif abs(stuck) > 2:
            trial = 0.5 * (low + high)
            stuck = 0
        else:
            trial = high + (low - high) * high_excess / (high_excess - low_excess)
            trial = min(max(trial, low + 1e-3 * (high - low)), high - 1e-3 * (high - low))
        log_mu = trial
        joint, power, missing = totals(sets, log_mu)
    if power > budget_w * (1.0 + 1e-12) and log_mu < high:
        log_mu = high
        joint, power, missing = totals(sets, log_mu)
    if missing > 0:
        return -UNREACHABLE * missing, log_mu, power
    if power > budget_w * (1.0 + 1e-9):
        return -OVERSPENT * (power / budget_w - 1.0), log_mu, power
    return joint, log_mu, power


@kernel
def settle_efficiency(sets: Sets, budget_w: float, circuit_w: float, log_mu: float) -> tuple[float, float, float]:
    """The efficiency, ln of the price of power and Σ P: Dinkelbach's method, within the budget."""
    spending = np.nan  # ln μ of the whole budget
    efficiency = 0.0
    power = 0.0
    for _ in range(STEPS):
        joint, power, missing = totals(sets, log_mu)
        if missing > 0:
            return -UNREACHABLE * missing, log_mu, power
        if power > budget_w:
            if np.isnan(spending):
                joint, spending, power = settle_budget(sets, budget_w, log_mu)
                if joint <= -OVERSPENT * 1e-9:
                    return joint, spending, power
            log_mu = max(log_mu, spending)
            joint, power, missing = totals(sets, log_mu)
        better = joint / (power + circuit_w) if power + circuit_w > 0.0 else 0.0
        if better <= 0.0:
            return 0.0, log_mu, power
        price = np.log(better)
        if not np.isnan(spending):
            price = max(price, spending)
        settled = abs(price - log_mu) <= SETTLED and better <= efficiency * (1.0 + SETTLED)
        efficiency = max(efficiency, better)
        log_mu = min(max(price, -HIGHEST_LOG_PRICE), HIGHEST_LOG_PRICE)
        if settled:
            break
    return efficiency, log_mu, power


@kernel
def set_level(rows: FloatArray, share: FloatArray, level: float) -> None:
    """Promise every user the rate ``level`` times its share, kept within its limits; ``share`` (user, 3) has those."""
    for k in range(rows.shape[0]):
        rate = min(max(level * share[k, 0], share[k, 1]), share[k, 2])
        rows[k, LOW] = rate
        rows[k, HIGH] = rate
        rows[k, REFERENCE] = max(rate, 1e-300)


@kernel
def settle_level(
    sets: Sets, share: FloatArray, budget_w: float, most: float, level: float
) -> tuple[float, float, float]:
    """The level, its logarithm and Σ P: the highest common level, at most ``most``; ``rows`` then promise it."""
    low, high = -np.inf, np.log(most)
    log_level = min(np.log(max(level, LEAST_LEVEL)), high)
    low_slack, high_slack = np.nan, np.nan
    reach = 0.05
    power = 0.0
    missing = 0
    stuck = 0
    for _ in range(STEPS):
        set_level(sets.user, share, np.exp(log_level))
        _, power, missing = totals(sets, 0.0)
        excess = np.log(max(power, 1e-300) / budget_w) if missing == 0 else np.inf
        if excess > 0.0:
            high, high_slack = log_level, excess
            stuck = stuck + 1 if stuck > 0 else 1
        else:
            low, low_slack = log_level, excess
            stuck = stuck - 1 if stuck < 0 else -1
            if excess > -SETTLED or high - low <= SETTLED:
                break
        if high - low <= SETTLED or log_level < np.log(LEAST_LEVEL):
            break
        if np.isinf(low):
            trial = log_level - reach
            reach *= 3.0
        elif np.isnan(high_slack):
            trial = min(log_level + reach, high)
            reach *= 3.0
        elif np.isinf(high_slack) or abs(stuck) > 2:
            trial = 0.5 * (low + high)
            stuck = 0
        else:
            trial = low + (high - low) * low_slack / (low_slack - high_slack)
            trial = min(max(trial, low + 1e-3 * (high - low)), high - 1e-3 * (high - low))
        log_level = trial
    if np.isinf(low):
        score = -UNREACHABLE * missing if missing > 0 else -OVERSPENT * max(power / budget_w - 1.0, 1e-9)
        return score, np.log(max(level, LEAST_LEVEL)), power
    set_level(sets.user, share, np.exp(low))
    _, power, missing = totals(sets, 0.0)
    return np.exp(low), low, power


@kernel
def settle(ask: Ask, sets: Sets, at: float) -> tuple[float, float, float]:
    """Score, ln μ (of the level for that goal) and Σ P on given sets, from a guess ``at`` of the second."""
    if ask.goal == POWER:
        _, power, missing = totals(sets, 0.0)
        return (-UNREACHABLE * missing if missing > 0 else -power), 0.0, power
    if ask.goal == SUM:
        return settle_budget(sets, ask.budget_w, at)
    if ask.goal == EFFICIENCY:
        return settle_efficiency(sets, ask.budget_w, ask.circuit_w, at)
    return settle_level(sets, ask.share, ask.budget_w, ask.most_level, np.exp(at))

"""Where the climb of the prices starts: each user as if its best few subcarriers all had one mean gain.

For promised rates R one price π per subcarrier equalises the users: one that carries r nats on each of its R/r
subcarriers pays least in all where (r − 1) e^r + 1 = π ā, and π is right where Σ R/r is the number of subcarriers. A
nat more then costs λ = e^r/ā. Users who take what is worthwhile instead start from an even split of the budget.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import CURVATURE, HIGH, LOW, REFERENCE, SLOPE
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

MOST_AVERAGED = 8
BISECTIONS = 24
NEWTON_STEPS = 30
SHALLOW = 1e-3
"""A rate in nats below which (r − 1) e^r + 1 is worked out as a series, where it would cancel."""


@kernel
def typical_snr(snr_per_w: FloatArray, typical: FloatArray) -> None:
    """Write the mean of each user's best few gains, as many as its share of the subcarriers; shape (user,)."""
    users, subcarriers = snr_per_w.shape
    size = min(max((subcarriers + users - 1) // users, 1), MOST_AVERAGED, subcarriers)
    best = np.empty(size)
    for k in range(users):
        best[:] = 0.0
        for n in range(subcarriers):
            if snr_per_w[k, n] > best[size - 1]:
                at = size - 1
                while at > 0 and best[at - 1] < snr_per_w[k, n]:
                    best[at] = best[at - 1]
                    at -= 1
                best[at] = snr_per_w[k, n]
        typical[k] = best.mean()


@kernel
def nats_at(log_worth: float) -> float:
    """r with (r − 1) e^r + 1 = e^``log_worth``: the nats on a subcarrier whose price is that many times 1/ā."""
    if log_worth < -1.0:
        r = np.sqrt(2.0 * np.exp(log_worth))
    else:
        r = max(log_worth - np.log(max(log_worth, 1.0)), 0.7) + 0.5
    worth = np.exp(min(log_worth, 600.0))
    for _ in range(NEWTON_STEPS):
        grown = np.exp(min(r, 600.0))
        reached = (r - 1.0) * grown + 1.0 if r > SHALLOW else r * r * (0.5 + r * (1.0 / 3.0 + 0.125 * r))
        step = (reached - worth) / (r * grown)
        r = max(r - step, 0.1 * r)
        if abs(step) < 1e-6 * r:
            break
    return r


@kernel
def equal_price(rows: FloatArray, typical: FloatArray, subcarriers: int, log_price: FloatArray) -> None:
    """Write ln λ for the rates that the users must have, shape (user,); −∞ for those that must have none."""
    users = typical.size
    low, high = np.inf, -np.inf
    for k in range(users):
        if rows[k, LOW] > 0.0 and typical[k] > 0.0:
            low = min(low, -np.log(typical[k]) - 60.0 + 2.0 * min(np.log(rows[k, LOW]), 0.0))
            high = max(high, -np.log(typical[k]) + min(rows[k, LOW], 400.0) + 60.0)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        taken = 0.0
        for k in range(users):
            if rows[k, LOW] > 0.0 and typical[k] > 0.0:
                taken += rows[k, LOW] / nats_at(middle + np.log(typical[k]))
        if taken > subcarriers:
            low = middle
        else:
            high = middle
    for k in range(users):
        log_price[k] = -np.inf
        if rows[k, LOW] > 0.0 and typical[k] > 0.0:
            log_snr = np.log(typical[k])
            log_price[k] = nats_at(0.5 * (low + high) + log_snr) - log_snr


@kernel
def even_split(
    rows: FloatArray, typical: FloatArray, subcarriers: int, budget_w: float, log_price: FloatArray
) -> float:
    """Raise ln λ to the level of an even split of the budget for users who take what is worthwhile; a guess of ln μ."""
    users = typical.size
    log_mu = -np.inf
    for k in range(users):
        if rows[k, SLOPE] <= 0.0 or typical[k] <= 0.0 or rows[k, LOW] >= rows[k, HIGH]:
            continue
        level = np.log(budget_w / subcarriers + 1.0 / typical[k])
        rate = max(subcarriers / users * np.log1p(budget_w / subcarriers * typical[k]), 1e-300)
        log_price[k] = max(log_price[k], level)
        slope = np.log(rows[k, SLOPE])
        if rows[k, CURVATURE] > 0.0:
            slope -= rows[k, CURVATURE] * np.log(rate / rows[k, REFERENCE])
        log_mu = max(log_mu, slope - level)
    return log_mu if log_mu > -np.inf else 0.0

"""Prices of the users' rates and of power: the dual of every problem, by Newton's method on a smoothed maximum.

With w_k the price of user k's rate, μ that of power and λ = w/μ in W per nat, no allocation is worth more than

    F(w, μ) = Σ_k u_k*(w_k) + μ [Σ_g max_k t_kg(λ) + P],    u*(w) = max over low ≤ r ≤ high of U(r) − w r,
    t_kg = Σ over n in g of λ_k r − (e^r − 1)/a_kn,  r = min(max(ln(λ_k a_kn), 0), c_kn),

where g runs over the groups of subcarriers that have one owner. F is convex in (w, μ) but kinked wherever two users tie
for a group, and at its minimum many do, so that subgradients and coordinate steps stall. Here max_k t becomes
T ln Σ_k e^(t_k/T) for a temperature T that falls step by step: the users' shares e^(t_k/T)/Σ give the supply of rate,
U gives the demand, and Newton's method in (ln λ, ln μ) makes them meet in a few steps per temperature. A utility that
is straight has a demand that jumps; it is bent by as little as the temperature, around the rate supplied just then.
Any prices on the way give a valid bound; the best are kept.

For promises alone (low = high, U = 0) μ is 1, P is 0, and −F = λ·R − Σ max t is the dual of P2.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import CURVATURE, HIGH, LOW, REFERENCE, SLOPE, utility
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

STEPS = 12
TRIALS = 12
SHRINK = 0.25
LONGEST_STEP = 1.0
FARTHEST = 500.0
"""Prices stay within e^±500 of 1 W per nat."""
FLAT = 1e-4
LOG_NEGLIGIBLE = np.log(1e-7)
"""Logarithm of the share below which a user counts for nothing in a group."""
SMALL = 0.03
"""A share, times the relative temperature, below which a user is left out of the Hessian: dense pairs would cost most
of the time, and what is left out weighs more the lower the temperature."""
LEAST_REFERENCE = 1e-6
"""Smallest rate, next to the mean one, around which a straight utility is bent."""


@kernel
def price_terms(
    log_snr: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    full_w: FloatArray,
    start: IntArray,
    log_price: FloatArray,
    rate: FloatArray,
    term: FloatArray,
    rising: FloatArray,
) -> float:
    """Write r, t and the number of subcarriers whose rate rises with the price, shape (group, user); returns Σ max t.

    The matrices of the channel have shape (subcarrier, user), ``start`` (group + 1,) the first subcarrier of each
    group, and ``full_w`` is the power (e^c − 1)/a at the ceiling.
    """  # fmt: skip
    users = log_price.size
    price = np.exp(log_price)
    total = 0.0
    for g in range(start.size - 1):
        for n in range(start[g], start[g + 1]):
            first = n == start[g]
            for k in range(users):
                r = log_price[k] + log_snr[n, k]
                up = 1.0
                t = price[k] * (r - 1.0) + inverse[n, k]
                if r >= ceiling[n, k]:
                    r = ceiling[n, k]
                    t = price[k] * r - full_w[n, k]
                    up = 0.0
                if r <= 0.0:
                    r = 0.0
                    t = 0.0
                    up = 0.0
                if first:
                    rate[g, k] = r
                    term[g, k] = t
                    rising[g, k] = up
                else:
                    rate[g, k] += r
                    term[g, k] += t
                    rising[g, k] += up
        highest = 0.0
        for k in range(users):
            highest = max(highest, term[g, k])
        total += highest
    return total


@kernel
def demand(
    user: FloatArray, slope: float, curvature: float, reference: float, offset: float, log_w: float
) -> tuple[float, float]:
    """The rate that a user takes at the price e^``log_w``, and minus its change per unit of ``log_w``.

    Beyond the rate ``offset`` its utility is a power law.
    """
    low, high = user[LOW], user[HIGH]
    if slope <= 0.0 or low >= high:
        return low, 0.0
    excess = np.exp(min((np.log(slope) - log_w) / curvature + np.log(reference), 700.0))
    rate = offset + excess
    if rate <= low:
        return low, 0.0
    if rate >= high:
        return high, 0.0
    return rate, excess / curvature


@kernel
def smoothed(
    users_rows: FloatArray,
    bent: FloatArray,
    budget_w: float,
    log_price: FloatArray,
    log_mu: float,
    moving: bool,
    rate: FloatArray,
    term: FloatArray,
    rising: FloatArray,
    temperature: float,
    small: float,
    gradient: FloatArray,
    hessian: FloatArray,
    supplied: FloatArray,
) -> tuple[float, float]:
    """The smoothed F from :func:`price_terms`; writes its gradient and the lower half of its Hessian in (ln λ, ln μ).

    ``bent`` (user, 4) holds slope, curvature, reference and offset of each user's bent utility. The Hessian leaves
    out what vanishes with the gradient, so it is positive semidefinite. ``supplied`` receives the users' rates.
    """  # fmt: skip
    groups, users = rate.shape
    price = np.exp(log_price)
    share = np.empty(users)
    worth = np.empty(users)
    bend_w = np.empty(users)
    active = np.empty(users, dtype=np.int64)
    hessian[:] = 0.0
    gradient[:] = 0.0
    supplied[:] = 0.0
    total = 0.0
    for g in range(groups):
        highest = 0.0
        for k in range(users):
            highest = max(highest, term[g, k])
        threshold = highest + temperature * LOG_NEGLIGIBLE
        sum_of_shares = 0.0
        size = 0
        for k in range(users):
            if term[g, k] > threshold:
                share[size] = np.exp((term[g, k] - highest) / temperature)
                sum_of_shares += share[size]
                active[size] = k
                size += 1
        total += highest + temperature * np.log(sum_of_shares)
        for i in range(size):
            k = active[i]
            share[i] /= sum_of_shares
            supplied[k] += share[i] * rate[g, k]
            worth[i] = price[k] * rate[g, k]
            hessian[k, k] += share[i] * (worth[i] * worth[i] / temperature + rising[g, k] * price[k])
        kept = 0
        for i in range(size):
            if share[i] > small and worth[i] > 0.0:
                share[kept], worth[kept], active[kept] = share[i], worth[i], active[i]
                kept += 1
        for i in range(kept):
            pull = share[i] * worth[i] / temperature
            for j in range(i + 1):
                hessian[active[i], active[j]] -= pull * share[j] * worth[j]
    if moving:
        log_mu = balance(users_rows, bent, log_price, total + budget_w, log_mu)
    mu = np.exp(log_mu)
    value = mu * (total + budget_w)
    elastic = 0.0
    for k in range(users):
        w = mu * price[k]
        taken, falling = demand(users_rows[k], bent[k, 0], bent[k, 1], bent[k, 2], bent[k, 3], log_price[k] + log_mu)
        value += bent_utility(users_rows[k], bent[k], taken) - w * taken
        gradient[k] = w * (supplied[k] - taken)
        bend_w[k] = w * falling
        elastic += w * falling
    for k in range(users):
        for j in range(k + 1):
            hessian[k, j] *= mu
            if moving and elastic > 0.0:
                hessian[k, j] -= bend_w[k] * bend_w[j] / elastic
        hessian[k, k] += bend_w[k]
    return value, log_mu


@kernel
def balance(users_rows: FloatArray, bent: FloatArray, log_price: FloatArray, worth_w: float, log_mu: float) -> float:
    """ln μ at which Σ λ_k r_k(μ λ_k), which falls with μ, is ``worth_w`` = Σ max t + P: the best μ at these λ."""
    low, high = -FARTHEST, FARTHEST
    for _ in range(60):
        paid = 0.0
        falling = 0.0
        for k in range(log_price.size):
            rate, change = demand(users_rows[k], bent[k, 0], bent[k, 1], bent[k, 2], bent[k, 3], log_price[k] + log_mu)
            price = np.exp(log_price[k])
            paid += price * rate
            falling += price * change
        if paid > worth_w:
            low = log_mu
        else:
            high = log_mu
        if abs(paid - worth_w) <= 1e-11 * worth_w or high - low < 1e-13:
            break
        trial = log_mu + np.log(paid / worth_w) * paid / falling if falling > 0.0 and paid > 0.0 else np.inf
        if not low < trial < high:
            if low == -FARTHEST:
                trial = max(log_mu - 3.0, 0.5 * (low + high))
            elif high == FARTHEST:
                trial = min(log_mu + 3.0, 0.5 * (low + high))
            else:
                trial = 0.5 * (low + high)
        log_mu = trial
    return log_mu


@kernel
def bent_utility(user: FloatArray, bent: FloatArray, rate: float) -> float:
    """U of the bent utility but for a constant."""
    if bent[0] <= 0.0:
        return 0.0
    exponent = 1.0 - bent[1]
    logarithm = np.log(max(rate - bent[3], 1e-300) / bent[2])
    if abs(exponent * logarithm) < 1e-8:
        return bent[0] * bent[2] * logarithm
    return bent[0] * bent[2] * np.expm1(exponent * logarithm) / exponent


@kernel
def dot(matrix: FloatArray, row: int, other: int, size: int) -> float:
    """The scalar product of the beginnings of two rows, in four sums that run side by side."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    i = 0
    while i + 4 <= size:
        a += matrix[row, i] * matrix[other, i]
        b += matrix[row, i + 1] * matrix[other, i + 1]
        c += matrix[row, i + 2] * matrix[other, i + 2]
        d += matrix[row, i + 3] * matrix[other, i + 3]
        i += 4
    while i < size:
        a += matrix[row, i] * matrix[other, i]
        i += 1
    return (a + b) + (c + d)


@kernel
def newton_step(hessian: FloatArray, gradient: FloatArray, size: int, step: FloatArray) -> None:
    """Write −hessian⁻¹ · gradient, by Cholesky's method with a small ridge; ``hessian`` is used up."""
    largest = 0.0
    for k in range(size):
        largest = max(largest, hessian[k, k])
    for k in range(size):
        hessian[k, k] += 1e-12 * largest + 1e-300
    for j in range(size):
        pivot = hessian[j, j] - dot(hessian, j, j, j)
        hessian[j, j] = np.sqrt(max(pivot, 1e-12 * largest + 1e-300))
        for k in range(j + 1, size):
            hessian[k, j] = (hessian[k, j] - dot(hessian, k, j, j)) / hessian[j, j]
    for k in range(size):
        rest = -gradient[k]
        for i in range(k):
            rest -= hessian[k, i] * step[i]
        step[k] = rest / hessian[k, k]
    for k in range(size - 1, -1, -1):
        rest = step[k]
        for i in range(k + 1, size):
            rest -= hessian[i, k] * step[i]
        step[k] = rest / hessian[k, k]


@kernel
def exact_dual(
    users_rows: FloatArray, budget_w: float, log_w: FloatArray, log_mu: float, total_of_terms: float
) -> float:
    """F for the users' own utilities; ``total_of_terms`` is Σ max t at these prices."""
    value = np.exp(log_mu) * (total_of_terms + budget_w)
    for k in range(log_w.size):
        value += conjugate(users_rows[k], log_w[k])
    return value


@kernel
def conjugate(user: FloatArray, log_w: float) -> float:
    """u*(w) = max over low ≤ r ≤ high of U(r) − w r."""
    low, high = user[LOW], user[HIGH]
    w = np.exp(log_w)
    if user[SLOPE] <= 0.0 or low >= high:
        return utility(user, low) - w * low
    if user[CURVATURE] == 0.0:
        return utility(user, high) - w * high if w < user[SLOPE] else utility(user, low) - w * low
    taken, _ = demand(user, user[SLOPE], user[CURVATURE], user[REFERENCE], 0.0, log_w)
    return utility(user, taken) - w * taken


@kernel
def bend(users_rows: FloatArray, supplied: FloatArray, curvature: float, bent: FloatArray) -> None:
    """Write slope, curvature and reference of utilities that are curved by at least ``curvature``."""
    users = supplied.size
    mean = max(supplied.sum() / users, 1e-300)
    for k in range(users):
        bent[k, 0] = users_rows[k, SLOPE]
        bent[k, 1] = users_rows[k, CURVATURE]
        bent[k, 2] = users_rows[k, REFERENCE]
        bent[k, 3] = 0.0
        if users_rows[k, LOW] >= users_rows[k, HIGH]:
            bent[k, 0] = 0.0
        if users_rows[k, CURVATURE] < curvature and bent[k, 0] > 0.0:
            middle = min(max(supplied[k], users_rows[k, LOW] + curvature * mean), users_rows[k, HIGH])
            if users_rows[k, CURVATURE] > 0.0:
                bent[k, 0] *= (middle / users_rows[k, REFERENCE]) ** (-users_rows[k, CURVATURE])
            bent[k, 1] = curvature
            bent[k, 2] = middle - users_rows[k, LOW]
            bent[k, 3] = users_rows[k, LOW]


@kernel
def straighten(
    users_rows: FloatArray, supplied: FloatArray, tolerance: float, log_price: FloatArray, log_mu: float
) -> bool:
    """Move the prices of straight utilities to where their exact conjugate is smallest; whether there are any.

    Prices within ``tolerance`` of the slope were kept from it by the bending only.
    """
    any_straight = False
    for k in range(supplied.size):
        if users_rows[k, CURVATURE] > 0.0 or users_rows[k, SLOPE] <= 0.0 or users_rows[k, LOW] >= users_rows[k, HIGH]:
            continue
        any_straight = True
        worth = np.log(users_rows[k, SLOPE]) - log_mu
        if log_price[k] < worth + tolerance and (supplied[k] < users_rows[k, HIGH] or log_price[k] > worth - tolerance):
            log_price[k] = worth
    return any_straight


@kernel
def climb(
    log_snr: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    full_w: FloatArray,
    start: IntArray,
    users_rows: FloatArray,
    budget_w: float,
    moving: bool,
    temperatures: FloatArray,
    log_price: FloatArray,
    log_mu: float,
    rate: FloatArray,
    term: FloatArray,
    rising: FloatArray,
    supplied: FloatArray,
) -> tuple[float, float, int]:
    """Minimise F from ``log_price`` (ln λ, overwritten with the best found) and ``log_mu``, which moves if ``moving``.

    Returns F and ln μ at the best prices, and the Newton steps. Temperatures are in units of the mean price of a
    group. The matrices of the channel have shape (subcarrier, user); ``rate``, ``term`` and ``rising`` (group, user)
    are scratch. ``supplied`` (user,) receives the rates that the smoothed groups supply at the last prices.
    """  # fmt: skip
    groups, users = rate.shape
    gradient = np.empty(users)
    trial_gradient = np.empty(users)
    hessian = np.empty((users, users))
    step = np.zeros(users)
    bent = np.empty((users, 4))
    here = np.minimum(np.maximum(log_price, -FARTHEST), FARTHEST)
    here_mu = log_mu
    best, best_mu = np.inf, log_mu
    iterations = 0
    total = price_terms(log_snr, inverse, ceiling, full_w, start, here, rate, term, rising)
    for k in range(users):
        supplied[k] = users_rows[k, REFERENCE]
    for relative_temperature in temperatures:
        mean = total / groups
        if mean <= 0.0:
            mean = np.exp(here.max())
        temperature = relative_temperature * mean
        small = SMALL * relative_temperature
        bend(users_rows, supplied, 0.5 * relative_temperature, bent)
        value, here_mu = smoothed(
            users_rows, bent, budget_w, here, here_mu, moving, rate, term, rising, temperature, small,
            gradient, hessian, supplied,
        )  # fmt: skip
        for _ in range(STEPS):
            newton_step(hessian, gradient, users, step)
            promised = 0.0
            for i in range(users):
                promised -= gradient[i] * step[i]
            scale_of_value = np.exp(here_mu) * (total + budget_w)
            if promised <= FLAT * relative_temperature * abs(scale_of_value):
                break
            iterations += 1
            scale = 1.0
            moved = False
            trial, trial_mu, trial_value = here, here_mu, value
            for _ in range(TRIALS):
                trial = here + scale * np.minimum(np.maximum(step, -LONGEST_STEP), LONGEST_STEP)
                trial = np.minimum(np.maximum(trial, -FARTHEST), FARTHEST)
                total = price_terms(log_snr, inverse, ceiling, full_w, start, trial, rate, term, rising)
                trial_value, trial_mu = smoothed(
                    users_rows, bent, budget_w, trial, here_mu, moving, rate, term, rising, temperature, small,
                    trial_gradient, hessian, supplied,
                )  # fmt: skip
                if trial_value < value:
                    moved = True
                    break
                scale *= SHRINK
            if not moved:
                break
            here, here_mu, value = trial, trial_mu, trial_value
            gradient[:] = trial_gradient
        straight = False
        for tolerance in (0.0, 2.0 * relative_temperature):
            settled = here.copy()
            straight = straighten(users_rows, supplied, tolerance, settled, here_mu)
            if straight:
                total = price_terms(log_snr, inverse, ceiling, full_w, start, settled, rate, term, rising)
            found = exact_dual(users_rows, budget_w, settled + here_mu, here_mu, total)
            if found < best:
                best, best_mu = found, here_mu
                log_price[:] = settled
            if not straight:
                break
        if straight:
            total = price_terms(log_snr, inverse, ceiling, full_w, start, here, rate, term, rising)
    return best, best_mu, iterations

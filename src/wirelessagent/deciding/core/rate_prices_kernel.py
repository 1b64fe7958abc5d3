"""Prices of the promised rates: the dual of P2, climbed by Newton's method on a smoothed maximum.

For prices λ of the users' rates (W per nat) the power that carries the rates R is at least

    D(λ) = λ·R − Σ_n max_k t_kn,    t_kn = λ_k r − (e^r − 1)/a_kn,  r = min(max(ln(λ_k a_kn), 0), c_kn).

D is concave but kinked wherever two users tie for a subcarrier, and at its maximum many do, so that subgradients and
coordinate steps stall. Here max_k t becomes T ln Σ_k e^(t_k/T) for a temperature T that falls step by step: the users'
shares x_kn = e^(t_kn/T)/Σ give the gradient R_k − Σ_n x_kn r_kn, and Newton's method in ln λ converges in a few steps
per temperature. Every λ on the way gives a valid bound; the best is kept.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

TEMPERATURES = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)
"""T in units of the mean price of a subcarrier."""

STEPS = 6
TRIALS = 12
SHRINK = 0.25
LONGEST_STEP = 1.0
HIGHEST_LOG_PRICE = 500.0
FLAT = 1e-4
LOG_NEGLIGIBLE = np.log(1e-7)
"""Logarithm of the share below which a user counts for nothing on a subcarrier."""
SMALL = 1e-2
"""A share below which a user counts on the diagonal of the Hessian only: dense pairs would cost most of the time."""


@kernel
def priced_terms(
    log_snr: FloatArray,
    inverse_snr: FloatArray,
    ceiling: FloatArray,
    cap_w: FloatArray,
    log_price: FloatArray,
    rate: FloatArray,
    term: FloatArray,
) -> float:
    """Write r and t of the module's docstring, shape (subcarrier, user); returns Σ_n max_k t_kn.

    ``cap_w`` is the power (e^c − 1)/a at the ceiling; all matrices have shape (subcarrier, user).
    """  # fmt: skip
    subcarriers, users = log_snr.shape
    price = np.exp(log_price)
    total = 0.0
    for n in range(subcarriers):
        highest = 0.0
        for k in range(users):
            r = log_price[k] + log_snr[n, k]
            t = 0.0
            if r <= 0.0:
                r = 0.0
            elif r < ceiling[n, k]:
                t = price[k] * ((r - 1.0) + inverse_snr[n, k] / price[k] if r > 0.1 else r + np.expm1(-r))
            else:
                r = ceiling[n, k]
                t = price[k] * r - cap_w[n, k]
            rate[n, k] = r
            term[n, k] = t
            highest = max(highest, t)
        total += highest
    return total


@kernel
def smoothed(
    nats: FloatArray,
    log_price: FloatArray,
    rate: FloatArray,
    term: FloatArray,
    ceiling: FloatArray,
    temperature: float,
    gradient: FloatArray,
    hessian: FloatArray,
) -> float:
    """The smoothed dual from :func:`priced_terms`; writes its gradient and the lower half of minus its Hessian in ln λ.

    The Hessian leaves out the diagonal that vanishes with the gradient, so it is positive semidefinite.
    """  # fmt: skip
    subcarriers, users = rate.shape
    price = np.exp(log_price)
    share = np.empty(users)
    worth = np.empty(users)
    active = np.empty(users, dtype=np.int64)
    total = 0.0
    hessian[:] = 0.0
    for k in range(users):
        gradient[k] = price[k] * nats[k]
        total += gradient[k]
    for n in range(subcarriers):
        highest = term[n].max()
        sum_of_shares = 0.0
        size = 0
        for k in range(users):
            distance = (term[n, k] - highest) / temperature
            if distance > LOG_NEGLIGIBLE:
                share[size] = np.exp(distance)
                sum_of_shares += share[size]
                active[size] = k
                size += 1
        total -= highest + temperature * np.log(sum_of_shares)
        for i in range(size):
            k = active[i]
            share[i] /= sum_of_shares
            worth[i] = price[k] * rate[n, k]
            gradient[k] -= share[i] * worth[i]
            hessian[k, k] += share[i] * worth[i] * worth[i] / temperature
            if 0.0 < rate[n, k] < ceiling[n, k]:
                hessian[k, k] += share[i] * price[k]
        kept = 0
        for i in range(size):
            if share[i] > SMALL and worth[i] > 0.0:
                share[kept], worth[kept], active[kept] = share[i], worth[i], active[i]
                kept += 1
        for i in range(kept):
            pull = share[i] * worth[i] / temperature
            for j in range(i + 1):
                hessian[active[i], active[j]] -= pull * share[j] * worth[j]
    return total


@kernel
def newton_step(hessian: FloatArray, gradient: FloatArray, step: FloatArray) -> None:
    """Solve hessian · step = gradient by Cholesky's method with a small ridge; ``hessian`` is used up."""
    users = gradient.size
    largest = 0.0
    for k in range(users):
        largest = max(largest, hessian[k, k])
    for k in range(users):
        hessian[k, k] += 1e-12 * largest + 1e-300
    for j in range(users):
        pivot = hessian[j, j]
        for i in range(j):
            pivot -= hessian[j, i] * hessian[j, i]
        hessian[j, j] = np.sqrt(max(pivot, 1e-12 * largest + 1e-300))
        for k in range(j + 1, users):
            rest = hessian[k, j]
            for i in range(j):
                rest -= hessian[k, i] * hessian[j, i]
            hessian[k, j] = rest / hessian[j, j]
    for k in range(users):
        rest = gradient[k]
        for i in range(k):
            rest -= hessian[k, i] * step[i]
        step[k] = rest / hessian[k, k]
    for k in range(users - 1, -1, -1):
        rest = step[k]
        for i in range(k + 1, users):
            rest -= hessian[i, k] * step[i]
        step[k] = rest / hessian[k, k]


@kernel
def best_start(
    log_snr: FloatArray,
    inverse_snr: FloatArray,
    ceiling: FloatArray,
    cap_w: FloatArray,
    nats: FloatArray,
    starts: FloatArray,
    rate: FloatArray,
    term: FloatArray,
) -> tuple[FloatArray, float]:
    """The start with the largest D, kept within the range of prices, and that D; ``rate`` and ``term`` are scratch."""
    here = np.zeros(nats.size)
    best = -np.inf
    for start in starts:
        trial = np.minimum(np.maximum(start, -HIGHEST_LOG_PRICE), HIGHEST_LOG_PRICE)
        total = priced_terms(log_snr, inverse_snr, ceiling, cap_w, trial, rate, term)
        worth = (np.exp(trial) * nats).sum()
        if worth - total > best:
            best = worth - total
            here = trial
    return here, best


@kernel
def climb_prices(
    log_snr: FloatArray,
    inverse_snr: FloatArray,
    ceiling: FloatArray,
    cap_w: FloatArray,
    nats: FloatArray,
    starts: FloatArray,
    log_price: FloatArray,
) -> tuple[float, int]:
    """Maximise D from the best of ``starts``; writes the best ln λ found, shape (user,); returns D and the iterations.

    Args:
        log_snr, inverse_snr: ln a and 1/a, shape (subcarrier, user); −inf and 0 where a pair may not be used.
        ceiling, cap_w: most nats and the power that they take, same shape; infinite where there is no limit.
        nats: promised rates, shape (user,), all positive.
        starts: choices of ln λ to start from, shape (choice, user); λ in W per nat.
    """  # fmt: skip
    subcarriers, users = log_snr.shape
    rate = np.empty((subcarriers, users))
    term = np.empty((subcarriers, users))
    gradient = np.empty(users)
    trial_gradient = np.empty(users)
    hessian = np.empty((users, users))
    step = np.empty(users)
    here, best = best_start(log_snr, inverse_snr, ceiling, cap_w, nats, starts, rate, term)
    log_price[:] = here
    iterations = 0
    for relative_temperature in TEMPERATURES:
        total = priced_terms(log_snr, inverse_snr, ceiling, cap_w, here, rate, term)
        worth = (np.exp(here) * nats).sum()
        temperature = relative_temperature * (total if total > 0.0 else worth) / subcarriers
        value = smoothed(nats, here, rate, term, ceiling, temperature, gradient, hessian)
        if worth - total > best:
            best = worth - total
            log_price[:] = here
        for _ in range(STEPS):
            newton_step(hessian, gradient, step)
            if (gradient * step).sum() <= FLAT * relative_temperature * abs(value):  # what the step promises
                break
            iterations += 1
            scale = 1.0
            moved = False
            trial, trial_value = here, value
            for _ in range(TRIALS):
                trial = here + scale * np.minimum(np.maximum(step, -LONGEST_STEP), LONGEST_STEP)
                trial = np.minimum(np.maximum(trial, -HIGHEST_LOG_PRICE), HIGHEST_LOG_PRICE)
                total = priced_terms(log_snr, inverse_snr, ceiling, cap_w, trial, rate, term)
                trial_value = smoothed(nats, trial, rate, term, ceiling, temperature, trial_gradient, hessian)
                if trial_value > value:
                    moved = True
                    break
                scale *= SHRINK
            if not moved:
                break
            here, value = trial, trial_value
            gradient[:] = trial_gradient
            worth = (np.exp(here) * nats).sum()
            if worth - total > best:
                best = worth - total
                log_price[:] = here
    return best, iterations

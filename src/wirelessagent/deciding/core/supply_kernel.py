"""What the groups of subcarriers supply at prices of the users' rates: a smoothed maximum, its slope and its curvature.

With λ_k in W per nat a group g is worth max_k t_kg to its owner,

    t_kg = Σ over n in g of λ_k r − (e^r − 1)/a_kn,    r = min(max(ln(λ_k a_kn), 0), c_kn).

The maximum is kinked wherever two users tie. Here it is T ln Σ_k e^(t_k/T) for a temperature T: users share the group
in proportion to e^(t_k/T), and the rates λ buys, Σ share · r, change smoothly with the prices.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.sets_kernel import Channel
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

LOG_NEGLIGIBLE = np.log(1e-5)
"""Logarithm of the share below which a user counts for nothing in a group."""
SMALL = 1.0
"""A share, times the relative temperature, up to which a user competes with the strongest only in the Hessian: dense
pairs would cost most of the time, and what is left out weighs more the lower the temperature."""


class Groups(NamedTuple):
    """The channel with a subcarrier's users side by side.

    Attributes:
        log_snr, inverse, ceiling, full_w: ln a, 1/a, c and (e^c − 1)/a, shape (subcarrier, user); the last two are
            empty where there are no ceilings.
        start: first subcarrier of each group, shape (group + 1,).
    """

    log_snr: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    full_w: FloatArray
    start: IntArray


@kernel
def groups_of(channel: Channel, start: IntArray, capped: bool) -> Groups:
    """The groups of a channel, which has ceilings if ``capped``."""
    users, subcarriers = channel.floor.shape
    log_snr = np.empty((subcarriers, users))
    inverse = np.empty((subcarriers, users))
    for k in range(users):
        scale = np.exp(-channel.log_best[k])
        for n in range(subcarriers):
            log_snr[n, k] = channel.log_best[k] - channel.floor[k, n]
            inverse[n, k] = channel.inverse[k, n] * scale
    ceiling = np.empty((0, users))
    full_w = np.empty((0, users))
    if capped:
        ceiling = np.ascontiguousarray(channel.ceiling.T)
        full_w = np.expm1(ceiling) * inverse
    return Groups(log_snr, inverse, ceiling, full_w, start)


@kernel
def write_terms(groups: Groups, group: int, log_price: FloatArray, price: FloatArray, term: FloatArray) -> float:
    """Write t of a group for each user, shape (user,); returns the largest, or 0 if that is more."""
    users = price.size
    capped = groups.ceiling.size > 0
    term[:] = 0.0
    for n in range(groups.start[group], groups.start[group + 1]):
        log_snr, inverse = groups.log_snr[n], groups.inverse[n]
        if capped:
            ceiling, full_w = groups.ceiling[n], groups.full_w[n]
            for k in range(users):
                rate = log_price[k] + log_snr[k]
                worth = price[k] * (rate - 1.0) + inverse[k] if rate > 0.0 else 0.0
                term[k] += price[k] * ceiling[k] - full_w[k] if rate >= ceiling[k] else worth
        else:
            for k in range(users):
                rate = log_price[k] + log_snr[k]
                term[k] += price[k] * (rate - 1.0) + inverse[k] if rate > 0.0 else 0.0
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    k = 0
    while k + 4 <= users:
        a = term[k] if term[k] > a else a
        b = term[k + 1] if term[k + 1] > b else b
        c = term[k + 2] if term[k + 2] > c else c
        d = term[k + 3] if term[k + 3] > d else d
        k += 4
    while k < users:
        a = term[k] if term[k] > a else a
        k += 1
    return max(max(a, b), max(c, d))


@kernel
def rate_of(groups: Groups, group: int, user: int, log_price: float) -> tuple[float, float]:
    """Σ r of a group at the price e^``log_price``, and its change per unit of that logarithm."""
    total, rising = 0.0, 0.0
    for n in range(groups.start[group], groups.start[group + 1]):
        rate = log_price + groups.log_snr[n, user]
        if groups.ceiling.size > 0 and rate >= groups.ceiling[n, user]:
            total += groups.ceiling[n, user]
        elif rate > 0.0:
            total += rate
            rising += 1.0
    return total, rising


@kernel
def worth_w(groups: Groups, log_price: FloatArray) -> float:
    """Σ_g max_k t_kg in W."""
    price = np.exp(log_price)
    term = np.empty(price.size)
    total = 0.0
    for g in range(groups.start.size - 1):
        total += write_terms(groups, g, log_price, price, term)
    return total


class Sharers(NamedTuple):
    """The users who share a group, the first of each array.

    Attributes:
        user: who they are.
        share, worth, spent: their shares, and λ r and λ r − t of the whole group in W.
        term: t of every user.
    """

    user: IntArray
    share: FloatArray
    worth: FloatArray
    spent: FloatArray
    term: FloatArray


@kernel
def share_out(
    groups: Groups, group: int, log_price: FloatArray, price: FloatArray, temperature: float, at: Sharers
) -> tuple[int, float, float]:
    """Write who shares a group and how; returns how many, max t, and T ln Σ e^(t/T) less that."""
    highest = write_terms(groups, group, log_price, price, at.term)
    threshold = highest + temperature * LOG_NEGLIGIBLE
    size = 0
    for k in range(price.size):
        at.user[size] = k
        size += 1 if at.term[k] >= threshold else 0
    total = 0.0
    for i in range(size):
        at.share[i] = np.exp((at.term[at.user[i]] - highest) / temperature)
        total += at.share[i]
    for i in range(size):
        at.share[i] /= total
    return size, highest, temperature * float(np.log(total))


@kernel
def couple(at: Sharers, size: int, temperature: float, small: float, hessian: FloatArray) -> None:
    """Add Σ share_i share_j (v_i − v_j)²/2T to the Hessian's quadratic form, v = worth · d ln w − spent · d ln μ.

    ``at`` is used up.
    """
    last = hessian.shape[0] - 1
    top = 0
    for i in range(size):
        if at.share[i] > at.share[top]:
            top = i
    owner, most, spent_most = at.user[top], at.worth[top], at.spent[top]
    mass, spent, kept = 0.0, 0.0, 0
    for i in range(size):
        k = at.user[i]
        if at.share[i] > small or i == top:
            at.user[kept], at.share[kept], at.worth[kept], at.spent[kept] = k, at.share[i], at.worth[i], at.spent[i]
            mass += at.share[i]
            spent += at.share[i] * at.spent[i]
            kept += 1
        else:
            pull, more = at.share[i] / temperature, at.spent[i] - spent_most
            hessian[k, k] += pull * at.worth[i] * at.worth[i]
            hessian[owner, owner] += pull * most * most
            hessian[max(k, owner), min(k, owner)] -= pull * at.worth[i] * most
            hessian[last, k] -= pull * at.worth[i] * more
            hessian[last, owner] += pull * most * more
            hessian[last, last] += pull * more * more
    for i in range(kept):
        k = at.user[i]
        pull, more = at.share[i] / temperature, mass * at.spent[i] - spent
        hessian[k, k] += pull * at.worth[i] * at.worth[i] * (mass - at.share[i])
        hessian[last, k] -= pull * at.worth[i] * more
        hessian[last, last] += pull * at.spent[i] * more
        for j in range(i):
            hessian[k, at.user[j]] -= pull * at.worth[i] * at.share[j] * at.worth[j]


@kernel
def supply(
    groups: Groups,
    log_price: FloatArray,
    temperature: float,
    small: float,
    supplied: FloatArray,
    rising: FloatArray,
    cooling: FloatArray,
    hessian: FloatArray,
) -> tuple[float, float, float]:
    """Σ_g max t, smoothed and exact, and Σ_g Σ_k share·t, in W, at ln λ (user,).

    Writes Σ share·r (user,) and the lower half of the Hessian by ln w and ln μ, (user + 1, user + 1), at a temperature
    that is fixed times μ: that of μ times the first is μ times as much, but for the gradient, which the diagonal leaves
    out. ``rising`` (user,) is its part from rates that rise with the price, and ``cooling`` (user + 1,) minus the
    change of the gradient by the logarithm of the temperature. Shares of at most ``small`` compete with the largest
    only: dense pairs would cost most of the time.
    """  # fmt: skip
    users = log_price.size
    price = np.exp(log_price)
    at = Sharers(np.empty(users, dtype=np.int64), np.empty(users), np.empty(users), np.empty(users), np.empty(users))
    hessian[:], supplied[:], rising[:], cooling[:] = 0.0, 0.0, 0.0, 0.0
    total, entropy, shared = 0.0, 0.0, 0.0
    for g in range(groups.start.size - 1):
        size, highest, more = share_out(groups, g, log_price, price, temperature, at)
        total += highest
        entropy += more
        mean = 0.0
        for i in range(size):
            k = at.user[i]
            rate, change = rate_of(groups, g, k, float(log_price[k]))
            at.worth[i] = price[k] * rate
            at.spent[i] = at.worth[i] - at.term[k]
            mean += at.share[i] * at.term[k]
            supplied[k] += at.share[i] * rate
            rising[k] += at.share[i] * change * price[k]
        shared += mean
        for i in range(size):
            ahead = at.share[i] * (at.term[at.user[i]] - mean) / temperature
            cooling[at.user[i]] += ahead * at.worth[i]
            cooling[users] -= ahead * at.spent[i]
        couple(at, size, temperature, small, hessian)
    for k in range(users):
        hessian[k, k] += rising[k]
        hessian[users, k] -= rising[k]
        hessian[users, users] += rising[k]
    return total + entropy, total, shared

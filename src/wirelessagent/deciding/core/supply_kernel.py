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
LEAST = 5e-324
"""The least that a group is worth if it is worth anything."""
CROWDED = 6
"""So many users of a group from which on whole rows of the Hessian are written, which then is faster."""


LOG_SNR, RECIPROCAL, LIMIT, FULL_W = range(4)
"""Layers of ``pair``."""
SHARE, PAYS, SPENDS, TERM, FLOW = range(5)
"""Rows of what is known of the users who share a group: their shares, λ r and λ r − t of the whole group in W; then for
every user t, and share times λ r, which is 0 between groups."""


class Groups(NamedTuple):
    """The channel with a subcarrier's users side by side; few arrays, because each costs time wherever handed on.

    Attributes:
        pair: ln a, 1/a and, where there are ceilings, c and (e^c − 1)/a, shape (2 or 4, subcarrier, user).
        start: first subcarrier of each group, shape (group + 1,).
    """

    pair: FloatArray
    start: IntArray


@kernel
def groups_of(channel: Channel, start: IntArray, capped: bool) -> Groups:
    """The groups of a channel, which has ceilings if ``capped``."""
    users, subcarriers = channel.floor.shape
    pair = np.empty((4 if capped else 2, subcarriers, users))
    floor, inverse, ceiling, log_best = channel.floor, channel.inverse, channel.ceiling, channel.log_best
    scale = np.exp(-log_best)
    for n in range(subcarriers):
        for k in range(users):
            pair[LOG_SNR, n, k] = log_best[k] - floor[k, n]
        for k in range(users):
            pair[RECIPROCAL, n, k] = inverse[k, n] * scale[k]
        if capped:
            for k in range(users):
                pair[LIMIT, n, k] = ceiling[k, n]
                pair[FULL_W, n, k] = np.expm1(ceiling[k, n]) * pair[RECIPROCAL, n, k]
    return Groups(pair, start)


@kernel
def write_terms(
    pair: FloatArray, first: int, last: int, log_price: FloatArray, price: FloatArray, term: FloatArray, row: int
) -> float:
    """Write t of the subcarriers from ``first`` to before ``last`` for each user into a row of ``term``.

    Returns the largest, or 0 if that is more.
    """
    users = price.size
    for k in range(users):
        term[row, k] = 0.0
    for n in range(first, last):
        if pair.shape[0] > LIMIT:
            for k in range(users):
                rate = log_price[k] + pair[LOG_SNR, n, k]
                worth = price[k] * (rate - 1.0) + pair[RECIPROCAL, n, k] if rate > 0.0 else 0.0
                full = price[k] * pair[LIMIT, n, k] - pair[FULL_W, n, k]
                term[row, k] += full if rate >= pair[LIMIT, n, k] else worth
        else:
            for k in range(users):
                rate = log_price[k] + pair[LOG_SNR, n, k]
                term[row, k] += price[k] * (rate - 1.0) + pair[RECIPROCAL, n, k] if rate > 0.0 else 0.0
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    k = 0
    while k + 4 <= users:
        a = term[row, k] if term[row, k] > a else a
        b = term[row, k + 1] if term[row, k + 1] > b else b
        c = term[row, k + 2] if term[row, k + 2] > c else c
        d = term[row, k + 3] if term[row, k + 3] > d else d
        k += 4
    while k < users:
        a = term[row, k] if term[row, k] > a else a
        k += 1
    return max(max(a, b), max(c, d))


@kernel
def rate_of(pair: FloatArray, first: int, last: int, user: int, log_price: float) -> tuple[float, float]:
    """Σ r of a group at the price e^``log_price``, and its change per unit of that logarithm."""
    total, rising = 0.0, 0.0
    for n in range(first, last):
        rate = log_price + pair[LOG_SNR, n, user]
        if pair.shape[0] > LIMIT and rate >= pair[LIMIT, n, user]:
            total += pair[LIMIT, n, user]
        elif rate > 0.0:
            total += rate
            rising += 1.0
    return total, rising


@kernel
def worth_w(groups: Groups, log_price: FloatArray) -> float:
    """Σ_g max_k t_kg in W."""
    pair, start = groups.pair, groups.start
    price, term = np.exp(log_price), np.empty((1, log_price.size))
    total = 0.0
    for g in range(start.size - 1):
        total += write_terms(pair, start[g], start[g + 1], log_price, price, term, 0)
    return total


@kernel
def list_sharers(at: FloatArray, threshold: float, user: IntArray) -> int:
    """List the users whose terms are at least ``threshold``, and return how many they are."""
    users = user.size
    size, k = 0, 0
    while k < users:
        last = min(k + 4, users)
        if last - k < 4 or (
            at[TERM, k] >= threshold
            or at[TERM, k + 1] >= threshold
            or at[TERM, k + 2] >= threshold
            or at[TERM, k + 3] >= threshold
        ):  # most fours have none
            for j in range(k, last):
                user[size] = j
                size += 1 if at[TERM, j] >= threshold else 0
        k = last
    return size


@kernel
def share_out(highest: float, temperature: float, at: FloatArray, user: IntArray) -> tuple[int, float, bool]:
    """Write who shares a group and how; returns how many, T ln Σ e^(t/T) less max t, and whether one has it all.

    Users to whom the group is worth nothing have shares as well, but buy nothing with them and are not listed.
    """
    threshold = highest + temperature * LOG_NEGLIGIBLE
    size = list_sharers(at, max(threshold, LEAST), user)
    worthless = user.size - size if threshold <= 0.0 else 0
    if size == 1 and worthless == 0:
        at[SHARE, 0] = 1.0
        return 1, 0.0, True
    total = worthless * np.exp(-highest / temperature) if worthless > 0 else 0.0
    for i in range(size):
        at[SHARE, i] = np.exp((at[TERM, user[i]] - highest) / temperature)
        total += at[SHARE, i]
    for i in range(size):
        at[SHARE, i] /= total
    return size, temperature * float(np.log(total)), False


@kernel
def couple(at: FloatArray, user: IntArray, size: int, temperature: float, hessian: FloatArray) -> None:
    """Add Σ share_i share_j (v_i − v_j)²/2T to the Hessian's quadratic form, v = λ r · d ln w − (λ r − t) · d ln μ.

    That is Σ share·v² − (Σ share·v)², over T. Shares that are not listed have v = 0.
    """
    last = hessian.shape[0] - 1
    spent = 0.0
    for i in range(size):
        spent += at[SHARE, i] * at[SPENDS, i]
    crowded = size >= CROWDED
    for i in range(size):
        k = user[i]
        flow = at[SHARE, i] * at[PAYS, i]
        pull, more = flow / temperature, at[SPENDS, i] - spent
        if crowded:
            for j in range(k):
                hessian[k, j] -= pull * at[FLOW, j]
            at[FLOW, k] = flow
        else:
            for j in range(i):
                hessian[k, user[j]] -= pull * at[SHARE, j] * at[PAYS, j]
        hessian[k, k] += pull * at[PAYS, i] * (1.0 - at[SHARE, i])
        hessian[last, k] -= pull * more
        hessian[last, last] += at[SHARE, i] * at[SPENDS, i] * more / temperature
    if crowded:
        for i in range(size):
            at[FLOW, user[i]] = 0.0


@kernel
def supply(
    groups: Groups,
    log_price: FloatArray,
    temperature: float,
    supplied: FloatArray,
    rising: FloatArray,
    cooling: FloatArray,
    hessian: FloatArray,
) -> tuple[float, float, float]:
    """Σ_g max t, smoothed and exact, and Σ_g Σ_k share·t, in W, at ln λ (user,).

    Writes Σ share·r (user,) and the lower half of the Hessian by ln w and ln μ, (user + 1, user + 1), at a temperature
    that is fixed times μ: that of μ times the first is μ times as much, but for the gradient, which the diagonal leaves
    out. ``rising`` (user,) is its part from rates that rise with the price, and ``cooling`` (user + 1,) minus the
    change of the gradient by the logarithm of the temperature.
    """
    pair, start, users = groups.pair, groups.start, log_price.size
    price, at, user = np.exp(log_price), np.zeros((5, users)), np.empty(users, dtype=np.int64)
    hessian[:], supplied[:], rising[:], cooling[:] = 0.0, 0.0, 0.0, 0.0
    total, entropy, shared = 0.0, 0.0, 0.0
    for g in range(start.size - 1):
        highest = write_terms(pair, start[g], start[g + 1], log_price, price, at, TERM)
        size, more, alone = share_out(highest, temperature, at, user)
        mean = 0.0
        for i in range(size):
            k = user[i]
            rate, change = rate_of(pair, start[g], start[g + 1], k, float(log_price[k]))
            at[PAYS, i] = price[k] * rate
            at[SPENDS, i] = at[PAYS, i] - at[TERM, k]
            mean += at[SHARE, i] * at[TERM, k]
            supplied[k] += at[SHARE, i] * rate
            rising[k] += at[SHARE, i] * change * price[k]
        total += highest
        entropy += more
        shared += mean
        if alone:
            continue
        for i in range(size):
            ahead = at[SHARE, i] * (at[TERM, user[i]] - mean) / temperature
            cooling[user[i]] += ahead * at[PAYS, i]
            cooling[users] -= ahead * at[SPENDS, i]
        couple(at, user, size, temperature, hessian)
    for k in range(users):
        hessian[k, k] += rising[k]
        hessian[users, k] -= rising[k]
        hessian[users, users] += rising[k]
    return total + entropy, total, shared

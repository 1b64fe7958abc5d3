"""Estimates that rest on correlated users as well: kriging over users and frequency.

The correlation of two gains is the product of that of their users, u, and that over frequency, so one estimate weighs
the user's own nearest gains and those of the users that are correlated with it most, in units of their levels, about
what each user's gains say of its level, o with the variance s. Formulas are those of :mod:`.kriging_kernel`, with the
mean of the user's hypotheses in their place.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.side_by_side_kernel import JITTER

OWN, PARTNERS, THEIRS = 12, 8, 3
"""Gains of the user itself, other users, and gains of each that an estimate rests on at most."""
LEAST = 0.05
"""Correlation of users below which they tell each other nothing."""


@kernel
def add_nearest(known: BoolArray, place: IntArray, user: int, at: int, most: int, chosen: IntArray, size: int) -> int:
    """Append (user, subcarrier) of a user's observed entries nearest to subcarrier ``at``; returns the new size."""
    below, above = at, at + 1
    while most > 0 and (below >= 0 or above < place.size):
        lower = below >= 0 and (above >= place.size or place[at] - place[below] <= place[above] - place[at])
        n = below if lower else above
        below -= 1 if lower else 0
        above += 0 if lower else 1
        if known[user, n]:
            chosen[size, 0], chosen[size, 1] = user, n
            size += 1
            most -= 1
    return size


@kernel
def solve(matrix: FloatArray, size: int, side: FloatArray) -> bool:
    """Solve in place by Cholesky factors; False where the matrix is not positive definite."""
    for i in range(size):
        for j in range(i + 1):
            total = matrix[i, j]
            for m in range(j):
                total -= matrix[i, m] * matrix[j, m]
            if i > j:
                matrix[i, j] = total / matrix[j, j]
            elif total > 0.0:
                matrix[i, i] = np.sqrt(total)
            else:
                return False
    for i in range(size):
        for j in range(i):
            side[i] -= matrix[i, j] * side[j]
        side[i] /= matrix[i, i]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, size):
            side[i] -= matrix[j, i] * side[j]
        side[i] /= matrix[i, i]
    return True


@kernel
def order_partners(correlation: FloatArray, seen: IntArray) -> IntArray:
    """The users correlated with one, the most first; shape (partner,)."""
    order = np.argsort(-correlation)
    partners = np.empty(min(PARTNERS, order.size), np.int64)
    size = 0
    for j in order:
        if size < partners.size and correlation[j] > LEAST and seen[j] > 0:
            partners[size] = j
            size += 1
    return partners[:size]


@kernel
def krige_with_partners(
    gain: FloatArray,
    known: BoolArray,
    seen: IntArray,
    noise_variance: FloatArray,
    place: IntArray,
    table: FloatArray,
    noise: FloatArray,
    level: FloatArray,
    offset: FloatArray,
    shared: FloatArray,
    correlation: FloatArray,
    found: FloatArray,
) -> None:
    """Overwrite mean, variance from fading and other variance of the missing entries of correlated users.

    Args:
        gain, known, seen, noise_variance: see :mod:`.relative_kernel`, the latter NaN where unknown.
        place: of each subcarrier, shape (subcarrier,).
        table, noise, level, offset, shared: |ρ|² at each distance, η, the level a, o and s, the means of a user's
            hypotheses, shapes (user, distance) and (user,) each.
        correlation: of the gains of each two users, shape (user, user).
        found: shape (user, subcarrier, 3).
    """
    users, subcarriers = gain.shape
    most = OWN + PARTNERS * THEIRS
    chosen, matrix = np.empty((most, 2), np.int64), np.empty((most, most))
    side, towards = np.empty(most), np.empty(most)
    for k in range(users):
        partners = order_partners(correlation[k], seen)
        if partners.size == 0:
            continue
        for n in range(subcarriers):
            if known[k, n] or seen[k] == 0:
                continue
            size = add_nearest(known, place, k, n, OWN, chosen, 0)
            for j in partners:
                size = add_nearest(known, place, j, n, THEIRS, chosen, size)
            for i in range(size):
                a, at = chosen[i]
                for j in range(i + 1):
                    b, there = chosen[j]
                    same = 1.0 if a == b else 0.0
                    alike = max(correlation[a, b], same)
                    matrix[i, j] = alike * table[k, abs(place[at] - place[there])] + same * shared[a]
                matrix[i, i] += noise[a] + JITTER
                same = 1.0 if a == k else 0.0
                alike = max(correlation[a, k], same)
                towards[i] = alike * table[k, abs(place[at] - place[n])] + same * shared[k]
                side[i] = towards[i]
            if not solve(matrix, size, side):
                continue
            estimate, error, known_part = offset[k], table[k, 0] + shared[k], 0.0
            for i in range(size):
                a, at = chosen[i]
                own = noise[a] * level[a] * gain[a, at] if np.isnan(noise_variance[a, at]) else noise_variance[a, at]
                estimate += side[i] * (gain[a, at] - offset[a])
                error -= side[i] * (towards[i] + noise[a] * side[i])
                known_part += side[i] * side[i] * own
            error = max(error, 1e-13)
            unknown = (1.0 - np.sqrt(1.0 - min(error, 1.0))) * level[k]
            estimate = max(estimate, unknown)
            found[k, n, 0] = estimate
            found[k, n, 1] = 2.0 * estimate * unknown - unknown * unknown + max(error - 1.0, 0.0) * level[k] * level[k]
            found[k, n, 2] = known_part

"""How likely the observed gains of a user are under each hypothesis of their correlation.

For gains x of one user, in units of about its level, a hypothesis is a covariance C = |ρ|² + η·1 in units of the
unknown level a squared: x has mean a and covariance a²C. With A = 1ᵀC⁻¹1, B = 1ᵀC⁻¹x, Q = xᵀC⁻¹x and n entries, the
Gaussian likelihood is largest at the level 1/u, u = (B + √(B² + 4nQ))/2Q, where

    ln L = n ln u − (Qu² − 2Bu + A)/2 − ln|C|/2.

Gains are not Gaussian, so the logarithm counts ``SHARE`` of its value only. What fades look like is told by the exact
density of two neighbours, both exponential, with complex correlation ρ (Simon and Alouini, *Digital Communication over
Fading Channels*, eq. 6.2),

    ln f(y|x)/f(y) = −ln(1 − r) − r(x + y)/(1 − r) + ln I₀(2√(rxy)/(1 − r)),    r = |ρ|²/(1 + η),

which counts ``PAIR_SHARE``: neighbouring pairs tell much the same.

All hypotheses are worked on side by side, as the innermost axis, so that the processor's vectors are full.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

SHARE, PAIR_SHARE = 0.5, 0.1
JITTER = 1e-10
"""Added to each variance, so that no matrix is singular."""
BLOCK = 16
"""Most entries weighed together; of longer bands blocks are weighed and taken for independent."""
MOST_BLOCKS = 2
NEAREST = 1.0 - 1e-9
"""Largest correlation of a pair."""


@kernel
def factorise(place: IntArray, table: FloatArray, noise: FloatArray, shared: FloatArray, low: FloatArray) -> None:
    """Write the Cholesky factors of C + shared into the lower half of ``low``, shape (n, n, hypothesis).

    The diagonal holds the inverses of the factor's. ``place`` is of shape (n,), ``table`` (distance, hypothesis),
    ``noise`` and ``shared`` (hypothesis,).
    """
    size, count = place.size, noise.size
    for i in range(size):
        for j in range(i):
            here, row = low[i, j], table[place[i] - place[j]]
            for h in range(count):
                here[h] = row[h] + shared[h]
            for m in range(j):
                left, right = low[i, m], low[j, m]
                for h in range(count):
                    here[h] -= left[h] * right[h]
            scale = low[j, j]
            for h in range(count):
                here[h] *= scale[h]
        here, row = low[i, i], table[0]
        for h in range(count):
            here[h] = row[h] + shared[h] + noise[h] + JITTER
        for m in range(i):
            left = low[i, m]
            for h in range(count):
                here[h] -= left[h] * left[h]
        for h in range(count):
            here[h] = 1.0 / np.sqrt(max(here[h], JITTER))


@kernel
def add_forms(low: FloatArray, gain: FloatArray, one: FloatArray, seen: FloatArray, forms: FloatArray) -> None:
    """Add A, B, Q and −ln|C| of ``gain`` (n,) to ``forms`` (4, hypothesis); the rest is workspace (n, hypothesis)."""
    size, count = gain.size, forms.shape[1]
    a, b, q, product = forms[0], forms[1], forms[2], np.ones(count)
    for i in range(size):
        ones, values, scale = one[i], seen[i], low[i, i]
        for h in range(count):
            ones[h], values[h] = 1.0, gain[i]
        for m in range(i):
            left, one_m, seen_m = low[i, m], one[m], seen[m]
            for h in range(count):
                ones[h] -= left[h] * one_m[h]
                values[h] -= left[h] * seen_m[h]
        for h in range(count):
            ones[h] *= scale[h]
            values[h] *= scale[h]
            a[h] += ones[h] * ones[h]
            b[h] += ones[h] * values[h]
            q[h] += values[h] * values[h]
            product[h] *= scale[h]
    for h in range(count):
        forms[3, h] += 2.0 * np.log(product[h])


@kernel
def bump(t: float) -> float:
    """I₀(z) e^−z √(1 + 2πz) for t = z/(1 + z), to 3e-4: a polynomial, since it is 1 at both ends (fitted at the roots
    of a Chebyshev polynomial in t)."""
    high = 23.260764614522017 + t * (
        -75.04966537383113 + t * (113.03524321926469 + t * (-80.00695897366538 + t * 21.52127575650344))
    )
    return 1.0002358451008324 + t * (
        2.1033567425941992 + t * (-4.165205258845457 + t * (-0.6990560569156764 + t * high))
    )


@kernel
def add_pairs(place: IntArray, gain: FloatArray, table: FloatArray, noise: FloatArray, log_pairs: FloatArray) -> None:
    """Add ln f(y|x)/f(y) of neighbours, of mean gain 1, to ``log_pairs`` (hypothesis,).

    Logarithms are taken of the product, once.
    """
    count = log_pairs.size
    kept, product = np.empty(count), np.ones(count)
    for h in range(count):
        kept[h] = 1.0 / (1.0 + noise[h])
    for i in range(gain.size - 1):
        row = table[place[i + 1] - place[i]]
        both, root = gain[i] + gain[i + 1], 2.0 * np.sqrt(gain[i] * gain[i + 1])
        for h in range(count):
            r = min(row[h] * kept[h], NEAREST)
            scale = 1.0 / (1.0 - r)
            z = root * np.sqrt(r) * scale
            product[h] *= bump(z / (1.0 + z)) * scale / np.sqrt(1.0 + 6.283185307179586 * z)
            log_pairs[h] += z - r * both * scale
    for h in range(count):
        log_pairs[h] += np.log(product[h])


@kernel
def weigh(
    gain: FloatArray,
    known: BoolArray,
    place: IntArray,
    table: FloatArray,
    noise: FloatArray,
    forms: FloatArray,
) -> FloatArray:
    """ln L of each hypothesis for one user, shape (hypothesis,), up to a constant.

    Args:
        gain, known: of a user in units of about its level, shape (subcarrier,).
        place, table, noise: see :mod:`.hypotheses`, none of the noise NaN.
        forms: written, A, B, Q, −ln|C| and the level 1/u, shape (5, hypothesis).
    """
    seen = np.flatnonzero(known)
    count = noise.size
    if seen.size == 0:
        forms[:4], forms[4] = 0.0, 1.0
        return np.zeros(count)
    blocks = max(1, min(MOST_BLOCKS, seen.size // BLOCK))
    length = min(BLOCK, seen.size) if blocks > 1 else seen.size
    low, one, values_of = np.empty((length, length, count)), np.empty((length, count)), np.empty((length, count))
    nothing = np.zeros(count)
    forms[:] = 0.0
    log_pairs = np.zeros(count)
    mean = 0.0
    for i in seen:
        mean += gain[i] / seen.size
    for b in range(blocks):
        first = 0 if blocks == 1 else b * (seen.size - length) // (blocks - 1)
        chosen = seen[first : first + length]
        here, values = place[chosen], gain[chosen]
        factorise(here, table, noise, nothing, low)
        add_forms(low, values, one, values_of, forms)
        if mean > 0.0:
            add_pairs(here, values / mean, table, noise, log_pairs)
    entries = float(blocks * length)
    result = np.empty(count)
    for h in range(count):
        a, b, q = forms[0, h], forms[1, h], max(forms[2, h], 1e-300)
        u = (b + np.sqrt(b * b + 4.0 * entries * q)) / (2.0 * q)
        forms[4, h] = 1.0 / u
        log_likelihood = entries * np.log(u) - 0.5 * (q * u * u - 2.0 * b * u + a) + 0.5 * forms[3, h]
        result[h] = SHARE * log_likelihood + PAIR_SHARE * log_pairs[h]
    return result


@kernel
def weigh_users(
    gain: FloatArray,
    known: BoolArray,
    place: IntArray,
    table: FloatArray,
    noise: FloatArray,
    noise_share: FloatArray,
    forms: FloatArray,
) -> FloatArray:
    """ln L of each hypothesis for each user, (user, hypothesis).

    ``noise_share`` (user,) is η where ``noise`` (hypothesis,) is NaN. ``forms`` (user, 5, hypothesis) is written.
    """
    users, count = gain.shape[0], noise.size
    result = np.empty((users, count))
    own = np.empty(count)
    for k in range(users):
        for h in range(count):
            own[h] = noise_share[k] if np.isnan(noise[h]) else noise[h]
        result[k] = weigh(gain[k], known[k], place, table, own, forms[k])
    return result

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

Hypotheses are worked on side by side; see :mod:`.side_by_side_kernel`.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.side_by_side_kernel import JITTER, factorise, packed, width_of

SHARE, PAIR_SHARE = 0.5, 0.1
BLOCK = 16
"""Most entries weighed together; of longer bands blocks are weighed and taken for independent."""
MOST_BLOCKS = 2
NEAREST = 1.0 - 1e-9
"""Largest correlation of a pair."""


@kernel
def fill(place: IntArray, table: FloatArray, noise: FloatArray, first: int, low: FloatArray) -> None:
    """Write C of the hypotheses from ``first`` on to ``low``, packed."""
    last = min(first + low.shape[1], noise.size)
    own = noise[first:last]
    for i in range(place.size):
        for j in range(i + 1):
            here, row = packed(i, j), table[place[i] - place[j]][first:last]
            for c in range(row.size):
                low[here, c] = row[c]
        here = packed(i, i)
        for c in range(own.size):
            low[here, c] += own[c] + JITTER


@kernel
def add_forms(low: FloatArray, gain: FloatArray, side: FloatArray, sums: FloatArray) -> None:
    """Add A, B and Q of ``gain`` (n,) to ``sums`` (4, lane), whose last row is multiplied by |C|^−½.

    ``low`` holds the factors; ``side`` (2, n, lane) is workspace.
    """
    count = low.shape[1]
    for i in range(gain.size):
        for c in range(count):
            side[0, i, c], side[1, i, c] = 1.0, gain[i]
        for m in range(i):
            left = packed(i, m)
            for c in range(count):
                side[0, i, c] -= low[left, c] * side[0, m, c]
                side[1, i, c] -= low[left, c] * side[1, m, c]
        diagonal = packed(i, i)
        for c in range(count):
            one, value = side[0, i, c] * low[diagonal, c], side[1, i, c] * low[diagonal, c]
            side[0, i, c], side[1, i, c] = one, value
            sums[0, c] += one * one
            sums[1, c] += one * value
            sums[2, c] += value * value
            sums[3, c] *= low[diagonal, c]


@kernel
def conclude(sums: FloatArray, entries: float, first: int, forms: FloatArray, result: FloatArray) -> None:
    """Write ln L and the forms of the hypotheses from ``first`` on; see :func:`weigh`."""
    level, exponent = np.empty(sums.shape[1]), np.empty(sums.shape[1])
    for c in range(sums.shape[1]):
        a, b, q = sums[0, c], sums[1, c], max(sums[2, c], 1e-300)
        root = np.sqrt(b * b + 4.0 * entries * q)
        u = (b + root) / (2.0 * q)
        level[c] = 2.0 * q / (b + root)
        exponent[c] = 0.5 * (q * u * u - 2.0 * b * u + a)
    for h in range(first, min(first + sums.shape[1], result.size)):
        c = h - first
        forms[0, h], forms[1, h], forms[2, h] = sums[0, c], sums[1, c], sums[2, c]
        forms[3, h], forms[4, h] = 2.0 * np.log(sums[3, c]), level[c]
        result[h] += SHARE * (0.5 * forms[3, h] - entries * np.log(level[c]) - exponent[c])


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
def add_pairs(place: IntArray, gain: FloatArray, table: FloatArray, noise: FloatArray, result: FloatArray) -> None:
    """Add the share of ln f(y|x)/f(y) of neighbours, of mean gain 1, to ``result`` (hypothesis,).

    Logarithms are taken of the product, once; what depends on the distance alone is worked out once for each.
    """
    count, pairs = result.size, gain.size - 1
    exponent, product, scale, share, spread = (
        np.zeros(count), np.ones(count), np.empty(count), np.empty(count), np.empty(count)
    )  # fmt: skip
    done = np.zeros(pairs, np.bool_)
    for start in range(pairs):
        if done[start]:
            continue
        distance = place[start + 1] - place[start]
        for h in range(count):
            r = min(table[distance, h] / (1.0 + noise[h]), NEAREST)
            scale[h] = 1.0 / (1.0 - r)
            share[h] = r * scale[h]
            spread[h] = 2.0 * np.sqrt(r) * scale[h]
        for i in range(start, pairs):
            if place[i + 1] - place[i] != distance:
                continue
            done[i] = True
            both, root = gain[i] + gain[i + 1], np.sqrt(gain[i] * gain[i + 1])
            for h in range(count):
                z = root * spread[h]
                width = np.sqrt(1.0 + 6.283185307179586 * z)
                inverse = 1.0 / ((1.0 + z) * width)
                product[h] *= bump(z * width * inverse) * scale[h] * (1.0 + z) * inverse
                exponent[h] += z - both * share[h]
    for h in range(count):
        result[h] += PAIR_SHARE * (exponent[h] + np.log(product[h]))


@kernel
def weigh(
    gain: FloatArray,
    place: IntArray,
    table: FloatArray,
    noise: FloatArray,
    low: FloatArray,
    side: FloatArray,
    forms: FloatArray,
    result: FloatArray,
) -> None:
    """Write ln L of each hypothesis for one user to ``result`` (hypothesis,), up to a constant.

    Args:
        gain, place: of the user's observed entries in units of about its level, and where they are, shape (entry,).
        table, noise: see :mod:`.hypotheses`, none of the noise NaN.
        low, side: workspace for matrices of as many entries as :func:`most_together` says.
        forms: written, A, B, Q, −ln|C| and the level 1/u, shape (5, hypothesis).
    """
    length = most_together(gain.size)
    forms[:4], forms[4], result[:] = 0.0, 1.0, 0.0
    if gain.size == 0:
        return
    blocks = max(1, min(MOST_BLOCKS, gain.size // BLOCK))
    mean, sums = gain.mean(), np.empty((4, low.shape[1]))
    for start in range(0, noise.size, low.shape[1]):
        sums[:3], sums[3] = 0.0, 1.0
        for b in range(blocks):
            first = first_of(b, blocks, gain.size, length)
            fill(place[first : first + length], table, noise, start, low)
            factorise(low, length)
            add_forms(low, gain[first : first + length], side, sums)
        conclude(sums, float(blocks * length), start, forms, result)
    for b in range(blocks if mean > 0.0 else 0):
        first = first_of(b, blocks, gain.size, length)
        add_pairs(place[first : first + length], gain[first : first + length] / mean, table, noise, result)


@kernel
def first_of(block: int, blocks: int, seen: int, length: int) -> int:
    """The first of the observed entries of a block."""
    return 0 if blocks == 1 else block * (seen - length) // (blocks - 1)


@kernel
def most_together(seen: int) -> int:
    """How many of the observed entries of a user are weighed together.

    >>> [most_together(seen) for seen in (5, 31, 32)]
    [5, 31, 16]
    """
    return seen if seen < 2 * BLOCK else BLOCK


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
    longest = 1
    for k in range(users):
        longest = max(longest, most_together(known[k].sum()))
    width = width_of(count)
    low, side = np.ones((packed(longest, 0), width)), np.empty((2, longest, width))
    result, own = np.empty((users, count)), np.empty(count)
    for k in range(users):
        for h in range(count):
            own[h] = noise_share[k] if np.isnan(noise[h]) else noise[h]
        seen = np.flatnonzero(known[k])
        weigh(gain[k][seen], place[seen], table, own, low, side, forms[k], result[k])
    return result

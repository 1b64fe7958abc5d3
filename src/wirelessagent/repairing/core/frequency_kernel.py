"""Predicting every entry of a gain matrix from its nearest known neighbours in frequency, itself excluded.

Gains are relative to each user's mean. With correlation ρ(Δ) = 1 − γ(Δ) over frequency, γ(Δ) = (Δ/c)²/(1 + (Δ/c)²)
(the gain's under Rayleigh fading with an exponential power-delay profile of rms delay spread 1/(2πc)), the best
weights of the neighbours at distances l and r on either side are those of two-point linear prediction,

    w_l = (ρ_l − ρ_r ρ_lr) / (1 − ρ_lr²),    w_r likewise,

and the mean gets 1 − w_l − w_r: linear interpolation for a wide coherence c, the mean alone for a narrow one. Where
the two would add up to more than 1 they are scaled down to 1, so that the prediction stays an average.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

SMALLEST_ERROR = 1e-12
"""Floor of the expected squared relative error, so that its logarithm and its inverse exist."""

PROVABLE_ERROR = 1e-4
"""Squared relative error, (1 %)², below which agreement is no evidence: reports are rounded, and two equal ones
would otherwise prove a channel without any fading."""

LEAST_SHARE_OF_MEAN = 1e-6
"""Weight that the mean always keeps, so that nothing is estimated as 0 between two readings of 0."""


@kernel
def nearest_known(known: BoolArray) -> tuple[IntArray, IntArray]:
    """Index of the nearest known entry strictly below and above each one, −1 for none; shapes (user, subcarrier)."""
    num_users, num_subcarriers = known.shape
    below = np.full(known.shape, -1, dtype=np.int64)
    above = np.full(known.shape, -1, dtype=np.int64)
    for k in range(num_users):
        for n in range(1, num_subcarriers):
            below[k, n] = n - 1 if known[k, n - 1] else below[k, n - 1]
        for n in range(num_subcarriers - 2, -1, -1):
            above[k, n] = n + 1 if known[k, n + 1] else above[k, n + 1]
    return below, above


@kernel
def two_sided(below: float, above: float, coherence: float) -> tuple[float, float, float]:
    """Weights of the neighbours at distances ``below`` and ``above``, and the expected squared error in units of the
    variance: (1 − s)² + 2(w_l γ_l + w_r γ_r) − 2 w_l w_r γ_lr with s = w_l + w_r.

    Written in q = (Δ/c)² with ρ = 1/(1 + q) and γ = q/(1 + q), so that no digits are lost where all ρ are near 1.
    """
    scale = 1.0 / (coherence * coherence)
    q_below, q_above = below * below * scale, above * above * scale
    q_between = (below + above) * (below + above) * scale
    one_below, one_above, one_between = 1.0 + q_below, 1.0 + q_above, 1.0 + q_between
    share = one_between / (one_below * one_above * q_between * (2.0 + q_between))
    w_below = (q_between - q_below + q_above * one_between) * share
    w_above = (q_between - q_above + q_below * one_between) * share
    if w_below + w_above > 1.0 - LEAST_SHARE_OF_MEAN:
        shrink = (1.0 - LEAST_SHARE_OF_MEAN) / (w_below + w_above)
        w_below, w_above = w_below * shrink, w_above * shrink
    rest = 1.0 - w_below - w_above
    # γ of each distance, over the common denominator: one division instead of three.
    common = 2.0 / (one_below * one_above * one_between)
    g_below = q_below * one_above * one_between * common
    g_above = q_above * one_below * one_between * common
    g_between = q_between * one_below * one_above * common
    return w_below, w_above, rest * rest + w_below * g_below + w_above * g_above - w_below * w_above * g_between


@kernel
def decorrelation(distance: float, coherence: float) -> float:
    """γ = 1 − ρ at a distance, in a form that keeps its digits when small."""
    ratio = distance / coherence
    return ratio * ratio / (1.0 + ratio * ratio)


@kernel
def fading_variance(gain: float, error: float) -> float:
    """Variance of a gain predicted as ``gain`` when the expected squared error is ``error``, both relative.

    A complex Gaussian channel known up to a diffuse power s has a noncentral χ² gain: of mean ĝ it has the variance
    ĝ² − (ĝ − s)². On average over ĝ that is 2s − s² = ``error``. So peaks are less certain than fades.
    """
    diffuse = 1.0 - np.sqrt(1.0 - min(error, 1.0))
    certain = max(gain - diffuse, 0.0)
    return max((gain - certain) * (gain + certain), SMALLEST_ERROR)


@kernel
def mean_of_others(relative: FloatArray, known: BoolArray, count: int, total: float, n: int) -> float:
    """Mean of the ``count`` known entries of a row of sum ``total``, the n-th left out; 1 where none remains."""
    if not known[n]:
        return total / count if count > 0 else 1.0
    return (total - relative[n]) / (count - 1) if count > 1 else 1.0


@kernel
def neighbour_weights(below: float, above: float, coherence: float) -> tuple[float, float, float]:
    """Weights of the neighbours at distances ``below`` and ``above`` (−1 for none), and the expected squared error."""
    if below >= 0.0 and above >= 0.0:
        return two_sided(below, above, coherence)
    if below < 0.0 and above < 0.0:
        return 0.0, 0.0, 1.0
    decorrelated = decorrelation(max(below, above), coherence)
    error = decorrelated * (2.0 - decorrelated)
    if below >= 0.0:
        return 1.0 - decorrelated, 0.0, error
    return 0.0, 1.0 - decorrelated, error


@kernel
def distances(position: FloatArray, n: int, left: int, right: int) -> tuple[float, float]:
    """How far the entries at ``left`` and ``right`` are from ``n``, −1 where there is none."""
    below = position[n] - position[left] if left >= 0 else -1.0
    above = position[right] - position[n] if right >= 0 else -1.0
    return below, above


@kernel
def neighbours(row: FloatArray, left: int, right: int, otherwise: float) -> tuple[float, float]:
    """The values at ``left`` and ``right``, ``otherwise`` where there is none."""
    return row[left] if left >= 0 else otherwise, row[right] if right >= 0 else otherwise


@kernel
def predict_entry(
    below: float,
    above: float,
    gains: tuple[float, float],
    noises: tuple[float, float],
    mean: float,
    coherence: float,
) -> tuple[float, float]:
    """An entry from its two neighbours' gains, at distances ``below`` and ``above``, and the mean; and the expected
    squared error, to which the neighbours' measurement noise adds."""
    w_below, w_above, error = neighbour_weights(below, above, coherence)
    value = max(mean + w_below * (gains[0] - mean) + w_above * (gains[1] - mean), 0.0)
    from_noise = w_below * w_below * noises[0] + w_above * w_above * noises[1]
    return value, fading_variance(value, error) + from_noise


@kernel
def predict(
    relative: FloatArray,
    known: BoolArray,
    noise: FloatArray,
    position: FloatArray,
    candidates: FloatArray,
    share: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Every entry predicted from the known ones other than itself, and the expected squared error.

    The coherence c is uncertain, so both are those of a mixture of the ``candidates``, in units of ``position``: the
    mean Σ p_c m_c and the error Σ p_c (v_c + (m_c − mean)²), with m_c and v_c those of :func:`predict_entry` and p_c
    the ``share``, shape (user, candidate), each user's adding up to 1. Other shapes: (user, subcarrier), ``position``
    (subcarrier,). ``relative`` and its measurement-error variance ``noise`` are 0 where not known.
    """
    lefts, rights = nearest_known(known)
    predicted, expected = np.empty(relative.shape), np.empty(relative.shape)
    for k in range(relative.shape[0]):
        row, row_noise, row_known = relative[k], noise[k], known[k]
        count, total = row_known.sum(), row.sum()
        for n in range(row.size):
            left, right = lefts[k, n], rights[k, n]
            below, above = distances(position, n, left, right)
            gains, noises = neighbours(row, left, right, 0.0), neighbours(row_noise, left, right, 0.0)
            mean = mean_of_others(row, row_known, count, total, n)
            value, spread, variance, weight = 0.0, 0.0, 0.0, 0.0
            for c in range(candidates.size):
                p = share[k, c]
                if p > 0.0:
                    one, error = predict_entry(below, above, gains, noises, mean, candidates[c])
                    # Weighted mean and spread, updated one by one: no digits are lost where all agree.
                    weight += p
                    step = one - value
                    value += step * p / weight
                    spread += p * step * (one - value)
                    variance += p * error
            predicted[k, n], expected[k, n] = value, variance + spread
    return predicted, expected


@kernel
def misfit(
    relative: FloatArray, known: BoolArray, noise: FloatArray, position: FloatArray, candidates: FloatArray
) -> FloatArray:
    """Σ (ln v + e²/v) over each user's known entries left out one by one; shape (user, candidate).

    Twice the negative logarithm of a Gaussian likelihood, for each candidate coherence; 0 for users with fewer than
    two known entries. The left-out entry's own noise and ``PROVABLE_ERROR`` are
    part of v.
    """
    lefts, rights = nearest_known(known)
    found = np.zeros((relative.shape[0], candidates.size))
    product = np.empty(candidates.size)
    for k in range(relative.shape[0]):
        row, row_noise, row_known = relative[k], noise[k], known[k]
        count, total = row_known.sum(), row.sum()
        if count < 2:
            continue
        product[:] = 1.0
        for n in range(row.size):
            if not row_known[n]:
                continue
            left, right = lefts[k, n], rights[k, n]
            below, above = distances(position, n, left, right)
            gains, noises = neighbours(row, left, right, 0.0), neighbours(row_noise, left, right, 0.0)
            mean = mean_of_others(row, row_known, count, total, n)
            for c in range(candidates.size):
                value, variance = predict_entry(below, above, gains, noises, mean, candidates[c])
                variance += row_noise[n] + PROVABLE_ERROR
                error = row[n] - value
                found[k, c] += error * error / variance
                product[c] *= variance
                if not 1e-200 < product[c] < 1e200:  # logarithms are dear: one for many factors
                    found[k, c] += np.log(product[c])
                    product[c] = 1.0
        found[k] += np.log(product)
    return found


@kernel
def interpolate(relative: FloatArray, known: BoolArray, position: FloatArray) -> FloatArray:
    """Linear interpolation of every entry between the nearest known ones other than itself, shape (user, subcarrier).

    Beyond the outermost known entry its value; 1 where there is no other known entry.
    """
    below, above = nearest_known(known)
    found = np.ones(relative.shape)
    for k in range(relative.shape[0]):
        for n in range(relative.shape[1]):
            left, right = below[k, n], above[k, n]
            if left >= 0 and right >= 0:
                share = (position[n] - position[left]) / (position[right] - position[left])
                found[k, n] = (1.0 - share) * relative[k, left] + share * relative[k, right]
            elif left >= 0 or right >= 0:
                found[k, n] = relative[k, max(left, right)]
    return found

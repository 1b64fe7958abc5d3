"""What a set of subcarriers is worth to one user at a price of power: the atom of every search and every column.

A user whose utility is U(r) for low ≤ r ≤ high gets from the set S, where a watt costs μ,

    V(S; μ) = max over r of U(r) − μ P(r; S),    P(r; S) = Σ (e^(r_n) − 1)/a_n,  Σ r_n = r,

with r_n = min(max(z + ln a_n, 0), c_n) at one level z (water-filling). At the best rate U′(r) = μ dP/dr = μ e^z.

A user is a row of six numbers (see :mod:`.program`): low, high, reference rate r₀ > 0, slope s = U′(r₀), curvature α
and base U(r₀), which stand for U(r) = U(r₀) + s r₀ ((r/r₀)^(1−α) − 1)/(1−α), a power law: α = 0 is the rate itself and
α = 1 its logarithm. With s = 0 and low = high it is a promise, and V is minus what the promise costs.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.water_filling_kernel import water_level
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

LOW, HIGH, REFERENCE, SLOPE, CURVATURE, BASE = 0, 1, 2, 3, 4, 5
"""Columns of a user's row."""

UNREACHABLE = 1e200
"""What a user without a rate that it must have costs; more, the more is missing."""
SLACK = 1.0 - 1e-12
"""Share of a promised rate that the ceilings of a set must reach; the rest is rounding."""
MOST_POWER = 1e150
SHALLOW = 1e-3
"""A depth in nats below which powers are not worked out from sums, where they would cancel."""
STEPS = 60
SETTLED = 1e-13


@kernel
def fill_level(
    floor: FloatArray, ceiling: FloatArray, size: int, nats: float, scratch: FloatArray, scratch_cap: FloatArray
) -> float:
    """The level z at which the first ``size`` subcarriers carry ``nats``; infinite where they cannot.

    ``floor`` is −ln a; the scratch arrays are at least as long.
    """
    if size == 0:
        return np.inf
    lowest = np.inf
    total = nats
    capacity = 0.0
    for i in range(size):
        lowest = min(lowest, floor[i])
        scratch[i] = floor[i]
        total += floor[i]
        capacity += ceiling[i]
    if capacity <= nats:
        if capacity < nats * SLACK:
            return np.inf
        level = -np.inf
        for i in range(size):
            level = max(level, floor[i] + ceiling[i])
        return level
    wet = size
    level = total / wet
    while True:
        kept = 0
        total = nats
        for i in range(wet):
            if scratch[i] < level:
                scratch[kept] = scratch[i]
                total += scratch[i]
                kept += 1
        if kept == wet or kept == 0:
            break
        wet = kept
        level = total / wet
    if capacity < np.inf:
        for i in range(size):
            if level - floor[i] > ceiling[i]:
                for j in range(size):
                    scratch[j] = floor[j] - lowest
                    scratch_cap[j] = ceiling[j]
                return lowest + water_level(scratch, scratch_cap, size, nats)
    return level


@kernel
def supply(floor: FloatArray, ceiling: FloatArray, size: int, level: float) -> tuple[float, int]:
    """The nats that the first ``size`` subcarriers carry at the level z, and how many would carry more at a higher."""
    nats = 0.0
    rising = 0
    for i in range(size):
        depth = level - floor[i]
        if depth > 0.0:
            if depth < ceiling[i]:
                nats += depth
                rising += 1
            else:
                nats += ceiling[i]
    return nats, rising


@kernel
def power_at(floor: FloatArray, inverse: FloatArray, ceiling: FloatArray, size: int, level: float) -> float:
    """The power in W that the first ``size`` subcarriers take at the level z."""
    power = 0.0
    top = np.exp(level)
    for i in range(size):
        depth = level - floor[i]
        if depth > 0.0:
            if depth >= ceiling[i]:
                power += np.expm1(ceiling[i]) * inverse[i]
            elif depth > 0.1:
                power += top - inverse[i]
            else:
                power += np.expm1(depth) * inverse[i]
    return min(power, MOST_POWER)


@kernel
def utility(user: FloatArray, rate: float) -> float:
    """U(r) of a user's row; −:data:`UNREACHABLE` where it is −∞."""
    reference = user[REFERENCE]
    if user[SLOPE] == 0.0:
        return user[BASE]
    if user[CURVATURE] == 0.0:
        return user[BASE] + user[SLOPE] * (rate - reference)
    if rate <= 0.0:
        if user[CURVATURE] >= 1.0:
            return -UNREACHABLE
        return user[BASE] - user[SLOPE] * reference / (1.0 - user[CURVATURE])
    exponent = 1.0 - user[CURVATURE]
    logarithm = np.log(rate / reference)
    if abs(exponent * logarithm) < 1e-8:
        return user[BASE] + user[SLOPE] * reference * logarithm
    return user[BASE] + user[SLOPE] * reference * np.expm1(exponent * logarithm) / exponent


@kernel
def best_level(
    user: FloatArray,
    floor: FloatArray,
    ceiling: FloatArray,
    size: int,
    log_mu: float,
    scratch: FloatArray,
    scratch_cap: FloatArray,
) -> float:
    """The level z of the best rate for a user at the price e^``log_mu``; infinite where ``low`` is out of reach.

    Between its limits the rate solves α ln(r/r₀) + z + ln μ = ln s, by Newton's method kept inside a bracket.
    """  # fmt: skip
    low, high = user[LOW], user[HIGH]
    if size == 0 or high <= 0.0:
        return np.inf if low > 0.0 else -np.inf
    if user[SLOPE] <= 0.0 or low >= high:
        return fill_level(floor, ceiling, size, low, scratch, scratch_cap) if low > 0.0 else -np.inf
    alpha = user[CURVATURE]
    level = np.log(user[SLOPE]) - log_mu
    rate, rising = supply(floor, ceiling, size, level)
    if alpha > 0.0:
        target = level + alpha * np.log(user[REFERENCE])
        lowest, highest = np.inf, -np.inf
        for i in range(size):
            lowest = min(lowest, floor[i])
            highest = max(highest, floor[i] + ceiling[i])
        level = max(level, lowest + 1e-3)
        for _ in range(STEPS):
            rate, rising = supply(floor, ceiling, size, level)
            if rate <= 0.0:
                break
            excess = alpha * np.log(rate) + level - target
            if excess > 0.0:
                highest = min(highest, level)
            else:
                lowest = max(lowest, level)
            step = excess / (1.0 + alpha * rising / rate)
            if abs(step) <= SETTLED * (1.0 + abs(level)):
                break
            trial = level - step
            if trial <= lowest or trial >= highest:
                if trial >= highest and np.isinf(highest):
                    level = trial
                    continue
                trial = 0.5 * (lowest + highest) if highest < np.inf else level + 1.0
            level = trial
        rate, rising = supply(floor, ceiling, size, level)
    if rate < low:
        return fill_level(floor, ceiling, size, low, scratch, scratch_cap)
    if rate > high:
        return fill_level(floor, ceiling, size, high, scratch, scratch_cap)
    return level


@kernel
def bundle(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    size: int,
    log_mu: float,
    scratch: FloatArray,
    scratch_cap: FloatArray,
) -> tuple[float, float, float, float]:
    """V(S; μ) of the module's docstring, with the rate, the power and the level z that reach it.

    Args:
        user: the user's row of six.
        floor, inverse, ceiling: −ln a, 1/a and the most nats of the set's subcarriers, the first ``size`` of each.
        log_mu: ln μ, the price of power in utility per W.
        scratch, scratch_cap: as long as the set, overwritten.
    """
    low = user[LOW]
    level = best_level(user, floor, ceiling, size, log_mu, scratch, scratch_cap)
    if level == np.inf:
        capacity = 0.0
        for i in range(size):
            capacity += ceiling[i]
        return -UNREACHABLE * (1.0 + max(1.0 - capacity / low, 0.0)), 0.0, 0.0, -np.inf
    rate, _ = supply(floor, ceiling, size, level)
    power = power_at(floor, inverse, ceiling, size, level)
    if low >= user[HIGH]:
        rate = low
    return utility(user, rate) - np.exp(log_mu) * power, rate, power, level


@kernel
def wet_bundle(
    user: FloatArray,
    size: float,
    floors: float,
    inverses: float,
    lowest: float,
    highest: float,
    log_mu: float,
    mu: float,
) -> tuple[float, float, float, float]:
    """:func:`bundle` from sums over the set alone, where all its subcarriers carry something and none is full.

    ``floors`` and ``inverses`` are Σ −ln a and Σ 1/a over the ``size`` subcarriers; then r = |S| z − Σ floors, and the
    power is |S| e^z − Σ 1/a. The worth is NaN where z is not between ``lowest`` and ``highest``.
    """
    low, high, reference, slope, curvature = user[LOW], user[HIGH], user[REFERENCE], user[SLOPE], user[CURVATURE]
    if slope <= 0.0 or low >= high:
        rate = low
    elif curvature == 0.0:
        rate = size * (np.log(slope) - log_mu) - floors
    else:
        target = np.log(slope) - log_mu + curvature * np.log(reference)
        rate = reference
        for _ in range(STEPS):
            excess = curvature * np.log(rate) + (rate + floors) / size - target
            step = excess / (curvature / rate + 1.0 / size)
            rate = max(rate - step, 0.1 * rate)
            if abs(step) <= 1e-14 * rate:
                break
    rate = min(max(rate, low), high)
    level = (rate + floors) / size
    if not (lowest < level <= highest and rate > 0.0):
        return np.nan, 0.0, 0.0, 0.0
    power = size * np.exp(level) - inverses
    if not power < MOST_POWER:
        return np.nan, 0.0, 0.0, 0.0
    return utility(user, rate) - mu * power, rate, power, level

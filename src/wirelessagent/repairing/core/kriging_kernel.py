"""Linear minimum-mean-square-error estimates of missing gains, for a few weighed hypotheses of the correlation.

In units of about the user's level, the observed gains x of a window have, under a hypothesis, the second moments
M = C + s·11ᵀ about an offset o of the level; for a band within one window o = 0 and s = 1, which gives the best
estimate among those that follow a change of unit, whatever the level is. A gain with the correlations k to those
observed is estimated as

    ĝ = o + wᵀ(x − o),    w = M⁻¹(k + s),

with the expected squared error 1 + s − wᵀ(k + s), a part of which, Σ w²η, is measurement noise. Where measured gains
are conditional means (:attr:`.observation.ChannelObservation.noise_variance`), they vary less than the gain does: for
C = |ρ|² + η their covariance is C/(1 + η)² and that with the gain |ρ|²/(1 + η). Noise is taken
as it was where each entry was measured, since it grows with the gain. The rest, V in units of the level squared, comes
from fading: of the complex coefficient the share c = 1 − √(1 − V) is unknown, and a gain whose mean is m has the
variance 2mc − c² then (a Rician power), if the phases of the observed coefficients are known. They are not, and what
they leave open depends less on m: the error's third cumulants with the estimate (tr AΣAΣBΣ for Hermitian forms A, B of
a complex Gaussian) give the variance the slope 5/6 · 2c for small c, and 2c for large, where phases do not matter. So m
is drawn towards the level there, by the share (1 − c)⁴/6, which follows the cumulants of holes on a grid within some
hundredths for c up to 0.4. The variance is small in a fade, and no estimate is below c. What V exceeds 1 by is due to
the level, which is unknown as well.

Hypotheses are averaged: means by their weights, variances with the disagreement of the means. Entries that were
observed are estimated from the others as well, which tells how good all this is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.side_by_side_kernel import (
    JITTER,
    backward,
    factorise,
    forward,
    invert,
    packed,
    width_of,
)
from wirelessagent.repairing.core.windows_kernel import (
    Lanes,
    Windows,
    empty_lanes,
    keep_likeliest,
    lay_lanes,
    lay_windows,
)

PHASES = 1.0 / 6.0
"""How much less the variance depends on the gain than that of a Rician power, for small c."""
LEAST = 1e-13
"""Least V."""


class Observed(NamedTuple):
    """What each lane rests on; shape (entry, lane) but ``size``.

    Attributes:
        size: how many members the lane's window has, shape (lane,).
        place: where they are, times the number of hypotheses: where the row of that distance begins in the table as it
            lies; beyond the last one, where that is.
        deviation: x − o, 0 beyond the last one.
        variance: of the measurement, 0 beyond the last one.
    """

    size: IntArray
    place: IntArray
    deviation: FloatArray
    variance: FloatArray


class Estimates(NamedTuple):
    """What each lane makes of one entry, shape (lane,): ĝ, Σ w², Σ w² times the noise, and the expected error."""

    mean: FloatArray
    own: FloatArray
    known: FloatArray
    error: FloatArray


@kernel
def load(
    gain: FloatArray,
    noise_variance: FloatArray,
    user: int,
    place: IntArray,
    members: IntArray,
    window: int,
    lanes: Lanes,
    begin: int,
    end: int,
    observed: Observed,
) -> None:
    """Write what the lanes from ``begin`` to ``end`` of a window rest on; see :func:`krige`."""
    last = 0
    for i in range(members.shape[1]):
        n = members[window, i]
        last = i if n >= 0 else last
        for c in range(begin, end):
            observed.place[i, c] = place[members[window, last]]
            observed.deviation[i, c], observed.variance[i, c] = 0.0, 0.0
            if n >= 0:
                own, noise = gain[user, n], noise_variance[user, n]
                observed.deviation[i, c] = own - lanes.offset[c]
                observed.variance[i, c] = lanes.noise[c] * lanes.level[c] * own if np.isnan(noise) else noise
    for c in range(begin, end):
        observed.size[c] = last + 1


@kernel
def fill(table: FloatArray, lanes: Lanes, observed: Observed, low: FloatArray) -> None:
    """Write M to ``low``, packed; that of the identity beyond the last member. ``table`` is flat."""
    size, count = observed.place.shape
    common = lanes.shared * lanes.grown**2
    for i in range(size):
        for j in range(i + 1):
            here = packed(i, j)
            for c in range(count):
                at = observed.place[i, c] - observed.place[j, c] + lanes.hypothesis[c]
                low[here, c] = table[at] + common[c]
        here = packed(i, i)
        for c in range(count):
            low[here, c] += lanes.noise[c] + JITTER
    for c in range(count):
        for i in range(observed.size[c], size):
            for j in range(i):
                low[packed(i, j), c] = 0.0
            low[packed(i, i), c] = 1.0


@kernel
def weigh_missing(
    low: FloatArray,
    at: IntArray,
    count: int,
    table: FloatArray,
    lanes: Lanes,
    observed: Observed,
    weight: FloatArray,
    error: FloatArray,
) -> None:
    """Write w (n, lane) for the place ``at`` (lane,), and its expected squared error (lane,), of ``count`` lanes.

    ``low`` holds factors, ``table`` is flat, and places are those of :class:`Observed`.
    """
    for c in range(count):
        h, grown = lanes.hypothesis[c], lanes.grown[c]
        common = lanes.shared[c] * grown * grown
        error[c] = table[h] * grown * grown + common
        for i in range(observed.size[c]):
            weight[i, c] = table[abs(observed.place[i, c] - at[c]) + h] * grown + common
        for i in range(observed.size[c], weight.shape[0]):
            weight[i, c] = 0.0
    forward(low, weight, count)
    for i in range(weight.shape[0]):
        for c in range(count):
            error[c] -= weight[i, c] * weight[i, c]
    backward(low, weight, count)
    for c in range(count):
        error[c] /= lanes.grown[c] ** 2


@kernel
def weigh_left_out(inverse: FloatArray, i: int, lanes: Lanes, weight: FloatArray, error: FloatArray) -> None:
    """Write w (n, lane) of the others for member ``i``, and its expected squared error (lane,); ``inverse`` packed."""
    size, count = weight.shape
    scale = 1.0 / inverse[packed(i, i)]
    for j in range(size):
        there = packed(max(i, j), min(i, j))
        for c in range(count):
            weight[j, c] = -inverse[there, c] * scale[c]
    weight[i] = 0.0
    for c in range(count):
        error[c] = (scale[c] - lanes.noise[c]) / lanes.grown[c] ** 2


@kernel
def apply(weight: FloatArray, count: int, lanes: Lanes, observed: Observed, estimates: Estimates) -> None:
    """Write the estimates that the weights (n, lane) make in the first ``count`` lanes."""
    mean, own, known = estimates.mean, estimates.own, estimates.known
    mean[:], own[:], known[:] = lanes.offset, 0.0, 0.0
    for i in range(weight.shape[0]):
        for c in range(count):
            w = weight[i, c]
            mean[c] += w * observed.deviation[i, c]
            own[c] += w * w
            known[c] += w * w * observed.variance[i, c]


@kernel
def combine(
    estimates: Estimates, lanes: Lanes, begin: int, end: int, found: FloatArray, user: int, subcarrier: int
) -> None:
    """Write mean, variance from fading and other variance of an entry to ``found``, from the lanes of a window."""
    mean, fading, other, total = 0.0, 0.0, 0.0, 0.0
    for c in range(begin, end):
        level, chance = lanes.level[c], lanes.probability[c]
        left = max(estimates.error[c] - lanes.noise[c] * estimates.own[c] / lanes.grown[c] ** 2, LEAST)
        share = 1.0 - np.sqrt(1.0 - min(left, 1.0))
        unknown = share * level
        estimate = max(estimates.mean[c], unknown)
        about = estimate + PHASES * (1.0 - share) ** 4 * (level - estimate)
        total += chance
        before = estimate - mean
        mean += before * chance / total
        other += chance * (before * (estimate - mean) + estimates.known[c])
        fading += chance * (2.0 * about * unknown - unknown * unknown + max(left - 1.0, 0.0) * level * level)
    found[user, subcarrier, 0], found[user, subcarrier, 1], found[user, subcarrier, 2] = mean, fading, other


@kernel
def estimate_missing(
    known: BoolArray,
    row: IntArray,
    table: FloatArray,
    windows: Windows,
    start: int,
    begin: IntArray,
    low: FloatArray,
    lanes: Lanes,
    observed: Observed,
    weight: FloatArray,
    estimates: Estimates,
    found: FloatArray,
) -> None:
    """Estimate the missing entries that the windows from ``start`` on serve, whose lanes begin at ``begin``.

    One of each window at a time, so that ever fewer windows, the first ones, have any left.
    """
    at, active = np.zeros(weight.shape[1], np.int64), begin.size - 1
    cursor = windows.begin[start : start + active].copy()
    for turn in range(windows.missing[start]):
        while windows.missing[start + active - 1] <= turn:
            active -= 1
        for i in range(active):
            while known[windows.user[start + i], cursor[i]]:
                cursor[i] += 1
            for c in range(begin[i], begin[i + 1]):
                at[c] = row[cursor[i]]
        count = width_of(int(begin[active]))
        weigh_missing(low, at, count, table, lanes, observed, weight, estimates.error)
        apply(weight, count, lanes, observed, estimates)
        for i in range(active):
            combine(estimates, lanes, begin[i], begin[i + 1], found, windows.user[start + i], cursor[i])
            cursor[i] += 1


@kernel
def estimate_left_out(
    windows: Windows,
    start: int,
    begin: IntArray,
    low: FloatArray,
    lanes: Lanes,
    observed: Observed,
    weight: FloatArray,
    estimates: Estimates,
    found: FloatArray,
) -> None:
    """Estimate the observed entries that the windows from ``start`` on serve from the others; ``low`` is used up."""
    length, count = weight.shape
    invert(low, length)
    for member in range(length):
        weigh_left_out(low, member, lanes, weight, estimates.error)
        apply(weight, count, lanes, observed, estimates)
        for i in range(begin.size - 1):
            w = start + i
            n = windows.member[w, member]
            if n >= windows.begin[w] and n < windows.end[w]:
                combine(estimates, lanes, begin[i], begin[i + 1], found, windows.user[w], n)


@kernel
def krige(
    gain: FloatArray,
    known: BoolArray,
    noise_variance: FloatArray,
    place: IntArray,
    table: FloatArray,
    noise: FloatArray,
    noise_share: FloatArray,
    forms: FloatArray,
    chance: FloatArray,
    test: bool,
    found: FloatArray,
) -> None:
    """Write mean, variance from fading and other variance of each entry, shape (user, subcarrier, 3).

    Args:
        gain, known: in units of about each user's level, shape (user, subcarrier).
        noise_variance: of the measurements in units of the level squared, NaN where unknown, same shape.
        place, table, noise: of the hypotheses; see :mod:`.hypotheses`.
        noise_share, forms: see :func:`.windows_kernel.lay_lanes`.
        chance: how likely each hypothesis is, shape (user, hypothesis).
        test: whether observed entries are estimated as well, on long bands those of some windows, from the others and
            without their own noise.
        found: left alone where nothing is estimated.
    """
    windows, kept = lay_windows(known, test), keep_likeliest(chance, known)
    total, length = windows.member.shape
    lane = np.zeros(total + 1, np.int64)
    for w in range(total):
        lane[w + 1] = lane[w] + kept.number[windows.user[w]]
    width = width_of(int(lane[total]))
    lanes, low, weight = empty_lanes(width), np.empty((packed(length, 0), width)), np.empty((length, width))
    estimates = Estimates(np.empty(width), np.empty(width), np.empty(width), np.empty(width))
    observed = Observed(
        np.zeros(width, np.int64), np.zeros((length, width), np.int64), np.zeros((length, width)),
        np.zeros((length, width)),
    )  # fmt: skip
    row, flat = place * table.shape[1], table.ravel()
    start = 0
    while start < total:
        stop, limit = start + 1, windows.tested if start < windows.tested else total
        while stop < limit and lane[stop + 1] - lane[start] <= width:
            stop += 1
        begin = lane[start : stop + 1] - lane[start]
        for w in range(start, stop):
            c, k = begin[w - start], windows.user[w]
            end = lay_lanes(lanes, c, k, kept, noise, noise_share, forms)
            load(gain, noise_variance, k, row, windows.member, w, lanes, c, end, observed)
        fill(flat, lanes, observed, low)
        factorise(low, length)
        estimate_missing(known, row, flat, windows, start, begin, low, lanes, observed, weight, estimates, found)
        if start < windows.tested:
            estimate_left_out(windows, start, begin, low, lanes, observed, weight, estimates, found)
        start = stop

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

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.evidence_kernel import JITTER
from wirelessagent.repairing.core.windows_kernel import Lanes, Windows

TOGETHER = 64
"""Lanes worked on together: as many as the cache holds."""
PHASES = 1.0 / 6.0
"""How much less the variance depends on the gain than that of a Rician power, for small c."""
LEAST = 1e-13
"""Least V."""


@kernel
def factorise_lanes(place: IntArray, table: FloatArray, lanes: Lanes, first: int, low: FloatArray) -> None:
    """Write the Cholesky factors of M into the lower half of ``low`` (n, n, lane), inverses on the diagonal.

    ``place`` (n, lane) is where the members are, −1 for none. ``first`` is the first lane.
    """
    size, count = place.shape
    for i in range(size):
        for j in range(i + 1):
            here = low[i, j]
            for c in range(count):
                at = first + c
                if place[i, c] >= 0:  # then the earlier one is there as well
                    here[c] = (
                        table[place[i, c] - place[j, c], lanes.hypothesis[at]] + lanes.shared[at] * lanes.grown[at] ** 2
                    )
                    here[c] += lanes.noise[at] + JITTER if i == j else 0.0
                else:
                    here[c] = 1.0 if i == j else 0.0
            for m in range(j):
                left, right = low[i, m], low[j, m]
                for c in range(count):
                    here[c] -= left[c] * right[c]
            if i == j:
                for c in range(count):
                    here[c] = 1.0 / np.sqrt(max(here[c], JITTER))
            else:
                scale = low[j, j]
                for c in range(count):
                    here[c] *= scale[c]


@kernel
def invert(low: FloatArray, inverse: FloatArray, total: FloatArray) -> None:
    """Write M⁻¹ (n, n, lane) for its factors, which are overwritten; ``total`` (lane,) is workspace."""
    size, count = low.shape[0], low.shape[2]
    for j in range(size):
        for i in range(j + 1, size):
            total[:] = 0.0
            for m in range(j, i):
                left, right = low[i, m], low[m, j]
                for c in range(count):
                    total[c] += left[c] * right[c]
            scale, here = low[i, i], low[i, j]
            for c in range(count):
                here[c] = -total[c] * scale[c]
    for i in range(size):
        for j in range(i + 1):
            here = inverse[i, j]
            here[:] = 0.0
            for m in range(i, size):
                left, right = low[m, i], low[m, j]
                for c in range(count):
                    here[c] += left[c] * right[c]
            if j < i:
                inverse[j, i] = here


@kernel
def write_targets(known: BoolArray, windows: Windows, target: IntArray) -> int:
    """Write the missing entries that each window serves, (window, most), −1 for none; returns the most of a window."""
    most = 0
    for w in range(windows.user.size):
        size = 0
        for n in range(windows.begin[w], windows.end[w]):
            if not known[windows.user[w], n]:
                target[w, size] = n
                size += 1
        target[w, size:] = -1
        most = max(most, size)
    return most


@kernel
def weigh_missing(
    low: FloatArray,
    where: IntArray,
    at: IntArray,
    table: FloatArray,
    lanes: Lanes,
    first: int,
    towards: FloatArray,
    weight: FloatArray,
    error: FloatArray,
) -> None:
    """Write w (n, lane) for the place ``at`` (lane,), −1 for none, and its expected squared error (lane,).

    ``low`` holds the factors, ``where`` (n, lane) is where the members are, ``towards`` (n, lane) workspace.
    """
    size, count = where.shape
    for c in range(count):
        lane = first + c
        h, grown = lanes.hypothesis[lane], lanes.grown[lane]
        s = lanes.shared[lane] * grown * grown
        error[c] = (table[0, h] + lanes.shared[lane]) * grown * grown
        for j in range(size):
            there = where[j, c] >= 0 and at[c] >= 0
            towards[j, c] = table[abs(where[j, c] - at[c]), h] * grown + s if there else 0.0
    for i in range(size):
        ours, scale = towards[i], low[i, i]
        for j in range(i):
            left, theirs = low[i, j], towards[j]
            for c in range(count):
                ours[c] -= left[c] * theirs[c]
        for c in range(count):
            ours[c] *= scale[c]
            error[c] -= ours[c] * ours[c]
    for i in range(size - 1, -1, -1):
        ours, k, scale = weight[i], towards[i], low[i, i]
        for c in range(count):
            ours[c] = k[c]
        for j in range(i + 1, size):
            left, theirs = low[j, i], weight[j]
            for c in range(count):
                ours[c] -= left[c] * theirs[c]
        for c in range(count):
            ours[c] *= scale[c]
    for c in range(count):
        error[c] /= lanes.grown[first + c] ** 2


@kernel
def weigh_left_out(
    inverse: FloatArray, i: int, lanes: Lanes, first: int, begin: int, end: int, weight: FloatArray, error: FloatArray
) -> None:
    """Write w (n, lane) of the others for member ``i`` of a window, and its expected squared error (lane,).

    The window's lanes are those from ``begin`` to ``end``, counted from lane ``first``.
    """
    for c in range(begin - first, end - first):
        scale = 1.0 / inverse[i, i, c]
        error[c] = (scale - lanes.noise[first + c]) / lanes.grown[first + c] ** 2
        for j in range(weight.shape[0]):
            weight[j, c] = -inverse[i, j, c] * scale
        weight[i, c] = 0.0


@kernel
def combine(
    gain: FloatArray,
    noise_variance: FloatArray,
    member: IntArray,
    lanes: Lanes,
    first: int,
    begin: int,
    end: int,
    weight: FloatArray,
    error: FloatArray,
    found: FloatArray,
) -> None:
    """Write mean, variance from fading and other variance to ``found`` (3,), from the lanes of a window.

    ``gain`` and ``noise_variance`` are its user's, NaN where the hypothesis says how large the noise is; ``weight``
    (n, lane) and ``error`` (lane,) those of the lanes from ``begin`` to ``end``, counted from lane ``first``.
    """
    mean, fading, other, total = 0.0, 0.0, 0.0, 0.0
    for lane in range(begin, end):
        c = lane - first
        level, noise, offset, chance = lanes.level[lane], lanes.noise[lane], lanes.offset[lane], lanes.probability[lane]
        estimate, own, known = offset, 0.0, 0.0
        for i in range(member.size):
            n = member[i]
            if n < 0:
                break
            w = weight[i, c]
            estimate += w * (gain[n] - offset)
            own += w * w
            known += w * w * (noise * level * gain[n] if np.isnan(noise_variance[n]) else noise_variance[n])
        left = max(error[c] - noise * own / lanes.grown[lane] ** 2, LEAST)
        share = 1.0 - np.sqrt(1.0 - min(left, 1.0))
        unknown = share * level
        estimate = max(estimate, unknown)
        about = estimate + PHASES * (1.0 - share) ** 4 * (level - estimate)
        total += chance
        before = estimate - mean
        mean += before * chance / total
        other += chance * (before * (estimate - mean) + known)
        fading += chance * (2.0 * about * unknown - unknown * unknown + max(left - 1.0, 0.0) * level * level)
    found[0], found[1], found[2] = mean, fading, other


@kernel
def krige(
    gain: FloatArray,
    known: BoolArray,
    noise_variance: FloatArray,
    place: IntArray,
    table: FloatArray,
    windows: Windows,
    lanes: Lanes,
    tested: int,
    found: FloatArray,
) -> None:
    """Write mean, variance from fading and other variance of each entry, shape (user, subcarrier, 3).

    Args:
        gain, known: in units of about each user's level, shape (user, subcarrier).
        noise_variance: of the measurements in units of the level squared, NaN where unknown, same shape.
        place, table: of the hypotheses; see :mod:`.hypotheses`.
        windows, lanes: see :mod:`.windows_kernel`.
        tested: of how many windows the observed entries are estimated as well, from the others and without their own
            noise.
        found: left alone where nothing is estimated.
    """
    total, length = windows.user.size, windows.member.shape[1]
    missing = np.empty((total, known.shape[1] + 1), np.int64)
    most = write_targets(known, windows, missing)
    start = 0
    while start < total:
        stop = start + 1
        while stop < total and windows.lane[stop + 1] - windows.lane[start] <= TOGETHER:
            stop += 1
        first = int(windows.lane[start])
        count = int(windows.lane[stop]) - first
        where = np.empty((length, count), np.int64)
        for c in range(count):
            for i in range(length):
                n = windows.member[lanes.window[first + c], i]
                where[i, c] = place[n] if n >= 0 else -1
        low = np.empty((length, length, count))
        towards, weight, error = np.empty((length, count)), np.empty((length, count)), np.empty(count)
        at = np.empty(count, np.int64)
        factorise_lanes(where, table, lanes, first, low)
        for t in range(most):
            some = False
            for c in range(count):
                n = missing[lanes.window[first + c], t]
                at[c] = place[n] if n >= 0 else -1
                some |= n >= 0
            if not some:
                break
            weigh_missing(low, where, at, table, lanes, first, towards, weight, error)
            for w in range(start, stop):
                n, k = missing[w, t], windows.user[w]
                if n >= 0:
                    combine(
                        gain[k], noise_variance[k], windows.member[w], lanes, first, windows.lane[w],
                        windows.lane[w + 1], weight, error, found[k, n],
                    )  # fmt: skip
        if start < tested:
            leave_out(gain, known, noise_variance, windows, lanes, start, min(stop, tested), low, weight, error, found)
        start = stop


@kernel
def leave_out(
    gain: FloatArray,
    known: BoolArray,
    noise_variance: FloatArray,
    windows: Windows,
    lanes: Lanes,
    start: int,
    stop: int,
    low: FloatArray,
    weight: FloatArray,
    error: FloatArray,
    found: FloatArray,
) -> None:
    """Estimate the observed entries that the windows from ``start`` to ``stop`` serve; ``low`` is used up."""
    first = int(windows.lane[start])
    inverse = np.empty(low.shape)
    invert(low, inverse, error)
    for w in range(start, stop):
        k, begin, end = windows.user[w], windows.lane[w], windows.lane[w + 1]
        for i in range(windows.member.shape[1]):
            n = windows.member[w, i]
            if n >= windows.begin[w] and n < windows.end[w]:
                weigh_left_out(inverse, i, lanes, first, begin, end, weight, error)
                combine(
                    gain[k], noise_variance[k], windows.member[w], lanes, first, begin, end, weight, error, found[k, n]
                )

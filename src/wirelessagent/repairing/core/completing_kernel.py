"""From relative estimates to the gains of a slot: variances tested on observed entries, and posteriors.

The squared errors of the observed entries in units of those expected have a mean that is a user's own, drawn towards
the users' common one where the user has shown little: by it the user's variances from fading are multiplied.

An entry that stands out from its neighbours stands out by its noise, most likely, and whoever looks for strong entries
finds those. So in the posterior a noisy measurement and what the others say of the entry, where that was worked out,
are weighed by their variances.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

PRIOR_ENTRIES = 8.0
"""Weight of the users' common factor of the variances in each user's, in observed entries."""
TAIL = 4.0
"""Entries taken off: the variance to be expected of a normal error is larger than its likeliest value by n/(n − 2), and
about half of the entries say something new."""
LARGEST_SURPRISE = 5.0
"""Deviations from the estimate, in standard deviations, beyond which an entry counts no more for the correlation."""
SMALLEST_VARIANCE = 2.2250738585072014e-308
"""That of the smallest normal number: no estimate is certain."""


@kernel
def test_variances(
    gain: FloatArray,
    known: BoolArray,
    noise: FloatArray,
    unstated: FloatArray,
    found: FloatArray,
    factor: FloatArray,
    surprise: FloatArray,
) -> None:
    """Write each user's factor (user,) and the surprises that say so, in standard deviations, (user, subcarrier).

    ``gain``, ``known`` and ``noise`` are those of :mod:`.relative_kernel`, ``unstated`` (user,) is of an entry whose
    noise is not known (:func:`.fit.unstated`), ``found`` is that of :mod:`.kriging_kernel`.
    Surprises are 0 where nothing was tested, and clipped.
    """
    users, subcarriers = gain.shape
    squares, count = np.zeros(users), np.zeros(users)
    for k in range(users):
        for n in range(subcarriers):
            surprise[k, n] = 0.0
            if known[k, n] and found[k, n, 0] > 0.0:
                own = unstated[k] if np.isnan(noise[k, n]) else noise[k, n]
                error = (gain[k, n] - found[k, n, 0]) / np.sqrt(found[k, n, 1] + found[k, n, 2] + own)
                surprise[k, n] = min(max(error, -LARGEST_SURPRISE), LARGEST_SURPRISE)
                squares[k] += error * error
                count[k] += 1.0
    pool = (squares.sum() + TAIL) / (count.sum() + TAIL)
    factor[:] = (squares + PRIOR_ENTRIES * pool) / (count + PRIOR_ENTRIES - TAIL)


@kernel
def complete(
    current: FloatArray,
    noise_variance: FloatArray,
    known: BoolArray,
    level: FloatArray,
    found: FloatArray,
    factor: FloatArray,
    unstated: FloatArray,
    unseen: FloatArray,
    told_least: int,
    seen: IntArray,
    gain: FloatArray,
    variance: FloatArray,
    mean: FloatArray,
    mean_variance: FloatArray,
    smoothed: BoolArray,
) -> None:
    """Write the last five, all (user, subcarrier).

    Args:
        current: measured gains, NaN where missing, (user, subcarrier).
        noise_variance: of the measurements, 0 where unknown, same shape.
        known, level, seen: see :mod:`.relative_kernel`.
        found: see :mod:`.kriging_kernel`.
        factor: of the variances from fading, (user,).
        unstated: variance of each entry's own, see :func:`.fit.unstated`, (user,).
        unseen: gain and variance of users without observation, and by what the variances of users with few are
            multiplied, (user, 3).
        told_least: observed entries from which on others tell of measured ones.
        gain, variance: of the estimate.
        mean, mean_variance: of the posterior.
        smoothed: known entries of which others tell.
    """
    users, subcarriers = current.shape
    for k in range(users):
        for n in range(subcarriers):
            estimate = level[k] * found[k, n, 0]
            others = level[k] * (level[k] * (factor[k] * found[k, n, 1] + found[k, n, 2] + unstated[k]))
            smoothed[k, n] = False
            if np.isnan(current[k, n]):
                gain[k, n] = estimate if seen[k] > 0 else unseen[k, 0]
                variance[k, n] = max(others * unseen[k, 2] if seen[k] > 0 else unseen[k, 1], SMALLEST_VARIANCE)
                mean[k, n], mean_variance[k, n] = gain[k, n], variance[k, n]
                continue
            gain[k, n], variance[k, n] = current[k, n], noise_variance[k, n]
            mean[k, n], mean_variance[k, n] = gain[k, n], variance[k, n]
            if variance[k, n] > 0.0 and others > 0.0 and seen[k] >= told_least:
                weight = variance[k, n] / (variance[k, n] + others)
                mean[k, n] += weight * (estimate - gain[k, n])
                mean_variance[k, n] *= 1.0 - weight
                smoothed[k, n] = known[k, n]

"""The paper's neighbour sweeps: each missing entry becomes the weighted average of its known four neighbours.

A sweep is linear in the known gains, so what it does to the users' levels and, with squared weights, to the variances
of independent entries is carried along: that is what the rule's error is expected to be made of.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

NEVER = -1


@kernel
def average_of_neighbours(
    layer: FloatArray,
    filled_in: IntArray,
    sweep: int,
    user: int,
    subcarrier: int,
    frequency_weight: float,
    user_weight: float,
) -> tuple[float, float]:
    """Weighted sum over the neighbours (k, n ± 1), (k ± 1, n) that were filled before ``sweep``, and their weight."""
    num_users, num_subcarriers = layer.shape
    total, weight = 0.0, 0.0
    for step in (-1, 1):
        n = subcarrier + step
        if 0 <= n < num_subcarriers and 0 <= filled_in[user, n] < sweep:
            total += frequency_weight * layer[user, n]
            weight += frequency_weight
    for step in (-1, 1):
        k = user + step
        if 0 <= k < num_users and 0 <= filled_in[k, subcarrier] < sweep:
            total += user_weight * layer[k, subcarrier]
            weight += user_weight
    return total, weight


@kernel
def sweep_until_full(
    gain: FloatArray, known: BoolArray, level: FloatArray, frequency_weight: float, user_weight: float
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Jacobi sweeps until nothing more can be filled; O(sweeps · users · subcarriers).

    ``gain`` and ``known`` have shape (user, subcarrier), ``level`` (user,). Returns four arrays of shape
    (user, subcarrier): the rule's value of every entry (of a known one, what its known neighbours say), the same
    average of the levels, the variance of the average if entries were independent with variance level², and whether
    the entry has a value at all.
    """
    num_users, num_subcarriers = gain.shape
    filled_in = np.where(known, 0, NEVER)
    source = np.where(known, gain, 0.0)
    levels, spread = np.empty(gain.shape), np.empty(gain.shape)
    for k in range(num_users):
        levels[k] = level[k]
        spread[k] = level[k] * level[k]
    value, mean, variance = np.zeros(gain.shape), np.zeros(gain.shape), np.zeros(gain.shape)
    reached = np.zeros(gain.shape, dtype=np.bool_)
    sweep, progress = 0, True
    while progress:
        sweep += 1
        progress = False
        for k in range(num_users):
            for n in range(num_subcarriers):
                if filled_in[k, n] > 0 or (filled_in[k, n] == 0 and sweep > 1):
                    continue
                total, weight = average_of_neighbours(source, filled_in, sweep, k, n, frequency_weight, user_weight)
                if weight <= 0.0:
                    continue
                value[k, n] = total / weight
                reached[k, n] = True
                total, _ = average_of_neighbours(levels, filled_in, sweep, k, n, frequency_weight, user_weight)
                mean[k, n] = total / weight
                total, _ = average_of_neighbours(
                    spread, filled_in, sweep, k, n, frequency_weight * frequency_weight, user_weight * user_weight
                )
                variance[k, n] = total / (weight * weight)
                if filled_in[k, n] == NEVER:
                    filled_in[k, n] = sweep
                    progress = True
        for k in range(num_users):
            for n in range(num_subcarriers):
                if filled_in[k, n] == sweep:
                    source[k, n], levels[k, n], spread[k, n] = value[k, n], mean[k, n], variance[k, n]
    return value, mean, variance, reached

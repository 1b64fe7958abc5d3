"""What correlated users show on a subcarrier beyond what their neighbours in frequency say."""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.repairing.core.frequency_kernel import distances, nearest_known, neighbour_weights, neighbours

INDEPENDENT_SHARE = 0.2
"""Independent comparisons per subcarrier that two users share: neighbouring surprises are not quite
independent, the less so the shorter the delay spread (measured: 0.2 at 30 ns, 0.9 at 1000 ns)."""


@kernel
def compare_users(surprise: FloatArray, known: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Correlation coefficient of each two users' surprises where both are known, and on how many subcarriers.

    Shapes (user, user); 0 where nothing can be compared and on the diagonal. A loop: a matrix product this small would
    wait longer for the threads of a busy machine than it computes.
    """
    users, subcarriers = surprise.shape
    seen, there = np.zeros((subcarriers, users)), np.zeros((subcarriers, users))
    for k in range(users):
        for n in range(subcarriers):
            if known[k, n]:
                seen[n, k], there[n, k] = surprise[k, n], 1.0
    product, power, count = np.zeros((users, users)), np.zeros((users, users)), np.zeros((users, users))
    for n in range(subcarriers):
        for j in range(users):
            if known[j, n]:
                own = seen[n, j]
                for k in range(users):
                    product[j, k] += own * seen[n, k]
                    power[j, k] += own * own * there[n, k]
                    count[j, k] += there[n, k]
    for j in range(users):
        for k in range(j + 1):
            scale = np.sqrt(power[j, k] * power[k, j])
            compared = scale > 0.0 and j != k
            product[j, k] = product[k, j] = product[j, k] / scale if compared else 0.0
            count[j, k] = count[k, j] = count[j, k] if compared else 0.0
    return product, count


@kernel
def correlation_beyond_chance(surprise: FloatArray, known: BoolArray) -> FloatArray:
    """See :func:`.users.correlation_beyond_chance`."""
    raw, count = compare_users(surprise, known)
    count *= INDEPENDENT_SHARE
    total, pairs, mean = 0.0, 0.0, 0.0
    for j in range(len(raw)):
        for k in range(j):
            total += 2.0 * count[j, k]
            mean += 2.0 * count[j, k] * raw[j, k]
            pairs += 1.0 if count[j, k] > 0.0 else 0.0
    if total == 0.0:
        return np.zeros_like(raw)
    mean, chance, scatter = mean / total, 2.0 / total, 0.0  # each pair is counted twice
    common = max(0.0, mean - 4.0 * chance / mean) if mean > 0.0 else 0.0
    for j in range(len(raw)):
        for k in range(j):
            scatter += 2.0 * count[j, k] * (raw[j, k] - mean) ** 2 / total
    beyond = max(0.0, scatter - 1.5 * pairs * chance)
    for j in range(len(raw)):
        for k in range(len(raw)):
            there = beyond * count[j, k]
            away = raw[j, k] - mean
            kept = max(there / (there + 1.0), 1.0 - 2.0 * np.log(pairs) / max(count[j, k] * away * away, 1.0))
            pair = min(max(common + kept * away, 0.0), 0.99) if count[j, k] > 0.0 else common
            raw[j, k] = pair if j != k else 0.0
    return raw


@kernel
def surprise_of_others(
    relative: FloatArray,
    predicted: FloatArray,
    known: BoolArray,
    position: FloatArray,
    coherence: FloatArray,
    correlation: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """The surprise to expect of every entry, and the share of its variance that the other users explain.

    User j's surprise on subcarrier n, for user k, is its gain less the average that k's own weights give of j's gains
    at the places of k's neighbours (predicted ones where j was not observed there): so both miss the same gap. Over
    the users j known at n,

        t_kn = Σ_j c_kj d_jn / (1 + Σ_j c_kj − c̄_kn),    explained share = Σ_j c_kj² / (1 + Σ_j c_kj − c̄_kn),

    with c̄ = Σ c²/Σ c: the best weights where all users are equally correlated. Shapes (user, subcarrier), but
    ``position`` (subcarrier,), ``coherence`` (user,) and ``correlation`` (user, user) with a diagonal of zeros.
    """
    num_users, num_subcarriers = relative.shape
    below, above = nearest_known(known)
    filled = np.where(known, relative, predicted)
    expected, explained = np.zeros(relative.shape), np.zeros(relative.shape)
    for k in range(num_users):
        for n in range(num_subcarriers):
            left, right = below[k, n], above[k, n]
            near_below, near_above = distances(position, n, left, right)
            w_left, w_right, _ = neighbour_weights(near_below, near_above, coherence[k])
            total, squares, surprise = 0.0, 0.0, 0.0
            for j in range(num_users):
                c = correlation[k, j]
                if c > 0.0 and known[j, n]:
                    at_left, at_right = neighbours(filled[j], left, right, 1.0)
                    surprise += c * (relative[j, n] - 1.0 - w_left * (at_left - 1.0) - w_right * (at_right - 1.0))
                    total += c
                    squares += c * c
            if total > 0.0:
                scale = 1.0 + total - squares / total
                expected[k, n] = surprise / scale
                explained[k, n] = squares / scale
    return expected, explained

"""What correlated users show on a subcarrier beyond what their neighbours in frequency say."""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.repairing.core.frequency_kernel import distances, nearest_known, neighbour_weights, neighbours


@kernel
def compare_users(surprise: FloatArray, known: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Correlation coefficient of each two users' surprises where both are known, and on how many subcarriers.

    Shapes (user, user); 0 where nothing can be compared and on the diagonal. A loop: a matrix product this small would
    wait longer for the threads of a busy machine than it computes.
    """
    num_users, num_subcarriers = surprise.shape
    coefficient, count = np.zeros((num_users, num_users)), np.zeros((num_users, num_users))
    for j in range(num_users):
        for k in range(j):
            product, power_j, power_k, common = 0.0, 0.0, 0.0, 0.0
            for n in range(num_subcarriers):
                if known[j, n] and known[k, n]:
                    product += surprise[j, n] * surprise[k, n]
                    power_j += surprise[j, n] * surprise[j, n]
                    power_k += surprise[k, n] * surprise[k, n]
                    common += 1.0
            scale = np.sqrt(power_j * power_k)
            if scale > 0.0:
                coefficient[j, k] = coefficient[k, j] = product / scale
                count[j, k] = count[k, j] = common
    return coefficient, count


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

"""What correlated users show on a subcarrier beyond what their neighbours in frequency say."""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.repairing.core.frequency_kernel import average, nearest_known, neighbour_weights


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
            w_left, w_right, _ = neighbour_weights(position, n, left, right, coherence[k])
            total, squares, surprise = 0.0, 0.0, 0.0
            for j in range(num_users):
                c = correlation[k, j]
                if c > 0.0 and known[j, n]:
                    surprise += c * (relative[j, n] - average(filled[j], 1.0, left, right, w_left, w_right))
                    total += c
                    squares += c * c
            if total > 0.0:
                scale = 1.0 + total - squares / total
                expected[k, n] = surprise / scale
                explained[k, n] = squares / scale
    return expected, explained

"""What the groups of subcarriers are worth at prices of the users' rates, exactly: the part of every bound that counts.

    Σ_g max(0, max_k t_kg),    t_kg = Σ over n in g of max over p in [0, u_kn] of λ_k ln(1 + p a_kn) − p,

with λ in W per nat. The search has the same sum in a form that is fast and loses digits where rates are tiny; bounds
are worked out here, where none are lost.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

SHALLOW = 1e-4


@kernel
def worth_of_groups(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, start: IntArray, price: FloatArray
) -> float:
    """The sum of the module's docstring in W.

    Args:
        snr_per_w: a, shape (user, subcarrier), in 1/W; 0 where a pair may not be used.
        cap_w: power cap of each subcarrier, shape (subcarrier,), infinite where there is none.
        max_snr: SNR beyond which the rate stays the same, infinite where there is none.
        start: first subcarrier of each group, shape (group + 1,).
        price: λ, shape (user,), in W per nat.
    """
    groups, users = start.size - 1, price.size
    best = np.zeros(groups)
    for k in range(users):
        if price[k] <= 0.0:
            continue
        for g in range(groups):
            worth = 0.0
            for n in range(start[g], start[g + 1]):
                snr = snr_per_w[k, n]
                reached = price[k] * snr
                if reached <= 1.0:
                    continue
                depth = reached - 1.0
                most = min(cap_w[n] * snr, max_snr)
                if depth >= most:
                    worth += price[k] * np.log1p(most) - most / snr
                elif depth < SHALLOW:
                    # (1 + d) ln(1 + d) − d without the difference
                    worth += depth * depth * (0.5 - depth * (1.0 / 6.0 - depth / 12.0)) / snr
                else:
                    worth += ((1.0 + depth) * np.log1p(depth) - depth) / snr
            best[g] = max(best[g], worth)
    return best.sum()

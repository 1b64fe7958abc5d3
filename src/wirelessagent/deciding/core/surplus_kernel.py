"""What the subcarriers are worth at a price of power, where all users' nats are worth the same.

If a nat is worth 1 and a watt costs μ, the subcarriers decouple and together are worth

    Φ(μ) = Σ_n max over p ≤ u_n of ln(1 + p max_k a_kn) − μ p,    p = min(max(1/μ − 1/a_n, 0), u_n).

No allocation of power P and rate R can have R − μ P above it. So Φ(μ) + μ P_max bounds the rate (P1), and P3 follows
from P1 and its own price; see :mod:`.bounds`.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray


@kernel
def surplus(snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, price: FloatArray) -> FloatArray:
    """Φ of the module's docstring for each problem, shape (batch,).

    Args:
        snr_per_w: a, shape (batch, user, subcarrier), in 1/W; 0 where a pair may not be used.
        cap_w: power cap of each subcarrier, shape (subcarrier,), infinite where there is none.
        max_snr: SNR beyond which the rate stays the same, infinite where there is none.
        price: μ ≥ 0, shape (batch,); where it is 0 every rate must be limited.

    >>> a = np.array([[[4.0, 1.0]]])
    >>> round(float(surplus(a, np.full(2, np.inf), np.inf, np.ones(1))[0]), 6)  # p = 3/4 and 0; ln 4 − 3/4
    0.636294
    """
    batch, users, subcarriers = snr_per_w.shape
    total, best = np.zeros(batch), np.empty(subcarriers)
    for b in range(batch):
        best[:] = snr_per_w[b, 0]
        for k in range(1, users):
            for n in range(subcarriers):
                best[n] = max(best[n], snr_per_w[b, k, n])
        for n in range(subcarriers):
            snr = min(cap_w[n] * best[n], max_snr) if best[n] > 0.0 else 0.0
            if price[b] > 0.0:
                snr = min(snr, (best[n] - price[b]) / price[b])  # exact near the cut-off, unlike a/μ − 1
            if snr > 0.0:
                total[b] += max(np.log1p(snr) - price[b] * (snr / best[n]), 0.0)
    return total

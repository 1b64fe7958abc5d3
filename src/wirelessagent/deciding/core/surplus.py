"""The oracle behind every bound: what the subcarriers are worth at given prices.

If a nat of user k is worth w_k and a watt costs μ, the subcarriers decouple and together are worth

    Φ(w, μ) = Σ_n max(0, max_k [w_k ln(1 + p a_kn) − μ p]),    p = min(max(w_k/μ − 1/a_kn, 0), u_kn).

No allocation of power P and rates r can have Σ w_k r_k − μ P above it. So Φ(1, μ) + μ P_max bounds the rate (P1),
λ·R − Φ(λ, 1) the power that carries the rates R (P2), and P3 follows from P1 and its own price; see :mod:`.bounds`.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray


def surplus(snr_per_w: FloatArray, cap_w: FloatArray, weight: FloatArray, price: float | FloatArray) -> FloatArray:
    """Φ(w, μ) of the module's docstring, shape (…).

    Args:
        snr_per_w: a, shape (…, user, subcarrier), in 1/W; 0 where a pair may not be used.
        cap_w: u, same shape, 0 where a is 0.
        weight: w, shape (…, user).
        price: μ ≥ 0, shape (…); where it is 0 every cap must be finite.

    >>> a = np.array([[4.0, 1.0]])
    >>> round(float(surplus(a, np.full((1, 2), np.inf), np.ones(1), 1.0)), 6)  # p = 3/4 and 0; ln 4 − 3/4
    0.636294
    """
    w, mu = weight[..., np.newaxis], np.asarray(price)[..., np.newaxis, np.newaxis]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        snr = np.maximum((w * snr_per_w - mu) / mu, 0.0)  # exact near the cut-off, unlike w a/μ − 1
        power = np.where(snr_per_w > 0, np.minimum(snr / snr_per_w, cap_w), 0.0)
    worth = w * np.log1p(power * snr_per_w) - mu * power
    return np.asarray(np.maximum(worth, 0.0).max(axis=-2).sum(axis=-1))

"""A rate that is worth itself, u(r) = r: what the objectives in bit/s and bit/J are made of."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray


def rate_conjugate(price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
    """max over r in [min_rate, max_rate] of r − price · r, and the rate that reaches it; elementwise, (…, user).

    A user whose price is below 1 takes all it may, any other only what it must.
    """
    rate = np.where(price < 1.0, max_rate, min_rate)
    with np.errstate(invalid="ignore"):
        return np.where(rate > 0, (1.0 - price) * rate, 0.0), rate

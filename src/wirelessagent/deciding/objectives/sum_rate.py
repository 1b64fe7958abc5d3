"""The sum rate as a utility, shared by the objectives that are made of it."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray


def sum_rate_conjugate(price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[float, FloatArray]:
    """max over r in [min_rate, max_rate] of Σ r − price · r, and the rates that reach it; all of shape (user,).

    A user whose price is below 1 takes all it may, any other only what it must.
    """
    rate = np.where(price < 1.0, max_rate, min_rate)
    with np.errstate(invalid="ignore"):
        surplus = np.where(rate > 0, (1.0 - price) * rate, 0.0)
    return float(surplus.sum()), rate

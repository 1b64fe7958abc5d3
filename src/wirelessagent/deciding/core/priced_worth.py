"""What a subcarrier is worth to each user at given prices of their rates: what they bid for it."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray


def priced_worth_w(form: NormalForm, snr_per_w: FloatArray, price: FloatArray) -> FloatArray:
    """t of each group of subcarriers to each user whose rate costs λ = ``price`` (user,) W per nat; (user, group), W.

    t_kg = Σ over n in g of max over p of λ_k ln(1 + p a_kn) − p, within the caps, for the SNRs per watt a
    (user, subcarrier); 0 where nothing can be used.
    """
    a = np.where(snr_per_w > 0, snr_per_w, 1.0)
    most = np.where(snr_per_w > 0, form.caps_w(snr_per_w), 0.0)
    power_w = np.clip(price[:, np.newaxis] - 1.0 / a, 0.0, most)
    worth = price[:, np.newaxis] * np.log1p(power_w * a) - power_w
    return np.add.reduceat(np.maximum(worth, 0.0), form.start[:-1], axis=1)

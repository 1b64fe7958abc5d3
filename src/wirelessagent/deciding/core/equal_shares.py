"""The same power on every subcarrier that somebody owns, for baselines that do not optimise it."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bounds import known_bound
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.promises import fixed_power_decision
from wirelessagent.model.arrays import IntArray
from wirelessagent.model.decision import Decision


def equal_shares(form: NormalForm, owner: IntArray, total_w: float) -> Decision:
    """The decision that splits ``total_w`` evenly over the owned subcarriers, each limited to its useful power.

    Subcarriers that their owner cannot use get nothing and lose their owner.
    """
    snr = np.where(owner >= 0, form.snr_per_w[np.maximum(owner, 0), np.arange(owner.size)], 0.0)
    used = snr > 0
    power_w = np.minimum(total_w / max(np.count_nonzero(used), 1), form.caps_w(snr))
    return fixed_power_decision(form, np.where(used, owner, -1), power_w, known_bound(form))

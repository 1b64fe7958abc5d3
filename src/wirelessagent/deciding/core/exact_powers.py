"""Powers to the last bit: the least that carry the rates found, and what rounding leaves short of a promise made up.

Searches measure rates by levels, which are logarithms and lose the digits of tiny rates. So whatever sets they find,
the powers are worked out anew from the rates on these sets. What is left is the rounding of sums: a rate may miss its
promise in the last digits, and a promise is kept or it is not.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.rate_proof import ceilings
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.metrics import RATE_TOLERANCE, kept
from wirelessagent.model.rates import user_rate_bps

BUDGET_ROUNDING = 1e-10
"""Share of the budget that a sum of powers may exceed it by: rounding."""
_TRIALS = 40
_STEP = 4e-16


def exact_powers(form: NormalForm, rows: FloatArray, owner: IntArray, power_w: FloatArray) -> FloatArray:
    """The least powers (subcarrier,) that carry the rates of ``power_w`` on the owners' sets, each within its row.

    They are infinite where a set cannot carry what its user must have.
    """
    from wirelessagent.deciding.core.least_power_kernel import keep_budget, least_power

    nats = user_rate_bps(form.estimate.gain, owner, power_w, form.cell) / form.bps_per_nat
    nats = np.clip(nats, rows[:, 0], rows[:, 1])
    exact = np.empty(power_w.size)
    spent_w = least_power(form.snr_per_w, ceilings(form, form.snr_per_w), nats, owner, exact, np.empty(nats.size))
    if np.isinf(spent_w):
        exact[:] = np.inf
    elif not form.promised_nats.any():
        keep_budget(form.budget_w, exact)
    return exact


def to_the_last_bit(form: NormalForm, gain: FloatArray, owner: IntArray, power_w: FloatArray) -> FloatArray:
    """The powers (…, subcarrier) with promises, budget and caps kept, where only rounding was in the way.

    ``gain`` is (…, user, subcarrier), ``owner`` (…, subcarrier). A promise that is short in the last digits gets more
    power on every subcarrier that may have more. What the sum of all powers then exceeds the budget by, users give who
    get more than they are promised.
    """
    holder, owned, power_w = np.maximum(owner, 0), owner >= 0, np.minimum(power_w, form.cap_w)
    if form.promised_bps.any():
        step = _STEP
        for _ in range(_TRIALS):
            rate = user_rate_bps(gain, owner, power_w, form.cell)
            short = (rate < form.promised_bps) & kept(rate, form.promised_bps)
            if not short.any():
                break
            raised = np.minimum(power_w * (1.0 + step), form.cap_w)
            power_w = np.where(owned & np.take_along_axis(short, holder, axis=-1), raised, power_w)
            step *= 2.0
    spent_w = power_w.sum(axis=-1, keepdims=True)
    over = (spent_w > form.budget_w) & (spent_w <= form.budget_w * (1.0 + RATE_TOLERANCE))
    if over.any():
        rate = user_rate_bps(gain, owner, power_w, form.cell)
        gives = np.take_along_axis(rate > form.promised_bps * (1.0 + RATE_TOLERANCE), holder, axis=-1)
        given_w = np.where(gives, power_w, 0.0).sum(axis=-1, keepdims=True)
        share = (spent_w * (1.0 + _STEP) - form.budget_w) / np.where(given_w > 0.0, given_w, np.inf)
        power_w = np.where(over & gives, power_w * (1.0 - share - _STEP), power_w)
    return power_w

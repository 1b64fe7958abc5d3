"""What an allocation will carry on the true channel, as far as observation tells, and the rates to commit to.

A user's true rate is X = Σ r(p_n g_n) over the entries that it owns, of which those uncertain are drawn jointly from
the estimate's posterior. A base station has to send at some rate R before it knows X; what arrives is R if X ≥ R,
else nothing. The rate to commit to is the one of which most is expected to arrive,

    R = argmax R · P(X ≥ R),

which is a little below the mean: for X normal of relative deviation s, some s √(2 ln(1/s)) below. A rate at the mean
itself arrives half the time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import RATE_TOLERANCE
from wirelessagent.model.rates import subcarrier_rate_bps
from wirelessagent.model.shown import Plain

_DRAWS = 4000
_BAND = (0.05, 0.95)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Forecast(Plain):
    """The true rates of an allocation by the posterior of the gains, and what to commit to.

    Attributes:
        mean_bps: each user's mean rate, shape (user,).
        low_bps, high_bps: its 5 % and 95 % quantiles, shape (user,).
        sum_low_bps, sum_high_bps: those of the sum rate.
        committed_bps: the rate that each user is sent at, shape (user,).
        carried: the probability that the true channel carries it, shape (user,); 1 for users who get nothing.
    """

    mean_bps: FloatArray
    low_bps: FloatArray
    high_bps: FloatArray
    sum_low_bps: float
    sum_high_bps: float
    committed_bps: FloatArray
    carried: FloatArray


def forecast(
    estimate: ChannelEstimate,
    owner: IntArray,
    power_w: FloatArray,
    cell: Cell,
    *,
    least_bps: FloatArray,
    most_bps: FloatArray,
    seed: int = 2,
) -> Forecast | None:
    """The forecast of an allocation; None where it rests on certain gains alone.

    Args:
        estimate: what is known of the channel.
        owner: shape (subcarrier,), −1 for nobody.
        power_w: shape (subcarrier,).
        cell: for its link.
        least_bps: the least that each user is committed to, shape (user,).
        most_bps: the most, shape (user,).
        seed: of the draws: others than a decision was made and judged on.
    """
    used = np.flatnonzero((owner >= 0) & (power_w > 0))
    if not (estimate.gain_variance[owner[used], used] > 0).any():
        return None
    users = estimate.num_users
    mean, low, high, committed = np.zeros(users), np.zeros(users), np.zeros(users), np.zeros(users)
    carried, total = np.ones(users), np.zeros(_DRAWS)
    for user in np.unique(owner[used]).tolist():
        rate = drawn_rates(estimate, user, used[owner[used] == user], power_w, cell, seed)
        total += rate
        rate.sort()
        mean[user] = rate.mean()
        low[user], high[user] = np.quantile(rate, _BAND)
        committed[user], carried[user] = _commitment(rate, float(least_bps[user]), float(most_bps[user]))
    sum_low, sum_high = np.quantile(total, _BAND).tolist()
    return Forecast(
        mean_bps=mean,
        low_bps=low,
        high_bps=high,
        sum_low_bps=sum_low,
        sum_high_bps=sum_high,
        committed_bps=committed,
        carried=carried,
    )


def drawn_rates(
    estimate: ChannelEstimate, user: int, own: IntArray, power_w: FloatArray, cell: Cell, seed: int
) -> FloatArray:
    """Draws of a user's true rate on the subcarriers ``own`` (entry,) with ``power_w`` (subcarrier,), shape (draw,)."""
    uncertain = estimate.gain_variance[user, own] > 0
    known, unknown = own[~uncertain], own[uncertain]
    rate = np.full(_DRAWS, subcarrier_rate_bps(estimate.gain[user, known], power_w[known], cell).sum())
    if unknown.size:
        gain = estimate.posterior.samples_of(user, unknown, _DRAWS, seed=seed)
        rate += subcarrier_rate_bps(gain, power_w[unknown], cell).sum(axis=1)
    return rate


def _commitment(rate: FloatArray, least: float, most: float) -> tuple[float, float]:
    """The R of most R · P(X ≥ R) from ``least`` to ``most``, and its P, from sorted draws (draw,) of X."""
    tried = np.clip(rate, least, most)
    carried = 1.0 - np.searchsorted(rate, tried * (1.0 - RATE_TOLERANCE)) / rate.size
    best = int(np.argmax(tried * carried))
    return float(tried[best]), float(carried[best])

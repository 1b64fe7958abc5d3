"""What was missing, what was made of it, and how sure the decision is of what it rests on."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.telling.facts.case import Case

_LEAST, _MOST = 0.05, 0.95


@dataclass(frozen=True, kw_only=True)
class Certainty:
    """How sure a decision is.

    Attributes:
        repaired, entries: gains that were not measured, and all.
        noisy: gains that were measured, but not exactly.
        method: what repaired them.
        used, resting: subcarriers in use, and those of them that rest on a gain that was not measured.
        unseen: users of whom nothing was measured.
        low_bps, high_bps: the 90 % band of the sum rate; NaN where nothing in use is uncertain.
        least_sure: the user whose committed rate is kept with the smallest probability; None likewise.
        least_kept: that probability.
        expected_missed: how many commitments are expected to fail.
        widest: the user and the subcarrier in use whose gain is known least; None likewise.
        widest_low_db, widest_high_db: its 90 % band around what was counted on, in dB.
    """

    repaired: int
    entries: int
    noisy: int
    method: str
    used: int
    resting: int
    unseen: tuple[int, ...]
    low_bps: float = np.nan
    high_bps: float = np.nan
    least_sure: int | None = None
    least_kept: float = np.nan
    expected_missed: float = 0.0
    widest: tuple[int, int] | None = None
    widest_low_db: float = 0.0
    widest_high_db: float = 0.0


def certainty(case: Case) -> Certainty:
    """What is known of the channel that a decision rests on."""
    decision, estimate = case.decision, case.estimate
    used = np.flatnonzero((decision.owner >= 0) & (decision.power_w > 0))
    owner = decision.owner[used]
    known = Certainty(
        repaired=int(estimate.repaired.sum()),
        entries=estimate.repaired.size,
        noisy=int(((estimate.gain_variance > 0) & ~estimate.repaired).sum()),
        method=estimate.method,
        used=used.size,
        resting=int(estimate.repaired[owner, used].sum()),
        unseen=tuple(int(user) for user in np.flatnonzero(estimate.unobserved_users & case.served)),
    )
    forecast = decision.forecast
    if forecast is None:
        return known
    served = np.flatnonzero(decision.committed_bps > 0)
    carried = 1.0 - decision.outage if decision.outage.size else forecast.carried
    unsure = np.flatnonzero(estimate.gain_variance[owner, used] > 0)
    low, high = (estimate.posterior.quantile(one)[owner, used] for one in (_LEAST, _MOST))
    with np.errstate(divide="ignore", invalid="ignore"):
        counted = case.counted.gain[owner, used]
        low_db, high_db = 10 * np.log10(low / counted), 10 * np.log10(high / counted)
    widest = int(unsure[np.argmax((high_db - low_db)[unsure])])
    least = int(served[np.argmin(carried[served])])
    return dataclasses.replace(
        known,
        low_bps=forecast.sum_low_bps,
        high_bps=forecast.sum_high_bps,
        least_sure=least,
        least_kept=float(carried[least]),
        expected_missed=float((1.0 - carried[served]).sum()),
        widest=(int(owner[widest]), int(used[widest])),
        widest_low_db=float(low_db[widest]),
        widest_high_db=float(high_db[widest]),
    )

"""Marginal prices: how the best value changes per watt more, and per bit/s more promised to each user.

They are the slopes of the dual bound. A decision of a method that knows no prices is given those of the dual for the
same problem: they speak of the problem, not of the allocation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent import chain
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.telling.facts.case import Case


@dataclass(frozen=True, kw_only=True, eq=False)
class MarginalPrices:
    """Slopes of the bound.

    Attributes:
        power: change of the best value per watt more, in the value's unit per W; NaN if not known.
        rate: change per bit/s more promised to each user, shape (user,), NaN if not known. Positive where what is to be
            small grows, negative where what is to be large shrinks, 0 for a promise that does not bind.
        binds: whether the whole budget is used.
    """

    power: float
    rate: FloatArray
    binds: bool


def marginal_prices(case: Case) -> MarginalPrices:
    """The prices of a case's problem on the channel that counts."""
    decision = case.decision
    power, rate = decision.price_of_power, decision.price_of_rate
    if np.isnan(power) or (not rate.size and case.promised_bps.any()):
        priced = _priced(case)
        power = priced.price_of_power if np.isnan(power) else power
        rate = rate if rate.size else priced.price_of_rate
    if not rate.size:
        rate = np.full(case.num_users, np.nan if case.promised_bps.any() else 0.0)
    return MarginalPrices(power=power, rate=rate, binds=case.spends_all)


def _priced(case: Case) -> Decision:
    """The decision of the dual with nothing searched, for its prices."""
    return chain.decide(case.counted, case.plain, case.cell, "dual", restarts=0)

"""Marginal prices: how the best value changes per watt more, and per bit/s more promised to each user.

They are the slopes of the dual bound. A decision of a method that knows no prices is given those of the dual for the
same problem: they speak of the problem, not of the allocation.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent import chain
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.telling.facts.case import Case

FIRST_BPS = 1e3
"""A promise so low that its price is that of the first bits."""


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


def prices_of_promises(case: Case, users: IntArray) -> FloatArray:
    """:attr:`MarginalPrices.rate` of ``users`` (number,), shape (number,).

    For users who get nothing and are promised nothing it is the price of their first bits, together: that of a promise
    so low that it changes nothing else.
    """
    first = users[(case.promised_bps[users] <= 0) & (case.decision.rate_bps[users] <= 0)]
    rate = marginal_prices(case).rate
    if first.size:
        promised = case.promised_bps.copy()
        promised[first] = FIRST_BPS
        priced = _priced(case, min_rate_bps=promised).price_of_rate
        rate = rate.copy()
        rate[first] = priced[first] if priced.size else np.nan
    return rate[users]


def _priced(case: Case, **changes: Any) -> Decision:
    """The decision of the dual with nothing searched, for its prices."""
    return chain.decide(case.counted, dataclasses.replace(case.plain, **changes), case.cell, "dual", restarts=0)

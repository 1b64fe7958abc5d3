"""Marginal prices: how the best value changes per watt more, and per bit/s more promised to each user; and the bids.

The prices are the slopes of the dual bound. A decision of a method that knows no prices is given those of the dual for
the same problem: they speak of the problem, not of the allocation.

At the price λ_k of a user's rate, in W per nat, a group of subcarriers is worth to it

    t_kg = Σ over n in g of max over p of λ_k ln(1 + p a_kn) − p

watts: what the rate it carries is worth, less the power it takes. The dual gives each group to the highest bid. A loser
is behind by the factor on its gains at which its bid would have been as high; with equal prices, one subcarrier and no
caps that is the ratio of the gains.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.priced_worth import priced_worth_w
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.telling.facts.case import Case

_HALVINGS = 60
_FARTHEST_DB = 120.0
_DEAREST = 1e130


@dataclass(frozen=True, kw_only=True, eq=False)
class MarginalPrices:
    """Slopes of the bound.

    Attributes:
        power: change of the best value per watt more, in the value's unit per W; NaN if not known.
        rate: change per bit/s more promised to each user, shape (user,), NaN if not known. Positive where what is to be
            small grows, negative where what is to be large shrinks, 0 for a promise that does not bind.
    """

    power: float
    rate: FloatArray


def marginal_prices(case: Case) -> MarginalPrices:
    """The prices of a case's problem on the channel that counts."""
    decision = case.decision
    power, rate = decision.price_of_power, decision.price_of_rate
    if np.isnan(power) or (not rate.size and case.promised_bps.any()):
        power = case.priced.price_of_power if np.isnan(power) else power
        rate = rate if rate.size else case.priced.price_of_rate
    if not rate.size:
        rate = np.full(case.num_users, np.nan if case.promised_bps.any() else 0.0)
    return MarginalPrices(power=power, rate=rate)


@dataclass(frozen=True, kw_only=True, eq=False)
class Bids:
    """Bids of all users for all groups of subcarriers.

    Attributes:
        price: λ of each user's rate, shape (user,), in W per nat.
        bid_w: t, shape (user, group), in W; 0 where a user can use nothing of it.
        owner: of each group, shape (group,), −1 for nobody.
        start: first subcarrier of each group, and the number of subcarriers, shape (group + 1,).
        behind_db: by how much a user's gains on the group are too low for the owner's bid, shape (user, group), in dB;
            0 for the owner, below 0 where a loser bids more, inf where no gain would do.
    """

    price: FloatArray
    bid_w: FloatArray
    owner: IntArray
    start: IntArray
    behind_db: FloatArray


def bids(case: Case) -> Bids:
    """The bids for a usable decision, at its own prices or, where its method has none, at the dual's."""
    form, price = case.form, _prices_of_rates(case)
    worth = priced_worth_w(form, form.snr_per_w, price)
    owner = np.maximum.reduceat(np.where(case.decision.power_w > 0, case.decision.owner, -1), form.start[:-1])
    held = np.flatnonzero(owner >= 0)
    wanted = np.zeros(owner.size)
    wanted[held] = worth[owner[held], held]
    behind = _behind_db(form, price, wanted)
    behind[owner[held], held] = 0.0
    return Bids(price=price, bid_w=worth, owner=owner, start=form.start, behind_db=behind)


def _prices_of_rates(case: Case) -> FloatArray:
    """λ of each user's rate, shape (user,), in W per nat: of the decision, a closed form, or the dual."""
    found = case.decision.prices
    if found is None and nats_worth(case.form) is None:
        found = case.priced.prices
    if found is not None:
        return np.minimum(np.exp(np.minimum(found.log_rate, 300.0)), _DEAREST)
    # one water level for all whose rate counts: the height of the water on the subcarriers that are not full
    a = case.form.snr_per_w[case.decision.owner[case.used], case.used]
    level = float((case.decision.power_w[case.used[a > 0]] + 1.0 / a[a > 0]).max(initial=0.0))
    return np.where(case.form.weight > 0, level, 0.0)


def _behind_db(form: NormalForm, price: FloatArray, wanted: FloatArray) -> FloatArray:
    """The factor in dB on each user's gains in each group at which its bid is ``wanted`` (group,); (user, group)."""
    low = np.full((price.size, wanted.size), -_FARTHEST_DB)
    high = -low
    sizes = np.diff(form.start)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        factor = np.repeat(10.0 ** (middle / 10.0), sizes, axis=1)
        enough = priced_worth_w(form, form.snr_per_w * factor, price) >= wanted
        low, high = np.where(enough, low, middle), np.where(enough, middle, high)
    return np.where((high >= _FARTHEST_DB) | (wanted <= 0), np.inf, high)

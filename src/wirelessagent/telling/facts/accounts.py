"""One user's account: what it gets, where it lost by which bids, and what a promise to it would cost.

At the price λ_k of a user's rate, in W per nat, a group of subcarriers is worth to it

    t_kg = Σ over n in g of max over p of λ_k ln(1 + p a_kn) − p

watts: what the rate it carries is worth, less the power it takes. The dual gives each group to the highest bid. A loser
is behind by the factor on its gains at which its bid would have been as high; with equal prices, one subcarrier and no
caps that is the ratio of the gains.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.priced_worth import priced_worth_w
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import db
from wirelessagent.telling.facts.case import BAND, Case, in_use
from wirelessagent.telling.facts.steps import Step, marginal_prices, promise_step

Standing: TypeAlias = Literal[
    "served", "left_out", "nothing_decided", "no_gain", "no_weight", "no_promise", "no_room", "outbid"
]
"""Why a user has what it has: it is served; it is not to be; nothing was decided at all; no subcarrier reaches it; its
rate counts for nothing; the power is to be least and it is promised nothing; there are too few subcarriers; or others
bid more everywhere."""

PROMISE_BPS = 100e3
"""The minimum rate that is tried for a user without any."""
_LOSSES = 3
_DRAWS, _SEED = 4000, 5
_HALVINGS, _FARTHEST_DB, _DEAREST = 60, 120.0, 1e130


@dataclass(frozen=True, kw_only=True)
class Loss:
    """A group of subcarriers that a user did not get.

    Attributes:
        first, last: its subcarriers, from 0.
        winner: who got it.
        behind_db: the factor by which the user's gains there are too low; below 0 where it bids more.
        repaired: whether any of the user's gains there was not measured.
        low_db, high_db: the 90 % band of the user's gain there around the one that counts, in dB; 0 for certain gains.
        chance: the probability that the true gains there are high enough to win; NaN where nothing is uncertain.
    """

    first: int
    last: int
    winner: int
    behind_db: float
    repaired: bool
    low_db: float
    high_db: float
    chance: float


@dataclass(frozen=True, kw_only=True)
class Account:
    """What a user has, and why.

    Attributes:
        user: number, from 0.
        standing: see :data:`Standing`.
        rate_bps, power_w: what it gets.
        subcarriers: how many carry its power.
        resting: how many of them rest on a gain that was not measured.
        promised_bps: what it must get; 0 for no promise.
        price_per_bps: what one bit/s more promised to it costs at the margin, where it is served and promised a rate.
        repaired, entries: gains of its own that were not measured, and all.
        losses: groups that it came closest to winning, the closest first.
        promise: what a small minimum rate would give it and cost; None where it has something.
        included: the decision if it were served too; None where it is, or is not left out.
    """

    user: int
    standing: Standing
    rate_bps: float = 0.0
    power_w: float = 0.0
    subcarriers: int = 0
    resting: int = 0
    promised_bps: float = 0.0
    price_per_bps: float = 0.0
    repaired: int = 0
    entries: int = 0
    losses: tuple[Loss, ...] = ()
    promise: Step | None = None
    included: Decision | None = None


def account(case: Case, user: int) -> Account:
    """The account of a user, from 0."""
    plain = share(case, user)
    standing = plain.standing
    also = case.named([*np.flatnonzero(case.served).tolist(), user])
    return dataclasses.replace(
        plain,
        losses=_losses(case, bids(case), user) if standing in ("served", "outbid", "no_weight") else (),
        included=case.solved(case.but(users=also)) if standing == "left_out" else None,
        promise=promise_step(case, user, PROMISE_BPS) if standing in ("outbid", "no_weight", "no_promise") else None,
    )


def share(case: Case, user: int) -> Account:
    """The account of a user, from 0, without where it lost."""
    decision, estimate = case.decision, case.estimate
    own = case.own(user)
    standing, promised = _standing(case, user, bool(own.any())), float(case.promised_bps[user])
    priced = standing == "served" and promised > 0
    return Account(
        user=user, standing=standing, rate_bps=float(case.rate_bps[user]), power_w=float(decision.power_w[own].sum()),
        price_per_bps=abs(float(marginal_prices(case).rate[user])) if priced else 0.0, promised_bps=promised,
        subcarriers=int(own.sum()), resting=int((own & estimate.repaired[user]).sum()),
        repaired=int(estimate.repaired[user].sum()), entries=estimate.num_subcarriers,
    )  # fmt: skip


def newcomer(case: Case) -> Account | None:
    """The account of the user with whom the value is best of those who are left out; None where nobody is."""
    accounts = [account(case, user) for user in np.flatnonzero(~case.served).tolist()]
    met = {one.included.value: one for one in reversed(accounts) if one.included is not None and one.included.is_usable}
    if not met:
        return accounts[0] if accounts else None
    return met[min(met) if case.falls else max(met)]


def _standing(case: Case, user: int, has_power: bool) -> Standing:
    if not case.served[user]:
        return "left_out"
    if not case.decision.is_usable:
        return "nothing_decided"
    if has_power:
        return "served"
    if not (case.form.snr_per_w[user] > 0).any():
        return "no_gain"
    if case.objective.measure == "power":
        return "no_promise"
    if case.form.weight[user] <= 0:
        return "no_weight"
    counts = int(np.count_nonzero(case.form.weight > 0))
    if case.form.start.size - 1 < counts and case.decision.value == 0:
        return "no_room"
    return "outbid"


def _losses(case: Case, found: Bids, user: int) -> tuple[Loss, ...]:
    behind = np.where((found.owner == user) | (found.owner < 0), np.inf, found.behind_db[user])
    distance = np.abs(behind) if (found.owner == user).any() else behind
    nearest = [int(group) for group in np.argsort(distance, kind="stable")[:_LOSSES] if np.isfinite(behind[group])]
    losses = list[Loss]()
    for group in nearest:
        inside = np.arange(int(found.start[group]), int(found.start[group + 1]))
        low_db, high_db, chance = _spread(case, user, inside, float(behind[group]))
        losses.append(Loss(
            first=int(inside[0]), last=int(inside[-1]), winner=int(found.owner[group]), behind_db=float(behind[group]),
            repaired=bool(case.estimate.repaired[user, inside].any()), low_db=low_db, high_db=high_db, chance=chance,
        ))  # fmt: skip
    return tuple(losses)


def _spread(case: Case, user: int, inside: IntArray, behind_db: float) -> tuple[float, float, float]:
    """The band of a user's true gain on a group around the one that counts, in dB, and the chance that it wins."""
    if not (case.estimate.gain_variance[user, inside] > 0).any():
        return 0.0, 0.0, np.nan
    counted = float(case.counted.gain[user, inside].sum())
    if counted <= 0:
        return -np.inf, np.inf, np.nan
    samples = case.estimate.posterior.samples_of(user, inside, _DRAWS, seed=_SEED)
    drawn: FloatArray = np.asarray(samples.sum(axis=1) / counted, dtype=np.float64)
    low, high = (float(one) for one in np.quantile(drawn, BAND))
    return float(db(low)), float(db(high)), float(np.mean(drawn >= 10 ** (behind_db / 10)))


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
    owner = np.maximum.reduceat(in_use(case.decision), form.start[:-1])
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

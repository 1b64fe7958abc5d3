"""What can be proven of promised rates before any allocation is known: the power they need, and what no power carries.

The dual of P2 (:mod:`.rate_prices_kernel`) gives prices λ; the figures here are then worked out afresh from them with
:func:`.surplus.surplus`, so that they hold whatever the search did:

    P ≥ λ·R − Φ(λ, 1)                for any allocation that carries the rates R,
    s ≤ (P_max + Φ(λ, 1))/(λ·R)      for any factor s such that s R is carried within the budget.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.surplus import surplus
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.units import human

_ROUNDS = 4
_SETTLED = 1e-2
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class RateProof:
    """What the dual of P2 proves.

    Attributes:
        needed_w: the promised rates need at least this power; 0 where none are promised.
        max_scaling: no larger common factor on the rates fits the budget.
        price: λ, shape (user,), W per nat; 0 for users without a promise.
        iterations: Newton steps done.
    """

    needed_w: float
    max_scaling: float
    price: FloatArray
    iterations: int


def prove(form: NormalForm) -> RateProof:
    """Bounds on the power and the scaling of the promised rates."""
    users = np.flatnonzero(form.promised_nats > 0)
    price = np.zeros(form.promised_nats.shape)
    if users.size == 0:
        return RateProof(needed_w=0.0, max_scaling=np.inf, price=price, iterations=0)
    snr, nats = form.snr_per_w[users], form.promised_nats[users]
    cap = form.caps_w(snr)
    found, iterations = _climb(form, snr, nats)
    price[users] = found
    worth = surplus(snr, cap, found, 1.0)
    needed = max(float(found @ nats) - worth, 0.0)
    scaling = (form.budget_w + worth) / float(found @ nats)
    for _ in range(_ROUNDS):  # the prices at the scaled rates give a tighter factor, until it settles
        found, steps = _climb(form, snr, scaling * nats)
        iterations += steps
        tighter = (form.budget_w + surplus(snr, cap, found, 1.0)) / float(found @ nats)
        settled = tighter > scaling * (1.0 - _SETTLED)
        scaling = min(scaling, tighter)
        if settled:
            break
    return RateProof(needed_w=needed, max_scaling=scaling, price=price, iterations=iterations)


def ceilings(form: NormalForm, snr_per_w: FloatArray) -> FloatArray:
    """The most nats on each (user, subcarrier), whatever the budget; 0 where a pair may not be used."""
    with np.errstate(invalid="ignore"):
        reached = np.log1p(form.cap_w * snr_per_w)
    return np.where(snr_per_w > 0, np.minimum(reached, form.max_nats), 0.0)


def log_snr(snr_per_w: FloatArray) -> FloatArray:
    """ln a, −inf where a is 0."""
    with np.errstate(divide="ignore"):
        return np.log(snr_per_w)


def one_each(usable: BoolArray) -> IntArray:
    """A subcarrier of its own for as many users as possible, shape (user,), −1 for those left without.

    ``usable`` has the shape (user, subcarrier). Maximum bipartite matching, by Hopcroft and Karp (1973).
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import maximum_bipartite_matching

    return np.asarray(maximum_bipartite_matching(csr_array(usable), perm_type="column"), dtype=np.int64)


def shortage(form: NormalForm) -> tuple[str, float]:
    """Why no power at all can carry the promised rates, and the largest factor on them that some power might.

    The reason is empty where nothing of the kind is known; the factor is then infinite.
    """
    users = np.flatnonzero(form.promised_nats > 0)
    snr, nats = form.snr_per_w[users], form.promised_nats[users]
    served = int(np.count_nonzero(one_each(snr > 0) >= 0)) if users.size else 0
    if served < users.size:
        count = int(np.count_nonzero(snr.max(axis=0) > 0))
        return (
            f"{users.size} users are promised a rate, but with {count} usable subcarriers "
            f"only {served} of them can have one of their own"
        ), 0.0
    if users.size == 0:
        return "", np.inf
    most = ceilings(form, snr)
    carried = most.sum(axis=1) / nats
    worst = int(carried.argmin())
    if carried[worst] < 1.0 - _ROUNDING:
        name = form.estimate.user_names[int(users[worst])]
        promised = human(float(nats[worst]) * form.bps_per_nat, "bit/s")
        best = human(float(most[worst].sum()) * form.bps_per_nat, "bit/s")
        return f"{name} is promised {promised}, but its subcarriers carry at most {best} at any power", float(
            carried[worst]
        )
    needed = int(np.ceil(nats / most.max(axis=1) * (1.0 - _ROUNDING)).sum())
    usable = int(np.count_nonzero(snr.max(axis=0) > 0))
    if needed > usable:
        return f"the promised rates take at least {needed} subcarriers at any power, but {usable} can be used", np.inf
    return "", np.inf


def _climb(form: NormalForm, snr: FloatArray, nats: FloatArray) -> tuple[FloatArray, int]:
    """Prices λ (user,) near the dual's maximum for ``nats``, all positive, and the Newton steps done."""
    from wirelessagent.deciding.core.exclusive_sets_kernel import grow_sets, least_power
    from wirelessagent.deciding.core.rate_prices_kernel import climb_prices

    log, ceiling = log_snr(snr), ceilings(form, snr)
    subcarriers = form.estimate.num_subcarriers
    owner = np.full(subcarriers, -1, dtype=np.int64)
    price = np.empty(nats.size)
    grow_sets(snr, log, ceiling, nats, owner)
    least_power(snr, ceiling, nats, owner, np.empty(subcarriers), price)
    share = nats * nats.size / subcarriers - np.max(log, axis=1)  # as if all had equally many subcarriers
    start = np.where(np.isfinite(price), price, np.where(np.isfinite(share), share, 0.0))
    with np.errstate(divide="ignore", over="ignore"):
        inverse = np.where(snr > 0, 1.0 / snr, 0.0)
    _, steps = climb_prices(
        np.ascontiguousarray(log.T),
        np.ascontiguousarray(inverse.T),
        np.ascontiguousarray(ceiling.T),
        np.ascontiguousarray(form.caps_w(snr).T),
        nats,
        start,
    )
    return np.exp(start), steps

"""What can be proven of promised rates before any allocation is known: the power they need, and what no power carries.

The dual of P2 (:mod:`.prices_kernel`) gives prices λ; the figures here are then worked out afresh from them with
:mod:`.terms_kernel`, so that they hold whatever the search did:

    P ≥ λ·R − Φ(λ, 1)                for any allocation that carries the rates R,
    s ≤ (P_max + Φ(λ, 1))/(λ·R)      for any factor s such that s R is carried within the budget.

For rates far beyond the budget the prices of the users lie many orders of magnitude apart and the search is of no use.
So no figure is worse than that of :mod:`.rate_relaxations`, and every λ found on the way is asked for both figures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, promises
from wirelessagent.deciding.core.rate_relaxations import Relaxations, largest_scaling, relaxations
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.units import human

_ROUNDS = 4
_SETTLED = 1e-2
_ROUNDING = 1e-9
_STEP = 4e-16
"""Share of its terms, for each of them, that a sum may be off by."""
_HIGHEST_LOG_PRICE = 500.0
"""That of the search. A lower price than the best proves less, but nothing wrong."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RateProof:
    """What the dual of P2 and its relaxations prove.

    Attributes:
        needed_w: the promised rates need at least this power; 0 where none are promised.
        max_scaling: no larger common factor on the rates fits the budget.
        price: λ that proves ``needed_w``, shape (user,), W per nat; 0 for users without a promise.
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
    relaxed = relaxations(snr, log_snr(snr), ceilings(form, snr), nats)
    strongest = int(relaxed.needed_w.argmax())
    needed = float(relaxed.needed_w[strongest])
    best = _prices_of(relaxed)[strongest]
    first = np.minimum(-log_snr(snr.max(axis=1)), _HIGHEST_LOG_PRICE)  # as if all nats cost as little as the first
    power, _ = _judge(form, snr, nats, first)
    if power > needed:
        needed, best = power, first
    scaling = min(largest_scaling(form, snr, nats), 1e300)
    iterations, factor = 0, 1.0
    for _ in range(1 + _ROUNDS):  # at the promised rates; then at those scaled to the budget, until that settles
        if form.limit.is_over():
            break
        found, steps = _climb(form, snr, factor * nats)
        iterations += steps
        power, tighter = _judge(form, snr, nats, found)
        if power > needed:
            needed, best = power, found
        settled = factor != 1.0 and tighter > scaling * (1.0 - _SETTLED)
        scaling = min(scaling, tighter)
        if settled or scaling <= 0.0:
            break
        factor = scaling
    price[users] = np.exp(best)
    return RateProof(needed_w=needed, max_scaling=scaling, price=price, iterations=iterations)


def _judge(form: NormalForm, snr: FloatArray, nats: FloatArray, log_price: FloatArray) -> tuple[float, float]:
    """The least power and the largest scaling that prices λ prove for ``nats``; see the module's docstring."""
    from wirelessagent.deciding.core.terms_kernel import worth_of_groups

    price = np.exp(log_price)  # of a few hundred at most, so that no product overflows
    worth_w = float(worth_of_groups(snr, form.cap_w, form.max_snr, form.start, price))
    paid_w = float(price @ nats)
    rounding_w = _STEP * (nats.size + form.cap_w.size) * (paid_w + worth_w)
    return max(paid_w - worth_w - rounding_w, 0.0), (form.budget_w + worth_w + rounding_w) / paid_w


def _prices_of(relaxed: Relaxations) -> FloatArray:
    """ln λ of each relaxation as prices of all users, shape (1 + user, user)."""
    own = np.minimum(relaxed.log_price, _HIGHEST_LOG_PRICE)
    users = own.size - 1
    alone = np.where(np.eye(users, dtype=bool), own[1:], -np.inf)
    return np.vstack([np.full(users, own[0]), alone])


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
    served = int(np.count_nonzero(one_each(usable_groups(form)[users]) >= 0)) if users.size else 0
    if served < users.size:
        return _too_few(form, users, served), 0.0
    if users.size == 0:
        return "", np.inf
    most = np.add.reduceat(ceilings(form, snr), form.start[:-1], axis=1)  # of each group
    carried = most.sum(axis=1) / nats
    worst = int(carried.argmin())
    if carried[worst] < 1.0 - _ROUNDING:
        name = form.estimate.user_names[int(users[worst])]
        promised = human(float(nats[worst]) * form.bps_per_nat, "bit/s")
        best = human(float(most[worst].sum()) * form.bps_per_nat, "bit/s")
        reason = f"{promised} is asked for {name}, but its subcarriers carry at most {best} at any power"
        return reason, float(carried[worst])
    together = float(most.max(axis=0).sum() / nats.sum())
    if together < 1.0 - _ROUNDING:
        promised = human(float(nats.sum()) * form.bps_per_nat, "bit/s")
        best = human(float(most.max(axis=0).sum()) * form.bps_per_nat, "bit/s")
        reason = f"the rates asked for add up to {promised}, but the subcarriers carry at most {best} at any power"
        return reason, together
    needed = int(np.ceil(nats / most.max(axis=1) * (1.0 - _ROUNDING)).sum())
    usable = int(np.count_nonzero(usable_groups(form)[users].any(axis=0)))
    if needed > usable:
        what = "subcarriers" if form.start.size - 1 == form.cap_w.size else "resource-block groups"
        return f"the rates asked for take at least {needed} {what} at any power, but {usable} can be used", np.inf
    return "", np.inf


def usable_groups(form: NormalForm) -> BoolArray:
    """Whether a user can use any subcarrier of a resource-block group, shape (user, group)."""
    return np.logical_or.reduceat(form.snr_per_w > 0, form.start[:-1], axis=1)


def _too_few(form: NormalForm, users: IntArray, served: int) -> str:
    """That of ``users`` no more than ``served`` can have a subcarrier of their own."""
    if users.size == 1:
        return f"{form.estimate.user_names[int(users[0])]} is asked to get a rate, but no subcarrier is of use to it"
    count = int(np.count_nonzero(usable_groups(form)[users].any(axis=0)))
    what = "subcarrier" if form.start.size - 1 == form.cap_w.size else "resource-block group"
    subcarriers = f"{count} usable {what}{'' if count == 1 else 's'}"
    those = f"only {served}" if served else "none"
    return (
        f"{users.size} users are to get a rate, but with {subcarriers} {those} of them can have one of their own"
    )  # fmt: skip


def _climb(form: NormalForm, snr: FloatArray, nats: FloatArray) -> tuple[FloatArray, int]:
    """ln λ (user,) near the dual's maximum for ``nats``, and the Newton steps done."""
    from wirelessagent.deciding.core.best_prices_kernel import find_prices
    from wirelessagent.deciding.core.climb_point_kernel import Ask
    from wirelessagent.deciding.core.dual_kernel import channel_of

    rows, log_price, no_share = promises(nats), np.empty(nats.size), np.zeros((nats.size, 3))
    ask = Ask(
        LEAST_POWER, form.cap_w, float(form.max_nats), form.start, rows, no_share, 0.0, float(form.budget_w), 0.0,
        form.limit.work,
    )  # fmt: skip
    term = np.empty((form.start.size - 1, nats.size))
    _, _, steps = find_prices(snr, channel_of(snr, ask), ask, rows, log_price, 0.0, False, term)
    return log_price, steps

"""The best choice among listed sets: a set for every user, no column twice, by integer programming.

Given sets are worth the least, over prices of power μ ≥ q, of Σ V_k(S_k; μ) + (μ − q) P. So with x_s = 1 where the set
s is taken the problem is

    max θ   with   θ ≤ Σ_s V_s(μ) x_s + (μ − q) P   for all μ,

which is solved for a few μ; the choice found has a price of its own, which is added, until none is missing (Benders,
1962; the same as Kelley's cuts, since what is listed is finite). Without a budget μ = q is the only price.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.market import NOTHING, Market, Sets
from wirelessagent.model.arrays import FloatArray

_UNIT = 1e-4
"""Values enter the programme in this part of what is at stake: its tolerances are 1e-6, so that 1e-10 remains."""
_LARGEST = 1e7
"""Losses in units of that are held at this, lest they spoil the programme's scaling; its bound stays one."""
LONGEST_S = 1e6
"""Where there is no limit, since HiGHS takes no infinite one."""
_CLOSE = 1e-10
_ROUNDS = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class Packing:
    """The best choice found.

    Attributes:
        sets: one for each user; None where there is none.
        value: what they are worth; −∞ where there are none.
        log_mu: ln μ at which they are.
        bound: no choice among the listed sets is worth more.
    """

    sets: Sets | None
    value: float
    log_mu: float
    bound: float


def pack(
    market: Market,
    sets: Sets,
    log_mu: float,
    *,
    scale: float,
    least: float = -np.inf,
    share: float = 1.0,
) -> Packing:
    """The best choice among ``sets``.

    Args:
        market: users, columns and power, and the time that there is.
        sets: the list.
        log_mu: ln of the first price of power to hold.
        scale: what is at stake; the answer is exact to 1e-10 of it.
        least: choices worth no more are of no use; the search ends where there is no better one.
        share: of the time that is left.
    """
    spare_s = (1.0 - share) * min(market.limit.left_s, LONGEST_S)
    unit = _UNIT * scale
    best = Packing(sets=None, value=-np.inf, log_mu=log_mu, bound=np.inf)
    cuts = [log_mu]
    bound = np.inf
    for _ in range(_ROUNDS):
        worths = np.stack([market.worths(sets, cut)[0] for cut in cuts])
        left = np.array([market.left_w(cut) for cut in cuts])
        if market.limit.is_over():
            break
        chosen, most = _solve(market, sets, worths, left, unit, spare_s)
        bound = min(bound, most)
        if chosen is None:
            break
        value, own = market.value(chosen, cuts[-1])
        if value > best.value:
            best = Packing(sets=chosen, value=value, log_mu=own, bound=bound)
        if bound - max(best.value, least) <= _CLOSE * scale or np.isinf(market.budget_w):
            break
        if any(abs(own - cut) <= 1e-13 * (1.0 + abs(cut)) for cut in cuts):
            break
        cuts.append(own)
    return Packing(sets=best.sets, value=best.value, log_mu=best.log_mu, bound=max(bound, best.value))


def _solve(
    market: Market, sets: Sets, worths: FloatArray, left: FloatArray, unit: float, spare_s: float
) -> tuple[Sets | None, float]:
    """The best choice at some prices of power (price, set), and a bound on all, −∞ where there is none.

    ``spare_s`` of the time that is left are for others.
    """
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import block_array, coo_array, csc_array, csr_array

    users = market.users.shape[0]
    usable = np.flatnonzero(worths.min(axis=0) > NOTHING)
    owner = sets.user[usable]
    base = np.full((left.size, users), -np.inf)
    for i in range(left.size):
        np.maximum.at(base[i], owner, worths[i, usable])
    if np.isinf(base).any():
        return None, -np.inf  # a user has no set at all
    loss = np.minimum((base[:, owner] - worths[:, usable]) / unit, _LARGEST)
    top = base.sum(axis=1) + left  # θ ≤ top − unit · loss·x
    highest = float(top.min())
    count = usable.size
    each = csr_array((np.ones(count), (owner, np.arange(count))), shape=(users, count))
    incidence = csc_array((np.ones(sets.member.size), sets.member, sets.first), shape=(market.columns, len(sets)))
    taken = csc_array(incidence[:, usable])
    price = csr_array(loss)
    fall = coo_array(np.full((left.size, 1), -1.0))  # θ = highest − unit · fall
    matrix = block_array([[each, None], [taken, None], [price, fall]], format="csc")
    lower = np.concatenate([np.ones(users), np.full(market.columns + left.size, -np.inf)])
    upper = np.concatenate([np.ones(users + market.columns), (top - highest) / unit])
    result = milp(
        np.concatenate([np.zeros(count), [1.0]]),
        constraints=LinearConstraint(matrix, lower, upper),
        integrality=np.concatenate([np.ones(count), [0.0]]),
        bounds=Bounds(np.zeros(count + 1), np.concatenate([np.ones(count), [np.inf]])),
        options={"mip_rel_gap": 0.0, "time_limit": max(min(market.limit.left_s, LONGEST_S) - spare_s, 0.01)},
    )
    if result.status == 2:
        return None, -np.inf
    proven = result.mip_dual_bound
    bound = highest - unit * (float(proven) if proven is not None and np.isfinite(proven) else 0.0)
    if result.x is None:
        return None, bound
    return sets.chosen(usable[np.asarray(result.x[:count]) > 0.5]), bound

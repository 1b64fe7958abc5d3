"""The dual core: prices, sets by the prices, better sets, powers; one problem or a batch.

Each problem is solved on its own and from its arrays alone, so a batch is a loop, and threads share it out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.ask_kernel import LEVEL, POWER, SUM, Ask
from wirelessagent.deciding.core.best_prices_kernel import find_prices
from wirelessagent.deciding.core.bundle_kernel import HIGH, LOW, SLOPE
from wirelessagent.deciding.core.climb_point_kernel import FARTHEST
from wirelessagent.deciding.core.demand_kernel import conjugate, level_bound
from wirelessagent.deciding.core.least_power_kernel import keep_budget, least_power
from wirelessagent.deciding.core.moves_kernel import serve_all
from wirelessagent.deciding.core.search_kernel import choose_candidates, polish, price_of, restart
from wirelessagent.deciding.core.sets_kernel import (
    CEILING,
    FLOOR,
    FULL,
    INVERSE,
    LOG_BEST,
    RATE,
    SPENT,
    WATER,
    Channel,
    Sets,
    assign,
    copy_owners,
    empty_sets,
    none,
    value_all,
)
from wirelessagent.deciding.core.settle_kernel import OVERSPENT, set_level, settle
from wirelessagent.deciding.core.terms_kernel import worth_of_groups
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

MARGIN = 1e-6
NEAR = 0.2
"""By how much, in units of a group's mean term, a candidate's term may fall short at first: sets near the prices fit
each other, and are a better start for the search among all candidates than what all of them lead to at once."""
LOWER = (0.7, 0.3, 1e-2, 1e-6)
"""Shares of a level at which users who cannot reach it are given subcarriers first."""


class Found(NamedTuple):
    """What was found.

    Attributes:
        score: of the allocation; see :mod:`.settle_kernel`.
        at: ln μ of the allocation, or ln of its level.
        dual: F at the best prices; minus the least power for that goal, and for the level a bound on it.
        log_mu: ln μ at those prices.
        missing: users without a rate that they must have.
        iterations: Newton steps.
    """

    score: float
    at: float
    dual: float
    log_mu: float
    missing: int
    iterations: int


@kernel
def channel_of(snr_per_w: FloatArray, ask: Ask) -> Channel:
    """The channel as the kernels read it, from a (user, subcarrier) in 1/W; 0 where a pair may not be used."""
    users, subcarriers = snr_per_w.shape
    log_best = np.empty(users)
    pair = np.empty((5, users, subcarriers))
    cap_w, max_nats = ask.cap_w, ask.max_nats
    for k in range(users):
        best = 0.0
        for n in range(subcarriers):
            best = max(best, snr_per_w[k, n])
        log_best[k] = np.log(best) if best > 0.0 else 0.0
        for n in range(subcarriers):
            snr = snr_per_w[k, n]
            floor, inverse, ceiling, full = np.inf, 0.0, 0.0, 0.0
            if snr > 0.0:
                floor, inverse, ceiling, full = -np.log(snr / best), best / snr, max_nats, np.inf
                if cap_w[n] < np.inf:
                    ceiling = min(np.log1p(cap_w[n] * snr), max_nats)
                if ceiling < np.inf:
                    full = np.expm1(ceiling) * inverse
            pair[FLOOR, k, n], pair[INVERSE, k, n], pair[CEILING, k, n], pair[FULL, k, n] = (
                floor,
                inverse,
                ceiling,
                full,
            )
    return Channel(pair[FLOOR], pair[INVERSE], pair[CEILING], log_best, pair)


@kernel
def usable_groups(ceiling: FloatArray, start: IntArray, rows: FloatArray) -> BoolArray:
    """Which users can and would use any subcarrier of a group, shape (group, user)."""
    groups, users = start.size - 1, rows.shape[0]
    usable = np.zeros((groups, users), dtype=np.bool_)
    for k in range(users):
        if rows[k, HIGH] <= 0.0 or (rows[k, LOW] <= 0.0 and rows[k, SLOPE] <= 0.0):
            continue
        for g in range(groups):
            for n in range(start[g], start[g + 1]):
                if ceiling[k, n] > 0.0:
                    usable[g, k] = True
    return usable


@kernel
def mean_term(term: FloatArray) -> float:
    """Mean over the groups of the largest term."""
    total = 0.0
    for g in range(term.shape[0]):
        highest = 0.0
        for k in range(term.shape[1]):
            highest = max(highest, term[g, k])
        total += highest
    return total / term.shape[0]


@kernel
def slack_of(
    ask: Ask,
    rows: FloatArray,
    log_price: FloatArray,
    log_mu: float,
    term: FloatArray,
    dual: float,
    score: float,
    at: float,
) -> float:
    """By how much a group's term may fall short of its largest, in W, in any allocation that scores higher.

    The dual is the score of the allocation at hand plus what its groups and users fall short of their best by.
    """  # fmt: skip
    if not score > -OVERSPENT * 1e-9:
        return np.inf
    if ask.goal == POWER:
        return max(-score - -dual, 0.0) * (1.0 + MARGIN)
    total = 0.0
    for g in range(term.shape[0]):
        total += max(term[g].max(), 0.0)
    if ask.goal == LEVEL:
        paid = 0.0
        for k in range(log_price.size):
            rate = min(max(np.exp(at) * ask.share[k, 0], ask.share[k, 1]), ask.share[k, 2])
            paid += np.exp(log_price[k]) * rate
        return max(ask.budget_w - (paid - total), 0.0) * (1.0 + MARGIN)
    mu = np.exp(log_mu)
    if ask.goal == SUM:
        return max(dual - score, 0.0) / mu * (1.0 + MARGIN)
    most = 0.0
    for k in range(log_price.size):
        most += conjugate(rows[k], log_price[k] + log_mu)
    if mu < score:
        return np.inf
    most += mu * total + (mu - score) * ask.budget_w - score * ask.circuit_w
    return max(most, 0.0) / mu * (1.0 + MARGIN)


@kernel
def dual_at(snr_per_w: FloatArray, ask: Ask, rows: FloatArray, log_price: FloatArray, log_mu: float) -> float:
    """What prices prove, so that prices can be compared: less is better. The prices of an allocation may prove more
    than those found by the climb, which stops at a temperature.
    """
    price = np.exp(log_price)
    worth_w = worth_of_groups(snr_per_w, ask.cap_w, np.expm1(ask.max_nats), ask.start, price)
    if ask.goal == LEVEL:
        return level_bound(ask.share, log_price, worth_w + ask.budget_w, ask.most_level)
    if ask.goal == POWER:
        return worth_w - (price * rows[:, LOW]).sum()
    mu = np.exp(log_mu)
    joint = 0.0
    for k in range(price.size):
        joint += conjugate(rows[k], log_price[k] + log_mu)
    if ask.goal == SUM:
        return joint + mu * (worth_w + ask.budget_w)
    surplus = joint + mu * (worth_w - ask.circuit_w)
    drawn = ask.circuit_w if surplus > 0.0 else ask.budget_w + ask.circuit_w
    return mu + surplus / max(drawn, 1e-300)


@kernel
def solve(
    snr_per_w: FloatArray,
    ask: Ask,
    choices: int,
    restarts: int,
    seed: int,
    warm: bool,
    log_price: FloatArray,
    log_mu: float,
    given: bool,
    owner: IntArray,
    power_w: FloatArray,
) -> Found:
    """One problem from its channel a (user, subcarrier) in 1/W.

    Args:
        choices: most candidates of a group.
        restarts, seed: of the search.
        warm, log_price, log_mu: whether ln λ (user,) and ln μ are those of the slot before; ln λ is overwritten.
        given: whether ``owner`` holds sets to start from as well.
        owner, power_w: written, shape (subcarrier,).
    """  # fmt: skip
    users = snr_per_w.shape[0]
    groups = ask.start.size - 1
    channel = channel_of(snr_per_w, ask)
    rows = ask.rows.copy()
    term = np.empty((groups, users))
    dual, log_mu, iterations = find_prices(snr_per_w, channel, ask, rows, log_price, log_mu, warm, term)
    sets = empty_sets(channel, ask.start, rows, ask.work)
    usable = usable_groups(channel.ceiling, ask.start, rows)
    candidates = np.empty((groups, min(choices, users)), dtype=np.int64)
    choose_candidates(term, usable, NEAR * mean_term(term), candidates)
    best_owner = np.empty(groups, dtype=np.int64)
    for g in range(groups):
        best_owner[g] = owner[ask.start[g]] if given else likeliest(term, candidates, g)
    at, missing = start_sets(ask, sets, log_mu, best_owner)
    score, at = polish(ask, sets, candidates, at, best_owner)
    if given:
        score, at, missing = polish_priced(ask, sets, candidates, term, log_mu, score, at, missing, best_owner)
    slack = slack_of(ask, rows, log_price, log_mu, term, dual, score, at)
    if slack > 0.0:
        choose_candidates(term, usable, slack, candidates)
        score, at = polish(ask, sets, candidates, at, best_owner)
        score, at = restart(ask, sets, candidates, score, at, best_owner, slack, restarts, seed)
    assign(sets, best_owner)
    value_all(sets, price_of(ask, at))
    for g in range(groups):
        owner[ask.start[g] : ask.start[g + 1]] = best_owner[g]
    nats, spare = np.empty(users), np.empty(users)
    log_mu = write_figures(snr_per_w, ask, sets, score, at, log_price, log_mu, nats)
    least_power(snr_per_w, channel.ceiling, nats, owner, power_w, spare)
    if ask.goal != POWER and not ask.rows[:, LOW].max() > 0.0:
        keep_budget(ask.budget_w, power_w)
    return Found(score, at, dual, log_mu, missing, iterations)


@kernel
def likeliest(term: FloatArray, candidates: IntArray, g: int) -> int:
    """The user with the largest term for a group, −1 where none gains by it."""
    k = candidates[g, 0]
    return k if k >= 0 and term[g, k] > 0.0 else none()


@kernel
def polish_priced(
    ask: Ask,
    sets: Sets,
    candidates: IntArray,
    term: FloatArray,
    log_mu: float,
    score: float,
    at: float,
    missing: int,
    best_owner: IntArray,
) -> tuple[float, float, int]:
    """:func:`.polish` from the sets that the prices give, unless the best sets so far score as much."""
    owner = best_owner.copy()
    for g in range(owner.size):
        owner[g] = likeliest(term, candidates, g)
    other_at, other_missing = start_sets(ask, sets, log_mu, owner)
    other, other_at = polish(ask, sets, candidates, other_at, owner)
    if other > score:
        copy_owners(owner, best_owner)
        return other, other_at, other_missing
    assign(sets, best_owner)
    if ask.goal == LEVEL:
        set_level(sets.user, ask.share, np.exp(at))
    return score, at, missing


@kernel
def write_figures(
    snr_per_w: FloatArray,
    ask: Ask,
    sets: Sets,
    score: float,
    at: float,
    log_price: FloatArray,
    log_mu: float,
    nats: FloatArray,
) -> float:
    """Write the users' rates in nats (user,), and ln λ (user,) of the sets where it proves more; ln μ."""
    user = sets.user
    own_price: FloatArray = log_price.copy()
    for k in range(nats.size):
        nats[k] = 0.0
        if user[k, RATE] > 0.0:  # levels lose digits of tiny rates
            nats[k] = min(max(user[k, RATE], user[k, LOW]), user[k, HIGH])
        level = user[k, WATER] - user[k, LOG_BEST]
        if user[k, SPENT] > 0.0 and abs(level) < FARTHEST:
            own_price[k] = level
    if not score > -OVERSPENT * 1e-9:
        return log_mu
    own_mu = log_mu if ask.goal == LEVEL else at
    own_dual = dual_at(snr_per_w, ask, sets.user, own_price, price_of(ask, at))
    if own_dual < dual_at(snr_per_w, ask, sets.user, log_price, log_mu):
        log_price[:] = own_price
        return own_mu
    return log_mu


@kernel
def start_sets(ask: Ask, sets: Sets, log_mu: float, owner: IntArray) -> tuple[float, int]:
    """Take over the owners (group,) and serve who lacks a rate; ln μ (or ln level) and how many still lack one.

    Owners that keep every limit are left as they are, unless the level is 0 because somebody has nothing at all, and
    serving everybody lifts it.
    """
    assign(sets, owner)
    score, own_at, _ = settle(ask, sets, log_mu)
    keeps = score > -OVERSPENT * 1e-9
    if keeps and (ask.goal != LEVEL or score > 0.0):
        return own_at, 0
    at, missing = serve_wanting(ask, sets, log_mu)
    if keeps and not settle(ask, sets, at)[0] > 0.0:
        assign(sets, owner)
        return own_at, 0
    return at, missing


@kernel
def serve_wanting(ask: Ask, sets: Sets, log_mu: float) -> tuple[float, int]:
    """Serve who lacks a rate at a price, or at as much of a level as can be; ln of it and how many still lack one."""
    at = log_mu
    if ask.goal == LEVEL:
        set_level(sets.user, ask.share, np.exp(at))
    value_all(sets, price_of(ask, at))
    missing = serve_all(sets)
    if ask.goal == LEVEL:
        for share_of_level in LOWER:
            if missing == 0:
                break
            at = log_mu + np.log(share_of_level)
            set_level(sets.user, ask.share, np.exp(at))
            value_all(sets, 0.0)
            missing = serve_all(sets)
    return at, missing

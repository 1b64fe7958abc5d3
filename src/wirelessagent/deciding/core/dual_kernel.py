"""The dual core: prices, sets by the prices, better sets, powers; one problem or a batch.

Each problem is solved on its own and from its arrays alone, so a batch is a loop, and threads share it out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.best_prices_kernel import Ask, find_prices, level_bound
from wirelessagent.deciding.core.bundle_kernel import HIGH, LOW, SLOPE
from wirelessagent.deciding.core.least_power_kernel import least_power
from wirelessagent.deciding.core.prices_kernel import FARTHEST, conjugate
from wirelessagent.deciding.core.search_kernel import choose_candidates, polish, restart, serve_all
from wirelessagent.deciding.core.sets_kernel import Channel, assign, empty_sets, no_group, set_bundle, value_all
from wirelessagent.deciding.core.settle_kernel import LEVEL, OVERSPENT, POWER, SUM, set_level
from wirelessagent.deciding.core.terms_kernel import worth_of_groups
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MARGIN = 1e-6
NEAR, FAR = 0.2, 0.6
"""By how much, in units of a group's mean term, a candidate's term may fall short at first, and later."""
MANY, TINY = 100, 64
"""From so many restarts on, or up to so many users × groups, all candidates are tried that the dual does not exclude;
so they are where utilities, not promises, say what is near."""
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
    floor = np.full((users, subcarriers), np.inf)
    inverse = np.zeros((users, subcarriers))
    ceiling = np.zeros((users, subcarriers))
    log_best = np.zeros(users)
    usable = np.zeros((ask.start.size - 1, users), dtype=np.bool_)
    least = np.inf
    for k in range(users):
        best = snr_per_w[k].max()
        if best <= 0.0:
            continue
        log_best[k] = np.log(best)
        for g in range(ask.start.size - 1):
            for n in range(ask.start[g], ask.start[g + 1]):
                snr = snr_per_w[k, n]
                if snr <= 0.0:
                    continue
                floor[k, n] = -np.log(snr / best)
                inverse[k, n] = best / snr
                ceiling[k, n] = ask.max_nats
                if ask.cap_w[n] < np.inf:
                    ceiling[k, n] = min(np.log1p(ask.cap_w[n] * snr), ask.max_nats)
                least = min(least, ceiling[k, n])
                usable[g, k] = True
    if ask.start.size - 1 < subcarriers:
        least = np.nan
    return Channel(floor, inverse, ceiling, log_best, ask.start, usable, least)


@kernel
def mean_term(term: FloatArray) -> float:
    """Mean over the groups of the largest term."""
    total = 0.0
    for g in range(term.shape[0]):
        total += max(term[g].max(), 0.0)
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
    users, subcarriers = snr_per_w.shape
    groups = ask.start.size - 1
    channel = channel_of(snr_per_w, ask)
    rows = ask.rows.copy()
    term = np.empty((groups, users))
    dual, log_mu, iterations = find_prices(snr_per_w, channel, ask, rows, log_price, log_mu, warm, term)
    usable = channel.usable.copy()
    for k in range(users):
        if rows[k, HIGH] <= 0.0 or (rows[k, LOW] <= 0.0 and rows[k, SLOPE] <= 0.0):
            usable[:, k] = False
    candidates = np.empty((groups, min(choices, users)), dtype=np.int64)
    wanted = np.empty((groups, users), dtype=np.bool_)
    mean = mean_term(term)
    choose_candidates(term, usable, NEAR * mean, candidates, wanted)
    sets = empty_sets(users, groups, subcarriers)
    best_owner = np.empty(groups, dtype=np.int64)
    for g in range(groups):
        k = candidates[g, 0]
        best_owner[g] = k if k >= 0 and term[g, k] > 0.0 else -1
    assign(sets, best_owner)
    at = log_mu
    price = 0.0 if ask.goal == LEVEL else log_mu
    value_all(channel, rows, price, sets)
    missing = serve_all(channel, rows, price, sets)
    if ask.goal == LEVEL:
        for share_of_level in LOWER:
            if missing == 0:
                break
            at = log_mu + np.log(share_of_level)
            set_level(rows, ask.share, np.exp(at))
            value_all(channel, rows, price, sets)
            missing = serve_all(channel, rows, price, sets)
    score, at = polish(
        ask.goal, channel, rows, ask.share, ask.budget_w, ask.circuit_w, ask.most_level, candidates, wanted, sets, at,
        best_owner,
    )  # fmt: skip
    if given:
        first_owner = best_owner.copy()
        for g in range(groups):
            best_owner[g] = owner[ask.start[g]]
        assign(sets, best_owner)
        other, other_at = polish(
            ask.goal, channel, rows, ask.share, ask.budget_w, ask.circuit_w, ask.most_level, candidates, wanted, sets,
            at, best_owner,
        )  # fmt: skip
        if other > score:
            score, at = other, other_at
        else:
            best_owner[:] = first_owner
            assign(sets, best_owner)
            if ask.goal == LEVEL:
                set_level(rows, ask.share, np.exp(at))
    slack = slack_of(ask, rows, log_price, log_mu, term, dual, score, at)
    promised = ask.goal == POWER or ask.goal == LEVEL
    reach = FAR * mean if promised and restarts < MANY and users * groups > TINY else np.inf
    if slack > 0.0:
        choose_candidates(term, usable, min(slack, reach), candidates, wanted)
        score, at = polish(
            ask.goal, channel, rows, ask.share, ask.budget_w, ask.circuit_w, ask.most_level, candidates, wanted, sets,
            at, best_owner,
        )  # fmt: skip
        state = np.array([seed * 2654435761 + 88172645463325252])
        score, at = restart(
            ask.goal, channel, rows, ask.share, ask.budget_w, ask.circuit_w, ask.most_level, candidates, wanted, sets,
            score, at, best_owner, restarts, state,
        )  # fmt: skip
    assign(sets, best_owner)
    nats = np.zeros(users)
    price = 0.0 if ask.goal == LEVEL else at
    own_price = log_price.copy()
    for k in range(users):
        _, nats[k], spent, level = set_bundle(channel, rows, price, sets, k, no_group(), no_group())
        if nats[k] > 0.0:
            nats[k] = min(max(nats[k], rows[k, LOW]), rows[k, HIGH])  # levels lose digits of tiny rates
        if spent > 0.0 and abs(level) < FARTHEST:
            own_price[k] = level
    if score > -OVERSPENT * 1e-9:
        own_dual = dual_at(snr_per_w, ask, rows, own_price, price)
        if own_dual < dual_at(snr_per_w, ask, rows, log_price, log_mu):
            log_price[:] = own_price
            log_mu = log_mu if ask.goal == LEVEL else price
    for g in range(groups):
        owner[ask.start[g] : ask.start[g + 1]] = best_owner[g]
    spare = np.empty(users)
    least_power(snr_per_w, channel.ceiling, nats, owner, power_w, spare)
    return Found(score, at, dual, log_mu, missing, iterations)

"""Sets by greedy gain: groups of subcarriers go one by one to whoever gains most, and then get their exact powers.

The price of power is the dual's, so a gain is what a group adds to a user's worth at that price: the power that it
saves to a user whose rate is promised, utility less power to one who takes what is worthwhile (:mod:`.bundle_kernel`).
Users without a set that carries a rate which they must have come first, the neediest ahead.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.best_prices_kernel import Ask, find_prices
from wirelessagent.deciding.core.bundle_kernel import LOW, UNREACHABLE
from wirelessagent.deciding.core.dual_kernel import Found, channel_of
from wirelessagent.deciding.core.least_power_kernel import least_power
from wirelessagent.deciding.core.sets_kernel import (
    ROUNDING,
    Channel,
    Sets,
    assign,
    change,
    changed_worth,
    empty_sets,
    no_group,
    set_bundle,
    value_all,
    worth_of,
)
from wirelessagent.deciding.core.settle_kernel import LEVEL, settle
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

NONE, UNKNOWN = -1, -2


@kernel
def best_free(
    channel: Channel, rows: FloatArray, log_mu: float, log_mus: FloatArray, sets: Sets, user: int, alike: bool
) -> tuple[int, float]:
    """The free group that is worth most to a user and what it gains by it; −1 if none is of use.

    The gain of a user who has no set that carries what it must have is its need: ln of the power that the whole rate
    takes, roughly, on the best subcarrier of the group. ``log_mus`` is ln μ less ln â of each user; groups are
    ``alike`` if nothing but the gain tells them apart.
    """  # fmt: skip
    now = sets.worth[user]
    best, chosen = now + ROUNDING * abs(now), NONE
    first, last = 0, sets.owner.size
    if alike:
        lowest = np.inf
        for g in range(sets.owner.size):
            if sets.owner[g] < 0 and channel.floor[user, g] < lowest:
                lowest, first = channel.floor[user, g], g
        last = first + 1
    for g in range(first, last):
        if sets.owner[g] >= 0 or not channel.usable[g, user]:
            continue
        worth = changed_worth(
            rows, sets.sums, channel.floor, channel.inverse, channel.least_ceiling, log_mus, user, no_group(), g
        )  # fmt: skip
        if np.isnan(worth):
            worth = worth_of(channel, rows, log_mu, sets, user, no_group(), g)
        if worth > best:
            best, chosen = worth, g
    if chosen == NONE or now > -UNREACHABLE:
        return chosen, best - now
    lowest = channel.floor[user, channel.start[chosen] : channel.start[chosen + 1]].min()
    return chosen, rows[user, LOW] + lowest - channel.log_best[user]


@kernel
def hand_out(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, alike: bool) -> None:
    """Give free groups away, one by one, to the user who needs one most or, where nobody needs any, gains most.

    ``alike`` as in :func:`best_free`.
    """
    users = sets.size.size
    choice = np.full(users, UNKNOWN)
    gain = np.empty(users)
    log_mus = log_mu - channel.log_best
    while True:
        chosen = -1
        urgent = False
        for k in range(users):
            if choice[k] == UNKNOWN or (choice[k] != NONE and sets.owner[choice[k]] >= 0):
                choice[k], gain[k] = best_free(channel, rows, log_mu, log_mus, sets, k, alike)
            if choice[k] == NONE:
                continue
            needy = sets.worth[k] <= -UNREACHABLE
            if chosen < 0 or (needy and not urgent) or (needy == urgent and gain[k] > gain[chosen]):
                chosen, urgent = k, needy
        if chosen < 0:
            return
        change(channel, rows, log_mu, sets, choice[chosen], chosen, no_group())
        choice[chosen] = UNKNOWN


@kernel
def solve_greedily(
    snr_per_w: FloatArray, ask: Ask, log_price: FloatArray, owner: IntArray, power_w: FloatArray
) -> Found:
    """One problem from its channel a (user, subcarrier) in 1/W.

    Args:
        log_price: ln λ, shape (user,), written.
        owner: the owners to start from, −1 for nobody, shape (subcarrier,); groups that nobody owns are given away,
            and the owners written.
        power_w: written, shape (subcarrier,).
    """
    users, subcarriers = log_price.size, owner.size
    groups = ask.start.size - 1
    channel = channel_of(snr_per_w, ask)
    rows = ask.rows.copy()
    term = np.empty((groups, users))
    dual, log_mu, iterations = find_prices(snr_per_w, channel, ask, rows, log_price, 0.0, False, term)
    sets = empty_sets(users, groups, subcarriers)
    owners = np.empty(groups, dtype=np.int64)
    for g in range(groups):
        owners[g] = owner[ask.start[g]]
    assign(sets, owners)
    price = 0.0 if ask.goal == LEVEL else log_mu
    value_all(channel, rows, price, sets)
    hand_out(channel, rows, price, sets, groups == subcarriers and ask.cap_w.min() == np.inf)
    missing = 0
    for k in range(users):
        if sets.worth[k] <= -UNREACHABLE:
            missing += 1
    score, at, _ = settle(
        ask.goal, channel, rows, ask.share, ask.budget_w, ask.circuit_w, ask.most_level, log_mu, sets
    )  # fmt: skip
    nats = np.zeros(users)
    price = 0.0 if ask.goal == LEVEL else at
    for k in range(users):
        nats[k] = set_bundle(channel, rows, price, sets, k, no_group(), no_group())[1]
    for g in range(groups):
        owner[ask.start[g] : ask.start[g + 1]] = sets.owner[g]
    least_power(snr_per_w, channel.ceiling, nats, owner, power_w, np.empty(users))
    return Found(score, at, dual, log_mu, missing, iterations)

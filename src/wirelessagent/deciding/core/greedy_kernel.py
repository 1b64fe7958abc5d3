"""Sets by greedy gain: groups of subcarriers go one by one to whoever gains most, and then get their exact powers.

The price of power is the dual's, so a gain is what a group adds to a user's worth at that price: the power that it
saves to a user whose rate is promised, utility less power to one who takes what is worthwhile (:mod:`.bundle_kernel`).
Users without a set that carries a rate which they must have come first, the neediest ahead.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import POWER, Ask
from wirelessagent.deciding.core.best_prices_kernel import find_prices
from wirelessagent.deciding.core.bundle_kernel import LOW, UNREACHABLE
from wirelessagent.deciding.core.dual_kernel import Found, channel_of
from wirelessagent.deciding.core.least_power_kernel import keep_budget, least_power
from wirelessagent.deciding.core.moves_kernel import ROUNDING, change, serve_all
from wirelessagent.deciding.core.search_kernel import price_of
from wirelessagent.deciding.core.sets_kernel import (
    FLOOR,
    LOG_BEST,
    OWNER,
    RATE,
    START,
    WORTH,
    Sets,
    assign,
    copy_owners,
    empty_sets,
    none,
    value_all,
    worth_of,
)
from wirelessagent.deciding.core.settle_kernel import settle
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

UNKNOWN = -2


@kernel
def best_free(sets: Sets, k: int, alike: bool) -> tuple[int, float]:
    """The free group that is worth most to a user and what it gains by it; −1 if none is of use.

    The gain of a user who has no set that carries what it must have is its need: ln of the power that the whole rate
    takes, roughly, on the best subcarrier of the group. Groups are ``alike`` if nothing but the gain tells them apart.
    """
    pair, user, group = sets.pair, sets.user, sets.group
    now = user[k, WORTH]
    best, chosen = now + ROUNDING * abs(now), none()
    first, last = none() + 1, group.shape[1] - 1
    if alike:
        lowest = np.inf
        for g in range(last):
            if group[OWNER, g] < 0 and pair[FLOOR, k, g] < lowest:
                lowest, first = pair[FLOOR, k, g], g
        last = first + 1
    for g in range(first, last):
        if group[OWNER, g] < 0:
            worth = worth_of(sets, k, none(), g)
            if worth > best:
                best, chosen = worth, g
    if chosen < 0 or now > -UNREACHABLE:
        return chosen, best - now
    lowest = np.inf
    for n in range(group[START, chosen], group[START, chosen + 1]):
        lowest = min(lowest, pair[FLOOR, k, n])
    return chosen, user[k, LOW] + lowest - user[k, LOG_BEST]


@kernel
def hand_out(sets: Sets, alike: bool) -> None:
    """Give free groups away, one by one, to the user who needs one most or, where nobody needs any, gains most.

    ``alike`` as in :func:`best_free`.
    """
    users = sets.user.shape[0]
    choice = np.full(users, UNKNOWN)
    gain = np.empty(users)
    while True:
        chosen = none()
        urgent = False
        for k in range(users):
            if choice[k] == UNKNOWN or (choice[k] >= 0 and sets.group[OWNER, choice[k]] >= 0):
                choice[k], gain[k] = best_free(sets, k, alike)
            if choice[k] < 0:
                continue
            needy = sets.user[k, WORTH] <= -UNREACHABLE
            if chosen < 0 or (needy and not urgent) or (needy == urgent and gain[k] > gain[chosen]):
                chosen, urgent = k, needy
        if chosen < 0 or is_over(sets.work):
            return
        change(sets, choice[chosen], chosen, none())
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
    sets = empty_sets(channel, ask.start, rows, ask.work)
    owners = np.empty(groups, dtype=np.int64)
    for g in range(groups):
        owners[g] = owner[ask.start[g]]
    assign(sets, owners)
    value_all(sets, price_of(ask, log_mu))
    hand_out(sets, groups == subcarriers and ask.cap_w.min() == np.inf)
    if is_over(ask.work):
        serve_all(sets)
    missing = 0
    for k in range(users):
        if sets.user[k, WORTH] <= -UNREACHABLE:
            missing += 1
    score, at, _ = settle(ask, sets, log_mu)
    value_all(sets, price_of(ask, at))
    nats = sets.user[:, RATE].copy()
    copy_owners(sets.group[OWNER], owners)
    for g in range(groups):
        owner[ask.start[g] : ask.start[g + 1]] = owners[g]
    least_power(snr_per_w, channel.ceiling, nats, owner, power_w, np.empty(users))
    if ask.goal != POWER and not ask.rows[:, LOW].max() > 0.0:
        keep_budget(ask.budget_w, power_w)
    return Found(score, at, dual, log_mu, missing, iterations)

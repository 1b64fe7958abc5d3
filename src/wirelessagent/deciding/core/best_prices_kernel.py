"""The dual's best prices for each goal: where the climb of :mod:`.prices_kernel` starts, and how it goes on."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import EFFICIENCY, LEVEL, POWER, SUM, Ask
from wirelessagent.deciding.core.bundle_kernel import LOW
from wirelessagent.deciding.core.climb_point_kernel import FARTHEST
from wirelessagent.deciding.core.demand_kernel import kink_of
from wirelessagent.deciding.core.prices_kernel import FLAT, climb
from wirelessagent.deciding.core.sets_kernel import Channel
from wirelessagent.deciding.core.settle_kernel import set_level
from wirelessagent.deciding.core.start_kernel import equal_price, even_split, typical_snr
from wirelessagent.deciding.core.supply_kernel import groups_of, write_terms
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray

COLD = np.array([0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 5e-6])
PROMISED = np.array([0.1, 0.02, 5e-3, 1.5e-3, 1e-4, 5e-6])
WARM = np.array([2e-2, 5e-3, 1.5e-3, 1e-4, 5e-6])
"""Temperatures of a climb from afar, from a start for promises alone, and from the slot before."""
LOOSE = 0.1
"""How roughly prices for promises alone settle among many pairs from the slot before, instead of ``FLAT``: they hardly
move in a slot, and most of the way is foreseen where the temperature falls."""
FEW, COLDEST = 300, 2
"""Pairs of users and groups up to which the last temperatures are worth their time, and how many those are."""


@kernel
def find_prices(
    snr_per_w: FloatArray,
    channel: Channel,
    ask: Ask,
    rows: FloatArray,
    log_price: FloatArray,
    log_mu: float,
    warm: bool,
    term: FloatArray,
) -> tuple[float, float, int]:
    """Climb to the dual's best prices; returns F (for the level its bound), ln μ and the Newton steps.

    ``log_price`` (user,) holds ln λ of the slot before where ``warm``, and receives the best; ``term`` (group, user)
    the groups' terms at them. ``rows`` is overwritten for the level.
    """  # fmt: skip
    users, subcarriers = snr_per_w.shape
    groups = groups_of(channel, ask.start, ask.max_nats < np.inf or ask.cap_w.min() < np.inf)
    elastic = ask.goal == SUM or ask.goal == EFFICIENCY
    level = np.exp(log_mu)
    if not warm:
        typical = np.empty(users)
        typical_snr(snr_per_w, typical)
        if ask.goal == LEVEL:
            level = first_level(typical, ask, subcarriers)
            set_level(rows, ask.share, level)
        equal_price(rows, typical, subcarriers, log_price)
        if elastic:
            log_mu = even_split(rows, typical, subcarriers, ask.budget_w, log_price)
    elif ask.goal == LEVEL:
        set_level(rows, ask.share, level)
    if not elastic:
        log_mu = 0.0
    point = np.empty(users + 1)
    point[users] = log_mu
    for k in range(users):
        point[k] = min(max(log_price[k], -FARTHEST), FARTHEST) + log_mu
        kink = kink_of(rows[k])
        if not warm and not np.isnan(kink):
            point[k] = max(point[k], kink) if rows[k, LOW] > 0.0 else kink
    temperatures, flat = WARM if warm else COLD if elastic else PROMISED, FLAT
    if users * (ask.start.size - 1) > FEW:
        temperatures = temperatures[:-COLDEST]
        if warm and ask.goal == POWER:
            flat = LOOSE
    dual, iterations = climb(groups, ask, rows, temperatures, flat, point)
    log_mu = float(point[users])
    for k in range(users):
        log_price[k] = point[k] - log_mu
    price = np.exp(log_price)
    for g in range(ask.start.size - 1):
        write_terms(groups.pair, ask.start[g], ask.start[g + 1], log_price, price, term, g)
    if ask.goal == LEVEL:
        log_mu = np.log(dual) if dual > 0.0 else -FARTHEST
    return dual, log_mu, iterations


@kernel
def first_level(typical: FloatArray, ask: Ask, subcarriers: int) -> float:
    """A level to start from: that of the user with the least for its share of an even split."""
    users = typical.size
    level = ask.most_level
    for k in range(users):
        if ask.share[k, 0] > 0.0:
            rate = subcarriers / users * np.log1p(ask.budget_w / subcarriers * typical[k])
            level = min(level, max(rate / ask.share[k, 0], 1e-250))
    return level

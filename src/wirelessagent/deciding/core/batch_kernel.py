"""Many problems that differ in their channel alone: the kernels of one problem in a loop, without the GIL."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import Ask
from wirelessagent.deciding.core.demand_kernel import level_bound
from wirelessagent.deciding.core.dual_kernel import solve
from wirelessagent.deciding.core.terms_kernel import worth_of_groups
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray


@kernel
def solve_all(
    snr_per_w: FloatArray,
    ask: Ask,
    rows: FloatArray,
    share: FloatArray,
    most_level: FloatArray,
    choices: int,
    restarts: int,
    seed: int,
    warm: BoolArray,
    given: bool,
    log_price: FloatArray,
    log_mu: FloatArray,
    owner: IntArray,
    power_w: FloatArray,
    score: FloatArray,
) -> None:
    """:func:`.dual_kernel.solve` for a batch, each problem from the same seed.

    Args:
        snr_per_w: a, shape (batch, user, subcarrier), in 1/W; 0 where a pair may not be used.
        ask: what is the same for all.
        rows, share, most_level: each problem's own, shapes (batch, user, 6), (batch, user, 3) and (batch,).
        choices, restarts, seed: of the search.
        warm: whether a search starts from its prices, shape (batch,).
        given: whether ``owner`` holds sets to start from.
        log_price, log_mu: ln λ and ln μ, shapes (batch, user) and (batch,); overwritten.
        owner, power_w: written, shape (batch, subcarrier).
        score: written, shape (batch,).
    """  # fmt: skip
    for b in range(snr_per_w.shape[0]):
        own = Ask(
            ask.goal, ask.cap_w, ask.max_nats, ask.start, rows[b], share[b], most_level[b], ask.budget_w, ask.circuit_w,
            ask.work,
        )  # fmt: skip
        found = solve(
            snr_per_w[b], own, choices, restarts, seed, warm[b], log_price[b], log_mu[b], given, owner[b], power_w[b]
        )  # fmt: skip
        score[b] = found.score
        log_mu[b] = found.log_mu


@kernel
def worth_of_all(
    snr_per_w: FloatArray, cap_w: FloatArray, max_snr: float, start: IntArray, price: FloatArray
) -> FloatArray:
    """:func:`.terms_kernel.worth_of_groups` for a (batch, user, subcarrier) and λ (batch, user); shape (batch,)."""
    worth = np.empty(snr_per_w.shape[0])
    for b in range(worth.size):
        worth[b] = worth_of_groups(snr_per_w[b], cap_w, max_snr, start, price[b])
    return worth


@kernel
def level_bounds(share: FloatArray, log_price: FloatArray, worth_w: FloatArray, most: FloatArray) -> FloatArray:
    """:func:`.demand_kernel.level_bound` for shares (batch, user, 3) and ln λ (batch, user); shape (batch,)."""
    level = np.empty(worth_w.size)
    for b in range(level.size):
        level[b] = level_bound(share[b], log_price[b], worth_w[b], most[b])
    return level


@kernel
def all_servable(snr_per_w: FloatArray, start: IntArray, wanting: BoolArray) -> BoolArray:
    """Whether each of the ``wanting`` users (user,) can use as many groups as they are, so that none is left out.

    Returns shape (batch,) for a (batch, user, subcarrier). False says nothing.
    """
    batch, users, _ = snr_per_w.shape
    count = wanting.sum()
    servable = np.ones(batch, dtype=np.bool_)
    for b in range(batch):
        for k in range(users):
            if not wanting[k]:
                continue
            usable = 0
            for g in range(start.size - 1):
                for n in range(start[g], start[g + 1]):
                    if snr_per_w[b, k, n] > 0.0:
                        usable += 1
                        break
            if usable < count:
                servable[b] = False
                break
    return servable

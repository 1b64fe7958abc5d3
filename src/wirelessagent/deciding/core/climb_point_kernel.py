"""A point of the climb of the prices: F there, its gradient and Hessian by ln w and ln μ, and what may move.

F is that of :mod:`.prices_kernel`. The Hessian leaves out the gradient on its diagonal, so it is positive semidefinite.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.ask_kernel import EFFICIENCY, LEVEL, POWER, SUM, Ask
from wirelessagent.deciding.core.bundle_kernel import HIGH, LOW, REFERENCE, SLOPE, utility
from wirelessagent.deciding.core.demand_kernel import demand, kink_of, level_bound
from wirelessagent.deciding.core.settle_kernel import set_level
from wirelessagent.deciding.core.supply_kernel import Groups, supply
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

FARTHEST = 290.0
"""Prices stay within e^±290 of 1 W per nat."""
NEAR, SAME = 1e-9, 1e-12
"""Logarithms nearer to a kink are on it, those of a start and those on the way."""
NOTHING = 1e-9
"""Share of what all rates are worth that a budget costs at least."""


class Path(NamedTuple):
    """Where a climb is bound to go.

    Attributes:
        kink: ln w at which a straight utility's demand jumps, NaN for none, shape (user,).
        figures: the temperature, relative to what a group is worth, that worth, the least ln μ, the efficiency q,
            the highest ln λ, and what a step must promise.
        free, slope, step, factor: workspace, shapes (user + 1,) thrice and (user + 1, user + 1).
    """

    kink: FloatArray
    figures: FloatArray
    free: IntArray
    slope: FloatArray
    step: FloatArray
    factor: FloatArray


class State(NamedTuple):
    """A point of the climb, and F there.

    Attributes:
        log_price: ln w of each user and ln μ, shape (user + 1,).
        gradient, hessian: of F by those, shapes (user + 1,) and (user + 1, user + 1), the lower half.
        supplied: nats of each user, shape (user,).
        rising, falling: w times the change of supply and of minus the demand with ln w, shape (user,).
        cooling: minus the change of the gradient with the logarithm of the temperature, shape (user + 1,).
        free: whether a price may move, shape (user + 1,).
        figures: what is made smaller, Φ smoothed, exact and of the shares, and Σ λ·supplied.
    """

    log_price: FloatArray
    gradient: FloatArray
    hessian: FloatArray
    supplied: FloatArray
    rising: FloatArray
    falling: FloatArray
    cooling: FloatArray
    free: BoolArray
    figures: FloatArray


RELATIVE, MEAN, LEAST, EFFICIENT, DEAREST, FLATNESS = 0, 1, 2, 3, 4, 5
VALUE, SMOOTH, EXACT, SHARED, PAID = 0, 1, 2, 3, 4


@kernel
def new_path(rows: FloatArray, log_price: FloatArray) -> Path:
    """One from the prices; those next to a kink are put on it."""
    users = rows.shape[0]
    kink = np.empty(users)
    for k in range(users):
        kink[k] = kink_of(rows[k])
        if abs(log_price[k] - kink[k]) < NEAR:
            log_price[k] = kink[k]
    size = users + 1
    return Path(
        kink, np.zeros(6), np.empty(size, dtype=np.int64), np.empty(size), np.empty(size), np.empty((size, size))
    )  # fmt: skip


@kernel
def new_state(users: int) -> State:
    """An empty one."""
    size = users + 1
    return State(
        np.zeros(size), np.empty(size), np.empty((size, size)), np.empty(users), np.empty(users), np.empty(users),
        np.empty(size), np.empty(size, dtype=np.bool_), np.zeros(5),
    )  # fmt: skip


@kernel
def budget_of(ask: Ask) -> float:
    """P of the module's docstring."""
    return 0.0 if ask.goal == POWER else ask.budget_w


@kernel
def evaluate(groups: Groups, ask: Ask, rows: FloatArray, path: Path, at: State) -> None:
    """Fill the state in at its prices."""
    users = rows.shape[0]
    log_mu = at.log_price[users]
    mu = np.exp(log_mu)
    log_lambda = np.minimum(np.maximum(at.log_price[:users] - log_mu, -FARTHEST), FARTHEST)
    relative = path.figures[RELATIVE]
    smooth, exact, shared = supply(
        groups, log_lambda, relative * path.figures[MEAN] / mu, at.supplied, at.rising, at.cooling, at.hessian,
    )  # fmt: skip
    worth = mu * (smooth + budget_of(ask))
    level = 0.0
    if ask.goal == LEVEL:
        level = level_bound(ask.share, log_lambda, float(worth), ask.most_level)
        set_level(rows, ask.share, level)
    value, paid, bought = worth, 0.0, 0.0
    for k in range(users):
        price = np.exp(log_lambda[k])
        w = mu * price
        taken, falling = demand(rows[k], at.log_price[k])
        stays = rows[k, LOW] <= 0.0 and (rows[k, SLOPE] <= 0.0 or rows[k, HIGH] <= 0.0)
        if at.log_price[k] == path.kink[k]:
            taken = min(max(at.supplied[k], rows[k, LOW]), rows[k, HIGH])
            stays = taken == at.supplied[k]
        at.free[k] = not stays
        at.gradient[k] = w * (at.supplied[k] - taken)
        at.rising[k] *= mu
        at.falling[k] = w * falling
        value += utility(rows[k], taken) - w * taken
        bought += w * taken
        paid += price * at.supplied[k]
    at.hessian[:] *= mu
    at.cooling[:] *= mu
    for k in range(users):
        at.hessian[k, k] += at.falling[k]
    at.gradient[users] = mu * (budget_of(ask) - (paid - shared))
    elastic = ask.goal == SUM or ask.goal == EFFICIENCY
    at.free[users] = elastic and (log_mu > path.figures[LEAST] + SAME or at.gradient[users] < 0.0)
    if ask.goal == LEVEL:  # beyond the highest level, how far the prices are from proving less
        value = level if level < ask.most_level else level * max(worth / max(bought, 1e-300), 1.0)
    at.figures[VALUE], at.figures[PAID] = value, paid
    at.figures[SMOOTH], at.figures[EXACT], at.figures[SHARED] = smooth, exact, shared


@kernel
def least_price(ask: Ask, rows: FloatArray) -> float:
    """ln μ at which the budget costs next to nothing. Below, F would hardly say where it falls."""
    worth = (rows[:, SLOPE] * rows[:, REFERENCE]).sum()
    if worth <= 0.0 or ask.goal == POWER or ask.goal == LEVEL:
        return -FARTHEST
    return max(float(np.log(NOTHING * worth / ask.budget_w)), -FARTHEST)


@kernel
def worth_of_group(groups: Groups, at: State) -> float:
    """What a group is worth on average, in units of F."""
    users = at.supplied.size
    mean = np.exp(at.log_price[users]) * at.figures[EXACT] / (groups.start.size - 1)
    return float(mean if mean > 0.0 else np.exp(min(at.log_price[:users].max(), FARTHEST)))


@kernel
def value_at(at: State, which: int) -> float:
    """F with another Φ than the smoothed."""
    return float(at.figures[VALUE] + np.exp(at.log_price[-1]) * (at.figures[which] - at.figures[SMOOTH]))

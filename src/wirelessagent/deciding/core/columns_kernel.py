"""What a set of columns can be worth to a user where every column has a price.

A column is one subcarrier, or a group of adjacent ones that are owned together. At the prices π ≥ 0 of columns and μ of
power a user wants the set S of columns with the most V(S; μ) − π(S) (V is that of :mod:`.bundle_kernel`). There are
2^N sets, but for any level z, with λ = μ e^z the price of the user's rate,

    V(S; μ) − π(S) ≤ U*(λ) + Σ_{j∈S} (t_j(λ) − π_j),    t_j(λ) = Σ_{n∈j} max over r ≤ c_n of λ r − μ (e^r − 1)/a_n,

U*(λ) = max over low ≤ r ≤ high of U(r) − λ r (Lagrange's multiplier of the rate). Here the columns decouple: those that
are not yet decided add at most (t_j − π_j)⁺. Depth-first branch and bound takes the smallest of these bounds over a few
levels around the one that is best before anything is decided.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import (
    CURVATURE,
    HIGH,
    LOW,
    REFERENCE,
    SLACK,
    SLOPE,
    UNREACHABLE,
    bundle,
    utility,
)
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

OFFSETS = (0.0, -0.1, 0.1, -0.25, 0.25, -0.5, 0.5, -1.0, 1.0, -2.0, 2.0, -4.0, 4.0)
"""The levels of the bounds, from the best before anything is decided."""
HALVINGS = 16
"""Of a bracket about 1 wide: any level gives a bound, and one so near the best gives nearly the best."""
HIGHEST_LEVEL = 600.0
ROUNDING = 1e-12
NOTHING = -0.5 * UNREACHABLE
"""Values below are those of sets that cannot carry what they must."""


@kernel
def conjugate(user: FloatArray, price: float) -> tuple[float, float]:
    """U*(λ) = max over low ≤ r ≤ high of U(r) − λ r, and the rate that reaches it."""
    rate = user[LOW]
    if user[SLOPE] > 0.0 and user[HIGH] > user[LOW]:
        if user[CURVATURE] > 0.0:
            wanted = user[REFERENCE] * (user[SLOPE] / price) ** (1.0 / user[CURVATURE])
            rate = min(max(wanted, user[LOW]), user[HIGH])
        elif price < user[SLOPE]:
            rate = user[HIGH]
    if rate == np.inf:
        return np.inf, rate
    return utility(user, rate) - price * rate, rate


@kernel
def column_term(
    floor: FloatArray, inverse: FloatArray, ceiling: FloatArray, first: int, last: int, level: float, top: float
) -> tuple[float, float]:
    """t/μ of the subcarriers ``first`` to ``last`` − 1 at the level z, and their nats; ``top`` is e^z."""
    term = 0.0
    nats = 0.0
    for n in range(first, last):
        depth = level - floor[n]
        if depth > 0.0 and ceiling[n] > 0.0:
            if depth >= ceiling[n]:
                term += top * ceiling[n] - np.expm1(ceiling[n]) * inverse[n]
                nats += ceiling[n]
            elif depth > 0.1:
                term += top * (depth - 1.0) + inverse[n]
                nats += depth
            else:
                term += top * (depth + np.expm1(-depth))
                nats += depth
    return term, nats


@kernel
def excess(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    level: float,
) -> float:
    """How many nats more the worthwhile columns carry at the level z than the user wants: the bound's slope in λ."""
    mu = np.exp(log_mu)
    top = np.exp(level)
    rate = -conjugate(user, mu * top)[1]
    for j in range(start.size - 1):
        term, nats = column_term(floor, inverse, ceiling, start[j], start[j + 1], level, top)
        if mu * term > price[j]:
            rate += nats
    return rate


@kernel
def is_straight(user: FloatArray) -> bool:
    """Whether the user's utility is its rate."""
    return bool(user[SLOPE] > 0.0 and user[CURVATURE] == 0.0)


@kernel
def kink(user: FloatArray, log_mu: float) -> float:
    """The level at which a nat costs what a straight utility pays for it, or just above."""
    level = np.log(user[SLOPE]) - log_mu
    level += 1e-15 * (1.0 + abs(level) + abs(log_mu))
    while np.exp(log_mu) * np.exp(level) < user[SLOPE]:
        level += 1e-15 * (1.0 + abs(level) + abs(log_mu))
    return level


@kernel
def relaxed_level(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
) -> float:
    """The level z of the smallest bound while nothing is decided, by bisection; infinite where nothing carries low."""
    lowest = np.inf
    highest = -np.inf
    capacity = 0.0
    for n in range(floor.size):
        if ceiling[n] > 0.0:
            lowest = min(lowest, floor[n])
            highest = max(highest, floor[n] + ceiling[n])
            capacity += ceiling[n]
    if capacity < user[LOW] * SLACK:
        return np.inf
    if lowest == np.inf:
        return 0.0
    least = lowest
    if is_straight(user) and user[HIGH] == np.inf:  # below it the conjugate is infinite
        least = kink(user, log_mu)
        if excess(user, floor, inverse, ceiling, start, price, log_mu, least) >= 0.0:
            return least
    low = max(least, lowest)
    step = 1.0
    high = low + step
    while high < HIGHEST_LEVEL and excess(user, floor, inverse, ceiling, start, price, log_mu, high) < 0.0:
        low = high
        step *= 2.0
        high += step
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if excess(user, floor, inverse, ceiling, start, price, log_mu, middle) < 0.0:
            low = middle
        else:
            high = middle
    return max(high, least)


@kernel
def levels_around(user: FloatArray, log_mu: float, root: float) -> FloatArray:
    """The levels of the bounds, shape (level,), the best before anything is decided first."""
    levels = np.empty(len(OFFSETS))
    least = -np.inf
    if is_straight(user) and user[HIGH] == np.inf:
        least = kink(user, log_mu)  # below it the conjugate is infinite
    for g in range(levels.size):
        levels[g] = max(root + OFFSETS[g], least)
    if is_straight(user):
        levels[-1] = kink(user, log_mu)  # the best once the promised rate is carried
    return levels


@kernel
def promising(
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    mu: float,
    level: float,
    base: float,
    least: float,
) -> IntArray:
    """The usable columns that a set worth ``least`` may hold, most worthwhile at the level z first; ``base`` is U*."""
    columns = start.size - 1
    top = np.exp(level)
    usable = np.empty(columns, dtype=np.int64)
    loss = np.empty(columns)
    count = 0
    bound = base
    for j in range(columns):
        able = False
        for n in range(start[j], start[j + 1]):
            able = able or ceiling[n] > 0.0
        if able:
            term, _ = column_term(floor, inverse, ceiling, start[j], start[j + 1], level, top)
            loss[count] = price[j] - mu * term
            bound += max(-loss[count], 0.0)
            usable[count] = j
            count += 1
    most = bound - least + ROUNDING * (abs(bound) + abs(least))
    kept = 0
    for i in range(count):
        if not loss[i] > most:
            usable[kept], loss[kept] = usable[i], loss[i]
            kept += 1
    return usable[np.argsort(loss[:kept])]


@kernel
def decoupled(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    root: float,
    least: float,
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """The columns that matter, most worthwhile first; their t − π (column, level); what is left; U*(λ) of each level.

    Those matter that a set worth ``least`` may hold. What is left at a column is Σ (t − π)⁺ over it and those after it,
    shape (column + 1, level).
    """
    mu = np.exp(log_mu)
    levels = levels_around(user, log_mu, root)
    top = np.exp(levels)
    base = np.empty(levels.size)
    for g in range(levels.size):
        base[g] = conjugate(user, mu * top[g])[0]
    order = promising(floor, inverse, ceiling, start, price, mu, levels[0], base[0], least)
    gain = np.empty((order.size, levels.size))
    left = np.zeros((order.size + 1, levels.size))
    for i in range(order.size - 1, -1, -1):
        j = int(order[i])
        for g in range(levels.size):
            term, _ = column_term(floor, inverse, ceiling, start[j], start[j + 1], levels[g], top[g])
            gain[i, g] = mu * term - price[j]
            left[i, g] = left[i + 1, g] + max(gain[i, g], 0.0)
    return order, gain, left, base


@kernel
def worths(
    users: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    log_mu: float,
    owner: IntArray,
    first: IntArray,
    member: IntArray,
    work: IntArray,
) -> tuple[FloatArray, FloatArray]:
    """V(S; μ) and the power in W of every set of a list, both (set,); without time the rest counts as nothing."""
    value = np.empty(owner.size)
    power = np.empty(owner.size)
    subcarriers = floor.shape[1]
    set_floor, set_inverse, set_ceiling = np.empty(subcarriers), np.empty(subcarriers), np.empty(subcarriers)
    scratch, scratch_cap = np.empty(subcarriers), np.empty(subcarriers)
    for s in range(owner.size):
        if is_over(work):
            value[s:], power[s:] = 4.0 * NOTHING, 0.0
            break
        k = owner[s]
        size = 0
        for i in range(first[s], first[s + 1]):
            for n in range(start[member[i]], start[member[i] + 1]):
                if ceiling[k, n] > 0.0:
                    set_floor[size], set_inverse[size], set_ceiling[size] = floor[k, n], inverse[k, n], ceiling[k, n]
                    size += 1
        value[s], _, power[s], _ = bundle(
            users[k], set_floor, set_inverse, set_ceiling, size, log_mu, scratch, scratch_cap
        )  # fmt: skip
    return value, power


@kernel
def middle_terms(
    floor: FloatArray, inverse: FloatArray, ceiling: FloatArray, start: IntArray, log_rate_price: FloatArray
) -> FloatArray:
    """Half way between the largest t_j/μ of any user and the next, (column,), a nat of user k costing e^λ_k W."""
    price = np.zeros(start.size - 1)
    next_price = np.zeros(start.size - 1)
    for k in range(floor.shape[0]):
        top = np.exp(log_rate_price[k])
        for j in range(price.size):
            term, _ = column_term(
                floor[k], inverse[k], ceiling[k], start[j], start[j + 1], log_rate_price[k], top
            )  # fmt: skip
            if term > price[j]:
                price[j], next_price[j] = term, price[j]
            elif term > next_price[j]:
                next_price[j] = term
    return 0.5 * (price + next_price)


@kernel
def spread(
    users: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    log_mu: float,
    owner: IntArray,
) -> FloatArray:
    """The power in W on every subcarrier, (subcarrier,), where ``owner`` (column,) has the columns, −1 for nobody."""
    subcarriers = floor.shape[1]
    power = np.zeros(subcarriers)
    held = np.empty(subcarriers, dtype=np.int64)
    set_floor, set_inverse, set_ceiling = np.empty(subcarriers), np.empty(subcarriers), np.empty(subcarriers)
    scratch, scratch_cap = np.empty(subcarriers), np.empty(subcarriers)
    for k in range(users.shape[0]):
        size = 0
        for j in range(owner.size):
            for n in range(start[j], start[j + 1]):
                if owner[j] == k and ceiling[k, n] > 0.0:
                    set_floor[size], set_inverse[size], set_ceiling[size] = floor[k, n], inverse[k, n], ceiling[k, n]
                    held[size] = n
                    size += 1
        level = bundle(users[k], set_floor, set_inverse, set_ceiling, size, log_mu, scratch, scratch_cap)[3]
        for i in range(size):
            depth = min(level - set_floor[i], set_ceiling[i])
            if depth > 0.0:
                power[held[i]] = np.expm1(depth) * set_inverse[i]
    return power

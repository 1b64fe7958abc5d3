"""The sets of subcarriers that are best for a user where every column has a price, and all that are nearly so.

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
    best_level,
    bundle,
    fill_level,
    utility,
)
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

OFFSETS = (0.0, -0.1, 0.1, -0.25, 0.25, -0.5, 0.5, -1.0, 1.0, -2.0, 2.0, -4.0, 4.0)
"""The levels of the bounds, from the best before anything is decided."""
HALVINGS = 30
HIGHEST_LEVEL = 600.0
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
def relaxed_level(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
) -> float:
    """The level z of the smallest bound before anything is decided, by bisection; infinite where nothing carries low."""
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
    if user[SLOPE] > 0.0 and user[CURVATURE] == 0.0 and user[HIGH] == np.inf:
        least = np.log(user[SLOPE]) - log_mu  # below it the conjugate is infinite
        least += 1e-15 * (1.0 + abs(least) + abs(log_mu))
        while np.exp(log_mu) * np.exp(least) < user[SLOPE]:
            least += 1e-15 * (1.0 + abs(least) + abs(log_mu))
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
def decoupled(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    root: float,
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """The usable columns, most worthwhile first, with their t − π (column, level) and what is left of them from there on.

    Also U*(λ) of each level. What is left is Σ (t − π)⁺ over this column and those after it, shape (column + 1, level).
    """
    columns = start.size - 1
    levels = len(OFFSETS)
    mu = np.exp(log_mu)
    base = np.empty(levels)
    used = np.empty(levels)
    least = -np.inf
    if user[SLOPE] > 0.0 and user[CURVATURE] == 0.0 and user[HIGH] == np.inf:
        least = root  # below it the conjugate may be infinite
    for g in range(levels):
        used[g] = max(root + OFFSETS[g], least)
        base[g] = conjugate(user, mu * np.exp(used[g]))[0]
    usable = np.empty(columns, dtype=np.int64)
    worth = np.empty(columns)
    count = 0
    for j in range(columns):
        able = False
        for n in range(start[j], start[j + 1]):
            able = able or ceiling[n] > 0.0
        if able:
            usable[count] = j
            term, _ = column_term(floor, inverse, ceiling, start[j], start[j + 1], used[0], np.exp(used[0]))
            worth[count] = price[j] - mu * term
            count += 1
    order = usable[np.argsort(worth[:count])]
    gain = np.empty((count, levels))
    left = np.zeros((count + 1, levels))
    for i in range(count - 1, -1, -1):
        j = order[i]
        for g in range(levels):
            term, _ = column_term(floor, inverse, ceiling, start[j], start[j + 1], used[g], np.exp(used[g]))
            gain[i, g] = mu * term - price[j]
            left[i, g] = left[i + 1, g] + max(gain[i, g], 0.0)
    return order, gain, left, base


@kernel
def power_level(floor: FloatArray, inverse: FloatArray, ceiling: FloatArray, size: int, power_w: float) -> float:
    """The level that the first ``size`` subcarriers reach with ``power_w``; infinite where a ceiling is in the way."""
    level = -np.inf
    wet = np.inf
    while True:
        total = power_w
        count = 0
        for i in range(size):
            if floor[i] < wet:
                total += inverse[i]
                count += 1
        if count == 0:
            return np.inf
        level = np.log(total / count)
        settled = True
        for i in range(size):
            settled = settled and not level <= floor[i] < wet
        wet = level
        if settled:
            break
    for i in range(size):
        if level - floor[i] > ceiling[i]:
            return np.inf
    return level


@kernel
def wet_level(
    wettest: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    size: int,
    log_mu: float,
    budget_w: float,
    scratch: FloatArray,
    scratch_cap: FloatArray,
) -> float:
    """A level that a set never exceeds at prices of power from e^``log_mu`` on, within the budget."""
    if size == 0:
        return np.inf
    level = np.inf
    if log_mu > -np.inf:
        level = best_level(wettest, floor, ceiling, size, log_mu, scratch, scratch_cap)
    elif wettest[HIGH] < np.inf:
        level = fill_level(floor, ceiling, size, wettest[HIGH], scratch, scratch_cap)
    if budget_w < np.inf:
        level = min(level, power_level(floor, inverse, ceiling, size, budget_w))
    return level


@kernel
def is_full(floor: FloatArray, ceiling: FloatArray, size: int, level: float) -> bool:
    """Whether the first ``size`` subcarriers all carry the most that they can at the level z, but for rounding."""
    for i in range(size):
        if level - floor[i] < ceiling[i] * (1.0 - 1e-9):
            return False
    return True


@kernel
def explore(
    user: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    least: float,
    tolerance: float,
    wettest: FloatArray,
    least_log_mu: float,
    budget_w: float,
    most_nodes: int,
    most_sets: int,
) -> tuple[float, float, int, IntArray, IntArray]:
    """Branch and bound for one user; see :func:`best_bundles` and :func:`bundles_within`, which call it.

    With ``tolerance`` ≥ 0 only sets that are better by more than that than the best so far are looked for, and the last
    one is the answer; with a negative one all that reach ``least`` are. Returns the best value, a bound on all values,
    how many sets there are (−1 − that where it gave up), and the sets: where each begins, and their columns.
    """
    first = np.zeros(17, dtype=np.int64)
    member = np.empty(64, dtype=np.int64)
    sets = 0
    best = least
    root = relaxed_level(user, floor, inverse, ceiling, start, price, log_mu)
    if root == np.inf:
        return NOTHING, NOTHING, 0, first, member
    order, gain, left, base = decoupled(user, floor, inverse, ceiling, start, price, log_mu, root)
    subcarriers = floor.size
    columns = order.size
    levels = base.size
    set_floor, set_inverse, set_ceiling = np.empty(subcarriers), np.empty(subcarriers), np.empty(subcarriers)
    scratch, scratch_cap = np.empty(subcarriers), np.empty(subcarriers)
    bottom = np.full(columns, np.inf)
    for i in range(columns):
        for n in range(start[order[i]], start[order[i] + 1]):
            if ceiling[n] > 0.0:
                bottom[i] = min(bottom[i], floor[n])
    position = np.zeros(columns + 1, dtype=np.int64)
    size = np.zeros(columns + 1, dtype=np.int64)
    chosen = np.empty(columns + 1, dtype=np.int64)
    spent = np.zeros(columns + 1)
    wet = np.full(columns + 1, np.inf)
    driest = np.full(columns + 1, -np.inf)
    gained = np.empty((columns + 1, levels))
    gained[0] = base
    depth = 0
    nodes = 0
    value = bundle(user, set_floor, set_inverse, set_ceiling, 0, log_mu, scratch, scratch_cap)[0]
    fresh = True
    while True:
        net = value - spent[depth]
        if fresh and net > NOTHING and (net > best + tolerance if tolerance >= 0.0 else net >= least):
            best = max(best, net)
            if tolerance >= 0.0:
                sets = 0
            if sets == most_sets:
                return best, (base + left[0]).min(), -1 - sets, first, member
            if sets + 2 > first.size:
                first = np.concatenate((first, np.empty(first.size, dtype=np.int64)))
            while first[sets] + depth > member.size:
                member = np.concatenate((member, np.empty(member.size, dtype=np.int64)))
            for i in range(depth):
                member[first[sets] + i] = order[chosen[i]]
            first[sets + 1] = first[sets] + depth
            sets += 1
        i = position[depth]
        reachable = False
        if i < columns:
            bound = np.inf
            for g in range(levels):
                bound = min(bound, gained[depth, g] + left[i, g])
            reachable = bound > best + tolerance if tolerance >= 0.0 else bound >= least
        if not reachable:
            if depth == 0:
                break
            depth -= 1
            fresh = False
            continue
        position[depth] = i + 1
        fresh = False
        if bottom[i] >= wet[depth]:
            continue  # here and in all larger sets it would get no power
        nodes += 1
        if nodes > most_nodes:
            return best, (base + left[0]).min(), -1 - sets, first, member
        filled = size[depth]
        for n in range(start[order[i]], start[order[i] + 1]):
            if ceiling[n] > 0.0:
                set_floor[filled], set_inverse[filled], set_ceiling[filled] = floor[n], inverse[n], ceiling[n]
                filled += 1
        value, _, _, level = bundle(
            user, set_floor, set_inverse, set_ceiling, filled, log_mu, scratch, scratch_cap
        )  # fmt: skip
        if tolerance < 0.0:
            level = wet_level(
                wettest, set_floor, set_inverse, set_ceiling, filled, least_log_mu, budget_w, scratch, scratch_cap
            )  # fmt: skip
        if value <= NOTHING or is_full(set_floor, set_ceiling, filled, level):
            level = np.inf  # more columns are of use however high their floors
        if max(driest[depth], bottom[i]) >= level:
            continue
        chosen[depth] = i
        depth += 1
        driest[depth] = max(driest[depth - 1], bottom[i])
        wet[depth] = level
        spent[depth] = spent[depth - 1] + price[order[i]]
        size[depth] = filled
        position[depth] = i + 1
        for g in range(levels):
            gained[depth, g] = gained[depth - 1, g] + gain[i, g]
        fresh = True
    return best, max(best, least) + max(tolerance, 0.0), sets, first, member


@kernel
def best_bundles(
    users: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    tolerance: float,
    most_nodes: int,
    bound: FloatArray,
) -> tuple[FloatArray, IntArray, IntArray]:
    """For every user the set of columns with the most V(S; μ) − π(S), to within ``tolerance``.

    Args:
        users: rows of six, shape (user, 6).
        floor, inverse, ceiling: −ln a, 1/a and the most nats, shape (user, subcarrier); a ceiling of 0 where a pair
            may not be used.
        start: where each column begins, and the number of subcarriers, shape (column + 1,).
        price: π ≥ 0, shape (column,).
        log_mu: ln μ.
        tolerance: at least 0.
        most_nodes: sets to look at per user at most; where that is not enough the bound is weaker.
        bound: written, shape (user,): no set is worth more.

    Returns:
        What the sets are worth (user,); where each set begins in the list of their columns (user + 1,); that list.
    """
    number = users.shape[0]
    worth = np.empty(number)
    first = np.zeros(number + 1, dtype=np.int64)
    member = np.empty(4 * number, dtype=np.int64)
    for k in range(number):
        worth[k], bound[k], count, begin, found = explore(
            users[k], floor[k], inverse[k], ceiling[k], start, price, log_mu, 4.0 * NOTHING, tolerance,
            users[k], log_mu, np.inf, most_nodes, 1,
        )  # fmt: skip
        held = 0 if count == 0 else begin[1]
        while first[k] + held > member.size:
            member = np.concatenate((member, np.empty(member.size, dtype=np.int64)))
        member[first[k] : first[k] + held] = found[:held]
        first[k + 1] = first[k] + held
    return worth, first, member[: first[number]]


@kernel
def bundles_within(
    users: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    least: FloatArray,
    wettest: FloatArray,
    least_log_mu: float,
    budget_w: float,
    most_nodes: int,
    most_sets: int,
) -> tuple[bool, IntArray, IntArray, IntArray]:
    """All sets with V(S; μ) − π(S) ≥ ``least`` (user,), but none with a column that gets no power whatever happens.

    What may happen is that a user's row becomes that of ``wettest``, and that power costs anything from
    e^``least_log_mu`` on, within ``budget_w``. Otherwise as :func:`best_bundles`, with ``most_sets`` per user at most.

    Returns:
        Whether these are all; the user of each set; where each begins in the list of their columns; that list.
    """
    complete = True
    owner = np.empty(64, dtype=np.int64)
    first = np.zeros(65, dtype=np.int64)
    member = np.empty(256, dtype=np.int64)
    total = 0
    for k in range(users.shape[0]):
        _, _, count, begin, found = explore(
            users[k], floor[k], inverse[k], ceiling[k], start, price, log_mu, least[k], -1.0,
            wettest[k], least_log_mu, budget_w, most_nodes, most_sets,
        )  # fmt: skip
        if count < 0:
            complete = False
            count = -1 - count
        while total + count > owner.size:
            owner = np.concatenate((owner, np.empty(owner.size, dtype=np.int64)))
            first = np.concatenate((first, np.empty(owner.size + 1 - first.size, dtype=np.int64)))
        held = begin[count]
        while first[total] + held > member.size:
            member = np.concatenate((member, np.empty(member.size, dtype=np.int64)))
        member[first[total] : first[total] + held] = found[:held]
        for s in range(count):
            owner[total + s] = k
            first[total + s + 1] = first[total] + begin[s + 1]
        total += count
    return complete, owner[:total], first[: total + 1], member[: first[total]]


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
) -> tuple[FloatArray, FloatArray]:
    """V(S; μ) and the power in W of every set of a list, both (set,)."""
    value = np.empty(owner.size)
    power = np.empty(owner.size)
    subcarriers = floor.shape[1]
    set_floor, set_inverse, set_ceiling = np.empty(subcarriers), np.empty(subcarriers), np.empty(subcarriers)
    scratch, scratch_cap = np.empty(subcarriers), np.empty(subcarriers)
    for s in range(owner.size):
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
def dearest(
    floor: FloatArray, inverse: FloatArray, ceiling: FloatArray, start: IntArray, log_rate_price: FloatArray
) -> FloatArray:
    """The largest t_j/μ of any user for each column, (column,), where a nat of user k costs e^``log_rate_price`` W."""
    price = np.zeros(start.size - 1)
    for k in range(floor.shape[0]):
        top = np.exp(log_rate_price[k])
        for j in range(price.size):
            term, _ = column_term(
                floor[k], inverse[k], ceiling[k], start[j], start[j + 1], log_rate_price[k], top
            )  # fmt: skip
            price[j] = max(price[j], term)
    return price

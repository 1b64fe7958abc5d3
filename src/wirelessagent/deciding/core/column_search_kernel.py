"""The best sets of priced columns for a user, and all that are nearly as good, by depth-first branch and bound.

The bounds are those of :mod:`.columns_kernel`: no set is worth more than the smallest of its levels says.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import HIGH, best_level, bundle, fill_level
from wirelessagent.deciding.core.columns_kernel import NOTHING, decoupled, relaxed_level
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray


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
    full = True
    for i in range(size):
        full = full and level - floor[i] >= ceiling[i] * (1.0 - 1e-9)
    return full


class Path(NamedTuple):
    """The columns taken on the way to a node, and what is known at each depth; all of shape (column + 1,) at least.

    Attributes:
        position: the next column to try.
        chosen: the column taken last.
        size: subcarriers held.
        spent: π of the columns taken.
        wet, driest: the level that the set never exceeds, and the highest floor in it.
        gained: Σ (t − π) over the columns taken and U*, shape (column + 1, level).
    """

    position: IntArray
    chosen: IntArray
    size: IntArray
    spent: FloatArray
    wet: FloatArray
    driest: FloatArray
    gained: FloatArray


@kernel
def path_from(base: FloatArray, columns: int) -> Path:
    """The path before anything is taken; ``base`` is U* of each level."""
    gained = np.empty((columns + 1, base.size))
    gained[0] = base
    return Path(
        np.zeros(columns + 1, dtype=np.int64),
        np.empty(columns + 1, dtype=np.int64),
        np.zeros(columns + 1, dtype=np.int64),
        np.zeros(columns + 1),
        np.full(columns + 1, np.inf),
        np.full(columns + 1, -np.inf),
        gained,
    )


@kernel
def bottoms(floor: FloatArray, ceiling: FloatArray, start: IntArray, order: IntArray) -> FloatArray:
    """The lowest usable floor of each column in ``order``."""
    bottom = np.full(order.size, np.inf)
    for i in range(order.size):
        for n in range(start[order[i]], start[order[i] + 1]):
            if ceiling[n] > 0.0:
                bottom[i] = min(bottom[i], floor[n])
    return bottom


@kernel
def least_sum(one: FloatArray, other: FloatArray) -> float:
    """The smallest of the sums of two rows."""
    least = np.inf
    for g in range(one.size):
        least = min(least, one[g] + other[g])
    return least


@kernel
def listed(
    first: IntArray, member: IntArray, sets: int, order: IntArray, chosen: IntArray, depth: int
) -> tuple[IntArray, IntArray]:
    """The list of sets with one more at place ``sets``, grown where it must be."""
    if sets + 2 > first.size:
        first = np.concatenate((first, np.empty(first.size, dtype=np.int64)))
    while first[sets] + depth > member.size:
        member = np.concatenate((member, np.empty(member.size, dtype=np.int64)))
    for i in range(depth):
        member[first[sets] + i] = order[chosen[i]]
    first[sets + 1] = first[sets] + depth
    return first, member


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
    work: IntArray,
) -> tuple[float, float, int, IntArray, IntArray]:
    """Branch and bound for one user; see :func:`best_bundles` and :func:`bundles_within`, which call it.

    With ``tolerance`` ≥ 0 only sets that are better by more than that than the best so far are looked for, and the last
    one is the answer; with a negative one all that reach ``least`` are. Returns the best value, a bound on all values,
    how many sets there are (−1 − that where it gave up), and the sets: where each begins, and their columns.
    """
    first, member = np.zeros(17, dtype=np.int64), np.empty(64, dtype=np.int64)
    sets, nodes, depth = 0, 0, 0
    best = least
    if is_over(work):
        return 4.0 * NOTHING, np.inf, -1, first, member
    root = relaxed_level(user, floor, inverse, ceiling, start, price, log_mu)
    if root == np.inf:
        return NOTHING, NOTHING, 0, first, member
    order, gain, left, base = decoupled(user, floor, inverse, ceiling, start, price, log_mu, root, least)
    bottom = bottoms(floor, ceiling, start, order)
    path = path_from(base, order.size)
    set_floor, set_inverse, set_ceiling = np.empty(floor.size), np.empty(floor.size), np.empty(floor.size)
    scratch, scratch_cap = np.empty(floor.size), np.empty(floor.size)
    value = bundle(user, set_floor, set_inverse, set_ceiling, 0, log_mu, scratch, scratch_cap)[0]
    fresh = True
    while True:
        net = value - path.spent[depth]
        if fresh and net > NOTHING and (net > best + tolerance if tolerance >= 0.0 else net >= least):
            best = max(best, net)
            if tolerance >= 0.0:
                sets = 0
            if sets == most_sets:
                break
            first, member = listed(first, member, sets, order, path.chosen, depth)
            sets += 1
        fresh = False
        i = path.position[depth]
        reachable = False
        if i < order.size:
            bound = least_sum(path.gained[depth], left[i])
            reachable = bound > best + tolerance if tolerance >= 0.0 else bound >= least
        if not reachable:
            if depth == 0:
                return best, max(best, least) + max(tolerance, 0.0), sets, first, member
            depth -= 1
            continue
        if bottom[i] >= path.wet[depth]:
            path.position[depth] = i + 1
            continue  # here and in all larger sets it would get no power
        nodes += 1
        if nodes > most_nodes or is_over(work):
            break
        path.position[depth] = i + 1
        filled = path.size[depth]
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
        driest = max(path.driest[depth], bottom[i])
        if driest >= level:
            continue
        path.chosen[depth] = i
        depth += 1
        path.position[depth], path.size[depth] = i + 1, filled
        path.driest[depth], path.wet[depth] = driest, level
        path.spent[depth] = path.spent[depth - 1] + price[order[i]]
        for g in range(base.size):
            path.gained[depth, g] = path.gained[depth - 1, g] + gain[i, g]
        fresh = True
    bound = best + max(tolerance, 0.0)
    for d in range(depth + 1):  # what was left open
        bound = max(bound, least_sum(path.gained[d], left[path.position[d]]))
    return best, bound, -1 - sets, first, member


@kernel
def best_bundles(
    users: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    ceiling: FloatArray,
    start: IntArray,
    price: FloatArray,
    log_mu: float,
    least: FloatArray,
    tolerance: float,
    most_nodes: int,
    bound: FloatArray,
    work: IntArray,
) -> tuple[FloatArray, IntArray, IntArray]:
    """For every user the set of columns with the most V(S; μ) − π(S), to within ``tolerance``.

    Args:
        users: rows of six, shape (user, 6).
        floor, inverse, ceiling: −ln a, 1/a and the most nats, shape (user, subcarrier); a ceiling of 0 where a pair
            may not be used.
        start: where each column begins, and the number of subcarriers, shape (column + 1,).
        price: π ≥ 0, shape (column,).
        log_mu: ln μ.
        least: shape (user,); sets that are worth no more than that are of no interest.
        tolerance: at least 0.
        most_nodes: sets to look at per user at most; where that is not enough the bound is weaker.
        bound: written, shape (user,): no set is worth more.
        work: steps done and to do; see :mod:`.work_kernel`.

    Returns:
        What the sets are worth (user,), less than ``NOTHING`` where there is none of interest; where each set begins in
        the list of their columns (user + 1,); that list.
    """
    number = users.shape[0]
    worth = np.empty(number)
    first = np.zeros(number + 1, dtype=np.int64)
    member = np.empty(4 * number, dtype=np.int64)
    for k in range(number):
        worth[k], bound[k], count, begin, found = explore(
            users[k], floor[k], inverse[k], ceiling[k], start, price, log_mu, least[k], tolerance,
            users[k], log_mu, np.inf, most_nodes, 1, work,
        )  # fmt: skip
        held = begin[1]
        if count == 0 or count == -1:
            held, worth[k] = 0, 4.0 * NOTHING
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
    work: IntArray,
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
            wettest[k], least_log_mu, budget_w, most_nodes, most_sets, work,
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

"""Sets of subcarriers, one per user, and what they are worth at a price of power.

The state of a search is which user owns each group of subcarriers. At a price of power μ the users' worths V_k(S_k; μ)
(see :mod:`.bundle_kernel`) add up. Where all subcarriers of a set carry something and none is full, V comes from sums
over the set, which makes it cheap to ask what a set is worth without one group and with another.

At its level z a user's rate has the price μ e^z, and by Lagrange's bound no change of its set gains more than the
groups' terms at that price, t_g = μ Σ over n in g of max over r of e^z r − (e^r − 1)/a_n, which need no exponential:

    V(S') ≤ V(S) + Σ over S' \\ S of t_g − Σ over S \\ S' of t_g.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import (
    BASE,
    CURVATURE,
    HIGH,
    LOW,
    MOST_POWER,
    REFERENCE,
    SHALLOW,
    SLOPE,
    UNREACHABLE,
    bundle,
    wet_bundle,
)
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

FLOOR, INVERSE, CEILING, FULL, TERM = range(5)
"""Layers of ``pair``."""
WORTH, RATE, SPENT, WATER, SIZE, FLOORS, INVERSES, DRY, WET = range(6, 15)
LOG_PRICE, PRICE, WANTED, LOG_BEST, SCALE = range(15, 20)
"""Columns of ``user``, after those of its row."""
OWNER, CHECKED, START = range(3)
"""Rows of ``group``."""
COUNT, CHANGED, MEMBERS = range(3)
"""Columns of ``member``; those from ``MEMBERS`` on list the groups."""
BEYOND = 4.0 * UNREACHABLE
"""More than any set can be worth to a user who lacks a rate that it must have."""
NONE = -1


class Channel(NamedTuple):
    """The channel as the kernels read it.

    Attributes:
        floor, inverse, ceiling: ln(â/a), â/a and the most nats, shape (user, subcarrier), â the user's largest a; ∞, 0
            and 0 where a is 0. Levels measured from a user's best subcarrier keep their digits where rates are tiny.
        log_best: ln â of each user, shape (user,); 0 where there is none.
        pair: all of it as the search reads it; see :class:`Sets`.
    """

    floor: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    log_best: FloatArray
    pair: FloatArray


class Sets(NamedTuple):
    """Who owns what, and what is known of its worth; few arrays, because each costs time wherever they are handed on.

    Attributes:
        pair: the floor, the inverse and the ceiling of :class:`Channel`, (e^ceiling − 1) â/a (infinite without a
            ceiling), shape (5, user, subcarrier), and in the last layer for each group the term of the module's
            docstring at the level of the user's set.
        user: a row for each user: the six of :mod:`.bundle_kernel`; of its set the worth V, the rate, the power and the
            level that reach it; the number of subcarriers, Σ −ln a, Σ 1/a, and the levels between which none is shallow
            or full; ln μ, μ and the level at which a straight utility has enough; all in units of â; ln â and 1/â.
            Shape (user, 20).
        member: of each user's set the number of groups, when it last changed, and the groups, shape (user, group + 2).
        group: the owner, −1 for nobody, when it was last seen to be the best, and the first subcarrier of each group,
            shape (3, group + 1); the time now is the second of the last.
        room: workspace for one set, shape (5, subcarrier).
        work: steps done and to do; see :mod:`.work_kernel`.
    """

    pair: FloatArray
    user: FloatArray
    member: IntArray
    group: IntArray
    room: FloatArray
    work: IntArray


@kernel
def none() -> int:
    """−1, which stands for no group and nobody: Numba would compile each function once more for the literal."""
    return int(np.int64(NONE))


@kernel
def empty_sets(channel: Channel, start: IntArray, rows: FloatArray, work: IntArray) -> Sets:
    """Sets that own nothing yet, their worth unknown."""
    groups, (users, subcarriers) = start.size - 1, channel.floor.shape
    user = np.empty((users, 20))
    member = np.empty((users, groups + MEMBERS), dtype=np.int64)
    group = np.empty((3, groups + 1), dtype=np.int64)
    for k in range(users):
        for i in range(6):
            user[k, i] = rows[k, i]
        user[k, LOG_BEST] = channel.log_best[k]
        user[k, SCALE] = np.exp(-channel.log_best[k])
        member[k, COUNT] = 0
        member[k, CHANGED] = 0
    for g in range(groups + 1):
        group[OWNER, g] = NONE
        group[CHECKED, g] = 0
        group[START, g] = start[g]
    return Sets(channel.pair, user, member, group, np.empty((5, subcarriers)), work)


@kernel
def quick_worth(pair: FloatArray, user: FloatArray, group: IntArray, k: int, skipped: int, added: int) -> float:
    """V of a user's set, without one group and with another (−1 for none), from the sums over it.

    NaN where they are not enough: where a subcarrier is dry or full, and for curved utilities.
    """
    size, floors, inverses = user[k, SIZE], user[k, FLOORS], user[k, INVERSES]
    lowest, highest = user[k, DRY], user[k, WET]
    if skipped >= 0:
        for n in range(group[START, skipped], group[START, skipped + 1]):
            if pair[CEILING, k, n] > 0.0:
                size -= 1.0
                floors -= pair[FLOOR, k, n]
                inverses -= pair[INVERSE, k, n]
    if added >= 0:
        for n in range(group[START, added], group[START, added + 1]):
            if pair[CEILING, k, n] > 0.0:
                size += 1.0
                floors += pair[FLOOR, k, n]
                inverses += pair[INVERSE, k, n]
                lowest = max(lowest, pair[FLOOR, k, n] + SHALLOW)
                highest = min(highest, pair[FLOOR, k, n] + pair[CEILING, k, n])
    if size == 0.0 or (user[k, CURVATURE] > 0.0 and user[k, LOW] < user[k, HIGH]):
        return np.nan
    rate = user[k, LOW]
    if user[k, SLOPE] > 0.0 and rate < user[k, HIGH]:
        rate = min(max(size * user[k, WANTED] - floors, rate), user[k, HIGH])
    level = (rate + floors) / size
    power = size * np.exp(level) - inverses
    if not (lowest < level <= highest and rate > 0.0 and power < MOST_POWER):
        return np.nan
    return user[k, BASE] + user[k, SLOPE] * (rate - user[k, REFERENCE]) - user[k, PRICE] * power


@kernel
def gather(sets: Sets, k: int, skipped: int, added: int) -> int:
    """Write the floors, inverses and ceilings of a user's set, without one group and with another; how many."""
    pair, member, group, room = sets.pair, sets.member, sets.group, sets.room
    count = member[k, COUNT]
    size = 0
    for i in range(count + 1):
        g = member[k, MEMBERS + i] if i < count else added
        if g < 0 or (g == skipped and i < count):
            continue
        for n in range(group[START, g], group[START, g + 1]):
            if pair[CEILING, k, n] > 0.0:
                room[0, size] = pair[FLOOR, k, n]
                room[1, size] = pair[INVERSE, k, n]
                room[2, size] = pair[CEILING, k, n]
                size += 1
    return size


@kernel
def set_bundle(sets: Sets, k: int, skipped: int, added: int) -> tuple[float, float, float, float]:
    """Worth, rate, power and level of a user's set, without one group and with another (−1 for none)."""
    user, room = sets.user, sets.room
    size = gather(sets, k, skipped, added)
    if size > 0 and user[k, CURVATURE] > 0.0:
        floors, inverses, highest, fullest = 0.0, 0.0, -np.inf, np.inf
        for i in range(size):
            floors += room[0, i]
            inverses += room[1, i]
            highest = max(highest, room[0, i])
            fullest = min(fullest, room[0, i] + room[2, i])
        found = wet_bundle(
            user[k], float(size), floors, inverses, highest + SHALLOW, fullest, user[k, LOG_PRICE], user[k, PRICE]
        )
        if not np.isnan(found[0]):
            return found
    return bundle(user[k], room[0], room[1], room[2], size, user[k, LOG_PRICE], room[3], room[4])


@kernel
def worth_of(sets: Sets, k: int, skipped: int, added: int) -> float:
    """V of a user's set, without one group and with another (−1 for none)."""
    worth = quick_worth(sets.pair, sets.user, sets.group, k, skipped, added)
    return set_bundle(sets, k, skipped, added)[0] if np.isnan(worth) else worth


@kernel
def sum_up(sets: Sets, k: int) -> None:
    """Write the sums of a user's set."""
    pair, user, member, group = sets.pair, sets.user, sets.member, sets.group
    size, floors, inverses = 0.0, 0.0, 0.0
    highest, fullest = -np.inf, np.inf
    for i in range(MEMBERS, MEMBERS + member[k, COUNT]):
        g = member[k, i]
        for n in range(group[START, g], group[START, g + 1]):
            if pair[CEILING, k, n] > 0.0:
                size += 1.0
                floors += pair[FLOOR, k, n]
                inverses += pair[INVERSE, k, n]
                highest = max(highest, pair[FLOOR, k, n])
                fullest = min(fullest, pair[FLOOR, k, n] + pair[CEILING, k, n])
    user[k, SIZE], user[k, FLOORS], user[k, INVERSES] = size, floors, inverses
    user[k, DRY], user[k, WET] = highest + SHALLOW, fullest


@kernel
def evaluate(sets: Sets, k: int) -> None:
    """Write the worth, rate, power and level of a user's set from its sums and its price of power."""
    user = sets.user
    worth, rate, power, level = np.nan, 0.0, 0.0, 0.0
    if user[k, SIZE] > 0.0:
        worth, rate, power, level = wet_bundle(
            user[k], user[k, SIZE], user[k, FLOORS], user[k, INVERSES], user[k, DRY], user[k, WET],
            user[k, LOG_PRICE], user[k, PRICE],
        )  # fmt: skip
    if np.isnan(worth):
        worth, rate, power, level = set_bundle(sets, k, none(), none())
    user[k, WORTH], user[k, RATE], user[k, SPENT], user[k, WATER] = worth, rate, power, level


@kernel
def write_terms(pair: FloatArray, user: FloatArray, member: IntArray, group: IntArray, k: int) -> None:
    """Write the terms of a user's groups at the level of its set."""
    level, price = user[k, WATER], user[k, PRICE]
    wanting = user[k, WORTH] <= -UNREACHABLE
    if user[k, SIZE] == 0.0 and user[k, SLOPE] > 0.0 and user[k, HIGH] > 0.0 and not wanting:
        level = user[k, WANTED]
        wanting = user[k, CURVATURE] > 0.0
    groups, subcarriers = group.shape[1] - 1, pair.shape[2]
    if wanting:
        for g in range(groups):
            pair[TERM, k, g] = BEYOND if group[OWNER, g] != k else 0.0
        return
    top = np.exp(level)
    for n in range(subcarriers):
        rate = min(level - pair[FLOOR, k, n], pair[CEILING, k, n])
        term = price * (top * rate - min(top - pair[INVERSE, k, n], pair[FULL, k, n]))
        pair[TERM, k, n] = term if rate > 0.0 else 0.0
    if groups < subcarriers:
        for g in range(groups):
            total = 0.0
            for n in range(group[START, g], group[START, g + 1]):
                total += pair[TERM, k, n]
            pair[TERM, k, g] = total


@kernel
def value_set(sets: Sets, k: int) -> None:
    """Note that a user's set has changed, and what it is worth."""
    sum_up(sets, k)
    evaluate(sets, k)
    write_terms(sets.pair, sets.user, sets.member, sets.group, k)
    group = sets.group
    last = group.shape[1] - 1
    group[CHECKED, last] += 1
    sets.member[k, CHANGED] = group[CHECKED, last]


@kernel
def value_changed(sets: Sets, since: int) -> None:
    """:func:`value_set` for all users whose sets were handed something, or lost it, after ``since``."""
    member = sets.member
    for k in range(member.shape[0]):
        if member[k, CHANGED] > since:
            value_set(sets, k)


@kernel
def set_price(user: FloatArray, log_mu: float) -> None:
    """Take over a price of power; worths are not worked out."""
    for k in range(user.shape[0]):
        user[k, LOG_PRICE] = log_mu - user[k, LOG_BEST]
        user[k, PRICE] = np.exp(user[k, LOG_PRICE])
        user[k, WANTED] = np.log(user[k, SLOPE]) - user[k, LOG_PRICE] if user[k, SLOPE] > 0.0 else -np.inf


@kernel
def value_all(sets: Sets, log_mu: float) -> float:
    """Work out the worths of all sets at a price; their sum."""
    set_price(sets.user, log_mu)
    for k in range(sets.user.shape[0]):
        value_set(sets, k)
    return total_worth(sets.user)


@kernel
def total_worth(user: FloatArray) -> float:
    """The sum of the sets' worths."""
    total = 0.0
    for k in range(user.shape[0]):
        total += user[k, WORTH]
    return total


@kernel
def assign(sets: Sets, owner: IntArray) -> None:
    """Take over the owners (group,); worths are not worked out."""
    member = sets.member
    for k in range(member.shape[0]):
        member[k, COUNT] = 0
    for g in range(owner.size):
        k = owner[g]
        sets.group[OWNER, g] = k
        if k >= 0:
            member[k, MEMBERS + member[k, COUNT]] = g
            member[k, COUNT] += 1
    for k in range(member.shape[0]):
        sum_up(sets, k)


@kernel
def hand_over(member: IntArray, group: IntArray, g: int, user: int) -> None:
    """Make ``user`` (−1 for nobody) the owner of a group; worths are not worked out."""
    k = group[OWNER, g]
    if k == user:
        return
    now = group[CHECKED, group.shape[1] - 1] + 1
    if k >= 0:
        last = MEMBERS + member[k, COUNT] - 1
        for i in range(MEMBERS, last):
            if member[k, i] == g:
                member[k, i] = member[k, last]
                break
        member[k, COUNT] -= 1
        member[k, CHANGED] = now
    group[OWNER, g] = user
    if user >= 0:
        member[user, MEMBERS + member[user, COUNT]] = g
        member[user, COUNT] += 1
        member[user, CHANGED] = now


@kernel
def copy_owners(source: IntArray, target: IntArray) -> None:
    """Copy the owners of groups."""
    for g in range(target.size):
        target[g] = source[g]

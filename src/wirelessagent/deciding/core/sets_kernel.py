"""Sets of subcarriers, one per user, and the ways to improve them: moves and swaps, each worth exactly what it says.

The state of a search is which user owns each group of subcarriers. At a price of power μ the users' worths V_k(S_k; μ)
(see :mod:`.bundle_kernel`) add up, so a move of a group or a swap of two changes just two of them. A search meets the
same sets again and again, so what they are worth is remembered: a set is known by a hash that changes by one exclusive
or with every group (Zobrist 1970), and a new price by a new salt.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import BASE, CURVATURE, HIGH, LOW, REFERENCE, SLOPE, bundle, wet_worth
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

ROUNDING = 1e-12
"""Share of a worth below which a gain is none."""
MOST_KNOWN = 65536


class Channel(NamedTuple):
    """The channel as the kernels read it.

    Attributes:
        floor, inverse, ceiling: ln(â/a), â/a and the most nats, shape (user, subcarrier), â the user's largest a; ∞, 0
            and 0 where a is 0. Levels measured from a user's best subcarrier keep their digits where rates are tiny.
        log_best: ln â of each user, shape (user,); 0 where there is none.
        start: first subcarrier of each group, shape (group + 1,).
        usable: whether a user can use any subcarrier of a group, shape (group, user).
        least_ceiling: the least ceiling of a usable pair; NaN where groups have more than one subcarrier.
    """

    floor: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    log_best: FloatArray
    start: IntArray
    usable: BoolArray
    least_ceiling: float


class Sets(NamedTuple):
    """Who owns what, and what is known of its worth.

    Attributes:
        owner: user of each group, −1 for nobody, shape (group,).
        members, size: each user's groups, shapes (user, group) and (user,).
        worth: V of each user's set, shape (user,).
        changed, checked: when a user's set last changed, shape (user,), and when a group was last seen to be best
            where it is, shape (group,), by the first number of ``clock``; the second is the salt.
        sign, digest: a random number for each group, and the hash of each user's set, shapes (group,) and (user,).
        known, known_worth: hashes of sets and their worths, as many as a power of two.
        sums: of each user's set the subcarriers, Σ −ln a, Σ 1/a, the highest floor, the next, the lowest and the next,
            shape (user, 7).
        floor, inverse, ceiling, spare, spare_cap: workspace for one set, shape (subcarrier,).
    """

    owner: IntArray
    members: IntArray
    size: IntArray
    worth: FloatArray
    changed: IntArray
    checked: IntArray
    clock: IntArray
    sign: IntArray
    digest: IntArray
    known: IntArray
    known_worth: FloatArray
    sums: FloatArray
    floor: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    spare: FloatArray
    spare_cap: FloatArray


@kernel
def no_group() -> int:
    """−1, which stands for no group: Numba would compile each function once more for the literal."""
    return int(np.int64(-1))


@kernel
def mixed(x: int) -> int:
    """A number in which every bit of ``x`` shows everywhere; the finaliser of splitmix64."""
    x = (x ^ ((x >> 30) & 0x3FFFFFFFF)) * -4658895280553007687
    x = (x ^ ((x >> 27) & 0x1FFFFFFFFF)) * -7723592293110705685
    return x ^ ((x >> 31) & 0x1FFFFFFFF)


@kernel
def empty_sets(users: int, groups: int, subcarriers: int) -> Sets:
    """Sets that own nothing yet, their worth unknown."""
    size = 1024
    while size < min(16 * users * groups, MOST_KNOWN):
        size *= 2
    sign = np.empty(groups, dtype=np.int64)
    for g in range(groups):
        sign[g] = mixed(g + 1)
    return Sets(
        np.full(groups, -1),
        np.empty((users, groups), dtype=np.int64),
        np.zeros(users, dtype=np.int64),
        np.zeros(users),
        np.zeros(users, dtype=np.int64),
        np.zeros(groups, dtype=np.int64),
        np.zeros(2, dtype=np.int64),
        sign,
        np.zeros(users, dtype=np.int64),
        np.zeros(size, dtype=np.int64),
        np.empty(size),
        np.empty((users, 7)),
        np.empty(subcarriers),
        np.empty(subcarriers),
        np.empty(subcarriers),
        np.empty(subcarriers),
        np.empty(subcarriers),
    )


@kernel
def gather(channel: Channel, sets: Sets, user: int, skipped: int, added: int) -> int:
    """Write the floors, inverses and ceilings of a user's set, without one group and with another; how many they are.

    −1 stands for no group.
    """
    size = 0
    floor, inverse, ceiling, start = channel.floor, channel.inverse, channel.ceiling, channel.start
    set_floor, set_inverse, set_ceiling = sets.floor, sets.inverse, sets.ceiling
    members = sets.members
    own = sets.size[user]
    for i in range(own + 1):
        g = members[user, i] if i < own else added
        if g < 0 or (g == skipped and i < own):
            continue
        for n in range(start[g], start[g + 1]):
            if ceiling[user, n] > 0.0:
                set_floor[size] = floor[user, n]
                set_inverse[size] = inverse[user, n]
                set_ceiling[size] = ceiling[user, n]
                size += 1
    return size


@kernel
def set_bundle(
    channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, user: int, skipped: int, added: int
) -> tuple[float, float, float, float]:
    """Worth, rate, power and level of a user's set, without one group and with another; −1 stands for no group."""
    size = gather(channel, sets, user, skipped, added)
    log_best = channel.log_best[user]
    worth, rate, power, level = bundle(
        rows[user], sets.floor, sets.inverse, sets.ceiling, size, log_mu - log_best, sets.spare, sets.spare_cap
    )  # fmt: skip
    return worth, rate, power * np.exp(-log_best), level - log_best


@kernel
def worth_of(
    channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, user: int, skipped: int, added: int
) -> float:
    """V of a user's set, without one group and with another; remembered."""
    digest = sets.digest[user]
    if skipped >= 0:
        digest ^= sets.sign[skipped]
    if added >= 0:
        digest ^= sets.sign[added]
    place = digest & (sets.known.size - 1)
    if sets.known[place] != digest:
        sets.known_worth[place] = set_bundle(channel, rows, log_mu, sets, user, skipped, added)[0]
        sets.known[place] = digest
    return float(sets.known_worth[place])


@kernel
def sum_up(channel: Channel, sets: Sets, user: int) -> None:
    """Write the sums of a user's set."""
    size, floors, inverses = 0, 0.0, 0.0
    highest, higher, lowest, lower = -np.inf, -np.inf, np.inf, np.inf
    for i in range(sets.size[user]):
        g = sets.members[user, i]
        for n in range(channel.start[g], channel.start[g + 1]):
            floor = channel.floor[user, n]
            if channel.ceiling[user, n] <= 0.0:
                continue
            size += 1
            floors += floor
            inverses += channel.inverse[user, n]
            if floor > highest:
                highest, higher = floor, highest
            elif floor > higher:
                higher = floor
            if floor < lowest:
                lowest, lower = floor, lowest
            elif floor < lower:
                lower = floor
    sums = sets.sums
    sums[user, 0], sums[user, 1], sums[user, 2] = size, floors, inverses
    sums[user, 3], sums[user, 4], sums[user, 5], sums[user, 6] = highest, higher, lowest, lower


@kernel
def changed_worth(
    rows: FloatArray,
    sums: FloatArray,
    floor: FloatArray,
    inverse: FloatArray,
    least_ceiling: float,
    log_mu: FloatArray,
    user: int,
    skipped: int,
    added: int,
) -> float:
    """V of a user's set without one subcarrier and with another, from its sums; NaN where they are not enough."""
    size = sums[user, 0]
    floors, inverses, highest, lowest = sums[user, 1], sums[user, 2], sums[user, 3], sums[user, 5]
    if skipped >= 0:
        f = floor[user, skipped]
        size -= 1
        floors -= f
        inverses -= inverse[user, skipped]
        highest = sums[user, 4] if f == highest else highest
        lowest = sums[user, 6] if f == lowest else lowest
    if added >= 0:
        f = floor[user, added]
        size += 1
        floors += f
        inverses += inverse[user, added]
        highest = max(highest, f)
        lowest = min(lowest, f)
    return wet_worth(
        rows[user, LOW], rows[user, HIGH], rows[user, REFERENCE], rows[user, SLOPE], rows[user, CURVATURE],
        rows[user, BASE], int(size), floors, inverses, highest, lowest, least_ceiling, log_mu[user],
    )  # fmt: skip


@kernel
def value_set(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, user: int) -> None:
    """Note that a user's set has changed, and its worth."""
    sum_up(channel, sets, user)
    sets.worth[user] = worth_of(channel, rows, log_mu, sets, user, no_group(), no_group())
    sets.clock[0] += 1
    sets.changed[user] = sets.clock[0]


@kernel
def value_all(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets) -> float:
    """Forget all worths, for a new price, and work out those of the sets; their sum."""
    sets.clock[1] += 1
    for k in range(sets.size.size):
        sets.digest[k] = mixed(~mixed(sets.clock[1] * sets.size.size + k + 1))  # nothing like the signs
        for i in range(sets.size[k]):
            sets.digest[k] ^= sets.sign[sets.members[k, i]]
    for k in range(sets.size.size):
        value_set(channel, rows, log_mu, sets, k)
    return sets.worth.sum()


@kernel
def assign(sets: Sets, owner: IntArray) -> None:
    """Take over the owners (group,); worths are not worked out."""
    sets.size[:] = 0
    sets.owner[:] = owner
    for g in range(owner.size):
        k = owner[g]
        if k >= 0:
            sets.members[k, sets.size[k]] = g
            sets.size[k] += 1


@kernel
def hand_over(sets: Sets, group: int, user: int) -> None:
    """Make ``user`` (−1 for nobody) the owner of ``group``; worths are not worked out."""
    k = sets.owner[group]
    if k >= 0:
        last = sets.size[k] - 1
        for i in range(last):
            if sets.members[k, i] == group:
                sets.members[k, i] = sets.members[k, last]
                break
        sets.size[k] = last
        sets.digest[k] ^= sets.sign[group]
    sets.owner[group] = user
    if user >= 0:
        sets.digest[user] ^= sets.sign[group]
        sets.members[user, sets.size[user]] = group
        sets.size[user] += 1


@kernel
def best_change(
    channel: Channel, rows: FloatArray, log_mu: float, candidates: IntArray, wanted: BoolArray, sets: Sets, group: int
) -> tuple[float, int, int]:
    """The largest gain that a new owner of ``group`` brings, that owner, and the group given in return, −1 for none.

    ``candidates`` (group, choice) lists the users that a group may go to, −1 for none; ``wanted`` (group, user) the
    same as a table.
    """  # fmt: skip
    owner, members, count, worth = sets.owner, sets.members, sets.size, sets.worth
    changed, sums, floor, inverse = sets.changed, sets.sums, channel.floor, channel.inverse
    least, log_mus = channel.least_ceiling, log_mu - channel.log_best
    k = owner[group]
    best, new_owner, in_return = 0.0, no_group(), no_group()
    since = sets.checked[group]
    seen = k < 0 or changed[k] <= since
    loss = np.nan
    for c in range(candidates.shape[1]):
        j = candidates[group, c]
        if j < 0:
            break
        if j == k or (seen and changed[j] <= since):
            continue
        if np.isnan(loss):
            loss = 0.0
            if k >= 0:
                loss = changed_worth(rows, sums, floor, inverse, least, log_mus, k, group, no_group())
                if np.isnan(loss):
                    loss = worth_of(channel, rows, log_mu, sets, k, group, no_group())
                loss -= worth[k]
        gain = changed_worth(rows, sums, floor, inverse, least, log_mus, j, no_group(), group)
        if np.isnan(gain):
            gain = worth_of(channel, rows, log_mu, sets, j, no_group(), group)
        gain += loss - worth[j]
        if gain > best + ROUNDING * abs(worth[j]):
            best, new_owner, in_return = gain, j, no_group()
        if k < 0:
            continue
        for i in range(count[j]):
            other = members[j, i]
            if not wanted[other, k]:
                continue
            gain = changed_worth(rows, sums, floor, inverse, least, log_mus, k, group, other)
            if np.isnan(gain):
                gain = worth_of(channel, rows, log_mu, sets, k, group, other)
            back = changed_worth(rows, sums, floor, inverse, least, log_mus, j, other, group)
            if np.isnan(back):
                back = worth_of(channel, rows, log_mu, sets, j, other, group)
            gain += back - (worth[k] + worth[j])
            if gain > best + ROUNDING * (abs(worth[j]) + abs(worth[k])):
                best, new_owner, in_return = gain, j, other
    if new_owner < 0:
        sets.checked[group] = sets.clock[0]
    return float(best), new_owner, in_return


@kernel
def change(
    channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, group: int, new_owner: int, in_return: int
) -> None:
    """Carry out a change as :func:`best_change` found it."""
    k = sets.owner[group]
    hand_over(sets, group, new_owner)
    if in_return >= 0:
        hand_over(sets, in_return, k)
    value_set(channel, rows, log_mu, sets, new_owner)
    if k >= 0:
        value_set(channel, rows, log_mu, sets, k)


@kernel
def try_change(
    channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, group: int, new_owner: int, in_return: int
) -> bool:
    """Carry out a change unless its gain was rounding, so that no search goes round in circles; whether it was not."""
    k = sets.owner[group]
    before = sets.worth[new_owner] + (sets.worth[k] if k >= 0 else 0.0)
    change(channel, rows, log_mu, sets, group, new_owner, in_return)
    if sets.worth[new_owner] + (sets.worth[k] if k >= 0 else 0.0) > before:
        return True
    undo(channel, rows, log_mu, sets, group, k, new_owner, in_return)
    sets.checked[group] = sets.clock[0]
    return False


@kernel
def undo(
    channel: Channel,
    rows: FloatArray,
    log_mu: float,
    sets: Sets,
    group: int,
    old_owner: int,
    new_owner: int,
    in_return: int,
) -> None:
    """Take back a change."""
    hand_over(sets, group, old_owner)
    if in_return >= 0:
        hand_over(sets, in_return, new_owner)
    value_set(channel, rows, log_mu, sets, new_owner)
    if old_owner >= 0:
        value_set(channel, rows, log_mu, sets, old_owner)


@kernel
def improve(
    channel: Channel, rows: FloatArray, log_mu: float, candidates: IntArray, wanted: BoolArray, sets: Sets
) -> int:
    """Change owners for as long as the worths add up to more; the number of changes."""
    changes = 0
    unchanged = 0
    groups = sets.owner.size
    g = groups - 1
    while unchanged < groups:
        gain, new_owner, in_return = best_change(channel, rows, log_mu, candidates, wanted, sets, g)
        if gain > 0.0 and try_change(channel, rows, log_mu, sets, g, new_owner, in_return):
            changes += 1
            unchanged = 0
        else:
            unchanged += 1
        g = g + 1 if g + 1 < groups else 0
    return changes

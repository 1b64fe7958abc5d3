"""Sets of subcarriers, one per user, and the ways to improve them: moves and swaps, each worth exactly what it says.

The state of a search is which user owns each group of subcarriers. At a price of power μ the users' worths V_k(S_k; μ)
(see :mod:`.bundle_kernel`) add up, so a move of a group or a swap of two changes just two of them. The worth of a user
with a group more, less or exchanged is kept until that user's set changes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import bundle
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

ROUNDING = 1e-12
"""Share of a worth below which a gain is none."""


class Channel(NamedTuple):
    """The channel as the kernels read it.

    Attributes:
        floor, inverse, ceiling: −ln a, 1/a and the most nats, shape (user, subcarrier); ∞, 0 and 0 where a is 0.
        start: first subcarrier of each group, shape (group + 1,).
        usable: whether a user can use any subcarrier of a group, shape (group, user).
    """

    floor: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    start: IntArray
    usable: BoolArray


class Sets(NamedTuple):
    """Who owns what, and what is known of its worth.

    Attributes:
        owner: user of each group, −1 for nobody, shape (group,).
        members, count: each user's groups, shapes (user, group) and (user,).
        worth: V of each user's set, shape (user,).
        stamp: a number that changes with each user's set, shape (user + 1,); the last counts them.
        without, without_stamp: V of a group's owner without it, shape (group,).
        joined, joined_stamp: V of a user with a group more, shape (group, user).
        traded, traded_stamp: V of the owner of the first group with the second in its place, shape (group, group).
        scratch: five rows of workspace, shape (5, subcarrier).
    """

    owner: IntArray
    members: IntArray
    count: IntArray
    worth: FloatArray
    stamp: IntArray
    without: FloatArray
    without_stamp: IntArray
    joined: FloatArray
    joined_stamp: IntArray
    traded: FloatArray
    traded_stamp: IntArray
    scratch: FloatArray


@kernel
def empty_sets(users: int, groups: int, subcarriers: int) -> Sets:
    """Sets that own nothing yet, their worth unknown."""
    return Sets(
        np.full(groups, -1),
        np.empty((users, groups), dtype=np.int64),
        np.zeros(users, dtype=np.int64),
        np.zeros(users),
        np.zeros(users + 1, dtype=np.int64),
        np.empty(groups),
        np.full(groups, -1),
        np.empty((groups, users)),
        np.full((groups, users), -1),
        np.empty((groups, groups)),
        np.full((groups, groups), -1),
        np.empty((5, subcarriers)),
    )


@kernel
def gather(channel: Channel, sets: Sets, user: int, skipped: int, added: int) -> int:
    """Write the floors, inverses and ceilings of a user's set, without one group and with another; how many they are.

    −1 stands for no group.
    """
    size = 0
    scratch = sets.scratch
    for i in range(sets.count[user] + 1):
        if i < sets.count[user]:
            g = sets.members[user, i]
            if g == skipped:
                continue
        else:
            g = added
            if g < 0:
                break
        for n in range(channel.start[g], channel.start[g + 1]):
            if channel.ceiling[user, n] > 0.0:
                scratch[0, size] = channel.floor[user, n]
                scratch[1, size] = channel.inverse[user, n]
                scratch[2, size] = channel.ceiling[user, n]
                size += 1
    return size


@kernel
def set_bundle(
    channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, user: int, skipped: int, added: int
) -> tuple[float, float, float, float]:
    """Worth, rate, power and level of a user's set, without one group and with another; −1 stands for no group."""
    size = gather(channel, sets, user, skipped, added)
    scratch = sets.scratch
    return bundle(rows[user], scratch[0], scratch[1], scratch[2], size, log_mu, scratch[3], scratch[4])


@kernel
def value_set(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, user: int) -> None:
    """Work out a user's worth afresh, and forget what was known of its set."""
    sets.worth[user] = set_bundle(channel, rows, log_mu, sets, user, -1, -1)[0]
    sets.stamp[-1] += 1
    sets.stamp[user] = sets.stamp[-1]


@kernel
def value_all(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets) -> float:
    """:func:`value_set` for every user; the sum of their worths."""
    for k in range(sets.count.size):
        value_set(channel, rows, log_mu, sets, k)
    return sets.worth.sum()


@kernel
def assign(sets: Sets, owner: IntArray) -> None:
    """Take over the owners (group,); worths are not worked out."""
    sets.count[:] = 0
    sets.owner[:] = owner
    for g in range(owner.size):
        k = owner[g]
        if k >= 0:
            sets.members[k, sets.count[k]] = g
            sets.count[k] += 1


@kernel
def hand_over(sets: Sets, group: int, user: int) -> None:
    """Make ``user`` (−1 for nobody) the owner of ``group``; worths are not worked out."""
    k = sets.owner[group]
    if k >= 0:
        last = sets.count[k] - 1
        for i in range(last):
            if sets.members[k, i] == group:
                sets.members[k, i] = sets.members[k, last]
                break
        sets.count[k] = last
    sets.owner[group] = user
    if user >= 0:
        sets.members[user, sets.count[user]] = group
        sets.count[user] += 1


@kernel
def worth_without(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, group: int) -> float:
    """V of the group's owner without it."""
    k = sets.owner[group]
    if sets.without_stamp[group] != sets.stamp[k]:
        sets.without[group] = set_bundle(channel, rows, log_mu, sets, k, group, -1)[0]
        sets.without_stamp[group] = sets.stamp[k]
    return sets.without[group]


@kernel
def worth_with(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, group: int, user: int) -> float:
    """V of ``user`` with ``group`` more."""
    if sets.joined_stamp[group, user] != sets.stamp[user]:
        sets.joined[group, user] = set_bundle(channel, rows, log_mu, sets, user, -1, group)[0]
        sets.joined_stamp[group, user] = sets.stamp[user]
    return sets.joined[group, user]


@kernel
def worth_traded(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, given: int, taken: int) -> float:
    """V of the owner of ``given`` with ``taken`` in its place."""
    k = sets.owner[given]
    if sets.traded_stamp[given, taken] != sets.stamp[k]:
        sets.traded[given, taken] = set_bundle(channel, rows, log_mu, sets, k, given, taken)[0]
        sets.traded_stamp[given, taken] = sets.stamp[k]
    return sets.traded[given, taken]


@kernel
def best_change(
    channel: Channel, rows: FloatArray, log_mu: float, candidates: IntArray, wanted: BoolArray, sets: Sets, group: int
) -> tuple[float, int, int]:
    """The largest gain that a new owner of ``group`` brings, that owner, and the group given in return, −1 for none.

    ``candidates`` (group, choice) lists the users that a group may go to, −1 for none; ``wanted`` (group, user) the
    same as a table.
    """  # fmt: skip
    k = sets.owner[group]
    best, new_owner, in_return = 0.0, -1, -1
    loss = worth_without(channel, rows, log_mu, sets, group) - sets.worth[k] if k >= 0 else 0.0
    for c in range(candidates.shape[1]):
        j = candidates[group, c]
        if j < 0:
            break
        if j == k:
            continue
        gain = worth_with(channel, rows, log_mu, sets, group, j) - sets.worth[j] + loss
        if gain > best + ROUNDING * abs(sets.worth[j]):
            best, new_owner, in_return = gain, j, -1
        if k < 0:
            continue
        for i in range(sets.count[j]):
            other = sets.members[j, i]
            if not wanted[other, k]:
                continue
            gain = (
                worth_traded(channel, rows, log_mu, sets, group, other)
                - sets.worth[k]
                + worth_traded(channel, rows, log_mu, sets, other, group)
                - sets.worth[j]
            )
            if gain > best + ROUNDING * (abs(sets.worth[j]) + abs(sets.worth[k])):
                best, new_owner, in_return = gain, j, other
    return best, new_owner, in_return


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
def improve(
    channel: Channel, rows: FloatArray, log_mu: float, candidates: IntArray, wanted: BoolArray, sets: Sets
) -> int:
    """Change owners for as long as the worths add up to more; the number of changes."""
    changes = 0
    unchanged = 0
    g = 0
    groups = sets.owner.size
    while unchanged < groups:
        gain, new_owner, in_return = best_change(channel, rows, log_mu, candidates, wanted, sets, g)
        if gain > 0.0:
            change(channel, rows, log_mu, sets, g, new_owner, in_return)
            changes += 1
            unchanged = 0
        else:
            unchanged += 1
        g = g + 1 if g + 1 < groups else 0
    return changes

"""Moves of a group to another user and swaps of two: which gain, and how much.

At a price of power the worths of :mod:`.sets_kernel` add up, so a change of owners changes just two of them. Terms at
the users' levels bound what it can gain; only where they leave something to gain is it worked out.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import UNREACHABLE
from wirelessagent.deciding.core.sets_kernel import (
    CHANGED,
    CHECKED,
    COUNT,
    FLOOR,
    MEMBERS,
    OWNER,
    START,
    TERM,
    WORTH,
    Sets,
    hand_over,
    none,
    quick_worth,
    set_bundle,
    value_set,
    worth_of,
)
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

ROUNDING = 1e-12
"""Share of a worth below which a gain is none."""


@kernel
def find_change(sets: Sets, candidates: IntArray, first: int) -> tuple[int, int, int]:
    """The next group from ``first`` on, round all of them, that a change gains by, with the best of its changes.

    A change is a new owner and the group given in return, −1 for none; without any the group is −1. ``candidates``
    (group, choice) lists the users that a group may go to, −1 for none.
    """
    pair, user, member, group = sets.pair, sets.user, sets.member, sets.group
    groups = group.shape[1] - 1
    now = group[CHECKED, groups]
    for offset in range(groups):
        g = first + offset if first + offset < groups else first + offset - groups
        k, since = group[OWNER, g], group[CHECKED, g]
        seen = k < 0 or member[k, CHANGED] <= since
        best, new_owner, in_return = 0.0, none(), none()
        for c in range(candidates.shape[1]):
            j = candidates[g, c]
            if j < 0:
                break
            if j == k or (seen and member[j, CHANGED] <= since):
                continue
            rounding = ROUNDING * (abs(user[j, WORTH]) + (abs(user[k, WORTH]) if k >= 0 else 0.0))
            loss = pair[TERM, k, g] if k >= 0 else 0.0
            for i in range(MEMBERS - 1, MEMBERS + (member[j, COUNT] if k >= 0 else 0)):
                other = member[j, i] if i >= MEMBERS else none()
                less = pair[TERM, k, other] - loss if other >= 0 else -loss
                more = pair[TERM, j, g] - (pair[TERM, j, other] if other >= 0 else 0.0)
                if more + less <= best + rounding:
                    continue
                if k >= 0:
                    less = quick_worth(pair, user, group, k, g, other) - user[k, WORTH]
                    if np.isnan(less):
                        less = set_bundle(sets, k, g, other)[0] - user[k, WORTH]
                    if more + less <= best + rounding:
                        continue
                more = quick_worth(pair, user, group, j, other, g) - user[j, WORTH]
                if np.isnan(more):
                    more = set_bundle(sets, j, other, g)[0] - user[j, WORTH]
                if more + less > best + rounding:
                    best, new_owner, in_return = more + less, j, other
        if new_owner >= 0:
            return g, new_owner, in_return
        group[CHECKED, g] = now
    return none(), none(), none()


@kernel
def gain_of(sets: Sets, k: int, skipped: int, added: int) -> float:
    """What a user's set gains without one group and with another (−1 for none)."""
    return worth_of(sets, k, skipped, added) - sets.user[k, WORTH]


@kernel
def change(sets: Sets, g: int, new_owner: int, in_return: int) -> None:
    """Give a group to ``new_owner`` (−1 for nobody), who may give one in return (−1 for none)."""
    k = int(sets.group[OWNER, g])
    hand_over(sets.member, sets.group, g, new_owner)
    if in_return >= 0:
        hand_over(sets.member, sets.group, in_return, k)
    if new_owner >= 0:
        value_set(sets, new_owner)
    if k >= 0:
        value_set(sets, k)


@kernel
def take_back(sets: Sets, g: int, old_owner: int, in_return: int) -> None:
    """Take back a change."""
    k = int(sets.group[OWNER, g])
    if in_return >= 0:
        hand_over(sets.member, sets.group, in_return, k)
    hand_over(sets.member, sets.group, g, old_owner)
    value_set(sets, k)
    if old_owner >= 0:
        value_set(sets, old_owner)


@kernel
def improve(sets: Sets, candidates: IntArray) -> int:
    """Change owners for as long as the worths add up to more; the number of changes.

    A change whose gain was rounding is taken back, so that no search goes round in circles.
    """
    user, group = sets.user, sets.group
    changes, refused = 0, 0
    groups = group.shape[1] - 1
    g = groups - 1
    while refused < groups and not is_over(sets.work):
        g, new_owner, in_return = find_change(sets, candidates, g)
        if g < 0:
            break
        k = int(group[OWNER, g])
        before = user[new_owner, WORTH] + (user[k, WORTH] if k >= 0 else 0.0)
        change(sets, g, new_owner, in_return)
        if user[new_owner, WORTH] + (user[k, WORTH] if k >= 0 else 0.0) > before:
            changes += 1
            refused = 0
        else:
            take_back(sets, g, k, in_return)
            group[CHECKED, g] = group[CHECKED, groups]
            refused += 1
        g = g + 1 if g + 1 < groups else 0
    return changes


@kernel
def some_wanting(user: FloatArray) -> bool:
    """Whether any user lacks a rate that it must have."""
    least = 0.0
    for k in range(user.shape[0]):
        least = min(least, user[k, WORTH])
    return bool(least <= -UNREACHABLE)


@kernel
def serve_all(sets: Sets) -> int:
    """Give groups to users who lack a rate that they must have, whatever that costs others; how many still lack one.

    Where time is over each gets one group that others can spare: better a rate that is low than none.
    """
    user = sets.user
    missing = 0
    for k in range(user.shape[0]):
        while user[k, WORTH] <= -UNREACHABLE:
            hurried = is_over(sets.work)
            chosen = spare_group(sets, k) if hurried else best_to_take(sets, k)
            if chosen >= 0:
                change(sets, chosen, k, none())
            if chosen < 0 or (hurried and user[k, WORTH] <= -UNREACHABLE):
                missing += 1
                break
    return missing


@kernel
def best_to_take(sets: Sets, k: int) -> int:
    """The group by whose going to a user all gain most; −1 if none gain."""
    group = sets.group
    best, chosen = 0.0, none()
    for g in range(group.shape[1] - 1):
        holder = group[OWNER, g]
        if holder == k:
            continue
        gain = gain_of(sets, k, none(), g)
        if holder >= 0:
            gain += gain_of(sets, holder, g, none())
        if gain > best:
            best, chosen = gain, g
    return chosen


@kernel
def spare_group(sets: Sets, k: int) -> int:
    """A user's best group among those that nobody has, or somebody who has several; −1 if there is none."""
    pair, group = sets.pair, sets.group
    lowest, chosen = np.inf, none()
    for g in range(group.shape[1] - 1):
        holder = group[OWNER, g]
        if holder == k or (holder >= 0 and sets.member[holder, COUNT] < 2):
            continue
        for n in range(group[START, g], group[START, g + 1]):
            if pair[FLOOR, k, n] < lowest:
                lowest, chosen = pair[FLOOR, k, n], g
    return chosen

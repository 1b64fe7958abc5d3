"""Chains of changes: a user takes a group, who loses it takes another, and so on, three or four users in all.

The last one takes what the first gave in return, or nothing. No user takes part twice. Such a chain may gain where no
move or swap does. At a price of power its gain is the sum of what each user gains, and at most the sum of what terms
say (:mod:`.sets_kernel`), so that few chains need to be worked out. A cycle that gains can be begun at a user from
whom on every partial sum is a gain (Lin and Kernighan, Operations Research 21(2), 1973), so only chains are followed
whose sums are. Where the first user gives nothing the chain is no cycle, and those whose first gains do not pay at once
are missed.

Beside the groups there is a row for each user, for a user who takes a group and gives none; the column after the last
group stands for taking none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.deciding.core.moves_kernel import ROUNDING, improve
from wirelessagent.deciding.core.sets_kernel import (
    CHANGED,
    CHECKED,
    OWNER,
    TERM,
    WORTH,
    Sets,
    hand_over,
    none,
    quick_worth,
    set_bundle,
    value_changed,
)
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray, IntArray

MOST_CHAINS = 50


class Chains(NamedTuple):
    """Workspace of the search for chains.

    Attributes:
        shift: what terms say that a group's going to a user gains, shape (user, group); −∞ where it may not go.
        order: the groups that may go to a user, those first that gain most, then their number, shape (user, group + 1).
        most: the largest of these gains for each group, at least 0, shape (group,).
        gain: what the owner of a row's group, or its user, gains who gives that group, or none, and takes a column's;
            NaN where it is not known, shape (group + user, group + 1).
        seen: the user of each row, and when its set had last changed, shape (group + user, 2).
        chain: the row of the first user, and the columns that are taken, one after the other, shape (5,).
    """

    shift: FloatArray
    order: IntArray
    most: FloatArray
    gain: FloatArray
    seen: IntArray
    chain: IntArray


@kernel
def empty_chains(users: int, groups: int) -> Chains:
    """A workspace in which nothing is known."""
    shift, order = np.empty((users, groups)), np.empty((users, groups + 1), dtype=np.int64)
    gain, seen = np.empty((groups + users, groups + 1)), np.full((groups + users, 2), none())
    return Chains(shift, order, np.empty(groups), gain, seen, np.empty(5, dtype=np.int64))


@kernel
def write_shift(
    pair: FloatArray, group: IntArray, candidates: IntArray, shift: FloatArray, order: IntArray, most: FloatArray
) -> tuple[float, float]:
    """Write ``shift``, ``order`` and ``most``; the largest of these and the next."""
    first, second, groups = 0.0, 0.0, most.size
    shift[:] = -np.inf
    order[:, groups] = 0
    for g in range(groups):
        k = group[OWNER, g]
        most[g] = 0.0
        if k < 0:
            continue
        for c in range(candidates.shape[1]):
            j = candidates[g, c]
            if j < 0:
                break
            if j == k:
                continue
            shift[j, g] = pair[TERM, j, g] - pair[TERM, k, g]
            most[g] = max(most[g], shift[j, g])
            at = order[j, groups]
            order[j, groups] += 1
            while at > 0 and shift[j, order[j, at - 1]] < shift[j, g]:
                order[j, at] = order[j, at - 1]
                at -= 1
            order[j, at] = g
        second = max(second, min(first, most[g]))
        first = max(first, most[g])
    return first, second


@kernel
def write_gain(
    pair: FloatArray,
    user: FloatArray,
    member: IntArray,
    group: IntArray,
    shift: FloatArray,
    least: float,
    gain: FloatArray,
    seen: IntArray,
) -> None:
    """Write ``gain`` anew for users whose sets have changed, from sums, where terms say more than ``least``."""
    groups = group.shape[1] - 1
    for row in range(gain.shape[0]):
        given = row if row < groups else none()
        j = group[OWNER, row] if row < groups else row - groups
        if j < 0 or (seen[row, 0] == j and seen[row, 1] == member[j, CHANGED]):
            continue
        seen[row, 0], seen[row, 1] = j, member[j, CHANGED]
        for g in range(groups):
            gain[row, g] = np.nan
            if shift[j, g] > least:
                gain[row, g] = quick_worth(pair, user, group, j, given, g) - user[j, WORTH]
        gain[row, groups] = quick_worth(pair, user, group, j, given, none()) - user[j, WORTH] if given >= 0 else 0.0


@kernel
def work_out(sets: Sets, gain: FloatArray, row: int, column: int) -> float:
    """Write an entry of ``gain`` that sums do not tell, or that terms seemed to rule out."""
    groups = sets.group.shape[1] - 1
    j = int(sets.group[OWNER, row]) if row < groups else row - groups
    given, taken = row if row < groups else none(), column if column < groups else none()
    worth = quick_worth(sets.pair, sets.user, sets.group, j, given, taken)
    if np.isnan(worth):
        worth = set_bundle(sets, j, given, taken)[0]
    gain[row, column] = worth - sets.user[j, WORTH]
    return float(gain[row, column])


@kernel
def best_fourth(
    sets: Sets,
    chains: Chains,
    row: int,
    j: int,
    k: int,
    g: int,
    said: float,
    gained: float,
    best: float,
) -> tuple[int, float]:
    """The best last group of a chain of four, −1 for none, and the chain's gain where that is more than ``best``.

    The users ``j`` and ``k`` have taken a group each, the last was ``g``; they gain ``gained`` by that, and the chain
    ``said`` by terms if its last user takes nothing.
    """
    group, shift, order, gain = sets.group, chains.shift, chains.order, chains.gain
    groups = group.shape[1] - 1
    i, back, most = group[OWNER, g], min(row, groups), chains.most[row] if row < groups else 0.0
    found = none()
    for place in range(order[i, groups]):
        last = order[i, place]
        said_now = said + shift[i, last]
        if said_now + most <= best:
            break
        m = group[OWNER, last]
        if m == j or said_now + (shift[m, row] if row < groups else 0.0) <= best:
            continue
        if m == k:
            continue
        total = gain[g, last]
        if np.isnan(total):
            total = work_out(sets, gain, g, last)
        total += gained
        if total <= 0.0:
            continue
        end = gain[last, back]
        if np.isnan(end):
            end = work_out(sets, gain, last, back)
        if total + end > best:
            best, found = total + end, last
    return found, best


@kernel
def best_chain(sets: Sets, chains: Chains, row: int, top: float, rest: float, best: float) -> int:
    """Write the best chain from the user of a row, if it gains more than ``best``; how many groups it takes, or 0.

    One group's change gains at most ``top`` by terms, those of two together ``rest``.
    """
    pair, group, found = sets.pair, sets.group, 0
    shift, order, gain, chain = chains.shift, chains.order, chains.gain, chains.chain
    groups = group.shape[1] - 1
    j = group[OWNER, row] if row < groups else row - groups
    given, most, back = (pair[TERM, j, row], chains.most[row], row) if row < groups else (0.0, 0.0, groups)
    for place in range(order[j, groups]):
        g = order[j, place]
        if shift[j, g] + rest + most <= best:
            break
        k, first = group[OWNER, g], float(gain[row, g])
        if np.isnan(first):
            first = work_out(sets, gain, row, g)
        if first <= 0.0:
            continue
        one = first + given - pair[TERM, k, g]
        for place_2 in range(order[k, groups]):
            h = order[k, place_2]
            if one + shift[k, h] + top + most <= best:
                break
            i = group[OWNER, h]
            if i == j:
                continue
            closing = shift[i, row] if row < groups else 0.0
            peak = shift[i, order[i, 0]] + most if order[i, groups] > 0 else -np.inf
            if one + shift[k, h] + max(closing, peak) <= best:
                continue
            second = float(gain[g, h])
            if np.isnan(second):
                second = work_out(sets, gain, g, h)
            second += first
            if second <= 0.0:
                continue
            two = second + given - pair[TERM, i, h]
            if two + closing > best:
                end = gain[h, back]
                if np.isnan(end):
                    end = work_out(sets, gain, h, back)
                if second + end > best:
                    best, found = second + end, 3
                    chain[0], chain[1], chain[2], chain[3] = row, g, h, back
            if two + peak > best:
                fourth, best = best_fourth(sets, chains, row, j, k, h, two, second, best)
                if fourth >= 0:
                    found = 4
                    chain[0], chain[1], chain[2], chain[3], chain[4] = row, g, h, fourth, back
    return found


@kernel
def find_chain(sets: Sets, candidates: IntArray, chains: Chains, first: int) -> int:
    """Write the best chain of the first row from ``first`` on, round all rows, that has one; as :func:`best_chain`."""
    pair, user, group = sets.pair, sets.user, sets.group
    rows, groups = chains.gain.shape[0], group.shape[1] - 1
    top, second = write_shift(pair, group, candidates, chains.shift, chains.order, chains.most)
    if top <= 0.0:
        return 0
    write_gain(pair, user, sets.member, group, chains.shift, -(2.0 * top + second), chains.gain, chains.seen)
    least = 0.0
    for k in range(user.shape[0]):
        least += ROUNDING * abs(user[k, WORTH])
    for offset in range(rows):
        row = first + offset if first + offset < rows else first + offset - rows
        if row < groups and group[OWNER, row] < 0:
            continue
        found = best_chain(sets, chains, row, top, top + second, least)
        if found > 0:
            return found
    return 0


@kernel
def take_chain(sets: Sets, chain: IntArray, size: int) -> None:
    """Hand on the groups of a chain."""
    group = sets.group
    groups = group.shape[1] - 1
    since = group[CHECKED, groups]
    taker = group[OWNER, chain[0]] if chain[0] < groups else chain[0] - groups
    for i in range(1, size + 1):
        if chain[i] < groups:
            giver = group[OWNER, chain[i]]
            hand_over(sets.member, group, chain[i], taker)
            taker = giver
    value_changed(sets, since)


@kernel
def improve_by_chains(sets: Sets, candidates: IntArray, chains: Chains) -> None:
    """Take chains, and moves and swaps after each, for as long as there are any that gain."""
    first = 0
    for _ in range(MOST_CHAINS):
        if is_over(sets.work):
            return
        size = find_chain(sets, candidates, chains, first)
        if size == 0:
            return
        take_chain(sets, chains.chain, size)
        improve(sets, candidates)
        first = int(chains.chain[0] + 1) % chains.gain.shape[0]

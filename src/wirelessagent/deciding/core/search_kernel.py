"""From prices to sets, and from sets to better ones: a local search that never gets worse, with restarts.

Sets are improved at their own price of power until none of the moves and swaps of :mod:`.sets_kernel` gains. That is a
true local optimum: with μ the price that settles the sets S, value(S) = Σ V_k(S_k; μ) + μ P, and no other sets S' can
be worth more than Σ V_k(S'_k; μ) + μ P, because their own price makes that smallest. So a change can be an improvement
only if the worths at the present price add up to more. Then it is settled afresh, and kept if the score is higher.
A restart gives a few groups away at random, improves, and goes back unless that scored, or was worth just as much.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.bundle_kernel import UNREACHABLE
from wirelessagent.deciding.core.sets_kernel import (
    ROUNDING,
    Channel,
    Sets,
    assign,
    best_change,
    change,
    hand_over,
    improve,
    no_group,
    undo,
    value_all,
    value_set,
    worth_of,
)
from wirelessagent.deciding.core.settle_kernel import LEVEL, POWER, set_level, settle
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

ROUNDS = 8
GAIN = 1e-12
"""Share of a score by which a better one is higher."""
MOST_KICKED = 3
SLACK_SHARE = 1e-9
LIFT = 1e-6
CHECKED = 400
"""Up to this many groups × candidates every change is settled before it is taken where a whole round did not score."""


@kernel
def choose_candidates(
    term: FloatArray, usable: BoolArray, regret: float, candidates: IntArray, wanted: BoolArray
) -> None:
    """Write the users with the largest terms for each group, shape (group, choice), −1 where there are no more.

    None is listed whose term is smaller than the largest by more than ``regret``. Where sets are known that fall short
    of the dual by just that, no better ones give a group to such a user: its term would cost them more.
    """
    groups, users = term.shape
    choices = candidates.shape[1]
    wanted[:] = False
    for g in range(groups):
        size = 0
        highest = 0.0
        for k in range(users):
            highest = max(highest, term[g, k])
        for k in range(users):
            if not usable[g, k] or term[g, k] < highest - regret:
                continue
            at = min(size, choices - 1)
            if size == choices and term[g, candidates[g, at]] >= term[g, k]:
                continue
            while at > 0 and term[g, candidates[g, at - 1]] < term[g, k]:
                candidates[g, at] = candidates[g, at - 1]
                at -= 1
            candidates[g, at] = k
            size = min(size + 1, choices)
        for c in range(size):
            wanted[g, candidates[g, c]] = True
        for c in range(size, choices):
            candidates[g, c] = -1


@kernel
def serve_all(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets) -> int:
    """Give groups to users who lack a rate that they must have, whatever that costs others; how many still lack one."""
    users = sets.size.size
    missing = 0
    for k in range(users):
        while sets.worth[k] <= -UNREACHABLE:
            best, chosen = 0.0, no_group()
            for g in range(sets.owner.size):
                if not channel.usable[g, k] or sets.owner[g] == k:
                    continue
                gain = worth_of(channel, rows, log_mu, sets, k, no_group(), g) - sets.worth[k]
                if sets.owner[g] >= 0:
                    holder = sets.owner[g]
                    gain += worth_of(channel, rows, log_mu, sets, holder, g, no_group()) - sets.worth[holder]
                if gain > best:
                    best, chosen = gain, g
            if chosen < 0:
                missing += 1
                break
            change(channel, rows, log_mu, sets, chosen, k, no_group())
    return missing


@kernel
def random(state: IntArray, below: int) -> int:
    """A number from 0 to ``below`` − 1; Marsaglia's xorshift, so that a seed gives the same search everywhere."""
    x = state[0]
    x ^= x << 13
    x ^= (x >> 7) & 0x1FFFFFFFFFFFFFF
    x ^= x << 17
    state[0] = x
    return int(((x >> 11) & 0x1FFFFFFFFFFFFF) % below)


@kernel
def contested_groups(candidates: IntArray, owner: IntArray, contested: IntArray) -> int:
    """Write the groups that could go to somebody else, and return how many they are."""
    size = 0
    for g in range(owner.size):
        for c in range(candidates.shape[1]):
            if candidates[g, c] >= 0 and candidates[g, c] != owner[g]:
                contested[size] = g
                size += 1
                break
    return size


@kernel
def kick(
    channel: Channel,
    rows: FloatArray,
    log_mu: float,
    candidates: IntArray,
    contested: IntArray,
    size: int,
    sets: Sets,
    state: IntArray,
) -> None:
    """Give one to three of the first ``size`` contested groups to random candidates."""
    for _ in range(1 + random(state, MOST_KICKED * size) % MOST_KICKED):
        g = contested[random(state, size)]
        choices = 0
        while choices < candidates.shape[1] and candidates[g, choices] >= 0:
            choices += 1
        j = int(candidates[g, random(state, choices)])
        k = int(sets.owner[g])
        if j == k:
            continue
        hand_over(sets, g, j)
        value_set(channel, rows, log_mu, sets, j)
        if k >= 0:
            value_set(channel, rows, log_mu, sets, k)


@kernel
def polish(
    goal: int,
    channel: Channel,
    rows: FloatArray,
    share: FloatArray,
    budget_w: float,
    circuit_w: float,
    most: float,
    candidates: IntArray,
    wanted: BoolArray,
    sets: Sets,
    at: float,
    best_owner: IntArray,
) -> tuple[float, float]:
    """Improve, settle, and improve at the settled price again, for as long as the score rises.

    Returns the best score and its ln μ (or ln level); ``best_owner`` and ``sets`` then hold the best sets. Where sets
    improved at one price score less at their own, changes are tried one by one.
    """  # fmt: skip
    score, at, spent = settle(goal, channel, rows, share, budget_w, circuit_w, most, at, sets)
    best_owner[:] = sets.owner
    for _ in range(ROUNDS):
        log_mu = 0.0 if goal == LEVEL else at
        if goal == LEVEL:
            set_level(rows, share, np.exp(at))
            if spent < budget_w * (1.0 - SLACK_SHARE):  # no power lifts the level: somebody's subcarriers are full
                set_level(rows, share, min(np.exp(at) * (1.0 + LIFT), most))
        before = value_all(channel, rows, log_mu, sets)
        if goal == LEVEL and sets.worth.min() <= -UNREACHABLE:
            serve_all(channel, rows, log_mu, sets)
            improve(channel, rows, log_mu, candidates, wanted, sets)
        elif improve(channel, rows, log_mu, candidates, wanted, sets) == 0:
            break
        after = sets.worth.sum()
        if after <= before + GAIN * abs(before):
            break
        found, found_at, found_w = settle(goal, channel, rows, share, budget_w, circuit_w, most, at, sets)
        if found > score + GAIN * abs(score):
            score, at, spent = found, found_at, found_w
            best_owner[:] = sets.owner
            if goal == POWER:
                break
            continue
        assign(sets, best_owner)
        if sets.owner.size * candidates.shape[1] > CHECKED:
            break
        found, found_at = single_changes(
            goal, channel, rows, share, budget_w, circuit_w, most, candidates, wanted, sets, score, at
        )  # fmt: skip
        if found <= score + GAIN * abs(score):
            break
        score, at = found, found_at
        best_owner[:] = sets.owner
    assign(sets, best_owner)
    if goal == LEVEL:
        set_level(rows, share, np.exp(at))
    return score, at


@kernel
def single_changes(
    goal: int,
    channel: Channel,
    rows: FloatArray,
    share: FloatArray,
    budget_w: float,
    circuit_w: float,
    most: float,
    candidates: IntArray,
    wanted: BoolArray,
    sets: Sets,
    score: float,
    at: float,
) -> tuple[float, float]:
    """Take the best change of the first group whose best change scores; the new score and its ln μ (or ln level)."""
    log_mu = 0.0 if goal == LEVEL else at
    if goal == LEVEL:
        set_level(rows, share, np.exp(at))
    value_all(channel, rows, log_mu, sets)
    for g in range(sets.owner.size):
        gain, new_owner, in_return = best_change(channel, rows, log_mu, candidates, wanted, sets, g)
        if gain <= 0.0:
            continue
        k = sets.owner[g]
        change(channel, rows, log_mu, sets, g, new_owner, in_return)
        found, found_at, _ = settle(goal, channel, rows, share, budget_w, circuit_w, most, at, sets)
        if found > score + GAIN * abs(score):
            return found, found_at
        if goal == LEVEL:
            set_level(rows, share, np.exp(at))
        undo(channel, rows, log_mu, sets, g, k, new_owner, in_return)
    return score, at


@kernel
def restart(
    goal: int,
    channel: Channel,
    rows: FloatArray,
    share: FloatArray,
    budget_w: float,
    circuit_w: float,
    most: float,
    candidates: IntArray,
    wanted: BoolArray,
    sets: Sets,
    score: float,
    at: float,
    best_owner: IntArray,
    restarts: int,
    state: IntArray,
) -> tuple[float, float]:
    """Restart so many times from the best sets; the best score and its ln μ (or ln level), as :func:`polish`."""
    log_mu = 0.0 if goal == LEVEL else at
    standard = value_all(channel, rows, log_mu, sets)
    base, trial_owner, contested = best_owner.copy(), best_owner.copy(), best_owner.copy()
    size = contested_groups(candidates, base, contested)
    if size == 0:
        return score, at
    for _ in range(restarts):
        kick(channel, rows, log_mu, candidates, contested, size, sets, state)
        if sets.worth.min() <= -UNREACHABLE:
            serve_all(channel, rows, log_mu, sets)
        improve(channel, rows, log_mu, candidates, wanted, sets)
        gained = sets.worth.sum()
        if gained > standard + ROUNDING * abs(standard):
            found, found_at = polish(
                goal, channel, rows, share, budget_w, circuit_w, most, candidates, wanted, sets, at, trial_owner
            )  # fmt: skip
            if found > score + GAIN * abs(score):
                score, at = found, found_at
                best_owner[:] = trial_owner
                base[:] = trial_owner
                log_mu = 0.0 if goal == LEVEL else at
                standard = value_all(channel, rows, log_mu, sets)
                continue
            if goal == LEVEL:
                set_level(rows, share, np.exp(at))
            assign(sets, base)
            value_all(channel, rows, log_mu, sets)
        elif gained >= standard - ROUNDING * abs(standard):
            base[:] = sets.owner  # as good: go on from there, to cross plateaus
        else:
            go_back(channel, rows, log_mu, sets, base)
    return score, at


@kernel
def go_back(channel: Channel, rows: FloatArray, log_mu: float, sets: Sets, owner: IntArray) -> None:
    """Return to the owners (group,), which no change improves, valuing only the sets that differ."""
    changed = np.zeros(sets.size.size, dtype=np.bool_)
    for g in range(owner.size):
        if sets.owner[g] != owner[g]:
            if sets.owner[g] >= 0:
                changed[sets.owner[g]] = True
            if owner[g] >= 0:
                changed[owner[g]] = True
            hand_over(sets, g, owner[g])
    for k in range(changed.size):
        if changed[k]:
            value_set(channel, rows, log_mu, sets, k)
    sets.checked[:] = sets.clock[0]

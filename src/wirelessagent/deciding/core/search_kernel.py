"""From prices to sets, and from sets to better ones: a local search that never gets worse, with restarts.

Sets are improved at their own price of power until none of the moves and swaps of :mod:`.moves_kernel` gains. That is a
true local optimum: with μ the price that settles the sets S, value(S) = Σ V_k(S_k; μ) + μ P, and no other sets S' can
be worth more than Σ V_k(S'_k; μ) + μ P, because their own price makes that smallest. So a change can be an improvement
only if the worths at the present price add up to more. Then it is settled afresh, and kept if the score is higher.
A restart gives a few groups away at random, improves, also by the chains of :mod:`.chains_kernel`, and goes back unless
that is worth nearly as much; the best sets are kept.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.ask_kernel import LEVEL, POWER, SUM, Ask
from wirelessagent.deciding.core.chains_kernel import Chains, empty_chains, improve_by_chains
from wirelessagent.deciding.core.moves_kernel import (
    ROUNDING,
    change,
    find_change,
    improve,
    serve_all,
    some_wanting,
    take_back,
)
from wirelessagent.deciding.core.sets_kernel import (
    CHECKED,
    OWNER,
    Sets,
    assign,
    copy_owners,
    hand_over,
    none,
    total_worth,
    value_all,
    value_changed,
)
from wirelessagent.deciding.core.settle_kernel import set_level, settle
from wirelessagent.deciding.core.work_kernel import is_over
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

ROUNDS = 8
GAIN = 1e-12
"""Share of a score by which a better one is higher."""
MOST_KICKED = 3
UNCHAINED = 3
"""Kicks of a restart that looks for no chains; it takes about as long as one that does."""
MOST_CHAINED = 32
"""Up to so many groups chains are looked for; the time for all of them grows as the cube."""
PROMISING = 0.05
"""Share of the slack by which sets may fall short after a kick for chains to be looked for."""
SLACK_SHARE = 1e-9
LIFT = 1e-6
SINGLE = 400
"""Up to this many groups × candidates every change is settled before it is taken where a whole round did not score."""


@kernel
def choose_candidates(term: FloatArray, usable: BoolArray, regret: float, candidates: IntArray) -> None:
    """Write the users with the largest terms for each group, shape (group, choice), −1 where there are no more.

    None is listed whose term is smaller than the largest by more than ``regret``. Where sets are known that fall short
    of the dual by just that, no better ones give a group to such a user: its term would cost them more.
    """
    groups, users = term.shape
    choices = candidates.shape[1]
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
        for c in range(size, choices):
            candidates[g, c] = -1


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
def kick(sets: Sets, candidates: IntArray, contested: IntArray, size: int, state: IntArray) -> None:
    """Give one to three of the first ``size`` contested groups to random candidates."""
    since = sets.group[CHECKED, candidates.shape[0]]
    for _ in range(1 + random(state, MOST_KICKED * size) % MOST_KICKED):
        g = contested[random(state, size)]
        choices = 0
        while choices < candidates.shape[1] and candidates[g, choices] >= 0:
            choices += 1
        hand_over(sets.member, sets.group, g, int(candidates[g, random(state, choices)]))
    value_changed(sets, since)


@kernel
def polish(ask: Ask, sets: Sets, candidates: IntArray, at: float, best_owner: IntArray) -> tuple[float, float]:
    """Improve, settle, and improve at the settled price again, for as long as the score rises.

    Returns the best score and its ln μ (or ln level); ``best_owner`` and ``sets`` then hold the best sets. Where sets
    improved at one price score less at their own, changes are tried one by one.
    """  # fmt: skip
    score, at, spent = settle(ask, sets, at)
    copy_owners(sets.group[OWNER], best_owner)
    for _ in range(ROUNDS):
        if is_over(ask.work):
            break
        if ask.goal == LEVEL:
            set_level(sets.user, ask.share, np.exp(at))
            if spent < ask.budget_w * (1.0 - SLACK_SHARE):  # no power lifts the level: somebody's subcarriers are full
                set_level(sets.user, ask.share, min(np.exp(at) * (1.0 + LIFT), ask.most_level))
        before = value_all(sets, price_of(ask, at))
        served = ask.goal == LEVEL and some_wanting(sets.user)
        if served:
            serve_all(sets)
        if improve(sets, candidates) == 0 and not served:
            break
        after = total_worth(sets.user)
        if after <= before + GAIN * abs(before):
            break
        found, found_at, found_w = settle(ask, sets, at)
        if found > score + GAIN * abs(score):
            score, at, spent = found, found_at, found_w
            copy_owners(sets.group[OWNER], best_owner)
            if ask.goal == POWER:
                break
            continue
        assign(sets, best_owner)
        if candidates.size > SINGLE:
            break
        found, found_at = single_changes(ask, sets, candidates, score, at)
        if found <= score + GAIN * abs(score):
            break
        score, at = found, found_at
        copy_owners(sets.group[OWNER], best_owner)
    assign(sets, best_owner)
    if ask.goal == LEVEL:
        set_level(sets.user, ask.share, np.exp(at))
    return score, at


@kernel
def price_of(ask: Ask, at: float) -> float:
    """ln of the price of power at ln μ (or ln level) ``at``."""
    return 0.0 if ask.goal == LEVEL else at


@kernel
def single_changes(ask: Ask, sets: Sets, candidates: IntArray, score: float, at: float) -> tuple[float, float]:
    """Take the best change of the first group whose best change scores; the new score and its ln μ (or ln level)."""
    if ask.goal == LEVEL:
        set_level(sets.user, ask.share, np.exp(at))
    value_all(sets, price_of(ask, at))
    first = none()
    while True:
        g, new_owner, in_return = find_change(sets, candidates, first + 1)
        if g <= first or is_over(ask.work):  # none, or round again
            return score, at
        k = int(sets.group[OWNER, g])
        change(sets, g, new_owner, in_return)
        found, found_at, _ = settle(ask, sets, at)
        if found > score + GAIN * abs(score):
            return found, found_at
        if ask.goal == LEVEL:
            set_level(sets.user, ask.share, np.exp(at))
        take_back(sets, g, k, in_return)
        value_all(sets, price_of(ask, at))
        first = g
        if first + 1 == candidates.shape[0]:
            return score, at


@kernel
def has_chains(ask: Ask, candidates: IntArray) -> bool:
    """Whether chains are worth their time: not where groups are many, nor for sums of utilities with full subcarriers.

    Sets with full subcarriers are not valued by sums over them, which is slow, and kicks alone find as good ones.
    """
    groups, users = candidates.shape
    return users >= 3 and groups <= MOST_CHAINED and (ask.goal != SUM or not ask.max_nats < np.inf)


@kernel
def restart(
    ask: Ask,
    sets: Sets,
    candidates: IntArray,
    score: float,
    at: float,
    best_owner: IntArray,
    slack: float,
    restarts: int,
    seed: int,
) -> tuple[float, float]:
    """Restart so many times; the best score and its ln μ (or ln level), as :func:`polish`.

    The first restart looks for chains from the best sets; the others kick, and look for chains where what comes of it
    is promising. Where there are no chains (:func:`has_chains`) each restart is three kicks instead. The next kick is
    from where the last one ended if that is worth less than before by no more than a share of ``slack`` (in W) that
    falls to nothing (threshold accepting), so that the search leaves wide valleys.
    """
    base, trial_owner, contested = best_owner.copy(), best_owner.copy(), best_owner.copy()
    size = contested_groups(candidates, base, contested)
    if size == 0 or restarts == 0:
        return score, at
    standard = value_all(sets, price_of(ask, at))
    here, leeway = standard, slack * np.exp(price_of(ask, at)) if slack < np.inf else 0.0
    state = np.array([seed * 2654435761 + 88172645463325252])
    chained = has_chains(ask, candidates)
    chains = empty_chains(sets.user.shape[0], base.size) if chained else empty_chains(0, 0)
    tries = restarts if chained else UNCHAINED * restarts
    for i in range(tries):
        if is_over(ask.work):
            break
        if i > 0 or not chained:
            kick(sets, candidates, contested, size, state)
        promising = -np.inf if i == 0 else here - PROMISING * leeway
        gained = improve_kicked(sets, candidates, chains, promising if chained else np.inf)
        rounding = ROUNDING * abs(standard)
        if gained > standard + rounding:
            found, found_at = polish(ask, sets, candidates, at, trial_owner)
            if found > score + GAIN * abs(score):
                score, at = found, found_at
                copy_owners(trial_owner, best_owner)
                copy_owners(trial_owner, base)
                standard = value_all(sets, price_of(ask, at))
                here = standard
                continue
            if ask.goal == LEVEL:
                set_level(sets.user, ask.share, np.exp(at))
            assign(sets, base)
            here = value_all(sets, price_of(ask, at))
        elif gained >= here - rounding - leeway * (1.0 - i / tries):
            copy_owners(sets.group[OWNER], base)
            here = gained
        else:
            go_back(sets, base)
    return score, at


@kernel
def improve_kicked(sets: Sets, candidates: IntArray, chains: Chains, promising: float) -> float:
    """Serve who lacks a rate and improve, by chains too where that is worth ``promising`` or more; what it is worth."""
    if some_wanting(sets.user):
        serve_all(sets)
    improve(sets, candidates)
    if total_worth(sets.user) >= promising and not some_wanting(sets.user):
        improve_by_chains(sets, candidates, chains)
    return total_worth(sets.user)


@kernel
def go_back(sets: Sets, owner: IntArray) -> None:
    """Return to the owners (group,), which no change improves, valuing only the sets that differ."""
    group = sets.group
    since = group[CHECKED, owner.size]
    for g in range(owner.size):
        if group[OWNER, g] != owner[g]:
            hand_over(sets.member, group, g, owner[g])
    value_changed(sets, since)
    for g in range(owner.size):
        group[CHECKED, g] = group[CHECKED, owner.size]

"""Chains of changes lead from sets that no move or swap betters to the optimum, and leave no exchange that gains."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.core.ask_kernel import Ask
from wirelessagent.deciding.core.chains_kernel import empty_chains, improve_by_chains
from wirelessagent.deciding.core.dual_kernel import channel_of
from wirelessagent.deciding.core.moves_kernel import gain_of, improve, some_wanting
from wirelessagent.deciding.core.program import LEAST_POWER, promises
from wirelessagent.deciding.core.sets_kernel import OWNER, Sets, assign, empty_sets, total_worth, value_all
from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.testing.channels import known, rayleigh_gain
from wirelessagent.testing.exhaustive import best_allocation

AMPLE = wa.Cell(max_power_w=1e6)
RATE_BPS = 1e6


def least_power_w(gain: FloatArray, owner: IntArray) -> float:
    """The power in W by which everybody gets the rate on its own subcarriers, infinite where one has none."""
    total = 0.0
    for user, row in enumerate(gain):
        noise = np.sort(AMPLE.noise_power_w / row[owner == user])
        if not noise.size:
            return np.inf
        count = np.arange(1, noise.size + 1)
        nats = RATE_BPS / AMPLE.subcarrier_bandwidth_hz * np.log(2.0)
        level = np.exp((nats + np.cumsum(np.log(noise))) / count)  # with so many of the best subcarriers filled
        filled = np.flatnonzero(level > noise)[-1]
        total += float(count[filled] * level[filled] - noise[: filled + 1].sum())
    return total


def moved_and_swapped(owner: IntArray, users: int) -> list[IntArray]:
    """All that one move or one swap leads to."""
    found: list[IntArray] = []
    for column, user in itertools.product(range(owner.size), range(users)):
        found.append(np.where(np.arange(owner.size) == column, user, owner))
    for one, other in itertools.combinations(range(owner.size), 2):
        swapped = owner.copy()
        swapped[[one, other]] = owner[[other, one]]
        found.append(swapped)
    return found


@pytest.mark.parametrize(
    ("users", "seed", "changed"),
    [(3, 12, 3), (4, 98, 3), (4, 118, 4), (3, 31, 2)],
    ids=["three users", "three of four users", "four users", "the last takes nothing"],
)
def test_a_chain_leads_on_where_no_move_or_swap_does(users: int, seed: int, changed: int) -> None:
    gain = rayleigh_gain(users, 6, seed=seed)[0]
    problem = wa.Problem(wa.plugins.objective("min_power"), min_rate_bps=RATE_BPS)
    stuck = wa.decide(known(gain), problem, AMPLE, "dual", restarts=0)
    freed = wa.decide(known(gain), problem, AMPLE, "dual", restarts=1)
    best = best_allocation(known(gain), problem, AMPLE)

    assert least_power_w(gain, stuck.owner) == pytest.approx(stuck.value, rel=1e-9)
    others = [least_power_w(gain, owner) for owner in moved_and_swapped(stuck.owner, users)]
    assert min(others) >= stuck.value * (1 - 1e-12)
    assert np.count_nonzero(stuck.owner != freed.owner) == changed
    assert best is not None
    assert stuck.value > best.value * (1 + 1e-4)
    assert freed.value == pytest.approx(best.value, rel=1e-9)


def random_sets(users: int, groups: int, seed: int) -> Sets:
    """Sets for promised rates, owned at random, whose power costs 1 per W."""
    rng = np.random.default_rng(seed)
    gain = rayleigh_gain(users, groups, seed=seed)[0]
    rows = promises(rng.uniform(2.0, 6.0, users))
    start, share = np.arange(groups + 1), np.zeros((users, 3))
    ask = Ask(LEAST_POWER, np.full(groups, np.inf), np.inf, start, rows, share, 0.0, 1e6, 0.0, TimeLimit().work)
    sets = empty_sets(channel_of(gain / AMPLE.noise_power_w, ask), start, rows, ask.work)
    assign(sets, rng.permutation(np.arange(groups) % users))
    value_all(sets, 0.0)
    return sets


def best_exchange(sets: Sets, size: int) -> float:
    """The most that any cycle of so many users gains, each of whom gives a group to the one before."""
    owner = sets.group[OWNER, :-1]
    groups, nobody = np.arange(owner.size), -np.inf
    gain = np.full((owner.size, owner.size), nobody)  # of the owner of the first, who gives it and takes the second
    for given, taken in itertools.permutations(groups.tolist(), 2):
        if owner[given] != owner[taken]:
            gain[given, taken] = gain_of(sets, int(owner[given]), given, taken)
    cycles = np.array(list(itertools.permutations(groups.tolist(), size)))
    differ = np.array([len(set(row)) == size for row in owner[cycles].tolist()])
    cycles = cycles[differ]
    return float(gain[cycles, np.roll(cycles, -1, axis=1)].sum(axis=1).max())


def test_no_exchange_is_left_that_gains() -> None:
    """All exchanges of three or four users, looked at one by one, before and after; few are left by moves and swaps."""
    users, groups, missed = 5, 10, 0
    candidates = np.tile(np.arange(users), (groups, 1))
    for seed in range(50):
        sets = random_sets(users, groups, seed)
        improve(sets, candidates)
        before = total_worth(sets.user)
        rounding = 1e-10 * abs(before)
        missed += max(best_exchange(sets, 3), best_exchange(sets, 4)) > rounding
        improve_by_chains(sets, candidates, empty_chains(users, groups))
        after = total_worth(sets.user)
        assert not some_wanting(sets.user)
        assert after >= before - rounding
        assert max(best_exchange(sets, 3), best_exchange(sets, 4)) <= rounding
        assert value_all(sets, 0.0) == pytest.approx(after, rel=1e-12)
    assert missed > 3

"""The nearest feasible requests against every assignment of small problems."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import Nearest, nearest

CELL = wa.Cell(max_power_w=5.0)
USERS, SUBCARRIERS = 3, 5
SEEDS = (1, 2, 3, 7)
RATES = (8e5, 5e5, 1.1e6)
BUDGET_W = 0.5


def estimate_of(seed: int) -> wa.ChannelEstimate:
    return wa.perfect(wa.simulate("rayleigh", CELL, num_users=USERS, num_subcarriers=SUBCARRIERS, seed=seed))


def power_for(a: FloatArray, nats: float) -> float:
    """The least power that carries ``nats`` on subcarriers of SNR per watt ``a`` (subcarrier,): water-filling."""
    if nats <= 0:
        return 0.0
    if not a.size:
        return np.inf
    best = np.sort(a)[::-1]
    for used in range(best.size, 0, -1):
        log_level = (nats - np.log(best[:used]).sum()) / used
        if np.exp(log_level) > 1 / best[used - 1]:
            return float((np.exp(log_level) - 1 / best[:used]).sum())
    raise AssertionError


def least_power(estimate: wa.ChannelEstimate, rates: Any) -> float:
    """The least power of the rates (user,), by every assignment."""
    a = estimate.gain / CELL.noise_power_w
    nats = np.asarray(rates) * np.log(2) / CELL.data_bandwidth_hz
    each = [
        {subset: power_for(a[user, list(subset)], nats[user]) for size in range(SUBCARRIERS + 1)
         for subset in itertools.combinations(range(SUBCARRIERS), size)}
        for user in range(USERS)
    ]  # fmt: skip
    owners = itertools.product(range(USERS), repeat=SUBCARRIERS)
    return min(
        sum(each[user][tuple(n for n in range(SUBCARRIERS) if owner[n] == user)] for user in range(USERS))
        for owner in owners
    )


def found(seed: int, rates: Any = RATES, **constraints: Any) -> tuple[wa.ChannelEstimate, Case, Nearest]:
    estimate = estimate_of(seed)
    problem = wa.Problem("max_rate", min_rate_bps=rates, max_power_w=BUDGET_W, **constraints)
    decision = wa.decide(estimate, problem, CELL)
    assert not decision.is_usable
    case = Case(decision=decision, estimate=estimate)
    return estimate, case, nearest(case)


@pytest.mark.parametrize("seed", SEEDS)
def test_more_power_is_the_least_that_carries_the_rates(seed: int) -> None:
    estimate, case, answer = found(seed)
    needed = least_power(estimate, RATES)
    assert answer.more_power is not None
    assert case.decision.needed_power_w is not None
    assert answer.more_power.power_w == pytest.approx(needed, rel=1e-5)
    assert case.decision.needed_power_w.at_least <= needed * (1 + 1e-9)
    assert answer.more_power.within_limit is (answer.more_power.power_w <= CELL.max_power_w)
    assert answer.more_power.decision.is_usable
    assert np.all(answer.more_power.decision.rate_bps >= np.array(RATES) * (1 - 1e-9))
    assert answer.more_power.decision.total_power_w <= answer.more_power.power_w * (1 + 1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_lower_rates_are_the_highest_that_the_budget_carries(seed: int) -> None:
    estimate, case, answer = found(seed)
    most = brentq(lambda factor: least_power(estimate, factor * np.array(RATES)) - BUDGET_W, 1e-4, 1.0, rtol=1e-6)
    lower = answer.lower_rates
    assert lower is not None
    assert lower.factor == pytest.approx(most, rel=2e-3)
    assert lower.factor <= most * (1 + 1e-6) <= lower.at_most * (1 + 2e-6)
    assert lower.decision.is_usable
    assert np.all(lower.decision.rate_bps >= lower.factor * case.promised_bps * (1 - 1e-9))
    assert lower.decision.total_power_w <= BUDGET_W * (1 + 1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_as_few_users_as_can_be_are_left_out(seed: int) -> None:
    estimate, _, answer = found(seed)
    fits = {
        left: least_power(estimate, [0.0 if user in left else RATES[user] for user in range(USERS)]) <= BUDGET_W
        for size in range(USERS)
        for left in itertools.combinations(range(USERS), size)
    }
    fewest = min((len(left) for left, does in fits.items() if does), default=None)
    if fewest is None:
        assert answer.fewer_users is None
        return
    fewer = answer.fewer_users
    assert fewer is not None
    assert len(fewer.left_out) == fewest
    assert fits[fewer.left_out]
    assert fewer.decision.is_usable
    assert np.all(np.delete(fewer.decision.rate_bps - np.array(RATES), fewer.left_out) >= -1e-3)
    assert not fewer.decision.rate_bps[list(fewer.left_out)].any()


def test_the_budgets_of_the_seeds_ask_for_one_and_for_two_to_be_left_out() -> None:
    left = {len(answer.fewer_users.left_out) for seed in SEEDS if (answer := found(seed)[2]).fewer_users is not None}
    assert left >= {1, 2}


def _cheapest(_case: Case, rest: list[int], _left: list[int]) -> int:
    """For seed 1, where only leaving out user 1 helps: the others first."""
    return rest[-1]


def _second(_case: Case, rest: list[int], _left: list[int]) -> int:
    """For seed 3, where leaving out user 3 helps: user 1 first, then user 3."""
    return rest[0] if len(rest) == USERS else rest[-1]


def test_a_bad_order_is_mended_by_trying_all(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wirelessagent.telling.facts.nearest._dearest", _cheapest)
    answer = found(1)[2].fewer_users
    assert answer is not None
    assert answer.left_out == (0,)
    assert answer.is_fewest


def test_whoever_fits_after_all_is_taken_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wirelessagent.telling.facts.nearest._dearest", _second)
    monkeypatch.setattr("wirelessagent.telling.facts.nearest._MOST_SETS", 0)
    answer = found(3)[2].fewer_users
    assert answer is not None
    assert answer.left_out == (2,)


def test_what_was_not_tried_is_not_said_to_be_proven(monkeypatch: pytest.MonkeyPatch) -> None:
    assert found(2)[2].fewer_users.is_fewest  # type: ignore[union-attr]
    monkeypatch.setattr("wirelessagent.telling.facts.nearest._MOST_SETS", 0)
    answer = found(2)[2].fewer_users
    assert answer is not None
    assert len(answer.left_out) == 2
    assert not answer.is_fewest


def test_no_power_helps_more_users_than_subcarriers() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=2, seed=1))
    decision = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=1e3), CELL)
    answer = nearest(Case(decision=decision, estimate=estimate))
    assert answer.more_power is None
    assert answer.lower_rates is None
    assert answer.fewer_users is not None
    assert len(answer.fewer_users.left_out) == 1
    assert answer.fewer_users.is_fewest


def test_who_is_not_to_be_served_is_not_taken_back() -> None:
    _, case, answer = found(1, users=("user 1", "user 3"))
    assert answer.fewer_users is None or 1 not in answer.fewer_users.left_out
    for way in (answer.more_power, answer.lower_rates, answer.fewer_users):
        assert way is None or way.decision.rate_bps[1] == 0.0
    assert case.promised_bps[1] == 0.0

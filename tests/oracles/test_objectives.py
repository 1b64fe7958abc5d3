"""Objectives against hand calculation, and the users who count in them: weights, highest rates, past averages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.objectives.max_energy_efficiency import MaxEnergyEfficiency
from wirelessagent.deciding.objectives.max_min_rate import MaxMinRate
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.deciding.objectives.min_power import MinPower
from wirelessagent.deciding.objectives.proportional_fairness import ProportionalFairness
from wirelessagent.model.errors import InputError

RATES = np.array([1e6, 4e6, 2e6])
WEIGHTS = np.array([1.0, 2.0, 0.0])
NAMES = ("user 1", "user 2", "user 3")
CELL = wa.Cell(circuit_power_w=5.0, amplifier_efficiency=0.5)


@pytest.mark.parametrize(
    ("objective", "alike", "weighed"),
    [
        (MaxRate(), 7e6, 9e6),
        (MinPower(), 2.5, 2.5),
        (MaxEnergyEfficiency(), 0.7e6, 0.9e6),
        (ProportionalFairness(), 2e6, 16e18 ** (1 / 3)),
        (MaxMinRate(), 1e6, 1e6),
        (ProportionalFairness(past_average_bps=1e6), 30e18 ** (1 / 3), 50e18 ** (1 / 3)),
        (ProportionalFairness(past_average_bps=(0.0, 4e6, 2e6)), 32e18 ** (1 / 3), 64e18 ** (1 / 3)),
    ],
)
def test_value_by_hand(objective: wa.Objective, alike: float, weighed: float) -> None:
    assert objective.value(RATES, 2.5, CELL) == pytest.approx(alike, rel=1e-12)
    assert objective.value(RATES, 2.5, CELL, WEIGHTS) == pytest.approx(weighed, rel=1e-12)


def test_the_smallest_share_counts_where_weights_are_shares() -> None:
    assert MaxMinRate().value(np.array([3e6, 2e6]), 1.0, CELL, np.array([4.0, 1.0])) == 0.75e6


def test_whoever_counts_for_nothing_may_starve() -> None:
    rates = np.array([0.0, 3e6])
    assert ProportionalFairness().value(rates, 1.0, CELL) == 0.0
    assert ProportionalFairness().value(rates, 1.0, CELL, np.array([0.0, 1.0])) == pytest.approx(3e6, rel=1e-12)
    assert MaxMinRate().value(rates, 1.0, CELL, np.array([0.0, 1.0])) == 3e6
    with pytest.raises(InputError, match="nobody's rate counts"):
        MaxRate().value(rates, 1.0, CELL, np.zeros(2))


def test_a_fair_share_pays_one_over_the_price_within_its_limits() -> None:
    price = np.array([1e-6, 1e-6, 1e-6, 0.0, 1e-320])
    low, high = np.array([0.0, 2e6, 0.0, 0.0, 0.0]), np.array([np.inf, 3e6, 0.5e6, 5e6, np.inf])
    value, rate = ProportionalFairness().conjugate(price, low, high)
    assert rate.tolist() == [1e6, 2e6, 0.5e6, 5e6, np.inf]
    assert value == pytest.approx([np.log(1e6) - 1, np.log(2e6) - 2, np.log(0.5e6) - 0.5, np.log(5e6), np.inf])


def test_what_users_have_had_counts_against_them() -> None:
    fair = ProportionalFairness(past_average_bps=(0.0, 0.4e6, 9e6))
    value, rate = fair.conjugate(np.full(3, 1e-6), np.zeros(3), np.full(3, np.inf))
    assert rate == pytest.approx([1e6, 0.6e6, 0.0])
    assert value == pytest.approx([np.log(1e6) - 1, np.log(1e6) - 0.6, np.log(9e6)])
    with pytest.raises(InputError, match="3 values for 2 users"):
        fair.utility(np.ones(2))


def test_a_long_window_is_the_schedulers_rule() -> None:
    """With T → ∞ the sum of ln(s + r) ranks allocations as Σ r/r̄ does; Viswanath, Tse and Laroia (2002)."""
    had, window = np.array([1e6, 3e6, 2e6]), 1e7
    fair = ProportionalFairness(past_average_bps=tuple((window - 1) * had))
    some = np.random.default_rng(1).uniform(0, 5e6, (20, 3))
    values = np.array([fair.value(rates, 1.0, CELL) for rates in some])
    assert np.argsort(values).tolist() == np.argsort((some / had).sum(axis=1)).tolist()


@pytest.mark.parametrize("past", [-1.0, float("nan"), float("inf"), (), (1.0, -2.0), "much"])
def test_past_averages_that_cannot_be_are_refused(past: Any) -> None:
    with pytest.raises(InputError, match="past_average_bps"):
        ProportionalFairness(past_average_bps=past)


@pytest.mark.parametrize(("alias", "name"), [("PF", "proportional_fairness"), ("max-min", "max_min_rate")])
def test_aliases(alias: str, name: str) -> None:
    assert plugins.objective(alias).name == name


# Who counts in a problem


def test_weights_are_per_user_and_zero_for_whoever_is_not_served() -> None:
    assert wa.Problem("max_rate").weights_of(3).tolist() == [1.0, 1.0, 1.0]
    assert wa.Problem("max_rate", weights=2.0, users=("user 3", "user 1")).for_users(NAMES).weights_of(3).tolist() == [
        2.0,
        0.0,
        2.0,
    ]
    assert wa.Problem("max_rate", weights=[1, 0, 3]).weights_of(3).tolist() == [1.0, 0.0, 3.0]
    with pytest.raises(InputError, match="weights are 0 for every user to serve"):
        wa.Problem("max_rate", weights=[1, 0, 3], users=("user 2",)).for_users(NAMES).weights_of(3)
    with pytest.raises(InputError, match="no user is called 'user 4'; the channel has user 1, user 2, user 3"):
        wa.Problem("max_rate", users=("user 4",)).for_users(NAMES)


@pytest.mark.parametrize("weights", [0.0, [0.0, 0.0]])
def test_weights_that_are_all_zero_are_refused(weights: Any) -> None:
    with pytest.raises(InputError, match="weights are all 0"):
        wa.Problem("max_rate", weights=weights)


def test_weights_mean_nothing_to_power() -> None:
    with pytest.raises(InputError, match="weights mean nothing to 'min_power'"):
        wa.Problem(MinPower(), weights=[1.0, 2.0])


def test_highest_rates_are_per_user_and_not_below_the_promised_ones() -> None:
    assert wa.Problem("max_rate").max_rates_bps(2).tolist() == [np.inf, np.inf]
    assert wa.Problem("max_rate", max_rate_bps=[1.0, np.inf]).max_rates_bps(2).tolist() == [1.0, np.inf]
    crossed = wa.Problem("max_rate", min_rate_bps=2e6, max_rate_bps=[3e6, 1e6, 1e6], users=("user 1", "user 2"))
    with pytest.raises(InputError, match=r"1 of 3 users \(user 2: 2 Mbit/s above 1 Mbit/s\)"):
        crossed.for_users(NAMES)


@pytest.mark.parametrize(
    "options",
    [
        {"resource_block_group_size": 2.5},
        {"resource_block_group_size": "2"},
        {"users": (0.5,)},
        {"outage_probability": "some"},
        {"outage_probability": float("nan")},
    ],
)
def test_a_field_of_another_kind_is_refused_by_name(options: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=next(iter(options))):
        wa.Problem("max_rate", **options)

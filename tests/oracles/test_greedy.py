"""The method greedy: exact where greed is, whole groups, and nobody left out who must have something."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.testing.channels import known, rayleigh_gain

LIMITS: dict[str, dict[str, Any]] = {
    "max_rate": {"min_rate_bps": (3e5, 0.0, 3e5, 0.0), "weights": (1.0, 2.0, 0.0, 1.0)},
    "min_power": {"min_rate_bps": 3e5},
    "max_energy_efficiency": {"min_rate_bps": (3e5, 0.0, 3e5, 0.0)},
    "proportional_fairness": {"weights": (1.0, 2.0, 1.0, 1.0), "max_rate_bps": 2e6},
    "max_min_rate": {"weights": (1.0, 2.0, 1.0, 1.0)},
}


@pytest.mark.parametrize("seed", range(4))
def test_the_most_rate_goes_to_the_best_users(seed: int) -> None:
    """There each subcarrier's gain is its own, so greed finds the optimum, up to the price of power."""
    estimate = known(rayleigh_gain(4, 12, seed=seed)[0])
    best, greedy = (wa.decide(estimate, wa.Problem("max_rate"), method=name) for name in ("dual", "greedy"))
    assert np.array_equal(greedy.owner, best.owner)
    assert greedy.value == pytest.approx(best.value, rel=1e-12)
    assert greedy.bound == pytest.approx(best.bound, rel=1e-6)


@pytest.mark.parametrize("objective", LIMITS)
@pytest.mark.parametrize("seed", range(4))
def test_it_is_no_better_than_the_bound_of_dual_and_not_far_behind(seed: int, objective: str) -> None:
    estimate = known(rayleigh_gain(4, 16, seed=seed)[0])
    problem = wa.Problem(objective, resource_block_group_size=2, **LIMITS[objective])
    dual, greedy = (wa.decide(estimate, problem, method=name) for name in ("dual", "greedy"))
    assert greedy.is_usable
    sign = -1 if objective == "min_power" else 1
    assert sign * (dual.bound - greedy.value) >= -1e-9 * abs(dual.bound)
    assert sign * (dual.value - greedy.value) <= 0.5 * abs(dual.value)
    assert np.array_equal(greedy.owner[::2], greedy.owner[1::2])


@pytest.mark.parametrize("objective", ["proportional_fairness", "max_min_rate"])
def test_a_matching_serves_those_whom_turns_leave_out(objective: str) -> None:
    """As many users as subcarriers, each of use to some only: in turn the first would take what another needs."""
    gain = np.array([[1.0, 0.9, 0.0], [5.0, 0.0, 0.0], [0.0, 9.0, 0.1]]) * 1e-11
    decision = wa.decide(known(gain), wa.Problem(objective), method="greedy")
    assert np.array_equal(decision.owner, [1, 0, 2])
    assert np.all(decision.rate_bps > 0)


def test_promises_that_the_price_of_power_would_not_pay_come_first() -> None:
    """A far user's promise takes most of the budget, which the near user's rate would be worth more for."""
    gain = np.array([[1e-15, 2e-15, 1e-15], [1e-9, 2e-9, 1e-9]])
    promised = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=(1.0, 0.0)), method="greedy")
    assert promised.rate_scaling is not None
    rate_bps = 0.99 * promised.rate_scaling.at_least
    for objective in ("max_rate", "max_energy_efficiency"):
        decision = wa.decide(known(gain), wa.Problem(objective, min_rate_bps=(rate_bps, 0.0)), method="greedy")
        assert decision.is_usable
        assert decision.rate_bps[0] >= rate_bps * (1 - 1e-9)

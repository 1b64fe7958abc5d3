"""Problems at the edges of what can be asked, each of which once went wrong."""

from __future__ import annotations

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.model.errors import InputError
from wirelessagent.testing.channels import known, rayleigh_gain
from wirelessagent.testing.exhaustive import best_allocation
from wirelessagent.testing.random_problems import random_problem

GAIN = np.array([[1, 1 / 2, 1 / 3, 1 / 5], [1 / 2, 1, 1 / 7, 1 / 3]])
METHODS = ("dual", "exact", "greedy")


@pytest.mark.parametrize("method", METHODS)
def test_rates_below_rounding_keep_the_budget(method: str) -> None:
    problem = wa.Problem("max_min_rate", max_power_w=1e-9)
    decision = wa.decide(known(GAIN * 1e-21), problem, wa.Cell(max_power_w=1e6), method)
    assert 0 < decision.total_power_w <= 1e-9 * (1 + 1e-9)
    assert 0 < decision.value <= decision.bound


@pytest.mark.parametrize("method", METHODS)
def test_a_promise_that_can_hardly_be_carried_does_not_keep_the_others_down(method: str) -> None:
    """Sets by the prices do not carry it within the caps, and those that do leave most of the power."""
    case = random_problem(1438, wa.plugins.objective("max_min_rate"), num_users=2, num_subcarriers=7)
    best = best_allocation(case.estimate, case.problem, case.cell)
    assert best is not None
    decision = wa.decide(case.estimate, case.problem, case.cell, method)
    assert decision.value >= (0.8 if method == "greedy" else 1 - 1e-6) * best.value


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("limits", [{"weights": [1, 2]}, {"resource_block_group_size": 2}, {"max_rate_bps": 1e6}])
def test_without_circuit_power_the_best_efficiency_is_approached(method: str, limits: dict[str, object]) -> None:
    problem = wa.Problem("max_energy_efficiency", **limits)
    decision = wa.decide(known(GAIN * 1e-12), problem, wa.Cell(circuit_power_w=0), method)
    assert decision.status == "optimal"
    assert decision.value > 0
    assert "only approached" in decision.reason


@pytest.mark.parametrize("method", METHODS)
def test_next_to_nothing_promised_has_a_bound(method: str) -> None:
    decision = wa.decide(known(GAIN * 1e-12), wa.Problem("min_power", min_rate_bps=1e-300), wa.Cell(), method)
    assert decision.is_usable
    assert 0 < decision.bound <= decision.value * (1 + 1e-9)


def test_what_is_out_of_range_is_named() -> None:
    with pytest.raises(InputError, match=r"weights lie more than 1e\+12 times apart"):
        wa.Problem("max_rate", weights=[1, 1e99])
    with pytest.raises(InputError, match=r"seed must be below 2\^63"):
        wa.decide(known(GAIN * 1e-12), wa.Problem("max_min_rate"), wa.Cell(), "dual", seed=2**70)


@pytest.mark.parametrize("name", ["proportional_fairness", "max_rate", "max_energy_efficiency", "max_min_rate"])
def test_one_thread_takes_many_channels_at_once(name: str) -> None:
    gain = np.stack([rayleigh_gain(3, 6, seed=seed)[0] for seed in range(5)])
    problem = wa.Problem(name, min_rate_bps=1e5)
    batch = wa.decide_batch(gain, problem, workers=1)
    for i in range(5):
        assert wa.decide(known(gain[i]), problem).value == pytest.approx(batch.value[i], rel=1e-9)
    alone = wa.decide_batch(gain[0], problem)
    assert alone.value.shape == ()
    assert float(alone.value) == batch.value[0]

"""The contract suite does the work; what is left are the cases with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from alpha_fairness import AlphaFairness

import wirelessagent as wa


class TestAlphaFairness(wa.testing.ObjectiveContract):
    objective = AlphaFairness()


class TestAlmostSumRate(wa.testing.ObjectiveContract):
    objective = AlphaFairness(alpha=0.1)


class TestProportionalFairness(wa.testing.ObjectiveContract):
    objective = AlphaFairness(alpha=1)


class TestAlmostMaxMin(wa.testing.ObjectiveContract):
    objective = AlphaFairness(alpha=6)


RATES = np.array([1e6, 4e6])


@pytest.mark.parametrize(
    ("alpha", "mean"),
    [(1.0, 2e6), (2.0, 1.6e6)],
    ids=["geometric", "harmonic"],
)
def test_value_is_the_mean_rate_of_its_kind(alpha: float, mean: float) -> None:
    assert AlphaFairness(alpha=alpha).value(RATES, 1.0, wa.Cell()) == pytest.approx(mean, rel=1e-12)


def test_weights_count_a_user_as_often() -> None:
    value = AlphaFairness(alpha=3).value(RATES, 1.0, wa.Cell(), np.array([1.0, 2.0]))
    assert value == pytest.approx(AlphaFairness(alpha=3).value(np.array([1e6, 4e6, 4e6]), 1.0, wa.Cell()), rel=1e-12)


def test_a_user_without_a_rate_makes_it_worthless() -> None:
    assert AlphaFairness().value(np.array([0.0, 4e6]), 1.0, wa.Cell()) == 0.0
    assert AlphaFairness().utility(np.array([0.0, 4e6])).tolist() == [-np.inf, -0.25e-6]


@pytest.mark.parametrize("alpha", [0, -1, float("nan"), float("inf")])
def test_alpha_out_of_range_is_refused(alpha: float) -> None:
    with pytest.raises(wa.InputError, match="alpha must be more than zero"):
        AlphaFairness(alpha=alpha)


def test_it_is_found_by_name_once_installed() -> None:
    assert wa.plugins.objective("alpha_fairness", {"alpha": "1"}) == AlphaFairness(alpha=1)
    assert wa.plugins.plugin("objective", "alpha_fairness").package == "wirelessagent-alpha-fairness"


def test_a_method_for_any_objective_decides_by_it() -> None:
    scene = wa.simulate("rayleigh", num_users=4, seed=1)
    estimate = wa.repair(scene.observe())
    decision = wa.decide(estimate, wa.Problem("alpha_fairness"), scene.cell, method="round_robin")
    assert decision.is_usable
    assert decision.value == pytest.approx(AlphaFairness().value(decision.rate_bps, decision.total_power_w, scene.cell))

"""The contract suite does the work; what is left are the cases with known answers."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

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


@pytest.fixture(scope="module")
def channel() -> tuple[wa.ChannelEstimate, wa.Cell]:
    scene = wa.simulate("rayleigh", num_users=4, num_subcarriers=16, seed=1)
    return wa.perfect(scene), scene.cell


@pytest.mark.parametrize("alpha", [0.5, 1.0, 2.0, 4.0])
def test_the_default_method_solves_it_with_a_certificate(
    channel: tuple[wa.ChannelEstimate, wa.Cell], alpha: float
) -> None:
    estimate, cell = channel
    decision = wa.decide(estimate, wa.Problem(AlphaFairness(alpha=alpha)), cell)
    assert (decision.method, decision.unit) == ("dual", "bit/s")
    assert decision.is_usable
    value = AlphaFairness(alpha=alpha).value(decision.rate_bps, decision.total_power_w, cell)
    assert decision.value == pytest.approx(value, rel=1e-9)
    assert decision.value <= decision.bound * (1 + 1e-9)
    assert decision.gap < 0.05
    turns = wa.decide(estimate, wa.Problem(AlphaFairness(alpha=alpha)), cell, method="round_robin")
    assert turns.value < decision.value


def test_what_it_declares_lets_optima_be_proven(channel: tuple[wa.ChannelEstimate, wa.Cell]) -> None:
    estimate, cell = channel
    decision = wa.decide(estimate, wa.Problem(AlphaFairness(alpha=2)), cell, method="exact")
    assert decision.status == "optimal"


def test_with_alpha_one_it_is_proportional_fairness(channel: tuple[wa.ChannelEstimate, wa.Cell]) -> None:
    estimate, cell = channel
    limits = {"weights": (1.0, 3.0, 1.0, 2.0), "min_rate_bps": (0.0, 0.0, 3e5, 0.0)}
    ours = wa.decide(estimate, wa.Problem(AlphaFairness(alpha=1), **limits), cell)
    theirs = wa.decide(estimate, wa.Problem("proportional_fairness", **limits), cell)
    assert ours.value == pytest.approx(theirs.value, rel=1e-9)
    assert ours.bound == pytest.approx(theirs.bound, rel=1e-6)
    assert ours.rate_bps[2] >= 3e5 * (1 - 1e-9)


def test_compare_lists_every_method_that_solves_it(channel: tuple[wa.ChannelEstimate, wa.Cell]) -> None:
    estimate, cell = channel
    found = {one.method: one.decision for one in wa.compare(estimate, wa.Problem("alpha_fairness"), cell)}
    assert found.keys() >= {"dual", "greedy", "equal_power", "round_robin"}
    assert "paper" not in found
    best = found["dual"]
    assert all(one.value <= best.bound * (1 + 1e-9) for one in found.values() if one.is_usable)


def answered(*arguments: str) -> dict[str, object]:
    """What the command line prints as JSON."""
    command = [sys.executable, "-m", "wirelessagent", *arguments, "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_command_line_solves_it(tmp_path: Path) -> None:
    gains = tmp_path / "gains.csv"
    np.savetxt(gains, 1e-11 * np.random.default_rng(1).exponential(size=(3, 8)), delimiter=",")
    decided = answered("solve", str(gains), "--objective", "alpha_fairness", "--alpha", "1")
    assert (decided["objective"], decided["method"]) == ("alpha_fairness", "dual")
    assert decided["gap"] < 0.1


def test_an_operator_may_ask_for_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WIRELESSAGENT_STORE_URL", str(tmp_path / "audit.sqlite3"))  # not among the user's own turns
    asked = answered("ask", "Share alpha-fairly with at most 10 W")
    assert asked["decision"]["objective"] == "alpha_fairness"
    assert asked["decision"]["method"] == "dual"

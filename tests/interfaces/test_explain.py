"""What people are told of a decision: its figure, the users' weights, and what prices mean for each objective."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.deciding.objectives.proportional_fairness import ProportionalFairness
from wirelessagent.model.phrases import phrases
from wirelessagent.model.units import human
from wirelessagent.telling.explanation import certificate_line, explain

SCENE = wa.simulate("rayleigh", num_users=4, seed=1)
ESTIMATE = wa.perfect(SCENE)


@dataclass(frozen=True, kw_only=True)
class Mean(MaxRate):
    """Somebody else's objective, which names its figure in English alone."""

    name = "mean"
    figure_name = phrases(en=["mean rate"])

    def figure(self, utility: float, weight: float) -> float:
        return utility / weight


def decided(objective: str | wa.Objective, prices: dict[str, Any] | None = None, **problem: Any) -> wa.Decision:
    """A decision by equal shares, as if it had been found at the given prices."""
    plain = wa.decide(ESTIMATE, wa.Problem(objective), SCENE.cell, method="round_robin")
    return replace(plain, problem=replace(plain.problem, **problem), **(prices or {}))


def told(decision: wa.Decision, language: str = "en") -> str:
    outcome = wa.SimulatedBaseStation(SCENE).apply(decision)
    return " ".join(explain(ESTIMATE, wa.report(decision, outcome), language=language))


@pytest.mark.parametrize(
    ("objective", "language", "name"),
    [
        ("proportional_fairness", "en", "users' geometric mean rate"),
        ("proportional_fairness", "zh", "几何平均速率"),
        ("max_min_rate", "en", "users' lowest rate"),
        ("max_min_rate", "zh", "最低速率"),
        (Mean(), "en", "users' mean rate"),
        (Mean(), "zh", "mean rate"),
    ],
)
def test_a_figure_that_its_unit_does_not_explain_is_named(objective: Any, language: str, name: str) -> None:
    decision = decided(objective)
    assert name in told(decision, language)
    assert human(decision.value, "bit/s") in told(decision, language)


def test_the_report_shows_the_objectives_own_figure_predicted_and_achieved() -> None:
    decision = decided("max_min_rate")
    report = wa.report(decision, wa.SimulatedBaseStation(SCENE).apply(decision))
    lowest = human(float(decision.rate_bps.min()), "bit/s")
    assert report.figures()[0] == ("Lowest rate", lowest, lowest)
    assert "Lowest rate" in str(report)
    assert wa.report(decided("max_rate")).figures()[0][0] == "Total rate"


def test_a_value_that_is_no_rate_and_has_no_name_is_not_called_the_total_rate() -> None:
    for unit, name in (("", "Value"), ("√(bit/s)", "Value"), ("bit/s", "Total rate")):
        objective = type("Unnamed", (MaxRate,), {"name": "unnamed", "unit": unit})()
        report = wa.report(decided(objective))
        assert report.figures()[0][0] == name


def test_weights_are_told() -> None:
    weights = (1.0, 3.0, 0.5, 1.0)
    assert "by their weights, from 0.5 to 3" in told(decided("max_rate", weights=weights))
    assert "in proportion to their weights, from 0.5 to 3" in told(decided("max_min_rate", weights=weights))
    assert "by their weights" not in told(decided("max_rate", weights=2.0))


def test_whoever_cannot_be_served_is_named() -> None:
    gain = np.array([[1e-10, 1e-10], [0.0, 0.0]])
    estimate = replace(
        ESTIMATE, gain=gain, gain_variance=0 * gain, repaired=gain < 0, unobserved_users=np.zeros(2, dtype=bool),
        user_names=("near", "far"),
    )  # fmt: skip
    decision = wa.decide(estimate, wa.Problem(ProportionalFairness()), method="round_robin")
    said = " ".join(explain(estimate, wa.report(decision)))
    assert "Far cannot be given any rate here, and that makes the geometric mean rate zero" in said


def test_a_dead_channel_is_not_told_as_a_lack_of_promises() -> None:
    estimate = replace(ESTIMATE, gain=0 * ESTIMATE.gain, gain_variance=0 * ESTIMATE.gain)
    said = " ".join(explain(estimate, wa.report(wa.decide(estimate, wa.Problem("max_rate"), method="round_robin"))))
    assert "No rate is promised" not in said
    nothing_asked = wa.decide(ESTIMATE, wa.Problem("min_power"), method="paper_inversion")
    assert "No rate is promised" in " ".join(explain(ESTIMATE, wa.report(nothing_asked)))


def test_groups_are_said_to_cost_what_the_bound_without_them_proves() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=3, num_subcarriers=12, seed=2))
    for problem in (wa.Problem("max_rate"), wa.Problem("min_power", min_rate_bps=1e6)):
        grouped = replace(problem, resource_block_group_size=4)
        decision = wa.decide(estimate, grouped)
        bound = wa.decide(estimate, problem).bound
        cost = round(100 * abs(1 - decision.value / bound), 9)
        said = [part for part in explain(estimate, wa.report(decision)) if "groups of 4" in part]
        assert len(said) == 1
        assert f"at most {cost:.2g} %" in said[0]
        assert not [part for part in explain(estimate, wa.report(wa.decide(estimate, problem))) if "groups" in part]


def test_rounding_is_no_gap_and_many_times_the_bound_is_a_factor() -> None:
    plain = decided("max_rate")
    near = replace(plain, status="feasible", gap=7.4e-14, bound=plain.value)
    assert "within 0 % of that" in told(near)
    assert "proven to be the best" in certificate_line(near)
    power = wa.decide(ESTIMATE, wa.Problem("min_power", min_rate_bps=1e5), SCENE.cell, method="round_robin")
    far = replace(power, bound=power.value / 14.0, gap=13.0, status="feasible")
    assert "this decision is 14 times that" in told(far)
    assert "14 倍" in told(far, "zh")


def test_rates_are_promised_where_some_were_asked_for_and_committed_elsewhere() -> None:
    assert "Every planned rate was kept" in told(decided("max_rate"))
    assert "所有计划速率都已兑现" in told(decided("max_rate"), "zh")
    assert "Every rate asked for was reached" in told(decided("max_rate", min_rate_bps=1e3))


def test_fairness_is_among_those_to_be_served() -> None:
    decision = decided("max_rate", users=("user 2", "user 4"))
    decision = replace(decision, rate_bps=np.array([0.0, 2e6, 0.0, 2e6]))
    report = wa.report(decision, wa.SimulatedBaseStation(SCENE).apply(decided("max_rate")))
    assert report.predicted.jain_index == 1.0
    assert report.achieved is not None
    rate = report.achieved.user_rate_bps[[1, 3]]
    assert report.achieved.jain_index == pytest.approx(rate.sum() ** 2 / (2 * np.square(rate).sum()))


def test_who_cannot_be_served_is_said_once() -> None:
    crowd = wa.perfect(wa.simulate("rayleigh", num_users=4, num_subcarriers=3, seed=1))
    decision = wa.decide(crowd, wa.Problem("proportional_fairness"))
    said = " ".join(explain(crowd, wa.report(decision)))
    assert said.count("User 4") == 1
    assert "1 of 4 users cannot be served: there are only 3 subcarriers" in certificate_line(decision)
    grouped = wa.decide(
        crowd, wa.Problem("max_min_rate", resource_block_group_size=2, users=("user 1", "user 2", "user 3"))
    )
    assert "1 of 3 users cannot be served: there are only 2 resource-block groups" in certificate_line(grouped)


@pytest.mark.parametrize(
    ("language", "same", "band"),
    [("en", "it would have been the same", "from"), ("zh", "结果也一样", "之间")],
)
def test_what_hardly_differs_is_told_as_the_same(language: str, same: str, band: str) -> None:
    """Nearly certain gains: no band of one figure, no probability of 100 %, no cost of a hundred-thousandth."""
    scene = wa.simulate("rayleigh", num_users=5, num_subcarriers=24, rms_delay_spread_s=100e-9, seed=1)
    seen = wa.repair(scene.observe(wa.loss.random(0.2), seed=1))
    decision = wa.decide(seen, wa.Problem("max_min_rate"), scene.cell)
    forecast = decision.forecast
    assert forecast is not None
    report = wa.report(decision, wa.SimulatedBaseStation(scene).apply(decision))
    assert 0 < abs(report.regret) < 5e-4
    said = " ".join(explain(seen, report, language=language))
    assert same in said
    assert "100 %" not in said
    shown = {human(rate, "bit/s") for rate in (forecast.sum_low_bps, forecast.sum_high_bps)}
    assert (band in said) == (len(shown) == 2)

"""The picture of prices shows the decision's own figures, and what it draws as a proof is one."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.pictures.prices_picture import bids_w, draw_prices, prices_canvas

CELL = wa.Cell(max_power_w=20)
PROBLEMS = {
    "sum": wa.Problem("proportional_fairness", max_power_w=10),
    "power": wa.Problem("min_power", min_rate_bps=3e5, resource_block_group_size=2),
    "efficiency": wa.Problem("max_energy_efficiency", min_rate_bps=3e5),
    "level": wa.Problem("max_min_rate"),
}


def a_decision(problem: wa.Problem):
    """A channel of 3 users on 12 subcarriers, and what is decided on it."""
    scene = wa.simulate("rayleigh", CELL, num_users=3, num_subcarriers=12, rms_delay_spread_s=200e-9, seed=4)
    estimate = wa.perfect(scene)
    return estimate, wa.decide(estimate, problem, CELL, method="dual")


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS.keys())
def test_the_curve_is_a_bound_and_touches_the_decisions(problem):
    estimate, decision = a_decision(problem)
    panel = prices_canvas(estimate=estimate, decision=decision).panels[2].axes
    curve, value = panel.lines[0].get_ydata(), panel.lines[1].get_ydata()[0]
    sign = 1.0 if decision.problem.objective.direction == "max" else -1.0
    best = float((sign * curve).min())

    assert decision.value == pytest.approx(value * 10 ** round(np.log10(decision.value / value)), rel=1e-12)
    assert best >= sign * value * (1 - sign * 1e-9)
    assert best == pytest.approx(sign * value * decision.bound / decision.value, rel=1e-4)


def test_water_stands_on_the_owners_floor_up_to_one_level():
    estimate, decision = a_decision(PROBLEMS["sum"])
    panel = prices_canvas(estimate=estimate, decision=decision).panels[0].axes
    water = [bar for bar in panel.patches if bar.get_facecolor()[:3] != panel.patches[0].get_facecolor()[:3]]
    noise = CELL.noise_power_w
    floor = noise / estimate.gain[decision.owner, np.arange(12)]

    assert len(water) == np.count_nonzero(decision.power_w)
    found = {round(bar.get_x() + bar.get_width() / 2) - 1: bar for bar in water}
    for subcarrier, bar in found.items():
        assert bar.get_y() == pytest.approx(floor[subcarrier], rel=1e-12)
        assert bar.get_height() == pytest.approx(decision.power_w[subcarrier], rel=1e-9)
    for user in range(3):
        tops = [bar.get_y() + bar.get_height() for n, bar in found.items() if decision.owner[n] == user]
        assert np.ptp(tops) <= 1e-6 * max(tops)


def test_worths_are_the_most_that_power_can_earn():
    estimate, decision = a_decision(wa.Problem("proportional_fairness", subcarrier_max_power_w=0.3, max_power_w=3))
    form = NormalForm.of(Dual(), estimate, decision.problem, CELL)
    price = np.exp(decision.prices.log_rate)
    power_w = np.linspace(0.0, 0.3, 20001)
    earned = price[:, None, None] * np.log1p(power_w * form.snr_per_w[..., None]) - power_w

    assert bids_w(form, price) == pytest.approx(earned.max(axis=2), rel=1e-6, abs=1e-9)


def test_it_is_written_as_a_file(tmp_path: Path):
    estimate, decision = a_decision(PROBLEMS["power"])
    draw_prices(estimate=estimate, decision=decision, path=tmp_path / "prices.png")

    assert (tmp_path / "prices.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("problem", "why"),
    [
        (wa.Problem("max_rate"), "has no prices"),
        (wa.Problem("min_power", min_rate_bps=1e9), "infeasible"),
    ],
)
def test_without_prices_or_an_allocation_the_error_says_so(problem, why):
    estimate, decision = a_decision(problem)

    with pytest.raises(wa.InputError, match=why):
        prices_canvas(estimate=estimate, decision=decision)


def test_prices_without_an_allocation_are_refused():
    estimate, decision = a_decision(PROBLEMS["sum"])

    with pytest.raises(wa.InputError, match="undecided and allocates nothing"):
        prices_canvas(estimate=estimate, decision=dataclasses.replace(decision, status="undecided"))


def test_more_users_than_colours_are_refused():
    _, decision = a_decision(PROBLEMS["sum"])
    many = wa.perfect(wa.simulate("rayleigh", CELL, num_users=9, num_subcarriers=12, seed=0))

    with pytest.raises(wa.InputError, match="at most 8 users; got 9"):
        prices_canvas(estimate=many, decision=decision)

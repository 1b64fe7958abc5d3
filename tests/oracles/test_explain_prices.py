"""Marginal prices against the slope of the bound, and finite steps against a problem solved by itself."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.steps import marginal_prices, power_step, promise_step, rate_step

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=4, num_subcarriers=8, seed=6)
ESTIMATE = wa.perfect(SCENE)
_CLOSE = 2e-3


def case_of(objective: str, method: str | None = None, **constraints: Any) -> Case:
    problem = wa.Problem(objective, **{"max_power_w": 10.0, **constraints})
    return Case(decision=wa.decide(ESTIMATE, problem, CELL, method), estimate=ESTIMATE, method=method)


def bound(case: Case, **changes: Any) -> float:
    return wa.decide(ESTIMATE, replace(case.problem, **changes), CELL, "dual", restarts=0).bound


def between(price: float, below: float, at: float, above: float, step: float) -> bool:
    """Whether a price lies between the slopes on either side, as that of a curve without dents does."""
    slopes = sorted(((above - at) / step, (at - below) / step))
    slack = _CLOSE * max(abs(slope) for slope in slopes) + 1e-9 * abs(at) / step
    return slopes[0] - slack <= price <= slopes[1] + slack


CASES = {
    "most rate": ("max_rate", {}),
    "weights": ("max_rate", {"weights": (1.0, 2.0, 1.5, 1.2)}),
    "most rate with promises": ("max_rate", {"min_rate_bps": 4e5}),
    "fair": ("proportional_fairness", {}),
    "fair with promises": ("proportional_fairness", {"min_rate_bps": (1.2e6, 0.0, 0.0, 0.0)}),
    "max-min": ("max_min_rate", {}),
    "efficient": ("max_energy_efficiency", {}),
    "efficient on a tight budget": ("max_energy_efficiency", {"max_power_w": 0.1}),
    "least power": ("min_power", {"min_rate_bps": (5e5, 2e5, 8e5, 1e6)}),
}


@pytest.mark.parametrize("name", CASES)
def test_prices_are_slopes_of_the_bound(name: str) -> None:
    objective, constraints = CASES[name]
    case = case_of(objective, **constraints)
    assert case.decision.is_usable
    prices, at = marginal_prices(case), bound(case)
    budget = case.problem.budget_w(CELL)
    step = 1e-3 * budget
    around = (bound(case, max_power_w=budget - step), at, bound(case, max_power_w=budget + step))
    assert between(prices.power, *around, step)
    for user in np.flatnonzero(case.promised_bps > 0).tolist():
        ends: list[float] = []
        step = 1e-3 * float(case.promised_bps[user])
        for sign in (-1, 1):
            promised = case.promised_bps.copy()
            promised[user] += sign * step
            ends.append(bound(case, min_rate_bps=promised))
        assert between(float(prices.rate[user]), ends[0], at, ends[1], step), case.estimate.user_names[user]


@pytest.mark.parametrize("circuit_w", [None, 1.0])
@pytest.mark.parametrize("seed", [3, 6, 9])
def test_rates_promised_efficiently_have_the_slope_of_the_bound_where_the_budget_is_not_used_up(
    seed: int, circuit_w: float | None
) -> None:
    cell = CELL if circuit_w is None else replace(CELL, circuit_power_w=circuit_w)
    estimate = wa.perfect(wa.simulate("rayleigh", cell, num_users=4, num_subcarriers=10, seed=seed))
    promised, step = np.full(4, 4e5), 500.0
    decision = wa.decide(estimate, wa.Problem("max_energy_efficiency", max_power_w=20, min_rate_bps=promised), cell)
    assert decision.total_power_w < 19.0
    assert decision.price_of_rate is not None
    slopes: list[float] = []
    for user in range(4):
        ends = (promised + sign * step * (np.arange(4) == user) for sign in (-1, 1))
        problems = (replace(decision.problem, min_rate_bps=rates) for rates in ends)
        low, high = (wa.decide(estimate, problem, cell, "dual", restarts=0).bound for problem in problems)
        slopes.append((high - low) / (2 * step))
    assert min(slopes) < -1e-3
    assert decision.price_of_rate == pytest.approx(np.array(slopes), rel=2e-3, abs=1e-6)


def test_a_method_without_prices_is_told_those_of_the_problem() -> None:
    constraints = {"min_rate_bps": 4e5}
    plain, dual = (marginal_prices(case_of("max_rate", method, **constraints)) for method in ("round_robin", "dual"))
    assert plain.power == pytest.approx(dual.power, rel=1e-3)
    assert plain.rate == pytest.approx(dual.rate, rel=1e-3)
    assert dual.power > 0
    alone = marginal_prices(case_of("max_rate", "round_robin")).power
    assert alone == pytest.approx(case_of("max_rate").decision.price_of_power, rel=1e-6)


@pytest.mark.parametrize("objective", ["max_rate", "max_min_rate", "max_energy_efficiency"])
def test_a_watt_more_is_solved_anew(objective: str) -> None:
    case = case_of(objective)
    step = power_step(case, 1.5)
    assert step is not None
    alone = wa.decide(ESTIMATE, wa.Problem(objective, max_power_w=11.5), CELL)
    assert step.after.value == alone.value
    assert step.change == pytest.approx(max(alone.value - case.decision.value, 0.0), rel=1e-12)
    assert step.change <= step.most_change * (1 + 1e-9) + 1e-9 * alone.value
    assert step.change <= 1.5 * max(marginal_prices(case).power, 0.0) + 1e-6 * alone.value  # returns diminish
    assert np.isnan(step.limit_w)
    assert power_step(case, -10.0) is None


def test_one_subcarrier_has_closed_steps() -> None:
    gain = np.array([[1e-11]])
    estimate = replace(
        ESTIMATE, gain=gain, gain_variance=0 * gain, repaired=gain < 0, unobserved_users=np.zeros(1, dtype=bool),
        user_names=("only",),
    )  # fmt: skip
    a, width = 1e-11 / CELL.noise_power_w, CELL.subcarrier_bandwidth_hz
    most = Case(decision=wa.decide(estimate, wa.Problem("max_rate", max_power_w=10), CELL), estimate=estimate)
    step = power_step(most, 15.0)  # beyond what the cell may radiate
    assert step is not None
    assert step.limit_w == 20.0
    assert step.change == pytest.approx(width * np.log2((1 + 25 * a) / (1 + 10 * a)))
    least = Case(decision=wa.decide(estimate, wa.Problem("min_power", min_rate_bps=2e5), CELL), estimate=estimate)
    for more in (rate_step(least, 1e5), rate_step(least, 1e5, 0), promise_step(least, 0, 3e5)):
        assert more.level == 3e5
        assert more.step == 1e5
        assert more.change == pytest.approx((2 ** (3e5 / width) - 2 ** (2e5 / width)) / a)
    assert not rate_step(least, 1e9).after.is_usable


def test_more_for_a_user_is_more_than_it_gets() -> None:
    case = case_of("max_rate", min_rate_bps=2e5)
    best = int(np.argmax(case.decision.rate_bps))
    step = rate_step(case, 1e5, best)
    assert step.level == pytest.approx(float(case.decision.rate_bps[best]) + 1e5)
    assert step.after.rate_bps[best] >= step.level * (1 - 1e-9)
    everybody = rate_step(case, 1e5)
    assert everybody.after.problem.min_rates_bps(4).tolist() == [3e5] * 4
    capped = rate_step(case_of("max_rate", max_rate_bps=1e6), 1e5, best)
    assert capped.after.is_usable
    assert capped.after.rate_bps[best] == pytest.approx(1.1e6)


def test_the_old_allocation_still_counts_where_it_keeps_the_new_problem() -> None:
    case = case_of("max_rate")
    better = replace(case.decision, value=case.decision.value * 2)
    step = power_step(replace(case, decision=better), 1.0)
    assert step is not None
    assert step.change == 0.0
    lower = power_step(replace(case, decision=better), -1.0)
    assert lower is not None
    assert lower.change < 0.0

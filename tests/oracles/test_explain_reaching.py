"""The power that a larger value takes: handed back as the budget, it yields the value."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from questions import answer

import wirelessagent as wa
from wirelessagent.model.units import human
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.steps import for_the_total, has_reach, rate_step, reach

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=4, num_subcarriers=8, seed=6)
SEEN = wa.repair(SCENE.observe(wa.loss.random(0.3), seed=4))
AIMS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("max_rate", {}),
    ("max_rate", {"min_rate_bps": 2e5}),
    ("max_min_rate", {}),
    ("proportional_fairness", {}),
)


def case_of(objective: Any, **constraints: Any) -> Case:
    problem = wa.Problem(objective, **{"max_power_w": 10.0, **constraints})
    return Case(decision=wa.decide(SEEN, problem, CELL), estimate=SEEN)


def told(case: Case, topic: str, language: str = "en", user: int | None = None, **figures: float) -> str:
    found = answer(case, topic, language, user, **figures)
    return found[0]


@pytest.mark.parametrize(("objective", "constraints"), AIMS)
@pytest.mark.parametrize("factor", [1.0, 1.2, 0.7])
def test_the_power_that_is_told_yields_the_value(objective: str, constraints: dict[str, Any], factor: float) -> None:
    case = case_of(objective, **constraints)
    target = factor * case.decision.value
    found = reach(case, target)
    cell = dataclasses.replace(CELL, max_power_w=1e3)
    with_it = wa.decide(case.estimate, dataclasses.replace(case.problem, max_power_w=found.power_w), cell)
    assert with_it.value == pytest.approx(target, rel=5e-3)
    assert (found.power_w > CELL.max_power_w) == (found.limit_w == CELL.max_power_w)


def test_what_no_power_reaches_is_told() -> None:
    case = case_of("max_rate")
    assert np.isnan(reach(case, 1e3 * case.decision.value).power_w)
    assert "out of reach" in told(case, "step", rate_bps=1e12)
    assert "nothing" in told(case, "step", rate_bps=-1e12)
    assert not has_reach(case_of("min_power", min_rate_bps=3e5))


@pytest.mark.parametrize("language", ["en", "zh"])
def test_more_rate_costs_watts(language: str) -> None:
    case = case_of("max_rate")
    found = reach(case, case.decision.value + 5e5)
    said = told(case, "step", language, rate_bps=5e5)
    for figure in (human(found.power_w, "W"), human(found.power_w - 10, "W"), "10 W", "500 kbit/s"):
        assert figure in said
    share = told(case, "step", language, rate_share=0.1)
    assert human(1.1 * case.decision.value, "bit/s") in share
    kept = reach(case, case.decision.value, rate_step(case, 3e5, 0).after.problem)
    assert human(kept.power_w, "W") in told(case, "step", language, 0, rate_bps=3e5)
    assert "300 kbit/s" in told(case, "step", language, rate_bps=3e5, each=1.0)
    least = case_of("min_power", min_rate_bps=3e5)
    more = rate_step(least, 3e4)
    assert human(more.change, "W") in told(least, "step", language, rate_share=0.1)


@pytest.mark.parametrize("language", ["en", "zh"])
@pytest.mark.parametrize(("objective", "limits"), [("max_energy_efficiency", {}), ("min_power", {"min_rate_bps": 3e5})])
def test_a_total_is_told_in_watts_whatever_the_aim(objective: str, limits: dict[str, Any], language: str) -> None:
    case = case_of(objective, **limits)
    target = float(case.decision.rate_bps.sum()) + 5e5
    found = reach(for_the_total(case), target)
    decision = wa.decide(SEEN, wa.Problem("max_rate", max_power_w=found.power_w, **limits), CELL)
    assert decision.value == pytest.approx(target, rel=5e-3)
    said = told(case, "step", language, rate_bps=5e5)
    assert human(found.power_w, "W") in said
    assert human(case.decision.total_power_w, "W") in said

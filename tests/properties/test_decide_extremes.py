"""Gains from 1e-30 to 1 with holes and ties, budgets from 1e-9 to 1e6 W, every shape down to one: decided soundly.

Every registered objective and method, with and without promised rates and a practical link, against exhaustive search:
no NaN, no warning (they are errors here), no limit broken, no bound beaten, no wrong status.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import MissingDependencyError, UnsupportedProblemError
from wirelessagent.testing.channels import known
from wirelessagent.testing.judge import faults, verdict_on

METHODS = tuple(wa.plugins.names("method"))
CELLS = (wa.Cell(max_power_w=1e6), wa.Cell.nr(max_power_w=1e6))
SHAPES = ((1, 1), (1, 2), (2, 1), (1, 5), (5, 1), (2, 3), (3, 2), (3, 4), (4, 3), (5, 2))

every_objective = pytest.mark.parametrize("objective", wa.plugins.names("objective"))


@st.composite
def extreme_gains(draw: st.DrawFn) -> FloatArray:
    """(user, subcarrier), 1e-30 … 1, with zero entries, rows and columns, and with ties."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    shape = draw(st.sampled_from(SHAPES))
    gain = 10.0 ** rng.uniform(
        *draw(st.sampled_from([(-30.0, 0.0), (-30.0, -28.0), (-2.0, 0.0), (-14.0, -9.0)])), shape
    )
    gain[rng.uniform(size=shape) < draw(st.sampled_from([0.0, 0.3, 1.0]))] = 0.0
    if draw(st.booleans()):
        gain[rng.integers(shape[0])] = 0.0
    if draw(st.booleans()):
        gain[:, rng.integers(shape[1])] = 0.0
    if draw(st.booleans()):
        gain[:] = gain[:, :1]
    return gain


def answers(gain: FloatArray, problem: wa.Problem, cell: wa.Cell) -> list[wa.Decision]:
    found: list[wa.Decision] = []
    for method in METHODS:
        try:
            found.append(wa.decide(known(gain), problem, cell, method))
        except (UnsupportedProblemError, MissingDependencyError):
            continue
    return found


@every_objective
@given(
    gain=extreme_gains(),
    log_budget=st.floats(-9, 6),
    cell=st.sampled_from(CELLS),
    promised_bps=st.sampled_from([None, None, 1e-3, 1e3, 1e6, 1e9]),
    promised_to=st.sampled_from(["all", "the first"]),
)
@settings(max_examples=120, deadline=None, derandomize=True)
def test_extreme_input_is_decided_soundly(
    objective: str, gain: FloatArray, log_budget: float, cell: wa.Cell, promised_bps: float | None, promised_to: str
) -> None:
    limits: dict[str, Any] = {}
    if promised_bps is not None:
        limits["min_rate_bps"] = promised_bps * np.where(
            (np.arange(len(gain)) == 0) | (promised_to == "all"), 1.0, 0.0
        )  # fmt: skip
    problem = wa.Problem(wa.plugins.objective(objective), max_power_w=10.0**log_budget, **limits)
    verdict = verdict_on(known(gain), problem, cell)
    bearing = problem.min_rates_bps(len(gain)) > 0
    impossible = np.any(bearing & ~gain.any(axis=1)) or bearing.sum() > np.count_nonzero(gain.any(axis=0))
    for decision in answers(gain, problem, cell):
        assert not faults(decision, known(gain), verdict), decision.method
        assert np.all(np.isfinite(decision.power_w)), decision.method
        assert np.all(np.isfinite(decision.rate_bps)), decision.method
        if decision.is_usable:
            assert np.isfinite(decision.value), decision.method
            assert not np.isinf(decision.bound), decision.method
        if impossible:
            assert decision.status == "infeasible", decision.method
        if decision.method == "dual":
            assert not decision.is_usable or not np.isnan(decision.bound)
            assert promised_bps is not None or decision.is_usable
            alone = len(gain) == 1 or gain.shape[1] == 1
            if alone and promised_bps is None:  # nothing to search for
                assert decision.status == "optimal"


@every_objective
@given(gain=extreme_gains(), log_budget=st.floats(-9, 6), cell=st.sampled_from(CELLS), seed=st.integers(0, 99))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_extreme_limits_are_kept(objective: str, gain: FloatArray, log_budget: float, cell: wa.Cell, seed: int) -> None:
    """Caps from nothing to the budget, highest rates of zero, forbidden rows, no circuit power, weights of 1e±6."""
    rng, (users, subcarriers), budget_w = np.random.default_rng(seed), gain.shape, 10.0**log_budget
    chosen = wa.plugins.objective(objective)
    limits: dict[str, Any] = {
        "subcarrier_max_power_w": budget_w * rng.choice([0.0, 1e-6, 0.3, 1.0], subcarriers),
        "max_rate_bps": rng.choice([0.0, 1e-3, 1e5, np.inf], users),
        "forbidden": rng.uniform(size=gain.shape) < rng.choice([0.0, 0.5, 1.0], (users, 1)),
        "resource_block_group_size": int(rng.integers(2, 9)),
    }
    if chosen.measure != "power":
        limits["weights"] = 10.0 ** rng.uniform(-6, 6, users)
    limits = {name: value for name, value in limits.items() if rng.uniform() < 0.5}
    cell = dataclasses.replace(cell, circuit_power_w=float(rng.choice([0.0, 1e-9, 1e6])))
    problem = wa.Problem(chosen, max_power_w=budget_w, **limits)
    best_is_no_limit = chosen.measure == "efficiency" and cell.circuit_power_w == 0.0  # the best ratio is at no power
    verdict = None if best_is_no_limit else verdict_on(known(gain), problem, cell)
    for decision in answers(gain, problem, cell):
        assert not faults(decision, known(gain), verdict), decision.method
        assert decision.is_usable, decision.method

"""What must hold of every registered objective and method, on random problems of every combination of limits."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wirelessagent as wa
from wirelessagent.model.arrays import IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import MissingDependencyError, UnsupportedProblemError
from wirelessagent.testing.channels import known
from wirelessagent.testing.judge import faults
from wirelessagent.testing.random_problems import RandomProblem, random_problem

OBJECTIVES = tuple(wa.plugins.names("objective"))
METHODS = tuple(wa.plugins.names("method"))
ROUNDING = 1e-9
SEARCHED = 1e-6
"""Relative; a bound is the best of a search for prices, which ends a little off wherever it starts from."""

quick = settings(max_examples=40, deadline=None, derandomize=True)
every_objective = pytest.mark.parametrize("objective", OBJECTIVES)


@st.composite
def seeds(draw: st.DrawFn) -> tuple[int, int, int]:
    """A seed and a shape."""
    return draw(st.integers(0, 10_000)), draw(st.integers(1, 5)), draw(st.integers(1, 10))


def problem_of(seed: tuple[int, int, int], objective: str) -> RandomProblem:
    number, users, subcarriers = seed
    return random_problem(
        number, wa.plugins.objective(objective), num_users=users, num_subcarriers=subcarriers
    )  # fmt: skip


def decided(case: RandomProblem, method: str) -> Decision | None:
    """The method's decision; None where it refuses such problems or lacks a package."""
    try:
        return wa.decide(case.estimate, case.problem, case.cell, method)
    except (UnsupportedProblemError, MissingDependencyError):
        return None


def decisions(*cases: RandomProblem) -> Iterator[tuple[Decision, ...]]:
    """The decisions of each method that solves all the cases."""
    for method in METHODS:
        found = [decision for case in cases if (decision := decided(case, method)) is not None]
        if len(found) == len(cases):
            yield tuple(found)


def sign_of(decision: Decision) -> int:
    objective = decision.problem.objective
    assert isinstance(objective, wa.Objective)
    return -1 if objective.direction == "min" else 1


def no_worse(better: Decision, worse: Decision) -> bool:
    """Whether the bound of the easier problem is on the better side of the harder one's, both being known."""
    if np.isnan(better.bound) or np.isnan(worse.bound):
        return True
    if "infeasible" in (better.status, worse.status):  # a bound beyond the budget has proven all that it must
        return True
    slack = SEARCHED * min(abs(better.bound), abs(worse.bound))
    return better.bound == worse.bound or sign_of(better) * (better.bound - worse.bound) >= -slack


def with_limits(case: RandomProblem, **limits: Any) -> RandomProblem:
    return case._replace(problem=dataclasses.replace(case.problem, **limits))


@every_objective
@given(seed=seeds())
@quick
def test_every_limit_is_kept_and_figures_agree(objective: str, seed: tuple[int, int, int]) -> None:
    case = problem_of(seed, objective)
    for (decision,) in decisions(case):
        assert not faults(decision, case.estimate), decision.method


@every_objective
@given(seed=seeds())
@quick
def test_methods_do_not_contradict_each_other(objective: str, seed: tuple[int, int, int]) -> None:
    """No value beyond another's bound, nothing usable where another has proven that nothing is."""
    found = [decision for (decision,) in decisions(problem_of(seed, objective))]
    usable = [decision for decision in found if decision.is_usable]
    for one in usable:
        for other in found:
            pair = f"{one.method} and {other.method}"
            assert other.status != "infeasible", pair
            assert not sign_of(one) * (one.value - other.bound) > ROUNDING * abs(other.bound), pair
            if one.status == other.status == "optimal":
                assert one.value == pytest.approx(other.value, rel=2 * ROUNDING), pair


@every_objective
@given(seed=seeds(), order=st.integers(0, 99))
@quick
def test_bounds_do_not_depend_on_order(objective: str, seed: tuple[int, int, int], order: int) -> None:
    """Nor whether promises can be kept. A heuristic may find nothing in one order and then has no bound to compare."""
    case = problem_of(seed, objective)
    rng = np.random.default_rng(order)
    users, subcarriers = rng.permutation(seed[1]), rng.permutation(seed[2])
    if case.problem.resource_block_group_size > 1:
        subcarriers = np.arange(seed[2])
    for first, second in decisions(case, permuted(case, users, subcarriers)):
        if first.method == "round_robin":  # the turn of a user depends on its place
            continue
        if "undecided" not in (first.status, second.status):
            assert first.bound == pytest.approx(second.bound, rel=SEARCHED, nan_ok=True), first.method
        assert {first.status, second.status} not in ({"infeasible", "feasible"}, {"infeasible", "optimal"})
        if first.status == second.status == "optimal":
            assert first.value == pytest.approx(second.value, rel=2 * ROUNDING), first.method


@every_objective
@given(seed=seeds(), exponent=st.integers(-20, 20))
@quick
def test_gains_and_noise_together_change_nothing(objective: str, seed: tuple[int, int, int], exponent: int) -> None:
    case, factor = problem_of(seed, objective), 2.0**exponent
    cell = dataclasses.replace(case.cell, noise_psd_w_per_hz=case.cell.noise_psd_w_per_hz * factor)
    scaled = case._replace(estimate=known(case.estimate.gain * factor), cell=cell)
    for first, second in decisions(case, scaled):
        assert first.bound == pytest.approx(second.bound, rel=ROUNDING, nan_ok=True), first.method
        assert first.value == pytest.approx(second.value, rel=ROUNDING, nan_ok=True), first.method
        assert first.status == second.status, first.method


@every_objective
@given(seed=seeds(), factor=st.floats(1.0, 100.0))
@quick
def test_bounds_never_fall_with_budget(objective: str, seed: tuple[int, int, int], factor: float) -> None:
    case = problem_of(seed, objective)
    budget_w = case.problem.budget_w(case.cell)
    cell = dataclasses.replace(case.cell, max_power_w=1e3 * budget_w)
    low, high = (with_limits(case._replace(cell=cell), max_power_w=b) for b in (budget_w, factor * budget_w))
    for less, more in decisions(low, high):
        assert no_worse(more, less), (less.method, less.bound, more.bound)
        assert not (less.is_usable and more.status == "infeasible"), less.method


@every_objective
@given(seed=seeds(), factor=st.just(0.0) | st.floats(1e-9, 1.0))
@quick
def test_bounds_never_rise_with_promised_rates(objective: str, seed: tuple[int, int, int], factor: float) -> None:
    case = problem_of(seed, objective)
    least = case.problem.min_rates_bps(seed[1])
    hard, easy = with_limits(case, min_rate_bps=least), with_limits(case, min_rate_bps=factor * least)
    for more, less in decisions(hard, easy):
        assert no_worse(less, more), (less.method, less.bound, more.bound)
        assert not (more.is_usable and less.status == "infeasible"), less.method


@given(seed=st.integers(0, 10_000), subcarriers=st.integers(1, 10))
@quick
def test_one_user_gets_for_the_least_power_of_its_best_rate_that_rate(seed: int, subcarriers: int) -> None:
    case = random_problem(seed, wa.plugins.objective("max_rate"), num_users=1, num_subcarriers=subcarriers)
    forward = with_limits(case, min_rate_bps=None, max_rate_bps=None, weights=None)
    for (best,) in decisions(forward):
        if best.status != "optimal" or best.value == 0:
            continue
        promised = best.value * (1 - 1e-13)
        back = with_limits(forward, objective=wa.plugins.objective("min_power"), min_rate_bps=promised)
        for (least,) in decisions(back):
            assert least.status != "infeasible", least.method
            assert not least.bound > best.total_power_w * (1 + ROUNDING), least.method
            if least.status == "optimal":
                assert least.value == pytest.approx(best.total_power_w, rel=SEARCHED)
                again = decided(with_limits(forward, max_power_w=least.value), best.method)
                assert again is not None
                if again.status != "optimal":  # a bisection may stop short of the budget
                    continue
                assert again.value == pytest.approx(best.value, rel=ROUNDING)


@given(seed=seeds())
@quick
def test_the_largest_common_rate_needs_the_budget(seed: tuple[int, int, int]) -> None:
    """The found rate is never said to need more than the budget, and what is beyond its bound never to be carried."""
    case = problem_of(seed, "max_min_rate")
    case = with_limits(case, min_rate_bps=None, max_rate_bps=None)
    share = np.ones(seed[1]) if case.problem.weights is None else np.asarray(case.problem.weights)
    power = wa.plugins.objective("min_power")
    budget_w = case.problem.budget_w(case.cell)
    for (common,) in decisions(case):
        if not common.is_usable or common.value == 0:
            continue
        carried = with_limits(
            case, objective=power, weights=None, min_rate_bps=share * common.value * (1 - 1e-12)
        )  # fmt: skip
        for (least,) in decisions(carried):
            assert least.status != "infeasible", least.method
            assert not least.bound > budget_w * (1 + ROUNDING), least.method
        if np.isnan(common.bound):
            continue
        beyond = with_limits(case, objective=power, weights=None, min_rate_bps=share * common.bound * (1 + SEARCHED))
        for (least,) in decisions(beyond):
            assert not least.is_usable, least.method


def permuted(case: RandomProblem, users: IntArray, subcarriers: IntArray) -> RandomProblem:
    """The same problem with users and subcarriers in another order."""
    problem, limits = case.problem, {}
    for name, order in (("weights", users), ("min_rate_bps", users), ("max_rate_bps", users)):
        value = getattr(problem, name)
        limits[name] = None if value is None else np.asarray(value)[order]
    if problem.subcarrier_max_power_w is not None:
        limits["subcarrier_max_power_w"] = np.asarray(problem.subcarrier_max_power_w)[subcarriers]
    if problem.forbidden is not None:
        limits["forbidden"] = problem.forbidden[users][:, subcarriers]
    if problem.users is not None:
        served = problem.for_users(case.estimate.user_names).user_indices
        limits["users"] = tuple(f"user {place + 1}" for place in np.flatnonzero(np.isin(users, served)))
    return with_limits(case._replace(estimate=known(case.estimate.gain[users][:, subcarriers])), **limits)

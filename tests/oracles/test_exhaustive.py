"""The exhaustive search, which judges every method, against a general solver on every assignment of tiny problems."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.testing.exhaustive import best_allocation
from wirelessagent.testing.random_problems import RandomProblem, random_problem

NAMES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
OBJECTIVES = {name: wa.plugins.objective(name) for name in NAMES}


@dataclass(frozen=True, kw_only=True)
class SquareRoots(wa.Objective):
    """Σ √r: a utility that no built-in objective has."""

    name = "square_roots"
    unit = "√(bit/s)"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.sqrt(rate)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        rate = np.clip(0.25 / np.maximum(price, 1e-300) ** 2, min_rate, max_rate)
        return np.sqrt(rate) - price * rate, rate


@dataclass(frozen=True, kw_only=True)
class FirstBits(wa.Objective):
    """Σ min(r, 100 kbit/s) + r/10: a utility with a corner."""

    name = "first_bits"
    unit = "bit/s"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.minimum(rate, 1e5) + 0.1 * rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        rate = np.where(price < 0.1, max_rate, np.where(price < 1.1, np.clip(1e5, min_rate, max_rate), min_rate))
        return self.utility(rate) - price * rate, rate


class Solver:
    """The problem of one assignment in powers as shares of the budget, for scipy's SLSQP."""

    def __init__(self, case: RandomProblem, owner: tuple[int, ...]) -> None:
        estimate, problem, cell, _ = case
        self.case, self.users, count = case, estimate.num_users, estimate.num_subcarriers
        self.owner = np.repeat(owner, problem.resource_block_group_size)[:count]
        self.snr = estimate.gain[self.owner, np.arange(count)] / (
            10 ** (cell.snr_gap_db / 10) * cell.noise_psd_w_per_hz * cell.subcarrier_bandwidth_hz
        )
        may = np.ones(estimate.gain.shape, dtype=bool) if problem.forbidden is None else ~problem.forbidden
        served = np.arange(self.users) if problem.users is None else np.array(problem.users)
        self.served = np.isin(np.arange(self.users), served)
        budget = problem.max_power_w
        assert budget is not None
        self.budget = budget
        cap = np.inf if problem.subcarrier_max_power_w is None else problem.subcarrier_max_power_w
        full = (2.0 ** (cell.max_spectral_efficiency_bps_per_hz or np.inf) - 1) / np.maximum(self.snr, 1e-300)
        self.most = np.minimum(np.minimum(cap, full) / budget, 1.0)
        self.most[~(may[self.owner, np.arange(count)] & self.served[self.owner] & (self.snr > 0))] = 0.0
        self.least = np.where(self.served, problem.min_rates_bps(self.users), 0.0)
        self.limit = problem.max_rates_bps(self.users)
        self.weight = problem.weights_of(self.users)

    def rate(self, share: FloatArray) -> FloatArray:
        cell = self.case.cell
        bits = np.log1p(np.maximum(share, 0) * self.budget * self.snr) / np.log(2)
        carried = cell.subcarrier_bandwidth_hz * (1 - cell.overhead) * bits
        return np.bincount(self.owner, weights=carried, minlength=self.users)

    def best(self) -> float:
        """The best value found from a few starts, NaN if none of them keeps the limits."""
        objective = self.case.problem.objective
        assert isinstance(objective, wa.Objective)
        sign = -1.0 if objective.direction == "max" else 1.0
        scale = 1e5

        def value(share: FloatArray) -> float:
            rate = np.minimum(self.rate(share), self.limit)
            return objective.value(rate, float(share.sum()) * self.budget, self.case.cell, self.weight)

        def cost(x: FloatArray) -> float:
            share, level = x[:-1], x[-1]
            if objective.joined == "min":  # the epigraph: as large a level as all reach
                return -level
            found = value(share)
            return sign * (np.log(max(found, 1e-9)) if objective.direction == "max" else found / self.budget)

        limits = [
            {"type": "ineq", "fun": lambda x: 1.0 - x[:-1].sum()},
            {"type": "ineq", "fun": lambda x: (self.rate(x[:-1]) - self.least) / scale},
        ]
        finite = np.isfinite(self.limit)
        if finite.any():
            limits.append({"type": "ineq", "fun": lambda x: (self.limit - self.rate(x[:-1]))[finite] / scale})
        if objective.joined == "min":
            some = self.weight > 0
            limits.append(
                {"type": "ineq", "fun": lambda x: (self.rate(x[:-1]) / scale)[some] / self.weight[some] - x[-1]}
            )
        best = np.nan
        for part in (0.9, 0.3, 0.02, 0.001):
            start = np.append(np.minimum(self.most, part / self.snr.size), 0.0)
            bounds = [*((0.0, most) for most in self.most), (0.0, None)]
            found = minimize(
                cost, start, bounds=bounds, constraints=limits, method="SLSQP", options={"maxiter": 200, "ftol": 1e-13}
            ).x[:-1]
            rate = self.rate(found)
            kept = found.sum() <= 1 + 1e-7 and np.all(rate >= self.least - 1e-2) and np.all(rate <= self.limit + 1e-2)
            if kept:
                best = np.fmin(best, value(found)) if sign > 0 else np.fmax(best, value(found))
        return float(best)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of SLSQP, where steps leave the limits
@pytest.mark.parametrize("objective", [*OBJECTIVES.values(), SquareRoots(), FirstBits()], ids=lambda o: o.name)
def test_a_general_solver_on_every_assignment_finds_the_same(objective: wa.Objective) -> None:
    compared = 0
    for seed in range(3):
        case = random_problem(seed, objective, num_users=2, num_subcarriers=3)
        groups = -(-3 // case.problem.resource_block_group_size)
        values = [Solver(case, owner).best() for owner in itertools.product(range(2), repeat=groups)]
        found = best_allocation(case.estimate, case.problem, case.cell)
        if found is None:
            assert np.isnan(values).all(), seed
            continue
        if np.isnan(values).all():
            continue
        best = np.nanmin(values) if objective.direction == "min" else np.nanmax(values)
        assert found.value == pytest.approx(best, rel=2e-5, abs=1e-9), seed
        if objective.direction == "max":  # the solver may leave the limits by 1e-7, and not find the best
            assert found.value >= best * (1 - 1e-6), seed
        compared += 1
    assert compared >= 2


@pytest.mark.parametrize(
    "objective", [OBJECTIVES["max_rate"], OBJECTIVES["max_energy_efficiency"]], ids=lambda o: o.name
)
@pytest.mark.parametrize("seed", range(4))
def test_the_best_user_of_each_subcarrier_is_found(objective: wa.Objective, seed: int) -> None:
    """Without rates and weights each subcarrier goes to its best user, and the water level is searched for."""
    case = random_problem(seed, objective)
    cell, budget_w = case.cell, case.problem.max_power_w
    assert budget_w is not None
    found = best_allocation(case.estimate, wa.Problem(objective, max_power_w=budget_w), cell)
    assert found is not None
    snr = case.estimate.gain.max(axis=0) / (
        10 ** (cell.snr_gap_db / 10) * cell.noise_psd_w_per_hz * cell.subcarrier_bandwidth_hz
    )
    full = (2.0 ** (cell.max_spectral_efficiency_bps_per_hz or np.inf) - 1) / snr
    low, high, best = 1e-6 * budget_w, 10 * budget_w + 2 / snr.min(), 0.0
    for _ in range(12):
        levels = np.geomspace(low, high, 41)
        values: list[float] = []
        for level in levels:
            power = np.clip(level - 1 / snr, 0.0, full)
            power *= min(1.0, budget_w / max(power.sum(), 1e-300))
            rate = cell.subcarrier_bandwidth_hz * (1 - cell.overhead) * np.log2(1 + power * snr)
            values.append(objective.value(rate, float(power.sum()), cell))
        top = int(np.argmax(values))
        low, high, best = levels[max(top - 2, 0)], levels[min(top + 2, 40)], max(best, values[top])
    assert found.value >= best * (1 - 1e-12)
    assert found.value == pytest.approx(best, rel=1e-10)


@pytest.mark.parametrize("objective", [*OBJECTIVES.values(), SquareRoots(), FirstBits()], ids=lambda o: o.name)
def test_the_search_proves_its_own_answers(objective: wa.Objective) -> None:
    """By weak duality alone: what it says to be the limit of all assignments is next to the allocation it gives."""
    away: list[float] = []
    for seed in range(1000, 1025):
        case = random_problem(seed, objective)
        found = best_allocation(case.estimate, case.problem, case.cell)
        if found is not None and found.value != 0:
            away.append(abs(found.at_best - found.value) / abs(found.value))
            sign = 1 if objective.direction == "max" else -1
            assert sign * (found.at_best - found.value) >= -1e-13 * abs(found.value), seed
    assert len(away) > 5
    assert max(away) <= 1e-11

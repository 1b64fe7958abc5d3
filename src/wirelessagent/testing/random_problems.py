"""Seeded small problems of every combination of objective, constraints and link.

Each constraint is set or not by a draw of its own, so that a few hundred seeds meet all pairs of them and most triples.
Promised rates are near what a random allocation carries: about half of the problems with them are hard or impossible.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import subcarrier_rate_bps, user_rate_bps
from wirelessagent.model.user_names import numbered
from wirelessagent.testing.channels import known

LINKS = ("shannon", "practical", "capped", "gap")
"""Shannon's; an NR-like one; a low spectral-efficiency cap with overhead; a coding gap with a poor amplifier."""


class RandomProblem(NamedTuple):
    """A problem with the channel and the cell that it is asked for."""

    estimate: ChannelEstimate
    problem: Problem
    cell: Cell
    link: str


def random_problem(seed: int, objective: Objective, *, num_users: int = 3, num_subcarriers: int = 6) -> RandomProblem:
    """The problem of this seed. The same seed has the same channel, cell and limits for every objective.

    Users' levels are up to 30 dB apart, and the SNR at an equal share of the budget is from −10 to 40 dB for the best
    user; one channel in four has pairs without any gain.
    """
    rng = np.random.default_rng([seed, num_users, num_subcarriers])
    shape = (num_users, num_subcarriers)
    link = LINKS[int(rng.integers(len(LINKS)))]
    cell = _cell(link, circuit_power_w=float(10.0 ** rng.uniform(-3, 1)))
    level = 10.0 ** rng.uniform(-3, 0, (num_users, 1))
    gain = 1e-11 * rng.exponential(size=shape) * level / level.max()
    if rng.uniform() < 0.25:
        gain[rng.uniform(size=shape) < 0.25] = 0.0
    snr = 10.0 ** rng.uniform(-1, 4)
    budget_w = float(snr * num_subcarriers * cell.snr_gap * cell.noise_power_w / 1e-11)
    cell = _cell(link, circuit_power_w=cell.circuit_power_w, max_power_w=budget_w * rng.choice([1.0, 2.0]))
    limits: dict[str, Any] = {"max_power_w": budget_w}
    if rng.uniform() < 0.3:
        limits["subcarrier_max_power_w"] = budget_w * 10.0 ** rng.uniform(-1.5, 0.3, num_subcarriers)
    if rng.uniform() < 0.3:
        limits["forbidden"] = rng.uniform(size=shape) < 0.3
    served = np.arange(num_users)
    if rng.uniform() < 0.3:
        served = np.sort(rng.permutation(num_users)[: rng.integers(1, num_users + 1)])
        limits["users"] = tuple(numbered(num_users)[int(user)] for user in served)
    if rng.uniform() < 0.3:
        limits["resource_block_group_size"] = int(rng.integers(2, 4))
    weights = np.round(rng.exponential(size=num_users) + 0.1, 3)
    if len(served) > 1 and rng.uniform() < 0.2:
        weights[served[0]] = 0.0
    if rng.uniform() < 0.3 and objective.measure != "power":
        limits["weights"] = weights
    rate = _carried(rng, known(gain), cell, Problem(objective, **limits).for_users(numbered(num_users)))
    promised = rng.uniform(size=num_users) < rng.choice([0.0, 0.5, 1.0])
    least = np.where(promised, rate * 10.0 ** rng.uniform(-0.5, 0.7, num_users), 0.0)
    if promised.any():
        limits["min_rate_bps"] = least
    if rng.uniform() < 0.3:
        limits["max_rate_bps"] = np.maximum(least, rate.mean() * 10.0 ** rng.uniform(-0.7, 0.7, num_users))
    return RandomProblem(known(gain), Problem(objective, **limits), cell, link)


def tiny_problem(number: int, objectives: tuple[Objective, ...]) -> RandomProblem:
    """One of a list of problems of two to four users and three to eight subcarriers, the objectives in turn."""
    rng = np.random.default_rng([number, 77])
    users, subcarriers = int(rng.integers(2, 5)), int(rng.integers(3, 9))
    objective = objectives[number % len(objectives)]
    return random_problem(5000 + number, objective, num_users=users, num_subcarriers=subcarriers)


def _cell(link: str, *, circuit_power_w: float, max_power_w: float = 20.0) -> Cell:
    if link == "practical":
        return Cell.nr(max_power_w=max_power_w, circuit_power_w=circuit_power_w)
    options: dict[str, Any] = {
        "shannon": {},
        "capped": {"max_spectral_efficiency_bps_per_hz": 2.5, "overhead": 0.3},
        "gap": {"snr_gap_db": 6.0, "amplifier_efficiency": 0.2},
    }[link]
    return Cell(max_power_w=max_power_w, circuit_power_w=circuit_power_w, **options)


def _carried(rng: np.random.Generator, estimate: ChannelEstimate, cell: Cell, problem: Problem) -> FloatArray:
    """Rates (user,) of an allocation to random users who may have the subcarriers, at equal power."""
    gain, (num_users, num_subcarriers) = estimate.gain, estimate.gain.shape
    group = np.arange(num_subcarriers, dtype=np.int64) // problem.resource_block_group_size
    owner: IntArray = np.asarray(rng.integers(num_users, size=num_subcarriers), dtype=np.int64)[group]
    may = (gain > 0) & problem.serves(num_users)[:, np.newaxis] & problem.allows((num_users, num_subcarriers))
    cap = np.inf if problem.subcarrier_max_power_w is None else problem.subcarrier_max_power_w
    power = np.minimum(problem.budget_w(cell) / num_subcarriers, cap)
    power = np.where(may[owner, np.arange(num_subcarriers)], power, 0.0)
    rate = user_rate_bps(gain, owner, power, cell)
    some = subcarrier_rate_bps(gain, power, cell).max(axis=1) / 2
    return np.where(rate > 0, rate, some)

"""Simple allocations that the contract suites compare methods with; independent of every method."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision, Status
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import normalised_gain, owned_gain, user_rate_bps
from wirelessagent.model.scene import Scene

_RANDOM_OWNERS = 15
_BUDGET_SHARES = (1.0, 0.5, 0.2, 0.05, 0.01)


def allocations(gain: FloatArray, problem: Problem, cell: Cell) -> Iterator[tuple[FloatArray, float]]:
    """Rates (user,) in bit/s and power in W of allocations that keep the budget, the promised and the highest rates.

    Best and random owners, water-filled with parts of the budget and cut to the highest rates; and for each user just
    the power for its rate. Other constraints of the problem are not looked at.
    """
    rng = np.random.default_rng(0)
    num_users, num_subcarriers = gain.shape
    budget_w, least, most = problem.budget_w(cell), problem.min_rates_bps(num_users), problem.max_rates_bps(num_users)
    in_turn = np.mod(np.arange(num_subcarriers, dtype=np.int64), num_users)
    owners: list[IntArray] = [gain.argmax(axis=0), in_turn]
    owners += [rng.integers(0, num_users, num_subcarriers) for _ in range(_RANDOM_OWNERS)]
    for owner in owners:
        a = normalised_gain(owned_gain(gain, owner), cell)
        powers = [_water_filling(a, share * budget_w) for share in _BUDGET_SHARES]
        powers.append(_just_enough(a, owner, least / cell.data_bandwidth_hz))
        for power in powers:
            above = user_rate_bps(gain, owner, power, cell) > most
            enough = _just_enough(a, owner, np.where(above, most, 0.0) / cell.data_bandwidth_hz)
            cut = np.where(above[owner], np.minimum(power, enough), power)
            rate = user_rate_bps(gain, owner, cut, cell)
            if cut.sum() <= budget_w and np.all(rate >= least):
                yield rate, float(cut.sum())


def equal_power_decision(scene: Scene, objective: Objective, *, status: Status = "feasible") -> Decision:
    """Half of the cell's power spread evenly over the best owners: a decision that any base station can apply."""
    cell, gain = scene.cell, scene.sensed.current
    owner = gain.argmax(axis=0)
    power = np.full(owner.shape, cell.max_power_w / 2 / owner.size)
    rate = user_rate_bps(gain, owner, power, cell)
    usable = status in ("optimal", "feasible")
    return Decision(
        owner=owner,
        power_w=power,
        rate_bps=rate,
        status=status,
        value=objective.value(rate, float(power.sum()), cell) if usable else np.nan,
        bound=np.nan,
        gap=np.nan,
        unit=objective.unit,
        method="equal_power_decision",
        problem=Problem(objective),
        cell=cell,
        user_names=scene.sensed.user_names,
        reason="" if usable else "made so for a test",
    )


def _water_filling(a: FloatArray, budget_w: float) -> FloatArray:
    """[μ − 1/a]⁺ with Σ = budget, by dropping the worst subcarrier until the level is above the rest."""
    inverse = np.sort(1.0 / a[a > 0])
    for active in range(inverse.size, 0, -1):
        level = (budget_w + inverse[:active].sum()) / active
        if level > inverse[active - 1]:
            return _above(a, level)
    return np.zeros(a.shape)


def _just_enough(a: FloatArray, owner: IntArray, bits: FloatArray) -> FloatArray:
    """For each user the least power for ``bits`` bit/s/Hz on the subcarriers it owns; zero where it owns none."""
    power = np.zeros(a.shape)
    for user in np.flatnonzero(bits > 0):
        mine = (owner == user) & (a > 0)
        inverse = np.sort(1.0 / a[mine])
        for active in range(inverse.size, 0, -1):
            level = 2.0 ** (bits[user] * (1 + 1e-12) / active) * np.exp(np.log(inverse[:active]).mean())
            if level > inverse[active - 1]:
                power[mine] = _above(a[mine], level)
                break
    return power


def _above(a: FloatArray, level: float) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.maximum(level - 1.0 / a, 0.0)

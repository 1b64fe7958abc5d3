"""A sound method, from which the broken ones differ in one thing each."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import cast

import numpy as np

from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import subcarrier_rate_bps, user_rate_bps


@dataclass(frozen=True, kw_only=True)
class InTurn(Method):
    """Subcarriers in turn with equal power."""

    name = "in_turn"
    objectives = ("max_rate",)
    constraints = frozenset({"min_rate_bps", "subcarrier_max_power_w"})
    caught_by = ""

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        self.objective_of(problem)
        users, subcarriers = estimate.gain.shape
        power = np.full(subcarriers, problem.budget_w(cell) / subcarriers)
        if problem.subcarrier_max_power_w is not None:
            power = np.minimum(power, np.asarray(problem.subcarrier_max_power_w))
        return self._decision(np.mod(np.arange(subcarriers, dtype=np.int64), users), power, estimate, problem, cell)

    def _decision(
        self, owner: IntArray, power: FloatArray, estimate: ChannelEstimate, problem: Problem, cell: Cell
    ) -> Decision:
        objective = cast(Objective, problem.objective)
        rate = user_rate_bps(estimate.gain, owner, np.maximum(power, 0), cell)
        alone = subcarrier_rate_bps(estimate.gain.max(axis=0), np.asarray(problem.budget_w(cell)), cell)
        kept = bool(np.all(rate >= problem.min_rates_bps(len(rate))))
        if not kept:
            owner, power, rate = np.full(owner.shape, -1), np.zeros(power.shape), np.zeros(rate.shape)
        decision = Decision(
            owner=owner,
            power_w=power,
            rate_bps=rate,
            status="feasible" if kept else "undecided",
            value=objective.value(rate, float(power.sum()), cell, problem.weights_of(len(rate))) if kept else np.nan,
            bound=float(alone.sum()),  # as if every subcarrier had all the power
            gap=np.nan,
            unit=objective.unit,
            reason="" if kept else "equal shares do not carry the promised rates",
            method=self.name,
            problem=problem,
            cell=cell,
            user_names=estimate.user_names,
        )
        return with_gap(decision)


def with_gap(decision: Decision) -> Decision:
    away = abs(decision.value - decision.bound)
    return dataclasses.replace(decision, gap=0.0 if away == 0 else away / abs(decision.bound))

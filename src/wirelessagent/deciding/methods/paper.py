"""The paper's own method for each of its three objectives, under one name."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from wirelessagent.deciding.method import Method
from wirelessagent.deciding.methods.paper_bisection import PaperBisection
from wirelessagent.deciding.methods.paper_inversion import PaperInversion
from wirelessagent.deciding.methods.paper_scan import PaperScan
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem

_METHODS: dict[str, Method] = {
    "max_rate": PaperBisection(),
    "min_power": PaperInversion(),
    "max_energy_efficiency": PaperScan(),
}


@dataclass(frozen=True, kw_only=True)
class Paper(Method):
    """What the paper would do: bisection (P1), channel inversion (P2) or the power scan (P3)."""

    name = "paper"
    objectives = tuple(_METHODS)
    constraints = frozenset[str]().union(*(method.constraints for method in _METHODS.values()))

    @classmethod
    def objective_of(cls, problem: Problem) -> Objective:
        """The problem's objective, after a check that the paper's method for it solves such problems."""
        objective = super().objective_of(problem)
        return _METHODS[objective.name].objective_of(problem)

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        method = _METHODS[self.objective_of(problem).name]
        return dataclasses.replace(method.solve(estimate, problem, cell), method=self.name)

"""The true optimum: for small problems, and as the judge of other methods."""

from __future__ import annotations

from dataclasses import dataclass

from wirelessagent.deciding.core.dual_decision import Plan, dual_decision
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.thorough import MOST_SETS
from wirelessagent.deciding.method import WHOLE_PROBLEM, Method
from wirelessagent.model.arrays import whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class Exact(Method):
    """Any objective with any constraints, to the proven optimum; where it is not proven, the reason says why.

    It takes some ten milliseconds for 8 users and 20 subcarriers, and mostly less than a second for 64 users and 273.
    It is the dual method's thorough search with more time. Prices of subcarriers, by column generation, bound what any
    allocation can reach and leave few sets of subcarriers that a user may hold at the optimum; an integer programme
    (HiGHS) chooses among them, and where they are many the problem is divided.

    An objective that declares no power law of the rate, such as proportional fairness with past averages, is solved
    with the power law that is nearest at the rates found: the decision is then no worse than the dual's, and its bound
    is the dual's, which rests on the conjugate.

    Attributes:
        deadline_s: time in s by which it decides on the best found so far, with its bound.
        max_sets: number of sets listed for one user before a problem is divided.
        seed: of the first search.
    """

    name = "exact"
    constraints = WHOLE_PROBLEM

    deadline_s: float | None = 60.0
    max_sets: int = MOST_SETS
    seed: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        whole("max_sets", self.max_sets)
        whole("seed", self.seed, smallest=0)

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        with self.limited():
            form = NormalForm.of(self, estimate, problem, cell)
            return dual_decision(form, Plan(restarts=None, seed=self.seed, is_thorough=True, most_sets=self.max_sets))

"""The true optimum: for small problems, and as the judge of other methods."""

from __future__ import annotations

import dataclasses
import time
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.certificate import Figures, certified
from wirelessagent.deciding.core.dual_prices import figures_of
from wirelessagent.deciding.core.dual_search import Effort, search_objective, search_promises
from wirelessagent.deciding.core.exact_search import Optimum
from wirelessagent.deciding.core.exact_start import goal_of, is_met_everywhere, shown
from wirelessagent.deciding.core.goals import Goal
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, MOST_EFFICIENCY, Program
from wirelessagent.deciding.core.search_decision import PROOF_ROUNDING, fits, unkept_decision
from wirelessagent.deciding.core.thorough import MOST_SETS, carried, make_ready, search_from
from wirelessagent.deciding.method import WHOLE_PROBLEM, Method
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import IntArray, positive, whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Bracket, Decision, Prices
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

_RESTARTS = 30
_TINY = 1e-3


@dataclass(frozen=True, kw_only=True)
class Exact(Method):
    """Any objective with any constraints, to the proven optimum.

    It takes some ten milliseconds for 8 users and 20 subcarriers, and mostly less than a second for 64 users and 273.
    It starts from the dual method's decision. Prices of subcarriers, by column generation, then bound what any
    allocation can reach and leave few sets of subcarriers that a user may hold at the optimum; an integer programme
    (HiGHS) chooses among them, and where they are many the problem is divided.

    An objective whose utility is no power law of the rate, such as proportional fairness with past averages, is solved
    with the power law that is nearest at the rates found: the decision is then no worse than the dual's, and its bound
    is the dual's.

    Attributes:
        deadline_s: time in s after which the best decision so far is returned with its bound.
        max_sets: number of sets listed for one user before a problem is divided.
        seed: of the first decision's search.
    """

    name = "exact"
    constraints = WHOLE_PROBLEM

    deadline_s: float = 60.0
    max_sets: int = MOST_SETS
    seed: int = 0

    def __post_init__(self) -> None:
        positive("deadline_s", self.deadline_s)
        whole("max_sets", self.max_sets)
        whole("seed", self.seed, smallest=0)

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        form = NormalForm.of(self, estimate, problem, cell)
        first = dataclasses.replace(Dual(seed=self.seed).solve(estimate, problem, cell), method=self.name)
        if first.status in ("optimal", "infeasible") or not _is_resolved(form):
            return first
        program = Program.of(form)
        make_ready()
        deadline = time.perf_counter() + self.deadline_s
        if not first.is_usable or first.prices is None:
            return self._carried(form, program, deadline)
        if program.goal == MOST_EFFICIENCY and form.circuit_w <= 0.0:
            return first  # the best efficiency is that of no power
        met = is_met_everywhere(form, program)
        if not met:
            program = Program.of(form, first.rate_bps / form.bps_per_nat)
        found = self._search(form, program, goal_of(form, program), first.owner, first.prices, deadline)
        figures = Figures(
            price_of_power=first.price_of_power,
            price_of_rate=first.price_of_rate,
            needed_power_w=first.needed_power_w,
            rate_scaling=first.rate_scaling,
            prices=first.prices,
            iterations=found.nodes,
        )
        decision = _decision(form, program, found, figures, first.bound if not met else None)
        return decision if _is_sound(form, decision, first) else first

    def _search(
        self, form: NormalForm, program: Program, goal: Goal, owner: IntArray, prices: Prices, deadline: float
    ) -> Optimum:
        return search_from(form, program, goal, owner, prices, deadline=deadline, most_sets=self.max_sets)

    def _carried(self, form: NormalForm, program: Program, deadline: float) -> Decision:
        """The decision where the dual method found none that keeps the promised rates."""
        least = carried(
            form, search_promises(form, Effort(restarts=_RESTARTS, seed=self.seed)), deadline, self.max_sets
        )  # fmt: skip
        if not fits(form, least):
            return unkept_decision(form, least, Effort(restarts=0, seed=self.seed))
        if program.goal == LEAST_POWER:
            return certified(form, least.owner, least.power_w, least.bound, **figures_of(form, least, least))
        start = search_objective(form, program, Effort(restarts=0, seed=self.seed), None, least.owner)
        known = start.owner if start.kept else least.owner
        best = self._search(form, start.program, goal_of(form, start.program), known, start.prices, deadline)
        bound = None if is_met_everywhere(form, start.program) else start.bound
        owner, power_w = best.allocation(goal_of(form, start.program))
        start = dataclasses.replace(start, owner=owner, power_w=power_w)
        return _decision(form, start.program, best, figures_of(form, start, least), bound)


def _decision(
    form: NormalForm, program: Program, found: Optimum, figures: Figures, bound: float | None = None
) -> Decision:
    """The decision for what was found, with its own bound unless another is given."""
    owner, power_w = found.allocation(goal_of(form, program))
    if program.goal == LEAST_POWER:
        figures["needed_power_w"] = Bracket(at_least=-found.bound, at_most=-found.x)
    proven = shown(form, program, found.bound) if bound is None else bound
    return certified(form, owner, power_w, proven, **figures)


def _is_resolved(form: NormalForm) -> bool:
    """Whether levels, which are logarithms, tell the powers apart: not where all SNRs or promised rates are tiny."""
    limits = np.concatenate([form.promised_nats, form.most_nats])
    return form.budget_w * float(form.snr_per_w.max()) > _TINY and bool(np.all(limits[limits > 0] > _TINY))


def _is_sound(form: NormalForm, decision: Decision, first: Decision) -> bool:
    """Whether a decision is no worse than the first, its bound does not contradict that, and it keeps its promises.

    Over gains that lie far apart the sets' levels lose the digits of tiny powers.
    """
    sign = 1.0 if form.objective.direction == "max" else -1.0
    slack = PROOF_ROUNDING * abs(first.value)
    promised = form.promised_nats * form.bps_per_nat
    return bool(
        sign * (decision.value - first.value) >= -slack
        and sign * (decision.bound - first.value) >= -slack
        and np.isfinite(decision.bound)
        and np.all(decision.rate_bps >= promised * (1.0 - PROOF_ROUNDING))
    )

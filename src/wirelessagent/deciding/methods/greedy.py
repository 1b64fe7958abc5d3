"""A plain, fast rule for any objective: each group of subcarriers to whoever gains most, then the exact powers."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.closed_form import closed_decision, nats_worth
from wirelessagent.deciding.core.dual_search import Effort, search_objective
from wirelessagent.deciding.core.greedy_search import search_greedily, search_objective_greedily
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program
from wirelessagent.deciding.core.scaling import searched_scaling
from wirelessagent.deciding.core.search_decision import (
    approached_decision,
    decision_of,
    fits,
    is_approached,
    unkept_decision,
    unpowered_decision,
    unservable_decision,
)
from wirelessagent.deciding.core.unserved import without_unservable
from wirelessagent.deciding.method import WHOLE_PROBLEM, Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

_NO_RESTARTS = Effort(restarts=0, seed=0)


@dataclass(frozen=True, kw_only=True)
class Greedy(Method):
    """Any objective with any constraints: each subcarrier to whoever gains most by it, water-filling within each set.

    First come users who have no set yet that carries what they must have, then whoever gains most at the price of power
    that the Lagrangian dual finds; nothing that was given away is taken back. The powers are the best on these sets.
    The sets are a heuristic; the bound, the dual at its prices, tells how far they may be from the optimum.
    """

    name = "greedy"
    constraints = WHOLE_PROBLEM

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        with self.limited():
            return _decision(NormalForm.of(self, estimate, problem, cell))


def _decision(form: NormalForm) -> Decision:
    program = Program.of(form)
    least = search_greedily(form, Program.of_promises(form)) if form.promised_nats.any() else None
    if least is not None and not fits(form, least):
        return unkept_decision(form, least, searched_scaling(form, least, _NO_RESTARTS))
    if program.goal == LEAST_POWER:
        if least is None:
            return unpowered_decision(form)
        return decision_of(form, least, least, np.empty(0, dtype=np.int64))
    if is_approached(form, program):
        return approached_decision(form, program)
    served, unserved = without_unservable(form, program)
    if not served.weight.any():
        return unservable_decision(form, least, unserved)
    program = Program.of(served) if unserved.size else program
    found = search_objective_greedily(served, program)
    if least is not None and not found.kept:  # the sets of the promises first, and what they leave
        found = search_objective_greedily(served, program, least.owner)
    if not found.kept:
        nobody = np.full(form.cap_w.size, -1, dtype=np.int64), np.zeros(form.cap_w.size)
        owner, power_w = (least.owner, least.power_w) if least is not None else nobody
        found = dataclasses.replace(found, owner=owner, power_w=power_w)
    worth = nats_worth(served)
    if worth is not None or not form.limit.is_over():
        dual = search_objective(served, program, _NO_RESTARTS) if worth is None else closed_decision(served, worth)
        found = dataclasses.replace(found, bound=dual.bound)  # whose prices fit its own sets, too
    return decision_of(form, found, least, unserved)

"""The dual method on one problem: prices, sets, restarts, and what prices of subcarriers add, as far as is wanted."""

from __future__ import annotations

import dataclasses
import sys
from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.closed_form import closed_decision, nats_worth
from wirelessagent.deciding.core.dual_search import Effort, Search, search, search_objective, search_promises, tighter
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program
from wirelessagent.deciding.core.scaling import searched_scaling
from wirelessagent.deciding.core.search_decision import (
    approached_decision,
    decision_of,
    fits,
    is_approached,
    is_proven_too_much,
    unkept_decision,
    unpowered_decision,
    unservable_decision,
)
from wirelessagent.deciding.core.thorough import MOST_SETS, carried, make_ready, tightened
from wirelessagent.deciding.core.unserved import without_unservable
from wirelessagent.model.decision import Decision, Prices

_SMALL = 400
"""Up to so many users × groups a search is restarted by default."""
_RESTARTS, _ROUND = 10, 10
"""Those of a small problem, and those of each round beyond them."""
_SETTLED_S = 1.0
"""Time for promised rates that were not found within the budget, where there is no limit."""


@dataclass(frozen=True, kw_only=True)
class Plan:
    """How far to go.

    Attributes:
        restarts: of the local search, in rounds beyond the first; None for those of the problem's size.
        seed: of the restarts.
        is_open: whether restarts end with the time only.
        is_thorough: whether to go on with prices of subcarriers.
        most_sets: number of sets listed for one user before a problem is divided.
    """

    restarts: int | None
    seed: int
    is_open: bool = False
    is_thorough: bool = False
    most_sets: int = MOST_SETS

    def effort_for(self, form: NormalForm) -> Effort:
        """The first search for a problem of this size; restarts beyond it come in rounds."""
        restarts = _RESTARTS if form.weight.size * (form.start.size - 1) <= _SMALL else 0
        return Effort(restarts=restarts if self.restarts is None else min(self.restarts, restarts), seed=self.seed)


def dual_decision(form: NormalForm, plan: Plan, after: Prices | None = None) -> Decision:
    """The decision from the prices of an earlier one, if any."""
    worth = nats_worth(form)
    if worth is not None:
        return closed_decision(form, worth)
    program, effort = Program.of(form), plan.effort_for(form)
    promised = bool(form.promised_nats.any())
    if program.goal == LEAST_POWER and not promised:
        return unpowered_decision(form)
    if is_approached(form, program):
        return approached_decision(form, program)
    started, least = form.limit.now_s, None
    if promised:
        wanted = program.goal == LEAST_POWER
        least = search(form, program, effort, after) if wanted else search_promises(form, Effort(restarts=0, seed=0))
        if not fits(form, least):
            scaling = searched_scaling(form, least, effort)
            if not is_proven_too_much(form, least):
                least = _carried(form, least, plan, improve=wanted)
            if not fits(form, least):
                return unkept_decision(form, least, scaling)
        if wanted:
            scaling = searched_scaling(form, least, effort) if plan.is_thorough else None
            least = _go_on(form, least, plan, started)
            return decision_of(form, least, least, np.empty(0, dtype=np.int64), scaling)
    served, unserved = without_unservable(form, program)
    if not served.weight.any():
        return unservable_decision(form, least, unserved)
    known = None if least is None else least.owner
    found = search_objective(served, Program.of(served) if unserved.size else program, effort, after, known)
    if not found.kept:  # the promised rates are, if nothing else
        nobody = np.full(form.cap_w.size, -1, dtype=np.int64), np.zeros(form.cap_w.size)
        owner, power_w = nobody if least is None else (least.owner, least.power_w)
        found = dataclasses.replace(found, owner=owner, power_w=power_w, kept=True, score=-np.inf)
    scaling = searched_scaling(form, least, effort) if plan.is_thorough and least is not None else None
    found = _go_on(served, found, plan, started)
    return decision_of(form, found, least, unserved, scaling)


def _carried(form: NormalForm, least: Search, plan: Plan, *, improve: bool) -> Search:
    """The promised rates within the budget, if time suffices to find out; at the least power where ``improve``."""
    make_ready()
    with form.limit.within(_SETTLED_S if np.isinf(form.limit.deadline) else np.inf):
        return carried(form, least, plan.most_sets, enough=np.inf if improve else -form.budget_w)


def _go_on(form: NormalForm, found: Search, plan: Plan, started: float) -> Search:
    """Restart in rounds; thoroughly, go on with prices of subcarriers."""
    found = _restarted(form, found, plan, started)
    if not plan.is_thorough:
        return found
    make_ready()
    return tightened(form, found, plan.most_sets)


def _restarted(form: NormalForm, found: Search, plan: Plan, started: float) -> Search:
    """Rounds up to the restarts that were asked for, or while one as long as those before ends by the deadline.

    A round depends on what was found and on its number alone, so that those of a deadline can be done again; one that
    the deadline cuts short all the same is forgotten.
    """
    most = plan.restarts
    if most is None:
        most = sys.maxsize if plan.is_open else found.restarts
    limit, seed, now = form.limit, plan.seed, form.limit.now_s
    longest = now - started
    while found.restarts < most and now + longest <= limit.deadline:
        seed, steps = seed + 1, limit.steps
        size = min(_ROUND, most - found.restarts)
        again = search(form, found.program, Effort(restarts=size, seed=seed), found.prices, found.owner)
        if limit.is_over():
            limit.go_back(steps)
            break
        better = again if again.kept and again.score > found.score else found
        found = dataclasses.replace(
            better,
            bound=tighter(form, found.program, found.bound, again.bound),
            iterations=found.iterations + again.iterations,
            restarts=found.restarts + size,
        )
        begun, now = now, limit.now_s
        longest = max(longest, now - begun)
    return found

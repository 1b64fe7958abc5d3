"""The default: prices of rates and power, sets by the prices, better sets by search, and a bound by the prices."""

from __future__ import annotations

import dataclasses
import sys
import time
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from wirelessagent.deciding.core.closed_form import closed_decision, nats_worth
from wirelessagent.deciding.core.dual_search import Effort, Search, search, search_objective, search_promises, tighter
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program
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
from wirelessagent.deciding.core.thorough import carried, make_ready, tightened
from wirelessagent.deciding.core.unserved import without_unservable
from wirelessagent.deciding.method import WHOLE_PROBLEM, Method
from wirelessagent.model.arrays import positive, whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

_SMALL = 400
"""Up to so many users × groups a search is restarted by default."""
_RESTARTS, _ROUND = 10, 10
"""Those of a small problem, and those of each round beyond them."""
_SETTLED_S, _THOROUGH_S = 1.0, 5.0
"""Time for promised rates that were not found within the budget, and for a thorough search, where none is given."""


@dataclass(frozen=True, kw_only=True)
class Dual(Method):
    """Any objective with any constraints, by the Lagrangian dual and a local search; certified.

    For given prices of the users' rates and of power the subcarriers decouple. The prices are found by Newton's method
    on a smoothed dual; they say who gets which subcarrier, and prove a bound. The sets are then improved by moves and
    swaps, each followed by exact water-filling, and by restarts with chains of such changes. The most rate, alone or
    per joule, without further limits is solved in closed form.

    Attributes:
        effort: "fast" for a scheduler's slot; "thorough" goes on with prices of subcarriers, which prove more and find
            better sets, for some seconds at most, and often to the proven optimum.
        deadline_ms: time until which a fast search is restarted, and after which a thorough one begins nothing new; the
            first search is done in any case.
        restarts: number of restarts instead of that of the effort. Each is one kick, the first none, with a search
            for chains where that is promising, or three kicks without one where chains are not worth their time. A
            fast decision under a deadline says how many it did, and so many without one make the same decision again.
        seed: of the restarts.
    """

    name = "dual"
    constraints = WHOLE_PROBLEM
    warm_starts: ClassVar[bool] = True

    effort: Literal["fast", "thorough"] = "fast"
    deadline_ms: float | None = None
    restarts: int | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        if self.effort not in ("fast", "thorough"):
            raise InputError(f"effort must be fast or thorough; got {self.effort!r}")
        if self.deadline_ms is not None:
            positive("deadline_ms", self.deadline_ms)
        for name in ("restarts", "seed"):
            if getattr(self, name) is not None:
                whole(name, getattr(self, name), smallest=0)

    def solve(
        self, estimate: ChannelEstimate, problem: Problem, cell: Cell, *, after: Decision | None = None
    ) -> Decision:
        started = time.perf_counter()
        form = NormalForm.of(self, estimate, problem, cell)
        worth = nats_worth(form)
        if worth is not None:
            return closed_decision(form, worth)
        program = Program.of(form)
        earlier = after.prices if after is not None else None
        effort = self.effort_for(form)
        scaled_by = effort if self.effort == "thorough" else None
        promised = bool(form.promised_nats.any())
        if program.goal == LEAST_POWER and not promised:
            return unpowered_decision(form)
        if is_approached(form, program):
            return approached_decision(form, program)
        least: Search | None = None
        if promised:
            if program.goal == LEAST_POWER:
                least = search(form, program, effort, earlier)
            else:
                least = search_promises(form, Effort(restarts=0, seed=0))
            if not fits(form, least) and not is_proven_too_much(form, least):
                least = carried(form, least, self._until(started, _SETTLED_S))
            if not fits(form, least):
                return unkept_decision(form, least, effort)
        if least is not None and program.goal == LEAST_POWER:
            least = self._go_on(form, least, started)
            return decision_of(form, least, least, np.empty(0, dtype=np.int64), scaled_by)
        served, unserved = without_unservable(form, program)
        if not served.weight.any():
            return unservable_decision(form, least, unserved)
        known = None if least is None else least.owner
        found = search_objective(served, Program.of(served) if unserved.size else program, effort, earlier, known)
        if found.kept:
            found = self._go_on(served, found, started)
        elif least is not None:  # the promised rates are kept, if nothing else
            found = dataclasses.replace(found, owner=least.owner, power_w=least.power_w)
        else:
            nobody = np.full(form.cap_w.size, -1, dtype=np.int64)
            found = dataclasses.replace(found, owner=nobody, power_w=np.zeros(form.cap_w.size))
        return decision_of(form, found, least, unserved, scaled_by)

    def effort_for(self, form: NormalForm) -> Effort:
        """The first search for a problem of this size; restarts beyond it come in rounds."""
        restarts = _RESTARTS if form.weight.size * (form.start.size - 1) <= _SMALL else 0
        return Effort(restarts=restarts if self.restarts is None else min(self.restarts, restarts), seed=self.seed)

    def _go_on(self, form: NormalForm, found: Search, started: float) -> Search:
        """Restart in rounds; thoroughly, go on with prices of subcarriers."""
        deadline = np.inf if self.deadline_ms is None else started + self.deadline_ms / 1e3
        found = self._restarted(form, found, started, deadline)
        if self.effort == "fast":
            return found
        return tightened(form, found, self._until(started, _THOROUGH_S))

    def _until(self, started: float, otherwise_s: float) -> float:
        """When nothing new begins any more, on ``time.perf_counter``."""
        make_ready()
        return time.perf_counter() + otherwise_s if self.deadline_ms is None else started + self.deadline_ms / 1e3

    def _restarted(self, form: NormalForm, found: Search, started: float, deadline: float) -> Search:
        """Rounds up to the restarts that were asked for, or while one as long as those before ends by the deadline.

        A round depends on what was found and on its number alone, so that those of a deadline can be done again.
        """
        most = self.restarts
        if most is None:
            most = sys.maxsize if self.effort == "fast" and self.deadline_ms is not None else found.restarts
        seed, now = self.seed, time.perf_counter()
        longest = now - started
        while found.restarts < most and now + longest <= deadline:
            seed += 1
            size = min(_ROUND, most - found.restarts)
            again = search(form, found.program, Effort(restarts=size, seed=seed), found.prices, found.owner)
            better = again if again.kept and again.score > found.score else found
            found = dataclasses.replace(
                better,
                bound=tighter(form, found.bound, again.bound),
                iterations=found.iterations + again.iterations,
                restarts=found.restarts + size,
            )
            begun, now = now, time.perf_counter()
            longest = max(longest, now - begun)
        return found

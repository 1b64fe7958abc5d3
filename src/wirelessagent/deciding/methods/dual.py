"""The default: prices of rates and power, sets by the prices, better sets by search, and a bound by the prices."""

from __future__ import annotations

import dataclasses
import time
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from wirelessagent.deciding.core.closed_form import closed_decision, is_closed
from wirelessagent.deciding.core.dual_search import Effort, Search, search, search_objective, search_promises, tighter
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import LEAST_POWER, Program
from wirelessagent.deciding.core.search_decision import (
    decision_of,
    fits,
    unkept_decision,
    unpowered_decision,
    unservable_decision,
)
from wirelessagent.deciding.core.thorough import tightened
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
_RESTARTS, _THOROUGH_RESTARTS, _CHUNK = 30, 400, 20
_THOROUGH_S = 5.0


@dataclass(frozen=True, kw_only=True)
class Dual(Method):
    """Any objective with any constraints, by the Lagrangian dual and a local search; certified.

    For given prices of the users' rates and of power the subcarriers decouple. The prices are found by Newton's method
    on a smoothed dual; they say who gets which subcarrier, and prove a bound. The sets are then improved by moves and
    swaps, each followed by exact water-filling, and by restarts. The most rate, alone or per joule, without further
    limits is solved in closed form.

    Attributes:
        effort: "fast" for a scheduler's slot; "thorough" goes on with prices of subcarriers, which prove more and find
            better sets, for some seconds at most, and often to the proven optimum.
        deadline_ms: time after which nothing new begins; a fast search is restarted until then.
        restarts: number of restarts instead of that of the effort, to do again what a deadline has cut short.
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
        program = Program.of(form)
        if is_closed(form, program):
            return closed_decision(form, program)
        earlier = after.prices if after is not None else None
        effort = self.effort_for(form)
        promised = bool(form.promised_nats.any())
        if program.goal == LEAST_POWER and not promised:
            return unpowered_decision(form)
        least: Search | None = None
        if promised:
            wanted = program.goal == LEAST_POWER
            least = search_promises(form, effort if wanted else Effort(restarts=0, seed=0), earlier if wanted else None)
            if not fits(form, least):
                least = search_promises(form, Effort(restarts=_THOROUGH_RESTARTS, seed=self.seed), least.prices)
            if not fits(form, least):
                return unkept_decision(form, least)
        if least is not None and program.goal == LEAST_POWER:
            return decision_of(form, self._go_on(form, least, started), least, np.empty(0, dtype=np.int64))
        served, unserved = without_unservable(form, program)
        if not served.weight.any():
            return unservable_decision(form, least, unserved)
        found = search_objective(served, Program.of(served) if unserved.size else program, effort, earlier)
        if least is not None and not found.kept:
            found = search_objective(served, found.program, effort, found.prices, least.owner)
        if found.kept:
            found = self._go_on(served, found, started)
        elif least is not None:  # the promised rates are kept, if nothing else
            found = dataclasses.replace(found, owner=least.owner, power_w=least.power_w)
        else:
            nobody = np.full(form.cap_w.size, -1, dtype=np.int64)
            found = dataclasses.replace(found, owner=nobody, power_w=np.zeros(form.cap_w.size))
        return decision_of(form, found, least, unserved)

    def effort_for(self, form: NormalForm) -> Effort:
        """How hard to search a problem of this size."""
        small = form.weight.size * (form.start.size - 1) <= _SMALL
        restarts = _RESTARTS if small else 0
        if self.effort == "thorough" and small:
            restarts = _THOROUGH_RESTARTS
        return Effort(restarts=restarts if self.restarts is None else self.restarts, seed=self.seed)

    def _go_on(self, form: NormalForm, found: Search, started: float) -> Search:
        """Restart until the deadline, if there is one; thoroughly, go on with prices of subcarriers."""
        if self.effort == "thorough":
            allowed = _THOROUGH_S if self.deadline_ms is None else self.deadline_ms / 1e3
            return tightened(form, found, started + allowed)
        if self.deadline_ms is None:
            return found
        seed = self.seed
        while time.perf_counter() - started < self.deadline_ms / 1e3:
            seed += 1
            again = search(form, found.program, Effort(restarts=_CHUNK, seed=seed), found.prices, found.owner)
            if again.kept and again.score > found.score:
                found = dataclasses.replace(again, bound=tighter(form, found.bound, again.bound))
        return found

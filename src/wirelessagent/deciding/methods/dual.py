"""The default: prices of rates and power, sets by the prices, better sets by search, and a bound by the prices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from wirelessagent.deciding.core.dual_decision import Plan, dual_decision
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import WHOLE_PROBLEM, Method
from wirelessagent.model.arrays import positive, whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

_THOROUGH_S = 5.0
"""Time for a thorough search where none is given."""


@dataclass(frozen=True, kw_only=True)
class Dual(Method):
    """Any objective with any constraints, by the Lagrangian dual and a local search; certified.

    For given prices of the users' rates and of power the subcarriers decouple. The prices are found by Newton's method
    on a smoothed dual; they say who gets which subcarrier, and prove a bound. The sets are then improved by moves and
    swaps, each followed by exact water-filling, and by restarts with chains of such changes. The most rate, alone or
    per joule, without further limits is solved in closed form.

    Attributes:
        effort: "fast" for a scheduler's slot; "thorough" goes on with prices of subcarriers, which prove more and find
            better sets, for 5 s if no deadline is given, and often to the proven optimum.
        deadline_s: time in s by which it decides on the best found so far; a fast search is restarted until then.
        deadline_ms: the same in ms, by its older name.
        restarts: number of restarts instead of that of the effort. Each is one kick, the first none, with a search
            for chains where that is promising, or three kicks without one where chains are not worth their time. A
            fast decision under a deadline says how many it did, and so many without one make the same decision again
            if the deadline left time for the first search.
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
        super().__post_init__()
        if self.effort not in ("fast", "thorough"):
            raise InputError(f"effort must be fast or thorough; got {self.effort!r}")
        if self.deadline_ms is not None:
            positive("deadline_ms", self.deadline_ms)
            if self.deadline_s is not None:
                raise InputError(
                    "deadline_s and deadline_ms are two names of one limit; "
                    f"got {self.deadline_s!r} s and {self.deadline_ms!r} ms: leave one out"
                )
        for name in ("restarts", "seed"):
            if getattr(self, name) is not None:
                whole(name, getattr(self, name), smallest=0)

    @property
    def allowed_s(self) -> float | None:
        if self.deadline_ms is not None:
            return self.deadline_ms / 1e3
        return _THOROUGH_S if self.deadline_s is None and self.effort == "thorough" else self.deadline_s

    @property
    def plan(self) -> Plan:
        """How far it goes."""
        is_thorough = self.effort == "thorough"
        is_open = not is_thorough and self.allowed_s is not None
        return Plan(restarts=self.restarts, seed=self.seed, is_open=is_open, is_thorough=is_thorough)

    def solve(
        self, estimate: ChannelEstimate, problem: Problem, cell: Cell, *, after: Decision | None = None
    ) -> Decision:
        with self.limited():
            form = NormalForm.of(self, estimate, problem, cell)
            return dual_decision(form, self.plan, after.prices if after is not None else None)

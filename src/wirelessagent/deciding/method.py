"""How to optimise: the base class of every method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import positive, whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem

WHOLE_PROBLEM = frozenset(
    {
        "weights",
        "min_rate_bps",
        "max_rate_bps",
        "subcarrier_max_power_w",
        "forbidden",
        "users",
        "resource_block_group_size",
    }
)
"""The constraints that a method honours which solves whatever can be said of one known channel."""


@dataclass(frozen=True, kw_only=True)
class Method(KnownKeywords, ABC):
    """A way to solve problems. Subclass as a frozen keyword-only dataclass; its fields become options everywhere.

    Attributes:
        name: the registered name, equal to the entry point's.
        objectives: names of the objectives it solves; None for all.
        constraints: fields of :class:`Problem` that it honours beside the objective and ``max_power_w``; a problem
            that sets others is refused, never solved as if they were not there.
        warm_starts: whether :meth:`solve` also takes ``after``, an earlier decision to start from, or None: a keyword
            that changes how fast a good decision is found, not what a good one is.
        deadline_s: time in s by which it decides on the best found so far; without it each method has its own. What
            the first decision of a process takes to load is not counted.
        steps: after how many steps of its search it ends, instead of at a deadline: the number that a decision under a
            deadline tells makes the same decision again.
    """

    name: ClassVar[str]
    objectives: ClassVar[tuple[str, ...] | None] = None
    constraints: ClassVar[frozenset[str]] = frozenset()
    warm_starts: ClassVar[bool] = False

    deadline_s: float | None = None
    steps: int | None = None

    def __post_init__(self) -> None:
        if self.deadline_s is not None:
            positive("deadline_s", self.deadline_s)
        if self.steps is not None:
            whole("steps", self.steps, smallest=0)

    @property
    def allowed_s(self) -> float | None:
        """The time in s that it has; None where there is no limit."""
        return self.deadline_s

    def limited(self) -> AbstractContextManager[TimeLimit]:
        """The time and the steps that it has, for all that is done inside (:class:`.core.time_limit.TimeLimit`)."""
        if self.allowed_s is not None:
            from wirelessagent.deciding.core.thorough import make_ready

            make_ready()
        return TimeLimit.of(self.allowed_s, self.steps)

    @abstractmethod
    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        """The decision for ``problem`` on the estimated channel, with what certificate the method has."""

    @classmethod
    def objective_of(cls, problem: Problem) -> Objective:
        """The problem's objective, after a check that this method solves such problems."""
        objective = problem.objective
        if isinstance(objective, str):
            raise UnsupportedProblemError(
                f"the objective {objective!r} is only a name: call wirelessagent.decide(), which looks it up, "
                "or give an Objective"
            )
        if cls.objectives is not None and objective.name not in cls.objectives:
            raise UnsupportedProblemError(
                f"method {cls.name!r} does not solve {objective.name!r} but only {', '.join(cls.objectives)}: "
                "name another method"
            )
        if reason := objective.unsolvable():
            raise UnsupportedProblemError(reason)
        surplus = problem.constraints().keys() - cls.constraints - {"max_power_w"}
        if surplus:
            them = "it" if len(surplus) == 1 else "them"
            raise UnsupportedProblemError(
                f"method {cls.name!r} does not honour {', '.join(sorted(surplus))}: "
                f"leave {them} out or name another method"
            )
        return objective

"""How to optimise: the base class of every method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

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
    """

    name: ClassVar[str]
    objectives: ClassVar[tuple[str, ...] | None] = None
    constraints: ClassVar[frozenset[str]] = frozenset()
    warm_starts: ClassVar[bool] = False

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
        surplus = problem.constraints().keys() - cls.constraints - {"max_power_w"}
        if surplus:
            them = "it" if len(surplus) == 1 else "them"
            raise UnsupportedProblemError(
                f"method {cls.name!r} does not honour {', '.join(sorted(surplus))}: "
                f"leave {them} out or name another method"
            )
        return objective

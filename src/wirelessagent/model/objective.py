"""What to optimise. An objective says *what*; a method says *how*.

For given prices of the users' rates the subcarriers decouple, so a rate objective enters a solver through its concave
conjugate alone: the most that utility minus payment can be, and the rates that reach it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Literal

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.phrases import Phrases, phrases


@dataclass(frozen=True, kw_only=True)
class Objective(ABC):
    """A goal for the allocation. Subclass as a frozen keyword-only dataclass; its fields become options everywhere.

    Attributes:
        name: the registered name, equal to the entry point's.
        aliases: other names, such as the paper's P1.
        unit: the unit of :meth:`value`, as in "bit/s".
        direction: whether a larger or a smaller value is better.
        phrases: what an operator may say to mean it, by language.
        default_method: the method used when none is named; None leaves it to the first that solves it.
    """

    name: ClassVar[str]
    aliases: ClassVar[tuple[str, ...]] = ()
    unit: ClassVar[str] = ""
    direction: ClassVar[Literal["max", "min"]] = "max"
    phrases: ClassVar[Phrases] = phrases()
    default_method: ClassVar[str | None] = None

    @abstractmethod
    def utility(self, rate: FloatArray) -> float:
        """U(r): what the users' rates (user,) in bit/s are worth; concave and non-decreasing, −inf allowed at 0."""

    @abstractmethod
    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[float, FloatArray]:
        """max over r in [min_rate, max_rate] of U(r) − price · r, and a rate vector that reaches it.

        All arrays have shape (user,); rates in bit/s, max_rate may be infinite, prices are zero or more. Where the
        maximum is not bounded the value is inf.
        """

    def value(self, rate: FloatArray, power_w: float, cell: Cell) -> float:
        """The objective's value for rates (user,) in bit/s and a radiated power in W: U(r) unless it says otherwise."""
        del power_w, cell
        return self.utility(rate)

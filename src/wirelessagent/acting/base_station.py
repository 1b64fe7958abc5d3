"""Carrying a decision out: the base class of every base station."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene


@dataclass(frozen=True)
class BaseStation(KnownKeywords, ABC):
    """Something that applies a decision and reads back what it did.

    Subclass as a frozen dataclass with keyword-only fields, which become options everywhere. Every base station is
    given the scene; those that reach real equipment may ignore it.
    """

    name: ClassVar[str]

    scene: Scene | None = None

    @abstractmethod
    def apply(self, decision: Decision) -> Outcome:
        """Put the decision into effect and return what was read back; all or nothing."""


def check_applicable(decision: Decision, cell: Cell) -> None:
    """Raise an :class:`InputError` for a decision that must not reach a base station."""
    if not decision.is_usable:
        raise InputError(f"a decision that is {decision.status} cannot be applied: {decision.reason}")
    if decision.total_power_w > cell.max_power_w * (1 + 1e-9):
        raise InputError(
            f"the decision radiates {decision.total_power_w:g} W, above the cell's limit of {cell.max_power_w:g} W"
        )

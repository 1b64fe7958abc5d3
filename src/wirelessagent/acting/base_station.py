"""Carrying a decision out: the base class of every base station."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, TypedDict, Unpack, final

from wirelessagent.acting.resolution import settable_power_w, worth_of_a_step_bps
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene


class Read(TypedDict, total=False):
    """What a base station may have read back; see :class:`.outcome.Outcome`."""

    owner: IntArray
    power_w: FloatArray
    achieved: LinkMetrics | None
    true_gain: FloatArray | None
    written_to: Path | None


@dataclass(frozen=True)
class BaseStation(KnownKeywords, ABC):
    """Something that applies a decision and reads back what it did.

    Subclass as a frozen dataclass with keyword-only fields, which become options everywhere. Every base station is
    given the scene; those that reach real equipment may ignore it.

    Attributes:
        scene: the scene, where there is one.
        power_resolution_w: the finest step of the power on a subcarrier; 0 where any power can be set. A class says
            its own, as a class attribute or as a field, which is then an option.
    """

    name: ClassVar[str]
    power_resolution_w = 0.0

    scene: Scene | None = None

    @abstractmethod
    def apply(self, decision: Decision) -> Outcome:
        """Put the decision into effect and return what was read back; all or nothing."""

    @final
    def settable_power_w(self, decision: Decision) -> FloatArray:
        """The power to set, shape (subcarrier,): the decision's, rounded up to what can be set, within its limits."""
        return settable_power_w(decision, self.power_resolution_w)

    @final
    def read_back(self, decision: Decision, **read: Unpack[Read]) -> Outcome:
        """The outcome of a decision that was applied: as it was told where nothing else was ``read``.

        A rate counts as kept if it is short by no more than a step of the power is worth.
        """
        told = Outcome(
            base_station=self.name,
            owner=decision.owner,
            power_w=self.settable_power_w(decision),
            promised_bps=decision.committed_bps,
            slack_bps=worth_of_a_step_bps(decision, self.power_resolution_w),
        )
        return dataclasses.replace(told, **read)


def check_applicable(decision: Decision, cell: Cell) -> None:
    """Raise an :class:`InputError` for a decision that must not reach a base station."""
    if not decision.is_usable:
        raise InputError(f"a decision that is {decision.status} cannot be applied: {decision.reason}")
    if decision.total_power_w > cell.max_power_w * (1 + 1e-9):
        raise InputError(
            f"the decision radiates {decision.total_power_w:g} W, above the cell's limit of {cell.max_power_w:g} W"
        )

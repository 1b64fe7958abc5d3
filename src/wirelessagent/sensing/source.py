"""Where channels come from: the base class of every channel source."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.model.cell import Cell
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.scene import Scene


@dataclass(frozen=True, kw_only=True)
class ChannelSource(KnownKeywords, ABC):
    """A source of channels. Subclass as a frozen keyword-only dataclass; its fields become options everywhere."""

    name: ClassVar[str]

    @abstractmethod
    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        """The channel of ``cell`` now: the sensed gains and, where known, the truth. Same seed, same scene."""

"""Filling the holes: the base class of every repairer."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.observation import ChannelObservation


@dataclass(frozen=True, kw_only=True)
class Repairer(KnownKeywords, ABC):
    """An estimator of missing gains. Subclass as a frozen keyword-only dataclass; its fields become options everywhere.

    A repairer is stateless: history travels in the observation.
    """

    name: ClassVar[str]

    @abstractmethod
    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        """The current slot's gains, complete and with variances; observed entries bit-identical.

        ``at_s`` asks for another time than the last slot's; repairers without a notion of time ignore it.
        """

"""What an experiment is: it draws channels, fills a table, measures what claims are judged by and draws a picture."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

from wirelessagent.experiments.intervals import Measure
from wirelessagent.experiments.table import Table
from wirelessagent.pictures.canvas import Canvas

Progress: TypeAlias = Callable[[int, int], None]
"""Called with how much is done and how much there is to do."""


@dataclass(frozen=True, kw_only=True)
class Result:
    """What an experiment found.

    Attributes:
        table: every figure that the picture shows.
        measures: the figures that claims are judged by; no two experiments have one of the same name.
        draws: the number of channel draws that the measures rest on.
    """

    table: Table
    measures: Mapping[str, Measure]
    draws: int


@dataclass(frozen=True, kw_only=True)
class Experiment(ABC):
    """A reproducible figure. Subclass as a frozen keyword-only dataclass whose fields are the configuration.

    Attributes:
        name: the name it is asked for by.
        summary: one line on what the figure shows.
    """

    name: ClassVar[str]
    summary: ClassVar[str]

    @abstractmethod
    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        """The table of this figure from so many draws; the same for any executor, which only runs it."""

    @abstractmethod
    def picture(self, result: Result) -> Canvas:
        """The figure of a result; its title says what was simulated and from how many draws."""

    def configuration(self) -> dict[str, Any]:
        """All that the table depends on beside seed and draws, as plain values."""
        return dataclasses.asdict(self)

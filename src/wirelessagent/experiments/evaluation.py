"""What an evaluation is: methods beside each other on the same draws, as tables with intervals, findings and pictures.

Unlike an :class:`~wirelessagent.experiments.experiment.Experiment`, which is one figure of the paper, an evaluation
takes its channels from whoever asks and draws several pictures. A new one is a subclass, and an operation of a few
lines in :mod:`wirelessagent.operations.evaluate`.
"""

from __future__ import annotations

import json
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import wirelessagent
from wirelessagent.experiments.experiment import Progress
from wirelessagent.experiments.table import Table
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError
from wirelessagent.pictures.canvas import Canvas


@dataclass(frozen=True, kw_only=True)
class Evaluated:
    """What an evaluation found.

    Attributes:
        tables: by name; the first one holds all figures, the others what single pictures show beside it.
        findings: the conclusions in figures, by name; None where there is none.
        draws: the number of draws that each figure rests on.
        seed: of the draws.
    """

    tables: Mapping[str, Table]
    findings: Mapping[str, Any]
    draws: int
    seed: int

    @property
    def table(self) -> Table:
        """The table of all figures."""
        return next(iter(self.tables.values()))


@dataclass(frozen=True, kw_only=True)
class Evaluation(ABC):
    """Methods compared. Subclass as a frozen keyword-only dataclass whose fields are the configuration.

    Attributes:
        name: the stem of its files.
        summary: one line on what it shows.
    """

    name: ClassVar[str]
    summary: ClassVar[str]

    @abstractmethod
    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Evaluated:
        """The tables from so many draws; the same for any executor but for times, which are measured."""

    @abstractmethod
    def pictures(self, result: Evaluated) -> dict[str, Canvas]:
        """The pictures of a result by name, drawn from its tables alone."""

    @abstractmethod
    def configuration(self) -> dict[str, Any]:
        """All that the tables depend on beside seed and draws, as plain values."""


def make_folder(out: Path) -> None:
    """Make the folder for an evaluation's files, or raise an :class:`InputError`."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the folder {out} cannot be made: {error.strerror}; choose another one") from error


def write(evaluation: Evaluation, result: Evaluated, out: Path) -> list[Path]:
    """Write each table as CSV, all of it as one JSON and each picture as PNG into the folder ``out``; their paths."""
    make_folder(out)
    paths: list[Path] = []
    for name, table in result.tables.items():
        paths.append(out / f"{name}.csv")
        text = table.to_csv()
        write_atomically(paths[-1], lambda stream, text=text: stream.write(text.encode()))
    paths.append(out / f"{evaluation.name}.json")
    record = json.dumps(_record(evaluation, result), ensure_ascii=False, allow_nan=False, indent=1)
    write_atomically(paths[-1], lambda stream: stream.write(f"{record}\n".encode()))
    for name, canvas in evaluation.pictures(result).items():
        paths.append(out / f"{name}.png")
        canvas.save(paths[-1])
    return paths


def rows_of(table: Table) -> list[dict[str, Any]]:
    """A table's rows by column; what is not known (NaN) is None."""
    return [
        {
            column: None if isinstance(value, float) and not math.isfinite(value) else value
            for column, value in zip(table.columns, row, strict=True)
        }
        for row in table.rows
    ]


def _record(evaluation: Evaluation, result: Evaluated) -> dict[str, Any]:
    """How it was made and what was found."""
    return {
        "evaluation": evaluation.name,
        "summary": evaluation.summary,
        "version": wirelessagent.__version__,
        "seed": result.seed,
        "draws": result.draws,
        "configuration": evaluation.configuration(),
        "findings": result.findings,
        "tables": {name: rows_of(table) for name, table in result.tables.items()},
    }

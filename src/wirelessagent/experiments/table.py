"""A table of results: what is written to the CSV file and all that the picture is drawn from."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wirelessagent.model.arrays import FloatArray

Value: TypeAlias = str | int | float


@dataclass(frozen=True)
class Table:
    """Rows of named columns; a quantity's unit ends its column's name, as in ``sum_rate_bps``."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"a row of {len(row)} values in a table of {len(self.columns)} columns: {row}")

    def where(self, **values: Value) -> Table:
        """The rows in which each named column has the given value."""
        wanted = {self.columns.index(column): value for column, value in values.items()}
        return Table(self.columns, tuple(row for row in self.rows if all(row[i] == v for i, v in wanted.items())))

    def numbers(self, column: str) -> FloatArray:
        """A column of numbers, shape (row,)."""
        return np.array([float(row[self.columns.index(column)]) for row in self.rows])

    def values(self, column: str) -> list[Value]:
        """The different values of a column, in order of appearance."""
        return list(dict.fromkeys(row[self.columns.index(column)] for row in self.rows))

    def to_csv(self) -> str:
        """Comma-separated text with a header; every float in full, an unknown one (NaN) as an empty cell."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([_cell(value) for value in row] for row in self.rows)
        return text.getvalue()


def table_of(columns: Sequence[str], rows: Sequence[Sequence[Value]]) -> Table:
    """A table from any sequences; NumPy's numbers become Python's."""
    return Table(tuple(columns), tuple(tuple(_plain(value) for value in row) for row in rows))


def _plain(value: Value) -> Value:
    if isinstance(value, str):
        return value
    return int(value) if isinstance(value, int | np.integer) else float(value)


def _cell(value: Value) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else repr(value)
    return str(value)

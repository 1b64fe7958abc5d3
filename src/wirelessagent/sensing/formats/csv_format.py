"""CSV: one line per user, cells separated by comma, semicolon or tab.

Beside the numbers a file may have a header line (headings only; the first may be empty) and a first column of user
names (no cell is a number). A header whose first cell is "slot" announces slots: then the first column says which slot
a line belongs to, each slot's lines stand together, and user names, if any, come second. Everything else must be a
number or mean missing (empty, NaN, null, NA). Complex cells are written 0.1+0.2i or 0.1+0.2j.
"""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import Contents, Entry, Kind
from wirelessagent.sensing.formats.csv_labels import (
    Labels,
    Row,
    caution,
    check_different,
    check_same_order,
    names_in,
    users_per_slot,
)
from wirelessagent.sensing.formats.text import decode, number

_SEPARATORS = {"\t": "tab", ";": "semicolon", ",": "comma"}


def read_csv(data: bytes, *, max_bytes: int) -> Contents:
    """The matrix of a CSV file, its user names if it has any, and what was understood."""
    text = decode(data)
    separator = _separator(text)
    rows = _rows(text, separator)
    first, second = next(rows, None), next(rows, None)
    if first is None:
        raise FileFormatError("is empty; it must hold one line of gains per user")
    labels = Labels.of(first, second)
    body = [row for row in (None if labels.header else first, second) if row is not None]
    if not body:
        raise FileFormatError("holds only a header line; it must hold one line of gains per user")
    values: list[NDArray[Any]] = []
    label_rows: list[Row] = []
    for line, cells in itertools.chain(body, rows):
        if len(cells) != len(first[1]):
            raise FileFormatError(
                f"is ragged: line {line} has {len(cells)} cells, line {first[0]} has {len(first[1])}; "
                "leave a cell empty where a gain is missing"
            )
        label_rows.append((line, cells[: labels.columns]))
        values.append(_numbers(line, cells, labels.columns, separator))
    notes = {"separator": _SEPARATORS[separator]} if len(first[1]) > 1 else {}
    if labels.header:
        notes["header"] = f"line {first[0]}"
    return _contents(np.stack(values), label_rows, labels, notes)


def _separator(text: str) -> str:
    """Tab before semicolon before comma, if the last line has it outside quotes."""
    last = text.rstrip(" \r\n").rpartition("\n")[2]
    unquoted = "".join(last.split('"')[::2])
    return next((mark for mark in _SEPARATORS if mark in unquoted), ",")


def _rows(text: str, separator: str) -> Iterator[Row]:
    """Lines with their cells; blank lines are allowed before and after them only."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    blank = 0
    begun = False
    while True:
        try:
            cells = next(reader, None)
        except csv.Error as error:
            raise FileFormatError(f"line {reader.line_num} is not CSV: {error}; check its quotes") from error
        if cells is None:
            return
        if not "".join(cells).strip() and len(cells) < 2:
            blank = blank or reader.line_num
        elif blank and begun:
            raise FileFormatError(f"line {blank} is empty; delete it, or write NaN in its cells if they are missing")
        else:
            blank, begun = 0, True
            yield reader.line_num, cells


def _numbers(line: int, cells: list[str], start: int, separator: str) -> NDArray[Any]:
    """A line's cells from column ``start`` (counted from 0) on, as numbers."""
    found: list[float | complex] = []
    for column, cell in enumerate(cells[start:], start + 1):
        value = number(cell)
        if value is None:
            raise FileFormatError(
                f"line {line}, column {column} holds {cell:.40}, which is not a number; {_mend(cell, separator)}"
            )
        found.append(value)
    return np.array(found)


def _mend(cell: str, separator: str) -> str:
    if separator != "," and "," in cell:
        return "write a decimal point instead of the comma"
    if len(cell.split()) > 1:
        return "separate cells with commas, semicolons or tabs"
    return "leave the cell empty if it is missing"


def _contents(matrix: NDArray[Any], rows: list[Row], labels: Labels, notes: dict[str, str]) -> Contents:
    """The matrix with its slots and user names."""
    names = names_in(rows, int(labels.slots)) if labels.names else []
    axes: tuple[str, ...] = ()
    if labels.slots:
        num_users = users_per_slot(rows)
        check_same_order(names or [""] * len(rows), num_users, rows)
        matrix = matrix.reshape(-1, num_users, matrix.shape[1])
        names = names[:num_users]
        axes = ("slot", "user", "subcarrier")
        notes["slots"] = "from column 1"
    elif warning := caution(matrix):
        notes["caution"] = warning
    check_different(names, rows[: len(names)])
    kind: Kind = "complex" if np.iscomplexobj(matrix) else "real"
    dtype = "complex numbers" if kind == "complex" else "numbers"
    entries = [Entry(name="", shape=matrix.shape, dtype=dtype, kind=kind, axes=axes, read=lambda: matrix)]
    if names:
        column = np.array(names)
        entries.append(Entry(name="user_names", shape=column.shape, dtype="text", kind="text", read=lambda: column))
        notes["user names"] = f"from column {labels.columns}"
    return Contents(entries=tuple(entries), notes=notes)

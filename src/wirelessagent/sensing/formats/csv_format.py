"""CSV: one line per user, cells separated by comma, semicolon or tab.

Beside the numbers a file may have a header line (headings only; the first may be empty) and a first column of user
names (no cell is a number). A header whose first cell is "slot" announces slots: then the first column says which slot
a line belongs to, each slot's lines stand together, and user names, if any, come second. Everything else must be a
number or mean missing (empty, NaN, null, NA). Complex cells are written 0.1+0.2i or 0.1+0.2j. Numbers have a decimal
point or, where it separates no cells, a decimal comma: all of them the same one.
"""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
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
_IN_TWO = "If 1,5 is meant as one number, write 1.5 or separate cells with semicolons"


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
    numbers = _Numbers(start=labels.columns, separator=separator)
    values: list[NDArray[Any]] = []
    label_rows: list[Row] = []
    for line, cells in itertools.chain(body, rows):
        if len(cells) != len(first[1]):
            raise FileFormatError(
                f"is ragged: line {line} has {len(cells)} cells, line {first[0]} has {len(first[1])}; "
                f"leave a cell empty where a gain is missing{f'. {_IN_TWO}' if numbers.may_be_in_two else ''}"
            )
        label_rows.append((line, cells[: labels.columns]))
        values.append(numbers.of(line, cells))
    notes = {"separator": _SEPARATORS[separator]} if len(first[1]) > 1 else {}
    if numbers.mark == ",":
        notes["decimals"] = f"decimal comma: {numbers.example} is read as {numbers.example.replace(',', '.')}"
    elif numbers.may_be_in_two and (len(first[1]) - labels.columns) % 2 == 0:
        notes["decimals"] = f"none, every comma separates cells. {_IN_TWO}"
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


@dataclass
class _Numbers:
    """Reads the numbers of each line, and learns from the first fraction whether they have decimal commas.

    Attributes:
        start: the first column of numbers, counted from 0.
        separator: what separates cells.
        mark: the decimal mark, "" as long as no number has one.
        example: the first number with that mark.
        line: its line.
        may_be_in_two: whether separators may be decimal commas: all numbers whole, and no second half has a sign.
    """

    start: int
    separator: str
    mark: str = ""
    example: str = ""
    line: int = 0
    may_be_in_two: bool = True

    def of(self, line: int, cells: list[str]) -> NDArray[Any]:
        """A line's numbers."""
        texts = [cell.strip() for cell in cells[self.start :]]
        found = [self._number(line, column, text) for column, text in enumerate(texts, self.start + 1)]
        whole = [text[1:] if text[:1] in ("-", "+") and i % 2 == 0 else text for i, text in enumerate(texts)]
        self.may_be_in_two = self.may_be_in_two and self.separator == "," and all(map(str.isdecimal, whole))
        return np.array(found)

    def _number(self, line: int, column: int, text: str) -> float | complex:
        mark = "," if "," in text and self.separator != "," and "." not in text else "." if "." in text else ""
        value = number(text.replace(",", ".") if mark == "," else text)
        if value is None:
            raise FileFormatError(
                f"line {line}, column {column} holds {text:.40}, which is not a number; {self._mend(text)}"
            )
        if mark and not self.mark:
            self.mark, self.example, self.line = mark, text, line
        if mark and mark != self.mark:
            names = {",": "comma", ".": "point"}
            raise FileFormatError(
                f"line {line}, column {column} holds {text:.40} with a decimal {names[mark]}, line {self.line} has "
                f"{self.example:.40} with a decimal {names[self.mark]}; write one of them throughout"
            )
        return value

    def _mend(self, text: str) -> str:
        if "," in text:
            return "write it with a decimal point, and without commas that group its digits"
        if len(text.split()) > 1:
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

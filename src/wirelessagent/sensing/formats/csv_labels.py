"""What stands around the numbers of a CSV file: a header line, user names, slots.

Lines and columns in messages are counted from 1, as editors and spreadsheets show them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.text import is_label

Row: TypeAlias = tuple[int, list[str]]
"""A line's number and its cells."""

_NAME_LABELS = {"user", "users", "user_id", "user id", "user_name", "user name", "name", "names", "ue", "ut", "id"}


@dataclass(frozen=True, kw_only=True)
class Labels:
    """Whether the first line is a header, and which label columns come before the numbers: slot, then user name."""

    header: bool
    slots: bool
    names: bool

    @classmethod
    def of(cls, first: Row, second: Row | None) -> Labels:
        """The labels that the first two lines show.

        A header has headings only (its first cell may be empty). A column of slots is announced by the header; a
        column of names has a name in the first line of data.
        """
        cells = first[1]
        corner = is_label(cells[0]) or (len(cells) > 1 and not cells[0].strip())
        header = corner and all(map(is_label, cells[1:]))
        column = int(header and len(cells) > 1 and cells[0].strip().lower() == "slot")
        data = second if header else first
        if data is None or len(data[1]) < column + 2:
            return cls(header=header, slots=column == 1, names=False)
        names = is_label(data[1][column])
        if names and not header and cells[0].strip().lower() in _NAME_LABELS:
            raise FileFormatError(
                f"line {first[0]} begins with {cells[0]!r} as a header does, and goes on with numbers; "
                "give the subcarriers headings such as f1, or delete the line"
            )
        if header and not names and cells[column].strip().lower() in _NAME_LABELS:
            cell = data[1][column]
            raise FileFormatError(
                f"column {column + 1} is headed {cells[column]!r} but line {data[0]} has the number {cell!r} in it; "
                f"write user names such as 'user {cell}', or delete the column"
            )
        return cls(header=header, slots=column == 1, names=names)

    @property
    def columns(self) -> int:
        """How many columns come before the numbers."""
        return self.slots + self.names


def names_in(rows: list[Row], column: int) -> list[str]:
    """The names in a column (counted from 0), each of which is not a number."""
    for line, cells in rows:
        if not is_label(cells[column]):
            first_line, first = rows[0]
            raise FileFormatError(
                f"line {line}, column {column + 1} holds {cells[column]!r} where line {first_line} has the user name "
                f"{first[column]!r}; write names in the whole column, or numbers"
            )
    return [cells[column].strip() for _, cells in rows]


def check_different(names: list[str], rows: list[Row]) -> None:
    """Raise for a user name that stands in two lines."""
    seen: dict[str, int] = {}
    for name, (line, _) in zip(names, rows, strict=True):
        if name in seen:
            raise FileFormatError(f"lines {seen[name]} and {line} are both for user {name!r}; give each its own name")
        seen[name] = line


def users_per_slot(rows: list[Row]) -> int:
    """How many lines each slot has, which must be the same for all and stand together."""
    slots: dict[str, int] = {}
    previous = None
    for line, cells in rows:
        slot = cells[0].strip()
        if slot != previous and slot in slots:
            raise FileFormatError(f"slot {slot!r} comes back in line {line}; keep each slot's lines together")
        slots[slot] = slots.get(slot, 0) + 1
        previous = slot
    first, expected = next(iter(slots.items()))
    for slot, found in slots.items():
        if found != expected:
            raise FileFormatError(
                f"slot {slot!r} has {found} lines, slot {first!r} has {expected}; every slot needs one line per user"
            )
    return expected


def check_same_order(names: list[str], num_users: int, rows: list[Row]) -> None:
    """Raise where a slot lists other users than the first one, or in another order."""
    for i, (name, (line, _)) in enumerate(zip(names, rows, strict=True)):
        if name != names[i % num_users]:
            raise FileFormatError(
                f"line {line} is for user {name!r} where the first slot has {names[i % num_users]!r}; "
                "list the same users in the same order in every slot"
            )


def caution(matrix: NDArray[Any]) -> str:
    """A word of caution where the first line only counts, as the row and column numbers of pandas do.

    Raises:
        FileFormatError: the corner is empty, and the first line and column both count: those are no gains.
    """
    if matrix.shape[1] < 3 or np.iscomplexobj(matrix):
        return ""
    if np.isnan(matrix[0, 0]) and _counts(matrix[0, 1:]) and (len(matrix) < 3 or _counts(matrix[1:, 0])):
        raise FileFormatError(
            "line 1 and column 1 only count 0, 1, 2 … and are no gains; "
            "save it without them (in pandas: to_csv(…, header=False, index=False))"
        )
    return "the first line just counts; if it is a header and not gains, delete it" if _counts(matrix[0]) else ""


def _counts(values: NDArray[Any]) -> bool:
    """Whether these are 0, 1, 2 … or 1, 2, 3 …"""
    return values[0] in (0, 1) and bool(np.all(values == np.arange(len(values)) + values[0]))

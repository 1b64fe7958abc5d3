"""A table for people; a module of its own, since listing what can be asked for loads no more than this."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Table:
    """All cells are text; numbers come with their units in the column's name or in the cell."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

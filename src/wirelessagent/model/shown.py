"""How the library's objects show themselves: in a few lines, in a notebook, as a picture, as plain data, as a table.

An object says what is to be read of it (:class:`Summary`), what is to be drawn (:class:`Picture`) and what its columns
are; the rest is the same for all of them. Pictures are drawn above the model, by what serves the door "draw".
"""

from __future__ import annotations

import dataclasses
import html
import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.doors import through
from wirelessagent.model.errors import InputError, MissingDependencyError
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.legible import legible

_MOST_LINES = 12
_WIDEST_CELL, _WIDEST_LINE = 72, 100
_MOST_VALUES = 8
"""Of an array that are written out."""


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What people read of an object: a title and rows of text, the first cell of each its label.

    Attributes:
        title: what it is, in one line.
        rows: as many as fit; the rest is counted.
        header: over the columns; empty where the labels say all.
    """

    title: str
    rows: tuple[tuple[str, ...], ...] = ()
    header: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Picture:
    """What is to be drawn: the kind of picture, and what goes into it by name."""

    kind: str
    parts: Mapping[str, Any] = field(default_factory=dict[str, Any])


class Drawn(Protocol):
    """A picture that was drawn: a notebook shows it."""

    def save(self, path: Path | str) -> None:
        """Write it as PNG, SVG or PDF by the suffix."""
        ...

    def _repr_html_(self) -> str: ...


class Plain(KnownKeywords):
    """A dataclass that shows itself as the call that makes it, and as plain data."""

    _derived: ClassVar[tuple[str, ...]] = ()
    """Properties that belong to the plain data beside the fields."""

    def __repr__(self) -> str:
        return _as_call(self)

    def to_dict(self) -> dict[str, Any]:
        """The fields by name, ready for JSON: arrays as lists, what is no finite number as None.

        A field that is left out of the ``repr`` is left out here as well.
        """
        names = [item.name for item in dataclasses.fields(cast("Any", self)) if item.repr]
        return {name: plain_data(getattr(self, name)) for name in (*names, *self._derived)}


class Shown(Plain):
    """An object that people look at: in a terminal, in a notebook, as a picture, as a table."""

    def summary(self) -> Summary:
        """What people read of it."""
        raise NotImplementedError

    def picture(self) -> Picture | None:
        """What is to be drawn; None where there is nothing."""
        return None

    def columns(self) -> Mapping[str, Sequence[Any] | NDArray[Any]]:
        """The columns of its table, all of one length."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return _as_text(self.summary())

    def _repr_html_(self) -> str:
        return _as_html(self.summary(), self.picture())

    def plot(self) -> Drawn:
        """The object as a picture: a notebook shows it, ``.save("picture.png")`` writes it, ``.figure`` is
        matplotlib's.

        Raises:
            InputError: there is nothing to draw.
            MissingDependencyError: matplotlib is not installed.
        """
        picture = self.picture()
        if picture is None:
            raise InputError(f"there is nothing to draw: {self.summary().title}")
        return cast("Drawn", through("draw")(picture, small=False))

    def to_frame(self) -> Any:
        """The object as a pandas DataFrame.

        Raises:
            MissingDependencyError: pandas is not installed.
        """
        try:
            import pandas as pd  # pyright: ignore[reportMissingImports, reportMissingModuleSource]
        except ImportError as error:
            raise MissingDependencyError("pandas", "", f"{type(self).__name__}.to_frame()") from error
        return cast("Any", pd).DataFrame(dict(self.columns()))


def plain_data(value: object) -> Any:
    """``value`` as numbers, text, lists and dictionaries, ready for JSON.

    >>> plain_data({"rate": np.array([1.0, np.nan]), "out": Path("a.csv")})
    {'rate': [1.0, None], 'out': 'a.csv'}
    """
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, np.ndarray | np.generic):
        return plain_data(cast("Any", value).tolist())
    if isinstance(value, Plain):
        return value.to_dict()
    if isinstance(value, Mapping):
        return {str(name): plain_data(each) for name, each in cast("Mapping[Any, object]", value).items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [plain_data(each) for each in cast("Iterable[object]", value)]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        name = getattr(value, "name", None)  # a plug-in's
        fields = {item.name: plain_data(getattr(value, item.name)) for item in dataclasses.fields(value)}
        return {"name": name, **fields} if isinstance(name, str) else fields
    return str(value)


def few(texts: Iterable[str]) -> str:
    """Up to eight texts; of more the first, the last, and how many there are.

    >>> few("ab"), few("abcdefghi")
    ('a, b', 'a, b, c, … i (9)')
    """
    found = list(texts)
    return ", ".join(found) if len(found) <= 8 else f"{', '.join(found[:3])}, … {found[-1]} ({len(found)})"


def _as_call(value: Any) -> str:
    """The call that makes an object: all that is set, with long arrays described."""
    parts: list[str] = []
    for item in dataclasses.fields(value):
        given = getattr(value, item.name)
        if item.init and item.repr and not _is_unset(given):
            parts.append(f"{item.name}={_argument(given)}" if item.kw_only else _argument(given))
    name, inner = type(value).__name__, ", ".join(parts)
    if len(name) + len(inner) + 2 <= _WIDEST_LINE:
        return f"{name}({inner})"
    lines = textwrap.wrap(inner, _WIDEST_LINE - 4, break_on_hyphens=False, max_lines=_MOST_LINES - 2, placeholder=" …")
    return "\n".join([f"{name}(", *(f"    {line}" for line in lines), ")"])


def _is_unset(value: object) -> bool:
    return value is None or value is False or (isinstance(value, str | tuple | Mapping) and not value)


def _argument(value: object) -> str:
    """A value inside a call: arrays of a few values as lists, longer ones by shape and range."""
    if isinstance(value, np.ndarray):
        array = cast("NDArray[Any]", value)
        if array.size <= _MOST_VALUES:
            values: Any = array.tolist()
            return _argument(values) if array.ndim == 0 else f"[{', '.join(map(_argument, values))}]"
        shape = "×".join(map(str, array.shape))
        if array.dtype.kind not in "fi" or np.isnan(array).all():
            return f"<{shape} {array.dtype}>"
        return f"<{shape} {array.dtype}, {np.nanmin(array):.3g} … {np.nanmax(array):.3g}>"
    if isinstance(value, float):
        return f"{value:.9g}"
    first, *more = repr(value).splitlines() or [""]
    return _short(f"<{first}>" if more or isinstance(value, Shown) else first)


def _as_text(summary: Summary) -> str:
    """Title and rows below each other, their columns aligned."""
    rows = [line for row in (*filter(None, [summary.header]), *summary.rows) for line in _wrapped(row)]
    room = _MOST_LINES - 1
    kept = rows if len(rows) <= room else [*rows[: room - 1], (f"… and {len(rows) - room + 1} lines more",)]
    columns = max(map(len, kept), default=0)
    widths = [max((len(row[k]) for row in kept if len(row) > k + 1), default=0) for k in range(columns)]
    lines = ["  ".join(cell.ljust(widths[k]) for k, cell in enumerate(row)).rstrip() for row in kept]
    return "\n".join([_short(summary.title, _WIDEST_LINE), *(f"  {line}" for line in lines)])


def _wrapped(row: tuple[str, ...]) -> list[tuple[str, ...]]:
    """A row as lines: a label's text goes on below, a table's cells are cut."""
    if len(row) != 2:
        return [tuple(map(_short, row))]
    first, *more = textwrap.wrap(legible(row[1], keep=""), _WIDEST_CELL) or [""]
    return [(_short(row[0]), first), *(("", line) for line in more)]


def _short(text: str, most: int = _WIDEST_CELL) -> str:
    """One legible line, cut where it is too long."""
    shown = legible(text, keep="")
    return shown if len(shown) <= most else f"{shown[: most - 1].rstrip()}…"


_CELL = "text-align:left;vertical-align:top;padding:1px 14px 1px 0;background:none;border:none;max-width:36em"
_TITLE = "font-weight:600;margin:2px 0 4px"
_SIDE_BY_SIDE = "display:flex;flex-wrap:wrap;gap:4px 18px;align-items:flex-start"


def _as_html(summary: Summary, picture: Picture | None) -> str:
    """Title, rows and a small picture, in the page's own colours; the picture brings its ground."""
    head = "".join(_html_cell(cell, k, "font-weight:600") for k, cell in enumerate(summary.header))
    body = ["".join(_html_cell(cell, k) for k, cell in enumerate(row)) for row in summary.rows]
    rows = "".join(f'<tr style="background:none">{cells}</tr>' for cells in ([head] if head else []) + body)
    table = f'<table style="margin:0;border-collapse:collapse;font-size:90%">{rows}</table>'
    title = html.escape(legible(summary.title, keep=""))
    return f'<div><div style="{_TITLE}">{title}</div><div style="{_SIDE_BY_SIDE}">{table}{_small(picture)}</div></div>'


def _html_cell(text: str, column: int, style: str = "") -> str:
    own = "opacity:0.7;white-space:nowrap" if column == 0 else ""
    return f'<td style="{_CELL};{own};{style}">{html.escape(legible(text, keep=""))}</td>'


def _small(picture: Picture | None) -> str:
    """The picture as HTML, or how to get one where matplotlib is not installed."""
    if picture is None:
        return ""
    try:
        drawn = cast("Drawn", through("draw")(picture, small=True))
    except MissingDependencyError as missing:
        return f'<small style="opacity:0.7">{html.escape(str(missing))}</small>'
    return drawn._repr_html_()  # pyright: ignore[reportPrivateUsage]  # the name that notebooks know

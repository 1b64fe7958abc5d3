"""Text in lines of a width: paragraphs, lists and tables.

Signs that take two columns of a terminal, as Chinese ones do, count as two. A word is never broken: what is longer
than the width, such as a path, stands out over it, and the terminal folds it in a way that copies as one. A figure
stays with its unit.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Sequence

from rich.cells import cell_len

_WIDE = (
    "\u1100-\u115f\u2e80-\u3000\u3003-\u3007\u3012-\ua4cf\uac00-\ud7a3\uf900-\ufaff\uff10-\uff5a\U00020000-\U0003fffd"
)
_OPENING, _CLOSING = "（【《「『“‘", ",.;:!?)%»”’、。，；：！？）】》」』％"
_WORD = rf"[^\s{_WIDE}{_OPENING}]+"
_PIECE = re.compile(
    rf"(\s*)([{_OPENING}]*(?:[{_WIDE}][{_CLOSING}]*|{_WORD}(?:(?<=\d) (?=[^\W\d]|%){_WORD})*)|[{_OPENING}])"
)
"""What may stand on a line by itself, after the space before it: a word, a figure with its unit, or a wide sign."""

_PIPED = 120
"""Columns where the output is no terminal and ``COLUMNS`` says nothing."""

_GAP = "  "
_READABLE = 10
"""Columns that every cell gets if it fills them, so that no heading stands sign by sign."""


def output_width() -> int:
    """Columns of the output: those of ``COLUMNS``, else of the terminal."""
    return max(20, shutil.get_terminal_size((_PIPED, 24)).columns)


def wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """The lines of a paragraph; ``indent`` goes before all but the first.

    >>> wrapped("at most 10 W for each of them", 12)
    ['at most 10 W', 'for each of', 'them']
    """
    lines, line = list[str](), ""
    for space, piece in _PIECE.findall(text):
        if line.strip() and cell_len(f"{line}{space}{piece}") > width:
            lines.append(line)
            line = f"{indent}{piece}"
        else:
            line += f"{space}{piece}" if line.strip() or not lines else piece
    return [*lines, line]


def name_width(names: Iterable[str], width: int, share: float = 0.4) -> int:
    """Columns for the names of a list: of those that take no more than their share of the width, the longest's."""
    return max((size for name in names if (size := cell_len(name)) <= max(16, share * width)), default=8)


def listed(rows: Sequence[tuple[str, str]], width: int, left: int) -> list[str]:
    """Names with what is said of them beside; below a name that is longer than its ``left`` columns."""
    lines: list[str] = []
    for name, text in rows:
        below = f"\n{_GAP}{' ' * left}{_GAP}"
        beside = below.join(wrapped(text, max(width - left - 2 * len(_GAP), 16)))
        start = f"{_filled(name, left)}{_GAP}" if cell_len(name) <= left else f"{name}{below}"
        lines += f"{_GAP}{start}{beside}".split("\n")
    return lines


def tabled(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> list[str]:
    """A table; each row as a list of its own where not all columns fit beside each other."""
    cells = [list(column) for column in zip(columns, *rows, strict=True)]
    natural = [max(map(cell_len, column)) for column in cells]
    least = [
        max(min(size, _READABLE), *map(_widest_piece, column)) for size, column in zip(natural, cells, strict=True)
    ]
    if sum(least) + len(_GAP) * (len(columns) - 1) > width:
        return _stacked(columns, rows, width)
    widths = _shared(natural, least, width - len(_GAP) * (len(columns) - 1))
    figures = [number > 0 and all(map(_is_figure, column[1:])) for number, column in enumerate(cells)]
    lines = [line for row in [columns, *rows] for line in _row(row, widths, figures)]
    head = len(_row(columns, widths, figures))
    return [*lines[:head], "─" * (sum(widths) + len(_GAP) * (len(widths) - 1)), *lines[head:]]


def _widest_piece(text: str) -> int:
    return max((cell_len(piece) for _, piece in _PIECE.findall(text)), default=0)


def _shared(natural: Sequence[int], least: Sequence[int], room: int) -> list[int]:
    """The widths of columns in the room there is: the widest ones give way, none below its least."""
    widths = list(natural)
    while sum(widths) > room:
        widest = max((number for number, size in enumerate(widths) if size > least[number]), key=widths.__getitem__)
        widths[widest] -= 1
    return widths


def _row(row: Sequence[str], widths: Sequence[int], figures: Sequence[bool]) -> list[str]:
    parts = [wrapped(cell, size) for cell, size in zip(row, widths, strict=True)]
    deep = [[*part, *[""] * (max(map(len, parts)) - len(part))] for part in parts]
    return [
        _GAP.join(_filled(*cell) for cell in zip(line, widths, figures, strict=True)).rstrip()
        for line in zip(*deep, strict=True)
    ]


def _filled(text: str, size: int, right: bool = False) -> str:
    space = " " * (size - cell_len(text))
    return f"{space}{text}" if right else f"{text}{space}"


def _stacked(columns: Sequence[str], rows: Iterable[Sequence[str]], width: int) -> list[str]:
    lines, left = list[str](), name_width(columns[1:], width, 0.5)
    for row in rows:
        lines += [*wrapped(row[0], width), *listed(list(zip(columns[1:], row[1:], strict=True)), width, left)]
    return lines


def _is_figure(cell: str) -> bool:
    return cell in ("–", "") or cell.lstrip("-−")[:1].isdigit()

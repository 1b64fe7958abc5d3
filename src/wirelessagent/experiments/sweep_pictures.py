"""What the pictures of evaluations share: one figure of all methods against the share lost, in a panel."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wirelessagent.experiments.table import Table, Value
from wirelessagent.model.arrays import FloatArray
from wirelessagent.pictures.canvas import PALETTE, Panel
from wirelessagent.pictures.method_names import readable

BLACK = 6
YARDSTICKS = ("oracle", "perfect")
"""Drawn in black."""


_FIXED = {"user_mean": 0, "nncf_paper": 1, "nncf": 2, "kriging": 3, "linear": 4, **dict.fromkeys(YARDSTICKS, BLACK)}
"""Those that are met in many pictures look the same in all; the paper's two are blue and red, as in its figures."""


def styles(methods: Sequence[Value]) -> dict[str, int]:
    """A colour and marker for each method."""
    rest = [str(name) for name in methods if name not in _FIXED]
    pale = len(PALETTE) - 1
    free = [n for n in range(5, 5 + 2 * len(rest)) if n % len(PALETTE) not in (BLACK, pale)]
    return {**_FIXED, **dict(zip(rest, free, strict=False))}


def pattern(loss: Value) -> str:
    """The kind of a loss: its names without figures.

    >>> pattern("random:0.1 + users:1")
    'random + users'
    """
    return " + ".join(part.strip().split(":")[0] for part in str(loss).split("+"))


def patterns(table: Table) -> list[str]:
    """The kinds of losses in a table, in order of appearance."""
    return list(dict.fromkeys(pattern(loss) for loss in table.values("loss")))


def of_pattern(table: Table, wanted: str) -> Table:
    """The rows whose loss is of a kind."""
    place = table.columns.index("loss")
    return Table(table.columns, tuple(row for row in table.rows if pattern(row[place]) == wanted))


def draw_sweep(panel: Panel, case: Table, column: str, style: dict[str, int], *, percent: bool = False) -> None:
    """A column with its interval, a curve for each method; where one share alone was lost, a mark for each."""
    scale = 100.0 if percent else 1.0
    methods = case.values("method")
    alone = len(case.values("loss")) == 1
    for place, method in enumerate(methods):
        rows = case.where(method=method)
        x = np.array([float(place)]) if alone else 100.0 * rows.numbers("missing_share")
        panel.curve(
            x,
            scale * rows.numbers(column),
            between=(scale * rows.numbers(f"{column}_low"), scale * rows.numbers(f"{column}_high")),
            label=readable(method),
            style=style[str(method)],
        )
    panel.grid()
    if alone:
        panel.ticks("x", range(len(methods)), [readable(method) for method in methods], slanted=True)


def x_label(case: Table) -> str:
    """What :func:`draw_sweep` has along its x axis."""
    losses = case.values("loss")
    return "Share missing (%)" if len(losses) > 1 else str(losses[0])


def logarithmic(panel: Panel, low: float, high: float) -> None:
    """A logarithmic y axis with its ticks written out: more of each decade where there are fewer decades."""
    panel.scales(y="log")
    panel.limits(y=(low, high))
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    steps = (1, 2, 3, 5, 7) if high < 15.0 * low else (1, 2, 5) if high < 2e3 * low else (1,)
    ticks = [float(f"{step}e{decade}") for decade in decades for step in steps]
    panel.plain_ticks("y", [tick for tick in ticks if low <= tick <= high])


def least_positive(values: FloatArray, default: float) -> float:
    """The smallest value above zero."""
    return float(values[values > 0].min(initial=default))

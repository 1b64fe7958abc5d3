"""The pictures of an evaluation of decisions: the regret against perfect knowledge, and promises with their price."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent.experiments.sweep_pictures import (
    draw_sweep,
    logarithmic,
    of_pattern,
    patterns,
    styles,
    x_label,
)
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.pictures.canvas import Canvas

_TITLES = {
    "goodput": "goodput of max rate",
    "proportional_fairness": "proportional fairness",
    "max_min_rate": "smallest rate",
}
_LEAST_REGRET = 0.01
"""In %: what is below it is drawn there."""
_WIDE = 5.0
"""Ratio of figures from which an axis is logarithmic."""


def regret_canvas(table: Table, objectives: Sequence[str], caption: str) -> Canvas:
    """What is lost against perfect knowledge: a row of panels for each channel and kind of loss."""
    canvas, rows = _grid(table, len(objectives))
    style = styles(table.values("method"))
    for place, panel in enumerate(canvas.panels):
        label, case = rows[place // len(objectives)]
        name = objectives[place % len(objectives)]
        regret = _regret(_without(case, "perfect"), f"{name}_share")
        draw_sweep(panel, regret, "regret", style, percent=True)
        known = 100.0 * np.nan_to_num(regret.numbers("regret"), nan=1.0)
        low, high = float(known.min()), float(known.max())
        if high > _WIDE * low:
            logarithmic(panel, 0.7 * low, 1.5 * high)
        else:
            panel.limits(y=(0.0, 1.15 * high))
        panel.describe(f"{label}: {_TITLES[name]}", x_label(case), "Below perfect knowledge (%)")
    canvas.legend_below(canvas.panels[0], columns=7)
    canvas.title("Regret: what is lost on the true channel, with 95 % bootstrap intervals", caption)
    return canvas


def _without(table: Table, method: str) -> Table:
    place = table.columns.index("method")
    return Table(table.columns, tuple(row for row in table.rows if row[place] != method))


def _regret(case: Table, column: str) -> Table:
    """The columns loss, method, missing_share, and 1 − share with its interval, which turns its ends round."""
    least = _LEAST_REGRET / 100.0
    figures = [np.maximum(1.0 - case.numbers(f"{column}{end}"), least) for end in ("", "_high", "_low")]
    kept = [case.columns.index(name) for name in ("loss", "method", "missing_share")]
    rows = [(*(row[at] for at in kept), *values) for row, *values in zip(case.rows, *figures, strict=True)]
    return table_of(("loss", "method", "missing_share", "regret", "regret_low", "regret_high"), rows)


def promises_canvas(table: Table, outage_probability: float | None, caption: str) -> Canvas:
    """Who misses a promised rate, among all users and among those that rest on a repaired entry, and the power."""
    figures = {
        "missed_share": ("all users", "Users below the promised rate (%)"),
        "missed_of_resting_share": ("users on repaired entries", "Users below the promised rate (%)"),
        "power_ratio": ("power", "Power, perfect knowledge = 1 (ratio)"),
    }
    canvas, rows = _grid(table, len(figures))
    style = styles(table.values("method"))
    for place, panel in enumerate(canvas.panels):
        label, case = rows[place // len(figures)]
        column, (title, y_label) = list(figures.items())[place % len(figures)]
        misses = column != "power_ratio"
        draw_sweep(panel, _without(case, "perfect"), column, style, percent=misses)
        if not misses:
            panel.level(1.0, label="perfect knowledge")
        elif outage_probability is not None:
            panel.level(100.0 * outage_probability, label=f"accepted: {100.0 * outage_probability:g} %")
        if misses:
            highest = 100.0 * float(np.nan_to_num(case.numbers(f"{column}_high")).max())
            panel.limits(y=(0.0, max(1.1 * highest, 1.0)))
        panel.describe(f"{label}: {title}", x_label(case), y_label)
    canvas.legend_below(canvas.panels[0], columns=7)
    canvas.title("Promises on the true channel and their price, with 95 % bootstrap intervals", caption)
    return canvas


def _grid(table: Table, columns: int) -> tuple[Canvas, list[tuple[str, Table]]]:
    """A canvas with a row for each channel and kind of loss, and what each row is of."""
    rows = [
        (
            f"{channel}, {kind}" if len(patterns(table)) > 1 else str(channel),
            of_pattern(table.where(channel=channel), kind),
        )
        for channel in table.values("channel")
        for kind in patterns(table)
    ]
    canvas = Canvas(rows=len(rows), columns=columns, width_in=1.0 + 4.2 * columns, height_in=1.9 + 3.4 * len(rows))
    return canvas, rows

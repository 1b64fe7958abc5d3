"""The pictures of an evaluation of repairers: one user's recovery, error against loss, calibration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent.experiments.evaluated_methods import BASELINE
from wirelessagent.experiments.sweep_pictures import (
    BLACK,
    draw_sweep,
    least_positive,
    logarithmic,
    of_pattern,
    patterns,
    styles,
    x_label,
)
from wirelessagent.experiments.table import Table
from wirelessagent.pictures.canvas import PALETTE, Canvas, Panel
from wirelessagent.pictures.method_names import readable

_HEADROOM = 1.6
"""How far above the user mean's error the error's axis ends; whoever lies beyond is named instead."""


def recovery_canvas(table: Table, caption: str) -> Canvas:
    """A user's channel with its holes, estimates in them and one method's band of 90 % probability."""
    canvas = Canvas(width_in=8.8, height_in=4.9)
    panel = canvas.panels[0]
    n, holes, heard = table.numbers("subcarrier"), table.where(missing=1), table.where(missing=0)
    names = [column.removesuffix("_db") for column in table.columns[5:-2]]
    panel.ribbon(
        n,
        table.numbers("low_db"),
        table.numbers("high_db"),
        colour=PALETTE[0],
        label=f"{readable(names[0])}, 90 % of probability",
    )
    panel.curve(n, table.numbers("truth_db"), label="true channel", style=BLACK, marked=False)
    panel.marks(
        heard.numbers("subcarrier"),
        heard.numbers("observed_db"),
        size_pt=4,
        shape="o",
        colour="black",
        label="observed",
    )
    for style, name in enumerate(names):
        panel.curve(
            holes.numbers("subcarrier"), holes.numbers(f"{name}_db"), label=f"missing, by {readable(name)}",
            style=style, joined=False,
        )  # fmt: skip
    shown = np.concatenate([table.numbers(f"{name}_db") for name in ("truth", *names)])
    low = max(float(shown.min()), -30.0) - 3.0
    panel.limits(y=(low, max(float(shown.max()), float(table.numbers("high_db").max())) + 1.5))
    panel.describe(
        f"{table.values('user')[0]}: {len(holes.rows)} of {len(table.rows)} gains missing",
        "Subcarrier",
        "Power gain relative to the user's level (dB)",
    )
    panel.plain_ticks("x", [1, *range(5, len(table.rows) + 1, 5 if len(table.rows) <= 60 else 50)])
    panel.grid()
    panel.legend(columns=2)
    canvas.title("Recovery of one user's channel", caption)
    return canvas


def error_canvas(table: Table, caption: str) -> Canvas:
    """The error against the share lost: a column of panels for each channel, a row for each pattern."""
    channels, kinds = table.values("channel"), patterns(table)
    columns = max(len(channels), 2)
    canvas = Canvas(rows=len(kinds), columns=columns, width_in=1.0 + 3.6 * columns, height_in=1.9 + 3.6 * len(kinds))
    style = styles(table.values("method"))
    for place, panel in enumerate(canvas.panels):
        row, column = divmod(place, columns)
        if column >= len(channels):
            panel.axes.set_visible(False)
            continue
        case = of_pattern(table.where(channel=channels[column]), kinds[row])
        _draw_errors(panel, case, style)
        panel.describe(f"{channels[column]}, {kinds[row]} loss", x_label(case), "RMSE / user's level (ratio)")
    canvas.legend_below(canvas.panels[0], columns=7)
    canvas.title("Error of repaired gains, with 95 % bootstrap intervals", caption)
    return canvas


def _draw_errors(panel: Panel, case: Table, style: dict[str, int]) -> None:
    draw_sweep(panel, case, "rmse", style)
    baseline = case.where(method=BASELINE)
    errors = case.numbers("rmse")
    top = _HEADROOM * float((baseline if baseline.rows else case).numbers("rmse").max())
    if top > 0:
        logarithmic(panel, 0.7 * max(least_positive(errors, top), 1e-4 * top), top)
    beyond = [name for name in case.values("method") if case.where(method=name).numbers("rmse").min() > top]
    if beyond:
        panel.corner(f"above: {', '.join(map(readable, beyond))}")


def calibration_canvas(table: Table, loss: str, probabilities: Sequence[float], caption: str) -> Canvas:
    """How often the truth lies below the quantiles of each posterior, less how often it should; a panel per channel."""
    channels = table.values("channel")
    columns = min(len(channels), 3)
    rows = -(-len(channels) // columns)
    canvas = Canvas(rows=rows, columns=columns, width_in=max(1.0 + 4.2 * columns, 8.0), height_in=1.7 + 3.6 * rows)
    style = styles(table.values("method"))
    nominal = 100.0 * np.array(probabilities)
    for place, panel in enumerate(canvas.panels):
        if place >= len(channels):
            panel.axes.set_visible(False)
            continue
        case = table.where(channel=channels[place], loss=loss)
        for method in case.values("method"):
            row = case.where(method=method)
            shares = [
                100.0 * np.concatenate([row.numbers(f"below_{at:g}{end}") for at in nominal.tolist()])
                for end in ("", "_low", "_high")
            ]
            if not np.isnan(shares[0]).any():
                panel.curve(
                    nominal, shares[0] - nominal, between=(shares[1] - nominal, shares[2] - nominal),
                    label=readable(method), style=style[str(method)],
                )  # fmt: skip
        panel.guide((0.0, 100.0), (0.0, 0.0), label="as it should be")
        panel.describe(
            f"{channels[place]}, {loss}", "Quantile of the posterior (%)", "Truth below it, less the nominal share (%)"
        )
        panel.plain_ticks("x", nominal.tolist())
        panel.grid()
    canvas.legend_below(canvas.panels[0], columns=6)
    canvas.title("Calibration of the stated uncertainty, with 95 % bootstrap intervals", caption)
    return canvas

"""The error of every registered repairer over a sweep of scenarios: what the error experiments share."""

from __future__ import annotations

from abc import abstractmethod
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.repair_error import comparable_repairers, squared_errors
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.statistics import root_ratio_interval
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.pictures.canvas import Canvas

BASELINE = "user_mean"


@dataclass(frozen=True, kw_only=True)
class ErrorSweep(Experiment):
    """Root-mean-square error over the missing entries, for every repairer, at each point of a sweep.

    Every repairer sees the same draws, and every point starts from the same seeds. The cut is how far a repairer's
    normalised error lies below the user mean's. Errors are pooled over all draws; the literal NNCF's then rest on the
    few draws in which a strong user stands beside a weak one, so the median over the draws of each draw's ratio to the
    user mean's error is given too.

    Attributes:
        scenario: the cell and channel at every point, but for what the sweep varies.
    """

    axis: ClassVar[str]
    axis_label: ClassVar[str]
    axis_ticks: ClassVar[tuple[float, ...]]
    varied: ClassVar[Literal["loss", "delay spread"]]
    axis_scale: ClassVar[Literal["linear", "log"]] = "linear"

    scenario: Scenario = field(default_factory=Scenario)

    @abstractmethod
    def points(self) -> dict[float, Scenario]:
        """The scenario at each value of the swept quantity."""

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        repairers = comparable_repairers()
        draw = SweepDraw(tuple(self.points().values()), repairers)
        sums = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor)
        table = _table(self.axis, tuple(self.points()), repairers, sums)
        return Result(table=table, findings=self.findings(table), draws=draws)

    def findings(self, table: Table) -> dict[str, Any]:
        """The conclusions, from the table."""
        return {
            f"cut_of_{BASELINE}_error_by_{self.axis}": self.by_point(table, "cut"),
            f"median_ratio_to_{BASELINE}_error_by_{self.axis}": self.by_point(table, "median_ratio"),
        }

    def by_point(self, table: Table, column: str) -> dict[str, dict[str, float]]:
        """A column's figures by repairer and point, but for the baseline."""
        found: dict[str, dict[str, float]] = {}
        for repairer in table.values("repairer"):
            if repairer != BASELINE:
                rows = table.where(repairer=repairer)
                points = (f"{x:g}" for x in rows.numbers(self.axis))
                found[str(repairer)] = dict(zip(points, rows.numbers(column).tolist(), strict=True))
        return found

    def picture(self, result: Result) -> Canvas:
        table = result.table
        canvas = Canvas(columns=2, width_in=11.0, height_in=4.8)
        relative, decibels = canvas.panels
        for style, repairer in enumerate(table.values("repairer")):
            rows = table.where(repairer=repairer)
            for panel, column in ((relative, "rmse_per_mean_gain"), (decibels, "rmse_db")):
                panel.curve(
                    rows.numbers(self.axis),
                    rows.numbers(column),
                    half_width=rows.numbers(f"{column}_ci95"),
                    label=str(repairer),
                    style=style,
                )
        relative.describe("Error relative to each user's mean gain", self.axis_label, "RMSE / mean gain (ratio)")
        relative.scales(x=self.axis_scale, y="log")
        decibels.describe("Error in dB", self.axis_label, "RMSE (dB)")
        decibels.scales(x=self.axis_scale)
        for panel in canvas.panels:
            panel.plain_ticks("x", self.axis_ticks)
            panel.grid()
            panel.legend()
        canvas.title(
            f"Missing gains, {len(table.values('repairer'))} ways to repair them, 95 % confidence intervals",
            self.scenario.caption(result.draws, varied=self.varied),
        )
        return canvas

    def configuration(self) -> dict[str, Any]:
        return {**super().configuration(), "repairers": list(comparable_repairers())}


@dataclass(frozen=True)
class SweepDraw:
    """One draw: the sums of squared errors, shape (point, repairer, 3)."""

    scenarios: tuple[Scenario, ...]
    repairers: tuple[str, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        return np.stack([squared_errors(*scenario.sense(seeds), self.repairers) for scenario in self.scenarios])


def _table(axis: str, points: tuple[float, ...], repairers: tuple[str, ...], sums: FloatArray) -> Table:
    """The table of sums of shape (draw, point, repairer, 3)."""
    relative, decibels, count = np.moveaxis(sums, -1, 0)
    baseline = relative[:, :, [repairers.index(BASELINE)]]
    rms, rms_half = root_ratio_interval(relative, count)
    rms_db, rms_db_half = root_ratio_interval(decibels, count)
    with np.errstate(invalid="ignore"):  # a draw in which nothing is missing has no ratio
        median_ratio = np.nanmedian(np.sqrt(relative / baseline), axis=0)
    share, share_half = root_ratio_interval(relative, np.broadcast_to(baseline, relative.shape))
    columns = (
        axis, "repairer", "rmse_per_mean_gain", "rmse_per_mean_gain_ci95", "rmse_db", "rmse_db_ci95", "cut", "cut_ci95",
        "median_ratio",
    )  # fmt: skip
    figures = np.stack([rms, rms_half, rms_db, rms_db_half, 1.0 - share, share_half, median_ratio], axis=-1)
    rows = [
        (point, repairer, *figures[i, j].tolist())
        for j, repairer in enumerate(repairers)
        for i, point in enumerate(points)
    ]
    return table_of(columns, rows)

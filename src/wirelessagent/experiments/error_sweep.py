"""The error of every registered repairer over a sweep: of the share lost, the delay spread, the users' correlation.

The paper says that its repair cuts the error by "approximately up to 67 %", without a delay spread and without saying
how alike its users are. The more a channel varies over the band, the less a neighbour in frequency says; the less alike
users are, the less a neighbour among them. So the claim belongs to a delay spread and to a correlation, found here.
"""

from __future__ import annotations

import dataclasses
from abc import abstractmethod
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.intervals import (
    Measure,
    columns_of,
    last_crossing,
    resampled_medians,
    resampled_sums,
    with_interval,
)
from wirelessagent.experiments.repair_error import comparable_repairers, squared_errors
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.sweep_pictures import styles
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.pictures.method_names import readable
from wirelessagent.sensing.rayleigh import Rayleigh

BASELINE = "user_mean"
AS_PRINTED = "nncf_paper"
OURS = ("nncf", chain.DEFAULT_REPAIRER)

CLAIMED_CUT = 0.67
"""The paper's figure, from its abstract."""

_FIGURES = ("rmse_per_mean_gain", "rmse_db", "cut", "cut_absolute")


@dataclass(frozen=True, kw_only=True)
class ErrorSweep(Experiment):
    """Root-mean-square error over the missing entries, for every repairer, at each point of a sweep.

    Every repairer sees the same draws, and every point starts from the same seeds. The cut is how far a repairer's
    error lies below the user mean's: of errors relative to each user's mean gain, and (``cut_absolute``) of errors in
    gain as they stand, which the strongest users rule.

    Attributes:
        scenario: the cell and channel at every point, but for what the sweep varies.
    """

    axis: ClassVar[str]
    axis_label: ClassVar[str]
    axis_ticks: ClassVar[tuple[float, ...]]
    varied: ClassVar[Literal["loss", "delay spread", "correlation"]]
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
        errors = Errors.of(tuple(self.points()), repairers, sums, seed)
        return Result(table=errors.table(self.axis), measures=self.measures(errors), draws=draws)

    def measures(self, errors: Errors) -> dict[str, Measure]:
        """The figures that claims are judged by."""
        del errors
        return {}

    def picture(self, result: Result) -> Canvas:
        table = result.table
        canvas = Canvas(columns=2, width_in=11.5, height_in=4.8)
        groups = _alike(table)
        style = styles(table.values("repairer"))
        for panel, column in zip(canvas.panels, _FIGURES, strict=False):
            for place, (repairer, others) in enumerate(groups.items()):
                rows = table.where(repairer=repairer)
                value, low, high = (rows.numbers(name) for name in columns_of(column))
                panel.curve(
                    rows.numbers(self.axis),
                    value,
                    between=(low, high),
                    label="\n= ".join(readable(name) for name in (repairer, *others)),
                    style=style[repairer],
                    dodge_pt=2.0 * (place - len(groups) / 2),
                )
            panel.plain_ticks("x", self.axis_ticks)
        relative, decibels = canvas.panels
        relative.describe("Error relative to each user's mean gain", self.axis_label, "RMSE / mean gain (ratio)")
        relative.scales(y="log")
        decibels.describe("Error in dB", self.axis_label, "RMSE (dB)")
        for panel in canvas.panels:
            panel.scales(x=self.axis_scale)
            panel.plain_ticks("x", self.axis_ticks)
            panel.grid()
        canvas.title(
            f"Missing gains, {len(table.values('repairer'))} ways to repair them, 95 % intervals",
            self.scenario.caption(result.draws, varied=self.varied),
        )
        self.annotate(canvas, result)
        for panel in canvas.panels:
            panel.label_ends()
        return canvas

    def annotate(self, canvas: Canvas, result: Result) -> None:
        """Draw what only one sweep shows."""

    def configuration(self) -> dict[str, Any]:
        return {**super().configuration(), "repairers": list(comparable_repairers())}


@dataclass(frozen=True, kw_only=True)
class ErrorVersusLoss(ErrorSweep):
    """Repair error from 5 % to 80 % random loss, at the scenario's delay spread."""

    name = "error_versus_loss"
    summary = "Repair error against the loss rate, for every registered repairer"
    axis = "loss_percent"
    axis_label = "Random loss (%)"
    varied = "loss"
    axis_ticks = (0.0, 20.0, 40.0, 60.0, 80.0)

    loss_percents: tuple[float, ...] = (5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0)

    def points(self) -> dict[float, Scenario]:
        return {percent: self.scenario.with_loss(percent / 100.0) for percent in self.loss_percents}


@dataclass(frozen=True, kw_only=True)
class ErrorVersusDelaySpread(ErrorSweep):
    """Repair error from a flat channel to one that changes from subcarrier to subcarrier."""

    name = "error_versus_delay_spread"
    summary = "Repair error against the delay spread, for every registered repairer: the paper's 67 % claim"
    axis = "rms_delay_spread_ns"
    axis_label = "RMS delay spread (ns)"
    varied = "delay spread"
    axis_ticks = (10.0, 30.0, 100.0, 300.0, 1000.0)
    axis_scale = "log"

    rms_delay_spreads_ns: tuple[float, ...] = (
        10.0, 20.0, 30.0, 50.0, 70.0, 100.0, 140.0, 170.0, 200.0, 240.0, 300.0, 400.0, 600.0, 1000.0,
    )  # fmt: skip

    def points(self) -> dict[float, Scenario]:
        return {spread: self.scenario.with_delay_spread(spread / 1e9) for spread in self.rms_delay_spreads_ns}

    def measures(self, errors: Errors) -> dict[str, Measure]:
        spreads = np.array(errors.points)
        usual_ns = 1e9 * self.scenario.channel.rms_delay_spread_s
        usual = int(np.abs(spreads - usual_ns).argmin())
        printed = 100.0 * errors.of_repairer("cut_absolute", AS_PRINTED)
        found = {
            "usual_delay_spread": Measure.exact(float(spreads[usual]), "ns"),
            "best_cut_as_printed": Measure.of(printed.max(axis=1), "%"),
            "best_delay_spread_as_printed": Measure.of(spreads[printed.argmax(axis=1)], "ns"),
            "error_ratio_as_printed": Measure.of(errors.median_ratio(AS_PRINTED, usual)),
        }
        for repairer in OURS:
            cut = errors.of_repairer("cut", repairer)
            reach = np.array([last_crossing(spreads, one, CLAIMED_CUT) for one in cut])
            found[f"cut_by_{repairer}"] = Measure.of(100.0 * cut[:, usual], "%")
            found[f"reach_of_{repairer}"] = Measure.of(reach, "ns")
        return found

    def annotate(self, canvas: Canvas, result: Result) -> None:
        baseline = result.table.where(repairer=BASELINE)
        errors = (1.0 - CLAIMED_CUT) * baseline.numbers("rmse_per_mean_gain")
        canvas.panels[0].guide(
            baseline.numbers(self.axis), errors, label=f"{100 * CLAIMED_CUT:.0f} % below\n{readable(BASELINE)}"
        )


@dataclass(frozen=True, kw_only=True)
class ErrorVersusUserCorrelation(ErrorSweep):
    """Repair error of users with one and the same path loss, from independent ones to almost equal ones.

    What the paper's rule, which averages over users as they stand, would need.
    """

    name = "error_versus_user_correlation"
    summary = "Repair error of users with the same path loss against their correlation: what the printed NNCF needs"
    axis = "user_correlation"
    axis_label = "Correlation of any two users' coefficients (ratio)"
    varied = "correlation"
    axis_ticks = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)

    scenario: Scenario = field(
        default_factory=lambda: Scenario(
            channel=Rayleigh(inner_radius_m=100.0, outer_radius_m=100.0, shadowing_std_db=0.0)
        )
    )
    user_correlations: tuple[float, ...] = (0.0, 0.5, 0.7, 0.8, 0.85, 0.9, 0.95, 0.99)

    def points(self) -> dict[float, Scenario]:
        channel = self.scenario.channel
        return {
            one: dataclasses.replace(self.scenario, channel=dataclasses.replace(channel, user_correlation=one))
            for one in self.user_correlations
        }

    def measures(self, errors: Errors) -> dict[str, Measure]:
        cut = errors.of_repairer("cut_absolute", AS_PRINTED)
        apart = 1.0 - np.array(errors.points[::-1])
        needed = np.array([1.0 - last_crossing(apart, one[::-1], CLAIMED_CUT) for one in cut])
        return {
            "cut_as_printed_of_alike_users": Measure.of(100.0 * cut[:, -1], "%"),
            "highest_correlation": Measure.exact(errors.points[-1]),
            "correlation_needed_as_printed": Measure.of(needed),
        }


@dataclass(frozen=True)
class SweepDraw:
    """One draw: the sums of squared errors, shape (point, repairer, 4)."""

    scenarios: tuple[Scenario, ...]
    repairers: tuple[str, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        return np.stack([squared_errors(*scenario.sense(seeds), self.repairers) for scenario in self.scenarios])


@dataclass(frozen=True, kw_only=True)
class Errors:
    """The errors of a sweep.

    Attributes:
        relative: sums of squared relative errors, shape (draw, point, repairer).
        resampled: each of ``_FIGURES`` from all draws and from each resample, shape (1 + resample, point, repairer).
    """

    points: tuple[float, ...]
    repairers: tuple[str, ...]
    seed: int
    relative: FloatArray
    resampled: Mapping[str, FloatArray]

    @classmethod
    def of(cls, points: tuple[float, ...], repairers: tuple[str, ...], sums: FloatArray, seed: int) -> Errors:
        """From sums of shape (draw, point, repairer, 4)."""
        relative, decibels, absolute, count = np.moveaxis(resampled_sums(sums, seed=seed), -1, 0)
        base = [repairers.index(BASELINE)]
        with np.errstate(divide="ignore", invalid="ignore"):  # a resample in which nothing is missing has no error
            figures = (
                np.sqrt(relative / count),
                np.sqrt(decibels / count),
                *(1.0 - np.sqrt(one / one[:, :, base]) for one in (relative, absolute)),
            )
        resampled: dict[str, FloatArray] = dict(zip(_FIGURES, figures, strict=True))
        return cls(points=points, repairers=repairers, seed=seed, relative=sums[..., 0], resampled=resampled)

    def of_repairer(self, figure: str, repairer: str) -> FloatArray:
        """A figure of one repairer, shape (1 + resample, point)."""
        return self.resampled[figure][:, :, self.repairers.index(repairer)]

    def median_ratio(self, repairer: str, point: int) -> FloatArray:
        """Median over the draws of a repairer's relative error to the user mean's, shape (1 + resample,)."""
        one, base = (self.relative[:, point, self.repairers.index(name)] for name in (repairer, BASELINE))
        with np.errstate(divide="ignore", invalid="ignore"):
            return resampled_medians(np.sqrt(one / base), seed=self.seed)

    def table(self, axis: str) -> Table:
        bounded = np.stack([with_interval(self.resampled[name]) for name in _FIGURES], axis=2)
        rows = [
            (point, repairer, *bounded[i, j].ravel().tolist())
            for j, repairer in enumerate(self.repairers)
            for i, point in enumerate(self.points)
        ]
        return table_of((axis, "repairer", *(column for name in _FIGURES for column in columns_of(name))), rows)


def _alike(table: Table) -> dict[str, list[str]]:
    """Repairers with one and the same error everywhere, by the first of them: one curve shows them all."""
    found: dict[str, list[str]] = {}
    for repairer in map(str, table.values("repairer")):
        errors = table.where(repairer=repairer).numbers(_FIGURES[0])
        for first in found:
            if np.allclose(errors, table.where(repairer=first).numbers(_FIGURES[0]), rtol=1e-9, atol=0.0):
                found[first].append(repairer)
                break
        else:
            found[repairer] = []
    return found

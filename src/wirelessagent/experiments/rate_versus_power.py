"""What repair is worth in rate: sum rate and goodput on the true channel against the power budget; Fig. 3.

Sum rate lets the link adapt ideally to the true channel after the allocation was made on the estimate, so it only
feels wrong owners and powers. Goodput counts a user's rate as it was committed on the estimate, and only if the true
channel carries it: all or nothing for each user. Where every subcarrier is coded and committed by itself, less is lost
at a time; that is the last panel.

The paper's own repair and its traditional filling have no variance: decisions take their gains at face value, as the
paper does. On the others the library decides as it always does, by the mean rate of an uncertain gain.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.intervals import Measure, columns_of, resampled_means, with_interval
from wirelessagent.experiments.scenario import Scenario, known
from wirelessagent.experiments.sweep_pictures import styles
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import kept, link_metrics
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import owned_gain, subcarrier_rate_bps
from wirelessagent.pictures.canvas import Canvas, Panel
from wirelessagent.pictures.method_names import readable

PERFECT = "perfect"
QUANTITIES = ("sum_rate", "goodput", "goodput_by_subcarrier")
"""What is measured of each decision."""

_PANELS = (
    ("sum_rate_mbps", "Sum rate, ideal link adaptation", "Achieved on the true channel (Mbit/s)"),
    ("sum_rate_share", "The same, beside perfect CSI", "Share of perfect CSI (%)"),
    ("goodput_mbps", "Goodput, committed per user", "Achieved on the true channel (Mbit/s)"),
    ("goodput_by_subcarrier_mbps", "Goodput, committed per subcarrier", "Achieved on the true channel (Mbit/s)"),
)
_MEGABIT = 1e6


@dataclass(frozen=True, kw_only=True)
class RateVersusPower(Experiment):
    """Max-rate decisions made with perfect, repaired and mean-filled channel knowledge, all on the same draws.

    A share is a ratio of means to perfect knowledge on the same draws, whose interval is much narrower than that of a
    rate. The picture's error bars are those of the shares, for by these the curves are compared.

    Attributes:
        scenario: the cell, channel and loss; the paper's Fig. 3 has 30 % loss.
        repairers: who repairs; ``user_mean`` is the paper's traditional filling, ``nncf_paper`` its own repair.
        max_powers_w: the power budgets.
    """

    name = "rate_versus_power"
    summary = "Achieved sum rate and goodput against the power budget at 30 % loss (the paper's Fig. 3)"

    scenario: Scenario = field(default_factory=lambda: Scenario(loss_rate=0.3))
    repairers: tuple[str, ...] = (chain.DEFAULT_REPAIRER, "nncf", "nncf_paper", "user_mean")
    max_powers_w: tuple[float, ...] = (1.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0)

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        draw = RateDraw(self.scenario, self.repairers, self.max_powers_w)
        rates = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor) / _MEGABIT
        means = resampled_means(rates, seed=seed)
        return Result(table=self._table(means), measures=self._measures(means), draws=draws)

    def _table(self, means: FloatArray) -> Table:
        """The table of mean rates in Mbit/s of shape (1 + resample, knowledge, power, quantity)."""
        figures = np.stack([with_interval(means), with_interval(means / means[:, :1])], axis=-2)
        names = [f"{quantity}_{kind}" for quantity in QUANTITIES for kind in ("mbps", "share")]
        return table_of(
            ("max_power_w", "csi", *(column for name in names for column in columns_of(name))),
            [
                (power, csi, *figures[i, j].ravel().tolist())
                for i, csi in enumerate((PERFECT, *self.repairers))
                for j, power in enumerate(self.max_powers_w)
            ],
        )

    def _measures(self, means: FloatArray) -> dict[str, Measure]:
        """The extremes over the budgets; gains are the printed repair's over mean filling."""
        share = 100.0 * means / means[:, :1]
        found: dict[str, Measure] = {}
        of_csi = {csi: share[:, i] for i, csi in enumerate((PERFECT, *self.repairers))}
        for place, quantity in enumerate(QUANTITIES[:2]):
            for csi in self.repairers:
                found[f"least_{quantity}_share_of_{csi}"] = Measure.of(of_csi[csi][..., place].min(axis=1), "%")
            filled, printed = of_csi["user_mean"][..., place], of_csi["nncf_paper"][..., place]
            found[f"largest_{quantity}_loss"] = Measure.of((100.0 - filled).max(axis=1), "%")
            gain = 100.0 * printed / np.where(filled > 0.0, filled, np.nan) - 100.0
            found[f"largest_{quantity}_gain"] = Measure.of(gain.max(axis=1), "%")
        return found

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(rows=2, columns=2, width_in=11.0, height_in=8.2)
        for panel, (column, title, y_label) in zip(canvas.panels, _PANELS, strict=True):
            self._draw(panel, result.table, column)
            panel.describe(title, "Power budget (W)", y_label)
            panel.grid()
            if column.endswith("_mbps"):
                panel.limits(y=(0.0, 1.05 * float(result.table.numbers("sum_rate_mbps").max())))
            panel.label_ends()
        canvas.title(
            f"Max rate on incomplete channel knowledge; {self.scenario.caption(result.draws)}",
            "In %: share of perfect CSI at full power. Error bars: 95 % interval of that share",
        )
        return canvas

    def _draw(self, panel: Panel, table: Table, column: str) -> None:
        """The curves of a column in %, or in Mbit/s with the interval of their share of perfect CSI."""
        quantity, _, kind = column.rpartition("_")
        style = styles(table.values("csi"))
        for place, csi in enumerate(table.values("csi")):
            rows = table.where(csi=csi)
            shares = [rows.numbers(name) for name in columns_of(f"{quantity}_share")]
            scale = 1.0 if kind == "share" else table.where(csi=PERFECT).numbers(column)
            panel.curve(
                rows.numbers("max_power_w"),
                rows.numbers(column),
                between=None if csi == PERFECT else (scale * shares[1], scale * shares[2]),
                label=readable(csi) if csi == PERFECT else f"{readable(csi)}:\n{100.0 * shares[0][-1]:.4g} %",
                style=style[str(csi)],
                dodge_pt=2.5 * (place - 2),
            )
        if kind == "share":
            panel.percent("y")


@dataclass(frozen=True)
class RateDraw:
    """One draw: the achieved ``QUANTITIES`` in bit/s, shape (knowledge, power, quantity)."""

    scenario: Scenario
    repairers: tuple[str, ...]
    max_powers_w: tuple[float, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        scene, observation = self.scenario.sense(seeds)
        cell = self.scenario.cell
        perfect = chain.perfect(scene)
        estimates = [perfect, *(known(observation, name) for name in self.repairers)]
        problems = [Problem("max_rate", max_power_w=power) for power in self.max_powers_w]
        return np.array(
            [[_rates(chain.decide(estimate, problem, cell), estimate, perfect) for problem in problems]
             for estimate in estimates]
        )  # fmt: skip


def _rates(decision: Decision, estimate: ChannelEstimate, perfect: ChannelEstimate) -> tuple[float, float, float]:
    """The ``QUANTITIES`` of a decision made on ``estimate``, in bit/s."""
    cell, owner, power_w = decision.cell, decision.owner, decision.power_w
    achieved = link_metrics(perfect.gain, owner, power_w, cell, committed_bps=decision.rate_bps)
    committed, carried = (
        subcarrier_rate_bps(owned_gain(one.gain, owner), power_w, cell) for one in (estimate, perfect)
    )
    by_subcarrier = float(committed[kept(carried, committed)].sum())
    return achieved.sum_rate_bps, achieved.goodput_bps, by_subcarrier

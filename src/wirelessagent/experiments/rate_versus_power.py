"""What repair is worth in rate: sum rate and goodput on the true channel against the power budget; Fig. 3.

Sum rate lets the link adapt ideally to the true channel after the allocation was made on the estimate, so it only
feels wrong owners and powers. Goodput counts a user's rate as it was committed on the estimate, and only if the true
channel carries it: all or nothing for each user. Where every subcarrier is coded and committed by itself, less is lost
at a time; that is the third panel.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.statistics import mean_interval, ratio_interval
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import kept, link_metrics
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import owned_gain, subcarrier_rate_bps
from wirelessagent.pictures.canvas import Canvas

PERFECT = "perfect"
QUANTITIES = {
    "sum_rate": "Sum rate, ideal link adaptation",
    "goodput": "Goodput, committed per user",
    "goodput_by_subcarrier": "Goodput, committed per subcarrier",
}
"""What is measured, and how the panels call it."""

_MEGABIT = 1e6


@dataclass(frozen=True, kw_only=True)
class RateVersusPower(Experiment):
    """Max-rate decisions made with perfect, repaired and mean-filled channel knowledge, all on the same draws.

    Every rate has two intervals: ``ci95`` of its own mean, and ``paired_ci95`` of its difference from perfect
    knowledge, draw by draw, which is much narrower because all share the draws. The picture shows the paired ones,
    for by these the curves are compared; perfect knowledge then has none. A share is a ratio of means.

    Attributes:
        scenario: the cell, channel and loss; the paper's Fig. 3 has 30 % loss.
        repairers: who repairs; ``user_mean`` is the paper's traditional filling.
        max_powers_w: the power budgets.
    """

    name = "rate_versus_power"
    summary = "Achieved sum rate and goodput against the power budget at 30 % loss (the paper's Fig. 3)"

    scenario: Scenario = field(default_factory=lambda: Scenario(loss_rate=0.3))
    repairers: tuple[str, ...] = ("nncf", "user_mean")
    max_powers_w: tuple[float, ...] = (1.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0)

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        draw = RateDraw(self.scenario, self.repairers, self.max_powers_w)
        rates = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor) / _MEGABIT
        table = self._table(rates)
        return Result(table=table, findings=self._findings(table), draws=draws)

    def _table(self, rates: FloatArray) -> Table:
        """The table of rates in Mbit/s of shape (draw, knowledge, power, quantity)."""
        perfect = rates[:, :1]
        mean, half = mean_interval(rates)
        _, paired_half = mean_interval(rates - perfect)
        share, share_half = ratio_interval(rates, np.broadcast_to(perfect, rates.shape))
        figures = np.stack([mean, half, paired_half, share, share_half], axis=-1).reshape(*mean.shape[:2], -1)
        columns = [
            f"{quantity}_{name}"
            for quantity in QUANTITIES
            for name in ("mbps", "mbps_ci95", "mbps_paired_ci95", "share", "share_ci95")
        ]
        return table_of(
            ("max_power_w", "csi", *columns),
            [
                (power, csi, *figures[i, j].tolist())
                for i, csi in enumerate((PERFECT, *self.repairers))
                for j, power in enumerate(self.max_powers_w)
            ],
        )

    def _findings(self, table: Table) -> dict[str, Any]:
        at_full_power = table.where(max_power_w=self.max_powers_w[-1])
        return {
            f"{quantity}_share_of_perfect_at_{self.max_powers_w[-1]:g}_w": {
                repairer: float(at_full_power.where(csi=repairer).numbers(f"{quantity}_share")[0])
                for repairer in self.repairers
            }
            for quantity in QUANTITIES
        }

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(columns=3, width_in=15.0, height_in=5.0)
        table = result.table
        highest = float(np.max([table.numbers(f"{quantity}_mbps") for quantity in QUANTITIES]))
        for panel, (quantity, title) in zip(canvas.panels, QUANTITIES.items(), strict=True):
            for csi in table.values("csi"):
                rows = table.where(csi=csi)
                share = float(rows.numbers(f"{quantity}_share")[-1])
                panel.curve(
                    rows.numbers("max_power_w"),
                    rows.numbers(f"{quantity}_mbps"),
                    half_width=None if csi == PERFECT else rows.numbers(f"{quantity}_mbps_paired_ci95"),
                    label="perfect CSI" if csi == PERFECT else f"{csi}: {100 * share:.2f} % of perfect at full power",
                    style=_STYLES.get(str(csi), 3),
                )
            panel.describe(title, "Power budget (W)", "Achieved on the true channel (Mbit/s)")
            panel.grid()
            panel.limits(y=(0.0, 1.4 * highest))
            panel.legend(place="upper left")
        canvas.title(
            f"Max rate on incomplete channel knowledge; {self.scenario.caption(result.draws)}",
            "Error bars: 95 % confidence interval of the paired difference from perfect CSI",
        )
        return canvas


_STYLES = {PERFECT: 6, "nncf": 1, "user_mean": 0}
"""Black, red and blue, as in the paper's figure."""


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
        estimates = [perfect, *(chain.repair(observation, name) for name in self.repairers)]
        problems = [Problem("max_rate", max_power_w=power) for power in self.max_powers_w]
        return np.array(
            [[_rates(chain.decide(estimate, problem, cell), estimate, perfect) for problem in problems]
             for estimate in estimates]
        )  # fmt: skip


def _rates(decision: Decision, estimate: ChannelEstimate, perfect: ChannelEstimate) -> tuple[float, float, float]:
    """Sum rate, goodput and goodput by subcarrier of a decision made on ``estimate``, in bit/s."""
    cell, owner, power_w = decision.cell, decision.owner, decision.power_w
    achieved = link_metrics(perfect.gain, owner, power_w, cell, committed_bps=decision.rate_bps)
    committed, carried = (
        subcarrier_rate_bps(owned_gain(known.gain, owner), power_w, cell) for known in (estimate, perfect)
    )
    by_subcarrier = float(committed[kept(carried, committed)].sum())
    return achieved.sum_rate_bps, achieved.goodput_bps, by_subcarrier

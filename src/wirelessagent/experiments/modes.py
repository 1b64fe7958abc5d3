"""The three modes side by side, against allocations that do not look at the objective.

Everything is decided on a repaired channel and measured on the true one. Minimum power cannot serve every draw: its
figures, and those of the fixed power that shares its subcarrier sets, are means over the draws in which it can, and
the share of the others is counted.
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
from wirelessagent.experiments.statistics import mean_interval
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.metrics import link_metrics
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human
from wirelessagent.pictures.canvas import PALETTE, Canvas

STRATEGIES = ("max rate", "min power", "max energy efficiency", "equal power", "fixed power", "round robin")
"""The three modes and the baselines, in the order of the table's rows."""

_STATUSES = ("optimal", "feasible", "infeasible", "undecided")

_FIGURES = {
    "sum_rate_mbps": "Sum rate (Mbit/s)",
    "power_w": "Radiated power (W)",
    "energy_efficiency_mbit_per_j": "Energy efficiency (Mbit/J)",
    "jain_index": "Jain's fairness index (ratio)",
}

_KEPT = "users_at_min_rate_share"
_SERVED = "served_share"


@dataclass(frozen=True, kw_only=True)
class Modes(Experiment):
    """Max rate, min power and max energy efficiency against equal power, fixed power and round robin.

    Equal power gives each subcarrier to its best user and every subcarrier the same power; round robin deals the
    subcarriers out in turn; both radiate the whole budget. Fixed power takes minimum power's subcarrier sets and
    radiates the budget in equal parts on them, the scheme that the paper holds against its minimum power.

    Attributes:
        scenario: the cell, channel and loss.
        repairer: who repairs.
        min_rate_bps: the rate that minimum power promises to each user.
    """

    name = "modes"
    summary = "Max rate, min power and max energy efficiency against equal power, fixed power and round robin"

    scenario: Scenario = field(default_factory=Scenario)
    repairer: str = "nncf"
    min_rate_bps: float = 1e6

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        draw = ModesDraw(self.scenario, self.repairer, self.min_rate_bps)
        figures = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor)
        table = _table(figures)
        return Result(table=table, findings=self._findings(table), draws=draws)

    def _findings(self, table: Table) -> dict[str, Any]:
        served = table.where(strategy="min power")
        watts, fixed_watts = (table.where(strategy=s).numbers("power_w")[0] for s in ("min power", "fixed power"))
        return {
            "min_power_infeasible_share": float(served.numbers("infeasible_share")[0]),
            "min_power_users_at_min_rate_share": None if np.isnan(watts) else float(served.numbers(_KEPT)[0]),
            "min_power_over_fixed_power": None if np.isnan(watts) else float(watts / fixed_watts),
        }

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(rows=2, columns=2, width_in=11.0, height_in=7.5)
        table = result.table
        for panel, (column, label) in zip(canvas.panels, _FIGURES.items(), strict=True):
            panel.bars(
                range(len(STRATEGIES)),
                table.numbers(column),
                width=0.7,
                colour=PALETTE[: len(STRATEGIES)],
                half_width=table.numbers(f"{column}_ci95"),
            )
            panel.describe(label.partition(" (")[0], "", label)
            panel.ticks("x", range(len(STRATEGIES)), [strategy.replace(" ", "\n") for strategy in STRATEGIES])
            panel.grid()
        canvas.title(
            f"Measured on the true channel, 95 % confidence intervals; {self.scenario.caption(result.draws)}",
            *self._served_lines(table),
        )
        return canvas

    def _served_lines(self, table: Table) -> list[str]:
        """What minimum power's bars count: found is decided on the estimate, what users get on the true channel."""
        least = table.where(strategy="min power")
        found, kept = (float(least.numbers(column)[0]) for column in (_SERVED, _KEPT))
        asked = f"min power ({human(self.min_rate_bps, 'bit/s')} each)"
        if found == 0:
            return [f"{asked}: no allocation was found in any draw, so min power and fixed power have no bars"]
        found_text = f"{asked}: an allocation was found in {100 * found:.0f} % of the draws"
        kept_text = f"{100 * kept:.0f} % of its users got the rate on the true channel"
        return [f"{found_text}, {kept_text}", "min power and fixed power: means over those draws only"]


@dataclass(frozen=True)
class ModesDraw:
    """One draw: per strategy its figures, the share of users at the minimum rate or above, and its status in ones.

    Shape (strategy, figure + 1 + status); figures are NaN where nothing may be applied.
    """

    scenario: Scenario
    repairer: str
    min_rate_bps: float

    def __call__(self, seeds: Seeds) -> FloatArray:
        scene, observation = self.scenario.sense(seeds)
        cell = self.scenario.cell
        truth = chain.perfect(scene).gain
        estimate = chain.repair(observation, self.repairer)
        least = chain.decide(estimate, Problem("min_power", min_rate_bps=self.min_rate_bps), cell)
        decisions = {
            "max rate": chain.decide(estimate, Problem("max_rate"), cell),
            "min power": least,
            "max energy efficiency": chain.decide(estimate, Problem("max_energy_efficiency"), cell),
            "equal power": chain.decide(estimate, Problem("max_rate"), cell, "equal_power"),
            "fixed power": least,
            "round robin": chain.decide(estimate, Problem("max_rate"), cell, "round_robin"),
        }
        return np.stack([self._measure(strategy, decisions[strategy], truth) for strategy in STRATEGIES])

    def _measure(self, strategy: str, decision: Decision, truth: FloatArray) -> FloatArray:
        status = [float(decision.status == name) for name in _STATUSES]
        if not decision.is_usable:
            return np.array([np.nan] * (len(_FIGURES) + 1) + status)
        owned = decision.owner >= 0
        power = decision.power_w
        if strategy == "fixed power":
            power = np.where(owned, decision.cell.max_power_w / owned.sum(), 0.0)
        achieved = link_metrics(truth, decision.owner, power, decision.cell)
        kept = float(np.mean(achieved.user_rate_bps >= self.min_rate_bps))
        figures = (
            achieved.sum_rate_bps / 1e6,
            achieved.power_w,
            achieved.energy_efficiency_bit_per_j / 1e6,
            achieved.jain_index,
        )
        return np.array([*figures, kept, *status])


def _table(figures: FloatArray) -> Table:
    """The table of figures of shape (draw, strategy, figure + 1 + status)."""
    mean, half = mean_interval(figures)
    measured = len(_FIGURES) + 1
    names = (*_FIGURES, _KEPT)
    columns = ["strategy"]
    for name in names:
        columns += [name, f"{name}_ci95"]
    shares = [f"{status}_share" for status in _STATUSES]
    rows = [
        (
            strategy,
            *np.stack([mean[i, :measured], half[i, :measured]], axis=-1).ravel().tolist(),
            float(mean[i, measured : measured + 2].sum()),
            *mean[i, measured:].tolist(),
        )
        for i, strategy in enumerate(STRATEGIES)
    ]
    return table_of([*columns, _SERVED, *shares], rows)

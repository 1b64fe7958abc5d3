"""The three modes side by side, as the library decides and as printed, against allocations blind to the objective.

Everything is decided on a repaired channel and measured on the true one. As printed is the paper's own chain: its
repair at face value, then its own method for the mode. Minimum power cannot serve every draw: its figures, and those of
the fixed power that shares its subcarrier sets, are means over the draws in which it can, and the share of the others
is counted.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np

from wirelessagent import chain
from wirelessagent.deciding.methods.paper_scan import PaperScan
from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.intervals import Measure, columns_of, resampled_means, with_interval
from wirelessagent.experiments.scenario import Scenario, known
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.metrics import kept, link_metrics
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human, reliability
from wirelessagent.pictures.canvas import GREY, PALETTE, Canvas, Panel

AS_PRINTED = "as printed"
PROMISED = "promised"
OURS = "default"

STRATEGIES = (
    ("max rate", OURS), ("max rate", AS_PRINTED),
    ("min power", OURS), ("min power", PROMISED), ("min power", AS_PRINTED),
    ("fixed power", OURS), ("fixed power", AS_PRINTED),
    ("max energy efficiency", OURS), ("max energy efficiency", AS_PRINTED),
    ("equal power", OURS), ("round robin", OURS),
)  # fmt: skip
"""Modes and baselines with who decides, in the order of the table's rows."""

_STATUSES = ("optimal", "feasible", "infeasible", "undecided")

_FIGURES = {
    "sum_rate_mbps": "Sum rate (Mbit/s)",
    "power_w": "Radiated power (W)",
    "energy_efficiency_mbit_per_j": "Energy efficiency (Mbit/J)",
    "users_at_min_rate_share": "Users at the promised rate (%)",
}
_MEASURED = (*_FIGURES, "jain_index", "drawn_w", "bound", "gap")
"""What is measured of each strategy in a draw: ``drawn_w`` with the circuits' power, last the certificate's figures."""

_SERVED = "served_share"


@dataclass(frozen=True, kw_only=True)
class Modes(Experiment):
    """Max rate, min power and max energy efficiency against fixed power, equal power and round robin.

    Equal power gives each subcarrier to its best user and every subcarrier the same power; round robin deals the
    subcarriers out in turn; both radiate the whole budget. Fixed power takes minimum power's subcarrier sets and
    radiates the budget in equal parts on them, the scheme that the paper holds against its minimum power.

    Attributes:
        scenario: the cell, channel and loss.
        repairer: who repairs where the library decides.
        min_rate_bps: the rate that minimum power carries for each user.
        outage_probability: with which it is promised, in the strategy of that name.
    """

    name = "modes"
    summary = "Max rate, min power and max energy efficiency, as printed and by default, against blind allocations"

    scenario: Scenario = field(default_factory=Scenario)
    repairer: str = chain.DEFAULT_REPAIRER
    min_rate_bps: float = 1e6
    outage_probability: float = 0.05

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        draw = ModesDraw(self.scenario, self.repairer, self.min_rate_bps, self.outage_probability)
        figures = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor)
        means = resampled_means(figures, seed=seed)
        return Result(table=_table(means), measures=self._measures(means), draws=draws)

    def _measures(self, means: FloatArray) -> dict[str, Measure]:
        """From means of shape (1 + resample, strategy, figure); of what is compared, ratios of means."""

        def mean(mode: str, who: str, figure: str) -> FloatArray:
            return means[:, STRATEGIES.index((mode, who)), _MEASURED.index(figure)]

        budget_w = self.scenario.cell.max_power_w
        found = {
            "radiated_share_as_printed": 100.0 * mean("max rate", AS_PRINTED, "power_w") / budget_w,
            "efficiency_gap_as_printed": 100.0 * mean("max energy efficiency", AS_PRINTED, "gap"),
            "drawn_saving_as_printed": 100.0
            - 100.0 * mean("min power", AS_PRINTED, "drawn_w") / mean("fixed power", AS_PRINTED, "drawn_w"),
            "rate_share_of_fixed_power": 100.0
            * mean("min power", AS_PRINTED, "sum_rate_mbps") / mean("fixed power", AS_PRINTED, "sum_rate_mbps"),
        }  # fmt: skip
        for who in (AS_PRINTED, PROMISED):
            name = who.replace(" ", "_")
            excess = mean("min power", who, "power_w") / mean("min power", who, "bound") - 1.0
            found[f"excess_power_{name}"] = 100.0 * excess
            found[f"users_served_{name}"] = 100.0 * mean("min power", who, "users_at_min_rate_share")
        levels = Measure.exact(PaperScan().num_levels)
        return {**{name: Measure.of(figures, "%") for name, figures in found.items()}, "power_levels": levels}

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(rows=2, columns=2, width_in=12.0, height_in=8.4)
        for panel, (column, label) in zip(canvas.panels, _FIGURES.items(), strict=True):
            _draw(panel, result.table, column)
            panel.describe(label.partition(" (")[0], "", label)
            panel.grid()
        canvas.panels[-1].percent("y")
        canvas.legend_below(canvas.panels[0], columns=4)
        canvas.title(
            f"Measured on the true channel, 95 % intervals; {self.scenario.caption(result.draws)}",
            *self._served_lines(result.table),
        )
        return canvas

    def _served_lines(self, table: Table) -> list[str]:
        """What minimum power's bars count: found is decided on the estimate, what users get on the true channel."""
        least = table.where(strategy="min power", who=OURS)
        found, got = (float(least.numbers(column)[0]) for column in (_SERVED, "users_at_min_rate_share"))
        sure = reliability(self.outage_probability)
        asked = f"min power: {human(self.min_rate_bps, 'bit/s')} each, promised with {sure} where so named"
        if found == 0:
            return [asked, "no allocation was found in any draw, so min power and fixed power have no bars"]
        return [
            f"{asked}; an allocation was found in {100 * found:.0f} % of the draws, over which its bars are means",
            f"by default and without a promise, {100 * got:.0f} % of its users got the rate",
        ]


_SERIES = {
    OURS: (PALETTE[0], "the library's default"),
    PROMISED: (PALETTE[2], "the same, with the rate promised"),
    AS_PRINTED: (PALETTE[1], "the paper's method on its own repair"),
    "blind": (GREY, "allocation blind to the objective"),
}
"""Colour and name of the bars of each kind."""
_WIDTH = 0.27


def _draw(panel: Panel, table: Table, column: str) -> None:
    """A group of bars for each mode and baseline."""
    modes = list(dict.fromkeys(mode for mode, _ in STRATEGIES))
    for series, (colour, label) in _SERIES.items():
        where = [
            (modes.index(mode) + _WIDTH * _place(mode, who), table.where(strategy=mode, who=who))
            for mode, who in STRATEGIES
            if series == ("blind" if mode in ("equal power", "round robin") else who)
        ]
        value, low, high = (np.concatenate([rows.numbers(name) for _, rows in where]) for name in columns_of(column))
        panel.bars([x for x, _ in where], value, width=_WIDTH, colour=colour, label=label, between=(low, high))
    panel.ticks("x", range(len(modes)), [mode.replace(" ", "\n") for mode in modes])


def _place(mode: str, who: str) -> float:
    """Where a bar stands in its group, in widths of a bar from the middle."""
    group = [one for named, one in STRATEGIES if named == mode]
    return group.index(who) - (len(group) - 1) / 2.0


@dataclass(frozen=True)
class ModesDraw:
    """One draw: per strategy what is measured and its status in ones, shape (strategy, measured + status).

    Figures are NaN where nothing may be applied.
    """

    scenario: Scenario
    repairer: str
    min_rate_bps: float
    outage_probability: float

    def __call__(self, seeds: Seeds) -> FloatArray:
        scene, observation = self.scenario.sense(seeds)
        truth = chain.perfect(scene).gain
        sure = Problem("min_power", min_rate_bps=self.min_rate_bps, outage_probability=self.outage_probability)
        problems = {
            "max rate": Problem("max_rate"),
            "min power": Problem("min_power", min_rate_bps=self.min_rate_bps),
            "max energy efficiency": Problem("max_energy_efficiency"),
            "equal power": Problem("max_rate"),
            "round robin": Problem("max_rate"),
        }
        methods = {"equal power": "equal_power", "round robin": "round_robin"}
        estimates = {who: known(observation, self.repairer) for who in (OURS, PROMISED)}
        estimates[AS_PRINTED] = known(observation, "nncf_paper")
        decisions: dict[tuple[str, str], Decision] = {}
        for mode, who in STRATEGIES:
            if mode == "fixed power":
                decisions[mode, who] = decisions["min power", who]
            else:
                problem = sure if who == PROMISED else problems[mode]
                method = "paper" if who == AS_PRINTED else methods.get(mode)
                decisions[mode, who] = chain.decide(estimates[who], problem, self.scenario.cell, method)
        return np.stack([self._measure(mode, decision, truth) for (mode, _), decision in decisions.items()])

    def _measure(self, mode: str, decision: Decision, truth: FloatArray) -> FloatArray:
        status = [float(decision.status == name) for name in _STATUSES]
        if not decision.is_usable:
            return np.array([np.nan] * len(_MEASURED) + status)
        owned = decision.owner >= 0
        power = decision.power_w
        if mode == "fixed power":
            power = np.where(owned, decision.cell.max_power_w / owned.sum(), 0.0)
        achieved = link_metrics(truth, decision.owner, power, decision.cell)
        promised = np.full(len(truth), self.min_rate_bps)
        figures = (
            achieved.sum_rate_bps / 1e6,
            achieved.power_w,
            achieved.energy_efficiency_bit_per_j / 1e6,
            float(np.mean(kept(achieved.user_rate_bps, promised))),
            achieved.jain_index,
            achieved.power_w + decision.cell.circuit_power_w,
            decision.bound,
            decision.gap,
        )
        return np.array([*figures, *status])


def _table(means: FloatArray) -> Table:
    """The table of means of shape (1 + resample, strategy, measured + status)."""
    bounded = with_interval(means[:, :, : len(_MEASURED)])
    status = means[0, :, len(_MEASURED) :]
    shares = [f"{name}_share" for name in _STATUSES]
    rows = [
        (*strategy, *bounded[i].ravel().tolist(), float(status[i, :2].sum()), *status[i].tolist())
        for i, strategy in enumerate(STRATEGIES)
    ]
    columns = [column for name in _MEASURED for column in columns_of(name)]
    return table_of(["strategy", "who", *columns, _SERVED, *shares], rows)

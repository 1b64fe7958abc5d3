"""How long repair and decision take as the matrix grows: the paper's claim of linear scaling (section III.C).

Timed are the library's calls as a user makes them, checks and certificates included, so small matrices show the fixed
cost of a call. The exponent is therefore fitted to the larger half of the sizes. Times are this machine's: of all
experiments only this one gives another table at each run.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import seeds_of
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.statistics import log_log_slope
from wirelessagent.experiments.table import Table, Value, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.sensing.rayleigh import Rayleigh

_DECISIONS = (
    ("max_rate", "dual"),
    ("min_power", "dual"),
    ("max_energy_efficiency", "dual"),
    ("max_energy_efficiency", "paper_scan"),
)

_FEWEST_REPEATS = 3

_SWEEPS = {"subcarriers": "Subcarriers N", "users": "Users K"}


@dataclass(frozen=True, kw_only=True)
class RunTime(Experiment):
    """Median and quartiles of the time of each stage over repeated calls on one channel.

    Attributes:
        num_subcarriers: sizes N of the first sweep, at ``users_held`` users.
        num_users: sizes K of the second sweep, at ``subcarriers_held`` subcarriers.
        users_held: K of the first sweep.
        subcarriers_held: N of the second sweep.
        loss_rate: share of the entries to be repaired.
        min_rate_bps: the rate that minimum power must carry for each user.
        most_repeats: calls per point, where as many draws are asked for.
        most_seconds: time after which a point of slow calls is left with fewer repeats, but three at least.
    """

    name = "run_time"
    summary = "Run time of repair and of each objective's method against N and K (the linear-scaling claim)"

    num_subcarriers: tuple[int, ...] = (64, 128, 256, 512, 1024, 2048, 4096, 8192)
    num_users: tuple[int, ...] = (4, 8, 16, 32, 64, 128, 256)
    users_held: int = 8
    subcarriers_held: int = 512
    loss_rate: float = 0.2
    min_rate_bps: float = 1e5
    most_repeats: int = 20
    most_seconds: float = 0.4

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        del executor  # calls that share the processor with others cannot be timed
        repeats = min(draws, self.most_repeats)
        points = [("subcarriers", self.users_held, size) for size in self.num_subcarriers]
        points += [("users", size, self.subcarriers_held) for size in self.num_users]
        rows: list[tuple[Value, ...]] = []
        for done, (sweep, num_users, num_subcarriers) in enumerate(points, start=1):
            for stage, call in self._stages(num_users, num_subcarriers, seed).items():
                quartiles = np.percentile(_times_ms(call, repeats, self.most_seconds), (50, 25, 75)).tolist()
                rows.append((sweep, num_users, num_subcarriers, stage, *quartiles))
            if progress is not None:
                progress(done, len(points))
        columns = (
            "sweep", "num_users", "num_subcarriers", "stage",
            "time_median_ms", "time_lower_quartile_ms", "time_upper_quartile_ms",
        )  # fmt: skip
        table = table_of(columns, rows)
        return Result(table=table, findings=self._findings(table), draws=repeats)

    def _stages(self, num_users: int, num_subcarriers: int, seed: int) -> dict[str, Callable[[], object]]:
        """The calls to time at one size."""
        channel = Rayleigh(num_users=num_users, num_subcarriers=num_subcarriers)
        scenario = Scenario(channel=channel, loss_rate=self.loss_rate)
        _, observation = scenario.sense(seeds_of(seed, 0))
        estimate = chain.repair(observation, "nncf")
        stages: dict[str, Callable[[], object]] = {}
        for repairer in ("nncf", "nncf_paper"):
            stages[f"repair, {repairer}"] = functools.partial(chain.repair, observation, repairer)
        for objective, method in _DECISIONS:
            promised = self.min_rate_bps if objective == "min_power" else None
            problem = Problem(objective, min_rate_bps=promised)
            stages[f"{objective}, {method}"] = functools.partial(chain.decide, estimate, problem, scenario.cell, method)
        return stages

    def _findings(self, table: Table) -> dict[str, Any]:
        return {
            f"exponent_in_{sweep}": {str(stage): _exponent(table, sweep, stage) for stage in table.values("stage")}
            for sweep in _SWEEPS
        }

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(columns=2, width_in=11.0, height_in=5.0)
        table = result.table
        for panel, (sweep, label) in zip(canvas.panels, _SWEEPS.items(), strict=True):
            for style, stage in enumerate(table.values("stage")):
                rows = table.where(sweep=sweep, stage=stage)
                median = rows.numbers("time_median_ms")
                panel.curve(
                    rows.numbers(f"num_{sweep}"),
                    median,
                    between=(rows.numbers("time_lower_quartile_ms"), rows.numbers("time_upper_quartile_ms")),
                    label=f"{stage}: ∝ size^{_exponent(table, sweep, stage):.2f}",
                    style=style,
                )
            held = self.users_held if sweep == "subcarriers" else self.subcarriers_held
            other = "K" if sweep == "subcarriers" else "N"
            panel.describe(f"{other} = {held}", label, "Time of a call (ms), median and quartiles")
            panel.scales(x="log", y="log")
            panel.plain_ticks("x", self.num_subcarriers if sweep == "subcarriers" else self.num_users)
            panel.grid()
            panel.legend(place="upper left")
        lowest, highest = table.numbers("time_lower_quartile_ms").min(), table.numbers("time_upper_quartile_ms").max()
        for panel in canvas.panels:
            panel.limits(y=(float(lowest) / 1.5, float(highest) * 40.0))
        spread = human(Rayleigh().rms_delay_spread_s, "s")
        canvas.title(
            "Run time; exponents fitted to the larger half of the sizes",
            f"{100 * self.loss_rate:g} % random loss, {spread} RMS delay spread, 1 draw at each size, "
            f"up to {result.draws} calls a point",
        )
        return canvas


def _times_ms(call: Callable[[], object], repeats: int, most_seconds: float) -> FloatArray:
    """Times of up to ``repeats`` calls in ms, after one that is not counted because it may compile."""
    call()
    times: list[float] = []
    while len(times) < repeats and (len(times) < _FEWEST_REPEATS or sum(times) < 1e3 * most_seconds):
        start = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - start))
    return np.array(times)


def _exponent(table: Table, sweep: str, stage: Value) -> float:
    """The exponent of time against size over the larger half of a sweep's sizes."""
    rows = table.where(sweep=sweep, stage=stage)
    half = min(len(rows.rows) // 2, len(rows.rows) - 2)
    return log_log_slope(rows.numbers(f"num_{sweep}")[half:], rows.numbers("time_median_ms")[half:])

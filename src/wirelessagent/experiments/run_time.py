"""How long repair and decision take as the matrix grows: the paper's claim of linear scaling (section III.C).

Timed are the library's calls as a user makes them, checks and certificates included, so small matrices show the fixed
cost of a call. The exponent is therefore fitted to the larger half of the sizes. Times are this machine's: of all
experiments only this one gives another table at each run.

Other programs only ever make a call slower, so the least time of a point is the one fitted, and the sizes are timed in
turn, in another order each round, so that a slow minute slows all of them. What noise is left scatters the times about
the fit, and widens the interval of the exponent.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wirelessagent import chain, kernels
from wirelessagent.experiments.draws import seeds_of
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.intervals import Measure, exponent
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.table import Table, Value, table_of
from wirelessagent.model.problem import Problem
from wirelessagent.model.units import human
from wirelessagent.pictures.canvas import Canvas, Panel
from wirelessagent.pictures.method_names import readable
from wirelessagent.sensing.rayleigh import Rayleigh

_REPAIRERS = ("nncf_paper", "nncf")
_SCAN = "max_energy_efficiency_by_paper_scan"
_DECISIONS = {
    "max_rate_by_dual": ("max_rate", "dual"),
    "min_power_by_dual": ("min_power", "dual"),
    "max_energy_efficiency_by_dual": ("max_energy_efficiency", "dual"),
    _SCAN: ("max_energy_efficiency", "paper_scan"),
}
"""Objective and method of each stage that decides."""

_FEWEST_REPEATS = 3

_SWEEPS = {"subcarriers": ("N", "Subcarriers N"), "users": ("K", "Users K"), "levels": ("L", "Power levels L")}
"""Symbol and label of what each sweep varies."""

Call: TypeAlias = Callable[[], object]
Point: TypeAlias = tuple[str, int, int, int, str]
"""Sweep, users, subcarriers, power levels and stage."""


@dataclass(frozen=True, kw_only=True)
class RunTime(Experiment):
    """Least time of each stage over repeated calls on one channel, and the scatter of the others above it.

    Attributes:
        num_subcarriers: sizes N of the first sweep, at ``users_held`` users.
        num_users: sizes K of the second sweep, at ``subcarriers_held`` subcarriers.
        num_levels: numbers L of power levels of the third, of the scan alone, at both sizes held.
        users_held: K of the first and the third sweep.
        subcarriers_held: N of the second and the third sweep.
        levels_held: L of the first and the second sweep; the paper names none.
        loss_rate: share of the entries to be repaired.
        min_rate_bps: the rate that minimum power must carry for each user.
        most_repeats: calls per point, where as many draws are asked for.
        most_seconds: time after which a point of slow calls is left with fewer repeats, but three at least.
    """

    name = "run_time"
    summary = "Run time of repair and of each objective's method against N, K and L (the linear-scaling claim)"

    num_subcarriers: tuple[int, ...] = (64, 128, 256, 512, 1024, 1448, 2048, 2896, 4096, 5792, 8192)
    num_users: tuple[int, ...] = (4, 8, 16, 32, 64, 91, 128, 181, 256)
    num_levels: tuple[int, ...] = (25, 50, 100, 200, 400, 566, 800, 1131, 1600)
    users_held: int = 8
    subcarriers_held: int = 512
    levels_held: int = 100
    loss_rate: float = 0.2
    min_rate_bps: float = 1e5
    most_repeats: int = 20
    most_seconds: float = 0.6

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        del executor  # calls that share the processor with others cannot be timed
        repeats = min(draws, self.most_repeats)
        with kernels.work_on(kernels.LARGE_GAINS):  # the times are those of machine code
            times = _times_ms(self._calls(seed), repeats, self.most_seconds, seed, progress)
        rows: list[tuple[Value, ...]] = []
        for point, found in times.items():
            median, upper = np.percentile(found, (50, 75)).tolist()
            rows.append((*point, min(found), median, upper))
        columns = (
            "sweep", "num_users", "num_subcarriers", "num_levels", "stage",
            "time_least_ms", "time_median_ms", "time_upper_quartile_ms",
        )  # fmt: skip
        table = table_of(columns, rows)
        return Result(table=table, measures=scaling(table), draws=repeats)

    def _calls(self, seed: int) -> dict[Point, Call]:
        """What is timed, sweep by sweep and size by size."""
        calls: dict[Point, Call] = {}
        sizes = [("subcarriers", self.users_held, size) for size in self.num_subcarriers]
        sizes += [("users", size, self.subcarriers_held) for size in self.num_users]
        for sweep, num_users, num_subcarriers in sizes:
            for stage, call in self._stages(num_users, num_subcarriers, seed).items():
                calls[sweep, num_users, num_subcarriers, self.levels_held, stage] = call
        scan = self._stages(self.users_held, self.subcarriers_held, seed)[_SCAN]
        for levels in self.num_levels:
            point = ("levels", self.users_held, self.subcarriers_held, levels, _SCAN)
            calls[point] = functools.partial(scan, num_levels=levels)
        return calls

    def _stages(self, num_users: int, num_subcarriers: int, seed: int) -> dict[str, Callable[..., object]]:
        """The calls to time at one size."""
        channel = Rayleigh(num_users=num_users, num_subcarriers=num_subcarriers)
        scenario = Scenario(channel=channel, loss_rate=self.loss_rate)
        _, observation = scenario.sense(seeds_of(seed, 0))
        estimate = chain.repair(observation, "nncf")
        stages: dict[str, Callable[..., object]] = {
            f"repair_by_{name}": functools.partial(chain.repair, observation, name) for name in _REPAIRERS
        }
        for stage, (objective, method) in _DECISIONS.items():
            promised = self.min_rate_bps if objective == "min_power" else None
            problem = Problem(objective, min_rate_bps=promised)
            options = {"num_levels": self.levels_held} if method == "paper_scan" else {}
            stages[stage] = functools.partial(chain.decide, estimate, problem, scenario.cell, method, **options)
        return stages

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(columns=3, width_in=13.0, height_in=5.4)
        table = result.table
        exponents = [self._draw(panel, table, sweep) for panel, sweep in zip(canvas.panels, _SWEEPS, strict=True)]
        lowest, highest = table.numbers("time_least_ms").min(), table.numbers("time_upper_quartile_ms").max()
        for panel, labels in zip(canvas.panels, exponents, strict=True):
            panel.limits(y=(float(lowest) / 1.5, float(highest) * 1.5))
            panel.label_ends(labels)
        canvas.legend_below(canvas.panels[0], columns=3)
        spread = human(Rayleigh().rms_delay_spread_s, "s")
        canvas.title(
            "Run time, with the exponents fitted to the larger half of the sizes and their 95 % intervals",
            f"{100 * self.loss_rate:g} % random loss, {spread} RMS delay spread, 1 draw at each size, "
            f"up to {result.draws} calls a point",
        )
        return canvas

    def _draw(self, panel: Panel, table: Table, sweep: str) -> dict[str, str]:
        """The curves of a sweep, from the least time up to the upper quartile; their exponents by their names."""
        symbol, label = _SWEEPS[sweep]
        ends: dict[str, str] = {}
        for style, stage in enumerate(table.values("stage"), start=1):
            rows = table.where(sweep=sweep, stage=stage)
            if rows.rows:
                action, _, method = str(stage).partition("_by_")
                name = f"{readable(action)}, {readable(method)}"
                least = rows.numbers("time_least_ms")
                panel.curve(
                    rows.numbers(f"num_{sweep}"), least, label=name, style=style,
                    between=(least, rows.numbers("time_upper_quartile_ms")),
                )  # fmt: skip
                ends[name] = _power_law(symbol, _exponent(table, sweep, stage))
        held = {"K": self.users_held, "N": self.subcarriers_held, "L": self.levels_held}
        told = ", ".join(f"{one} = {size}" for one, size in held.items() if one != symbol)
        panel.describe(told, label, "Least time of a call and upper quartile (ms)")
        panel.scales(x="log", y="log")
        panel.plain_ticks("x", _far_apart(getattr(self, f"num_{sweep}")))
        panel.grid()
        return ends


def _far_apart(sizes: Sequence[int]) -> list[int]:
    """The first size and every one at least four times the last one taken."""
    taken: list[int] = []
    for size in sizes:
        if not taken or size >= 4 * taken[-1]:
            taken.append(size)
    return taken


def scaling(table: Table) -> dict[str, Measure]:
    """The exponent of every stage's time in every size, as ``exponent_in_<symbol>_of_<stage>``."""
    return {
        f"exponent_in_{symbol}_of_{stage}": _exponent(table, sweep, stage)
        for sweep, (symbol, _) in _SWEEPS.items()
        for stage in table.where(sweep=sweep).values("stage")
    }


def _exponent(table: Table, sweep: str, stage: Value) -> Measure:
    """The exponent of the least time over the larger half of a sweep's sizes."""
    rows = table.where(sweep=sweep, stage=stage)
    half = max(min(len(rows.rows) // 2, len(rows.rows) - 3), 0)
    return exponent(rows.numbers(f"num_{sweep}")[half:], rows.numbers("time_least_ms")[half:])


def _power_law(symbol: str, found: Measure) -> str:
    """The exponent as its interval leaves it."""
    half = (found.high - found.low) / 2.0
    return f"∝ {symbol}^{found.value:.2f} ± {half:.2f}" if half < 1.0 else "no exponent: noise"


def _times_ms(
    calls: Mapping[Point, Call], repeats: int, most_seconds: float, seed: int, progress: Progress | None
) -> dict[Point, list[float]]:
    """Times of up to ``repeats`` calls in ms, the points in turn, after one that is not counted as it may compile."""
    points = list(calls)
    shuffle = np.random.default_rng(seed)
    times: dict[Point, list[float]] = {point: [] for point in points}
    for done in range(repeats + 1):
        for place in shuffle.permutation(len(points)).tolist():
            found = times[points[place]]
            if len(found) < _FEWEST_REPEATS or sum(found) < 1e3 * most_seconds:
                took = _clocked(calls[points[place]])
                if done:
                    found.append(took)
        if progress is not None:
            progress(done, repeats)
    return times


def _clocked(call: Call) -> float:
    """The time of a call in ms: this process's own where the clock for that is fine enough, else that on the wall."""
    clock = time.process_time if time.get_clock_info("process_time").resolution < 1e-6 else time.perf_counter
    start = clock()
    call()
    return 1e3 * (clock() - start)

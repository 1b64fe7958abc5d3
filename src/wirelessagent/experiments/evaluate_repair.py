"""How wrong repaired gains are, and whether the methods know it: methods × channels × losses.

Every method repairs the same observations of the same channels. The error is the root of the mean squared error over
all missing entries of all draws, each relative to its user's level
(:mod:`wirelessagent.experiments.evaluated_channels`), and in dB, with deep fades floored as in
:mod:`wirelessagent.experiments.repair_error`. Calibration counts how often the truth lies below a quantile of the
posterior: below the 5 % one it should 5 % of the time, and between it and the 95 % one 90 % of the time.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.evaluate_repair_pictures import calibration_canvas, error_canvas, recovery_canvas
from wirelessagent.experiments.evaluated_channels import EvaluatedChannel
from wirelessagent.experiments.evaluated_methods import BASELINE, ORACLE, repaired, states_uncertainty
from wirelessagent.experiments.evaluation import Evaluated, Evaluation
from wirelessagent.experiments.experiment import Progress
from wirelessagent.experiments.intervals import resampled_sums, with_interval
from wirelessagent.experiments.recovery import recovery_table
from wirelessagent.experiments.repair_error import DEEPEST_FADE_DB
from wirelessagent.experiments.table import Table, Value, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.units import db
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.sensing.loss import parse as parse_loss

PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)
"""The quantiles whose calibration is counted; the first and the last enclose the 90 % interval."""

_SQUARED, _SQUARED_DB, _COUNT, _ENTRIES, _TIME, _BELOW = range(6)
"""Places of the sums of a draw; from the last on one for each of ``PROBABILITIES``."""

_INTERVALS = ("rmse", "rmse_db", "ratio_to_best", "ratio_to_oracle", "coverage_90")


@dataclass(frozen=True, kw_only=True)
class EvaluateRepair(Evaluation):
    """Repairers compared by their errors.

    Attributes:
        channels: to repair.
        losses: patterns in the words of :func:`wirelessagent.sensing.loss.parse`.
        methods: of :func:`wirelessagent.experiments.evaluated_methods.all_methods`.
    """

    name = "evaluate_repair"
    summary = "Error, calibration and time of repairers and their competitors"

    channels: tuple[EvaluatedChannel, ...]
    losses: tuple[str, ...]
    methods: tuple[str, ...]

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Evaluated:
        cases = [(channel, loss) for channel in self.channels for loss in self.losses]
        rows: list[tuple[Value, ...]] = []
        for number, (channel, loss) in enumerate(cases):

            def told(done: int, total: int, number: int = number) -> None:
                if progress is not None:
                    progress(number * total + done, len(cases) * total)

            methods = tuple(name for name in self.methods if name != ORACLE or channel.has_oracle)
            sums = run_draws(
                RepairDraw(channel, loss, methods), draws=draws, seed=seed, progress=told, executor=executor
            )
            rows += _rows((channel.name, loss), methods, sums, seed)
        table = table_of(COLUMNS, rows)
        recovery = recovery_table(self.channels[0], self.losses[0], self.methods, seed)
        tables = {self.name: table, "recovery": recovery}
        return Evaluated(tables=tables, findings=_findings(table), draws=draws, seed=seed)

    def pictures(self, result: Evaluated) -> dict[str, Canvas]:
        note = self._note(result.draws)
        first = f"{self.channels[0].name}, {self.losses[0]}; {self.channels[0].caption()}"
        return {
            "recovery": recovery_canvas(result.tables["recovery"], first),
            "error_versus_loss": error_canvas(result.table, note),
            "calibration": calibration_canvas(result.table, self.losses[0], PROBABILITIES, note),
        }

    def _note(self, draws: int) -> str:
        captions = dict.fromkeys(channel.caption() for channel in self.channels)
        return f"{'; '.join(captions)}; {draws} draw{'s' * (draws != 1)} each"

    def configuration(self) -> dict[str, Any]:
        return {
            "channels": {channel.name: channel.caption() for channel in self.channels},
            "losses": list(self.losses),
            "methods": list(self.methods),
        }


@dataclass(frozen=True)
class RepairDraw:
    """One draw: sums over the missing entries, shape (method, sum), in the order of the places above."""

    channel: EvaluatedChannel
    loss: str
    methods: tuple[str, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        drawn = self.channel.drawn(seeds.channel)
        observation = drawn.scene.observe(parse_loss(self.loss), seed=seeds.loss)
        level = np.broadcast_to(drawn.level[:, np.newaxis], drawn.truth.shape)
        chosen = observation.missing & (level > 0)
        wanted, scale = drawn.truth[chosen] / level[chosen], level[chosen]
        wanted_db = db(wanted, floor_db=DEEPEST_FADE_DB)
        sums = np.full((len(self.methods), _BELOW + len(PROBABILITIES)), np.nan)
        for row, method in zip(sums, self.methods, strict=True):
            estimate, row[_TIME] = repaired(method, drawn, observation)
            found = estimate.gain[chosen] / scale
            row[_SQUARED] = np.square(found - wanted).sum()
            row[_SQUARED_DB] = np.square(db(found, floor_db=DEEPEST_FADE_DB) - wanted_db).sum()
            row[_COUNT], row[_ENTRIES] = wanted.size, level.size
            if states_uncertainty(method):
                bounds = (estimate.posterior.quantile(at)[chosen] / scale for at in PROBABILITIES)
                row[_BELOW:] = [
                    np.sum(wanted <= bound if at > 0.5 else wanted < bound)  # the ends of an interval belong to it
                    for at, bound in zip(PROBABILITIES, bounds, strict=True)
                ]
        return sums


def _columns() -> tuple[str, ...]:
    intervals = [f"{name}{end}" for name in _INTERVALS for end in ("", "_low", "_high")]
    below = [f"below_{100 * at:g}{end}" for at in PROBABILITIES for end in ("", "_low", "_high")]
    return ("channel", "loss", "method", *intervals, *below, "missing_share", "time_ms", "missing_entries")


COLUMNS = _columns()
"""``rmse`` is relative to the user's level; ``_low`` and ``_high`` are the ends of a 95 % bootstrap interval."""


def _rows(case: tuple[str, str], methods: tuple[str, ...], sums: FloatArray, seed: int) -> list[tuple[Value, ...]]:
    """The rows of one channel and loss, from the sums of all draws (draw, method, sum)."""
    total = resampled_sums(np.delete(sums, _TIME, axis=2), seed=seed)
    squared, squared_db, count, entries = np.moveaxis(total[..., :4], -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        rmse, rmse_db = np.sqrt(squared / count), np.sqrt(squared_db / count)
        below = total[..., 4:] / count[..., np.newaxis]
        best = _best(methods, rmse[0])
        oracle = rmse[:, [methods.index(ORACLE)]] if ORACLE in methods else np.full_like(rmse[:, :1], np.nan)
        figures = [rmse, rmse_db, rmse / rmse[:, [best]], rmse / oracle, below[..., -1] - below[..., 0]]
    bounded = np.stack([with_interval(figure) for figure in figures], axis=1)
    shares = np.moveaxis(with_interval(below), 0, 0)
    rows: list[tuple[Value, ...]] = []
    for j, method in enumerate(methods):
        rest = (float(count[0, j] / entries[0, j]), 1e3 * float(np.median(sums[:, j, _TIME])), int(count[0, j]))
        rows.append((*case, method, *bounded[j].ravel().tolist(), *shares[j].ravel().tolist(), *rest))
    return rows


def _best(methods: tuple[str, ...], rmse: FloatArray) -> int:
    """The place of the method with the smallest error that anybody can have."""
    open_to_all = [j for j, name in enumerate(methods) if name != ORACLE] or [0]
    return min(open_to_all, key=lambda j: rmse[j])


def _findings(table: Table) -> dict[str, Any]:
    """Who is best, what that is to the oracle, and how far below the user mean's error it lies, by case."""
    found: dict[str, Any] = {}
    for channel in table.values("channel"):
        for loss in table.where(channel=channel).values("loss"):
            case = table.where(channel=channel, loss=loss)
            errors = dict(zip(case.values("method"), case.numbers("rmse").tolist(), strict=True))
            ratios = dict(zip(case.values("method"), case.numbers("ratio_to_oracle").tolist(), strict=True))
            best = min((name for name in errors if name != ORACLE), key=lambda name: errors[name], default=ORACLE)
            baseline = errors.get(BASELINE)
            found[f"{channel}, {loss}"] = {
                "best": best,
                "rmse": errors[best],
                "ratio_to_oracle": None if np.isnan(ratios[best]) else ratios[best],
                f"cut_of_{BASELINE}_error": None if not baseline else 1.0 - errors[best] / baseline,
            }
    return found

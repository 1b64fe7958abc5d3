"""One user's channel, what was lost of it and what repair makes of that: the paper's Fig. 2.

A single user proves nothing, so how closely a repair follows the channel is measured over all users of all draws: the
share of the fading that it explains at the missing entries, R² = 1 − Σ (ĝ_dB − g_dB)² / Σ (g_dB − ḡ_dB)² with ḡ_dB the
mean of a user's gains in dB, and gains floored as in :mod:`wirelessagent.experiments.repair_error`.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds, run_draws, seeds_of
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.intervals import Measure, resampled_medians, resampled_sums
from wirelessagent.experiments.repair_error import DEEPEST_FADE_DB
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.sweep_pictures import BLACK, styles
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.units import db
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.pictures.method_names import readable


@dataclass(frozen=True, kw_only=True)
class ChannelRecovery(Experiment):
    """The picture of the first draw's first user that lost at least its share of entries, and R² of all draws.

    Attributes:
        scenario: the cell, channel and loss.
        repairers: the repairers compared.
    """

    name = "channel_recovery"
    summary = "One user's channel, its missing entries and their repair (the paper's Fig. 2)"

    scenario: Scenario = field(default_factory=Scenario)
    repairers: tuple[str, ...] = ("user_mean", "nncf_paper", "nncf", chain.DEFAULT_REPAIRER)

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        draw = RecoveryDraw(self.scenario, self.repairers)
        sums = run_draws(draw, draws=draws, seed=seed, progress=progress, executor=executor)
        *squared, fading, _ = np.moveaxis(resampled_sums(sums, seed=seed), -1, 0)
        measures = {"usual_spread": Measure.exact(1e9 * self.scenario.channel.rms_delay_spread_s, "ns")}
        with np.errstate(divide="ignore", invalid="ignore"):  # nothing is missing in some resamples of few draws
            for repairer, error in zip(self.repairers, squared, strict=True):
                measures[f"explained_by_{repairer}"] = Measure.of(100.0 * (1.0 - error / fading), "%")
        measures["level_spread"] = Measure.of(resampled_medians(sums[:, -1], seed=seed), "dB")
        return Result(table=self._table(seed), measures=measures, draws=draws)

    def _table(self, seed: int) -> Table:
        """The picture's user: truth and estimates by subcarrier."""
        scene, observation = self.scenario.sense(seeds_of(seed, 0))
        truth = chain.perfect(scene).gain
        lost = observation.missing.sum(axis=1)
        expected = min(self.scenario.loss_rate * self.scenario.channel.num_subcarriers, float(lost.max()))
        user = int(np.flatnonzero(lost >= expected)[0])
        gains = [chain.repair(observation, repairer).gain[user] for repairer in self.repairers]
        return table_of(
            ("user", "subcarrier", "missing", "true_gain_db", *(f"{name}_gain_db" for name in self.repairers)),
            [
                (
                    user + 1, n + 1, int(observation.missing[user, n]),
                    *(float(db(gain[n])) for gain in (truth[user], *gains)),
                )
                for n in range(truth.shape[1])
            ],
        )  # fmt: skip

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(width_in=9.0, height_in=5.4)
        table = result.table
        panel = canvas.panels[0]
        holes, heard = table.where(missing=1), table.where(missing=0)
        panel.curve(
            table.numbers("subcarrier"), table.numbers("true_gain_db"), label="true channel", style=BLACK, marked=False
        )
        panel.marks(
            heard.numbers("subcarrier"), heard.numbers("true_gain_db"),
            size_pt=4, shape="o", colour="black", label="observed",
        )  # fmt: skip
        style = styles(self.repairers)
        for place, name in enumerate(self.repairers):
            explained = result.measures[f"explained_by_{name}"].value
            panel.curve(
                holes.numbers("subcarrier"), holes.numbers(f"{name}_gain_db"),
                label=f"missing, by {readable(name)} (R² {explained / 100.0:.3g})".replace("-", "−"),
                style=style[name], joined=False, dodge_pt=3.0 * (place - 1.5),
            )  # fmt: skip
        share = f"{len(holes.rows)} of {len(table.rows)}"
        user = table.values("user")[0]
        panel.describe(f"The channel of user {user}, {share} entries missing", "Subcarrier", "Power gain (dB)")
        canvas.title(
            self.scenario.caption(1),
            f"R²: share of the fading in dB that is explained, all users, {result.draws} draws",
        )
        panel.grid()
        panel.plain_ticks("x", [1, *range(5, len(table.rows) + 1, 5)])
        canvas.legend_below(panel, columns=2)
        return canvas


@dataclass(frozen=True)
class RecoveryDraw:
    """One draw: Σ (ĝ_dB − g_dB)² over the missing entries of each repairer, Σ (g_dB − ḡ_dB)², and users' spread in dB.

    The spread is that of the strongest user's mean gain to the weakest's. Shape (repairer + 2,).
    """

    scenario: Scenario
    repairers: tuple[str, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        scene, observation = self.scenario.sense(seeds)
        truth, missing = chain.perfect(scene).gain, observation.missing
        level = truth.mean(axis=1, keepdims=True)
        wanted = db(truth / level, floor_db=DEEPEST_FADE_DB)
        fading = np.square(wanted - wanted.mean(axis=1, keepdims=True))[missing].sum()
        estimates = (chain.repair(observation, name).gain for name in self.repairers)
        errors = [np.square(db(gain / level, floor_db=DEEPEST_FADE_DB) - wanted)[missing].sum() for gain in estimates]
        return np.array([*errors, fading, float(db(level.max() / level.min()))])

"""One user's channel, what was lost of it and what repair makes of that: the paper's Fig. 2."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import seeds_of
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.table import Table, table_of
from wirelessagent.model.units import db
from wirelessagent.pictures.canvas import Canvas

_BLACK = 6


@dataclass(frozen=True, kw_only=True)
class ChannelRecovery(Experiment):
    """The first draw's first user that lost at least its share of entries; a single draw, whatever is asked for.

    Attributes:
        scenario: the cell, channel and loss.
        repairers: the repairers compared.
    """

    name = "channel_recovery"
    summary = "One user's channel, its missing entries and their repair (the paper's Fig. 2)"

    scenario: Scenario = field(default_factory=Scenario)
    repairers: tuple[str, ...] = ("user_mean", "nncf", "nncf_paper")

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Result:
        del draws, executor
        scene, observation = self.scenario.sense(seeds_of(seed, 0))
        truth = chain.perfect(scene).gain
        lost = observation.missing.sum(axis=1)
        expected = min(self.scenario.loss_rate * self.scenario.channel.num_subcarriers, float(lost.max()))
        user = int(np.flatnonzero(lost >= expected)[0])
        gains = [chain.repair(observation, repairer).gain[user] for repairer in self.repairers]
        table = table_of(
            ("subcarrier", "missing", "true_gain_db", *(f"{name}_gain_db" for name in self.repairers)),
            [
                (n + 1, int(observation.missing[user, n]), *(float(db(gain[n])) for gain in (truth[user], *gains)))
                for n in range(truth.shape[1])
            ],
        )
        if progress is not None:
            progress(1, 1)
        findings = {"user_number": user + 1, "missing_entries": int(lost[user]), "rmse_db": self._rmse_db(table)}
        return Result(table=table, findings=findings, draws=1)

    def _rmse_db(self, table: Table) -> dict[str, float]:
        """Root-mean-square error over this user's missing entries, in dB."""
        holes = table.where(missing=1)
        true_db = holes.numbers("true_gain_db")
        return {
            name: float(np.sqrt(np.mean(np.square(holes.numbers(f"{name}_gain_db") - true_db))))
            for name in self.repairers
        }

    def picture(self, result: Result) -> Canvas:
        canvas = Canvas(width_in=8.4, height_in=4.8)
        table = result.table
        panel = canvas.panels[0]
        holes = table.where(missing=1)
        panel.curve(
            table.numbers("subcarrier"), table.numbers("true_gain_db"), label="true channel", style=_BLACK, marked=False
        )
        heard = table.where(missing=0)
        panel.marks(
            heard.numbers("subcarrier"), heard.numbers("true_gain_db"),
            size_pt=4, shape="o", colour="black", label="observed",
        )  # fmt: skip
        for style, column in enumerate(table.columns[3:]):
            panel.curve(
                holes.numbers("subcarrier"), holes.numbers(column),
                label=f"missing, by {column.removesuffix('_gain_db')}", style=style, joined=False,
            )  # fmt: skip
        share = f"{len(holes.rows)} of {len(table.rows)}"
        user = result.findings["user_number"]
        panel.describe(f"The channel of user {user}, {share} entries missing", "Subcarrier", "Power gain (dB)")
        canvas.title(self.scenario.caption(result.draws))
        panel.grid()
        panel.plain_ticks("x", [1, *range(5, len(table.rows) + 1, 5)])
        panel.legend()
        return canvas

"""The error of every repairer against the delay spread: where the paper's 67 % holds, and where it does not.

The paper says that its repair cuts the error by "approximately up to 67 %" without a delay spread. The more the
channel varies over the band, the less a neighbour says; so the claim belongs to a delay spread, found here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from wirelessagent.experiments.error_sweep import BASELINE, ErrorSweep
from wirelessagent.experiments.experiment import Result
from wirelessagent.experiments.scenario import Scenario
from wirelessagent.experiments.statistics import last_crossing
from wirelessagent.experiments.table import Table
from wirelessagent.pictures.canvas import Canvas

CLAIMED_CUT = 0.67
"""The paper's figure, from its abstract."""


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

    def findings(self, table: Table) -> dict[str, Any]:
        spreads = table.where(repairer=BASELINE).numbers(self.axis)
        reached = {
            str(repairer): last_crossing(spreads, table.where(repairer=repairer).numbers("cut"), CLAIMED_CUT)
            for repairer in table.values("repairer")
            if repairer != BASELINE
        }
        return {**super().findings(table), f"cut_of_{CLAIMED_CUT:.0%}_holds_up_to_ns": reached}

    def picture(self, result: Result) -> Canvas:
        canvas = super().picture(result)
        baseline = result.table.where(repairer=BASELINE)
        relative = canvas.panels[0]
        relative.guide(
            baseline.numbers(self.axis),
            (1.0 - CLAIMED_CUT) * baseline.numbers("rmse_per_mean_gain"),
            label=f"{BASELINE} less {CLAIMED_CUT:.0%}",
        )
        relative.legend()
        return canvas

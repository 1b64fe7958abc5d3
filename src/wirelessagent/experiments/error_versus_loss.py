"""The error of every repairer against the share of entries that is lost."""

from __future__ import annotations

from dataclasses import dataclass

from wirelessagent.experiments.error_sweep import ErrorSweep
from wirelessagent.experiments.scenario import Scenario


@dataclass(frozen=True, kw_only=True)
class ErrorVersusLoss(ErrorSweep):
    """Repair error from 5 % to 80 % random loss, at the scenario's delay spread."""

    name = "error_versus_loss"
    summary = "Repair error against the loss rate, for every registered repairer"
    axis = "loss_percent"
    axis_label = "Random loss (%)"
    varied = "loss"
    axis_ticks = (0.0, 20.0, 40.0, 60.0, 80.0)

    loss_percents: tuple[float, ...] = (5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0)

    def points(self) -> dict[float, Scenario]:
        return {percent: self.scenario.with_loss(percent / 100.0) for percent in self.loss_percents}

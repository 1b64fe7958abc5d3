"""A simulated base station: the decision meets the true channel."""

from __future__ import annotations

from dataclasses import dataclass, field

from wirelessagent.acting.base_station import BaseStation, check_applicable
from wirelessagent.model.arrays import positive
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import link_metrics
from wirelessagent.model.outcome import Outcome


@dataclass(frozen=True)
class SimulatedBaseStation(BaseStation):
    """Applies a decision to the scene's true channel and reads back rates, misses and power.

    Attributes:
        power_resolution_w: the finest step of the power on a subcarrier; 0 for any power.
    """

    name = "simulated"

    power_resolution_w: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        positive("power_resolution_w", self.power_resolution_w, zero=True)

    def apply(self, decision: Decision) -> Outcome:
        if self.scene is None:
            raise InputError("a simulated base station needs a scene: SimulatedBaseStation(scene)")
        truth = self.scene.current_truth
        if truth is None:
            raise InputError(
                "the true channel of this scene is not known, so nothing can be simulated on it; "
                "use the base station 'file', or a complete gain matrix"
            )
        if truth.shape != (decision.rate_bps.size, decision.owner.size):
            raise InputError(
                f"the decision is for {decision.rate_bps.size} users and {decision.owner.size} subcarriers, "
                f"the scene has {truth.shape[0]} and {truth.shape[1]}"
            )
        check_applicable(decision, self.scene.cell)
        told = self.read_back(decision)
        achieved = link_metrics(
            truth,
            decision.owner,
            told.power_w,
            self.scene.cell,
            committed_bps=decision.committed_bps,
            slack_bps=told.slack_bps,
        )
        return self.read_back(decision, achieved=achieved, true_gain=truth)

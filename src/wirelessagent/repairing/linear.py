"""Linear interpolation over frequency: the simplest repair that a short delay spread allows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import frequency
from wirelessagent.repairing.core.calibration import calibrated
from wirelessagent.repairing.core.levels import user_levels
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class Linear(Repairer):
    """Linear interpolation of the gain between the nearest observed subcarriers, the nearest value at the edges.

    Uses the subcarriers' frequencies where they are known. The expected squared error is that of the best average of
    the same neighbours (:mod:`wirelessagent.repairing.core.frequency`) plus the squared difference from it, scaled to
    the errors on observed entries left out. Users without any observation in this slot: see
    :mod:`wirelessagent.repairing.core.levels`.
    """

    name: ClassVar[str] = "linear"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        levels = user_levels(observation)
        predicted = frequency.interpolate(levels, observation)
        best = frequency.predict(levels, observation)
        expected = best.expected + (predicted - best.predicted) ** 2
        squared_error = (levels.relative - predicted) ** 2
        variance = calibrated(
            expected, squared_error, levels.compared, noise=levels.noise, ceiling=levels.relative_variance
        )
        gain, gain_variance = levels.completing(predicted, variance)
        return ChannelEstimate.completing(observation, gain=gain, gain_variance=gain_variance, method=self.name)

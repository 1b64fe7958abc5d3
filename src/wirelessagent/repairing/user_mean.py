"""The paper's traditional baseline: a missing gain is the user's mean gain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.levels import user_levels
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class UserMean(Repairer):
    """Mean imputation: ĝ_kn = mean of the user's observed gains (Sec. IV-B of the paper, "traditional").

    The variance is the one that the observed gains show around their mean, shrunk towards the exponential
    distribution's (the mean squared) where a user has few. Users without any observation: see
    :mod:`wirelessagent.repairing.core.levels`.
    """

    name: ClassVar[str] = "user_mean"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        levels = user_levels(observation)
        shape = observation.current.shape
        return ChannelEstimate.completing(
            observation,
            gain=np.broadcast_to(levels.level[:, np.newaxis], shape),
            gain_variance=np.broadcast_to(levels.variance[:, np.newaxis], shape),
            method=self.name,
        )

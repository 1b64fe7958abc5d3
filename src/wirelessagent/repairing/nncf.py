"""Nearest-neighbour collaborative filtering, done right: relative gains, weights from the correlation seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import frequency, users
from wirelessagent.repairing.core.calibration import calibrated
from wirelessagent.repairing.core.levels import UserLevels, user_levels
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class Nncf(Repairer):
    """The paper's idea (Sec. III-A) with three departures.

    - Gains are compared relative to each user's mean: with a path-loss spread of 30 dB, absolute gains of another
      user say nothing about one's own.
    - The weights are not constants but follow from the correlation that the observed entries show, over frequency
      (:mod:`wirelessagent.repairing.core.frequency`) and between users (:mod:`wirelessagent.repairing.core.users`).
      Independent users, the usual case, get no weight; the user's mean gets what the neighbours leave.
    - The nearest known neighbours are used at whatever distance they are, so one pass fills everything and no
      estimate rests on another.

    With û_kn the average over frequency, v_kn its expected squared error and t_kn the average of the other users'
    surprises (g_jn/ḡ_j − û_jn)/√v_jn, the estimate is ĝ_kn = ḡ_k · (û_kn + √v_kn t_kn), never below the lesser of û_kn
    and the smallest relative gain seen of that user. The variance is scaled to the errors on observed entries left
    out. Users without any observation in this slot: see :mod:`wirelessagent.repairing.core.levels`.
    """

    name: ClassVar[str] = "nncf"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        levels = user_levels(observation)
        over_frequency, expected = frequency.predict(levels, observation)
        predicted, expected = _with_users(levels, over_frequency, expected)
        squared_error = (levels.relative - predicted) ** 2 - levels.noise
        variance = calibrated(expected, squared_error, levels.compared, ceiling=levels.relative_variance)
        gain, gain_variance = levels.completing(predicted, variance)
        return ChannelEstimate.completing(observation, gain=gain, gain_variance=gain_variance, method=self.name)


def _with_users(levels: UserLevels, predicted: FloatArray, expected: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The prediction over frequency moved by what the correlated users show on the same subcarrier."""
    deviation = np.sqrt(expected)
    surprise = (levels.relative - predicted) / deviation
    correlation = users.correlation_beyond_chance(surprise, levels.compared)
    if not correlation.any():
        return predicted, expected
    expected_surprise, explained = users.averaged(surprise, levels.compared, correlation)
    smallest = np.where(levels.known & (levels.relative > 0), levels.relative, np.inf).min(axis=1, keepdims=True)
    moved = np.maximum(predicted + deviation * expected_surprise, np.minimum(predicted, smallest))
    return moved, expected * (1.0 - explained)

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

LARGEST_SURPRISE = 5.0
"""Deviations from the prediction, in standard deviations, beyond which an entry counts no more for the correlation."""


@dataclass(frozen=True, kw_only=True)
class Nncf(Repairer):
    """Average of the nearest known neighbours, weighted by the correlation that the observed entries show.

    It is the paper's idea (Sec. III-A) with three departures:

    - Gains are compared relative to each user's mean: with a path-loss spread of 30 dB, absolute gains of another
      user say nothing about one's own.
    - The weights are not constants but follow from the correlation that the observed entries show, over frequency
      (:mod:`wirelessagent.repairing.core.frequency`) and between users (:mod:`wirelessagent.repairing.core.users`).
      Independent users, the usual case, get no weight; the user's mean gets what the neighbours leave.
    - The nearest known neighbours are used at whatever distance they are, so one pass fills everything and no
      estimate rests on another.

    The estimate is the user's level times the average over frequency, moved by what correlated users show on the same
    subcarrier. Variances are scaled to the errors on observed entries left out. Users without any observation in this
    slot: see :mod:`wirelessagent.repairing.core.levels`.
    """

    name: ClassVar[str] = "nncf"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        levels = user_levels(observation)
        over = frequency.predict(levels, observation)
        predicted, variance = over.predicted, _learnt(levels, over.predicted, over.expected)
        correlation = _between_users(levels, predicted, variance)
        if correlation.any():
            predicted, explained = users.moved(levels, over, correlation)
            variance = _learnt(levels, predicted, variance * (1.0 - explained))
        gain, gain_variance = levels.completing(predicted, variance)
        return ChannelEstimate.completing(observation, gain=gain, gain_variance=gain_variance, method=self.name)


def _learnt(levels: UserLevels, predicted: FloatArray, expected: FloatArray) -> FloatArray:
    """The expected squared errors, scaled to those of the observed entries left out."""
    squared_error = (levels.relative - predicted) ** 2
    return calibrated(expected, squared_error, levels.compared, noise=levels.noise, ceiling=levels.relative_variance)


def _between_users(levels: UserLevels, predicted: FloatArray, variance: FloatArray) -> FloatArray:
    """The correlation between users that their surprises show, shape (user, user).

    No surprise counts for more than ``LARGEST_SURPRISE``, since gains have heavy tails.
    """
    deviation = np.where(levels.compared, np.sqrt(variance + levels.noise), 1.0)
    surprise = np.clip((levels.relative - predicted) / deviation, -LARGEST_SURPRISE, LARGEST_SURPRISE)
    return users.correlation_beyond_chance(surprise, levels.compared)

"""The paper's channel repair to the letter, kept as a baseline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, positive
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.calibration import calibrated
from wirelessagent.repairing.core.levels import SMALLEST_VARIANCE, UserLevels, user_levels
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class NncfPaper(Repairer):
    """Weighted average of the four neighbours in absolute gain (Sec. III-A, the equation of ĝ_kn).

        ĝ_kn = Σ w_ij g_ij / Σ w_ij over the known (i, j) among (k, n ± 1), (k ± 1, n)

    In sweeps until full: what one sweep fills is known to the next (the paper says only that the algorithm cycles).
    The result depends on the order of the users, and where path loss spreads them its error is far larger than that
    of the user's mean: use :class:`wirelessagent.repairing.nncf.Nncf`. The paper gives no variance. Here it is the
    squared error of such an average of independent entries of the users' levels, scaled to the errors on observed
    entries left out. Entries that no weight reaches get the user's level.

    Attributes:
        frequency_weight: weight w of the neighbours (k, n ± 1).
        user_weight: weight w of the neighbours (k ± 1, n).
    """

    name: ClassVar[str] = "nncf_paper"

    frequency_weight: float = 2.0
    user_weight: float = 1.0

    def __post_init__(self) -> None:
        if not positive("frequency_weight", self.frequency_weight, zero=True) + positive(
            "user_weight", self.user_weight, zero=True
        ):
            raise InputError("frequency_weight and user_weight are both 0; give at least one neighbour a weight")

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        from wirelessagent.repairing import nncf_paper_kernel

        levels = user_levels(observation)
        level = levels.level[:, np.newaxis]
        current, seen = observation.current, ~observation.missing
        value, mean, spread, reached = nncf_paper_kernel.sweep_until_full(
            current, seen, levels.level, float(self.frequency_weight), float(self.user_weight)
        )
        gain = np.where(reached, value, level)
        error = np.where(seen, current, 0.0) - value
        expected = (mean - level) ** 2 + spread + level**2
        variance = _scaled(levels, expected, error**2, seen & reached)
        from_level = level * (level * (levels.doubt[:, np.newaxis] - 1.0))
        variance = np.maximum(np.maximum(variance, from_level), SMALLEST_VARIANCE)
        guessed = ~reached | ~seen.any(axis=1, keepdims=True)
        around_level = levels.variance[:, np.newaxis] + (gain - level) ** 2
        return ChannelEstimate.completing(
            observation, gain=gain, gain_variance=np.where(guessed, around_level, variance), method=self.name
        )


def _scaled(levels: UserLevels, expected: FloatArray, squared_error: FloatArray, known: BoolArray) -> FloatArray:
    """The expected squared errors, calibrated in units of each user's level."""
    scale = levels.level[:, np.newaxis]
    return scale * (scale * calibrated(expected / scale / scale, squared_error / scale / scale, known))

"""Neighbours in frequency, with weights from the correlation over frequency that the observed entries show."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.levels import UserLevels

COHERENCES = np.geomspace(0.25, 1000.0, 16)
"""Candidate coherence widths in subcarriers: from no correlation at all to a flat channel."""

OTHERS = 0.2
"""What another user's evidence of the coherence counts beside one's own: delay spreads are alike, not equal."""


def predict(levels: UserLevels, observation: ChannelObservation) -> tuple[FloatArray, FloatArray]:
    """Relative gain of every entry from known neighbours other than itself, and the expected squared error.

    Shapes (user, subcarrier). The coherence of each user is the candidate under which its observed entries, each left
    out and predicted from the others, are most likely; the other users' evidence is added at a reduced weight.
    """
    from wirelessagent.repairing.core import frequency_kernel

    position = _positions(observation)
    misfit = frequency_kernel.misfit(levels.relative, levels.known, position, COHERENCES)
    evidence = misfit + OTHERS * (misfit.sum(axis=0) - misfit)
    coherence = COHERENCES[np.argmin(evidence, axis=1)]
    return frequency_kernel.predict(levels.relative, levels.known, position, coherence)


def interpolate(levels: UserLevels, observation: ChannelObservation) -> FloatArray:
    """Relative gain of every entry by linear interpolation between the known neighbours other than itself."""
    from wirelessagent.repairing.core import frequency_kernel

    return frequency_kernel.interpolate(levels.relative, levels.known, _positions(observation))


def _positions(observation: ChannelObservation) -> FloatArray:
    """Subcarrier positions in units of the median spacing, from the frequencies where these are known."""
    frequencies = observation.subcarrier_frequencies_hz
    if frequencies is None or frequencies.size == 1:
        return np.arange(observation.num_subcarriers, dtype=np.float64)
    return (frequencies - frequencies[0]) / np.median(np.diff(frequencies))

"""Neighbours in frequency, with weights from the correlation over frequency that the observed entries show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.levels import UserLevels

COHERENCES = np.geomspace(0.25, 1000.0, 16)
"""Candidate coherence widths in subcarriers: from no correlation at all to a flat channel."""

OTHERS = 0.2
"""What another user's evidence of the coherence counts beside one's own: delay spreads are alike, not equal."""


@dataclass(frozen=True, kw_only=True)
class OverFrequency:
    """Every entry predicted from known neighbours other than itself.

    Attributes:
        predicted: relative gain, shape (user, subcarrier).
        expected: its expected squared error, shape (user, subcarrier).
        position: subcarrier positions in units of the spacing, shape (subcarrier,).
        coherence: coherence width of each user in the same unit, shape (user,).
    """

    predicted: FloatArray
    expected: FloatArray
    position: FloatArray
    coherence: FloatArray


def predict(levels: UserLevels, observation: ChannelObservation) -> OverFrequency:
    """The prediction of every entry with weights from the correlation seen.

    The coherence of each user is the candidate under which its observed entries, each left out and predicted from the
    others, are most likely; the other users' evidence is added at a reduced weight.
    """
    from wirelessagent.repairing.core import frequency_kernel

    position = _positions(observation)
    entries = (levels.relative, levels.known, levels.noise, position)
    misfit = frequency_kernel.misfit(*entries, COHERENCES)
    evidence = misfit + OTHERS * (misfit.sum(axis=0) - misfit)
    coherence = COHERENCES[np.argmin(evidence, axis=1)]
    predicted, expected = frequency_kernel.predict(*entries, coherence)
    return OverFrequency(predicted=predicted, expected=expected, position=position, coherence=coherence)


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

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


EVIDENCE = 0.5
"""What a left-out entry counts as evidence: each pair of neighbours is compared twice, once from either side."""

NOMINAL_DELAY_SPREAD_S = 100e-9
"""Rms delay spread expected before anything is seen: the nominal one of 3GPP TR 38.901, table 7.7.3-1."""

NOMINAL_FACTOR = 3.3
"""Standard deviation of what is expected, as a factor: 95 % lie between 10 ns and 1 µs."""

NOMINAL_SPACING_HZ = 180e3
"""Subcarrier spacing where no frequencies are known: a resource block of twelve times 15 kHz."""

LEAST_SHARE = 1e-3
"""Candidates less likely than this beside the likeliest are left out."""


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

    The coherence of each user is uncertain. A candidate counts by how likely it makes the user's observed entries,
    each left out and predicted from the others (the other users' evidence is added at a reduced weight), times how
    likely it is beforehand: log-normal about the coherence 1/(2πτ) of a nominal delay spread τ. So few reports, or
    equal ones, prove no flat channel. Prediction and expected error are those of the mixture, ``coherence`` is the
    likeliest.
    """
    from wirelessagent.repairing.core import frequency_kernel

    position = _positions(observation)
    entries = (levels.relative, levels.known, levels.noise, position)
    misfit = EVIDENCE * frequency_kernel.misfit(*entries, COHERENCES)
    beforehand = (np.log(COHERENCES / _nominal_coherence(observation)) / np.log(NOMINAL_FACTOR)) ** 2
    evidence = beforehand + misfit + OTHERS * (misfit.sum(axis=0) - misfit)
    share = np.exp(-0.5 * (evidence - evidence.min(axis=1, keepdims=True)))
    share[share < LEAST_SHARE] = 0.0
    share /= share.sum(axis=1, keepdims=True)
    predicted, expected = frequency_kernel.predict(*entries, COHERENCES, share)
    coherence = COHERENCES[np.argmin(evidence, axis=1)]
    return OverFrequency(predicted=predicted, expected=expected, position=position, coherence=coherence)


def interpolate(levels: UserLevels, observation: ChannelObservation) -> FloatArray:
    """Relative gain of every entry by linear interpolation between the known neighbours other than itself."""
    from wirelessagent.repairing.core import frequency_kernel

    return frequency_kernel.interpolate(levels.relative, levels.known, _positions(observation))


def _nominal_coherence(observation: ChannelObservation) -> float:
    """Coherence width 1/(2πτ) of the nominal delay spread, in units of the subcarrier spacing."""
    frequencies = observation.subcarrier_frequencies_hz
    spacing_hz = NOMINAL_SPACING_HZ
    if frequencies is not None and frequencies.size > 1:
        spacing_hz = float(np.median(np.diff(frequencies)))
    return 1.0 / (2.0 * np.pi * NOMINAL_DELAY_SPREAD_S * spacing_hz)


def _positions(observation: ChannelObservation) -> FloatArray:
    """Subcarrier positions in units of the median spacing, from the frequencies where these are known."""
    frequencies = observation.subcarrier_frequencies_hz
    if frequencies is None or frequencies.size == 1:
        return np.arange(observation.num_subcarriers, dtype=np.float64)
    return (frequencies - frequencies[0]) / np.median(np.diff(frequencies))

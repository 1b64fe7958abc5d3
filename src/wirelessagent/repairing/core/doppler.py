"""What the gain's correlation over time may be: Doppler spectra, weighed by how earlier slots explain later ones.

Scatterers all around a user that moves at v give the complex correlation J₀(2πf_dΔt) with f_d = v f_c/c (Clarke 1968),
and its gain J₀². Where power comes from few directions the spectrum is narrower; a Gaussian one of the same width,
exp(−(2πf_dΔt)²/2) for the gain, stands for those. Doppler shifts lie on a grid from what hardly changes the gain over
the whole history to what makes each slot a new channel. They are averaged over, not chosen: a wrong one is worse than
none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.observation import ChannelObservation

SHIFTS = 24
"""Doppler shifts on the grid."""
SLOWEST, FASTEST = 0.01, 0.6
"""The smallest shift times the length of the history, and the largest times the shortest step, in turns."""
UNFORESEEN = (1e-3, 1e-2, 1e-1)
"""Shares of the variance that earlier slots do not tell of: paths move, and each has a Doppler shift of its own."""
EXPECTED_TURNS, FACTOR = 0.03, 10.0
"""Doppler shift times the step that is expected beforehand, and by what factor it may well be wrong: 30 Hz at a step
of 1 ms is a user at 9 km/h in a band at 3.5 GHz."""

DECIMALS = 9
"""Of a step to which distances are told apart: most slots are equally far apart, but for rounding."""


@dataclass(frozen=True, kw_only=True)
class Doppler:
    """Correlations of the gain over time, as :class:`.hypotheses.Hypotheses` has them over frequency.

    Attributes:
        time: of each slot in units of the shortest step, the last one last, shape (slot,).
        shift: 2πf_d in turns per step times 2π, of each hypothesis, shape (hypothesis,).
        gaussian: whether the spectrum is Gaussian, shape (hypothesis,).
        unforeseen: share of the gain's variance that no earlier slot tells of, shape (hypothesis,).
        log_step, log_prior: see :class:`.hypotheses.Hypotheses`.
    """

    time: FloatArray
    shift: FloatArray
    gaussian: FloatArray
    unforeseen: FloatArray
    log_step: float
    log_prior: FloatArray

    @property
    def families(self) -> int:
        """How many kinds there are; hypotheses of one kind follow each other."""
        return self.shift.size // SHIFTS

    def correlation(self, distance: FloatArray, of: IntArray | slice = slice(None)) -> FloatArray:
        """Of gains that lie ``distance`` (any shape) steps apart, that shape and (hypothesis,), for those of ``of``."""
        from scipy.special import j0

        apart, where = np.unique(np.round(distance, DECIMALS), return_inverse=True)
        angle = np.multiply.outer(apart, self.shift[of])
        smooth = np.where(self.gaussian[of] > 0, np.exp(-0.5 * angle**2), j0(angle) ** 2)
        return np.where(angle > 0, (1.0 - self.unforeseen[of]) * smooth, 1.0)[where.reshape(distance.shape)]


def doppler(observation: ChannelObservation) -> Doppler:
    """Hypotheses for the times of an observation of two slots or more; one step each where times are unknown."""
    times = observation.slot_times_s
    if times is None:
        times = np.arange(observation.num_slots, dtype=np.float64)
    step = float(np.diff(times).min())
    time = (times - times[-1]) / step
    slowest = SLOWEST / -float(time[0])
    turns = slowest * (FASTEST / slowest) ** np.linspace(0.0, 1.0, SHIFTS)
    return Doppler(
        time=time,
        shift=np.tile(2.0 * np.pi * turns, 2 * len(UNFORESEEN)),
        gaussian=np.tile(np.repeat([0.0, 1.0], SHIFTS), len(UNFORESEEN)),
        unforeseen=np.repeat(UNFORESEEN, 2 * SHIFTS),
        log_step=float(np.log(turns[1] / turns[0])),
        log_prior=-0.5 * (np.log(turns / EXPECTED_TURNS) / np.log(FACTOR)) ** 2,
    )

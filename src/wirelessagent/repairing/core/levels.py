"""Each user's own level: the mean gain against which everything else is measured.

Path loss spreads users over 30 dB and more, so gains of different users can be compared only relative to their
levels. A user's level is the mean of its observed gains in the current slot; of a user who has none there, the mean
over its history. A user who was never observed gets a guess: the median of the other users' levels in dB, with a
variance as wide as the users' levels lie apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.calibration import calibrated

Scalar = TypeVar("Scalar", bound=np.generic)

PRIOR_LEVEL = 1e-10
"""The level where nothing positive was ever observed: −100 dB, a user some 180 m from a macro base station
(128.1 + 37.6 log10(d_km), 3GPP TR 36.942)."""

PRIOR_SPREAD = 10.0
"""Factor (10 dB) by which an unseen user's level may well lie above or below the guess, whatever the others show."""


@dataclass(frozen=True, kw_only=True)
class UserLevels:
    """Levels and what follows from them.

    Attributes:
        level: mean gain of each user, shape (user,).
        variance: variance of a missing entry's gain around the level, shape (user,).
        relative: the current slot's gain in units of the level, shape (user, subcarrier); 0 where not ``known``.
        known: observed in the current slot, of a user whose level is positive, shape (user, subcarrier).
        noise: measurement-error variance in units of the level squared, shape (user, subcarrier); 0 where unknown.
    """

    level: FloatArray
    variance: FloatArray
    relative: FloatArray
    known: BoolArray
    noise: FloatArray

    @property
    def compared(self) -> BoolArray:
        """Known entries of users with another known entry: those that can be left out and predicted."""
        return self.known & (self.known.sum(axis=1, keepdims=True) > 1)

    @property
    def relative_variance(self) -> FloatArray:
        """``variance`` in units of the level squared, shape (user,); 0 where the level is 0."""
        scale = np.where(self.level > 0, self.level, 1.0)
        return np.where(self.level > 0, self.variance / scale / scale, 0.0)

    def completing(self, relative: FloatArray, relative_variance: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gains and variances from relative ones; users unseen in this slot get their level and its variance."""
        unseen = ~self.known.any(axis=1, keepdims=True)
        level = self.level[:, np.newaxis]
        gain = np.where(unseen, level, level * relative)
        variance = np.where(unseen, self.variance[:, np.newaxis], level * (level * relative_variance))
        return gain, variance


def user_levels(observation: ChannelObservation) -> UserLevels:
    """The users' levels; where nothing positive was observed of anybody, ``PRIOR_LEVEL``."""
    slots = observation.slots
    current = ~observation.missing
    used = ~np.isnan(slots)
    used[:-1, current.any(axis=1)] = False
    entries = _by_user(np.where(used, slots, 0.0))
    count = _by_user(used).sum(axis=1)
    # Scaled by the largest gain, the mean of equal gains is exact and no sum can overflow.
    largest = entries.max(axis=1)
    scale = np.where(largest > 0, largest, 1.0)
    level = scale * ((entries / scale[:, np.newaxis]).sum(axis=1) / np.maximum(count, 1))
    variance = _variance_around(level, entries, _by_user(used))
    unseen = count == 0
    level[unseen], variance[unseen] = _guess(level[level > 0])
    known = current & (level > 0)[:, np.newaxis]
    divisor = np.where(level > 0, level, 1.0)[:, np.newaxis]
    return UserLevels(
        level=level,
        variance=variance,
        relative=np.where(known, observation.current / divisor, 0.0),
        known=known,
        noise=np.where(known, observation.current_noise_variance / divisor / divisor, 0.0),
    )


def _by_user(slots: NDArray[Scalar]) -> NDArray[Scalar]:
    """(slot, user, subcarrier) as (user, entry)."""
    return np.moveaxis(slots, 1, 0).reshape(slots.shape[1], -1)


def _variance_around(level: FloatArray, entries: FloatArray, used: BoolArray) -> FloatArray:
    """Variance of an entry around its user's mean, from leaving each one out.

    The error of the mean of the others is n/(n − 1) times the deviation from the mean of all. The expectation is 1 in
    units of the level squared: the exponential gain of Rayleigh fading.
    """
    count = used.sum(axis=1, keepdims=True)
    compared = used & (count > 1) & (level > 0)[:, np.newaxis]
    relative = entries / np.where(level > 0, level, 1.0)[:, np.newaxis]
    error = (relative - 1.0) * (count / np.maximum(count - 1, 1))
    spread = calibrated(np.ones(entries.shape), error**2, compared)[:, 0]
    return level * (level * spread)


def _guess(levels: FloatArray) -> tuple[float, float]:
    """Level and variance for a user never observed, from the positive levels L_j of the others.

    The guess m is their median in dB. If the true level is one of theirs and fading is exponential around it, the
    mean squared error is the mean of L_j² + (L_j − m)². Two pseudo-users at m · 10^±1 stand for those not yet seen.
    """
    guess = float(np.exp(np.median(np.log(levels)))) if levels.size else PRIOR_LEVEL
    possible = np.append(levels, [guess / PRIOR_SPREAD, guess * PRIOR_SPREAD])
    return guess, float(np.mean(possible**2 + (possible - guess) ** 2))

"""Each user's own level: the mean gain against which everything else is measured.

Path loss spreads users over 30 dB and more, so gains of different users can be compared only relative to their
levels. A user's level is the mean of its observed gains in the current slot; of a user who has none there, the mean
over its history. A user who was never observed gets a guess: the median of the other users' levels in dB, with a
variance as wide as the users' levels lie apart.

A level that rests on few reports may come from a fade: then the true level, and with it all errors, is many times
larger. By how much the squared errors are expected to exceed what the measured level suggests is each user's
:attr:`UserLevels.doubt`.

Reports of exactly 0 lie below what the report can express. A user of whom nothing else is seen has its gain somewhere
below the smallest positive gain known, its own in an earlier slot or else anybody's: 10 dB below it is the guess, and
its square the variance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.calibration import calibrated

Scalar = TypeVar("Scalar", bound=np.generic)

PRIOR_LEVEL = 1e-10
"""The level where nothing positive was ever observed: −100 dB, a user some 180 m from a macro base station
(128.1 + 37.6 log10(d_km), 3GPP TR 36.942)."""

PRIOR_SPREAD = 10.0
"""Factor (10 dB) by which an unseen user's level may well lie above or below the guess, whatever the others show."""


SMALLEST_VARIANCE = float(np.finfo(np.float64).tiny)
"""No guess is certain, not even one so small that its square is 0 in floating point."""

LOG_RATIOS = np.linspace(-3.0, 9.0, 61)
"""ln of the candidates for true level over measured level, from −13 to 39 dB."""


@dataclass(frozen=True, kw_only=True)
class UserLevels:
    """Levels and what follows from them.

    Attributes:
        level: mean gain of each user, shape (user,).
        variance: variance of a missing entry's gain around the level, shape (user,).
        doubt: factor of all squared errors that the uncertainty of the level brings about, part of ``variance``,
            shape (user,).
        relative: the current slot's gain in units of the level, shape (user, subcarrier); 0 where not ``known``.
        known: observed in the current slot, of a user whose level is positive, shape (user, subcarrier).
        noise: measurement-error variance in units of the level squared, shape (user, subcarrier); 0 where unknown.
    """

    level: FloatArray
    variance: FloatArray
    doubt: FloatArray
    relative: FloatArray
    known: BoolArray
    noise: FloatArray

    @property
    def compared(self) -> BoolArray:
        """Known entries of users with another known entry: those that can be left out and predicted."""
        return self.known & (self.known.sum(axis=1, keepdims=True) > 1)

    @property
    def relative_variance(self) -> FloatArray:
        """``variance`` without doubt of the level, in units of the level squared, shape (user,)."""
        return self.variance / self.doubt / self.level / self.level

    def completing(self, relative: FloatArray, relative_variance: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gains and variances from relative ones without doubt; users unseen now get their level and its variance."""
        unseen = ~self.known.any(axis=1, keepdims=True)
        level = self.level[:, np.newaxis]
        gain = np.where(unseen, level, level * relative)
        variance = np.where(
            unseen, self.variance[:, np.newaxis], level * (level * relative_variance * self.doubt[:, np.newaxis])
        )
        return gain, np.maximum(variance, SMALLEST_VARIANCE)


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
    doubt = _doubt(level, count)
    variance *= doubt
    unseen, dark = count == 0, (count > 0) & (level == 0)
    known = current & (level > 0)[:, np.newaxis]
    positive = level > 0
    level[dark], variance[dark] = _below_floor(slots[:, dark], slots)
    level[unseen], variance[unseen] = _guess(level[positive if positive.any() else dark])
    divisor = level[:, np.newaxis]
    return UserLevels(
        level=level,
        variance=np.maximum(variance, SMALLEST_VARIANCE),
        doubt=doubt,
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


def _doubt(level: FloatArray, count: IntArray) -> FloatArray:
    """E[2a² − 2a + 1] of the ratio a = true level / level: the mean squared error of the level as an estimate of an
    exponential gain, in units of the level squared; shape (user,), 1 where no level was measured and never less.

    Given a, the level is the mean of n independent exponential gains: likelihood a^−n exp(−n/a). Beforehand
    the true level is log-normal about the users' median, as wide as they lie apart; two pseudo-users at 10^±1 of the
    median stand for those not yet seen.
    """
    measured = level > 0
    doubt = np.ones(level.shape)
    if not measured.any():
        return doubt
    log_level, fades = np.log(level[measured])[:, np.newaxis], _fades(count[measured])[:, np.newaxis]
    middle = np.median(log_level)
    spread = np.append(log_level - middle, [-np.log(PRIOR_SPREAD), np.log(PRIOR_SPREAD)])
    prior = (log_level + LOG_RATIOS - middle) ** 2 / (2.0 * (spread**2).sum() / (spread.size - 1))
    exponent = -fades * (LOG_RATIOS + np.exp(-LOG_RATIOS)) - prior
    weight = np.exp(exponent - exponent.max(axis=1, keepdims=True))
    ratio = np.exp(LOG_RATIOS)
    error = (weight * (2.0 * ratio * (ratio - 1.0) + 1.0)).sum(axis=1) / weight.sum(axis=1)
    doubt[measured] = np.maximum(error, 1.0)
    return doubt


def _fades(count: IntArray) -> FloatArray:
    """Independent fades for which ``count`` reports stand as evidence of the level: max(1, count²/3).

    Two neighbours may well lie in one fade. The level's error over many reports, on the other hand, is already part
    of the errors on left-out entries, from which variances are learnt, and must not be counted twice.
    """
    return np.maximum(count**2 / 3.0, 1.0)


def _below_floor(dark: FloatArray, slots: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Level and variance for users of whom only zeros were reported, from the smallest positive gain of their own,
    ``dark`` of shape (slot, user, subcarrier), or else of ``slots``."""
    everybody = slots[slots > 0]
    floor = float(everybody.min()) if everybody.size else PRIOR_LEVEL
    own = np.where(dark > 0, dark, np.inf).min(axis=(0, 2), initial=np.inf)
    own = np.where(np.isfinite(own), own, floor)
    return own / PRIOR_SPREAD, own**2


def _guess(levels: FloatArray) -> tuple[float, float]:
    """Level and variance for a user never observed, from the positive levels L_j of the others.

    The guess m is their median in dB. If the true level is one of theirs and fading is exponential around it, the
    mean squared error is the mean of L_j² + (L_j − m)². Two pseudo-users at m · 10^±1 stand for those not yet seen.
    """
    guess = float(np.exp(np.median(np.log(levels)))) if levels.size else PRIOR_LEVEL
    possible = np.append(levels, [guess / PRIOR_SPREAD, guess * PRIOR_SPREAD])
    return guess, float(np.mean(possible**2 + (possible - guess) ** 2))

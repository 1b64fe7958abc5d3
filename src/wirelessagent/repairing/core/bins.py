"""A history in few bins, and which Doppler shifts explain it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.repairing.core.doppler import Doppler

GROWTH = 1.45
"""Ratio of the ages at a bin's end and its begin."""
BLOCK = 24
"""Subcarriers from which Doppler shifts are told."""
LEAST = 1e-9


def bins_of(age: FloatArray) -> IntArray:
    """The bin of each slot for its age in steps, 1 or more, the last slot's first.

    >>> bins_of(np.arange(8.0, 0.0, -1.0))
    array([4, 3, 3, 3, 2, 2, 1, 0])
    """
    result = np.empty(age.size, dtype=np.int64)
    current, begin = -1, 0.0
    for slot in np.argsort(age, kind="stable"):
        if current < 0 or age[slot] >= begin * GROWTH:
            current, begin = current + 1, float(age[slot])
        result[slot] = current
    return result


@dataclass(frozen=True, kw_only=True)
class OverTime:
    """Correlations of the bins under each hypothesis of the Doppler shift.

    Attributes:
        between: of two bins, shape (hypothesis, bin, bin).
        towards: of a bin and the slot that is asked for, shape (hypothesis, bin).
    """

    between: FloatArray
    towards: FloatArray


def over_time(candidates: Doppler, bin_of: IntArray, at: float) -> OverTime:
    """Means over the slots of the bins; ``at`` is the time asked for, in steps."""
    time = candidates.time
    member = bin_of == np.arange(int(bin_of.max()) + 1)[:, np.newaxis]
    mean: FloatArray = member / member.sum(axis=1, keepdims=True)
    pairs = candidates.correlation(np.abs(time[:, np.newaxis] - time))
    return OverTime(
        between=np.ascontiguousarray(np.einsum("bt,tsh,cs->hbc", mean, pairs, mean)),
        towards=np.ascontiguousarray((mean @ candidates.correlation(np.abs(at - time))).T),
    )


def log_evidence(
    filled: FloatArray, noise: FloatArray, over_frequency: FloatArray, between: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """ln L of each hypothesis, and the level that it says, for each user; shapes (user, hypothesis).

    On complete slots the covariance is a Kronecker product plus noise, so that two small eigenvalue problems do.

    Args:
        filled: gains without holes, in units of about the level, shape (user, slot, subcarrier).
        noise: η of each user, shape (user,).
        over_frequency: correlation of two subcarriers for each user, shape (user, subcarrier, subcarrier).
        between: of two slots, shape (hypothesis, slot, slot).
    """
    _, slots, subcarriers = filled.shape
    mode, shape = np.linalg.eigh(over_frequency)
    beat, spectrum = np.linalg.eigh(between)
    variance = np.maximum(beat, 0.0)[np.newaxis, :, :, np.newaxis] * np.maximum(mode, 0.0)[:, np.newaxis, np.newaxis]
    variance = variance + np.maximum(noise, LEAST)[:, np.newaxis, np.newaxis, np.newaxis]
    seen = np.swapaxes(spectrum, 1, 2) @ (filled @ shape)[:, np.newaxis]
    one = spectrum.sum(axis=1)[np.newaxis, :, :, np.newaxis] * shape.sum(axis=1)[:, np.newaxis, np.newaxis]
    a, b, q = (np.sum(x * y / variance, axis=(2, 3)) for x, y in ((one, one), (one, seen), (seen, seen)))
    entries = slots * subcarriers
    u = (b + np.sqrt(b * b + 4.0 * entries * q)) / (2.0 * q)
    likelihood = entries * np.log(u) - 0.5 * (q * u * u - 2.0 * b * u + a) - 0.5 * np.log(variance).sum(axis=(2, 3))
    return likelihood, 1.0 / u

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
class Binned:
    """A user's reports in bins.

    Attributes:
        mean, noise, count: mean of what was observed, variance of its noise, and how many reports it is of, 0 where
            nothing was, shape (bin, subcarrier).
        reports: how many each bin is of, shape (bin,).
        between: correlation of two bins over time under each hypothesis, shape (hypothesis, bin, bin).
        towards: of a bin and the slot that is asked for, shape (hypothesis, bin).
    """

    mean: FloatArray
    noise: FloatArray
    count: IntArray
    reports: IntArray
    between: FloatArray
    towards: FloatArray


def binned(
    gain: FloatArray, noise: FloatArray, time: FloatArray, candidates: Doppler, likely: IntArray, at: float
) -> Binned:
    """The reports of a user, shape (report, subcarrier), NaN where missing, at ``time`` (report,), in steps.

    ``likely`` are the hypotheses that count, ``at`` is the time asked for, in steps.
    """
    bin_of = bins_of(time[-1] - time + 1.0)
    member = bin_of == np.arange(int(bin_of.max()) + 1)[:, np.newaxis]
    reports = member.sum(axis=1)
    there = ~np.isnan(gain)
    count = member @ there.astype(np.int64)
    size = np.maximum(count, 1)
    over_slots: FloatArray = member / reports[:, np.newaxis]
    pairs = np.moveaxis(candidates.correlation(np.abs(time[:, np.newaxis] - time), likely), -1, 0)
    return Binned(
        mean=member @ np.where(there, gain, 0.0) / size,
        noise=member @ np.where(there, noise, 0.0) / size**2,
        count=count,
        reports=reports,
        between=np.ascontiguousarray(over_slots @ pairs @ over_slots.T),
        towards=np.ascontiguousarray((over_slots @ candidates.correlation(np.abs(at - time), likely)).T),
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

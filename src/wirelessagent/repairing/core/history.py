"""Slots of the past in units of each user's mean, with the measurement noise that they carry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import fit
from wirelessagent.repairing.core.hypotheses import Hypotheses, hypotheses

RECENT = 16
"""Reports of each user from which correlations over time are learnt, the last ones."""
LARGEST_SHARE = 0.9


@dataclass(frozen=True, kw_only=True)
class History:
    """What was seen of all users, slots without any gain left out.

    Attributes:
        gain: in units of the level, NaN where missing, shape (slot, user, subcarrier).
        noise: variance of its error in the same unit squared, 0 where unknown, same shape.
        level: mean of each user's observed gains, 1 where nothing positive was observed, shape (user,).
        seen: how many gains are known of each user, 0 where none is positive, shape (user,).
        noise_share: η of one slot, shape (user,).
        grown: 1 + η where measured gains are conditional means, 1 where the noise is unknown, shape (user,).
        place: of each slot among those of the observation, shape (slot,).
    """

    gain: FloatArray
    noise: FloatArray
    level: FloatArray
    seen: IntArray
    noise_share: FloatArray
    grown: FloatArray
    place: IntArray

    @property
    def reported(self) -> BoolArray:
        """Where a user told anything, shape (user, slot); reports get lost, and users join late."""
        return np.any(~np.isnan(self.gain), axis=2).T


def history(observation: ChannelObservation) -> History | None:
    """The slots of an observation that hold any gain; None if none does."""
    place = np.flatnonzero(~np.isnan(observation.slots).all(axis=(1, 2)))
    if not place.size:
        return None
    gain = observation.slots[place]
    there = ~np.isnan(gain)
    largest = np.where(there, gain, 0.0).max(axis=(0, 2))
    scale = np.where(largest > 0, largest, 1.0)
    count = there.sum(axis=(0, 2))
    mean = np.where(there, gain / scale[:, np.newaxis], 0.0).sum(axis=(0, 2)) / np.maximum(count, 1)
    level = np.where(largest > 0, scale * mean, 1.0)
    relative = gain / level[:, np.newaxis]
    noise, share = np.zeros(gain.shape), np.zeros(len(level))
    known = observation.noise_variance is not None
    if observation.noise_variance is not None:
        given = observation.noise_variance.reshape(observation.slots.shape)[place]
        noise = np.where(there, given / level[:, np.newaxis] / level[:, np.newaxis], 0.0)
        part = np.where(there, relative - np.sqrt(np.maximum(relative**2 - noise, 0.0)), 0.0)
        part = np.minimum(part.sum(axis=(0, 2)) / np.maximum(count, 1), LARGEST_SHARE)
        share = 1.0 / (1.0 - part) ** 2 - 1.0
    return History(
        gain=relative,
        noise=noise,
        level=level,
        seen=np.where(largest > 0, count, 0),
        noise_share=share,
        grown=1.0 + share if known else np.ones(len(level)),
        place=place,
    )


@dataclass(frozen=True, kw_only=True)
class OverFrequency:
    """What each user's last reports say of the correlation over frequency, and those reports without holes.

    Attributes:
        candidates: where subcarriers are on a raster.
        table: each user's |ρ|² at each distance, shape (user, distance).
        noise_share: η of each user, shape (user,).
        filled: the last slots, holes estimated over frequency, shape (user, slot, subcarrier). NaN where a report was
            lost, lies too far back or holds no positive gain: nothing was told, and nothing may be learnt.
    """

    candidates: Hypotheses
    table: FloatArray
    noise_share: FloatArray
    filled: FloatArray

    @property
    def told(self) -> BoolArray:
        """Which users' reports ``filled`` holds, shape (user, slot)."""
        return ~np.isnan(self.filled[..., 0])


def over_frequency(seen: History, observation: ChannelObservation, *, most: int = RECENT) -> OverFrequency:
    """Kriging on each user's last reports, ``most`` of them, each user's correlation the mean over them."""
    known_noise = observation.noise_variance is not None
    reported = seen.reported & (seen.reported[:, ::-1].cumsum(axis=1)[:, ::-1] <= most)
    first = int(np.argmax(reported.any(axis=0)))
    reported = reported[:, first:]
    gain, noise = (entries[first:].swapaxes(0, 1)[reported] for entries in (seen.gain, seen.noise))
    rows = ChannelObservation(
        gain=gain,
        noise_variance=np.where(np.isnan(gain), np.nan, noise) if known_noise else None,
        subcarrier_frequencies_hz=observation.subcarrier_frequencies_hz,
    )
    slot = fit.relative(rows)
    learnt = fit.learn(slot, hypotheses(rows))
    estimated = fit.estimate(slot, learnt, tested=False)[..., 0] * slot.level[:, np.newaxis]
    filled = np.full((*reported.shape, rows.num_subcarriers), np.nan)
    filled[reported] = np.where((slot.seen > 0)[:, np.newaxis], np.where(slot.known, gain, estimated), np.nan)
    whose = np.nonzero(reported)[0] == np.arange(len(reported))[:, np.newaxis]
    share = whose & (slot.seen > 0)
    share = share / np.maximum(share.sum(axis=1, keepdims=True), 1)
    of_row, noise_share, _ = fit.mean_hypothesis(slot, learnt)
    table = share @ of_row
    table[table[:, 0] == 0.0] = table[table[:, 0] > 0.0].mean(axis=0) if (table[:, 0] > 0.0).any() else 1.0
    return OverFrequency(
        candidates=learnt.candidates,
        table=table,
        noise_share=seen.noise_share if known_noise else share @ noise_share,
        filled=filled,
    )

"""Correlation over frequency learned from earlier slots, where the profile is of no known kind.

The mean product of deviations from the level at each distance, over slots that are far enough apart to be new channels,
estimates |ρ|² without a model. Few slots say little, so it is blended with the model's, its own and all users' at
once, and the blends are weighed by how likely they make slots that were not learned from. Negative power is cut from
its spectrum, so that it stays a correlation.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.repairing.core.history import History, OverFrequency

BLENDS = (0.3, 0.6, 0.9)
"""Shares of what is learned beside the model."""
NEW = 0.3
"""Correlation of two slots below which they count as new channels."""
LEAST_SLOTS = 6
"""New channels without which nothing is learned."""
BLOCK, MOST_WEIGHED = 24, 8
"""Subcarriers and slots on which blends are weighed."""
ALIKE = 0.5
"""What the mean over all users counts in the weight of a user's blends: users are alike, not equal."""
SHARE = 0.5
"""Of its value a Gaussian log-likelihood of gains counts; see :mod:`.evidence_kernel`."""
JITTER = 1e-6


def deviations(filled: FloatArray) -> tuple[FloatArray, BoolArray]:
    """From each user's level, in its units, 0 where nothing was reported, and where something was, (user, slot)."""
    told = ~np.isnan(filled[..., 0])
    gain = np.where(told[..., np.newaxis], filled, 0.0)
    reports = np.maximum(told.sum(axis=1), 1)[:, np.newaxis, np.newaxis]
    level = gain.mean(axis=2, keepdims=True).sum(axis=1, keepdims=True) / reports
    return np.where(told[..., np.newaxis], gain / np.where(level > 0, level, 1.0) - 1.0, 0.0), told


def new_channels(filled: FloatArray) -> IntArray:
    """Slots, from the last one backwards, each hardly correlated with the one before; ``filled`` (user, slot, …).

    Each user who reported in a slot is compared with its own report before, in the last slot chosen that has one.
    """
    deviation, told = deviations(filled)
    before = np.full(len(told), -1)
    chosen: list[int] = []
    for slot in range(filled.shape[1] - 1, -1, -1):
        who = np.flatnonzero(told[:, slot] & (before >= 0))
        one, other = deviation[who, slot], deviation[who, before[who]]
        if float((one * other).sum()) <= NEW * float(np.sqrt((one**2).sum() * (other**2).sum())):
            chosen.append(slot)
            before[told[:, slot]] = slot
    return np.array(chosen)


def is_new_each_slot(over: OverFrequency) -> bool:
    """Whether more than half of the slots that anybody reported in are new channels."""
    return 2 * new_channels(over.filled).size > int(over.told.any(axis=0).sum())


def empirical(filled: FloatArray, noise: FloatArray, place: IntArray) -> tuple[FloatArray, IntArray]:
    """Correlation at each distance on the raster for each user, (user, distance), and of how many slots, (user,).

    ``filled`` (user, slot, subcarrier) is in units of about the level, NaN where nothing was reported, ``noise``
    (user,) the variance of its error. Distances that no two subcarriers have are interpolated.
    """
    users, _, subcarriers = filled.shape
    deviation, told = deviations(filled)
    reports = told.sum(axis=1)
    product = np.einsum("ksm,ksn->kmn", deviation, deviation) / np.maximum(reports, 1)[:, np.newaxis, np.newaxis]
    product -= noise[:, np.newaxis, np.newaxis] * np.eye(subcarriers)
    distance = np.abs(place[:, np.newaxis] - place)
    width = int(distance.max()) + 1
    count = np.bincount(distance.ravel(), minlength=width)
    table = np.empty((users, width))
    for k in range(users):
        total = np.bincount(distance.ravel(), weights=product[k].ravel(), minlength=width)
        table[k] = np.interp(np.arange(width), np.flatnonzero(count), (total / np.maximum(count, 1))[count > 0])
    return positive_definite(table), reports


def positive_definite(table: FloatArray) -> FloatArray:
    """The nearest correlation whose spectrum has no negative power, (…, distance), 1 at distance 0."""
    width = table.shape[-1]
    around = np.concatenate([table, table[..., -2:0:-1]], axis=-1) if width > 1 else table
    spectrum = np.maximum(np.fft.rfft(around, axis=-1).real, 0.0)
    cut = np.fft.irfft(spectrum, n=around.shape[-1], axis=-1)[..., :width]
    return cut / np.maximum(cut[..., :1], 1e-12)


def refined(over: OverFrequency, seen: History) -> OverFrequency:
    """The same with what the reports show of the correlation, where enough slots are new channels.

    The last slot, which is to be repaired, is not learned from. One half of the others is weighed on by what the other
    half shows.
    """
    new = new_channels(over.filled)[1:]
    if new.size < LEAST_SLOTS:
        return over
    halves = new[::2], new[1::2]
    with_holes = seen.gain[-over.filled.shape[1] :].swapaxes(0, 1)
    tables = [
        blended(over, over.filled[:, learnt], with_holes[:, weighed[:MOST_WEIGHED]])
        for learnt, weighed in (halves, halves[::-1])
    ]
    return dataclasses.replace(over, table=np.mean(tables, axis=0))


def blended(over: OverFrequency, filled: FloatArray, held_out: FloatArray) -> FloatArray:
    """The model's correlation with what ``filled`` slots show, weighed on slots ``held_out``; (user, distance).

    Both are of shape (user, slot, subcarrier), held-out ones NaN where missing.
    """
    place = over.candidates.place
    own, reports = empirical(filled, over.noise_share, place)
    if not reports.any():
        return over.table
    everybody = np.broadcast_to(np.average(own, axis=0, weights=reports), own.shape)
    own = np.where(reports[:, np.newaxis] > 0, own, everybody)
    shown = [(share, table) for share in BLENDS for table in (own, everybody)]
    tables = np.array([over.table, *((1.0 - share) * over.table + share * table for share, table in shown)])
    likelihood = np.array(
        [
            [log_likelihood(*user, place) for user in zip(table, over.noise_share, held_out, strict=True)]
            for table in tables
        ]
    )
    total = ALIKE * likelihood.mean(axis=1, keepdims=True) + (1.0 - ALIKE) * likelihood
    weight = np.exp(total - total.max(axis=0))
    return np.einsum("ck,ckd->kd", weight / weight.sum(axis=0), tables)


def log_likelihood(table: FloatArray, noise: float, slots: FloatArray, place: IntArray) -> float:
    """Gaussian ln L of a user's slots (slot, subcarrier), each of unknown level, counted as much as in kriging."""
    total = 0.0
    for row in slots[:, :BLOCK]:
        known = np.flatnonzero(~np.isnan(row))
        if known.size < 2:
            continue
        at = place[known]
        matrix: FloatArray = table[np.abs(at[:, np.newaxis] - at)] + (noise + JITTER) * np.eye(known.size)
        side = np.stack([np.ones(known.size), row[known]], axis=1)
        sign, log_determinant = np.linalg.slogdet(matrix)
        if sign <= 0:
            return -np.inf
        forms = side.T @ np.linalg.solve(matrix, side)
        a, b, q = float(forms[0, 0]), float(forms[0, 1]), float(forms[1, 1])
        u = (b + np.sqrt(b * b + 4.0 * known.size * q)) / (2.0 * q)
        total += known.size * np.log(u) - 0.5 * (q * u * u - 2.0 * b * u + a + log_determinant)
    return SHARE * total

"""How wrong repaired gains are: relative to each user's own level, and in dB."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import db

DEEPEST_FADE_DB = -30.0
"""Gains further below their user's mean count as this far below in the dB error, or a single null would rule it."""


def comparable_repairers() -> tuple[str, ...]:
    """Every registered repairer that can be made without options, the paper's baseline first."""
    found = [one.name for one in plugins.plugins("repairer") if one.cls and not any(o.required for o in one.options)]
    return tuple(sorted(found, key=lambda name: (name != "user_mean", name)))


def squared_errors(scene: Scene, observation: ChannelObservation, repairers: Sequence[str]) -> FloatArray:
    """Sums over the missing entries of one matrix, shape (repairer, 4).

    The first is Σ ((ĝ − g)/ḡ)² with ḡ the mean of the user's true gains, the second Σ (ĝ_dB − g_dB)² in dB², both of
    them floored at ``DEEPEST_FADE_DB`` below ḡ, the third Σ (ĝ − g)², the last the number of missing entries.
    """
    truth = chain.perfect(scene).gain
    missing = observation.missing
    level = np.broadcast_to(truth.mean(axis=1, keepdims=True), truth.shape)[missing]
    wanted = truth[missing] / level
    sums = np.empty((len(repairers), 4))
    for row, repairer in zip(sums, repairers, strict=True):
        found = chain.repair(observation, repairer).gain[missing] / level
        error_db = db(found, floor_db=DEEPEST_FADE_DB) - db(wanted, floor_db=DEEPEST_FADE_DB)
        absolute = np.square((found - wanted) * level).sum()
        row[:] = np.square(found - wanted).sum(), np.square(error_db).sum(), absolute, missing.sum()
    return sums

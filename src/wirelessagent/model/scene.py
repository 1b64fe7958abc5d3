"""A cell in a moment of time: what is sensed of its channel and, in a simulation, the truth behind it."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, float_array
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.observation import ChannelObservation, check_gain


class Loss(Protocol):
    """A pattern of missing entries."""

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        """True where an entry of ``gain`` (slot, user, subcarrier) gets lost, same shape."""
        ...


@dataclass(frozen=True, kw_only=True)
class Scene:
    """What a channel source delivers.

    Attributes:
        cell: the cell, with what the source knows of it (a file may state its bandwidth and noise).
        sensed: the measured gains before anything is lost on the way.
        truth: the true gain, shape as ``sensed.gain``, NaN nowhere; None where it is not known.
        facts: what the source understood or drew, as (label, text), to be shown to the user.
    """

    cell: Cell
    sensed: ChannelObservation
    truth: FloatArray | None = None
    facts: Mapping[str, str] = field(default_factory=dict[str, str])

    def __post_init__(self) -> None:
        if self.truth is None:
            return
        truth = float_array("truth", self.truth)
        check_gain(truth)
        if truth.shape != self.sensed.gain.shape or np.isnan(truth).any():
            raise InputError(
                f"truth must be complete and of the observation's shape {self.sensed.gain.shape}; got {truth.shape}"
            )
        object.__setattr__(self, "truth", truth)

    @property
    def current_truth(self) -> FloatArray | None:
        """The true gain of the current (last) slot, shape (user, subcarrier)."""
        if self.truth is None or self.truth.ndim == 2:
            return self.truth
        return self.truth[-1]

    def observe(self, *losses: Loss, seed: int = 0) -> ChannelObservation:
        """What arrives at the base station when ``losses`` strike, each independently of the others."""
        slots = self.sensed.slots
        rng = np.random.default_rng(seed)
        masks = [loss.missing(slots, rng) for loss in losses]
        lost = functools.reduce(np.logical_or, masks, np.zeros(slots.shape, dtype=bool))
        lost = lost.reshape(self.sensed.gain.shape)
        noise_variance = self.sensed.noise_variance
        if noise_variance is not None:  # it grows with the gain, so that of a lost entry would tell what was lost
            noise_variance = np.where(lost, np.nan, noise_variance)
        return replace(self.sensed, gain=np.where(lost, np.nan, self.sensed.gain), noise_variance=noise_variance)

"""A cell in a moment of time: what is sensed of its channel and, in a simulation, the truth behind it."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, float_array
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.gain_views import entries, gains_picture, level
from wirelessagent.model.observation import ChannelObservation, check_gain
from wirelessagent.model.shown import Picture, Shown, Summary
from wirelessagent.model.units import human


class Loss(Protocol):
    """A pattern of missing entries."""

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        """True where an entry of ``gain`` (slot, user, subcarrier) gets lost, same shape."""
        ...


@dataclass(frozen=True, kw_only=True, repr=False)
class Scene(Shown):
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

    def summary(self) -> Summary:
        sensed, cell = self.sensed, self.cell
        known = "not known" if self.truth is None else "known"
        slots = f", {sensed.num_slots} slots" if sensed.num_slots > 1 else ""
        radiates = f"at most {human(cell.max_power_w, 'W')}, {human(cell.subcarrier_bandwidth_hz, 'Hz')} a subcarrier"
        title = f"Scene: {sensed.num_users} users × {sensed.num_subcarriers} subcarriers{slots}"
        rows = (("cell", radiates), ("mean gain", level(sensed.current)), ("true channel", known), *self.facts.items())
        return Summary(title=title, rows=rows)

    def picture(self) -> Picture:
        truth, sensed = self.current_truth, self.sensed.current
        differs = truth is not None and not np.array_equal(truth, sensed)
        others = {"True": truth} if truth is not None and differs else {}
        title = "Sensed" if differs or truth is None else "Sensed, and true"
        return gains_picture(self.sensed.user_names, self.sensed.slots, title, others)

    def columns(self) -> Mapping[str, Any]:
        """One row for each entry."""
        sensed = self.sensed
        found: dict[str, Any] = {**entries(sensed.user_names, sensed.gain), "gain": sensed.gain.ravel()}
        return found if self.truth is None else {**found, "truth": self.truth.ravel()}

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

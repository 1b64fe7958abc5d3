"""What the base station was told about the channel: a power-gain matrix with holes, eq. (2) of the paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from wirelessagent.model.arrays import LARGEST, BoolArray, FloatArray, float_array, frozen, names, real_array, switches
from wirelessagent.model.errors import InputError
from wirelessagent.model.gain_views import entries, gains_picture, level
from wirelessagent.model.shown import Picture, Shown, Summary, few
from wirelessagent.model.units import percent
from wirelessagent.model.user_names import numbered


@dataclass(frozen=True, kw_only=True, repr=False)
class ChannelObservation(Shown):
    """Observed power gains, NaN where missing.

    Attributes:
        gain: linear power gain, float64, shape (user, subcarrier) or (slot, user, subcarrier), NaN = missing. With
            slots the last one is the current one and the others are history.
        noise_variance: variance of the true gain about each measured one, given the measurement; same shape (or a
            scalar), NaN where nothing was measured; None if unknown.
        estimated: True where the gain is no measurement but the estimate of an earlier repair, whose variance is then
            in ``noise_variance``; bool, same shape as ``gain``; None if all are measured.
        user_names: one name per user; "user 1" … by default.
        subcarrier_frequencies_hz: centre frequencies, shape (subcarrier,); None if unknown.
        slot_times_s: time of each slot, shape (slot,), increasing; None if unknown.
    """

    gain: FloatArray
    noise_variance: FloatArray | None = None
    estimated: BoolArray | None = None
    user_names: tuple[str, ...] = field(default=())
    subcarrier_frequencies_hz: FloatArray | None = None
    slot_times_s: FloatArray | None = None

    def __post_init__(self) -> None:
        gain = float_array("gain", self.gain)
        if gain.ndim not in (2, 3) or gain.size == 0:
            raise InputError(
                "gain must have shape (user, subcarrier) or (slot, user, subcarrier), none of them zero; "
                f"got shape {gain.shape}"
            )
        check_gain(gain)
        object.__setattr__(self, "gain", gain)
        if self.noise_variance is not None:
            variance = real_array("noise_variance", self.noise_variance)
            if variance.shape not in ((), gain.shape):
                raise InputError(
                    f"noise_variance must be one value or of the gain's shape {gain.shape}; got shape {variance.shape}"
                )
            variance = frozen(np.broadcast_to(variance, gain.shape))
            check_variance("noise_variance", variance, ~np.isnan(gain))
            object.__setattr__(self, "noise_variance", variance)
        if self.estimated is not None:
            object.__setattr__(self, "estimated", switches("estimated", self.estimated, gain.shape))
        called = self.user_names if len(self.user_names) else numbered(self.num_users)
        object.__setattr__(self, "user_names", names("user_names", called, self.num_users))
        self._check_axis("subcarrier_frequencies_hz", self.num_subcarriers)
        self._check_axis("slot_times_s", self.num_slots)

    def _check_axis(self, name: str, size: int) -> None:
        value: ArrayLike | None = getattr(self, name)
        if value is None:
            return
        axis = float_array(name, value)
        if axis.shape != (size,) or not np.all(np.isfinite(axis)) or np.any(np.diff(axis) <= 0):
            raise InputError(f"{name} must be {size} finite, increasing values; got shape {axis.shape}")
        object.__setattr__(self, name, axis)

    def summary(self) -> Summary:
        lost, size = int(self.missing.sum()), self.missing.size
        holes = f"{lost} of {size} gains missing ({percent(lost / size)})" if lost else "no gain missing"
        rows = [("mean gain", level(self.current)), ("users", few(self.user_names))]
        if self.num_slots > 1:
            rows.append(("slots", f"{self.num_slots}, the last is the current one"))
        if self.noise_variance is not None:
            rows.append(("measurement noise", "known"))
        if self.estimated is not None and self.estimated.any():
            rows.append(("repaired before", f"{int(self.estimated.sum())} entries"))
        title = f"ChannelObservation: {self.num_users} users × {self.num_subcarriers} subcarriers, {holes}"
        return Summary(title=title, rows=tuple(rows))

    def picture(self) -> Picture:
        lost, size = int(self.missing.sum()), self.missing.size
        return gains_picture(self.user_names, self.slots, f"Observed; missing: {lost} of {size}")

    def columns(self) -> Mapping[str, Any]:
        """One row for each entry."""
        found: dict[str, Any] = {**entries(self.user_names, self.gain), "gain": self.gain.ravel()}
        if self.noise_variance is not None:
            found["noise_variance"] = self.noise_variance.ravel()
        return found if self.estimated is None else {**found, "estimated": self.estimated.ravel()}

    @property
    def num_users(self) -> int:
        return self.gain.shape[-2]

    @property
    def num_subcarriers(self) -> int:
        return self.gain.shape[-1]

    @property
    def num_slots(self) -> int:
        return self.gain.shape[0] if self.gain.ndim == 3 else 1

    @property
    def slots(self) -> FloatArray:
        """The gain as (slot, user, subcarrier), whatever it came as."""
        return self.gain if self.gain.ndim == 3 else self.gain[np.newaxis]

    @property
    def current(self) -> FloatArray:
        """The current slot's gain, shape (user, subcarrier), NaN = missing."""
        return self.slots[-1]

    @property
    def current_noise_variance(self) -> FloatArray:
        """Measurement-error variance of the current slot, shape (user, subcarrier); 0 where unknown."""
        if self.noise_variance is None:
            return np.zeros(self.current.shape)
        return self.noise_variance if self.gain.ndim == 2 else self.noise_variance[-1]

    @property
    def missing(self) -> BoolArray:
        """True where the current slot has no observation, shape (user, subcarrier)."""
        return np.isnan(self.current)

    @property
    def measured(self) -> BoolArray:
        """True where a gain is there and was measured, shape (slot, user, subcarrier)."""
        there = ~np.isnan(self.slots)
        return there if self.estimated is None else there & ~self.estimated.reshape(there.shape)


def check_gain(gain: FloatArray) -> None:
    """Raise an :class:`InputError` that names the first entry that is negative, infinite or far too large."""
    with np.errstate(invalid="ignore"):
        bad, far = np.isinf(gain) | (gain < 0), gain > LARGEST
    if bad.any():
        raise InputError(
            f"a power gain must be finite and zero or more; got {_first(gain, bad)}. "
            "Mark missing entries with NaN; give dB values as unit='db'"
        )
    if far.any():
        raise InputError(
            f"a power gain must be {LARGEST:g} at most, since its variance is its square; got {_first(gain, far)}. "
            "A power gain is about 1 at most: check its unit"
        )


def check_variance(name: str, variance: FloatArray, needed: BoolArray) -> None:
    """Raise an :class:`InputError` that names the first variance that is no number where it is ``needed``."""
    with np.errstate(invalid="ignore"):
        bad = ~(variance >= 0) & needed | (variance < 0) | (variance > LARGEST**2)
    if bad.any():
        raise InputError(f"{name} must be zero or more and finite; got {_first(variance, bad)}")


def _first(array: FloatArray, bad: BoolArray) -> str:
    """The first bad entry and its place."""
    index = tuple(int(i) for i in np.argwhere(bad)[0])
    axes = ("slot", "user", "subcarrier")[-array.ndim :]
    where = ", ".join(f"{axis} {i}" for axis, i in zip(axes, index, strict=True))
    return f"{array[index]:g} at {where} (counted from 0)"

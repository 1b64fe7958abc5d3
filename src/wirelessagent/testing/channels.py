"""Small seeded channels that the contract suites try plug-ins on; independent of every channel source."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.user_names import numbered

SPACING_HZ = 180e3
_TAPS = 12
_TAP_SPACING_S = 50e-9


def rayleigh_gain(num_users: int, num_subcarriers: int, *, seed: int, num_slots: int = 1) -> FloatArray:
    """Frequency-selective Rayleigh gains, users 20 dB apart, slots correlated; shape (slot, user, subcarrier)."""
    rng = np.random.default_rng(seed)
    shape = (num_slots, num_users, _TAPS)
    innovation = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    taps = innovation.copy()
    for slot in range(1, num_slots):
        taps[slot] = 0.9 * taps[slot - 1] + np.sqrt(1 - 0.9**2) * innovation[slot]
    delay = _TAP_SPACING_S * np.arange(_TAPS)
    profile = np.exp(-delay / 100e-9)
    rotation = np.exp(-2j * np.pi * np.outer(delay, SPACING_HZ * np.arange(num_subcarriers)))
    response = (taps * np.sqrt(profile / profile.sum() / 2)) @ rotation
    level = 10.0 ** rng.uniform(-12, -10, num_users)
    return level[:, np.newaxis] * np.abs(response) ** 2


def known(gain: FloatArray) -> ChannelEstimate:
    """An estimate that is certain of ``gain``, shape (user, subcarrier)."""
    return ChannelEstimate(
        gain=gain,
        gain_variance=np.zeros(gain.shape),
        repaired=np.zeros(gain.shape, dtype=bool),
        unobserved_users=np.zeros(len(gain), dtype=bool),
        user_names=numbered(len(gain)),
        method="known",
    )


def known_scene(*, num_users: int = 4, num_subcarriers: int = 12, seed: int = 0) -> Scene:
    """A scene whose true channel is known and was sensed without error."""
    gain = rayleigh_gain(num_users, num_subcarriers, seed=seed)[0]
    return Scene(cell=Cell(), sensed=ChannelObservation(gain=gain), truth=gain)


def observations() -> dict[str, ChannelObservation]:
    """Every pattern of holes that a repairer meets, by what is special about it."""
    full = rayleigh_gain(6, 16, seed=1)[0]
    history = rayleigh_gain(6, 16, seed=2, num_slots=5)
    without_now = _with_holes(history, 0.2)
    without_now[-1] = np.nan
    return {
        "scattered holes": _observation(_with_holes(full, 0.2)),
        "nothing missing": _observation(full),
        "a user that was never observed": _observation(_without(_with_holes(full, 0.2), row=2)),
        "a subcarrier that nobody observed": _observation(_without(_with_holes(full, 0.2), column=3)),
        "the first and the last subcarriers missing": _observation(_without(_without(full, column=0), column=-1)),
        "one observed entry": _observation(_without_all_but(full, row=2, column=8)),
        "a single user": _observation(_with_holes(full, 0.3)[:1]),
        "a single subcarrier": _observation(_without(full, row=4)[:, :1]),
        "gains of zero": _observation(_with_holes(np.where(full < np.median(full), 0.0, full), 0.2)),
        "a history of slots": _observation(_with_holes(history, 0.2)),
        "a history and nothing of now": _observation(without_now),
        "measurement noise": _observation(_with_holes(full, 0.2), noise_variance=(0.1 * full) ** 2),
    }


def _observation(gain: FloatArray, *, noise_variance: FloatArray | None = None) -> ChannelObservation:
    num_slots, num_subcarriers = gain.shape[0], gain.shape[-1]
    return ChannelObservation(
        gain=gain,
        noise_variance=noise_variance,
        user_names=tuple(f"phone {k}" for k in range(gain.shape[-2])),
        subcarrier_frequencies_hz=3.5e9 + SPACING_HZ * np.arange(num_subcarriers, dtype=np.float64),
        slot_times_s=1e-3 * np.arange(num_slots, dtype=np.float64) if gain.ndim == 3 else None,
    )


def _with_holes(gain: FloatArray, rate: float) -> FloatArray:
    return np.where(np.random.default_rng(7).uniform(size=gain.shape) < rate, np.nan, gain)


def _without(gain: FloatArray, *, row: int | None = None, column: int | None = None) -> FloatArray:
    rest = gain.copy()
    if row is not None:
        rest[row] = np.nan
    if column is not None:
        rest[:, column] = np.nan
    return rest


def _without_all_but(gain: FloatArray, *, row: int, column: int) -> FloatArray:
    rest = np.full(gain.shape, np.nan)
    rest[row, column] = gain[row, column]
    return rest

"""The channels, cells and problems that the bars are measured on.

Channels come from the project's own ``rayleigh`` source, which has exactly the law asked for: users uniform by area in
35–300 m, path loss 128.1 + 37.6 log10(d/km) dB, 6 dB shadowing, Rayleigh fading with an exponential power-delay
profile (here 300 ns rms) and Clarke's Doppler spectrum, 180 kHz spacing. Seeds start at 1000, so that none is one that
the methods were built on. Every method is given the true channel: estimation is another benchmark's subject.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.testing.channels import known

FIRST_SEED = 1000
RMS_DELAY_SPREAD_S = 300e-9

SHANNON = Cell()
PRACTICAL = Cell(
    snr_gap_db=2.0, max_spectral_efficiency_bps_per_hz=7.4063, overhead=0.14, amplifier_efficiency=0.3
)  # the link of Cell.nr() on the grid and noise of the reference figures
LINKS = {"Shannon": SHANNON, "practical": PRACTICAL}


def gains(num_users: int, num_subcarriers: int, seed: int, *, num_slots: int = 1) -> FloatArray:
    """True gains, shape (slot, user, subcarrier); slots 1 ms apart at 3 km/h and 3.5 GHz."""
    scene = wa.simulate(
        "rayleigh",
        SHANNON,
        seed=seed,
        num_users=num_users,
        num_subcarriers=num_subcarriers,
        rms_delay_spread_s=RMS_DELAY_SPREAD_S,
        num_slots=num_slots,
        slot_s=1e-3,
        speed_km_per_h=3.0,
        carrier_hz=3.5e9,
    )
    assert scene.truth is not None
    return np.asarray(scene.truth).reshape(num_slots, num_users, num_subcarriers)


def draws(num_users: int, num_subcarriers: int, count: int) -> Iterator[ChannelEstimate]:
    """``count`` independent channels."""
    for seed in range(FIRST_SEED, FIRST_SEED + count):
        yield known(gains(num_users, num_subcarriers, seed)[0])


def slots(num_users: int, num_subcarriers: int, count: int, *, seed: int = FIRST_SEED) -> list[ChannelEstimate]:
    """One cell's channel in ``count`` slots of 1 ms, correlated in time by Clarke's spectrum."""
    return [known(gain) for gain in gains(num_users, num_subcarriers, seed, num_slots=count)]


def snr_per_w(estimate: ChannelEstimate, cell: Cell) -> FloatArray:
    """a = g/(Γ N0 B) in 1/W, shape (user, subcarrier)."""
    return estimate.gain / (cell.snr_gap * cell.noise_power_w)

"""A simulated downlink cell: path loss, shadowing and frequency-selective Rayleigh fading.

The paper (section IV.A) says only "Rayleigh fading, incorporating path loss"; here is what is assumed. The power gain
of user k on subcarrier n in slot t is

    g = 10^(−(128.1 + 37.6 log10(d_k/km) + X_k)/10) · |h_k(n, t)|²,    X_k ~ N(0, σ_X²) in dB,

- with users dropped uniformly by area between two radii (35 m is the smallest distance of TR 36.814, table A.2.1.1-1),
- the urban macro path loss of TR 36.942, clause 4.5.2 (2 GHz), also table A.2.1.1-3 of TR 36.814; it is kept for
  every carrier, which sets only the Doppler shift and the frequencies that are reported,
- and the fading of :mod:`wirelessagent.sensing.fading`: exponential power-delay profile, Clarke's Doppler spectrum.
  100 ns is the nominal delay spread of TR 38.901, table 7.7.3-1.

Deliberately missing: antennas and their patterns, line of sight, other cells, the distance's effect on delay spread,
correlated shadowing, and movement large enough to change the path loss within the slots drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, positive, whole, within
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import from_db, human
from wirelessagent.sensing.fading import ComplexArray, complex_normal, rayleigh_fading
from wirelessagent.sensing.source import ChannelSource

SPEED_OF_LIGHT_M_PER_S = 299_792_458.0

MAX_GAINS = 50_000_000
"""Most gains that one scene may hold; beyond it a typing error would fill the memory."""

LIMITS = {
    "outer_radius_m": 1e6,
    "shadowing_std_db": 50.0,
    "rms_delay_spread_s": 1e-3,
    "speed_km_per_h": 1e5,
    "carrier_hz": 1e13,
    "slot_s": 1e6,
}
"""Largest values taken: far beyond any cell, so that what exceeds them is a mistaken unit."""


@dataclass(frozen=True, kw_only=True)
class Rayleigh(ChannelSource):
    """A simulated cell with path loss, shadowing and frequency-selective Rayleigh fading.

    Attributes:
        num_users: number of users K.
        num_subcarriers: number of subcarriers N; their spacing is the cell's subcarrier bandwidth.
        inner_radius_m: smallest distance of a user from the base station.
        outer_radius_m: largest distance of a user from the base station.
        shadowing_std_db: standard deviation of the log-normal shadowing, independent between users.
        user_correlation: correlation coefficient ρ in [0, 1) of any two users' complex fading coefficients on one
            subcarrier in one slot, E[h_j h_k*] = ρ: all users share a common component of power ρ. Their normalised
            gains are then correlated by ρ². Distances and shadowing stay independent.
        rms_delay_spread_s: rms delay spread τ of the exponential power-delay profile; 0 is flat fading.
        speed_km_per_h: speed of every user; 0 keeps the channel the same in all slots.
        carrier_hz: carrier frequency, the centre of the band.
        num_slots: number of slots T; the last one is the current one and the others are history.
        slot_s: time from one slot to the next.
        snr_db: signal-to-noise ratio of the channel measurement, each user's mean gain over the noise in its
            coefficients; exact measurements if not set.
    """

    name = "rayleigh"

    num_users: int = 8
    num_subcarriers: int = 20
    inner_radius_m: float = 35.0
    outer_radius_m: float = 300.0
    shadowing_std_db: float = 6.0
    user_correlation: float = 0.0
    rms_delay_spread_s: float = 100e-9
    speed_km_per_h: float = 0.0
    carrier_hz: float = 3.5e9
    num_slots: int = 1
    slot_s: float = 1e-3
    snr_db: float | None = None

    def __post_init__(self) -> None:
        for name in ("num_users", "num_subcarriers", "num_slots"):
            object.__setattr__(self, name, whole(name, getattr(self, name)))
        for name in ("inner_radius_m", "outer_radius_m", "carrier_hz", "slot_s"):
            object.__setattr__(self, name, positive(name, getattr(self, name)))
        for name in ("shadowing_std_db", "user_correlation", "rms_delay_spread_s", "speed_km_per_h"):
            object.__setattr__(self, name, positive(name, getattr(self, name), zero=True))
        for name, limit in LIMITS.items():
            if getattr(self, name) > limit:
                raise InputError(f"{name} must be at most {limit:g}; got {getattr(self, name):g}: check its unit")
        if self.outer_radius_m < self.inner_radius_m:
            raise InputError(
                f"outer_radius_m must be at least inner_radius_m ({self.inner_radius_m:g}); got {self.outer_radius_m:g}"
            )
        if self.user_correlation >= 1:
            raise InputError(f"user_correlation must be in [0, 1); got {self.user_correlation:g}")
        if self.snr_db is not None:
            object.__setattr__(self, "snr_db", within("snr_db", self.snr_db, -100.0, 200.0))
        gains = self.num_users * self.num_subcarriers * self.num_slots
        if gains > MAX_GAINS:
            raise InputError(
                f"{self.num_users} users × {self.num_subcarriers} subcarriers × {self.num_slots} slots are {gains:,} "
                f"gains, more than {MAX_GAINS:,}: ask for fewer"
            )

    @property
    def doppler_hz(self) -> float:
        """The largest Doppler shift, speed over wavelength, in Hz."""
        return self.speed_km_per_h / 3.6 * self.carrier_hz / SPEED_OF_LIGHT_M_PER_S

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        """A scene of shape (user, subcarrier), with several slots (slot, user, subcarrier).

        The users of a seed stay the same when more are asked for. With ``snr_db`` set, ``sensed`` holds what
        :func:`measured` makes of the true coefficients.
        """
        _, _, fade, common, noise = streams(seed, 5)
        distance_m, shadowing_db = self._placed(seed)
        mean_gain = self.mean_gain(seed=seed)[:, np.newaxis, np.newaxis]
        fading = self._fading(cell, fade, common)
        truth = mean_gain * (fading.real**2 + fading.imag**2)
        gain, variance = truth, None
        if self.snr_db is not None:
            gain, variance = measured(fading, float(from_db(self.snr_db)), noise)
            gain, variance = mean_gain * gain, self._as_observed(mean_gain**2 * variance)
        offset = np.arange(self.num_subcarriers, dtype=np.float64) - (self.num_subcarriers - 1) / 2
        sensed = ChannelObservation(
            gain=self._as_observed(gain),
            noise_variance=variance,
            subcarrier_frequencies_hz=self.carrier_hz + offset * cell.subcarrier_bandwidth_hz,
            slot_times_s=self.slot_s * np.arange(self.num_slots, dtype=np.float64) if self.num_slots > 1 else None,
        )
        facts = self._facts(distance_m, shadowing_db)
        return Scene(cell=cell, sensed=sensed, truth=self._as_observed(truth), facts=facts)

    def mean_gain(self, *, seed: int = 0) -> FloatArray:
        """Each user's mean over the fading in the scene of this seed: path loss and shadowing, shape (user,)."""
        distance_m, shadowing_db = self._placed(seed)
        return from_db(-path_loss_db(distance_m) - shadowing_db)

    def _placed(self, seed: int) -> tuple[FloatArray, FloatArray]:
        """Distance in m and shadowing in dB of each user, shape (user,) each."""
        place, shadow = streams(seed, 2)
        inner, outer = self.inner_radius_m, self.outer_radius_m
        distance_m = np.sqrt(inner**2 + place.random(self.num_users) * (outer**2 - inner**2))
        return distance_m, self.shadowing_std_db * shadow.standard_normal(self.num_users)

    def _fading(self, cell: Cell, fade: np.random.Generator, common: np.random.Generator) -> ComplexArray:
        """Unit-power coefficients with the users' correlation, shape (user, slot, subcarrier)."""

        def drawn(rng: np.random.Generator, num_users: int) -> ComplexArray:
            return rayleigh_fading(
                rng,
                num_users=num_users,
                num_slots=self.num_slots,
                num_subcarriers=self.num_subcarriers,
                subcarrier_spacing_hz=cell.subcarrier_bandwidth_hz,
                rms_delay_spread_s=self.rms_delay_spread_s,
                doppler_hz=self.doppler_hz,
                slot_s=self.slot_s,
            )

        own = drawn(fade, self.num_users)
        if self.user_correlation == 0:
            return own
        return np.sqrt(1 - self.user_correlation) * own + np.sqrt(self.user_correlation) * drawn(common, 1)

    def _as_observed(self, values: FloatArray) -> FloatArray:
        """(user, slot, subcarrier) as an observation has it: slots first, and left out where there is only one."""
        return values[:, 0] if self.num_slots == 1 else np.ascontiguousarray(values.transpose(1, 0, 2))

    def _facts(self, distance_m: FloatArray, shadowing_db: FloatArray) -> dict[str, str]:
        loss_db = path_loss_db(distance_m)
        spread = human(self.rms_delay_spread_s, "s")
        facts = {
            "users": f"{self.num_users}, uniform by area in {self.inner_radius_m:g}–{self.outer_radius_m:g} m, "
            f"drawn at {distance_m.min():.0f}–{distance_m.max():.0f} m",
            "path loss": f"{loss_db.min():.1f}–{loss_db.max():.1f} dB; with shadowing "
            f"({self.shadowing_std_db:g} dB) {(loss_db + shadowing_db).min():.1f}–"
            f"{(loss_db + shadowing_db).max():.1f} dB",
            "fading": f"Rayleigh, exponential power-delay profile, {spread} rms delay spread",
        }
        if self.user_correlation:
            facts["users' correlation"] = f"{self.user_correlation:g} between fading coefficients"
        if self.num_slots > 1:
            facts["slots"] = (
                f"{self.num_slots}, every {human(self.slot_s, 's')}, at {self.speed_km_per_h:g} km/h "
                f"(Doppler {human(self.doppler_hz, 'Hz')} at {human(self.carrier_hz, 'Hz')})"
            )
        facts["measurement"] = "exact" if self.snr_db is None else f"{self.snr_db:g} dB SNR"
        return facts


def path_loss_db(distance_m: FloatArray) -> FloatArray:
    """Urban macro path loss 128.1 + 37.6 log10(d/km) in dB, TR 36.942, clause 4.5.2.

    >>> float(path_loss_db(np.array(1000.0)))
    128.1
    """
    return 128.1 + 37.6 * np.log10(distance_m / 1e3)


def measured(fading: ComplexArray, snr: float, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """What a receiver that sees y = h + e makes of the gain |h|², and the variance of its error; both like ``fading``.

    For h of unit mean power and noise e of power 1/snr, h given y is complex Gaussian with mean s·y and variance
    v = 1/(1 + snr), s = snr/(1 + snr). The measured gain is the conditional mean and the variance the conditional one,

        E[|h|² | y] = |s y|² + v,    Var[|h|² | y] = 2 |s y|² v + v²,

    so the gain is above zero and without bias, and the variance is exact for each entry, deep fades included.
    (The bare |y|² would be too large by the noise power.)
    """
    noise = complex_normal(rng, fading.shape) / np.sqrt(snr)
    seen = (fading + noise) * (snr / (1.0 + snr))
    power, variance = seen.real**2 + seen.imag**2, 1.0 / (1.0 + snr)
    return power + variance, 2.0 * power * variance + variance**2


def streams(seed: int, count: int) -> list[np.random.Generator]:
    """Independent random generators from one seed, so that one drawn quantity does not shift the next."""
    number = whole("seed", seed, smallest=0)
    return [np.random.default_rng(child) for child in np.random.SeedSequence(number).spawn(count)]

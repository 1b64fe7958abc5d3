"""The bar of lost reports, measured: ``python benchmarks/bars_history.py [--draws 200] [--speeds 3,30]``.

Eight users on 20 subcarriers tell their gains in 16 slots of 1 ms at 20 dB SNR, and whole reports get lost. The bar:
the error of ``wa.repair`` is at most 1.05 times that of each user repaired alone, and of the last report as it is
(entry by entry, the user's mean where an entry never came), whatever share is lost and whenever users join.

- *Rayleigh*: the project's own source, 100 ns, Clarke's spectrum.
- *rays*: clusters of rays with a delay, a direction and a power each, in delay spreads from 30 to 300 ns, and a line of
  sight to half of the users: neither the profiles nor the Doppler spectra that the repair weighs.

Errors are root mean squares over the gains asked for, those missing in the current slot (*now*) or all of the next slot
(*next*), in units of each user's mean true gain. Ratios are of errors over all draws with 95 % bootstrap intervals over
draws; *band holds* is how often the truth lies in the 90 % band. Each user has at least one report.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
from channels import FIRST_SEED
from measuring import table

import wirelessagent as wa
from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.units import from_db
from wirelessagent.sensing.rayleigh import measured

SLOTS, USERS, SUBCARRIERS = 16, 8, 20
SLOT_S, SPACING_HZ, CARRIER_HZ, LIGHT_M_PER_S = 1e-3, 180e3, 3.5e9, 299792458.0
SNR_DB = 20.0
CLUSTERS, RAYS = 10, 20
CLUSTER_WIDTH_RAD, CLUSTER_SHADOWING_DB = 0.3, 3.0
LOSS_SEED = 1_000_000
RESAMPLED = 2000
HEADER = (
    "channels", "lost, asked for", "joint", "each alone", "last report", "joint / alone", "joint / last", "band holds",
)  # fmt: skip


def rayleigh(speed_km_per_h: float, seed: int) -> tuple[FloatArray, ChannelObservation]:
    """Truth, one slot longer, and what is measured."""
    scene = wa.simulate(
        "rayleigh", seed=seed, num_users=USERS, num_subcarriers=SUBCARRIERS, num_slots=SLOTS + 1, slot_s=SLOT_S,
        speed_km_per_h=speed_km_per_h, carrier_hz=CARRIER_HZ, snr_db=SNR_DB, rms_delay_spread_s=100e-9,
    )  # fmt: skip
    assert scene.truth is not None
    return scene.truth, scene.sensed


def rays(speed_km_per_h: float, seed: int) -> tuple[FloatArray, ChannelObservation]:
    """As :func:`rayleigh`, of users in clusters of rays."""
    rng = np.random.default_rng(seed)
    times = SLOT_S * np.arange(SLOTS + 1)
    frequencies_hz = SPACING_HZ * np.arange(SUBCARRIERS)
    doppler_hz = speed_km_per_h / 3.6 / LIGHT_M_PER_S * CARRIER_HZ
    fading = np.empty((times.size, USERS, SUBCARRIERS), dtype=np.complex128)
    for k in range(USERS):
        spread_s = np.exp(rng.uniform(np.log(30e-9), np.log(300e-9)))
        delay_s = rng.exponential(2.0 * spread_s, CLUSTERS)
        power = np.exp(-0.5 * delay_s / spread_s) * from_db(CLUSTER_SHADOWING_DB * rng.standard_normal(CLUSTERS))
        power = np.repeat(power / power.sum() / RAYS, RAYS)
        angle = np.repeat(rng.uniform(0.0, 2.0 * np.pi, CLUSTERS), RAYS) + rng.laplace(
            scale=CLUSTER_WIDTH_RAD / np.sqrt(2.0), size=power.size
        )
        delay_s = np.repeat(delay_s, RAYS)
        if k % 2:  # a line of sight, 7 ± 4 dB above the rest (3GPP TR 38.901, table 7.5-6, UMi has 9 ± 5)
            rice = float(from_db(7.0 + 4.0 * rng.standard_normal()))
            power = np.append(power, rice) / (1.0 + rice)
            angle, delay_s = np.append(angle, rng.uniform(0.0, 2.0 * np.pi)), np.append(delay_s, 0.0)
        phase = rng.uniform(0.0, 2.0 * np.pi, power.size)
        over_time = np.exp(1j * (2.0 * np.pi * doppler_hz * np.outer(times, np.cos(angle)) + phase))
        fading[:, k] = (np.sqrt(power) * over_time) @ np.exp(-2j * np.pi * np.outer(delay_s, frequencies_hz))
    gain, variance = measured(fading, float(from_db(SNR_DB)), rng)
    level = from_db(-rng.uniform(90.0, 120.0, (USERS, 1)))
    return np.abs(fading) ** 2 * level, ChannelObservation(
        gain=gain * level,
        noise_variance=variance * level**2,
        subcarrier_frequencies_hz=CARRIER_HZ + frequencies_hz,
        slot_times_s=times,
    )


FAMILIES: dict[str, Callable[[float, int], tuple[FloatArray, ChannelObservation]]] = {
    "Rayleigh": rayleigh,
    "rays": rays,
}


def reports(share: float) -> Callable[[np.random.Generator], BoolArray]:
    """Each report is lost with the same chance, but one of each user."""

    def lost(rng: np.random.Generator) -> BoolArray:
        missing = rng.random((SLOTS, USERS)) < share
        missing[rng.integers(SLOTS, size=USERS), np.arange(USERS)] = False
        return missing[..., np.newaxis]

    return lost


def late(rng: np.random.Generator) -> BoolArray:
    """Every other user joins at any slot."""
    first = np.where(np.arange(USERS) % 2, rng.integers(1, SLOTS, USERS), 0)
    return (np.arange(SLOTS)[:, np.newaxis] < first)[..., np.newaxis]


def silent(rng: np.random.Generator) -> BoolArray:
    """Every other user is heard no more from some slot on."""
    last = np.where(np.arange(USERS) % 2, rng.integers(1, SLOTS, USERS), SLOTS)
    return (np.arange(SLOTS)[:, np.newaxis] >= last)[..., np.newaxis]


def old(rng: np.random.Generator) -> BoolArray:
    """The last reports have all come, those before as a rule not."""
    missing = reports(0.6)(rng)
    missing[-1] = False
    return missing


def holed(rng: np.random.Generator) -> BoolArray:
    """Reports are lost, and single gains of those that come."""
    return reports(0.4)(rng) | (rng.random((SLOTS, USERS, SUBCARRIERS)) < 0.3)


CASES: dict[str, tuple[Callable[[np.random.Generator], BoolArray], bool]] = {
    "none, next": (reports(0.0), True),
    **{f"{share:.0%} of the reports, now": (reports(share), False) for share in (0.2, 0.4, 0.6, 0.8)},
    "80% of the reports, next": (reports(0.8), True),
    "before users join, next": (late, True),
    "since users are silent, now": (silent, False),
    "60% of the history, next": (old, True),
    "40% of the reports and 30% holes, now": (holed, False),
}
"""What gets lost, and whether the next slot is asked for instead of the current one."""


def last_seen(seen: ChannelObservation) -> FloatArray:
    """Each entry as it was last reported; the user's mean where it never was."""
    last = np.full(seen.current.shape, np.nan)
    for slot in seen.slots:
        last = np.where(np.isnan(slot), last, slot)
    return np.where(np.isnan(last), np.nanmean(seen.slots, axis=(0, 2))[:, np.newaxis], last)


def each_alone(seen: ChannelObservation, at_s: float | None, asked: BoolArray) -> FloatArray:
    """Gains of each user of whom any are ``asked``, repaired as if there were no others; NaN of the others."""
    variance = seen.noise_variance
    assert variance is not None
    found = np.full(asked.shape, np.nan)
    for k in np.flatnonzero(asked.any(axis=1)):
        alone = dataclasses.replace(
            seen,
            gain=seen.slots[:, [k]],
            noise_variance=variance[:, [k]],
            user_names=(seen.user_names[k],),
        )
        found[k] = wa.repair(alone, at_s=at_s).gain[0]
    return found


def measure(family: str, speed_km_per_h: float, case: str, count: int) -> FloatArray:
    """Squared errors of joint repair, users alone and last report, gains in the band, gains; shape (draw, 5)."""
    lose, is_next = CASES[case]
    result = np.zeros((count, 5))
    for draw in range(count):
        truth, sensed = FAMILIES[family](speed_km_per_h, FIRST_SEED + draw)
        lost = lose(np.random.default_rng(LOSS_SEED + draw)) | np.zeros(sensed.gain[:-1].shape, dtype=bool)
        assert sensed.slot_times_s is not None
        assert sensed.noise_variance is not None
        seen = dataclasses.replace(
            sensed,
            gain=np.where(lost, np.nan, sensed.gain[:-1]),
            noise_variance=np.where(lost, np.nan, sensed.noise_variance[:-1]),
            slot_times_s=sensed.slot_times_s[:-1],
        )
        at_s, now = (float(sensed.slot_times_s[-1]), truth[-1]) if is_next else (None, truth[-2])
        asked = np.ones(now.shape, dtype=bool) if is_next else seen.missing
        estimate = wa.repair(seen, at_s=at_s)
        level = truth.mean(axis=(0, 2))[:, np.newaxis]
        for i, found in enumerate((estimate.gain, each_alone(seen, at_s, asked), last_seen(seen))):
            result[draw, i] = np.sum((((found - now) / level)[asked]) ** 2)
        low, high = estimate.posterior.quantile(0.05), estimate.posterior.quantile(0.95)
        result[draw, 3:] = np.sum(((now >= low) & (now <= high))[asked]), np.sum(asked)
    return result


def row(channels: str, case: str, found: FloatArray) -> list[str]:
    """Errors, their ratios and the share of gains in the band, with their intervals."""
    drawn = np.random.default_rng(1).integers(len(found), size=(RESAMPLED, len(found)))
    again = found[drawn].sum(axis=1)
    total = found.sum(axis=0)

    def shown(of: Callable[[FloatArray], FloatArray], form: str) -> str:
        low, high = np.nanquantile(of(again.T), [0.025, 0.975])
        return f"{of(total):{form}} ({low:{form}}–{high:{form}})"

    return [
        channels,
        case,
        *(shown(lambda x, i=i: np.sqrt(x[i] / x[4]), ".3f") for i in range(3)),
        *(shown(lambda x, i=i: np.sqrt(x[0] / x[i]), ".2f") for i in (1, 2)),
        shown(lambda x: x[3] / x[4], ".1%"),
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=200, help="channels per case (%(default)s)")
    parser.add_argument("--families", default=",".join(FAMILIES), help="separated by commas: %(default)s")
    parser.add_argument("--speeds", default="3,30", help="km/h, separated by commas: %(default)s")
    chosen = parser.parse_args(arguments)
    for family in chosen.families.split(","):
        for speed in map(float, chosen.speeds.split(",")):
            channels = f"{family}, {speed:g} km/h"
            rows = [row(channels, case, measure(family, speed, case, chosen.draws)) for case in CASES]
            table(f"Lost reports, {USERS}×{SUBCARRIERS}, {SLOTS} slots, {chosen.draws} draws", HEADER, rows)


if __name__ == "__main__":
    main()

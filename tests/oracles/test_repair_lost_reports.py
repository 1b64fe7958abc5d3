"""Histories in which whole reports are lost: what a user did not tell is no evidence.

Everybody is repaired together, each user alone as if there were no others, and the last report is taken as it is:
together must not be worse than either. Channels are drawn as in ``test_repair_by_evidence``.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import j0

import wirelessagent as wa
from wirelessagent.model.observation import ChannelObservation

USERS, SLOTS, SUBCARRIERS, SLOT_S = 8, 16, 20, 1e-3
FREQUENCIES_HZ = 1e9 + 180e3 * np.arange(SUBCARRIERS)
SNR = 100.0

Floats = NDArray[np.float64]
Lost = NDArray[np.bool_]


def normal(rng: np.random.Generator, *shape: int) -> NDArray[np.complex128]:
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2)


def root(covariance: NDArray[np.complex128]) -> NDArray[np.complex128]:
    value, vector = np.linalg.eigh(covariance)
    return vector * np.sqrt(np.maximum(value, 0.0))


def moving(rng: np.random.Generator, speed_km_per_h: float) -> NDArray[np.complex128]:
    """Rayleigh fading of unit power by Clarke's spectrum and an exponential profile of 100 ns, one slot more."""
    times = SLOT_S * np.arange(SLOTS + 1)
    doppler_hz = speed_km_per_h / 3.6 / 3e8 * 3.5e9
    over_time = root(j0(2 * np.pi * doppler_hz * (times[:, np.newaxis] - times)).astype(np.complex128))
    over_frequency = root(1 / (1 + 2e-7j * np.pi * (FREQUENCIES_HZ[:, np.newaxis] - FREQUENCIES_HZ)))
    return np.einsum("ts,skn,fn->tkf", over_time, normal(rng, times.size, USERS, SUBCARRIERS), over_frequency)


def observed(rng: np.random.Generator, fading: NDArray[np.complex128], lost: Lost, level: Floats) -> ChannelObservation:
    """What arrives of noisy measurements: conditional means of the gain, with their variances."""
    seen = (fading + normal(rng, *fading.shape) / np.sqrt(SNR)) * SNR / (1 + SNR)
    power, left = np.abs(seen) ** 2, 1 / (1 + SNR)
    lost = lost | np.zeros(fading.shape, dtype=bool)
    return ChannelObservation(
        gain=np.where(lost, np.nan, (power + left) * level),
        noise_variance=np.where(lost, np.nan, (2 * power * left + left**2) * level**2),
        subcarrier_frequencies_hz=FREQUENCIES_HZ,
        slot_times_s=SLOT_S * np.arange(len(fading)),
    )


def only(seen: ChannelObservation, users: NDArray[np.int64]) -> ChannelObservation:
    """Some users, as if there were no others."""
    noise = seen.noise_variance
    return dataclasses.replace(
        seen,
        gain=seen.slots[:, users],
        noise_variance=None if noise is None else noise[:, users],
        user_names=tuple(seen.user_names[k] for k in users),
    )


def last_reports(seen: ChannelObservation) -> Floats:
    return np.array([user[~np.isnan(user[:, 0])][-1] for user in seen.slots.swapaxes(0, 1)])


def a_share(share: float) -> Callable[[np.random.Generator], Lost]:
    """Reports lost at random, but one of each user."""

    def lost(rng: np.random.Generator) -> Lost:
        missing = rng.random((SLOTS, USERS)) < share
        missing[rng.integers(SLOTS, size=USERS), np.arange(USERS)] = False
        return missing

    return lost


def those_before_joining(rng: np.random.Generator) -> Lost:
    return np.arange(SLOTS)[:, np.newaxis] < np.where(np.arange(USERS) % 2, rng.integers(1, SLOTS, USERS), 0)


def those_since_falling_silent(rng: np.random.Generator) -> Lost:
    return np.arange(SLOTS)[:, np.newaxis] >= np.where(np.arange(USERS) % 2, rng.integers(1, SLOTS, USERS), SLOTS)


def those_of_the_past(rng: np.random.Generator) -> Lost:
    missing = a_share(0.7)(rng)
    missing[-1] = False
    return missing


LOSSES = [
    a_share(0.25),
    a_share(0.6),
    a_share(0.8),
    those_before_joining,
    those_since_falling_silent,
    those_of_the_past,
]
NAMES = ["25%", "60%", "80%", "late", "silent", "past"]


@pytest.mark.parametrize("lose", LOSSES, ids=NAMES)
@pytest.mark.parametrize("speed_km_per_h", [3.0, 30.0])
def test_together_is_no_worse_than_alone_or_the_last_report(
    speed_km_per_h: float, lose: Callable[[np.random.Generator], Lost]
) -> None:
    """All gains one slot ahead, of 8 rooms, and how often the truth lies in their 90 % bands."""
    rng = np.random.default_rng(21)
    errors, inside = np.zeros(3), 0
    rooms = 8
    for _ in range(rooms):
        fading, lost = moving(rng, speed_km_per_h), lose(rng)[..., np.newaxis]
        level = 10 ** -rng.uniform(9, 12, (USERS, 1))
        seen = observed(rng, fading[:SLOTS], lost, level)
        truth = np.abs(fading[-1]) ** 2
        together = wa.repair(seen, at_s=SLOT_S * SLOTS)
        alone = [wa.repair(only(seen, np.array([k])), at_s=SLOT_S * SLOTS).gain[0] for k in range(USERS)]
        for i, found in enumerate((together.gain, np.array(alone), last_reports(seen))):
            errors[i] += np.sum((found / level - truth) ** 2)
        low, high = (together.posterior.quantile(q) / level for q in (0.05, 0.95))
        inside += int(np.sum((truth >= low) & (truth <= high)))
    error, by_each, by_last = np.sqrt(errors)
    assert error <= 1.05 * by_each
    assert error <= 1.05 * by_last
    assert 0.8 <= inside / (rooms * truth.size) <= 0.98  # 64 users are few fades


@pytest.mark.parametrize("known_noise", [True, False], ids=["noise stated", "noise unknown"])
def test_lost_reports_and_holes_in_those_that_come(known_noise: bool) -> None:
    """What is missing now of users at 3 km/h, beside the same without history."""
    rng = np.random.default_rng(31)
    errors = np.zeros(2)
    for _ in range(6):
        fading = moving(rng, 3.0)[:SLOTS]
        lost = a_share(0.4)(rng)[..., np.newaxis] | (rng.random(fading.shape) < 0.3)
        seen = observed(rng, fading, lost, np.ones((USERS, 1)))
        seen = seen if known_noise else dataclasses.replace(seen, noise_variance=None)
        for i, found in enumerate((wa.repair(seen), wa.repair(seen, "kriging"))):
            errors[i] += np.sum((found.gain - np.abs(fading[-1]) ** 2)[seen.missing] ** 2)
    assert np.sqrt(errors[0] / errors[1]) < 0.5


def test_who_never_reports_tells_nothing_of_the_others() -> None:
    rng = np.random.default_rng(5)
    seen = observed(rng, moving(rng, 30.0)[:SLOTS], a_share(0.3)(rng)[..., np.newaxis], np.ones((USERS, 1)))
    heard = np.arange(2)
    gain, noise = seen.gain.copy(), np.array(seen.noise_variance)
    gain[:, 2:], noise[:, 2:] = np.nan, np.nan
    with_silent = wa.repair(dataclasses.replace(seen, gain=gain, noise_variance=noise), at_s=SLOT_S * SLOTS)
    without = wa.repair(only(seen, heard), at_s=SLOT_S * SLOTS)
    np.testing.assert_array_equal(with_silent.unobserved_users, np.arange(USERS) >= 2)
    deviation = np.sqrt(without.gain_variance)
    assert np.max(np.abs(with_silent.gain[:2] - without.gain) / deviation) < 0.1
    np.testing.assert_allclose(with_silent.gain_variance[:2], without.gain_variance, rtol=0.2)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6])
def test_a_profile_of_no_kind_is_learnt_from_the_reports_that_came(share: float) -> None:
    """Three equal paths over 4 µs, each slot a new channel: users heard now, beside the current slot alone."""
    rng = np.random.default_rng(5)
    paths = np.exp(-2j * np.pi * np.outer(np.array([0.0, 1.2, 4.0]) * 1e-6, FREQUENCIES_HZ))
    errors = np.zeros(2)
    for _ in range(8):
        fading = normal(rng, 33, USERS, 3) / np.sqrt(3) @ paths
        lost = (rng.random((33, USERS, 1)) < share) | (rng.random(fading.shape) < 0.2)
        seen = observed(rng, fading, lost, np.ones((USERS, 1)))
        asked = lost[-1] & ~lost[-1].all(axis=1, keepdims=True)
        for i, found in enumerate((wa.repair(seen), wa.repair(seen, "kriging"))):
            errors[i] += np.sum((found.gain - np.abs(fading[-1]) ** 2)[asked] ** 2)
    assert np.sqrt(errors[0] / errors[1]) < 0.7

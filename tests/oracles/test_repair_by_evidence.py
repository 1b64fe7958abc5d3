"""Kriging, the learned covariance and the predictor against linear estimation with everything known.

Channels are drawn here with exact covariances, independently of the package's own sources. The oracle knows delay
spread, Doppler shift, mean and noise.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import j0

import wirelessagent as wa
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.kriging import Kriging
from wirelessagent.repairing.learned_covariance import LearnedCovariance
from wirelessagent.repairing.linear import Linear
from wirelessagent.repairing.nncf import Nncf
from wirelessagent.repairing.predictor import Predictor

SPACING_HZ, USERS, SUBCARRIERS = 180e3, 8, 20
FREQUENCIES_HZ = 1e9 + SPACING_HZ * np.arange(SUBCARRIERS)
DISTANCE_HZ = np.abs(FREQUENCIES_HZ[:, np.newaxis] - FREQUENCIES_HZ)

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]


def normal(rng: np.random.Generator, shape: tuple[int, ...]) -> Complex:
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2)


def root(covariance: Complex) -> Complex:
    value, vector = np.linalg.eigh(covariance)
    return vector * np.sqrt(np.maximum(value, 0.0))


def exponential(delay_spread_s: float) -> Complex:
    signed = FREQUENCIES_HZ[:, np.newaxis] - FREQUENCIES_HZ
    return 1.0 / (1.0 + 2j * np.pi * signed * delay_spread_s)


def reported(fading: Complex, snr_db: float, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """What a receiver makes of the gain, and the variance of the true one about it: conditional mean and variance."""
    snr = 10 ** (snr_db / 10)
    seen = (fading + normal(rng, fading.shape) / np.sqrt(snr)) * snr / (1 + snr)
    power, left = np.abs(seen) ** 2, 1 / (1 + snr)
    return power + left, 2 * power * left + left**2


@dataclass(frozen=True)
class Outcome:
    truth: Floats
    found: Floats
    oracle: Floats
    low: Floats
    high: Floats

    @property
    def ratio(self) -> float:
        return float(np.sqrt(np.sum((self.found - self.truth) ** 2) / np.sum((self.oracle - self.truth) ** 2)))

    @property
    def covered(self) -> float:
        return float(np.mean((self.truth >= self.low) & (self.truth <= self.high)))

    @property
    def undershot(self) -> float:
        return float(np.mean(self.truth < self.low))


def lost_at_random(rng: np.random.Generator, rate: float) -> NDArray[np.bool_]:
    lost = np.zeros(USERS * SUBCARRIERS, dtype=bool)
    lost[rng.permutation(lost.size)[: round(rate * lost.size)]] = True
    return lost.reshape(USERS, SUBCARRIERS)


def completed(spreads_s: list[float] | None, *, matrices: int = 120, rate: float = 0.2, seed: int = 11) -> Outcome:
    """Kriging at 30 dB SNR; ``spreads_s`` None draws each user's delay spread from 30 ns to 1 µs."""
    rng = np.random.default_rng(seed)
    snr = 1e3
    kept = snr / (1 + snr)
    columns: list[list[Floats]] = []
    for _ in range(matrices):
        spread = np.exp(rng.uniform(np.log(30e-9), np.log(1e-6), USERS)) if spreads_s is None else spreads_s * USERS
        fading = np.stack([root(exponential(s)) @ normal(rng, (SUBCARRIERS,)) for s in spread])
        gain, noise = reported(fading, 30.0, rng)
        level = 10 ** -rng.uniform(9, 12, (USERS, 1))
        lost = lost_at_random(rng, rate)
        seen = ChannelObservation(
            gain=np.where(lost, np.nan, gain * level),
            noise_variance=np.where(lost, np.nan, noise * level**2),
            subcarrier_frequencies_hz=FREQUENCIES_HZ,
        )
        estimate = Kriging().repair(seen)
        low, high = estimate.posterior.quantile(0.05) / level, estimate.posterior.quantile(0.95) / level
        for k in range(USERS):
            known, hole = ~lost[k], lost[k]
            alike = np.abs(exponential(spread[k])) ** 2
            seen_alike = kept**4 * alike + (kept**2 - kept**4) * np.eye(SUBCARRIERS)
            weight = np.linalg.solve(seen_alike[np.ix_(known, known)], kept**2 * alike[np.ix_(known, hole)])
            oracle = 1 + weight.T @ (gain[k, known] - 1)
            truth = np.abs(fading[k, hole]) ** 2
            columns.append([truth, (estimate.gain / level)[k, hole], oracle, low[k, hole], high[k, hole]])
    return Outcome(*(np.concatenate(column) for column in zip(*columns, strict=True)))


@pytest.mark.parametrize(
    ("delay_spread_s", "most"), [(100e-9, 1.10), (300e-9, 1.10), (1000e-9, 1.06), (None, 1.06)], ids=str
)
def test_kriging_is_next_to_the_oracle(delay_spread_s: float | None, most: float) -> None:
    assert completed(None if delay_spread_s is None else [delay_spread_s]).ratio <= most


def test_kriging_stays_next_to_the_oracle_where_half_is_lost() -> None:
    assert completed([300e-9], rate=0.5).ratio <= 1.12


@pytest.mark.parametrize("delay_spread_s", [100e-9, 300e-9, 1000e-9])
def test_the_band_of_kriging_holds_nine_of_ten(delay_spread_s: float) -> None:
    outcome = completed([delay_spread_s], matrices=250)
    assert 0.865 <= outcome.covered <= 0.935  # 6,000 correlated entries: 0.88 to 0.93 and chance
    assert 0.03 <= outcome.undershot <= 0.07


def moving(
    speed_km_per_h: float, ahead: int, *, slots: int = 16, rooms: int = 5, seed: int = 3
) -> tuple[Outcome, Floats]:
    """The predictor at 20 dB SNR, 100 ns and 20 % loss, ``ahead`` slots of 1 ms after the last, and the user mean."""
    rng = np.random.default_rng(seed)
    snr = 1e2
    kept = snr / (1 + snr)
    doppler_hz = speed_km_per_h / 3.6 / 3e8 * 3.5e9
    times = 1e-3 * np.arange(slots + ahead)
    over_time = root(j0(2 * np.pi * doppler_hz * (times[:, np.newaxis] - times)).astype(np.complex128))
    over_frequency = root(exponential(100e-9))
    columns: list[list[Floats]] = []
    means: list[Floats] = []
    for _ in range(rooms):
        drawn = normal(rng, (USERS, times.size, SUBCARRIERS))
        fading = np.einsum("ts,ksn,fn->ktf", over_time, drawn, over_frequency)
        gain, noise = reported(fading, 20.0, rng)
        lost = rng.random((USERS, slots, SUBCARRIERS)) < 0.2
        level = 10 ** -rng.uniform(9, 12, (USERS, 1, 1))
        seen = ChannelObservation(
            gain=np.where(lost, np.nan, gain[:, :slots] * level).swapaxes(0, 1),
            noise_variance=np.where(lost, np.nan, noise[:, :slots] * level**2).swapaxes(0, 1),
            subcarrier_frequencies_hz=FREQUENCIES_HZ,
            slot_times_s=times[:slots],
        )
        estimate = Predictor().repair(seen, at_s=float(times[-1]))
        assert estimate.repaired.all()
        low, high = estimate.posterior.quantile(0.05), estimate.posterior.quantile(0.95)
        for k in range(USERS):
            at, of = np.nonzero(~lost[k])
            apart = np.abs(times[at][:, np.newaxis] - times[at])
            alike = j0(2 * np.pi * doppler_hz * apart) ** 2 / (1 + (2e-7 * np.pi * DISTANCE_HZ[np.ix_(of, of)]) ** 2)
            towards = j0(2 * np.pi * doppler_hz * (times[-1] - times[at])) ** 2
            across = towards[:, np.newaxis] / (1 + (2e-7 * np.pi * DISTANCE_HZ[of]) ** 2)
            matrix = kept**4 * alike + (kept**2 - kept**4) * np.eye(at.size)
            values = gain[k, at, of]
            oracle = 1 + kept**2 * np.linalg.solve(matrix, across).T @ (values - 1)
            scale = level[k, 0, 0]
            truth = np.abs(fading[k, -1]) ** 2
            columns.append([truth, estimate.gain[k] / scale, oracle, low[k] / scale, high[k] / scale])
            means.append(np.full(SUBCARRIERS, values.mean()))
    return Outcome(*(np.concatenate(column) for column in zip(*columns, strict=True))), np.concatenate(means)


@pytest.mark.parametrize("ahead", [1, 5])
def test_the_predictor_follows_a_walker(ahead: int) -> None:
    outcome, mean = moving(3.0, ahead)
    assert outcome.ratio <= 1.5
    assert np.sum((outcome.found - outcome.truth) ** 2) < 0.2 * np.sum((mean - outcome.truth) ** 2)


@pytest.mark.parametrize("speed_km_per_h", [0.0, 30.0, 120.0, 500.0])
@pytest.mark.parametrize("ahead", [1, 10])
def test_the_predictor_does_not_lose_to_the_mean(speed_km_per_h: float, ahead: int) -> None:
    outcome, mean = moving(speed_km_per_h, ahead)
    error, by_mean = np.mean((outcome.found - outcome.truth) ** 2), np.mean((mean - outcome.truth) ** 2)
    assert np.sqrt(error / by_mean) <= 1.05  # 1.02 and chance: 40 users are few fades


def test_learning_takes_over_where_the_profile_is_of_no_kind() -> None:
    """Three equal paths over 4 µs, whose correlation comes and goes, each slot a new channel."""
    rng = np.random.default_rng(5)
    paths = np.exp(-2j * np.pi * np.outer(np.array([0.0, 1.2, 4.0]) * 1e-6, FREQUENCIES_HZ))
    errors = np.zeros(3)
    for _ in range(10):
        fading = normal(rng, (33, USERS, 3)) / np.sqrt(3) @ paths
        gain, noise = reported(fading, 30.0, rng)
        lost = rng.random(gain.shape) < 0.2
        seen = ChannelObservation(
            gain=np.where(lost, np.nan, gain),
            noise_variance=np.where(lost, np.nan, noise),
            subcarrier_frequencies_hz=FREQUENCIES_HZ,
        )
        truth = np.abs(fading[-1]) ** 2
        for i, repairer in enumerate((LearnedCovariance(), Predictor(), Kriging())):
            errors[i] += np.sum((repairer.repair(seen).gain - truth)[lost[-1]] ** 2)
    learned, predicted, kriged = np.sqrt(errors)
    assert learned < 0.6 * kriged
    assert predicted < 0.6 * kriged


def test_held_parameters_repair_the_next_slot_as_well() -> None:
    rng = np.random.default_rng(9)
    made = root(exponential(200e-9))
    slots = [np.abs(normal(rng, (USERS, SUBCARRIERS)) @ made.T) ** 2 for _ in range(20)]
    lost = [lost_at_random(rng, 0.2) for _ in slots]
    held = Kriging().hold(ChannelObservation(gain=np.where(lost[0], np.nan, slots[0])))
    errors = np.zeros(3)
    for gain, hole in zip(slots[1:], lost[1:], strict=True):
        seen = ChannelObservation(gain=np.where(hole, np.nan, gain))
        for i, repairer in enumerate((held, Kriging(), Nncf())):
            errors[i] += np.sum((repairer.repair(seen).gain - gain)[hole] ** 2)
    assert errors[0] < 1.3 * errors[1]
    assert errors[0] < errors[2]


def test_correlated_users_help_each_other() -> None:
    rng = np.random.default_rng(13)
    made = root(exponential(1000e-9))
    errors = np.zeros(3)
    for _ in range(25):
        common, own = normal(rng, (1, SUBCARRIERS)), normal(rng, (USERS, SUBCARRIERS))
        gain = np.abs((np.sqrt(0.9) * common + np.sqrt(0.1) * own) @ made.T) ** 2
        lost = lost_at_random(rng, 0.2)
        seen = ChannelObservation(gain=np.where(lost, np.nan, gain), subcarrier_frequencies_hz=FREQUENCIES_HZ)
        for i, repairer in enumerate((Kriging(), Nncf(), Linear())):
            errors[i] += np.sum((repairer.repair(seen).gain - gain)[lost] ** 2)
    assert np.sqrt(errors[0] / errors[2]) < 0.65
    assert errors[0] < errors[1]


@pytest.mark.parametrize("late_s", [None, 2e-3], ids=["missing slot", "late slot"])
def test_predicted_neighbours_are_wrong_together(late_s: float | None) -> None:
    """A sum of rates over neighbours stays below its 5 % quantile as often, and that is right only for joint errors."""
    below = []
    for draw in range(60):
        scene = wa.simulate(
            "rayleigh", wa.Cell(), num_users=4, num_subcarriers=20, num_slots=12, rms_delay_spread_s=100e-9,
            speed_km_per_h=30, snr_db=30, seed=draw,
        )  # fmt: skip
        slots = scene.truth
        assert slots is not None
        gain = np.where(np.random.default_rng(draw).random(slots.shape) < 0.2, np.nan, scene.sensed.slots)
        kept = gain[:-2] if late_s else np.concatenate([gain[:-1], np.full_like(gain[-1:], np.nan)])
        times = scene.sensed.slot_times_s
        assert times is not None
        seen = dataclasses.replace(scene.sensed, gain=kept, slot_times_s=times[: len(kept)], noise_variance=None)
        estimate = Predictor().repair(seen, at_s=float(times[-1]) if late_s else None)
        for user in range(4):
            entries = np.arange(4, 10)
            drawn = np.log1p(1e12 * estimate.posterior.samples_of(user, entries, 500, seed=1)).sum(axis=1)
            below.append(np.log1p(1e12 * slots[-1][user, entries]).sum() < np.quantile(drawn, 0.05))
    assert np.mean(below) < 0.1


def test_exact_histories_of_fast_users_are_no_worse_than_the_current_slot_alone() -> None:
    """Without noise nothing hides what a model of the motion gets wrong, such as gaps in the past."""
    errors = np.zeros(2)
    for draw in range(12):
        scene = wa.simulate(
            "rayleigh", wa.Cell(), num_users=4, num_subcarriers=20, num_slots=16, rms_delay_spread_s=100e-9,
            speed_km_per_h=30, seed=draw,
        )  # fmt: skip
        truth = scene.current_truth
        assert truth is not None
        seen = scene.observe(wa.loss.random(0.2), seed=draw)
        for i, repairer in enumerate((Predictor(), Kriging())):
            estimate = repairer.repair(seen)
            errors[i] += np.sum(((estimate.gain - truth) / truth.mean(axis=1, keepdims=True)) ** 2)
    assert np.sqrt(errors[0] / errors[1]) < 1.1


@pytest.mark.parametrize("strength", [1.0, 4.0])
def test_entries_that_are_missing_because_they_are_weak_are_estimated_as_weak(strength: float) -> None:
    """The linear estimate with everything known does not know why entries are missing; kriging finds out."""
    rng = np.random.default_rng(17)
    covariance = exponential(300e-9)
    made, correlation = root(covariance), np.abs(covariance) ** 2
    errors, below, count = np.zeros(2), 0, 0
    for _ in range(60):
        gain = np.abs(normal(rng, (USERS, SUBCARRIERS)) @ made.T) ** 2
        lost = rng.random(gain.shape) < 0.6 * np.exp(-strength * gain)
        seen = ChannelObservation(gain=np.where(lost, np.nan, gain), subcarrier_frequencies_hz=FREQUENCIES_HZ)
        estimate = Kriging().repair(seen)
        errors[0] += np.sum((estimate.gain - gain)[lost] ** 2)
        below += int(np.sum(gain[lost] < estimate.posterior.quantile(0.05)[lost]))
        count += int(lost.sum())
        for user, hole in enumerate(lost):
            inner = correlation[np.ix_(~hole, ~hole)] + 1e-6 * np.eye(int((~hole).sum()))
            linear = 1.0 + correlation[np.ix_(hole, ~hole)] @ np.linalg.solve(inner, gain[user, ~hole] - 1.0)
            errors[1] += np.sum((linear - gain[user, hole]) ** 2)
    assert errors[0] < errors[1]
    assert below / count < 0.16


def test_what_is_not_said_to_be_noise_is_part_of_the_gain() -> None:
    """With variations that no neighbour tells of, a band holds what would be measured; stated noise is left out."""
    rng = np.random.default_rng(19)
    made = root(exponential(50e-9))
    inside, width = 0, np.zeros(2)
    holes = 0
    for _ in range(60):
        smooth = np.abs(normal(rng, (USERS, SUBCARRIERS)) @ made.T) ** 2 + 0.5
        gain = np.abs(smooth + 0.3 * rng.standard_normal(smooth.shape))
        lost = lost_at_random(rng, 0.2)
        seen = ChannelObservation(gain=np.where(lost, np.nan, gain), subcarrier_frequencies_hz=FREQUENCIES_HZ)
        posterior = Kriging().repair(seen).posterior
        low, high = posterior.quantile(0.05)[lost], posterior.quantile(0.95)[lost]
        inside += int(np.sum((gain[lost] >= low) & (gain[lost] <= high)))
        holes += int(lost.sum())
        stated = dataclasses.replace(seen, noise_variance=np.where(lost, np.nan, 0.09))
        known = Kriging().repair(stated).posterior
        width += np.sum(high - low), np.sum(known.quantile(0.95)[lost] - known.quantile(0.05)[lost])
    assert inside / holes > 0.85
    assert width[1] < 0.8 * width[0]

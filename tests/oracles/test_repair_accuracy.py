"""How good the repairs are, and whether they know it: Monte-Carlo over exactly drawn channels.

Rayleigh fading with the exponential power-delay profile's covariance 1/(1 + j2πΔfτ), independent users (unless said)
with levels 30 dB apart, 180 kHz spacing, 8 × 20. The error is the RMSE over missing entries, each in units of its
user's mean true gain (the ensemble mean).
"""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pytest

from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.linear import Linear
from wirelessagent.repairing.nncf import Nncf
from wirelessagent.repairing.nncf_paper import NncfPaper
from wirelessagent.repairing.repairer import Repairer
from wirelessagent.repairing.user_mean import UserMean

SHAPE = (8, 20)


def coefficients(delay_spread_s: float, draws: int, seed: int, correlation: float = 0.0) -> np.ndarray:
    """Complex coefficients of unit power, shape (draw, user, subcarrier)."""
    rng = np.random.default_rng(seed)
    n = np.arange(SHAPE[1])
    covariance = 1 / (1 + 2j * np.pi * 180e3 * delay_spread_s * (n[:, np.newaxis] - n))
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))

    def white(*shape: int) -> np.ndarray:
        return (rng.normal(size=shape) + 1j * rng.normal(size=shape)) / np.sqrt(2)

    own, shared = white(draws, *SHAPE), white(draws, 1, SHAPE[1])
    return (np.sqrt(1 - correlation) * own + np.sqrt(correlation) * shared) @ root.T


def errors(
    repairer: Repairer, delay_spread_s: float, *, draws: int, spread_db: float = 30.0, correlation: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Normalised errors of the missing entries of all draws, and the variances stated for them."""
    gain = np.abs(coefficients(delay_spread_s, draws, seed=1, correlation=correlation)) ** 2
    rng = np.random.default_rng(2)
    level = 10 ** (-10 + spread_db / 10 * rng.random((draws, SHAPE[0], 1)))
    missing = rng.random(gain.shape) < 0.2
    found, stated = [], []
    for truth, mean, lost in zip(gain * level, level, missing, strict=True):
        estimate = repairer.repair(ChannelObservation(gain=np.where(lost, np.nan, truth)))
        found.append(((estimate.gain - truth) / mean)[lost])
        stated.append((estimate.gain_variance / mean**2)[lost])
    return np.concatenate(found), np.concatenate(stated)


@functools.cache
def rmse(repairer: Repairer, delay_spread_s: float, draws: int, correlation: float = 0.0) -> float:
    found, _ = errors(repairer, delay_spread_s, draws=draws, correlation=correlation)
    return float(np.sqrt(np.mean(found**2)))


def test_nncf_cuts_the_error_of_the_user_mean_by_two_thirds() -> None:
    assert rmse(Nncf(), 100e-9, 2000) <= (1 - 0.67) * rmse(UserMean(), 100e-9, 2000)


@pytest.mark.parametrize("delay_spread_s", [30e-9, 300e-9, 1000e-9])
def test_nncf_is_nowhere_clearly_worse_than_its_rivals(delay_spread_s: float) -> None:
    rivals = min(rmse(Linear(), delay_spread_s, 500), rmse(UserMean(), delay_spread_s, 500))
    assert rmse(Nncf(), delay_spread_s, 500) <= 1.1 * rivals


@pytest.mark.parametrize("delay_spread_s", [30e-9, 300e-9, 1000e-9])
def test_nncf_uses_correlated_users(delay_spread_s: float) -> None:
    alone = rmse(Nncf(), delay_spread_s, 300)
    assert rmse(Nncf(), delay_spread_s, 300, correlation=0.9) <= 0.7 * alone


def test_the_literal_rule_is_far_worse_than_the_user_mean() -> None:
    assert rmse(NncfPaper(), 100e-9, 300) > 10 * rmse(UserMean(), 100e-9, 300)


@pytest.mark.parametrize("delay_spread_s", [30e-9, 100e-9, 300e-9, 1000e-9])
@pytest.mark.parametrize("repairer", [UserMean(), Linear(), Nncf()], ids=lambda r: r.name)
def test_the_stated_variance_is_the_error(repairer: Repairer, delay_spread_s: float) -> None:
    found, stated = errors(repairer, delay_spread_s, draws=500)
    assert 0.8 < np.mean(found**2) / np.mean(stated) < 1.25


@pytest.mark.parametrize("delay_spread_s", [100e-9, 300e-9, 1000e-9])
@pytest.mark.parametrize("repairer", [Linear(), Nncf()], ids=lambda r: r.name)
def test_no_entry_is_stated_far_too_certain(repairer: Repairer, delay_spread_s: float) -> None:
    found, stated = errors(repairer, delay_spread_s, draws=300)
    assert np.mean(found**2 / stated) < 2.0
    assert np.mean(found**2 > 25 * stated) < 0.005


@pytest.mark.parametrize(("delay_spread_s", "snr"), [(30e-9, 10.0), (30e-9, 100.0), (100e-9, 100.0)])
@pytest.mark.parametrize("repairer", [Linear(), Nncf()], ids=lambda r: r.name)
def test_measurement_noise_is_not_taken_for_fading(repairer: Repairer, delay_spread_s: float, snr: float) -> None:
    """Reports are conditional means of the gain, given the coefficient and complex Gaussian noise.

    They leave it open whether a channel is as flat as at 30 ns: the variance may be somewhat too wide there.
    """
    rng = np.random.default_rng(7)
    fading = coefficients(delay_spread_s, 300, seed=6)
    noise = (rng.normal(size=fading.shape) + 1j * rng.normal(size=fading.shape)) / np.sqrt(2 * snr)
    power, left = np.abs((fading + noise) * snr / (1 + snr)) ** 2, 1 / (1 + snr)
    lost = rng.random(fading.shape) < 0.2
    found, stated = [], []
    for truth, seen, missing in zip(np.abs(fading) ** 2, power, lost, strict=True):
        gain = np.where(missing, np.nan, seen + left)
        variance = np.where(missing, np.nan, 2 * seen * left + left**2)
        estimate = repairer.repair(ChannelObservation(gain=gain, noise_variance=variance))
        found.append((estimate.gain - truth)[missing])
        stated.append(estimate.gain_variance[missing])
    assert 0.68 < np.mean(np.concatenate(found) ** 2) / np.mean(np.concatenate(stated)) < 1.3


@pytest.mark.parametrize("delay_spread_s", [30e-9, 100e-9, 1000e-9])
def test_the_variance_is_honest_of_correlated_users(delay_spread_s: float) -> None:
    found, stated = errors(Nncf(), delay_spread_s, draws=300, correlation=0.9)
    assert 0.75 < np.mean(found**2) / np.mean(stated) < 1.3


def test_the_literal_rules_stated_variance_is_the_error() -> None:
    found, stated = errors(NncfPaper(), 300e-9, draws=500, spread_db=0.0)
    assert 0.8 < np.mean(found**2) / np.mean(stated) < 1.25


@pytest.mark.parametrize("repairer", [Linear(), Nncf()], ids=lambda r: r.name)
@pytest.mark.parametrize("delay_spread_s", [100e-9, 300e-9, 1000e-9])
def test_the_variance_is_honest_of_fades_and_of_peaks(repairer: Repairer, delay_spread_s: float) -> None:
    """A single variance for all would be six times too wide in fades and three times too narrow on peaks."""
    gain = np.abs(coefficients(delay_spread_s, 500, seed=3)) ** 2
    lost = np.random.default_rng(4).random(gain.shape) < 0.2
    estimates = [
        repairer.repair(ChannelObservation(gain=np.where(mask, np.nan, truth)))
        for truth, mask in zip(gain, lost, strict=True)
    ]
    estimated = np.array([e.gain for e in estimates])[lost]
    stated = np.array([e.gain_variance for e in estimates])[lost]
    squared = (estimated - gain[lost]) ** 2
    edges = np.quantile(estimated, [0.0, 0.2, 0.8, 1.0])
    for low, high in itertools.pairwise(edges):
        chosen = (estimated >= low) & (estimated <= high)
        assert 0.5 < squared[chosen].mean() / stated[chosen].mean() < 2.0


def test_linear_knows_where_interpolation_is_a_bad_idea() -> None:
    """Without correlation over frequency, interpolating far from the mean costs the squared distance from it."""
    rng = np.random.default_rng(12)
    squared, stated = [], []
    for _ in range(200):
        truth = rng.exponential(size=(8, 40))
        lost = rng.random(truth.shape) < 0.2
        estimate = Linear().repair(ChannelObservation(gain=np.where(lost, np.nan, truth)))
        far = lost & (estimate.gain > 2.0)
        squared.append((estimate.gain - truth)[far] ** 2)
        stated.append(estimate.gain_variance[far])
    assert 0.8 < np.concatenate(squared).mean() / np.concatenate(stated).mean() < 1.25


def surprises(repairer: Repairer, delay_spread_s: float, *, loss: float, step_db: float, spread_db: float) -> float:
    """Mean of (true − estimate)²/variance over the missing entries of 200 draws, reports rounded to ``step_db``."""
    rng = np.random.default_rng(2)
    fading = np.abs(coefficients(delay_spread_s, 200, seed=1)) ** 2
    gain = fading * 10 ** (-10 + spread_db / 10 * rng.random((200, SHAPE[0], 1)))
    reported = 10 ** (np.round(10 * np.log10(gain) / step_db) * step_db / 10) if step_db else gain
    missing = rng.random(gain.shape) < loss
    found = []
    for truth, report, lost in zip(gain, reported, missing, strict=True):
        estimate = repairer.repair(ChannelObservation(gain=np.where(lost, np.nan, report)))
        found.append((truth - estimate.gain)[lost] ** 2 / estimate.gain_variance[lost])
    return float(np.mean(np.concatenate(found)))


@pytest.mark.parametrize("repairer", [UserMean(), Linear(), Nncf(), NncfPaper()], ids=lambda r: r.name)
@pytest.mark.parametrize("step_db", [0.0, 3.0])
@pytest.mark.parametrize(("delay_spread_s", "spread_db"), [(100e-9, 0.0), (300e-9, 0.0), (1e-6, 0.0), (1e-6, 30.0)])
def test_few_reports_are_known_to_say_little(
    repairer: Repairer, delay_spread_s: float, step_db: float, spread_db: float
) -> None:
    """Four reports a user, most often: a level measured in a fade, or agreement by chance, must not pass for proof."""
    assert 0.3 < surprises(repairer, delay_spread_s, loss=0.8, step_db=step_db, spread_db=spread_db) < 3.0


@pytest.mark.parametrize("repairer", [Linear(), Nncf()], ids=lambda r: r.name)
def test_rounded_reports_at_low_loss_keep_their_variance_honest(repairer: Repairer) -> None:
    assert 0.5 < surprises(repairer, 100e-9, loss=0.2, step_db=3.0, spread_db=30.0) < 1.5


@pytest.mark.parametrize("repairer", [UserMean(), Linear(), Nncf(), NncfPaper()], ids=lambda r: r.name)
def test_two_equal_neighbours_prove_no_flat_channel(repairer: Repairer) -> None:
    nan = np.nan
    gain = np.array([[nan, 1e-9, nan, nan], [nan, 1e-9, 1e-9, nan]])
    estimate = repairer.repair(ChannelObservation(gain=gain))
    spread = np.sqrt(estimate.gain_variance[estimate.repaired])
    assert np.all(spread > 0.1 * 1e-9)

"""Rates that are committed on uncertain channels: what of them arrives, and what they are chosen from."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.special import exp1

import wirelessagent as wa
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.fading_posterior import MEAN_LOGS, tabulated
from wirelessagent.model.rates import user_rate_bps

CELL = wa.Cell()
SNR_PER_GAIN = 1.0 / CELL.noise_power_w


def estimated(gain: FloatArray, variance: FloatArray) -> wa.ChannelEstimate:
    """An estimate whose uncertain gains are independent Rician powers."""
    return wa.ChannelEstimate(
        gain=gain,
        gain_variance=variance,
        repaired=variance > 0,
        unobserved_users=np.zeros(len(gain), dtype=bool),
        user_names=tuple(f"user {user + 1}" for user in range(len(gain))),
        method="test",
        joint_posterior=wa.FadingPosterior(gain, variance),
    )


def seen(seed: int, delay_spread_s: float = 300e-9) -> tuple[wa.Scene, wa.ChannelEstimate]:
    scene = wa.simulate("rayleigh", num_users=8, num_subcarriers=20, rms_delay_spread_s=delay_spread_s, seed=seed)
    return scene, wa.repair(scene.observe(wa.loss.random(0.3), seed=seed))


@pytest.mark.parametrize("objective", ["max_rate", "proportional_fairness", "min_power"])
def test_certain_channels_are_decided_and_committed_as_they_are(objective: str) -> None:
    scene, _ = seen(1)
    problem = wa.Problem(objective, min_rate_bps=2e5 if objective == "min_power" else None)
    decision = wa.decide(wa.perfect(scene), problem, scene.cell)
    alone = Dual().solve(wa.perfect(scene), decision.problem, scene.cell)
    assert decision.power_w.tobytes() == alone.power_w.tobytes()
    assert (decision.value, decision.bound) == (alone.value, alone.bound)
    assert decision.forecast is None
    assert decision.committed_bps is decision.rate_bps


def test_the_commitment_is_that_of_which_most_is_expected_to_arrive() -> None:
    mean = 1e-10
    decision = wa.decide(estimated(np.array([[mean]]), np.array([[mean**2]])), wa.Problem("max_rate"), CELL)
    snr, bandwidth = mean * SNR_PER_GAIN * CELL.max_power_w, CELL.subcarrier_bandwidth_hz

    def arriving(rate: float) -> float:
        return rate * float(np.exp(-np.expm1(rate / bandwidth * np.log(2.0)) / snr))  # exponential gain

    best = minimize_scalar(lambda rate: -arriving(rate), bounds=(1.0, 20 * bandwidth), method="bounded").x
    forecast = decision.forecast
    assert forecast is not None
    assert arriving(forecast.committed_bps[0]) == pytest.approx(arriving(best), rel=2e-3)
    assert forecast.committed_bps[0] * forecast.carried[0] == pytest.approx(arriving(best), rel=0.02)
    mean_bps = bandwidth / np.log(2.0) * np.exp(1.0 / snr) * exp1(1.0 / snr)
    assert forecast.mean_bps[0] == pytest.approx(mean_bps, rel=0.01)
    assert forecast.low_bps[0] < forecast.committed_bps[0] < forecast.mean_bps[0] < forecast.high_bps[0]


def test_the_value_is_the_mean_rate() -> None:
    for seed in range(5):
        _, estimate = seen(seed)
        decision = wa.decide(estimate, wa.Problem("max_rate"), CELL)
        assert decision.forecast is not None
        assert decision.value == pytest.approx(decision.forecast.mean_bps.sum(), rel=3e-3)
        carried_by_means = user_rate_bps(estimate.gain, decision.owner, decision.power_w, CELL).sum()
        assert decision.value < carried_by_means
        assert decision.value <= decision.bound


def test_of_two_gains_of_one_mean_the_surer_one_is_chosen() -> None:
    gain = np.full((2, 1), 1e-10)
    for sure in (0, 1):
        variance = np.where(np.arange(2)[:, np.newaxis] == sure, 0.0, gain**2)
        assert wa.decide(estimated(gain, variance), wa.Problem("max_rate"), CELL).owner.tolist() == [sure]


def test_commitments_lie_between_what_was_promised_and_what_can_be_used() -> None:
    _, estimate = seen(2)
    promised = wa.decide(estimate, wa.Problem("max_rate", min_rate_bps=3e5), CELL)
    assert np.all(promised.committed_bps >= 3e5)
    limited = wa.decide(estimate, wa.Problem("proportional_fairness", max_rate_bps=2e6), CELL)
    assert np.all(limited.committed_bps <= 2e6)
    least = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=3e5), CELL)
    assert least.forecast is not None
    assert least.committed_bps.tobytes() == least.rate_bps.tobytes()
    sure = wa.decide(estimate, wa.Problem("max_rate", outage_probability=0.05), CELL)
    assert sure.committed_bps.tobytes() == sure.rate_bps.tobytes()


def test_what_is_committed_arrives_as_often_as_forecast() -> None:
    carried, forecast, share, point = [], [], [], []
    for seed in range(150):
        scene, estimate = seen(seed)
        decision = wa.decide(estimate, wa.Problem("max_rate"), scene.cell)
        outcome = wa.SimulatedBaseStation(scene).apply(decision)
        if decision.forecast is None or outcome.achieved is None:
            continue
        unsure = decision.forecast.carried < 1
        carried += (~outcome.missed[unsure]).tolist()
        forecast += decision.forecast.carried[unsure].tolist()
        share.append(outcome.achieved.goodput_bps / outcome.achieved.sum_rate_bps)
        naive = dataclasses.replace(decision, estimate=None)
        at_the_mean = wa.SimulatedBaseStation(scene).apply(naive).achieved
        assert at_the_mean is not None
        point.append(at_the_mean.goodput_bps / at_the_mean.sum_rate_bps)
    assert np.mean(carried) == pytest.approx(np.mean(forecast), abs=0.03)
    assert np.mean(share) > 0.95 > 0.8 > np.mean(point)


def test_the_band_holds_nine_times_out_of_ten() -> None:
    held, total = [], []
    for seed in range(150):
        scene, estimate = seen(seed)
        decision = wa.decide(estimate, wa.Problem("proportional_fairness"), scene.cell)
        forecast, achieved = decision.forecast, wa.SimulatedBaseStation(scene).apply(decision).achieved
        assert forecast is not None
        assert achieved is not None
        unsure = forecast.high_bps > forecast.low_bps * (1 + 1e-9)
        rate = achieved.user_rate_bps
        held += ((rate >= forecast.low_bps) & (rate <= forecast.high_bps))[unsure].tolist()
        total.append(forecast.sum_low_bps <= rate.sum() <= forecast.sum_high_bps)
    assert 0.84 < np.mean(held) < 0.96
    assert 0.8 < np.mean(total) < 0.97


def test_forecasts_are_the_same_again() -> None:
    _, estimate = seen(3)
    first, again = (wa.decide(estimate, wa.Problem("max_rate"), CELL).forecast for _ in range(2))
    assert first is not None
    assert again is not None
    assert first.committed_bps.tobytes() == again.committed_bps.tobytes()


def test_the_table_that_is_kept_is_the_one_that_would_be_made() -> None:
    assert np.allclose(np.load(MEAN_LOGS), tabulated().factor, rtol=1e-12, atol=0)


@pytest.mark.parametrize("posterior", [wa.FadingPosterior, wa.GammaPosterior])
def test_mean_logarithms_are_those_of_draws(posterior: type[wa.FadingPosterior | wa.GammaPosterior]) -> None:
    spread, snr = np.meshgrid([0.0, 1e-3, 0.05, 0.3, 0.8, 1.0, 1.2], np.geomspace(1e-2, 1e6, 5), indexing="ij")
    mean = np.full(spread.shape, 1e-9)
    known = posterior(mean, spread * mean**2)
    drawn = np.log1p(snr * known.samples(100_000, seed=1) / mean)
    error = drawn.std(axis=0) / np.sqrt(len(drawn))
    assert np.all(np.abs(known.expected_log1p(snr / mean) - drawn.mean(axis=0)) < 5 * error + 2e-3)
    assert np.array_equal(known.expected_log1p(snr / mean)[0], np.log1p(snr[0]))

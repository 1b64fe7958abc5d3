"""The simulated cell: its statistics are what its docstring says, within sampling error at fixed seeds."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from scipy.special import j0
from scipy.stats import kstest

from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.scene import Scene
from wirelessagent.sensing import loss
from wirelessagent.sensing.fading import delay_taps, rayleigh_fading, time_root
from wirelessagent.sensing.rayleigh import MAX_GAINS, Rayleigh, path_loss_db

CELL = Cell()


def still(num_users: int = 20_000, **options: Any) -> Rayleigh:
    """A source without spread between users, so that their gains over the path loss are plain fading."""
    return Rayleigh(num_users=num_users, inner_radius_m=100.0, outer_radius_m=100.0, shadowing_std_db=0.0, **options)


def fading_gain(source: Rayleigh, *, seed: int = 1) -> np.ndarray:
    """|h|² of a source made by :func:`still`."""
    return truth_of(source.observe(CELL, seed=seed)) * 10 ** (path_loss_db(np.array(100.0)) / 10)


def truth_of(scene: Scene) -> np.ndarray:
    assert scene.truth is not None
    return scene.truth


def correlation(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.corrcoef(first, second)[0, 1])


# Shapes, axes and seeds


def test_defaults_are_the_papers() -> None:
    scene = Rayleigh().observe(CELL)
    assert truth_of(scene).shape == scene.sensed.gain.shape == (8, 20)
    assert scene.sensed.slot_times_s is None
    assert scene.sensed.noise_variance is None
    np.testing.assert_array_equal(scene.sensed.gain, truth_of(scene))


def test_axes_follow_the_cell_the_carrier_and_the_slots() -> None:
    source = Rayleigh(num_users=3, num_subcarriers=5, num_slots=4, slot_s=0.5e-3, carrier_hz=2e9)
    scene = source.observe(Cell(subcarrier_bandwidth_hz=360e3))
    assert truth_of(scene).shape == (4, 3, 5)
    assert scene.sensed.subcarrier_frequencies_hz is not None
    assert scene.sensed.subcarrier_frequencies_hz.mean() == 2e9
    np.testing.assert_allclose(np.diff(scene.sensed.subcarrier_frequencies_hz), 360e3, rtol=1e-9)
    np.testing.assert_allclose(scene.sensed.slot_times_s, [0, 0.5e-3, 1e-3, 1.5e-3], rtol=1e-12)


FULL = Rayleigh(num_slots=3, speed_km_per_h=30, user_correlation=0.5, snr_db=20)


@pytest.mark.parametrize("source", [Rayleigh(), FULL])
def test_same_seed_same_scene(source: Rayleigh) -> None:
    first, again, other = (source.observe(CELL, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(truth_of(first), truth_of(again))
    np.testing.assert_array_equal(first.sensed.gain, again.sensed.gain)
    assert first.facts == again.facts
    assert not np.any(truth_of(first) == truth_of(other))


@pytest.mark.parametrize("source", [Rayleigh(), FULL])
def test_more_users_leave_the_first_ones_as_they_were(source: Rayleigh) -> None:
    few = dataclasses.replace(source, num_users=3).observe(CELL, seed=5)
    many = dataclasses.replace(source, num_users=11).observe(CELL, seed=5)
    np.testing.assert_allclose(truth_of(many)[..., :3, :], truth_of(few), rtol=1e-9)
    np.testing.assert_allclose(many.sensed.gain[..., :3, :], few.sensed.gain, rtol=1e-9)


def test_noise_and_correlation_do_not_change_what_else_was_drawn() -> None:
    plain = Rayleigh(num_slots=2).observe(CELL, seed=2)
    noisy = Rayleigh(num_slots=2, snr_db=10).observe(CELL, seed=2)
    np.testing.assert_array_equal(truth_of(plain), truth_of(noisy))
    assert noisy.facts["users"] == Rayleigh(user_correlation=0.7).observe(CELL, seed=2).facts["users"]


def test_facts_say_what_was_drawn() -> None:
    facts = Rayleigh(num_slots=16, speed_km_per_h=3, user_correlation=0.9, snr_db=30).observe(CELL, seed=1).facts
    assert facts["users"].startswith("8, uniform by area in 35–300 m, drawn at ")
    assert "100 ns rms delay spread" in facts["fading"]
    assert "Doppler 9.73 Hz" in facts["slots"]
    assert facts["users' correlation"] == "0.9 between fading coefficients"
    assert facts["measurement"] == "30 dB SNR"
    assert Rayleigh().observe(CELL).facts["measurement"] == "exact"


# Large scale


def test_mean_gain_is_the_path_loss() -> None:
    gain = fading_gain(still())
    assert path_loss_db(np.array(100.0)) == pytest.approx(128.1 - 37.6, rel=1e-12)
    assert gain.mean() == pytest.approx(1.0, abs=4 / np.sqrt(20_000))


def ratio_db(first: Rayleigh, second: Rayleigh) -> np.ndarray:
    """Gains over gains of one seed in dB: what differs between two sources, as the fading is the same."""
    return 10 * np.log10(truth_of(first.observe(CELL, seed=6)) / truth_of(second.observe(CELL, seed=6)))[:, 0]


def test_users_are_uniform_by_area() -> None:
    ring = still(num_subcarriers=1)
    level_db = ratio_db(dataclasses.replace(ring, inner_radius_m=35.0, outer_radius_m=300.0), ring)
    distance_m = 100 * 10 ** (-level_db / 37.6)
    assert kstest((distance_m**2 - 35**2) / (300**2 - 35**2), "uniform").pvalue > 0.01
    assert 35 < distance_m.min() < 37
    assert 299 < distance_m.max() < 300


def test_shadowing_is_log_normal() -> None:
    clear = still(num_subcarriers=1)
    level_db = ratio_db(dataclasses.replace(clear, shadowing_std_db=6.0), clear)
    assert level_db.std() == pytest.approx(6.0, rel=4 / np.sqrt(2 * 20_000))
    assert kstest(level_db / 6.0, "norm").pvalue > 0.01


# Fading


def test_gains_are_exponential() -> None:
    gain = fading_gain(still())
    for subcarrier in (0, 10, 19):
        assert kstest(gain[:, subcarrier], "expon").pvalue > 0.01


def test_coefficients_are_circular_and_correlated_as_the_profile_says() -> None:
    """E[h(f) h*(f')] = 1/(1 + j2πΔfτ), the imaginary part with its sign."""
    h = rayleigh_fading(
        np.random.default_rng(7),
        num_users=40_000, num_slots=1, num_subcarriers=6, subcarrier_spacing_hz=180e3,
        rms_delay_spread_s=500e-9, doppler_hz=0.0, slot_s=1e-3,
    )[:, 0]  # fmt: skip
    apart = np.arange(6)
    measured = (h * h[:, :1].conj()).mean(axis=0)
    np.testing.assert_allclose(measured, 1 / (1 + 2j * np.pi * apart * 180e3 * 500e-9), atol=4 / np.sqrt(40_000))
    np.testing.assert_allclose((h * h[:, :1]).mean(axis=0), 0, atol=6 / np.sqrt(40_000))


@pytest.mark.parametrize("spread_s", [30e-9, 100e-9, 300e-9, 1000e-9])
def test_gain_correlation_over_frequency(spread_s: float) -> None:
    gain = fading_gain(still(rms_delay_spread_s=spread_s))
    for apart in (1, 2, 5, 19):
        expected = 1 / (1 + (2 * np.pi * apart * 180e3 * spread_s) ** 2)
        assert correlation(gain[:, 0], gain[:, apart]) == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize("spread", [0.0, 1e-6, 0.0054, 0.018, 0.0249, 0.0251, 0.18, 30.0])
@pytest.mark.parametrize("num_subcarriers", [1, 2, 20, 273])
def test_taps_have_the_exact_covariance(num_subcarriers: int, spread: float) -> None:
    taps = delay_taps(num_subcarriers, spread)
    response = taps.amplitude[..., np.newaxis] * taps.panel_phase * taps.node_phase[:, np.newaxis]
    response = response.reshape(-1, num_subcarriers)
    apart = np.subtract.outer(np.arange(num_subcarriers), np.arange(num_subcarriers))
    np.testing.assert_allclose(response.T @ response.conj(), 1 / (1 + 2j * np.pi * apart * spread), atol=1e-12)


def test_taps_are_exact_over_a_wide_band() -> None:
    """3,276 subcarriers of 30 kHz at 300 ns, first column of the covariance."""
    taps = delay_taps(3276, 30e3 * 300e-9)
    first = (taps.amplitude**2)[..., np.newaxis] * taps.panel_phase
    covariance = np.einsum("ipn,in->n", first, taps.node_phase)
    np.testing.assert_allclose(covariance, 1 / (1 + 2j * np.pi * np.arange(3276) * 30e3 * 300e-9), atol=1e-12)


def test_flat_fading_without_delay_spread() -> None:
    gain = fading_gain(still(50, rms_delay_spread_s=0.0))
    np.testing.assert_allclose(gain, gain[:, :1].repeat(20, axis=1), rtol=1e-12)
    assert gain[:, 0].std() > 0.5


def test_large_draws_are_made_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = fading_gain(still(50))
    monkeypatch.setattr("wirelessagent.sensing.fading._BLOCK", 3 * 32 * 20)
    np.testing.assert_allclose(fading_gain(still(50)), whole, rtol=1e-9)


@pytest.mark.parametrize("speed_km_per_h", [3.0, 30.0, 120.0])
def test_gain_correlation_over_time(speed_km_per_h: float) -> None:
    source = still(num_subcarriers=1, num_slots=11, speed_km_per_h=speed_km_per_h)
    gain = fading_gain(source)[..., 0]
    assert source.doppler_hz == pytest.approx(speed_km_per_h / 3.6 * 3.5e9 / 299_792_458, rel=1e-12)
    for apart in (1, 2, 5, 10):
        expected = j0(2 * np.pi * source.doppler_hz * apart * 1e-3) ** 2
        assert correlation(gain[0], gain[apart]) == pytest.approx(expected, abs=0.03)
    assert kstest(gain[-1], "expon").pvalue > 0.01


def test_frequency_and_time_correlations_multiply() -> None:
    source = still(num_subcarriers=4, num_slots=6, speed_km_per_h=20.0, rms_delay_spread_s=200e-9)
    gain = fading_gain(source)
    expected = j0(2 * np.pi * source.doppler_hz * 5e-3) ** 2 / (1 + (2 * np.pi * 3 * 180e3 * 200e-9) ** 2)
    assert correlation(gain[0, :, 0], gain[5, :, 3]) == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize("turns_per_slot", [1e-9, 0.0097, 0.3, 13.0])
def test_time_root_has_the_exact_covariance(turns_per_slot: float) -> None:
    root = time_root(60, turns_per_slot)
    apart = np.subtract.outer(np.arange(60), np.arange(60))
    np.testing.assert_allclose(root @ root.T, j0(2 * np.pi * turns_per_slot * apart), atol=1e-11)
    np.testing.assert_allclose(root, root.T, atol=1e-12)


def test_a_cell_at_rest_does_not_change() -> None:
    truth = truth_of(Rayleigh(num_slots=5).observe(CELL))
    np.testing.assert_array_equal(truth, np.broadcast_to(truth[0], truth.shape))


def test_user_correlation_is_of_coefficients() -> None:
    """Gains of two users are correlated by ρ²; subcarriers are as good as independent here."""

    def gains(rho: float) -> np.ndarray:
        source = still(2, rms_delay_spread_s=100e-6, user_correlation=rho)
        return np.concatenate([fading_gain(source, seed=seed) for seed in range(1000)], axis=1)

    first, second = gains(0.9)
    assert correlation(first, second) == pytest.approx(0.81, abs=0.02)
    assert (first.mean() + second.mean()) / 2 == pytest.approx(1.0, abs=0.03)
    assert correlation(*gains(0.0)) == pytest.approx(0.0, abs=0.03)


# Measurement


@pytest.mark.parametrize("snr_db", [0.0, 10.0, 30.0])
def test_noise_variance_is_honest(snr_db: float) -> None:
    """Errors have no bias and the stated variance, overall and among the weakest and strongest tenth measured."""
    scene = still(3000, snr_db=snr_db).observe(CELL, seed=8)
    assert scene.sensed.noise_variance is not None
    unit = 10 ** (path_loss_db(np.array(100.0)) / 10)
    seen, true = scene.sensed.gain.ravel() * unit, truth_of(scene).ravel() * unit
    stated = scene.sensed.noise_variance.ravel() * unit**2
    order = np.argsort(seen)
    for part in (order, order[:6000], order[-6000:]):
        error = true[part] - seen[part]
        assert error.mean() == pytest.approx(0.0, abs=6 * np.sqrt(stated[part].mean() / part.size))
        assert np.mean(error**2) == pytest.approx(stated[part].mean(), rel=0.12)
    snr = 10 ** (snr_db / 10)
    assert stated.mean() == pytest.approx((2 * snr + 1) / (1 + snr) ** 2, rel=0.05)


def test_measured_gains_are_positive_and_near_the_truth() -> None:
    for snr_db in (-60.0, 30.0):
        scene = Rayleigh(num_users=50, num_slots=4, speed_km_per_h=3, snr_db=snr_db).observe(CELL, seed=1)
        assert scene.sensed.gain.min() > 0
        assert scene.sensed.noise_variance is not None
        assert scene.sensed.noise_variance.shape == scene.sensed.gain.shape
    scene = Rayleigh(snr_db=150.0).observe(CELL)
    np.testing.assert_allclose(scene.sensed.gain, truth_of(scene), rtol=1e-5)


def test_a_lost_entry_keeps_nothing_back() -> None:
    """Its noise variance would give the gain away."""
    scene = Rayleigh(snr_db=20.0, num_slots=2).observe(CELL, seed=1)
    seen = scene.observe(loss.random(0.3), seed=1)
    assert seen.noise_variance is not None
    assert scene.sensed.noise_variance is not None
    lost = np.isnan(seen.gain)
    assert lost.any()
    np.testing.assert_array_equal(np.isnan(seen.noise_variance), lost)
    np.testing.assert_array_equal(seen.noise_variance[~lost], scene.sensed.noise_variance[~lost])


# Bad input


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("num_users", 0), ("num_users", 2.5), ("num_users", "many"), ("num_subcarriers", 0), ("num_slots", -1),
        ("inner_radius_m", 0.0), ("inner_radius_m", 301.0), ("outer_radius_m", np.inf), ("outer_radius_m", 1e9),
        ("shadowing_std_db", -1.0), ("shadowing_std_db", np.nan), ("shadowing_std_db", 1e3),
        ("user_correlation", 1.0), ("user_correlation", -0.1), ("rms_delay_spread_s", -1e-9),
        ("rms_delay_spread_s", 100.0), ("speed_km_per_h", -3.0), ("speed_km_per_h", 1e9), ("carrier_hz", 0.0),
        ("carrier_hz", 1e20), ("slot_s", 0.0), ("slot_s", 1e9), ("snr_db", np.nan), ("snr_db", np.inf),
        ("snr_db", "loud"),
    ],
)  # fmt: skip
def test_bad_fields_are_refused_by_name(field: str, value: object) -> None:
    options: dict[str, Any] = {field: value}
    with pytest.raises(InputError, match="inner_radius_m" if value == 301.0 else field):
        Rayleigh(**options)


def test_a_scene_that_would_fill_the_memory_is_refused() -> None:
    with pytest.raises(InputError, match=f"more than {MAX_GAINS:,}"):
        Rayleigh(num_users=10**9)


@pytest.mark.parametrize("seed", [-1, 1.5])
def test_bad_seeds_are_refused(seed: Any) -> None:
    with pytest.raises(InputError, match="seed"):
        Rayleigh().observe(CELL, seed=seed)

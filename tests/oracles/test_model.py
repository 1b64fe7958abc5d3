"""The model against hand calculation: units, rates, metrics, and what its types refuse."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.special import exp1
from scipy.stats import expon

import wirelessagent as wa
from wirelessagent.model.arrays import frozen
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import energy_efficiency_bit_per_j, jain_index, kept
from wirelessagent.model.rates import (
    normalised_gain,
    owned_gain,
    subcarrier_rate_bps,
    useful_power_w,
    user_rate_bps,
)

EXACT = {"rel": 1e-14, "abs": 0.0}


# Units


@pytest.mark.parametrize(("ratio", "in_db"), [(1.0, 0.0), (2.0, 3.010299956639812), (1e-12, -120.0), (1e9, 90.0)])
def test_decibels_there_and_back(ratio: float, in_db: float) -> None:
    assert float(wa.units.db(ratio)) == pytest.approx(in_db, **EXACT)
    assert float(wa.units.from_db(in_db)) == pytest.approx(ratio, rel=1e-13, abs=0)


def test_zero_is_minus_infinity_decibels_or_the_floor() -> None:
    assert wa.units.db(0.0) == -np.inf
    assert wa.units.db(0.0, floor_db=-30.0) == -30.0
    assert wa.units.db(1e-9, floor_db=-30.0) == -30.0


@pytest.mark.parametrize(("dbm", "watts"), [(0.0, 1e-3), (30.0, 1.0), (40.0, 10.0), (46.0, 39.810717055349734)])
def test_dbm_to_watts(dbm: float, watts: float) -> None:
    assert wa.units.dbm_to_w(dbm) == pytest.approx(watts, **EXACT)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (1.234e6, "bit/s", "1.23 Mbit/s"),
        (999.4, "bit/s", "999 bit/s"),
        (999.9, "bit/s", "1 kbit/s"),  # not 1e+03 bit/s
        (-0.5, "W", "-500 mW"),
        (2e-7, "W", "200 nW"),
        (2.5e-6, "W", "2.5 µW"),
        (3e-15, "W", "3e-15 W"),
        (0.0, "W", "0 W"),
        (1234.5, "bit/s/Hz", "1.23e+03 bit/s/Hz"),
        (0.5, "", "0.5"),
        (math.nan, "W", "–"),
        (math.inf, "W", "inf W"),
    ],
)
def test_figures_as_people_read_them(value: float, unit: str, text: str) -> None:
    assert wa.units.human(value, unit) == text


# Rates, eq. (1) of the paper


def test_rate_is_shannons_with_the_papers_figures() -> None:
    cell = wa.Cell()  # 180 kHz, 1e-17 W/Hz: 1.8e-12 W of noise
    snr = 0.5 * 3e-11 / 1.8e-12
    rate = subcarrier_rate_bps(np.array([3e-11]), np.array([0.5]), cell)
    assert rate[0] == pytest.approx(180e3 * math.log2(1 + snr), **EXACT)


def test_tiny_signals_keep_their_rate() -> None:
    cell = wa.Cell()
    rate = subcarrier_rate_bps(np.array([1e-30]), np.array([1.0]), cell)
    assert rate[0] == pytest.approx(180e3 * 1e-30 / 1.8e-12 / math.log(2), rel=1e-12, abs=0)


def test_a_practical_link_has_a_gap_a_cap_and_overhead() -> None:
    cell = wa.Cell(snr_gap_db=3.0, max_spectral_efficiency_bps_per_hz=4.0, overhead=0.25)
    gain, gap = np.array([1e-11, 1e-9]), 10**0.3
    rate = subcarrier_rate_bps(gain, np.array([1.0, 1.0]), cell)
    assert rate[0] == pytest.approx(0.75 * 180e3 * math.log2(1 + 1e-11 / 1.8e-12 / gap), **EXACT)
    assert rate[1] == pytest.approx(0.75 * 180e3 * 4.0, **EXACT)


def test_power_beyond_the_cap_is_useless() -> None:
    cell = wa.Cell(max_spectral_efficiency_bps_per_hz=4.0)
    gain = np.array([[1e-9, 1e-11, 0.0]])
    useful = useful_power_w(gain, cell)
    assert useful[0, 0] == pytest.approx(15 * 1.8e-12 / 1e-9, **EXACT)
    assert useful[0, 2] == np.inf
    at_cap = subcarrier_rate_bps(gain[:, :2], useful[:, :2], cell)
    assert at_cap == pytest.approx(np.full((1, 2), 720e3), **EXACT)
    assert np.all(np.isinf(useful_power_w(gain, wa.Cell())))


def test_normalised_gain_is_snr_per_watt() -> None:
    assert normalised_gain(np.array(1.8e-12), wa.Cell()) == pytest.approx(1.0, **EXACT)


def test_user_rates_sum_over_owned_subcarriers() -> None:
    cell = wa.Cell(subcarrier_bandwidth_hz=1.0, noise_psd_w_per_hz=1.0)
    gain = np.array([[1.0, 3.0, 7.0, 1.0], [15.0, 1.0, 1.0, 31.0]])
    owner, power = np.array([0, 0, -1, 1]), np.array([1.0, 1.0, 1.0, 1.0])
    assert owned_gain(gain, owner).tolist() == [1.0, 3.0, 0.0, 31.0]
    assert user_rate_bps(gain, owner, power, cell).tolist() == [1.0 + 2.0, 5.0]


# Metrics


def test_metrics_of_a_small_allocation() -> None:
    cell = wa.Cell(subcarrier_bandwidth_hz=1.0, noise_psd_w_per_hz=1.0, circuit_power_w=2.0, amplifier_efficiency=0.5)
    gain = np.array([[1.0, 3.0, 7.0], [15.0, 1.0, 1.0]])
    owner, power = np.array([1, 0, 0]), np.array([1.0, 1.0, 1.0])
    metrics = wa.link_metrics(gain, owner, power, cell, committed_bps=np.array([5.0, 4.1]))
    assert metrics.user_rate_bps.tolist() == [5.0, 4.0]
    assert metrics.sum_rate_bps == 9.0
    assert metrics.goodput_bps == 5.0  # user 2 was promised more than the channel carries
    assert metrics.power_w == 3.0
    assert metrics.energy_efficiency_bit_per_j == 9.0 / (3.0 / 0.5 + 2.0)
    assert metrics.spectral_efficiency_bps_per_hz == 3.0
    assert metrics.jain_index == pytest.approx(81 / (2 * 41), **EXACT)


def test_goodput_counts_the_commitment_and_not_the_surplus() -> None:
    cell = wa.Cell(subcarrier_bandwidth_hz=1.0, noise_psd_w_per_hz=1.0)
    metrics = wa.link_metrics(np.array([[3.0]]), np.array([0]), np.array([1.0]), cell, committed_bps=np.array([1.5]))
    assert (metrics.goodput_bps, metrics.sum_rate_bps) == (1.5, 2.0)


def test_a_rate_is_kept_up_to_rounding_only() -> None:
    promised = np.array([1e6, 1e6, 0.0])
    assert kept(np.array([1e6 * (1 - 1e-10), 1e6 * (1 - 1e-8), 0.0]), promised).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("rates", "index"),
    [
        ([2.0, 2.0, 2.0], 1.0),
        ([0.0, 0.0, 5.0], 1 / 3),
        ([0.0, 0.0], 0.0),
        ([1e200, 1e200], 1.0),
        ([1e-200, 3e-200], 0.8),
    ],
)
def test_jains_index(rates: list[float], index: float) -> None:
    assert jain_index(np.array(rates)) == pytest.approx(index, rel=1e-14, abs=0)


def test_nothing_drawn_and_nothing_sent_has_no_efficiency() -> None:
    assert energy_efficiency_bit_per_j(0.0, 0.0, wa.Cell(circuit_power_w=0.0)) == 0.0


# Cell


def test_the_cell_has_the_papers_figures() -> None:
    cell = wa.Cell()
    assert (cell.subcarrier_bandwidth_hz, cell.noise_psd_w_per_hz) == (180e3, 1e-17)
    assert (cell.max_power_w, cell.circuit_power_w) == (20.0, 5.0)
    assert (cell.snr_gap, cell.data_bandwidth_hz, cell.max_spectral_efficiency) == (1.0, 180e3, np.inf)


def test_the_nr_cell_has_the_standards_figures() -> None:
    cell = wa.Cell.nr(max_power_w=5.0)
    assert cell.max_power_w == 5.0
    assert cell.subcarrier_bandwidth_hz == 12 * 30e3
    assert cell.max_spectral_efficiency == pytest.approx(8 * 948 / 1024, rel=1e-5, abs=0)  # TS 38.214, 256QAM
    assert wa.units.db(cell.noise_psd_w_per_hz * 1e3) == pytest.approx(-165.0, rel=1e-12, abs=0)  # −174 dBm/Hz and 9 dB


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("subcarrier_bandwidth_hz", 0.0),
        ("noise_psd_w_per_hz", -1e-17),
        ("max_power_w", math.nan),
        ("max_power_w", math.inf),
        ("max_power_w", "much"),
        ("circuit_power_w", -1.0),
        ("snr_gap_db", -3.0),
        ("max_spectral_efficiency_bps_per_hz", 0.0),
        ("snr_gap_db", 1e308),
        ("max_power_w", 1e308),
        ("noise_psd_w_per_hz", 1e-320),
        ("overhead", 1.0),
        ("overhead", -0.1),
        ("overhead", "little"),
        ("overhead", None),
        ("amplifier_efficiency", 1e-320),
        ("amplifier_efficiency", "good"),
        ("amplifier_efficiency", 0.0),
        ("amplifier_efficiency", 1.1),
    ],
)
def test_a_cell_that_cannot_be_is_refused_with_the_field_and_the_value(field: str, value: object) -> None:
    with pytest.raises(InputError, match=field) as caught:
        wa.Cell(**{field: value})
    assert repr(value) in str(caught.value)


# Problem


@pytest.mark.parametrize(
    "options",
    [
        {"weights": [-1.0, 1.0]},
        {"weights": math.inf},
        {"min_rate_bps": -1.0},
        {"min_rate_bps": math.inf},
        {"min_rate_bps": 1e308},
        {"max_power_w": 1e308},
        {"min_rate_bps": math.nan},
        {"min_rate_bps": "fast"},
        {"max_rate_bps": -1.0},
        {"max_power_w": 0.0},
        {"max_power_w": math.inf},
        {"subcarrier_max_power_w": -1.0},
        {"users": ()},
        {"users": ("user 2", "user 2")},
        {"users": (-1,)},
        {"resource_block_group_size": 0},
        {"outage_probability": 0.0},
        {"outage_probability": 1.0},
    ],
)
def test_a_problem_that_cannot_be_is_refused_with_the_field(options: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=next(iter(options))):
        wa.Problem("max_rate", **options)


def test_a_full_buffer_and_no_cap_are_infinite() -> None:
    problem = wa.Problem("max_rate", max_rate_bps=math.inf, subcarrier_max_power_w=math.inf)
    assert problem.max_rate_bps == math.inf


def test_the_problems_budget_tightens_the_cells() -> None:
    cell = wa.Cell(max_power_w=20.0)
    assert wa.Problem("max_rate").budget_w(cell) == 20.0
    assert wa.Problem("max_rate", max_power_w=3.0).budget_w(cell) == 3.0
    with pytest.raises(InputError, match=r"25 W is above the cell's limit of 20 W"):
        wa.Problem("max_rate", max_power_w=25.0).budget_w(cell)


def test_promised_rates_are_per_user_or_for_all() -> None:
    assert wa.Problem("max_rate").min_rates_bps(2).tolist() == [0.0, 0.0]
    assert wa.Problem("max_rate", min_rate_bps=5.0).min_rates_bps(2).tolist() == [5.0, 5.0]
    assert wa.Problem("max_rate", min_rate_bps=[1.0, 2.0]).min_rates_bps(2).tolist() == [1.0, 2.0]
    with pytest.raises(InputError, match=r"one per user \(3\)"):
        wa.Problem("max_rate", min_rate_bps=[1.0, 2.0]).min_rates_bps(3)


def test_constraints_are_those_that_are_set() -> None:
    assert wa.Problem("max_rate").constraints() == {}
    problem = wa.Problem("max_rate", max_power_w=1.0, users=("user 1",), resource_block_group_size=2)
    assert problem.constraints() == {"max_power_w": 1.0, "users": ("user 1",), "resource_block_group_size": 2}


# Observation, estimate, scene

HOLES = np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan]])


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"gain": np.ones(3)}, r"shape \(user, subcarrier\)"),
        ({"gain": np.ones((1, 1, 1, 1))}, r"got shape \(1, 1, 1, 1\)"),
        ({"gain": np.ones((0, 3))}, r"none of them zero"),
        ({"gain": [["a", "b"]]}, r"gain must be numbers"),
        ({"gain": [[1.0, -2.0]]}, r"got -2 at user 0, subcarrier 1 \(counted from 0\).*unit='db'"),
        ({"gain": [[[1.0], [2.0]], [[3.0], [np.inf]]]}, r"got inf at slot 1, user 1, subcarrier 0"),
        ({"gain": [[1e307, 1.0]]}, r"a power gain must be 1e\+100 at most.*got 1e\+307 at user 0.*check its unit"),
        ({"gain": HOLES, "noise_variance": -1.0}, r"noise_variance must be zero or more and finite; got -1 at user 0"),
        ({"gain": HOLES, "noise_variance": np.inf}, r"noise_variance must be zero or more and finite; got inf"),
        ({"gain": HOLES, "noise_variance": np.nan}, r"noise_variance must be zero or more and finite; got nan"),
        (
            {"gain": HOLES, "noise_variance": [[1, 1, np.inf], [1, 1, 1]]},
            r"noise_variance .*inf at user 0, subcarrier 2",
        ),
        (
            {"gain": HOLES, "noise_variance": [1, 2]},
            r"noise_variance must be one value or of the gain's shape \(2, 3\)",
        ),
        ({"gain": HOLES, "user_names": "ab"}, r"user_names must be 2 different names; got 'ab'"),
        ({"gain": HOLES, "user_names": (1, 2)}, r"user_names must be 2 different names; got \(1, 2\)"),
        ({"gain": HOLES, "user_names": ("a",)}, r"user_names must be 2 different names"),
        ({"gain": HOLES, "user_names": ("a", "a")}, r"user_names must be 2 different names"),
        ({"gain": HOLES, "subcarrier_frequencies_hz": [1.0, 2.0]}, r"must be 3 finite, increasing values"),
        ({"gain": HOLES, "subcarrier_frequencies_hz": [1.0, 3.0, 2.0]}, r"must be 3 finite, increasing values"),
        ({"gain": HOLES, "slot_times_s": [0.0, 1.0]}, r"slot_times_s must be 1 finite"),
    ],
)
def test_an_observation_that_cannot_be_is_refused(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        wa.ChannelObservation(**fields)


def test_an_observation_has_defaults_and_knows_its_current_slot() -> None:
    history = np.stack([np.ones((2, 3)), HOLES])
    observation = wa.ChannelObservation(gain=history, noise_variance=0.5)
    assert (observation.num_slots, observation.num_users, observation.num_subcarriers) == (2, 2, 3)
    assert observation.user_names == ("user 1", "user 2")
    assert np.array_equal(observation.current, HOLES, equal_nan=True)
    assert np.array_equal(observation.missing, np.isnan(HOLES))
    assert np.all(observation.current_noise_variance[~observation.missing] == 0.5)
    flat = wa.ChannelObservation(gain=HOLES)
    assert flat.num_slots == 1
    assert flat.slots.shape == (1, 2, 3)
    assert np.all(flat.current_noise_variance == 0.0)


def test_arrays_of_the_model_are_copies_that_nobody_can_write_to() -> None:
    mine = np.ones((2, 3))
    observation = wa.ChannelObservation(gain=mine)
    mine[0, 0] = 9.0
    assert observation.gain[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        observation.gain[0, 0] = 9.0
    view = frozen(np.arange(4.0))[1:]
    assert not frozen(view).flags.writeable


def test_completing_keeps_what_was_observed_and_flags_what_was_not() -> None:
    observation = wa.ChannelObservation(gain=HOLES, noise_variance=np.full((2, 3), 0.25))
    estimate = wa.ChannelEstimate.completing(
        observation, gain=np.full((2, 3), 7.0), gain_variance=np.full((2, 3), 49.0), method="sevens"
    )
    assert estimate.gain.tolist() == [[1.0, 7.0, 3.0], [7.0, 7.0, 7.0]]
    assert estimate.gain_variance.tolist() == [[0.25, 49.0, 0.25], [49.0, 49.0, 49.0]]
    assert np.array_equal(estimate.repaired, np.isnan(HOLES))
    assert estimate.unobserved_users.tolist() == [False, True]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gain": np.array([[1.0, np.nan]])}, "complete"),
        ({"gain": np.array([[1.0, -1.0]])}, "zero or more"),
        (
            {"gain_variance": np.array([[0.0, -1.0]])},
            "gain_variance must be zero or more and finite; got -1 at user 0, sub",
        ),
        ({"gain_variance": np.array([[0.0, np.nan]])}, "gain_variance .* got nan at user 0, subcarrier 1"),
        ({"gain_variance": np.array([[np.inf, 0.0]])}, "gain_variance .* got inf at user 0, subcarrier 0"),
        ({"gain": np.array([[1.0, 1e307]])}, r"1e\+100 at most.* got 1e\+307 at user 0, subcarrier 1"),
        ({"gain_variance": np.zeros((2, 1))}, "share one"),
        ({"repaired": np.zeros((2, 2), dtype=bool)}, r"repaired must be .* of shape \(1, 2\)"),
        ({"repaired": np.zeros((1, 2))}, r"repaired must be switches \(bool\).*; got float64"),
        ({"repaired": None}, "repaired must be switches"),
        ({"unobserved_users": "x"}, "unobserved_users must be switches"),
        ({"user_names": ("a", "a")}, r"user_names must be 1 different names; got \('a', 'a'\)"),
        ({"user_names": (3,)}, r"user_names must be 1 different names; got \(3,\)"),
    ],
)
def test_an_estimate_that_cannot_be_is_refused(change: dict[str, Any], message: str) -> None:
    sound: dict[str, Any] = {
        "gain": np.ones((1, 2)),
        "gain_variance": np.zeros((1, 2)),
        "repaired": np.zeros((1, 2), dtype=bool),
        "unobserved_users": np.zeros(1, dtype=bool),
        "user_names": ("a",),
        "method": "none",
    }
    assert wa.ChannelEstimate(**sound).num_subcarriers == 2
    with pytest.raises(InputError, match=message):
        wa.ChannelEstimate(**{**sound, **change})


def test_a_scenes_truth_must_be_complete_and_fit() -> None:
    sensed = wa.ChannelObservation(gain=np.ones((2, 3)))
    for truth in (np.ones((3, 2)), HOLES):
        with pytest.raises(InputError, match=r"truth must be complete and of the observation's shape \(2, 3\)"):
            wa.Scene(cell=wa.Cell(), sensed=sensed, truth=truth)


def test_losses_strike_independently_and_by_the_seed() -> None:
    sensed = wa.ChannelObservation(gain=np.ones((2, 30, 40)))
    scene = wa.Scene(cell=wa.Cell(), sensed=sensed, truth=2 * sensed.gain)
    assert scene.current_truth is not None
    assert scene.current_truth.shape == (30, 40)
    assert np.array_equal(scene.observe().gain, sensed.gain)
    losses = wa.loss.random(0.5), wa.loss.random(0.2)
    once, again, other = (scene.observe(*losses, seed=seed).gain for seed in (3, 3, 4))
    assert np.array_equal(once, again, equal_nan=True)
    assert not np.array_equal(once, other, equal_nan=True)
    assert np.isnan(once).mean() == pytest.approx(1 - 0.5 * 0.8, rel=0.1, abs=0)  # not 0.5, nor 0.7


# Posterior


def test_a_gamma_posterior_of_unit_shape_is_exponential() -> None:
    mean = np.array([[2.0, 0.5]])
    posterior = wa.GammaPosterior(mean, mean**2)
    for probability in (0.01, 0.05, 0.5, 0.99):
        assert posterior.quantile(probability) == pytest.approx(mean * expon.ppf(probability), rel=1e-10, abs=0)


def test_expected_rate_of_an_exponential_gain() -> None:
    mean = np.array([[2.0, 0.5]])
    expected = np.exp(1 / mean) * exp1(1 / mean)  # E[ln(1 + g)] for g exponential
    assert wa.GammaPosterior(mean, mean**2).expected_log1p(np.ones((1, 2))) == pytest.approx(expected, rel=5e-3, abs=0)


def test_a_certain_gain_has_a_point_posterior() -> None:
    mean = np.array([[2.0, 0.0]])
    posterior = wa.GammaPosterior(mean, np.zeros((1, 2)))
    assert np.array_equal(posterior.quantile(0.05), mean)
    assert np.array_equal(posterior.samples(3, seed=0), np.repeat(mean[np.newaxis], 3, axis=0))
    assert posterior.expected_log1p(np.ones((1, 2))) == pytest.approx(np.log1p(mean), rel=1e-14, abs=0)


def test_posterior_samples_have_its_mean_and_variance() -> None:
    mean, variance = np.array([[2.0, 0.5]]), np.array([[1.0, 0.5]])
    drawn = wa.GammaPosterior(mean, variance).samples(40_000, seed=1)
    assert drawn.mean(axis=0) == pytest.approx(mean, rel=0.03, abs=0)
    assert drawn.var(axis=0) == pytest.approx(variance, rel=0.1, abs=0)


# Decision and outcome


def decision(**fields: Any) -> Decision:
    given: dict[str, Any] = {
        "owner": np.array([0, -1]),
        "power_w": np.array([2.0, 0.0]),
        "rate_bps": np.array([1e6]),
        "status": "feasible",
        "value": 1e6,
        "bound": np.nan,
        "gap": np.nan,
        "unit": "bit/s",
        "method": "by hand",
        "problem": wa.Problem("max_rate"),
        "cell": wa.Cell(),
        "user_names": ("a",),
    }
    return Decision(**{**given, **fields})


@pytest.mark.parametrize(
    ("status", "usable"), [("optimal", True), ("feasible", True), ("infeasible", False), ("undecided", False)]
)
def test_only_what_keeps_every_constraint_is_usable(status: str, usable: bool) -> None:
    assert decision(status=status).is_usable is usable


def test_a_decision_cannot_be_changed() -> None:
    made = decision()
    assert made.total_power_w == 2.0
    with pytest.raises(ValueError, match="read-only"):
        made.power_w[0] = 30.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.status = "optimal"  # type: ignore[misc]


def test_an_outcome_names_who_was_let_down() -> None:
    cell = wa.Cell(subcarrier_bandwidth_hz=1.0, noise_psd_w_per_hz=1.0)
    owner, power = np.array([0, 1]), np.array([1.0, 1.0])
    achieved = wa.link_metrics(np.array([[3.0, 1.0], [1.0, 1.0]]), owner, power, cell)
    fields: dict[str, Any] = {
        "base_station": "x",
        "owner": owner,
        "power_w": power,
        "promised_bps": np.array([2.0, 1.1]),
    }
    assert wa.Outcome(achieved=achieved, **fields).missed.tolist() == [False, True]
    assert wa.Outcome(**fields).missed.tolist() == [False, False]

"""What every built-in repairer promises, whatever the matrix."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from wirelessagent.model.errors import InputError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.levels import PRIOR_LEVEL
from wirelessagent.repairing.kriging import Kriging
from wirelessagent.repairing.learned_covariance import LearnedCovariance
from wirelessagent.repairing.linear import Linear
from wirelessagent.repairing.nncf import Nncf
from wirelessagent.repairing.nncf_paper import NncfPaper
from wirelessagent.repairing.predictor import Predictor
from wirelessagent.repairing.repairer import Repairer
from wirelessagent.repairing.user_mean import UserMean

NAN = np.nan
RELATIVE = [UserMean(), Linear(), Nncf()]
BY_EVIDENCE = [Kriging(), LearnedCovariance(), Predictor()]
ALL = [*RELATIVE, *BY_EVIDENCE, NncfPaper()]

all_repairers = pytest.mark.parametrize("repairer", ALL, ids=lambda r: r.name)
relative_repairers = pytest.mark.parametrize("repairer", RELATIVE, ids=lambda r: r.name)
repairers_by_evidence = pytest.mark.parametrize("repairer", BY_EVIDENCE, ids=lambda r: r.name)
repairers_of_levels = pytest.mark.parametrize("repairer", [*RELATIVE, *BY_EVIDENCE], ids=lambda r: r.name)
few = settings(max_examples=60, deadline=None, derandomize=True)


@st.composite
def observations(draw: st.DrawFn, max_slots: int = 3) -> ChannelObservation:
    """Odd shapes, wide dynamic range, zeros, ties, rows and columns missing, with or without history and noise."""
    shape = (draw(st.integers(0, max_slots)), draw(st.integers(1, 5)), draw(st.integers(1, 8)))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    gain = 10.0 ** rng.uniform(draw(st.sampled_from([-30.0, -1.0, 0.0])), 0.0, shape if shape[0] else shape[1:])
    gain[rng.random(gain.shape) < draw(st.sampled_from([0.0, 0.0, 0.5, 1.0]))] = 0.0
    gain[rng.random(gain.shape) < draw(st.sampled_from([0.2, 0.5, 0.9, 1.0]))] = NAN
    gain[..., rng.random(shape[1]) < draw(st.sampled_from([0.0, 0.5])), :] = NAN
    frequencies = np.cumsum(rng.uniform(1e4, 1e6, shape[2])) if draw(st.booleans()) else None
    noise = np.where(np.isnan(gain), NAN, 0.01 * gain**2) if draw(st.booleans()) else None
    return ChannelObservation(gain=gain, noise_variance=noise, subcarrier_frequencies_hz=frequencies)


@all_repairers
@few
@given(seen=observations())
def test_every_matrix_is_completed(repairer: Repairer, seen: ChannelObservation) -> None:
    estimate = repairer.repair(seen)
    observed = ~seen.missing
    assert estimate.gain[observed].tobytes() == seen.current[observed].tobytes()
    assert np.array_equal(estimate.gain_variance[observed], seen.current_noise_variance[observed])
    assert np.array_equal(estimate.repaired, seen.missing)
    assert np.array_equal(estimate.unobserved_users, np.isnan(seen.slots).all(axis=(0, 2)))
    assert np.all(np.isfinite(estimate.gain))
    assert np.all(estimate.gain >= 0)
    assert np.all(np.isfinite(estimate.gain_variance))
    assert estimate.method == repairer.name
    unseen = estimate.unobserved_users
    if repairer.name != "nncf_paper":
        assert np.all(estimate.gain[unseen] > 0)
        assert np.all(estimate.gain_variance[unseen] > estimate.gain[unseen] ** 2)
    assert np.all(estimate.gain_variance[estimate.repaired] > 0)
    if repairer.name in ("user_mean", "nncf") or repairer in BY_EVIDENCE:
        assert np.all(estimate.gain[estimate.repaired] > 0)


@repairers_of_levels
@few
@given(seen=observations(), seed=st.integers(0, 1000))
def test_permuting_users_permutes_the_estimate(repairer: Repairer, seen: ChannelObservation, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(seen.num_users)
    variance = None if seen.noise_variance is None else seen.noise_variance[..., order, :]
    permuted = dataclasses.replace(
        seen,
        gain=seen.gain[..., order, :],
        noise_variance=variance,
        user_names=tuple(seen.user_names[k] for k in order),
    )
    straight, swapped = repairer.repair(seen), repairer.repair(permuted)
    # Evidence is summed over the users in their order, and eigenvectors turn with rounding.
    by_evidence = repairer in BY_EVIDENCE
    np.testing.assert_allclose(swapped.gain, straight.gain[order], rtol=1e-4 if by_evidence else 1e-9)
    np.testing.assert_allclose(swapped.gain_variance, straight.gain_variance[order], rtol=1e-3 if by_evidence else 1e-6)
    assert np.array_equal(swapped.unobserved_users, straight.unobserved_users[order])


@relative_repairers
@few
@given(seen=observations(), exponent=st.integers(-40, 40))
def test_scaling_one_user_scales_its_estimate_alone(
    repairer: Repairer, seen: ChannelObservation, exponent: int
) -> None:
    everybody = (seen.slots > 0).any(axis=(0, 2))
    everybody &= np.where(seen.missing.all(axis=1), True, (seen.current > 0).any(axis=1))
    assume(everybody.all())  # the guess for a user without a level rests on the others
    factor = np.ones((seen.num_users, 1))
    factor[0] = 2.0**exponent
    variance = None if seen.noise_variance is None else seen.noise_variance * factor**2
    scaled = repairer.repair(dataclasses.replace(seen, gain=seen.gain * factor, noise_variance=variance))
    plain = repairer.repair(seen)
    np.testing.assert_array_equal(scaled.gain, plain.gain * factor)
    # How far a level may be trusted depends on how far the others' lie from it, but only that.
    for one, other, repaired in zip(scaled.gain_variance, plain.gain_variance * factor**2, plain.repaired, strict=True):
        ratio = one[repaired] / other[repaired]
        np.testing.assert_allclose(ratio, ratio.mean() if ratio.size else 1.0, rtol=1e-9)


@repairers_of_levels
@few
@given(seen=observations(), exponent=st.integers(-40, 40))
def test_scaling_everything_scales_the_estimate(repairer: Repairer, seen: ChannelObservation, exponent: int) -> None:
    assume((seen.slots > 0).any())  # else the level is absolute
    factor = 2.0**exponent
    variance = None if seen.noise_variance is None else seen.noise_variance * factor**2
    scaled = repairer.repair(dataclasses.replace(seen, gain=seen.gain * factor, noise_variance=variance))
    plain = repairer.repair(seen)
    rounding = 1e-6 if repairer in BY_EVIDENCE else 1e-9  # eigenvectors
    np.testing.assert_allclose(scaled.gain, plain.gain * factor, rtol=rounding)
    np.testing.assert_allclose(scaled.gain_variance, plain.gain_variance * factor**2, rtol=rounding)


@all_repairers
@pytest.mark.parametrize("value", [1.0, 0.1, 3e-13, 1e-30])
def test_a_constant_channel_is_reproduced(repairer: Repairer, value: float) -> None:
    gain = np.full((4, 20), value)
    gain[np.random.default_rng(3).random(gain.shape) < 0.3] = NAN
    estimate = repairer.repair(ChannelObservation(gain=gain))
    np.testing.assert_allclose(estimate.gain, value, rtol=1e-4 if repairer in BY_EVIDENCE else 1e-15)


@relative_repairers
def test_constant_rows_of_different_levels_are_reproduced(repairer: Repairer) -> None:
    truth = np.array([1e-30, 1e-12, 1e-9, 1.0])[:, np.newaxis] * np.ones((4, 20))
    gain = np.where(np.random.default_rng(3).random(truth.shape) < 0.3, NAN, truth)
    np.testing.assert_allclose(repairer.repair(ChannelObservation(gain=gain)).gain, truth, rtol=1e-15)


@relative_repairers
def test_a_user_unseen_now_gets_the_level_of_its_history(repairer: Repairer) -> None:
    rng = np.random.default_rng(1)
    gain = rng.exponential(size=(5, 3, 12)) * np.array([1e-10, 1e-13, 1e-8])[:, np.newaxis]
    level = gain[:-1, 1].mean()
    gain[-1, 1] = NAN
    estimate = repairer.repair(ChannelObservation(gain=gain))
    np.testing.assert_allclose(estimate.gain[1], level, rtol=1e-12)
    assert not estimate.unobserved_users.any()
    # The history's spread around its level is near an exponential's: variance = level².
    assert 0.5 * level**2 < estimate.gain_variance[1, 0] < 2 * level**2


@relative_repairers
def test_a_user_seen_now_does_not_need_its_history(repairer: Repairer) -> None:
    gain = np.random.default_rng(1).exponential(size=(3, 4, 12))
    gain[-1, :, 3:5] = NAN
    with_history = repairer.repair(ChannelObservation(gain=gain))
    without = repairer.repair(ChannelObservation(gain=gain[-1]))
    np.testing.assert_array_equal(with_history.gain, without.gain)
    np.testing.assert_array_equal(with_history.gain_variance, without.gain_variance)


@repairers_of_levels
def test_a_user_never_seen_gets_the_median_of_the_others_in_db(repairer: Repairer) -> None:
    gain = np.array([1e-10, 1e-13, 1e-11, 1e-12])[:, np.newaxis] * np.ones((4, 6))
    gain[2] = NAN
    estimate = repairer.repair(ChannelObservation(gain=gain))
    np.testing.assert_allclose(estimate.gain[2], 1e-12, rtol=1e-12)
    others = np.array([1e-10, 1e-13, 1e-12, 1e-13, 1e-11])  # observed, and 10 dB about the guess
    np.testing.assert_allclose(estimate.gain_variance[2], np.mean(others**2 + (others - 1e-12) ** 2), rtol=1e-12)
    np.testing.assert_array_equal(estimate.unobserved_users, [False, False, True, False])


@all_repairers
def test_nothing_observed_gives_the_prior_level(repairer: Repairer) -> None:
    estimate = repairer.repair(ChannelObservation(gain=np.full((2, 3), NAN)))
    np.testing.assert_allclose(estimate.gain, PRIOR_LEVEL)
    assert np.all(estimate.gain_variance > PRIOR_LEVEL**2)
    assert estimate.unobserved_users.all()


@all_repairers
def test_a_report_of_zero_is_no_certainty(repairer: Repairer) -> None:
    gain = np.array([[0.0, NAN, 0.0, NAN], [1e-9, 3e-9, NAN, 2e-9]])
    for seen in (gain, np.where(gain > 0, 0.0, gain)):
        estimate = repairer.repair(ChannelObservation(gain=seen))
        assert np.all(estimate.gain_variance[estimate.repaired] > 0)


@relative_repairers
def test_a_user_reported_as_zero_lies_below_the_smallest_positive_gain(repairer: Repairer) -> None:
    gain = np.array([[0.0, NAN, NAN, NAN], [1e-9, 3e-9, NAN, 2e-9]])
    estimate = repairer.repair(ChannelObservation(gain=gain))
    np.testing.assert_allclose(estimate.gain[0, 1:], 1e-10, rtol=1e-12)
    np.testing.assert_allclose(estimate.gain_variance[0, 1:], 1e-18, rtol=1e-12)
    earlier = np.array([[4e-12, NAN, NAN, 6e-12], [1e-9, 3e-9, NAN, 2e-9]])
    estimate = repairer.repair(ChannelObservation(gain=np.array([earlier, gain])))
    np.testing.assert_allclose(estimate.gain[0, 1:], 4e-13, rtol=1e-12)
    np.testing.assert_allclose(estimate.gain_variance[0, 1:], 1.6e-23, rtol=1e-12)


@all_repairers
def test_a_single_observation_is_enough(repairer: Repairer) -> None:
    gain = np.full((1, 5), NAN)
    gain[0, 3] = 2e-11
    estimate = repairer.repair(ChannelObservation(gain=gain))
    # Of one report that may be a peak, less is expected where the channel may be another.
    lowest = 0.4 if repairer in BY_EVIDENCE else 1.0
    assert np.all(estimate.gain >= lowest * 2e-11 * (1 - 1e-12))
    assert np.all(estimate.gain <= 2e-11 * (1 + 1e-9))
    assert np.all(estimate.gain_variance[0, [0, 1, 2, 4]] > 0)


def test_a_wider_gap_is_less_certain() -> None:
    rng = np.random.default_rng(8)
    n = np.arange(24)
    covariance = 1 / (1 + 0.2j * (n[:, np.newaxis] - n))
    root = np.linalg.cholesky(covariance + 1e-12 * np.eye(24))
    gain = np.abs((rng.normal(size=(8, 24)) + 1j * rng.normal(size=(8, 24))) @ root.T / np.sqrt(2)) ** 2
    gain[:, 3] = NAN
    gain[:, 10:17] = NAN
    for repairer in (Linear(), Nncf(), Kriging()):
        spread = np.sqrt(repairer.repair(ChannelObservation(gain=gain)).gain_variance).mean(axis=0)
        assert 3 * spread[3] < spread[13]


@repairers_by_evidence
def test_constant_rows_are_all_but_reproduced(repairer: Repairer) -> None:
    truth = np.array([1e-30, 1e-12, 1e-9, 1.0])[:, np.newaxis] * np.ones((4, 20))
    gain = np.where(np.random.default_rng(3).random(truth.shape) < 0.3, NAN, truth)
    np.testing.assert_allclose(repairer.repair(ChannelObservation(gain=gain)).gain, truth, rtol=1e-3)


def test_kriging_needs_no_history_and_the_predictor_none_but_history() -> None:
    rng = np.random.default_rng(1)
    gain = rng.exponential(size=(5, 3, 12)) * np.array([1e-10, 1e-13, 1e-8])[:, np.newaxis]
    gain[-1, :, 3:5] = NAN
    alone = Kriging().repair(ChannelObservation(gain=gain[-1]))
    np.testing.assert_array_equal(Kriging().repair(ChannelObservation(gain=gain)).gain, alone.gain)
    np.testing.assert_array_equal(Predictor().repair(ChannelObservation(gain=gain[-1])).gain, alone.gain)
    gain[-1, 1] = NAN
    level = gain[:-1, 1].mean()
    unseen_now = Predictor().repair(ChannelObservation(gain=gain)).gain[1]
    np.testing.assert_allclose(unseen_now, level, rtol=0.5)  # slots are independent: near the level
    np.testing.assert_allclose(Kriging().repair(ChannelObservation(gain=gain)).gain[1], level, rtol=1e-12)


def test_the_literal_rule_refuses_weights_that_mean_nothing() -> None:
    with pytest.raises(InputError, match="frequency_weight"):
        NncfPaper(frequency_weight=-1.0)
    with pytest.raises(InputError, match="both 0"):
        NncfPaper(frequency_weight=0.0, user_weight=0.0)


@pytest.mark.parametrize("repairer", [Kriging(), Predictor(), LearnedCovariance()], ids=lambda one: one.name)
def test_frequencies_closer_than_a_raster_tells_apart(repairer: Repairer) -> None:
    """Carriers of several operators: a few hertz apart in one place, a gigahertz elsewhere."""
    rng = np.random.default_rng(3)
    frequencies = np.sort(np.concatenate([1e9 + 10.0 * np.arange(4), rng.uniform(1.1e9, 2e9, 96)]))
    gain = rng.exponential(size=(3, 100))
    lost = rng.random(gain.shape) < 0.3
    seen = ChannelObservation(gain=np.where(lost, np.nan, gain), subcarrier_frequencies_hz=frequencies)
    estimate = repairer.repair(seen)
    assert np.isfinite(estimate.gain).all()
    assert (estimate.gain >= 0).all()
    assert (estimate.gain_variance[lost] > 0).all()

"""The repairers against slow, plain implementations of what they say they compute."""

from __future__ import annotations

import numpy as np
import pytest

from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import users
from wirelessagent.repairing.core.frequency_kernel import interpolate, predict, two_sided
from wirelessagent.repairing.core.users_kernel import surprise_of_others
from wirelessagent.repairing.linear import Linear
from wirelessagent.repairing.nncf import Nncf
from wirelessagent.repairing.nncf_paper import NncfPaper
from wirelessagent.repairing.user_mean import UserMean

NAN = np.nan


def with_holes(seed: int, num_users: int, num_subcarriers: int, loss: float) -> np.ndarray:
    rng = np.random.default_rng(seed)
    gain = rng.exponential(size=(num_users, num_subcarriers)) * 10.0 ** rng.uniform(-13, -8, (num_users, 1))
    return np.where(rng.random(gain.shape) < loss, NAN, gain)


def the_papers_rule(raw: np.ndarray, frequency_weight: float, user_weight: float) -> np.ndarray:
    """Sec. III-A line by line: cycle over the missing entries until all are filled."""
    known = {(int(k), int(n)): float(raw[k, n]) for k, n in np.argwhere(~np.isnan(raw))}
    while len(known) < raw.size:
        filled = {}
        for k in range(raw.shape[0]):
            for n in range(raw.shape[1]):
                if (k, n) in known:
                    continue
                weights = {
                    (k, n - 1): frequency_weight,
                    (k, n + 1): frequency_weight,
                    (k - 1, n): user_weight,
                    (k + 1, n): user_weight,
                }
                valid = {at: w for at, w in weights.items() if at in known and w > 0}
                if valid:
                    filled[k, n] = sum(w * known[at] for at, w in valid.items()) / sum(valid.values())
        known |= filled
    return np.array([[known[k, n] for n in range(raw.shape[1])] for k in range(raw.shape[0])])


@pytest.mark.parametrize("loss", [0.2, 0.5, 0.9])
@pytest.mark.parametrize(("frequency_weight", "user_weight"), [(2.0, 1.0), (1.0, 1.0), (0.5, 3.0)])
@pytest.mark.parametrize("shape", [(8, 20), (3, 7), (5, 1), (2, 2)])
def test_nncf_paper_is_the_papers_equation(
    shape: tuple[int, int], frequency_weight: float, user_weight: float, loss: float
) -> None:
    raw = with_holes(11, *shape, loss)
    raw[0, 0] = 3e-10
    repairer = NncfPaper(frequency_weight=frequency_weight, user_weight=user_weight)
    repaired = repairer.repair(ChannelObservation(gain=raw))
    np.testing.assert_allclose(repaired.gain, the_papers_rule(raw, frequency_weight, user_weight), rtol=1e-13)


def test_nncf_paper_weighs_frequency_double_by_default() -> None:
    raw = with_holes(12, 8, 20, 0.3)
    repaired = NncfPaper().repair(ChannelObservation(gain=raw))
    np.testing.assert_allclose(repaired.gain, the_papers_rule(raw, 2.0, 1.0), rtol=1e-13)


def test_nncf_paper_by_hand() -> None:
    raw = np.array([[1.0, NAN, 3.0], [NAN, NAN, 9.0]])
    gain = NncfPaper().repair(ChannelObservation(gain=raw)).gain
    # First sweep: (0,1) from 1 and 3, (1,0) from 1 above it, (1,1) from 9 beside it.
    assert gain[0, 1] == 2.0
    assert gain[1, 0] == 1.0
    assert gain[1, 1] == 9.0


def test_what_no_weight_reaches_gets_the_users_level() -> None:
    raw = np.array([[1.0, 3.0, NAN], [5.0, 7.0, NAN]])
    estimate = NncfPaper(frequency_weight=0.0).repair(ChannelObservation(gain=raw))
    np.testing.assert_array_equal(estimate.gain[:, 2], [2.0, 6.0])
    assert np.all(estimate.gain_variance[:, 2] > 0)


@pytest.mark.parametrize("with_frequencies", [False, True])
@pytest.mark.parametrize("loss", [0.2, 0.7])
def test_linear_is_interpolation(loss: float, with_frequencies: bool) -> None:
    raw = with_holes(5, 12, 40, loss)
    rng = np.random.default_rng(6)
    frequencies = 3.5e9 + np.cumsum(rng.uniform(15e3, 400e3, 40)) if with_frequencies else None
    axis = np.arange(40.0) if frequencies is None else frequencies - frequencies[0]
    estimate = Linear().repair(ChannelObservation(gain=raw, subcarrier_frequencies_hz=frequencies))
    for row, repaired in zip(raw, estimate.gain, strict=True):
        seen = ~np.isnan(row)
        np.testing.assert_allclose(repaired, np.interp(axis, axis[seen], row[seen]), rtol=1e-11)


def test_user_mean_is_the_mean() -> None:
    raw = with_holes(7, 9, 30, 0.4)
    estimate = UserMean().repair(ChannelObservation(gain=raw))
    expected = np.broadcast_to(np.nanmean(raw, axis=1, keepdims=True), raw.shape)
    np.testing.assert_allclose(estimate.gain[estimate.repaired], expected[estimate.repaired], rtol=1e-14)


@pytest.mark.parametrize("coherence", [0.5, 3.0, 20.0])
@pytest.mark.parametrize(("below", "above"), [(1.0, 1.0), (1.0, 4.0), (3.0, 2.0)])
def test_weights_are_those_of_linear_prediction(below: float, above: float, coherence: float) -> None:
    def correlation(distance: float) -> float:
        return 1.0 / (1.0 + (distance / coherence) ** 2)

    to_target = np.array([correlation(below), correlation(above)])
    matrix = np.array([[1.0, correlation(below + above)], [correlation(below + above), 1.0]])
    weights = np.linalg.solve(matrix, to_target)
    weights /= max(1.0, weights.sum())
    w_below, w_above, error = two_sided(below, above, coherence)
    np.testing.assert_allclose([w_below, w_above], weights, rtol=2e-6)
    used = np.array([w_below, w_above])
    np.testing.assert_allclose(error, 1 - 2 * used @ to_target + used @ matrix @ used, rtol=1e-9)


def test_a_wide_coherence_means_interpolation_and_a_narrow_one_the_mean() -> None:
    np.testing.assert_allclose(two_sided(1.0, 3.0, 1e3)[:2], [0.75, 0.25], rtol=1e-4)
    np.testing.assert_allclose(two_sided(1.0, 3.0, 1e-3)[:2], [0.0, 0.0], atol=1e-5)


def test_the_neighbours_noise_adds_to_the_expected_error() -> None:
    relative, known = np.array([[1.5, 0.0, 0.5]]), np.array([[True, False, True]])
    noise = np.array([[0.04, 0.0, 0.01]])
    entries, where = (relative, known), (np.arange(3.0), np.array([2.0]), np.ones((1, 1)))
    added = predict(*entries, noise, *where)[1] - predict(*entries, 0 * noise, *where)[1]
    w_below, w_above, _ = two_sided(1.0, 1.0, 2.0)
    np.testing.assert_allclose(added[0, 1], w_below**2 * 0.04 + w_above**2 * 0.01, rtol=1e-9)


def test_the_mean_always_keeps_a_little_weight() -> None:
    assert sum(two_sided(1.0, 3.0, 20.0)[:2]) <= 1 - 0.9e-6


def test_no_entry_takes_part_in_its_own_prediction() -> None:
    rng = np.random.default_rng(3)
    relative = rng.exponential(size=(1, 12))
    known = rng.random(relative.shape) < 0.7
    known[0, 4] = True
    relative[~known] = 0.0
    noise = 0.01 * relative**2
    position, coherence, share = np.arange(12.0), np.array([3.0, 9.0]), np.array([[0.7, 0.3]])
    before = [predict(relative, known, noise, position, coherence, share)[0], interpolate(relative, known, position)]
    relative[0, 4] = 77.0
    after = [predict(relative, known, noise, position, coherence, share)[0], interpolate(relative, known, position)]
    for one, other in zip(before, after, strict=True):
        np.testing.assert_allclose(other[0, 4], one[0, 4], rtol=1e-12)
        assert one[0, 5] != other[0, 5]


@pytest.mark.parametrize("correlation", [0.2, 0.9])
@pytest.mark.parametrize("num_users", [2, 3, 8])
def test_equally_correlated_users_get_the_best_weights(num_users: int, correlation: float) -> None:
    """Where fading is independent over frequency: the multiple regression of one user on all others."""
    matrix = np.full((num_users, num_users), correlation) + (1 - correlation) * np.eye(num_users)
    relative = np.random.default_rng(2).exponential(size=(num_users, 5))
    known = np.ones(relative.shape, dtype=bool)
    surprise, explained = surprise_of_others(
        relative, relative, known, np.arange(5.0), np.full(num_users, 1e-6), matrix - np.eye(num_users)
    )
    weights = np.linalg.solve(matrix[1:, 1:], matrix[1:, 0])
    np.testing.assert_allclose(surprise[0], weights @ (relative[1:] - 1), rtol=1e-9)
    np.testing.assert_allclose(explained[0], weights @ matrix[1:, 0], rtol=1e-9)


def test_other_users_are_compared_over_the_same_gap() -> None:
    """Gaussian gains correlated over frequency and users (separably): the full linear prediction, by hand."""
    position, coherence, correlation = np.array([0.0, 2.0, 5.0]), 2.0, 0.7
    over_frequency = 1 / (1 + np.subtract.outer(position, position) ** 2 / coherence**2)
    covariance = np.kron(np.array([[1, correlation], [correlation, 1]]), over_frequency)
    relative = 1 + 0.3 * np.random.default_rng(1).normal(size=(2, 3))
    known = np.array([[True, False, True], [True, True, True]])
    inside = known.ravel()
    weights = np.linalg.solve(covariance[np.ix_(inside, inside)], covariance[inside, 1])
    in_frequency = np.linalg.solve(over_frequency[::2, ::2], over_frequency[::2, 1])
    assert in_frequency.sum() < 1
    between = correlation * (np.ones((2, 2)) - np.eye(2))
    surprise, _ = surprise_of_others(relative, relative, known, position, np.full(2, coherence), between)
    expected = 1 + weights @ (relative.ravel()[inside] - 1)
    np.testing.assert_allclose(1 + in_frequency @ (relative[0, ::2] - 1) + surprise[0, 1], expected, rtol=1e-12)


@pytest.mark.parametrize("groups", [[0, 0, 1, 2, 3, 4], [0, 0, 0, 1, 1, 1], [0, 0, 0, 0, 0, 0]])
def test_users_who_move_together_are_found_and_others_are_not(groups: list[int]) -> None:
    rng = np.random.default_rng(4)
    surprise = rng.normal(size=(6, 120))[groups] + 0.3 * rng.normal(size=(6, 120))
    known = rng.random(surprise.shape) < 0.8
    correlation = users.correlation_beyond_chance(surprise, known)
    np.testing.assert_allclose(correlation, correlation.T, rtol=1e-12)
    together = np.equal.outer(groups, groups)
    apart = ~together
    np.fill_diagonal(together, False)
    assert correlation[together].min() > 0.5  # 0.92 in truth
    assert np.all(correlation[apart] < 0.3)
    assert not correlation.diagonal().any()


def test_independent_users_get_no_weight() -> None:
    rng = np.random.default_rng(5)
    known = rng.random((8, 20)) < 0.8
    found = [users.correlation_beyond_chance(rng.normal(size=(8, 20)), known).mean() for _ in range(200)]
    assert np.mean(found) < 0.01


def moving_together(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Eight users of one shape and different levels, independent over frequency, and the same with holes."""
    rng = np.random.default_rng(seed)
    truth = rng.exponential(size=60) * 10.0 ** rng.uniform(-13, -10, (8, 1)) * rng.uniform(0.8, 1.2, (8, 60))
    return truth, np.where(rng.random(truth.shape) < 0.2, NAN, truth)


def test_where_the_other_users_are_missing_too_one_is_less_certain() -> None:
    _, raw = moving_together(10)
    raw[:, 20:40] = np.where(np.arange(8)[:, np.newaxis] == 0, raw[:, 20:40], NAN)
    raw[0, 5:55:2] = NAN
    spread = np.sqrt(Nncf().repair(ChannelObservation(gain=raw)).gain_variance[0])
    assert spread[[21, 25, 29, 33, 37]].mean() > 2 * spread[[7, 11, 15, 43, 47]].mean()


def test_a_user_unseen_gets_no_shape_from_the_others() -> None:
    _, raw = moving_together(10)
    raw[3] = NAN
    gain = Nncf().repair(ChannelObservation(gain=raw)).gain
    assert np.ptp(gain[3]) == 0


def test_spatial_neighbours_are_used_where_users_move_together() -> None:
    truth, raw = moving_together(9)
    estimate = Nncf().repair(ChannelObservation(gain=raw))
    error = ((estimate.gain - truth) / truth.mean(axis=1, keepdims=True))[estimate.repaired]
    assert np.sqrt(np.mean(error**2)) < 0.4  # frequency neighbours alone know nothing here: 1.0

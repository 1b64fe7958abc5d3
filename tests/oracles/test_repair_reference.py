"""The repairers against slow, plain implementations of what they say they compute."""

from __future__ import annotations

import numpy as np
import pytest

from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import users
from wirelessagent.repairing.core.frequency_kernel import two_sided
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


@pytest.mark.parametrize("correlation", [0.2, 0.9])
@pytest.mark.parametrize("num_users", [2, 3, 8])
def test_equally_correlated_users_get_the_best_weights(num_users: int, correlation: float) -> None:
    matrix = np.full((num_users, num_users), correlation) + (1 - correlation) * np.eye(num_users)
    surprise = np.random.default_rng(2).normal(size=(num_users, 5))
    known = np.ones(surprise.shape, dtype=bool)
    moved, explained = users.averaged(surprise, known, matrix - np.eye(num_users))
    weights = np.linalg.solve(matrix[1:, 1:], matrix[1:, 0])
    np.testing.assert_allclose(moved[0], weights @ surprise[1:], rtol=1e-12)
    np.testing.assert_allclose(explained[0], weights @ matrix[1:, 0], rtol=1e-12)


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


def test_spatial_neighbours_are_used_where_users_move_together() -> None:
    rng = np.random.default_rng(9)
    shared = rng.exponential(size=60)
    truth = shared * 10.0 ** rng.uniform(-13, -10, (8, 1)) * rng.uniform(0.95, 1.05, (8, 60))
    seen = ChannelObservation(gain=np.where(rng.random(truth.shape) < 0.2, NAN, truth))
    estimate = Nncf().repair(seen)
    error = (estimate.gain - truth)[estimate.repaired] / np.broadcast_to(
        truth.mean(axis=1, keepdims=True), truth.shape
    )[estimate.repaired]
    assert np.sqrt(np.mean(error**2)) < 0.35  # frequency neighbours alone know nothing here: 1.0

"""Loss patterns: their rates, their shapes, and what they leave as it was."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.sensing import loss
from wirelessagent.sensing.rayleigh import Rayleigh

RATED: list[Callable[[float], loss.LossPattern]] = [
    loss.random,
    loss.bursts,
    loss.subcarriers,
    loss.users,
    loss.when_weak,
]


def exponential_gain(num_slots: int = 500, num_users: int = 8, num_subcarriers: int = 20) -> np.ndarray:
    """Rayleigh gains whose users lie 70 dB apart, so that levels must be taken relative to each user's own."""
    level = 10.0 ** -np.arange(num_users)[:, np.newaxis]
    return level * np.random.default_rng(0).exponential(size=(num_slots, num_users, num_subcarriers))


def struck(pattern: Loss, gain: np.ndarray | None = None, *, seed: int = 1) -> np.ndarray:
    return pattern.missing(exponential_gain() if gain is None else gain, np.random.default_rng(seed))


def runs(lost: np.ndarray) -> np.ndarray:
    """Lengths of the runs of lost entries along the last axis."""
    lengths = []
    for row in lost.reshape(-1, lost.shape[-1]):
        steps = np.diff(np.concatenate([[0], row.astype(int), [0]]))
        lengths.append(np.flatnonzero(steps == -1) - np.flatnonzero(steps == 1))
    return np.concatenate(lengths)


# Rates


@pytest.mark.parametrize("make", RATED)
@pytest.mark.parametrize("rate", [0.01, 0.2, 0.33, 0.5, 0.8])
def test_mean_loss_is_the_rate(make: Callable[[float], loss.LossPattern], rate: float) -> None:
    share = struck(make(rate), exponential_gain(200)).mean(axis=(1, 2))
    assert share.mean() == pytest.approx(rate, abs=4 * share.std() / np.sqrt(share.size) + 1e-12)


@pytest.mark.parametrize("make", [loss.random, loss.when_weak])
def test_a_rate_of_whole_entries_is_exact_in_every_slot(make: Callable[[float], loss.LossPattern]) -> None:
    assert np.all(struck(make(0.2)).sum(axis=(1, 2)) == 32)


@pytest.mark.parametrize("make", RATED)
def test_no_loss_at_rate_zero(make: Callable[[float], loss.LossPattern]) -> None:
    assert not struck(make(0.0)).any()


SMALL_SHAPES = [(200, 1, 3), (200, 2, 4), (200, 1, 1), (200, 2, 1)]


@pytest.mark.parametrize(
    ("make", "shape"),
    [(make, shape) for make in RATED for shape in SMALL_SHAPES if make is not loss.bursts or shape[2] >= 3],
)
def test_a_slot_is_never_lost_whole_below_rate_one(make: Callable[[float], loss.LossPattern], shape: Any) -> None:
    for rate in (0.2, 0.99):
        assert not struck(make(rate), np.ones(shape)).all(axis=(1, 2)).any()


@pytest.mark.parametrize(
    "pattern", [loss.random(1), loss.bursts(1), loss.subcarriers(1), loss.users(8), loss.when_weak(1)]
)
def test_everything_is_lost_when_asked_for(pattern: loss.LossPattern) -> None:
    assert struck(pattern).all()


@pytest.mark.parametrize("make", RATED)
def test_same_seed_same_loss(make: Callable[[float], loss.LossPattern]) -> None:
    pattern = make(0.3)
    np.testing.assert_array_equal(struck(pattern), struck(pattern))
    assert np.any(struck(pattern) != struck(pattern, seed=2))


# Shapes


def test_random_strikes_every_entry_alike() -> None:
    share = struck(loss.random(0.2), exponential_gain(4000)).mean(axis=0)
    np.testing.assert_allclose(share, 0.2, atol=5 * np.sqrt(0.16 / 4000))


@pytest.mark.parametrize("rate", [0.05, 0.2, 0.5])
def test_bursts_are_of_the_lengths_given_and_apart(rate: float) -> None:
    lengths = runs(struck(loss.bursts(rate)))
    assert set(lengths) == {3, 4, 5, 6}
    assert set(runs(struck(loss.bursts(rate, 2, 2)))) == {2}


def test_bursts_run_together_when_there_is_no_room_left() -> None:
    lengths = runs(struck(loss.bursts(0.9), exponential_gain(20)))
    assert lengths.min() >= 3
    assert lengths.max() > 6


def test_a_slots_share_of_bursts_is_near_the_rate() -> None:
    assert np.all(np.abs(struck(loss.bursts(0.3)).sum(axis=(1, 2)) - 48) < 6)


def test_bursts_in_a_narrow_band() -> None:
    assert set(runs(struck(loss.bursts(0.3), np.ones((50, 8, 4))))) <= {3, 4}
    with pytest.raises(InputError, match="bursts of 3 subcarriers do not fit into 2"):
        struck(loss.bursts(0.3), np.ones((1, 8, 2)))


def test_subcarriers_are_lost_for_all_users() -> None:
    lost = struck(loss.subcarriers(0.2))
    np.testing.assert_array_equal(lost.any(axis=1), lost.all(axis=1))
    assert np.all(lost.any(axis=1).sum(axis=1) == 4)


def test_users_are_lost_whole_by_count_or_share() -> None:
    for pattern, number in ((loss.users(3), 3), (loss.users(1), 1), (loss.users(0.25), 2)):
        lost = struck(pattern)
        np.testing.assert_array_equal(lost.any(axis=2), lost.all(axis=2))
        assert np.all(lost.any(axis=2).sum(axis=1) == number)
    with pytest.raises(InputError, match="users:9 cannot be lost of 8 users"):
        struck(loss.users(9))


def test_slots_are_struck_differently() -> None:
    for pattern in (loss.random(0.2), loss.bursts(0.2), loss.subcarriers(0.2), loss.users(1), loss.when_weak(0.2)):
        lost = struck(pattern)
        assert any(np.any(first != second) for first, second in pairwise(lost[:10]))


def test_stale_loses_the_last_slots() -> None:
    lost = struck(loss.stale(2), exponential_gain(5))
    np.testing.assert_array_equal(lost.all(axis=(1, 2)), [False, False, False, True, True])
    np.testing.assert_array_equal(lost.any(axis=(1, 2)), lost.all(axis=(1, 2)))
    assert not struck(loss.stale(0), exponential_gain(1)).any()
    with pytest.raises(InputError, match=r"stale:1 leaves nothing .* num_slots of 2 or more"):
        struck(loss.stale(1), exponential_gain(1))


# Not at random


def test_weak_entries_are_lost_more_often_relative_to_their_user() -> None:
    gain = exponential_gain(2000)
    level = gain / gain.mean(axis=(0, 2), keepdims=True)
    lost = struck(loss.when_weak(0.2), gain)
    np.testing.assert_allclose(lost.mean(axis=(0, 2)), 0.2, atol=0.02)  # no user more than another
    shares = [lost[(level >= low) & (level < low + 0.5)].mean() for low in np.arange(0, 2.5, 0.5)]
    assert all(first > 1.3 * second for first, second in pairwise(shares))
    assert level[lost].mean() < 0.6
    stronger = struck(loss.when_weak(0.2, strength=20), gain)
    assert level[stronger].mean() < 0.5 * level[lost].mean()


def test_few_weak_entries_have_the_stated_odds() -> None:
    """With one of many lost, P(lost) is proportional to exp(−strength · level)."""
    gain = np.tile(np.array([0.0, 2.0] * 50), (20_000, 1, 1))
    lost = struck(loss.when_weak(0.01, strength=1.0), gain)
    odds = lost[..., ::2].sum() / lost[..., 1::2].sum()
    assert odds == pytest.approx(np.exp(2.0), rel=0.08)


def test_strength_zero_is_blind() -> None:
    gain = exponential_gain(2000)
    level = gain / gain.mean(axis=(0, 2), keepdims=True)
    assert level[struck(loss.when_weak(0.2, strength=0), gain)].mean() == pytest.approx(1.0, abs=0.02)


def test_when_weak_takes_holes_and_silent_users() -> None:
    gain = exponential_gain(50)
    gain[:, 0] = 0.0
    gain[:, 1] = np.nan
    gain[:, 2, ::2] = np.nan
    lost = struck(loss.when_weak(0.2), gain)
    assert np.all(lost.sum(axis=(1, 2)) == 32)


# Combined


def test_combined_loses_what_any_part_loses() -> None:
    rng = np.random.default_rng(1)
    parts = [loss.random(0.1), loss.subcarriers(0.1), loss.users(1)]
    masks = [part.missing(exponential_gain(), rng) for part in parts]
    combined = parts[0] | parts[1] | parts[2]
    assert combined == loss.Combined(tuple(parts))
    np.testing.assert_array_equal(struck(combined), np.logical_or.reduce(masks))
    independent = struck(loss.random(0.3) | loss.random(0.5)).mean()
    assert independent == pytest.approx(1 - 0.7 * 0.5, abs=0.005)


@pytest.mark.parametrize("num_slots", [1, 3])
def test_what_is_left_is_bit_identical(num_slots: int) -> None:
    scene = Rayleigh(num_slots=num_slots, speed_km_per_h=3, snr_db=20).observe(Cell(), seed=3)
    pattern = loss.bursts(0.2) | loss.when_weak(0.2)
    seen = scene.observe(pattern, seed=4)
    lost = struck(pattern, scene.sensed.slots, seed=4).reshape(seen.gain.shape)
    np.testing.assert_array_equal(np.isnan(seen.gain), lost)
    assert seen.gain[~lost].tobytes() == scene.sensed.gain[~lost].tobytes()
    assert scene.observe(seed=4).gain.tobytes() == scene.sensed.gain.tobytes()


def test_holes_stay_holes() -> None:
    gain = exponential_gain(1)[0]
    gain[2, :] = np.nan
    scene = Scene(cell=Cell(), sensed=ChannelObservation(gain=gain))
    assert np.isnan(scene.observe(loss.random(0.1), seed=1).gain[2]).all()


# From text


@pytest.mark.parametrize(
    ("text", "pattern"),
    [
        ("random:0.2", loss.random(0.2)),
        (" random : 0.2 ", loss.random(0.2)),
        ("bursts:0.2", loss.bursts(0.2, min_length=3, max_length=6)),
        ("bursts:0.2,2,4", loss.bursts(0.2, 2, 4)),
        ("subcarriers:.1", loss.subcarriers(0.1)),
        ("users:1", loss.users(1)),
        ("users:0.5", loss.users(0.5)),
        ("stale:2", loss.stale(2)),
        ("when_weak:0.3,4", loss.when_weak(0.3, strength=4)),
        ("random:0.1+bursts:0.1", loss.random(0.1) | loss.bursts(0.1)),
        ("random:0.1 + users:1 + stale:1", loss.random(0.1) | loss.users(1) | loss.stale(1)),
    ],
)
def test_parse(text: str, pattern: loss.LossPattern) -> None:
    assert loss.parse(text) == pattern


@pytest.mark.parametrize(
    "text",
    [
        "random", "random:", "random:a", "random:20", "random:20%", "random:-0.1", "random:nan", "random:inf",
        "random:0.1,3", "bursts:0.2,6,3", "bursts:0.2,0", "bursts:0.2,2.5", "bursts:0.2,3,6,9", "users:1.5",
        "users:-1", "stale:1.5", "stale:-1", "stale:0.5", "when_weak:0.2,-1", "random:0.1+", "+", "", ":0.2",
    ],
)  # fmt: skip
def test_parse_errors_name_the_value_and_the_known_patterns(text: str) -> None:
    with pytest.raises(InputError) as caught:
        loss.parse(text)
    message = str(caught.value)
    assert repr(text) in message
    assert all(pattern.usage in message for pattern in loss.PATTERNS.values())
    assert "\n" not in message


def test_parse_suggests_a_pattern() -> None:
    with pytest.raises(UnknownNameError, match="'randm': did you mean 'random'"):
        loss.parse("bursts:0.1+randm:0.2")


def test_every_pattern_is_listed_with_what_it_does() -> None:
    for name, pattern in loss.PATTERNS.items():
        assert pattern.usage.startswith(f"{name}:")
        assert pattern.summary.endswith(".")
        assert pattern.make is getattr(loss, name)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: loss.random(1.01), r"loss rate must be in \[0, 1\]; got 1.01"),
        (lambda: loss.bursts(-0.1), "loss rate must be zero or more"),
        (lambda: loss.bursts(0.1, 0), "min_length must be 1 or more; got 0"),
        (lambda: loss.bursts(0.1, 5, 4), r"max_length must be at least min_length \(5\); got 4"),
        (lambda: loss.users(2.5), "number of users lost must be whole"),
        (lambda: loss.users(float("nan")), "of users lost must be zero or more"),
        (lambda: loss.stale(-1), "stale slots must be 0 or more; got -1"),
        (lambda: loss.when_weak(0.1, float("inf")), "strength must be zero or more and finite"),
    ],
)
def test_bad_parameters_are_refused(make: Callable[[], loss.LossPattern], message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()

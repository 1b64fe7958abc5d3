"""A batch makes the decisions that are made one by one."""

from __future__ import annotations

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.objectives.proportional_fairness import ProportionalFairness
from wirelessagent.testing.channels import known

USERS, SUBCARRIERS = 4, 9
LINKS = {"Shannon": wa.Cell(), "practical": wa.Cell.nr(circuit_power_w=2.0)}
WEIGHTS = (1.0, 2.0, 0.0, 0.5)
PROBLEMS = {
    "rate": wa.Problem("max_rate"),
    "weighted rate, groups, caps": wa.Problem(
        "max_rate", weights=WEIGHTS, resource_block_group_size=2, subcarrier_max_power_w=0.5
    ),
    "rate, promised": wa.Problem("max_rate", min_rate_bps=(5e5, 0.0, 2e5, 1e6)),
    "power": wa.Problem("min_power", min_rate_bps=8e5),
    "power, too much": wa.Problem("min_power", min_rate_bps=5e7),
    "power, nothing promised": wa.Problem("min_power"),
    "efficiency": wa.Problem("max_energy_efficiency"),
    "efficiency, promised": wa.Problem("max_energy_efficiency", min_rate_bps=5e5, max_rate_bps=3e6),
    "fair": wa.Problem("proportional_fairness", max_power_w=1.0),
    "fair, some users": wa.Problem("proportional_fairness", users=("user 1", "user 4"), min_rate_bps=4e5),
    "fair, after a past": wa.Problem(ProportionalFairness(past_average_bps=(1e6, 0.0, 3e6, 1e5))),
    "fair, more users than groups": wa.Problem("proportional_fairness", resource_block_group_size=3),
    "lowest": wa.Problem("max_min_rate"),
    "lowest, shares": wa.Problem("max_min_rate", weights=WEIGHTS, max_rate_bps=4e6),
}


def channels(count: int, seed: int) -> np.ndarray:
    """Gains from −140 to −90 dB, and a user without any in the first channel."""
    rng = np.random.default_rng(seed)
    gain = rng.exponential(size=(count, USERS, SUBCARRIERS)) * 10.0 ** rng.uniform(-14, -9, (count, USERS, 1))
    gain[0, 1] = 0.0
    return gain


@pytest.mark.parametrize("link", LINKS)
@pytest.mark.parametrize("name", PROBLEMS)
def test_a_batch_makes_the_decisions_of_one_by_one(name: str, link: str) -> None:
    gain = channels(6, seed=7)
    batch = wa.decide_batch(gain, PROBLEMS[name], LINKS[link], seed=3)
    for number, one in enumerate(gain):
        decision = wa.decide(known(one), PROBLEMS[name], LINKS[link], "dual", seed=3)
        assert batch.status[number] == decision.status
        np.testing.assert_array_equal(batch.owner[number], decision.owner)
        for field in ("power_w", "rate_bps", "value", "bound"):
            found, expected = getattr(batch, field)[number], getattr(decision, field)
            np.testing.assert_allclose(found, expected, rtol=1e-12, atol=0.0, err_msg=field)
        np.testing.assert_allclose(batch.gap[number], decision.gap, rtol=0.0, atol=1e-12)


def test_threads_and_leading_axes_change_nothing() -> None:
    gain = channels(30, seed=8)
    problem = wa.Problem("max_min_rate")
    alone = wa.decide_batch(gain, problem, workers=1)
    shared = wa.decide_batch(gain.reshape(2, 15, USERS, SUBCARRIERS), problem, workers=3)
    assert shared.owner.shape == (2, 15, SUBCARRIERS)
    assert shared.rate_bps.shape == (2, 15, USERS)
    assert shared.status.shape == shared.gap.shape == (2, 15)
    for field in ("owner", "power_w", "rate_bps", "status", "value", "bound", "gap"):
        one_by_one = getattr(alone, field)
        np.testing.assert_array_equal(getattr(shared, field).reshape(one_by_one.shape), one_by_one)
    np.testing.assert_array_equal(shared.total_power_w, shared.power_w.sum(axis=-1))
    assert shared.is_usable.all()
    with pytest.raises(ValueError, match="read-only"):
        shared.value[0, 0] = 1.0


def test_an_empty_batch_is_empty() -> None:
    assert wa.decide_batch(np.empty((0, 3, 5)), wa.Problem("max_rate")).value.shape == (0,)


@pytest.mark.parametrize(
    ("gain", "message"),
    [
        (np.ones(4), "shape"),
        (np.full((2, 3, 4), np.nan), "complete"),
        (-np.ones((2, 3, 4)), "zero or more"),
        (np.full((2, 3, 4), 1e-9), "workers"),
    ],
)
def test_a_batch_says_what_is_wrong_with_it(gain: np.ndarray, message: str) -> None:
    with pytest.raises(wa.InputError, match=message):
        wa.decide_batch(gain, wa.Problem("max_rate"), workers=0)


def test_a_batch_refuses_what_its_method_does_not_solve() -> None:
    with pytest.raises(wa.InputError, match="outage_probability"):
        wa.decide_batch(channels(2, seed=1), wa.Problem("max_rate", outage_probability=0.1))

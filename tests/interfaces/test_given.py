"""What the library is given by mistake is answered with the call that was meant."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.methods.greedy import Greedy

SCENE = wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1)
ESTIMATE = wa.perfect(SCENE)
HOLED = SCENE.observe(wa.loss.random(0.25), seed=1)
PROBLEM = wa.Problem("max_rate")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((HOLED, PROBLEM), r"an observation with 12 of 48 gains missing: repair it first, as in wa.decide\(wa.repair"),
        ((SCENE, PROBLEM), "got a scene: observe and repair it first"),
        ((ESTIMATE.gain, PROBLEM), r"got an array of shape \(4, 12\): gains go in as"),
        ((ESTIMATE, "max_rate"), r"got 'max_rate': wa.Problem\('max_rate'\) poses it"),
        ((ESTIMATE, PROBLEM, "greedy"), "cell must be a wa.Cell; got 'greedy': a method is named as method='greedy'"),
        ((ESTIMATE, PROBLEM, None, Greedy), r"method must be a registered name or .*Greedy\(…\)"),
    ],
)
def test_wrong_types_are_named_with_the_call_that_was_meant(arguments: Any, told: str) -> None:
    with pytest.raises(wa.InputError, match=told):
        wa.decide(*arguments)


def test_a_batch_of_objects_is_to_be_stacked() -> None:
    with pytest.raises(wa.InputError, match=r"stack them, as in wa.decide_batch\(np.stack"):
        wa.decide_batch([ESTIMATE, ESTIMATE], PROBLEM)  # type: ignore[arg-type]
    with pytest.raises(wa.InputError, match=r"problem must be a wa\.Problem"):
        wa.decide_batch(ESTIMATE.gain, "max_rate")  # type: ignore[arg-type]


def test_repair_takes_observations() -> None:
    with pytest.raises(wa.InputError, match=r"got a scene: observe it first, as in wa.repair\(scene.observe"):
        wa.repair(SCENE)  # type: ignore[arg-type]
    with pytest.raises(wa.InputError, match="missing ones as NaN"):
        wa.repair(HOLED.gain)  # type: ignore[arg-type]


def test_options_beside_an_instance_are_not_dropped() -> None:
    with pytest.raises(wa.InputError, match=r"Greedy\(seed=…\)"):
        wa.decide(ESTIMATE, PROBLEM, method=Greedy(), seed=1)


def test_complex_gains_do_not_lose_their_imaginary_part() -> None:
    coefficients = np.full((2, 3), 1e-5 + 1e-5j)
    for gain in (coefficients, coefficients.tolist(), coefficients.astype(object)):
        with pytest.raises(wa.InputError, match=r"gain must be (real|numbers)"):
            wa.ChannelObservation(gain=gain)
    with pytest.raises(wa.InputError, match=r"\|h\|², np.abs\(h\) \*\* 2"):
        wa.ChannelObservation(gain=coefficients)
    with pytest.raises(wa.InputError, match="gain must be real"):
        wa.decide_batch(coefficients, PROBLEM)
    with pytest.raises(wa.InputError, match="min_rate_bps must be real"):
        wa.Problem("max_rate", min_rate_bps=[1e6 + 1j])  # type: ignore[list-item]


def test_an_earlier_decision_is_for_the_same_users() -> None:
    fair = wa.Problem("proportional_fairness", max_power_w=5)
    three = wa.perfect(wa.simulate("rayleigh", num_users=3, num_subcarriers=12, seed=1))
    earlier = wa.decide(three, fair)
    with pytest.raises(wa.InputError, match="after=… is a decision for 3 users, and the estimate has 4"):
        wa.decide(ESTIMATE, fair, after=earlier)


def test_users_are_served_by_name_and_are_indices_in_what_comes_out() -> None:
    decision = wa.decide(ESTIMATE, wa.Problem("max_rate", users=("user 4", "user 2")))
    assert decision.problem.users == ("user 4", "user 2")
    assert decision.problem.user_indices == (3, 1)
    assert set(decision.owner.tolist()) <= {3, 1}
    batch = wa.decide_batch(ESTIMATE.gain, wa.Problem("max_rate", users=("user 4", "user 2")))
    assert np.array_equal(batch.owner, decision.owner)
    with pytest.raises(wa.InputError, match="no user is called 'Ann'; the channel has user 1, user 2"):
        wa.decide(ESTIMATE, wa.Problem("max_rate", users=("Ann",)))
    with pytest.raises(wa.InputError, match="no user is called '3'; 'user 3' is the whole name of one"):
        wa.decide(ESTIMATE, wa.Problem("max_rate", users=("3",)))
    with pytest.raises(wa.InputError, match="different users"):
        wa.Problem("max_rate", users=("user 2", "user 2"))
    with pytest.raises(wa.InputError, match=r"users=\('user 3',\)"):
        wa.Problem("max_rate", users="user 2")  # type: ignore[arg-type]


@pytest.mark.parametrize("number", [3, np.int64(3)])
def test_a_bare_number_for_a_user_is_refused_with_both_readings(number: Any) -> None:
    """Whoever counts as people do means another user than whoever counts as arrays do."""
    with pytest.raises(wa.InputError, match=r"'user 3', as people count, or .* index 3 .* from 0, .* 'user 4'"):
        wa.Problem("max_rate", users=[number])


def test_a_problem_posed_on_one_channel_is_another_one_elsewhere() -> None:
    asked = wa.Problem("max_rate", users=("Bea",))
    assert asked.for_users(("Ann", "Bea")).user_indices == (1,)
    assert asked.for_users(("Ann", "Bea")).for_users(("Bea", "Ann")).user_indices == (0,)
    assert dataclasses.replace(asked.for_users(("Ann", "Bea")), users=("Ann",)).user_indices == (0,)
    with pytest.raises(wa.InputError, match=r"users are named \('Bea'\), and only the channel knows who that is"):
        asked.serves(2)


def test_messages_call_users_by_their_names() -> None:
    seen = wa.ChannelObservation(gain=ESTIMATE.gain, user_names=("Ann", "Bo", "Cy", "Di"))
    crossed = wa.Problem("max_rate", min_rate_bps=[1e6, 0, 1e6, 0], max_rate_bps=[2e6, 1e6, 5e5, 1e6])
    with pytest.raises(wa.InputError, match=r"1 of 4 users \(Cy: 1 Mbit/s above 500 kbit/s\)"):
        wa.decide(wa.repair(seen), crossed)


def test_the_mask_of_forbidden_pairs_is_explained() -> None:
    with pytest.raises(wa.InputError, match=r"True where a user may not use .*np.zeros\(gain.shape, dtype=bool\)"):
        wa.Problem("max_rate", forbidden=[(1, 5), (1, 6)])  # type: ignore[arg-type]
    with pytest.raises(wa.InputError, match=r"\(user, subcarrier\) = \(4, 12\); got shape \(2, 12\)"):
        wa.decide(ESTIMATE, wa.Problem("max_rate", forbidden=np.zeros((2, 12), dtype=bool)))


def test_messages_show_values_as_people_write_them() -> None:
    with pytest.raises(wa.InputError, match=r"got 0\.0: give a user"):
        wa.Problem("max_rate", weights=0)
    with pytest.raises(wa.InputError, match=r"got -1\.0"):
        wa.Cell(max_power_w=np.float64(-1.0))
    with pytest.raises(
        wa.InputError, match=r"unknown option 'depth' of the method 'paper_inversion': known are deadline_s, steps"
    ):
        wa.decide(ESTIMATE, PROBLEM, method="paper_inversion", depth=1)
    with pytest.raises(wa.InputError, match=r"one per user \(4\); got 3 values"):
        wa.decide(ESTIMATE, wa.Problem("max_rate", min_rate_bps=[1, 2, 3]))

"""Margins against closed forms, brute force, and problems solved anew with other gains, weights and owners."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.telling.facts.accounts import account, bids
from wirelessagent.telling.facts.case import Case

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=4, num_subcarriers=8, seed=6)
ESTIMATE = wa.perfect(SCENE)


def certain(gain: Any) -> wa.ChannelEstimate:
    gain = np.asarray(gain, dtype=float)
    names = tuple(f"user {user + 1}" for user in range(len(gain)))
    return replace(
        ESTIMATE, gain=gain, gain_variance=0 * gain, repaired=gain < 0,
        unobserved_users=np.zeros(len(gain), dtype=bool), user_names=names,
    )  # fmt: skip


def case_of(objective: str, estimate: wa.ChannelEstimate = ESTIMATE, cell: wa.Cell = CELL, **constraints: Any) -> Case:
    return Case(decision=wa.decide(estimate, wa.Problem(objective, **constraints), cell), estimate=estimate)


def test_with_one_price_the_margin_is_the_ratio_of_gains() -> None:
    found = bids(case_of("max_rate"))
    gain = ESTIMATE.gain
    ratio_db = 10 * np.log10(gain.max(axis=0) / gain)
    assert found.owner.tolist() == gain.argmax(axis=0).tolist()
    assert found.behind_db == pytest.approx(ratio_db, abs=1e-9)


def test_a_bid_is_the_most_that_any_power_makes() -> None:
    cell = wa.Cell(max_power_w=20, max_spectral_efficiency_bps_per_hz=8.0)
    limits = {"resource_block_group_size": 2, "subcarrier_max_power_w": 0.1, "max_power_w": 0.3}
    case = case_of("max_rate", cell=cell, weights=(1.0, 2.0, 1.0, 1.5), **limits)
    found, a = bids(case), case.form.snr_per_w
    assert case.decision.is_usable
    assert 0.0 < found.price.max() < 10.0  # so that power counts
    power = np.linspace(0.0, 0.1, 20001)
    for user in range(4):
        nats = np.minimum(np.log1p(a[user][:, np.newaxis] * power), 8.0 * np.log(2))
        most = (found.price[user] * nats - power).max(axis=1).reshape(4, 2).sum(axis=1)
        assert found.bid_w[user] == pytest.approx(most, rel=1e-5, abs=1e-6)


def test_at_the_margin_both_bids_are_the_same() -> None:
    case = case_of("proportional_fairness", resource_block_group_size=2)
    found = bids(case)
    for group, winner in enumerate(found.owner.tolist()):
        first, last = found.start[group], found.start[group + 1] - 1
        loser = int(np.argsort(found.behind_db[:, group])[1])
        gain = ESTIMATE.gain.copy()
        gain[loser, first : last + 1] *= 10 ** (found.behind_db[loser, group] / 10)
        raised = bids(Case(decision=case.decision, estimate=certain(gain)))
        assert raised.bid_w[loser, group] == pytest.approx(found.bid_w[winner, group], rel=1e-9)


def test_a_user_who_gets_nothing_would_with_the_gain_that_it_is_told() -> None:
    case = case_of("max_rate")
    idle = np.flatnonzero(case.decision.rate_bps <= 0).tolist()
    assert idle
    for user in idle:
        told = account(case, user)
        assert told.standing == "outbid"
        assert told.losses[0].behind_db == min(loss.behind_db for loss in told.losses)
        closest = 10 * np.log10((ESTIMATE.gain.max(axis=0) / ESTIMATE.gain[user]).min())
        assert told.losses[0].behind_db == pytest.approx(closest, abs=1e-9)
        for factor, wins in ((10 ** (closest / 10) * 1.02, True), (10 ** (closest / 10) / 1.02, False)):
            gain = ESTIMATE.gain.copy()
            gain[user] *= factor
            found = wa.decide(certain(gain), wa.Problem("max_rate"), CELL)
            assert bool((found.owner == user).any()) is wins
        assert told.promise is not None
        assert (told.promise.after.owner == user).any()
        assert told.promise.change < 0


def test_why_somebody_has_nothing() -> None:
    assert account(case_of("max_rate", users=("user 1", "user 2", "user 3")), 3).standing == "left_out"
    assert account(case_of("min_power", min_rate_bps=(1e5, 0, 0, 0)), 2).standing == "no_promise"
    assert account(case_of("max_rate", weights=(1, 1, 1, 0)), 3).standing == "no_weight"
    assert account(case_of("max_rate", min_rate_bps=1e9), 0).standing == "nothing_decided"
    dead = ESTIMATE.gain.copy()
    dead[1] = 0.0
    assert account(case_of("max_rate", certain(dead)), 1).standing == "no_gain"
    crowd = certain(ESTIMATE.gain[:, :3])
    fair = case_of("proportional_fairness", crowd)
    starved = int(np.flatnonzero(fair.decision.rate_bps <= 0)[0])
    assert account(fair, starved).standing == "no_room"


def test_who_is_left_out_is_told_what_it_would_get() -> None:
    told = account(case_of("max_min_rate", users=("user 1", "user 2", "user 3")), 3)
    alone = wa.decide(ESTIMATE, wa.Problem("max_min_rate"), CELL)
    assert told.included is not None
    assert told.included.value == pytest.approx(alone.value, rel=1e-3)
    assert told.included.rate_bps[3] > 0


def test_a_served_user_is_told_what_it_has() -> None:
    case = case_of("max_rate")
    user = int(np.argmax(case.decision.rate_bps))
    told, own = account(case, user), case.decision.owner == user
    assert (told.standing, told.subcarriers) == ("served", int(own.sum()))
    assert told.power_w == pytest.approx(case.decision.power_w[own].sum())
    assert told.rate_bps == case.decision.rate_bps[user]
    assert all(loss.winner != user for loss in told.losses)


def test_the_chance_to_win_is_that_of_the_posterior() -> None:
    gain, spread = np.array([[4e-11, 4e-11], [1e-11, 1e-12]]), np.zeros((2, 2))
    spread[1, 0] = 1e-22  # of an exponential gain with the mean 1e-11
    repaired = spread > 0
    estimate = replace(certain(gain), gain_variance=spread, repaired=repaired)
    case = case_of("max_rate", estimate)
    told = account(case, 1)
    counted = case.counted.gain[1, 0]
    assert counted < 1e-11
    assert told.losses[0].behind_db == pytest.approx(10 * np.log10(4e-11 / counted), abs=1e-9)
    assert told.losses[0].repaired
    assert told.losses[0].chance == pytest.approx(np.exp(-4), abs=0.01)
    assert told.losses[0].low_db == pytest.approx(10 * np.log10(-np.log(0.95) * 1e-11 / counted), abs=0.5)
    assert told.losses[0].high_db == pytest.approx(10 * np.log10(-np.log(0.05) * 1e-11 / counted), abs=0.2)
    assert np.isnan(told.losses[1].chance)

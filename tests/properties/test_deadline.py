"""What a deadline has found can be found again without one, from the restarts and the steps that it left time for."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.core import time_limit
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.deciding.methods.exact import Exact
from wirelessagent.deciding.objectives.proportional_fairness import ProportionalFairness
from wirelessagent.deciding.soundness import unsound
from wirelessagent.model.errors import InputError
from wirelessagent.testing.channels import known, rayleigh_gain

CELL = wa.Cell(max_power_w=20)
EFFORTS = ("fast", "thorough")
PROBLEMS = {
    "rate": wa.Problem("max_rate", weights=(3.0, 1.0, 1.0, 2.0)),
    "rate, promised": wa.Problem("max_rate", min_rate_bps=8e5),
    "power": wa.Problem("min_power", min_rate_bps=1e6),
    "power, too much": wa.Problem("min_power", min_rate_bps=5e7),
    "efficiency, promised": wa.Problem("max_energy_efficiency", min_rate_bps=1e6),
    "fair, after a past": wa.Problem(ProportionalFairness(past_average_bps=(1e6, 0.0, 3e6, 1e5))),
    "lowest": wa.Problem("max_min_rate"),
}


@pytest.fixture
def ticking(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock by which a millisecond passes whenever the method looks at it, with an alarm that never rings."""
    ticks = itertools.count()
    silent = SimpleNamespace(start=lambda: None, cancel=lambda: None)
    monkeypatch.setattr(time_limit, "time", SimpleNamespace(perf_counter=lambda: next(ticks) / 1e3))
    monkeypatch.setattr(time_limit.threading, "Timer", lambda *_: silent)


def same(one: wa.Decision, other: wa.Decision) -> None:
    """Bit for bit."""
    for field in dataclasses.fields(wa.Decision):
        found, expected = getattr(one, field.name), getattr(other, field.name)
        if field.name == "prices":
            found, expected = found and found.log_rate, expected and expected.log_rate
        if not field.compare:
            continue
        if isinstance(expected, np.ndarray) or expected != expected:
            np.testing.assert_array_equal(found, expected, err_msg=field.name)
        else:
            assert found == expected, field.name


def estimate() -> wa.ChannelEstimate:
    return known(rayleigh_gain(4, 12, seed=3)[0])


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS.keys())
def test_a_deadline_is_replayed_by_its_restarts(problem: wa.Problem, ticking: None) -> None:
    cut = wa.decide(estimate(), problem, CELL, "dual", deadline_s=0.0085, seed=5)
    again = wa.decide(estimate(), problem, CELL, "dual", restarts=cut.restarts, seed=5)
    assert cut.restarts >= 10
    assert (cut.restarts > 10) == cut.is_usable
    same(again, cut)


@pytest.mark.parametrize(
    "method",
    [Dual(), Dual(effort="thorough", deadline_s=600.0), Exact(deadline_s=600.0)],
    ids=["fast", "thorough", "exact"],
)
@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS.keys())
def test_a_search_ends_soundly_after_however_few_steps(problem: wa.Problem, method: wa.Method) -> None:
    channel = estimate()
    whole = wa.decide(channel, problem, CELL, method)
    for steps in {0, 1, 3, 10, whole.steps // 4, whole.steps // 2, max(whole.steps - 1, 0)}:
        cut = wa.decide(channel, problem, CELL, dataclasses.replace(method, steps=steps))
        assert cut.steps == steps or whole.steps <= steps
        assert not list(unsound(cut, channel))
        assert cut.is_usable or cut.reason
        sign = 1.0 if cut.unit != "W" else -1.0
        assert not sign * cut.bound < sign * whole.value
        assert method.name == "dual" or cut.status != "feasible" or cut.reason
    same(wa.decide(channel, problem, CELL, dataclasses.replace(method, steps=whole.steps)), whole)


@pytest.mark.parametrize("deadline_s", [1e-4, 0.01, 0.05])
@pytest.mark.parametrize("name", ["rate, promised", "efficiency, promised", "lowest"])
def test_a_search_that_the_clock_ends_ends_there_again(name: str, deadline_s: float) -> None:
    channel = known(rayleigh_gain(12, 40, seed=4)[0])
    cut = wa.decide(channel, PROBLEMS[name], CELL, "dual", deadline_s=deadline_s)
    assert not list(unsound(cut, channel))
    same(wa.decide(channel, PROBLEMS[name], CELL, "dual", restarts=cut.restarts, steps=cut.steps), cut)


def test_an_alarm_ends_every_search_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    class Rung:
        def __init__(self, _: float, ring: Callable[[], None]) -> None:
            self.start, self.cancel = ring, lambda: None

    monkeypatch.setattr(time_limit.threading, "Timer", Rung)
    for name in ("dual", "exact", "greedy"):
        for problem in PROBLEMS.values():
            cut = wa.decide(estimate(), problem, CELL, name, deadline_s=1e3)
            assert cut.steps == 0
            assert not list(unsound(cut, estimate()))


@pytest.mark.parametrize("name", plugins.names("method"))
def test_every_method_takes_a_deadline(name: str) -> None:
    assert plugins.create("method", name, {"deadline_s": "0.5"}).allowed_s == 0.5
    with pytest.raises(InputError, match="deadline_s must be more than zero"):
        plugins.create("method", name, {"deadline_s": 0.0})


def test_the_older_name_of_a_deadline_means_the_same() -> None:
    for effort in EFFORTS:
        one, other = Dual(effort=effort, deadline_ms=500.0), Dual(effort=effort, deadline_s=0.5)
        assert (one.allowed_s, one.plan) == (other.allowed_s, other.plan)
    with pytest.raises(InputError, match="two names of one limit"):
        Dual(deadline_s=0.5, deadline_ms=500.0)


def test_a_round_begins_only_where_one_like_those_before_ends_in_time(ticking: None) -> None:
    problem = PROBLEMS["lowest"]
    done = [wa.decide(estimate(), problem, CELL, "dual", deadline_ms=ms).restarts for ms in (0.5, 3.9, 4.1, 5.1, 11.1)]
    assert done == [10, 10, 20, 30, 90]


def test_a_deadline_ends_with_the_restarts_that_were_asked_for(ticking: None) -> None:
    few, some = (
        wa.decide(estimate(), PROBLEMS["lowest"], CELL, "dual", deadline_s=1.0, restarts=number) for number in (7, 75)
    )
    assert (few.restarts, some.restarts) == (7, 75)


@pytest.mark.parametrize("name", ["power", "fair, after a past", "lowest"])
def test_more_rounds_are_never_worse(name: str) -> None:
    found = [wa.decide(estimate(), PROBLEMS[name], CELL, "dual", restarts=number) for number in (30, 50, 90)]
    objective = found[0].problem.objective
    assert not isinstance(objective, str)
    sign = 1.0 if objective.direction == "max" else -1.0
    values, bounds = ([sign * getattr(one, field) for one in found] for field in ("value", "bound"))
    assert values == sorted(values)
    assert bounds == sorted(bounds, reverse=True)


def test_a_batch_does_its_restarts_in_the_same_rounds() -> None:
    gain = np.stack([rayleigh_gain(4, 12, seed=seed)[0] for seed in range(3)])
    for problem in (PROBLEMS["power"], PROBLEMS["lowest"], wa.Problem("max_rate")):
        batch = wa.decide_batch(gain, problem, CELL, restarts=65, seed=2)
        for number, one in enumerate(gain):
            decision = wa.decide(known(one), problem, CELL, "dual", restarts=65, seed=2)
            np.testing.assert_array_equal(batch.power_w[number], decision.power_w)


def test_the_least_power_that_is_told_is_that_of_the_decision() -> None:
    """Thorough effort proves more than the search that comes first, and on some of these channels finds better sets."""
    ample = wa.Cell(max_power_w=1e3)
    better = 0
    for seed in range(6):
        channel = known(rayleigh_gain(6, 14, seed=seed)[0])
        hard = wa.Problem("min_power", min_rate_bps=1e6)
        first, last = (
            wa.decide(channel, hard, ample, Dual(effort=one, restarts=0, deadline_s=60.0)) for one in EFFORTS
        )
        assert last.needed_power_w is not None
        assert last.needed_power_w.at_most == pytest.approx(last.value, rel=1e-12)
        assert last.needed_power_w.at_least == pytest.approx(last.bound, rel=1e-12)
        assert last.bound > first.bound * (1 + 1e-6)
        better += last.value < first.value * (1 - 1e-6)
    assert better


@pytest.mark.parametrize(("rate_bps", "effort"), [(5e5, "thorough"), (4e6, "fast"), (4e6, "thorough")])
def test_the_largest_scaling_is_that_of_the_highest_common_rate(rate_bps: float, effort: str) -> None:
    """Thoroughly, or where the promised rates are too much, it is searched for."""
    for seed in range(3):
        channel = known(rayleigh_gain(5, 14, seed=seed)[0])
        promised = wa.decide(channel, wa.Problem("min_power", min_rate_bps=rate_bps), CELL, "dual", effort=effort)
        highest = wa.decide(channel, wa.Problem("max_min_rate"), CELL, "dual")
        scaling = promised.rate_scaling
        assert promised.is_usable == (rate_bps < 1e6)
        assert scaling is not None
        assert highest.value * 0.97 <= scaling.at_least * rate_bps <= highest.bound * (1 + 1e-9)
        assert scaling.at_most * rate_bps <= highest.bound * 1.01

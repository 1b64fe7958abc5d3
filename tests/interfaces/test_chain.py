"""The chain's stages: what is checked before they run."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import chain, plugins
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.errors import UnknownNameError, UnsupportedProblemError
from wirelessagent.operations.compare import _place
from wirelessagent.plugins import Plugin


@dataclass(frozen=True, kw_only=True)
class Needy(wa.Method):
    """A method with an option that has no default, and that honours weights."""

    name = "needy"
    constraints = frozenset({"weights"})

    depth: int

    def solve(self, estimate: wa.ChannelEstimate, problem: wa.Problem, cell: wa.Cell) -> wa.Decision:
        raise AssertionError("nothing is solved here")


def test_a_refusal_names_a_method_that_needs_options(monkeypatch: pytest.MonkeyPatch) -> None:
    needy = Plugin(kind="method", name="needy", package="some-package", target="some:Needy", cls=Needy)
    installed = [*plugins.plugins("method"), needy]
    monkeypatch.setattr(plugins, "plugins", lambda kind: installed)
    with pytest.raises(UnsupportedProblemError, match=r"does not honour weights.*\(.*needy\)"):
        chain.check_solvable(wa.Problem("max_rate", weights=[1.0, 2.0]), "round_robin")


def test_decide_names_the_methods_that_solve_what_one_refuses() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=3, seed=1))
    problem = wa.Problem("proportional_fairness", min_rate_bps=1e3)
    with pytest.raises(UnsupportedProblemError, match=r"'paper_scan' does not solve.*\(.*equal_power.*\)"):
        wa.decide(estimate, problem, method="paper_scan")


@dataclass(frozen=True, kw_only=True)
class Warm(wa.Method):
    """Equal shares that remember what they were given to start from."""

    name = "warm"
    warm_starts = True

    def solve(
        self, estimate: wa.ChannelEstimate, problem: wa.Problem, cell: wa.Cell, *, after: wa.Decision | None = None
    ) -> wa.Decision:
        decision = wa.decide(estimate, problem, cell, method="equal_power")
        reason = "cold" if after is None or after.prices is None else f"warm from {after.prices.log_power:g}"
        return replace(decision, prices=wa.Prices(log_rate=np.zeros(3), log_power=-2.0), reason=reason)


def test_only_methods_that_can_are_given_an_earlier_decision() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=3, seed=1))
    first = wa.decide(estimate, wa.Problem("max_rate"), method=Warm())
    assert first.reason == "cold"
    assert wa.decide(estimate, wa.Problem("max_rate"), method=Warm(), after=first).reason == "warm from -2"
    with pytest.raises(wa.InputError, match="'equal_power' does not start from an earlier decision"):
        wa.decide(estimate, wa.Problem("max_rate"), method="equal_power", after=first)


def test_methods_are_compared_with_their_options() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=3, num_subcarriers=8, seed=1))
    problem = wa.Problem("max_min_rate", max_power_w=1)
    found = wa.compare(estimate, problem, methods=["dual", Dual(effort="thorough"), "greedy"], restarts=2)
    assert [one.method for one in found] == ["dual", "dual (effort=thorough)", "greedy"]
    assert found[0].decision is not None
    assert found[0].decision.restarts == 2
    assert found[1].decision is not None
    assert found[1].decision.restarts != 2
    with pytest.raises(UnknownNameError, match="unknown option 'depth' of the methods greedy"):
        wa.compare(estimate, problem, methods=["greedy"], depth=1)


def test_of_equal_values_what_proves_more_stands_first_and_what_refuses_last() -> None:
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=3, num_subcarriers=8, seed=1))
    one = wa.compare(estimate, wa.Problem("max_rate"), methods=["equal_power"])[0]
    assert one.decision is not None
    loose = replace(one, method="loose", decision=replace(one.decision, gap=0.01, status="feasible"), time_s=1e-6)
    tight = replace(one, method="tight", decision=replace(one.decision, gap=0.001, status="feasible"), time_s=1e-3)
    proven = replace(one, method="proven", decision=replace(one.decision, gap=0.0, status="optimal"), time_s=1.0)
    without = replace(one, method="without", decision=replace(one.decision, gap=np.nan, status="feasible"))
    worse = replace(one, method="worse", decision=replace(one.decision, value=one.decision.value / 2, gap=0.0))
    refused = replace(one, method="refused", decision=None)
    placed = sorted([refused, worse, without, loose, proven, tight], key=_place)
    assert [one.method for one in placed] == ["proven", "tight", "loose", "without", "worse", "refused"]


def test_prices_are_read_only() -> None:
    prices = wa.Prices(log_rate=np.zeros(2), log_power=0.0)
    with pytest.raises(ValueError, match="read-only"):
        prices.log_rate[0] = 1.0


def test_a_problem_that_its_method_solves_passes() -> None:
    chain.check_solvable(wa.Problem("max_rate", max_power_w=3))
    chain.check_solvable(wa.Problem("min_power", min_rate_bps=1e6), "paper_inversion")

"""The contract of methods: allocations that keep every limit, honest figures, certificates that hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from wirelessagent import plugins
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.testing.allocations import allocations
from wirelessagent.testing.channels import known, rayleigh_gain
from wirelessagent.testing.constraints import CONSTRAINTS, NUM_SUBCARRIERS, NUM_USERS
from wirelessagent.testing.contract import TOLERANCE, ValueContract, as_returned, skip

_OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
_EASY_RATE_BPS = 50e3
_IMPOSSIBLE_RATE_BPS = 1e9
_MAX_RATE_BPS = (2e5, np.inf, 1e6, 5e6)
_WEIGHTS = (1.0, 3.0, 0.0, 2.0)


class _Case(NamedTuple):
    """A question to the method."""

    what: str
    estimate: ChannelEstimate
    problem: Problem
    cell: Cell


class MethodContract(ValueContract):
    """Inherit this and set ``method``; it is tried on every objective that it says it solves.

    ``objectives`` gives others, with options, or those of a method that solves all.
    """

    method: Method
    objectives: tuple[Objective, ...] | None = None

    def subject(self) -> Method:
        return self.method

    def test_returns_a_decision(self) -> None:
        for case in self._cases():
            decision = self._solve(case)
            assert isinstance(decision, Decision), f"solve must return a Decision; got {type(decision).__name__}"
            users, subcarriers = case.estimate.gain.shape
            shapes = decision.owner.shape, decision.power_w.shape, decision.rate_bps.shape
            assert shapes == ((subcarriers,), (subcarriers,), (users,)), (
                f"with {case.what} owner, power_w and rate_bps have the shapes {shapes}"
            )
            assert decision.status in ("optimal", "feasible", "infeasible", "undecided"), (
                f"with {case.what} the status is {decision.status!r}"
            )

    def test_says_what_it_solved(self) -> None:
        for case, decision in self._decisions():
            assert decision.method == self.method.name, f"the decision says it is by {decision.method!r}"
            solved, asked = decision.problem, case.problem
            assert solved.objective == asked.objective, f"with {case.what} it solved {solved.objective!r}"
            assert solved.constraints().keys() == asked.constraints().keys(), (
                f"with {case.what} it solved a problem with {sorted(solved.constraints())}"
            )
            assert decision.cell == case.cell, f"with {case.what} the decision carries another cell"
            assert decision.user_names == case.estimate.user_names, f"with {case.what} the users' names were lost"
            unit = _objective(case).unit
            assert decision.unit == unit, f"with {case.what} the unit is {decision.unit!r}, not {unit!r}"

    def test_solves_what_is_easy(self) -> None:
        for case, decision in self._decisions():
            if case.problem.min_rate_bps is None:
                assert decision.is_usable, f"with {case.what} it is {decision.status!r}: {decision.reason}"
            else:  # equal shares would do: not finding that is allowed, a proof of the contrary is not
                assert decision.status != "infeasible", f"with {case.what} it is 'infeasible', though equal shares do"

    def test_owners_exist(self) -> None:
        for case, decision in self._usable():
            owner = decision.owner
            assert np.all((owner >= -1) & (owner < len(decision.rate_bps))), f"with {case.what} the owners are {owner}"

    def test_power_is_not_negative(self) -> None:
        for case, decision in self._usable():
            assert np.all(decision.power_w >= 0), f"with {case.what} a power is {decision.power_w.min():g} W"

    def test_power_is_within_the_budget(self) -> None:
        for case, decision in self._usable():
            budget = case.problem.budget_w(case.cell)
            assert decision.total_power_w <= budget * (1 + TOLERANCE), (
                f"with {case.what} it radiates {decision.total_power_w!r} W of {budget!r} W"
            )

    def test_nobody_means_no_power(self) -> None:
        for case, decision in self._usable():
            lost = decision.power_w[decision.owner < 0].sum()
            assert lost == 0, f"with {case.what} {lost:g} W go to subcarriers that nobody owns"

    def test_rates_follow_from_the_allocation(self) -> None:
        for case, decision in self._usable():
            owner = np.where(decision.owner < len(decision.rate_bps), decision.owner, -1)
            rate = user_rate_bps(case.estimate.gain, owner, np.maximum(decision.power_w, 0), case.cell)
            assert np.allclose(decision.rate_bps, rate, rtol=TOLERANCE, atol=0), (
                f"with {case.what} the rates are {decision.rate_bps}, but owners and powers give {rate}"
            )

    def test_value_is_the_objectives(self) -> None:
        for case, decision in self._usable():
            value = _value(case, decision.rate_bps, decision.total_power_w)
            assert abs(decision.value - value) <= TOLERANCE * abs(value), (
                f"with {case.what} the value is {decision.value!r}, but the objective says {value!r}"
            )

    def test_bound_is_on_the_right_side(self) -> None:
        for case, decision in self._certified():
            assert not _beaten(case, decision, decision.value), (
                f"with {case.what} the value {decision.value!r} is better than its bound {decision.bound!r}"
            )

    def test_bound_is_never_beaten(self) -> None:
        for case, decision in self._certified():
            if _beaten(case, decision, decision.value):
                skip("the bound is on the wrong side of its own value")
            for rate, power_w in allocations(case.estimate.gain, case.problem, case.cell):
                value = _value(case, rate, power_w)
                assert not _beaten(case, decision, value), (
                    f"with {case.what} the bound is {decision.bound!r}, but an allocation reaches {value!r}"
                )

    def test_gap_follows_from_value_and_bound(self) -> None:
        for case, decision in self._usable():
            away, bound = abs(decision.value - decision.bound), abs(decision.bound)
            gap = 0.0 if away == 0 else away / bound if bound > 0 else np.inf
            if np.isnan(decision.bound):
                gap = np.nan
            assert np.isclose(decision.gap, gap, rtol=1e-6, atol=1e-15, equal_nan=True), (
                f"with {case.what} the gap is {decision.gap!r}; |value − bound| / |bound| is {gap!r}"
            )

    def test_optimal_means_no_gap(self) -> None:
        for case, decision in self._certified():
            assert decision.status != "optimal" or decision.gap <= OPTIMAL_GAP, (
                f"with {case.what} it says it is optimal with a gap of {decision.gap:g}"
            )

    def test_is_deterministic(self) -> None:
        for case in self._cases():
            first, again = self._solve(case), self._solve(case)
            if isinstance(first, Decision) and isinstance(again, Decision):
                same = (
                    first.owner.tobytes() == again.owner.tobytes()
                    and first.power_w.tobytes() == again.power_w.tobytes()
                )
                assert same, f"with {case.what} a second call gave another allocation"

    def test_zero_gains_are_no_trouble(self) -> None:
        some = rayleigh_gain(4, 12, seed=3)[0]
        some[1], some[:, 5] = 0.0, 0.0
        for what, gain in {"a user without any channel": some, "no channel at all": np.zeros((3, 4))}.items():
            for objective in self._objectives():
                decision = self.method.solve(known(gain), Problem(objective), Cell())
                figures = np.concatenate([decision.power_w, decision.rate_bps])
                assert np.all(np.isfinite(figures)), f"with {what} powers or rates are not finite: {figures}"
                assert not (decision.is_usable and np.isnan(decision.value)), f"with {what} the value is NaN"

    def test_every_size_is_solved(self) -> None:
        for users, subcarriers in ((1, 1), (1, 6), (6, 1), (6, 3)):
            for objective in self._objectives():
                estimate = known(rayleigh_gain(users, subcarriers, seed=4)[0])
                try:
                    self.method.solve(estimate, Problem(objective), Cell())
                except Exception as error:  # whatever it raises, the size must be named
                    raise AssertionError(
                        f"{objective.name} with {users} users and {subcarriers} subcarriers raised {error!r}"
                    ) from error

    def test_impossible_promises_are_not_made(self) -> None:
        if "min_rate_bps" not in self.method.constraints:
            skip("this method promises no rates")
        for objective in self._objectives():
            problem = Problem(objective, min_rate_bps=_IMPOSSIBLE_RATE_BPS)
            if self._refuses(problem):
                continue
            decision = self.method.solve(known(rayleigh_gain(4, 12, seed=5)[0]), problem, Cell())
            assert decision.status in ("infeasible", "undecided"), (
                f"{objective.name} with 1 Gbit/s for each user is said to be {decision.status!r}"
            )
            assert decision.reason, f"{objective.name} is {decision.status!r} without a reason"
            assert np.isnan(decision.value), (
                f"{objective.name} is {decision.status!r} but has the value {decision.value}"
            )
            radiated = decision.total_power_w
            assert radiated == 0, f"{objective.name} is {decision.status!r} but carries an allocation of {radiated:g} W"

    def test_declared_constraints_are_kept(self) -> None:
        estimate = known(rayleigh_gain(NUM_USERS, NUM_SUBCARRIERS, seed=6)[0])
        for field in self.method.constraints & CONSTRAINTS.keys():
            constraint, answers = CONSTRAINTS[field], 0
            for objective in self._objectives():
                problem = constraint.problem(field, objective)
                if problem is None or self._refuses(problem):  # some objectives and constraints may not go together
                    continue
                answers += 1
                decision = self.method.solve(estimate, problem, Cell())
                assert not decision.is_usable or constraint.is_kept(decision), (
                    f"{objective.name} with {field} = {constraint.value!r} is {decision.status!r} but does not keep it"
                )
            assert answers, f"{field} is among its constraints, but refused with every objective"

    def test_other_constraints_are_refused(self) -> None:
        for field in CONSTRAINTS.keys() - self.method.constraints:
            for objective in self._objectives():
                problem = CONSTRAINTS[field].problem(field, objective)
                assert problem is None or self._refuses(problem), (
                    f"{field} is not among its constraints, but was not refused"
                )

    def test_other_objectives_are_refused(self) -> None:
        if self.method.objectives is None:
            skip("this method solves every objective")
        for name in plugins.names("objective"):
            found = plugins.plugin("objective", name)
            if name not in self.method.objectives and found.cls and not any(o.required for o in found.options):
                assert self._refuses(Problem(found.cls())), f"{name} is not among its objectives, but was not refused"

    def _refuses(self, problem: Problem) -> bool:
        estimate = known(rayleigh_gain(NUM_USERS, NUM_SUBCARRIERS, seed=7)[0])
        try:
            self.method.solve(estimate, problem, Cell())
        except UnsupportedProblemError:
            return True
        return False

    def _objectives(self) -> tuple[Objective, ...]:
        if self.objectives is not None:
            return self.objectives
        names = self.method.objectives or _OBJECTIVES
        return tuple(plugins.objective(name) for name in names)

    def _cases(self) -> Iterator[_Case]:
        """Every objective on a few channels: a cell like the paper's, a small budget, each limit, a practical link."""
        ask: dict[str, dict[str, Any]] = {"20 W": {}, "0.1 W": {"max_power_w": 0.1}}
        if "min_rate_bps" in self.method.constraints:
            ask["50 kbit/s each"] = {"min_rate_bps": _EASY_RATE_BPS}
        if "max_rate_bps" in self.method.constraints:
            ask["a highest rate for some"] = {"max_rate_bps": _MAX_RATE_BPS}
        if "weights" in self.method.constraints:
            ask["weights"] = {"weights": _WEIGHTS}
        for objective in self._objectives():
            for seed, (what, fields) in enumerate(ask.items()):
                if "weights" in fields and objective.measure == "power":
                    continue
                problem = Problem(objective, **fields)
                if fields and self._refuses(problem):
                    continue
                estimate = known(rayleigh_gain(4, 12, seed=20 + seed)[0])
                for link, cell in {"Shannon's link": Cell(), "a practical link": Cell.nr()}.items():
                    yield _Case(f"{objective.name}, {what}, {link}", estimate, problem, cell)

    def _solve(self, case: _Case) -> object:
        return as_returned(self.method.solve(case.estimate, case.problem, case.cell))

    def _decisions(self) -> Iterator[tuple[_Case, Decision]]:
        for case in self._cases():
            try:
                decision = self._solve(case)
            except Exception:  # noqa: BLE001  # test_returns_a_decision reports it
                skip("no decision was returned")
            if not isinstance(decision, Decision) or len(decision.rate_bps) != case.estimate.num_users:
                skip("no decision was returned")
            yield case, decision

    def _usable(self) -> Iterator[tuple[_Case, Decision]]:
        return ((case, decision) for case, decision in self._decisions() if decision.is_usable)

    def _certified(self) -> Iterator[tuple[_Case, Decision]]:
        return ((case, decision) for case, decision in self._usable() if not np.isnan(decision.bound))


def _objective(case: _Case) -> Objective:
    assert isinstance(case.problem.objective, Objective)
    return case.problem.objective


def _value(case: _Case, rate_bps: FloatArray, power_w: float) -> float:
    return _objective(case).value(rate_bps, power_w, case.cell, case.problem.weights_of(len(rate_bps)))


def _beaten(case: _Case, decision: Decision, value: float) -> bool:
    """Whether ``value`` is better than the bound, beyond rounding."""
    better = decision.bound - value if _objective(case).direction == "min" else value - decision.bound
    return better > TOLERANCE * abs(decision.bound)

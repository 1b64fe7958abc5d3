"""Whatever a method answers is checked before it leaves: promises, budget and caps to the last bit, bounds unbeaten."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.core.exact_powers import to_the_last_bit
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.deciding.methods.exact import Exact
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.errors import PluginError, UnsupportedProblemError
from wirelessagent.testing.channels import known, rayleigh_gain
from wirelessagent.testing.random_problems import random_problem, tiny_problem

OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
METHODS = {
    "dual": Dual(),
    "thorough": Dual(effort="thorough", deadline_s=600.0),
    "exact": Exact(deadline_s=600.0),
    "cut short": Dual(effort="thorough", steps=40),
    **{name: plugins.create("method", name) for name in plugins.names("method") if name not in ("dual", "exact")},
}


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_limits_are_kept_to_the_last_bit_and_bounds_are_not_beaten(name: str, objective: str) -> None:
    for seed in range(12):
        users, subcarriers = 2 + seed % 3, 3 + seed % 6
        case = random_problem(seed, plugins.objective(objective), num_users=users, num_subcarriers=subcarriers)
        try:
            decision = wa.decide(case.estimate, case.problem, case.cell, METHODS[name])
        except UnsupportedProblemError:
            continue
        assert decision.is_usable or decision.reason
        if not decision.is_usable:
            continue
        promised = np.where(decision.problem.serves(users), decision.problem.min_rates_bps(users), 0.0)
        assert (decision.rate_bps >= promised).all()
        assert decision.total_power_w <= case.problem.budget_w(case.cell)
        if case.problem.subcarrier_max_power_w is not None:
            assert (decision.power_w <= np.asarray(case.problem.subcarrier_max_power_w)).all()
        sign = 1.0 if plugins.objective(objective).direction == "max" else -1.0
        assert not sign * decision.value > sign * decision.bound


def test_tiny_promises_are_kept_by_every_search() -> None:
    """Levels lose the digits of rates as small as these: a thorough search once left 7e-8 of one missing."""
    for seed in range(8):
        rng = np.random.default_rng(seed)
        gain = rayleigh_gain(3, 6, seed=seed)[0] * 10.0 ** rng.uniform(-6, 0, (3, 1))
        problem = wa.Problem("min_power", min_rate_bps=10.0 ** rng.uniform(-3, 2, 3))
        for method in (Dual(), Dual(effort="thorough", deadline_s=600.0), Exact(deadline_s=600.0)):
            decision = wa.decide(known(gain), problem, wa.Cell(), method)
            if decision.is_usable:
                assert (decision.rate_bps >= problem.min_rates_bps(3)).all()
                assert decision.value >= decision.bound


def test_what_rounding_leaves_short_is_made_up_by_who_has_more() -> None:
    estimate = known(rayleigh_gain(3, 9, seed=1)[0])
    problem = wa.Problem(MaxRate(), min_rate_bps=(4e5, 0.0, 4e5))
    decision = wa.decide(estimate, problem, wa.Cell())
    form = NormalForm.of(Dual(), estimate, problem, wa.Cell())
    assert decision.total_power_w == pytest.approx(form.budget_w, rel=1e-12)
    for off in (1.0 - 1e-12, 1.0 + 1e-12):
        power_w = to_the_last_bit(form, estimate.gain, decision.owner, decision.power_w * off)
        rate = wa.model.rates.user_rate_bps(estimate.gain, decision.owner, power_w, wa.Cell())
        assert (rate >= form.promised_bps).all()
        assert power_w.sum() <= form.budget_w
        np.testing.assert_allclose(power_w, decision.power_w, rtol=1e-10)


def test_the_bound_of_a_power_under_another_objective_is_the_higher_one() -> None:
    """Whether rates can be carried is asked before the most rate is, and what is proven of that is kept."""
    found = {}
    for seed in range(60):
        case = random_problem(seed, MaxRate(), num_users=4, num_subcarriers=6)
        if case.problem.min_rate_bps is not None:
            decision = wa.decide(case.estimate, case.problem, case.cell, Exact(deadline_s=600.0))
            found[seed] = decision.status
    assert "undecided" not in found.values()
    assert {"optimal", "infeasible"} <= set(found.values())


def test_a_level_is_not_left_at_zero() -> None:
    """The sets of the promises leave others with nothing; a search cut short has hardly any sets at all."""
    case = tiny_problem(39, tuple(plugins.objective(name) for name in OBJECTIVES))
    assert wa.decide(case.estimate, case.problem, case.cell, "dual").value > 0
    estimate = known(rayleigh_gain(12, 30, seed=2)[0])
    for name in ("max_min_rate", "proportional_fairness"):
        for method in ("dual", "greedy"):
            values = [wa.decide(estimate, wa.Problem(name), wa.Cell(), method, steps=n).value for n in (0, 20, 10**6)]
            assert 0 < values[0] < values[2]
            assert values[1] > 0


FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "budget": ({"power_w": np.full(6, 1e3)}, "above the budget"),
    "cap": ({"power_w": np.full(6, 2.0)}, "above the caps"),
    "short": ({"power_w": np.full(6, 1e-9)}, "fall short of the promised"),
    "nobody": ({"owner": np.full(6, -1)}, "power goes to nobody"),
    "nonsense": ({"power_w": np.full(6, np.nan)}, "make no sense"),
    "bound": ({"bound": 1.0}, "beyond its bound"),
    "value": ({"value": 1.0}, "but the objective says"),
    "shape": ({"owner": np.zeros(5, dtype=np.int64)}, "have the shapes"),
}


@dataclass(frozen=True, kw_only=True)
class Faulty(wa.Method):
    """A third party's, which spoils the dual's decision."""

    name = "faulty"
    constraints = Dual.constraints

    fault: str = ""

    def solve(self, estimate: wa.ChannelEstimate, problem: wa.Problem, cell: wa.Cell) -> wa.Decision:
        found = Dual().solve(estimate, problem, cell)
        changed = dataclasses.replace(found, method=self.name, **FAULTS[self.fault][0] if self.fault else {})
        if self.fault in ("budget", "cap", "short"):
            rate = wa.model.rates.user_rate_bps(estimate.gain, changed.owner, changed.power_w, cell)
            value = float(rate.sum())
            changed = dataclasses.replace(changed, rate_bps=rate, value=value, bound=2.0 * value, gap=0.5)
        return changed


@pytest.mark.parametrize("fault", FAULTS)
def test_an_unsound_decision_of_any_method_does_not_leave(fault: str) -> None:
    estimate = known(rayleigh_gain(2, 6, seed=2)[0])
    problem = wa.Problem("max_rate", min_rate_bps=2e4, subcarrier_max_power_w=1.0, max_power_w=15.0)
    assert wa.decide(estimate, problem, wa.Cell(), Faulty()).is_usable
    with pytest.raises(PluginError, match=f"decision of the method 'faulty' is not sound: .*{FAULTS[fault][1]}"):
        wa.decide(estimate, problem, wa.Cell(), Faulty(fault=fault))

"""What is proven holds, or nobody is told that it does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.core.certificate import judged
from wirelessagent.deciding.core.closed_form import nats_worth
from wirelessagent.deciding.core.dual_bounds import bound_of
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.program import Program
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.deciding.objectives.min_power import MinPower
from wirelessagent.model.errors import PluginError, UnsupportedProblemError
from wirelessagent.telling.explanation import Proofs, explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.testing.judge import verdict_on
from wirelessagent.testing.kinked import KinkedLogarithm

ESTIMATE = wa.perfect(wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1))


@dataclass(frozen=True, kw_only=True)
class Logarithm(wa.Objective):
    """Σ ln r with a conjugate that is too small by ``short``."""

    name = "logarithm"

    short: float = 2.5

    def utility(self, rate):
        with np.errstate(divide="ignore"):
            return np.log(rate)

    def conjugate(self, price, min_rate, max_rate):
        with np.errstate(divide="ignore"):
            rate = np.clip(1 / price, min_rate, max_rate)
        payment = np.multiply(price, rate, where=price > 0, out=np.zeros_like(rate))
        return self.utility(rate) - payment - self.short, rate


@dataclass(frozen=True, kw_only=True)
class Bold(wa.Method):
    """All power to one pair, with a bound out of the blue."""

    name = "bold"
    constraints = frozenset({"users"})

    def solve(self, estimate, problem, cell):
        from wirelessagent.deciding.core.certificate import certified
        from wirelessagent.deciding.core.normal_form import NormalForm

        form = NormalForm.of(self, estimate, problem, cell)
        owner = np.full(estimate.num_subcarriers, -1)
        power_w = np.zeros(estimate.num_subcarriers)
        owner[0], power_w[0] = 0, form.budget_w
        return certified(form, owner, power_w, bound=1.0)


def test_a_wrong_conjugate_is_named_with_a_rate_that_shows_it() -> None:
    told = r"'logarithm' .* above the bound .* 'dual'.*conjugate of .* 'logarithm' is wrong: at the price .* at r = "
    with pytest.raises(PluginError, match=told):
        wa.decide(ESTIMATE, wa.Problem(Logarithm()))
    with pytest.raises(PluginError, match=told):
        wa.decide_batch(ESTIMATE.gain[np.newaxis], wa.Problem(Logarithm()))
    assert wa.decide(ESTIMATE, wa.Problem(Logarithm(short=0.0))).is_usable


def test_a_wrong_bound_of_a_method_is_the_methods() -> None:
    with pytest.raises(wa.WirelessAgentError, match="bound of 'bold' is wrong"):
        wa.decide(ESTIMATE, wa.Problem("max_rate"), method=Bold())
    with pytest.raises(PluginError, match=r"Either the conjugate .* or the bound of 'bold' is wrong"):
        wa.decide(ESTIMATE, wa.Problem(Logarithm(short=0.0), users=("user 1",)), method=Bold())


def test_rounding_is_forgiven_on_both_sides() -> None:
    assert judged(MaxRate(), 1.0 + 1e-13, 1.0, "any") == (1.0 + 1e-13, 0.0, "optimal")
    assert judged(MinPower(), 1.0 - 1e-8, 1.0, "any")[1] == pytest.approx(1e-8)
    with pytest.raises(wa.WirelessAgentError, match="below the bound"):
        judged(MinPower(), 1.0 - 1e-5, 1.0, "any")
    assert judged(MaxRate(), -np.inf, -np.inf, "any")[1] == 0.0


# What a bound rests on


def planted(seed: int) -> tuple[wa.ChannelEstimate, KinkedLogarithm]:
    """A channel of two users, and corners that lie between all rates at which the logarithm might be recognised.

    Those are the fair rates, and parts of the rates around which a search meets utilities.
    """
    estimate = wa.perfect(wa.simulate("rayleigh", num_users=2, num_subcarriers=4, seed=seed))
    fair = wa.Problem(plugins.objective("proportional_fairness"))
    form = NormalForm.of(Dual(), estimate, fair, wa.Cell())
    around = Program.of(form).rows[:, 2] * form.bps_per_nat
    found = wa.decide(estimate, fair, method="exact").rate_bps
    knots = np.sort(np.column_stack([np.outer(around, [0.1, 0.5, 1.0, 2.0]), found]))
    return estimate, KinkedLogarithm(knots=tuple(tuple(map(float, row)) for row in knots))


@pytest.mark.parametrize("seed", [6, 12])
@pytest.mark.parametrize(("method", "options"), [("dual", {"effort": "thorough"}), ("exact", {}), ("greedy", {})])
def test_corners_that_no_sample_meets_make_no_bound_wrong(seed: int, method: str, options: dict[str, str]) -> None:
    estimate, objective = planted(seed)
    best = verdict_on(estimate, wa.Problem(objective), wa.Cell()).best
    assert best is not None
    decision = wa.decide(estimate, wa.Problem(objective), method=method, **options)
    assert decision.bound >= best.value * (1 - 1e-9)


@dataclass(frozen=True, kw_only=True)
class Mute(KinkedLogarithm):
    """It can be priced, but says of no rate what it is worth."""

    def utility(self, rate):
        raise AssertionError("a utility was sampled")

    def conjugate(self, price, min_rate, max_rate):
        return KinkedLogarithm().conjugate(price, min_rate, max_rate)


@pytest.mark.parametrize("measure", ["utility", "efficiency"])
def test_a_bound_asks_for_no_utility(measure: str) -> None:
    asked = type("Asked", (KinkedLogarithm,), {"measure": measure, "figure": wa.Objective.figure})()
    mute = type("Muted", (Mute,), {"measure": measure, "figure": wa.Objective.figure})()
    form, silent = (NormalForm.of(Dual(), ESTIMATE, wa.Problem(each), wa.Cell()) for each in (asked, mute))
    program, price = Program.of(form), np.full(4, -1.0)
    assert bound_of(silent, program, price, 0.0) == bound_of(form, program, price, 0.0)
    assert nats_worth(silent) is None


@dataclass(frozen=True, kw_only=True)
class Straight(wa.Objective):
    """The rate itself, which it may or may not declare."""

    name = "straight"
    unit = "bit/s"

    declared: bool = False

    def utility(self, rate):
        return rate

    def conjugate(self, price, min_rate, max_rate):
        return MaxRate().conjugate(price, min_rate, max_rate)

    def power_law(self):
        return 0.0 if self.declared else None


def test_a_closed_form_is_chosen_by_declaration() -> None:
    best = wa.decide(ESTIMATE, wa.Problem("max_rate"))
    for declared in (True, False):
        found = wa.decide(ESTIMATE, wa.Problem(Straight(declared=declared)))
        assert (found.prices is None) == declared  # a closed form needs none
        assert found.bound >= best.value * (1 - 1e-12)
        assert found.value == pytest.approx(best.value, rel=1e-9)


@pytest.mark.parametrize(
    ("objective", "told"),
    [
        (KinkedLogarithm(), "the conjugate that kinked_logarithm states"),
        (plugins.objective("proportional_fairness", {"past_average_bps": 1e6}), "the conjugate that"),
        (plugins.objective("proportional_fairness"), "declares a rate r to be worth, ln r,"),
        (plugins.objective("max_min_rate"), "a higher rate is worth no less"),
    ],
)
def test_the_report_says_what_the_bound_rests_on(objective: wa.Objective, told: str) -> None:
    decision = wa.decide(ESTIMATE, wa.Problem(objective, max_power_w=1))
    assert told in Proofs(Case(decision=decision, estimate=ESTIMATE), "en").proof()


def test_the_report_on_somebody_elses_objective_says_so_at_once() -> None:
    decision = wa.decide(ESTIMATE, wa.Problem(Straight(declared=True)))
    assert any("straight declares a rate r to be worth, r," in said for said in explain(ESTIMATE, wa.report(decision)))


def test_an_efficiency_that_no_bound_is_known_for_is_refused() -> None:
    smallest = type("Smallest", (Straight,), {"measure": "efficiency", "joined": "min"})()
    with pytest.raises(UnsupportedProblemError, match="'straight' is an efficiency, so joined must be 'sum'"):
        wa.decide(ESTIMATE, wa.Problem(smallest))

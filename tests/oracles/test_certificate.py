"""What is proven holds, or nobody is told that it does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.deciding.core.certificate import judged
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.deciding.objectives.min_power import MinPower
from wirelessagent.model.errors import PluginError

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
        wa.decide(ESTIMATE, wa.Problem(Logarithm(short=0.0), users=(0,)), method=Bold())


def test_rounding_is_forgiven_on_both_sides() -> None:
    assert judged(MaxRate(), 1.0 + 1e-13, 1.0, "any") == (1.0 + 1e-13, 0.0, "optimal")
    assert judged(MinPower(), 1.0 - 1e-8, 1.0, "any")[1] == pytest.approx(1e-8)
    with pytest.raises(wa.WirelessAgentError, match="below the bound"):
        judged(MinPower(), 1.0 - 1e-5, 1.0, "any")
    assert judged(MaxRate(), -np.inf, -np.inf, "any")[1] == 0.0

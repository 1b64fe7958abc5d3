"""P1 as the paper has it: water-filling by bisection on the multiplier λ of the power budget."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.bounds import rate_bound_nats
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class PaperBisection(Method):
    """The paper's P1: best user per subcarrier, p = [1/λ − N0 B/g]⁺ with λ by bisection; eqs. (8) and (9).

    The paper gives no tolerance; ours is relative to the budget. The result never exceeds the budget, and its gap to
    the dual bound at its own λ shows what the bisection left undone.

    Attributes:
        tolerance: share of the budget that may stay unspent.
        max_iterations: halvings of the interval of λ at most.
    """

    name = "paper_bisection"
    objectives = ("max_rate",)
    constraints = frozenset({"users", "forbidden", "subcarrier_max_power_w"})

    tolerance: float = 1e-6
    max_iterations: int = 100

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.tolerance >= 0 or self.max_iterations < 1:
            raise InputError(
                "tolerance must be zero or more and max_iterations one or more; "
                f"got {self.tolerance!r} and {self.max_iterations!r}"
            )

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        form = NormalForm.of(self, estimate, problem, cell)
        snr = form.best_snr_per_w
        cap_w = form.caps_w(snr)
        low, high, iterations = 0.0, float(snr.max()), 0
        if cap_w.sum() <= form.budget_w:  # also where nothing can be used
            high = 0.0
        while iterations < self.max_iterations and high > 0.0:
            middle = 0.5 * (low + high)
            spent = float(_power_w(snr, cap_w, middle).sum())
            iterations += 1
            if spent > form.budget_w:
                low = middle
            else:
                high = middle
                if spent >= form.budget_w * (1.0 - self.tolerance):
                    break
        power_w = _power_w(snr, cap_w, high)
        owner = np.where(power_w > 0, form.snr_per_w.argmax(axis=0), -1)
        bound = float(rate_bound_nats(form, high)) * form.bps_per_nat
        return certified(
            form, owner, power_w, bound, price_of_power=high * form.bps_per_nat, iterations=iterations
        )  # fmt: skip


def _power_w(snr_per_w: FloatArray, cap_w: FloatArray, price: float) -> FloatArray:
    """[1/λ − 1/a]⁺ up to the cap; the cap at the price 0."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        power = np.where(snr_per_w > price, (snr_per_w - price) / price / snr_per_w, 0.0)
    return np.minimum(power, cap_w)

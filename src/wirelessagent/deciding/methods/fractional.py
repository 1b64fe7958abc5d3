"""P3 exactly: the most bits per joule by Dinkelbach's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.bounds import efficiency_bound_nats_per_j
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

_ROUNDING = 1e-12
"""Share of the budget that a sum of powers may miss it by."""
_APPROACHED = (
    "without circuit power less power is always more efficient: the best efficiency is only approached "
    "as the power goes to 0, here to 1e-12 of it"
)


@dataclass(frozen=True, kw_only=True)
class Fractional(Method):
    """The best energy efficiency: best user per subcarrier, power by Dinkelbach's method; exact where the paper scans.

    The bound is the smallest efficiency q whose dual, min over μ ≥ q of Φ(1, μ) + (μ − q) P_max − q ξ P_c, is not
    positive. Without circuit power the efficiency only approaches its supremum as the power goes to 0; the power given
    then is so small that less than 1e-12 of it is lost, and the decision's reason says so.
    """

    name = "fractional"
    objectives = ("max_energy_efficiency",)
    constraints = frozenset({"users", "forbidden", "subcarrier_max_power_w"})

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        from wirelessagent.deciding.core.fractional_kernel import max_efficiency

        form = NormalForm.of(self, estimate, problem, cell)
        owner, power_w, price, iterations = max_efficiency(
            form.snr_per_w[np.newaxis], form.cap_w, form.max_snr, np.array([form.budget_w]), form.circuit_w
        )
        bound = efficiency_bound_nats_per_j(form, float(price[0]))
        bit_per_nat = form.bps_per_nat * cell.amplifier_efficiency
        # Where the budget binds, a watt more brings μ nats and costs q of them, spread over P + C; elsewhere nothing.
        binds = float(power_w[0].sum()) >= form.budget_w * (1.0 - _ROUNDING)
        surplus = max(float(price[0]) - bound, 0.0) / (form.budget_w + form.circuit_w) if binds else 0.0
        return certified(
            form,
            owner[0],
            power_w[0],
            bound * bit_per_nat,
            reason=_APPROACHED if form.circuit_w == 0.0 and power_w[0].any() else "",
            price_of_power=surplus * bit_per_nat,
            iterations=int(iterations[0]),
        )

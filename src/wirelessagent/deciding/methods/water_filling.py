"""P1 exactly: the best user on each subcarrier, and water-filling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.bounds import rate_bound_nats
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class WaterFilling(Method):
    """The largest sum rate: best user per subcarrier and exact water-filling, with caps; eqs. (8) and (9).

    The level is found by projection instead of the paper's bisection (:class:`PaperBisection`), exact to rounding.
    The bound is the Lagrangian dual at the level's price, Φ(1, μ) + μ P_max, so the gap proves the optimum. Weights are
    left to other methods: with them the best user changes with the level, and water-filling is no longer exact.
    """

    name = "water_filling"
    objectives = ("max_rate",)
    constraints = frozenset({"users", "forbidden", "subcarrier_max_power_w"})

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        from wirelessagent.deciding.core.water_filling_kernel import max_rate

        form = NormalForm.of(self, estimate, problem, cell)
        owner, power_w, price = max_rate(
            form.snr_per_w[np.newaxis], form.cap_w, form.max_snr, np.array([form.budget_w])
        )  # fmt: skip
        mu = float(price[0])
        bound = rate_bound_nats(form, mu) * form.bps_per_nat
        return certified(form, owner[0], power_w[0], bound, price_of_power=mu * form.bps_per_nat)

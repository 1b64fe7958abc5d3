"""A baseline: the best user on each subcarrier, all subcarriers at the same power."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.equal_shares import equal_shares
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class EqualPower(Method):
    """Baseline: the best user on each subcarrier, and the budget (or a fixed power) split evenly.

    Promised rates are not aimed at; a problem with them is solved if they happen to be kept, and undecided if not.

    Attributes:
        power_w: the total power to radiate, at most the budget; the whole budget if not set.
    """

    name = "equal_power"
    constraints = frozenset({"min_rate_bps", "users", "forbidden", "subcarrier_max_power_w"})

    power_w: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.power_w is not None and not 0 < self.power_w < np.inf:
            raise InputError(f"power_w must be more than zero and finite; got {self.power_w!r}")

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        form = NormalForm.of(self, estimate, problem, cell)
        total_w = form.budget_w if self.power_w is None else self.power_w
        if total_w > form.budget_w * (1 + 1e-12):
            raise InputError(
                f"power_w = {total_w:g} W is above the budget of {form.budget_w:g} W: "
                "ask for less, or raise the problem's max_power_w"
            )
        return equal_shares(form, form.snr_per_w.argmax(axis=0), total_w)

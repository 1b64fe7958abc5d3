"""A baseline: users in turn, whatever their channels, all subcarriers at the same power."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.equal_shares import equal_shares
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class RoundRobin(Method):
    """Baseline: subcarrier n goes to user n mod K, and the budget is split evenly over those that can be used.

    K counts the users to serve; a subcarrier that is forbidden to the user whose turn it is stays empty. Promised rates
    are not aimed at; a problem with them is solved if they happen to be kept, and undecided if not.
    """

    name = "round_robin"
    constraints = frozenset({"min_rate_bps", "users", "forbidden", "subcarrier_max_power_w"})

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        form = NormalForm.of(self, estimate, problem, cell)
        users = np.flatnonzero(form.problem.serves(estimate.num_users))
        return equal_shares(form, users[np.arange(estimate.num_subcarriers) % users.size], form.budget_w)

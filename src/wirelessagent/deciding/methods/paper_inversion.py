"""P2 as the paper has it: pre-assigned sets and channel inversion at equal rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.promises import least_power_decision
from wirelessagent.deciding.core.rate_proof import ceilings
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class PaperInversion(Method):
    """The paper's P2: each user's ⌊N/K⌋ best subcarriers, p = (2^(R/(B|S|)) − 1) N0 B/g on each; eq. (10).

    The paper's sets S_k may overlap, ours never do: the users with a promised rate take turns in their order, each turn
    taking the best subcarrier that is still free. K counts those users. It is a heuristic, judged by the same bound as
    :class:`Dual`.
    """

    name = "paper_inversion"
    objectives = ("min_power",)
    constraints = frozenset({"min_rate_bps", "users", "forbidden", "subcarrier_max_power_w"})

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        form = NormalForm.of(self, estimate, problem, cell)
        owner = _take_turns(form.snr_per_w, np.flatnonzero(form.promised_nats > 0))
        ceiling = ceilings(form, form.snr_per_w)

        def allocate(nats: FloatArray) -> tuple[IntArray, FloatArray]:
            power_w = np.zeros(owner.size)
            for user in np.flatnonzero(nats > 0):
                mine = np.flatnonzero(owner == user)
                rate = nats[user] / mine.size if mine.size else np.inf
                if np.any(ceiling[user, mine] < rate * (1.0 - 1e-12)) or not mine.size:
                    return owner, np.full(owner.size, np.inf)
                with np.errstate(over="ignore"):
                    power_w[mine] = np.expm1(rate) / form.snr_per_w[user, mine]
            return owner, power_w

        return least_power_decision(form, allocate)


def _take_turns(snr_per_w: FloatArray, users: IntArray) -> IntArray:
    """Owners (subcarrier,), −1 for nobody: ⌊N/K⌋ turns in which each user takes its best free subcarrier."""
    subcarriers = snr_per_w.shape[1]
    owner = np.full(subcarriers, -1)
    for _ in range(subcarriers // users.size if users.size else 0):
        for user in users:
            free = np.where(owner < 0, snr_per_w[user], 0.0)
            best = int(free.argmax())
            if free[best] > 0.0:
                owner[best] = user
    return owner

"""P3 as the paper has it: a scan over L levels of the total power."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.bounds import best_efficiency_nats_per_j
from wirelessagent.deciding.core.certificate import certified
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

MAX_LEVELS = 100_000
"""Most levels taken: the loss of the grid is then far below 1e-9, and the powers of all levels are held at once."""


@dataclass(frozen=True, kw_only=True)
class PaperScan(Method):
    """The paper's P3: max rate at each of L power levels in (0, P_max], and the best ratio of them; eq. (11).

    The levels are P_max l/L. The bound is the exact method's, so the gap shows what the grid costs.

    Attributes:
        num_levels: number L of power levels tried.
    """

    name = "paper_scan"
    objectives = ("max_energy_efficiency",)
    constraints = frozenset({"users", "forbidden", "subcarrier_max_power_w"})

    num_levels: int = 100

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 1 <= self.num_levels <= MAX_LEVELS:
            raise InputError(f"num_levels must be from 1 to {MAX_LEVELS:,}; got {self.num_levels!r}")

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        from wirelessagent.deciding.core.water_filling_kernel import max_rate

        form = NormalForm.of(self, estimate, problem, cell)
        snr = form.best_snr_per_w
        level_w = form.budget_w * np.arange(1, self.num_levels + 1) / self.num_levels
        rows = np.ascontiguousarray(np.broadcast_to(snr, (self.num_levels, 1, snr.size)))
        _, power_w, _ = max_rate(rows, form.cap_w, form.max_snr, level_w)
        rate = np.log1p(power_w * snr).sum(axis=1)
        best = int(np.argmax(rate / (power_w.sum(axis=1) + form.circuit_w))) if snr.any() else 0
        owner = np.where(power_w[best] > 0, form.snr_per_w.argmax(axis=0), -1)
        bound = best_efficiency_nats_per_j(form) * form.bps_per_nat * cell.amplifier_efficiency
        return certified(form, owner, power_w[best], bound, iterations=self.num_levels)

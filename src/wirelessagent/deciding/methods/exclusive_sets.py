"""P2: conflict-free sets of subcarriers, and the least power for each user's rate on its own set."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.promises import least_power_decision
from wirelessagent.deciding.core.rate_proof import ceilings, log_snr, one_each
from wirelessagent.deciding.method import Method
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True)
class ExclusiveSets(Method):
    """The least power for promised rates on sets that grow by the largest saving, water-filling within each.

    The paper gives each user the subcarriers that are best for it, which may overlap, and equal rates on them. Here
    users take turns by need: first whoever has no set that carries its rate, then whoever saves most power by its best
    free subcarrier. Nobody is left empty while there are subcarriers for all. The sets are a heuristic; the bound, the
    dual of P2 at the best rate prices found, tells how far they may be from the optimum.
    """

    name = "exclusive_sets"
    objectives = ("min_power",)
    constraints = frozenset({"min_rate_bps", "users", "forbidden", "subcarrier_max_power_w"})

    def solve(self, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> Decision:
        from wirelessagent.deciding.core.least_power_kernel import grow_sets, least_power

        form = NormalForm.of(self, estimate, problem, cell)
        snr, log, ceiling = form.snr_per_w, log_snr(form.snr_per_w), ceilings(form, form.snr_per_w)

        def grown(nats: FloatArray, owner: IntArray) -> tuple[IntArray, FloatArray]:
            power_w = np.empty(owner.size)
            grow_sets(snr, log, ceiling, nats, owner)
            total = least_power(snr, ceiling, nats, owner, power_w, np.empty(nats.size))
            if not np.isfinite(total):
                power_w[:] = np.inf
            return np.where(power_w > 0, owner, -1), power_w

        def allocate(nats: FloatArray) -> tuple[IntArray, FloatArray]:
            owner, power_w = grown(nats, np.full(estimate.num_subcarriers, -1))
            if np.isinf(power_w).any():  # turns may have left a user without; a matching leaves as few as possible
                owner, power_w = grown(nats, _seeds(snr, nats))
            return owner, power_w

        return least_power_decision(form, allocate)


def _seeds(snr_per_w: FloatArray, nats: FloatArray) -> IntArray:
    """Owners (subcarrier,) that give each user with a promise one usable subcarrier, as far as there are any."""
    seed = one_each((snr_per_w > 0) & (nats > 0)[:, np.newaxis])
    owner = np.full(snr_per_w.shape[1], -1)
    users = np.flatnonzero(seed >= 0)
    owner[seed[users]] = users
    return owner

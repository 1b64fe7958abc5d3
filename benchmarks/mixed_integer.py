"""The peer of the decisions: the problem with whole subcarriers as a mixed-integer linear program, by HiGHS in scipy.

Power is convex in rate, p = x (e^{r/x} − 1)/a with x the 0/1 choice of a pair, and is replaced by tangents at rates
spaced as the promised rates and the budget suggest: an outer approximation, so that HiGHS's bound is one of the problem
itself. The value is that of the assignment it returns, with the best power for it (a cone program, Clarabel).
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import relaxation
from relaxation import Peer

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell

TANGENTS = 24

Triple: TypeAlias = tuple[IntArray, IntArray, FloatArray]
"""Rows, columns and coefficients."""


@dataclass(kw_only=True, eq=False)
class Program:
    """The columns are x, r and p of each pair (p in ``unit_w``) and the smallest rate t; here the rows gather."""

    snr: FloatArray
    most: FloatArray
    user: IntArray
    subcarrier: IntArray
    unit_w: float
    rows: list[Any] = field(default_factory=list)

    def limit(self, parts: list[Triple], low: float, high: float, count: int) -> None:
        """Rows low ≤ Σ coefficient · column ≤ high."""
        from scipy.optimize import LinearConstraint
        from scipy.sparse import coo_array

        row, column, value = (np.concatenate(piece) for piece in zip(*parts, strict=True))
        matrix = coo_array((value, (row, column)), shape=(count, 3 * self.snr.size + 1)).tocsc()
        self.rows.append(LinearConstraint(matrix, low, high))

    def link(self) -> None:
        """One user per subcarrier, no rate without the pair, and p ≥ slope (r − at x) + (e^at − 1)/a x."""
        pairs = self.snr.size
        x, one = np.arange(pairs), np.ones(pairs)
        r, p = pairs + x, 2 * pairs + x
        self.limit([(self.subcarrier, x, one)], -np.inf, 1.0, int(self.subcarrier.max()) + 1)
        self.limit([(x, r, one), (x, x, -self.most)], -np.inf, 0.0, pairs)
        for share in np.linspace(0.0, 1.0, TANGENTS):
            at = share * self.most
            slope = np.exp(at) / self.snr / self.unit_w
            offset = np.expm1(at) / self.snr / self.unit_w - slope * at
            self.limit([(x, p, -one), (x, r, slope), (x, x, offset)], -np.inf, 0.0, pairs)


def solve(
    objective: str,
    snr_per_w: FloatArray,
    cell: Cell,
    *,
    budget_w: float,
    min_rate_bps: float = 0.0,
    limit_s: float = 10.0,
) -> tuple[Peer, float]:
    """What HiGHS finds within ``limit_s``, and its bound; min_power, max_rate or max_min_rate."""
    from scipy.optimize import Bounds, milp

    start = time.perf_counter()
    (users, subcarriers), pairs = snr_per_w.shape, snr_per_w.size
    per_nat = cell.data_bandwidth_hz / np.log(2.0)
    user, subcarrier = np.divmod(np.arange(pairs), subcarriers)
    most = np.minimum(np.log1p(budget_w * snr_per_w.ravel()), cell.max_spectral_efficiency * np.log(2.0))
    if objective == "min_power":  # nobody needs more than the promise
        most = np.minimum(most, min_rate_bps / per_nat)
    unit_w = 1.0 / float(np.median(snr_per_w.max(axis=0)))
    program = Program(snr=snr_per_w.ravel(), most=most, user=user, subcarrier=subcarrier, unit_w=unit_w)
    program.link()
    r, p, t, one = pairs + np.arange(pairs), 2 * pairs + np.arange(pairs), 3 * pairs, np.ones(pairs)
    cost = np.zeros(t + 1)
    cost[{"min_power": p, "max_rate": r, "max_min_rate": t}[objective]] = 1.0 if objective == "min_power" else -1.0
    if min_rate_bps > 0:
        program.limit([(user, r, one)], min_rate_bps / per_nat, np.inf, users)
    if objective != "min_power":
        program.limit([(np.zeros(pairs, dtype=np.int64), p, one)], -np.inf, budget_w / unit_w, 1)
    if objective == "max_min_rate":
        smallest = (np.arange(users), np.full(users, t), -np.ones(users))
        program.limit([(user, r, one), smallest], 0.0, np.inf, users)
    found = milp(
        cost,
        constraints=program.rows,
        bounds=Bounds(np.zeros(t + 1), np.concatenate([one, most, np.full(pairs + 1, np.inf)])),
        integrality=np.arange(t + 1) < pairs,
        options={"time_limit": limit_s, "mip_rel_gap": 1e-4},
    )
    solver_s = time.perf_counter() - start
    sign, unit = (1.0, unit_w) if objective == "min_power" else (-1.0, per_nat)
    bound = np.nan if found.mip_dual_bound is None else sign * float(found.mip_dual_bound) * unit
    if found.x is None:
        return Peer(value=np.nan, time_s=solver_s, solver_s=solver_s, status=found.message), bound
    chosen = found.x[:pairs].reshape(users, subcarriers)
    owner = np.where(chosen.max(axis=0) > 0.5, chosen.argmax(axis=0), -1)
    best = relaxation.solve(objective, snr_per_w, cell, budget_w=budget_w, min_rate_bps=min_rate_bps, owner=owner)
    status = "optimal" if found.status == 0 else "time limit"
    return Peer(value=best.value, time_s=time.perf_counter() - start, solver_s=solver_s, status=status), bound

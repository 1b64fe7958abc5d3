"""The peer of the decisions: the problem with whole subcarriers as a mixed-integer linear program, by HiGHS in scipy.

Power is convex in rate, p = x (e^{r/x} − 1)/a with x the 0/1 choice of a pair, and is replaced by tangents at rates
spaced as the promised rates and the budget suggest: an outer approximation, so that HiGHS's bound is one of the problem
itself. The value is that of the assignment it returns, with the best power for it (a cone program, Clarabel).
"""

from __future__ import annotations

import time

import numpy as np
import relaxation
from relaxation import Peer

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell

TANGENTS = 24


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
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import coo_array

    start = time.perf_counter()
    users, subcarriers = snr_per_w.shape
    pairs = snr_per_w.size
    per_nat = cell.data_bandwidth_hz / np.log(2.0)
    user, subcarrier = np.divmod(np.arange(pairs), subcarriers)
    snr = snr_per_w.ravel()
    most = np.minimum(np.log1p(budget_w * snr), cell.max_spectral_efficiency * np.log(2.0))
    # Columns: x of each pair, r of each pair, p of each pair in the unit below, and the smallest rate t.
    unit_w = 1.0 / float(np.median(snr_per_w.max(axis=0)))
    x, r, p, t = np.arange(pairs), pairs + np.arange(pairs), 2 * pairs + np.arange(pairs), 3 * pairs
    rows: list[LinearConstraint] = []

    def limit(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]], low: float, high: float, count: int) -> None:
        """Rows low ≤ Σ coefficient · column ≤ high from (row, column, coefficient) triples."""
        row, column, value = (np.concatenate(piece) for piece in zip(*parts, strict=True))
        rows.append(LinearConstraint(coo_array((value, (row, column)), shape=(count, t + 1)).tocsc(), low, high))

    one = np.ones(pairs)
    limit([(subcarrier, x, one)], -np.inf, 1.0, subcarriers)
    limit([(x, r, one), (x, x, -most)], -np.inf, 0.0, pairs)
    for share in np.linspace(0.0, 1.0, TANGENTS):
        at = share * most
        slope = np.exp(at) / snr / unit_w  # p ≥ slope (r − at x) + (e^at − 1)/a x
        limit([(x, p, -one), (x, r, slope), (x, x, np.expm1(at) / snr / unit_w - slope * at)], -np.inf, 0.0, pairs)
    cost = np.zeros(t + 1)
    if min_rate_bps > 0:
        limit([(user, r, one)], min_rate_bps / per_nat, np.inf, users)
    if objective == "min_power":
        cost[p] = 1.0
    else:
        limit([(np.zeros(pairs, dtype=np.int64), p, one)], -np.inf, budget_w / unit_w, 1)
        cost[r] = -1.0 if objective == "max_rate" else 0.0
        cost[t] = -1.0 if objective == "max_min_rate" else 0.0
    if objective == "max_min_rate":
        limit([(user, r, one), (np.arange(users), np.full(users, t), -np.ones(users))], 0.0, np.inf, users)
    upper = np.concatenate([one, most, np.full(pairs + 1, np.inf)])
    found = milp(
        cost,
        constraints=rows,
        bounds=Bounds(np.zeros(t + 1), upper),
        integrality=np.arange(t + 1) < pairs,
        options={"time_limit": limit_s, "mip_rel_gap": 1e-4},
    )
    solver_s = time.perf_counter() - start
    sign, unit = (1.0, unit_w) if objective == "min_power" else (-1.0, per_nat)
    bound = np.nan if found.mip_dual_bound is None else sign * float(found.mip_dual_bound) * unit
    if found.x is None:
        peer = Peer(value=np.nan, time_s=time.perf_counter() - start, solver_s=solver_s, status=found.message)
        return peer, bound
    chosen = found.x[:pairs].reshape(users, subcarriers)
    owner = np.where(chosen.max(axis=0) > 0.5, chosen.argmax(axis=0), -1)
    best = relaxation.solve(objective, snr_per_w, cell, budget_w=budget_w, min_rate_bps=min_rate_bps, owner=owner)
    status = "optimal" if found.status == 0 else "time limit"
    return Peer(value=best.value, time_s=time.perf_counter() - start, solver_s=solver_s, status=status), bound

"""The peer of the bounds: the time-shared problem as a cone program, by cvxpy and Clarabel.

If users may share a subcarrier in time, user k with the share ρ and the power p (averaged over the slot) carries

    r ≤ ρ ln(1 + a p/ρ)  nats,    r ≤ c ρ,    Σ_k ρ ≤ 1,

which is convex, and its optimum is the Lagrangian dual of the problem without sharing: each subcarrier's best response
to prices of rate and power is an extreme point. So the bound of a method that searches rate prices must end there, from
the outside; nothing of the project is used here to find it.

Two things make the 17,472 cones of 64×273 bearable for Clarabel's arithmetic. Pairs (user, subcarrier) are generated:
it solves the program on some, and pairs that its prices find worth more than their subcarrier costs join, until none
is. And a cone is centred where its user's rate is expected: with p a = e^s z − ρ the first line is r − sρ ≤ ρ ln(z/ρ),
whose numbers are about 1 where s = ln(a L) is the rate at the user's water level L.

With the shares given (each subcarrier whole to its owner) the same program is the best power for an assignment.
"""

from __future__ import annotations

import contextlib
import time
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.cell import Cell

ALL_AT_ONCE = 400
"""Pairs up to which none are left out at first."""
SETTINGS: tuple[dict[str, Any], ...] = ({}, {"max_step_fraction": 0.9}, {"max_step_fraction": 0.8, "max_iter": 400})
"""Clarabel's settings, tried in turn where its arithmetic fails."""
WORTH = 1e-7
"""What a pair left out may be worth beyond its subcarrier's price, relative to the value of all subcarriers."""


@dataclass(frozen=True, kw_only=True)
class Peer:
    """What a peer found: value in W, bit/s or bit/J; time of the whole call and of its solvers; status; pairs used."""

    value: float
    time_s: float
    solver_s: float
    status: str
    pairs: int = 0


@dataclass(frozen=True, kw_only=True, eq=False)
class Master:
    """The program on some pairs, solved: its value in its own units, the prices, and the status."""

    value: float
    rate_price: FloatArray
    power_price: float
    subcarrier_price: FloatArray
    solver_s: float
    status: str


def solve(
    objective: str,
    snr_per_w: FloatArray,
    cell: Cell,
    *,
    budget_w: float,
    min_rate_bps: float = 0.0,
    owner: np.ndarray[Any, np.dtype[np.int64]] | None = None,
) -> Peer:
    """The best that time sharing reaches; with an ``owner`` (subcarrier,) given, the best without, for that owner."""
    start = time.perf_counter()
    kept = _first_pairs(snr_per_w)
    if owner is not None:
        kept = owner == np.arange(len(snr_per_w))[:, np.newaxis]
    spent = 0.0
    level_w = _first_levels(snr_per_w, cell, 0.0 if objective == "min_power" else budget_w, min_rate_bps)
    while True:
        master = _solve_on(kept, level_w, objective, snr_per_w, cell, budget_w, min_rate_bps)
        spent += master.solver_s
        if owner is not None or not np.isfinite(master.value):
            break
        level_w = np.maximum(master.rate_price / master.power_price, 1e-3 * level_w)
        worth = _worth(snr_per_w, cell, master) - master.subcarrier_price
        joining = (worth > WORTH * master.subcarrier_price.sum() / snr_per_w.shape[1]) & ~kept
        if not joining.any():
            break
        kept |= joining
    elapsed = time.perf_counter() - start
    value = _in_units(master.value, objective, len(snr_per_w), cell)
    return Peer(value=value, time_s=elapsed, solver_s=spent, status=master.status, pairs=int(kept.sum()))


def _first_pairs(snr_per_w: FloatArray) -> BoolArray:
    """The users that each subcarrier suits best, and the subcarriers best for each user."""
    if snr_per_w.size <= ALL_AT_ONCE:
        return snr_per_w > 0
    relative = snr_per_w / np.median(snr_per_w, axis=1, keepdims=True)
    by_user = np.argsort(np.argsort(-relative, axis=0), axis=0)
    by_subcarrier = np.argsort(np.argsort(-relative, axis=1), axis=1)
    return np.asarray((by_user < 4) | (by_subcarrier < 8))


def _first_levels(snr_per_w: FloatArray, cell: Cell, budget_w: float, min_rate_bps: float) -> FloatArray:
    """A guess at each user's water level in W, (user,): what its rate, or its part of the budget, makes of it."""
    users, subcarriers = snr_per_w.shape
    good = np.quantile(snr_per_w, 0.9, axis=1)
    promised = min_rate_bps * np.log(2.0) / cell.data_bandwidth_hz * users / subcarriers
    return np.maximum(np.exp(promised) / good, budget_w / subcarriers)


def _worth(snr_per_w: FloatArray, cell: Cell, master: Master) -> FloatArray:
    """What each pair is worth at the prices: max over r in [0, c] of w r − μ (e^r − 1)/a."""
    most = cell.max_spectral_efficiency * np.log(2.0)
    w, mu = master.rate_price[:, np.newaxis], master.power_price
    with np.errstate(divide="ignore"):
        rate = np.clip(np.log(w * snr_per_w / mu), 0.0, most)
    return np.asarray(w * rate - mu * np.expm1(rate) / snr_per_w)


def _in_units(value: float, objective: str, users: int, cell: Cell) -> float:
    per_nat = cell.data_bandwidth_hz / np.log(2.0)
    if objective == "min_power":
        return value
    return float(np.exp(value / users) if objective == "proportional_fairness" else value) * per_nat


def _solve_on(
    kept: BoolArray,
    level_w: FloatArray,
    objective: str,
    snr_per_w: FloatArray,
    cell: Cell,
    budget_w: float,
    min_rate_bps: float,
) -> Master:
    """The program on the pairs ``kept``, with the cones centred on the water levels (user,)."""
    import cvxpy as cp
    from scipy.sparse import csr_array

    user, subcarrier = np.nonzero(kept)
    users, subcarriers, count = *snr_per_w.shape, user.size
    by_user = csr_array((np.ones(count), (user, np.arange(count))), shape=(users, count))
    by_subcarrier = csr_array((np.ones(count), (subcarrier, np.arange(count))), shape=(subcarriers, count))
    snr = snr_per_w[user, subcarrier]
    centre = np.maximum(snr * level_w[user], 1.0)  # e^s
    unit_w = float(np.median(level_w))
    efficiency = objective == "max_energy_efficiency"
    # Charnes and Cooper: all variables are divided by the drawn power, in units of `drawn_w`, whose inverse is `whole`.
    drawn_w = cell.circuit_power_w + 0.5 * budget_w / cell.amplifier_efficiency
    whole: Any = cp.Variable(nonneg=True) if efficiency else 1.0
    share, swollen, nats = cp.Variable(count, nonneg=True), cp.Variable(count), cp.Variable(count)
    rate, total = cp.Variable(users), cp.Variable()
    carried, shared = rate <= by_user @ nats, by_subcarrier @ share <= whole
    spent = (centre / snr / unit_w) @ swollen - (1.0 / snr / unit_w) @ share <= total
    limits = [carried, shared, spent, swollen >= cp.multiply(1.0 / centre, share)]
    limits.append(nats <= cp.multiply(np.log(centre), share) - cp.rel_entr(share, swollen))
    if np.isfinite(cell.max_spectral_efficiency):
        limits.append(nats <= cell.max_spectral_efficiency * np.log(2.0) * share)
    if min_rate_bps > 0:
        limits.append(rate >= min_rate_bps * np.log(2.0) / cell.data_bandwidth_hz * whole)
    if objective != "min_power":
        limits.append(total <= budget_w / unit_w * whole)
    if efficiency:
        drawn = total * (unit_w / cell.amplifier_efficiency / drawn_w) + (cell.circuit_power_w / drawn_w) * whole
        limits.append(drawn <= 1.0)
    program = cp.Problem(_goal(objective, rate, total), limits)
    if not _solved(program):
        none, status = np.empty(0), program.status or "solver error"
        return Master(
            value=np.nan, rate_price=none, power_price=np.nan, subcarrier_price=none, solver_s=0.0, status=status
        )
    scale = {"min_power": unit_w, "max_energy_efficiency": 1.0 / drawn_w}.get(objective, 1.0)
    return Master(
        value=float(program.value) * scale,
        rate_price=np.asarray(carried.dual_value),
        power_price=float(spent.dual_value) / unit_w,
        subcarrier_price=np.asarray(shared.dual_value),
        solver_s=program.solver_stats.solve_time,
        status=program.status,
    )


def _goal(objective: str, rate: Any, total: Any) -> Any:
    import cvxpy as cp

    if objective == "min_power":
        return cp.Minimize(total)
    if objective == "proportional_fairness":
        return cp.Maximize(cp.sum(cp.log(rate)))
    return cp.Maximize(cp.min(rate) if objective == "max_min_rate" else cp.sum(rate))


def _solved(program: Any) -> bool:
    """Whether one of the ``SETTINGS`` brings a finite value; the program keeps it."""
    import cvxpy as cp

    for settings in SETTINGS:
        with warnings.catch_warnings(), contextlib.suppress(cp.SolverError):
            warnings.simplefilter("ignore")  # "may be inaccurate" is in the status
            program.solve(solver=cp.CLARABEL, **settings)
        if program.status == cp.OPTIMAL:
            break
    return program.value is not None and bool(np.isfinite(program.value))

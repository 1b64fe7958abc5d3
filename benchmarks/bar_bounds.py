"""Are bounds and optima those that general-purpose solvers find? Peers: Clarabel for bounds, HiGHS for optima."""

from __future__ import annotations

import dataclasses

import mixed_integer
import numpy as np
import relaxation
from bar_objectives import PROBLEMS
from channels import LINKS, draws, snr_per_w
from measuring import Tally, contenders, duration, percent, spread, table, worse_by

from wirelessagent.model.cell import Cell
from wirelessagent.model.problem import Problem

ALL = {"min power, 1 Mbit/s each": Problem("min_power", min_rate_bps=1e6, max_power_w=1e6), **PROBLEMS}


def bounds(count: int) -> None:
    """Each method's bound beside the optimum of the time-shared problem, which rate prices cannot beat.

    "beyond" is how far the bound lies outside (looser than) the peer's optimum, the largest over all draws, and
    "inside" how far within; both should be the peer's accuracy, unless a method's bound uses more than rate prices.
    """
    import cvxpy  # noqa: F401  # an import of half a second that is no part of the first peer's time

    rows: list[list[str]] = []
    for users, subcarriers in ((8, 20), (64, 273)):
        for case, problem in ALL.items():
            for link, cell in LINKS.items():
                rows += _bounds(users, subcarriers, case, problem, link, cell, count if users == 8 else min(count, 5))
    header = ("size, objective", "method", "link", "beyond", "inside", "time", "peer's time", "peer failed")
    table(f"Bounds beside cvxpy and Clarabel on the time-shared problem, {count} draws (5 at 64×273)", header, rows)


def _bounds(
    users: int, subcarriers: int, case: str, problem: Problem, link: str, cell: Cell, count: int
) -> list[list[str]]:
    cell = dataclasses.replace(cell, max_power_w=max(cell.max_power_w, problem.max_power_w or 0.0))
    objective = _name(problem)
    chosen = contenders("greedy", "dual fast", "dual thorough")
    tallies = {label: Tally() for label in chosen}
    signed: dict[str, list[float]] = {label: [] for label in chosen}
    times: list[float] = []
    failures = 0
    for estimate in draws(users, subcarriers, count):
        peer = relaxation.solve(
            objective,
            snr_per_w(estimate, cell),
            cell,
            budget_w=problem.budget_w(cell),
            min_rate_bps=float(np.max(problem.min_rates_bps(users))),
        )
        times.append(peer.time_s)
        failures += peer.status != "optimal"
        for label, (method, options) in chosen.items():
            decision = tallies[label].ask(estimate, problem, cell, method, **options)
            if decision is not None and peer.status == "optimal" and np.isfinite(decision.bound):
                signed[label].append(-worse_by(decision.bound, peer.value, decision))
    size_and_case, peer_s = f"{users}×{subcarriers} {case}", spread(times, duration)[0]
    return [
        [size_and_case, label, link, *_sides(signed[label]), spread(tally.time_s, duration)[0], peer_s, str(failures)]
        for label, tally in tallies.items()
        if signed[label]
    ]


def _name(problem: Problem) -> str:
    return problem.objective if isinstance(problem.objective, str) else problem.objective.name


def _sides(signed: list[float]) -> list[str]:
    return [f"{max(0.0, *signed):.1e}", f"{max(0.0, *(-value for value in signed)):.1e}"]


def milp(count: int) -> None:
    """HiGHS on the same problems at 8×20, with 24 tangents and 10 s each."""
    count = min(count, 5)
    rows: list[list[str]] = []
    for case in ("min power, 1 Mbit/s each", *list(PROBLEMS)[:1], *list(PROBLEMS)[3:]):
        problem, link = ALL[case], "Shannon"
        cell = dataclasses.replace(LINKS[link], max_power_w=max(20.0, problem.max_power_w or 0.0))
        chosen = contenders("greedy", "dual fast", "dual thorough", "exact")
        tallies = {label: Tally() for label in chosen}
        times: list[float] = []
        gaps: list[float] = []
        for estimate in draws(8, 20, count):
            budget_w = min(problem.budget_w(cell), 1e3)
            peer, bound = mixed_integer.solve(
                _name(problem),
                snr_per_w(estimate, cell),
                cell,
                budget_w=budget_w,
                min_rate_bps=float(np.max(problem.min_rates_bps(8))),
            )
            times.append(peer.time_s)
            gaps.append(abs(peer.value - bound) / abs(bound))
            for label, (method, options) in chosen.items():
                tallies[label].ask(estimate, problem, cell, method, optimum=peer.value, **options)
        rows.append([case, "HiGHS", "", "", percent(float(np.median(gaps))), *spread(times, duration)])
        for label, tally in tallies.items():
            if tally.statuses:
                least = f"{100 * min(tally.distance, default=np.nan):.2g} %"
                rows.append([case, label, *_ordered(tally, least), *spread(tally.time_s, duration)])
    header = ("objective", "who", "over HiGHS: least", "most", "own gap: median", "time: median", "max")
    table(f"8×20 beside HiGHS (24 tangents, at most 10 s), {count} draws", header, rows)


def _ordered(tally: Tally, least: str) -> list[str]:
    return [least, spread(tally.distance)[1], spread(tally.gap)[0]]

"""Bar 3: P1 and P3, which have exact solutions: how exact, how fast, and how much faster than cvxpy with Clarabel.

Everybody gets the same normalised gains a (user, subcarrier) and returns powers: best users are part of the task. The
peer is measured in three ways, from generous to plain: what Clarabel itself reports for its iterations; a program
compiled once, with the gains as parameter, from handing over the gains to having the powers; and a program written and
solved anew, which is what a caller does whose users or subcarriers change in number. The kernel's time is that of a
call from Python; ``wa.decide`` adds the checks, the certificate and the decision.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from channels import SHANNON, draws, snr_per_w
from closed_forms import BUDGET_W, CIRCUIT_W, CONTENDERS, CVXPY_SHAPES, SHAPES
from measuring import duration, fastest, table

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.problem import Problem

OBJECTIVES = {"P1 max rate": "max_rate", "P3 max energy efficiency": "max_energy_efficiency"}


def best_value(name: str, best: FloatArray) -> np.longdouble:
    """The optimum in nats or nats per J, in 64-bit mantissas: level by sorting, and Dinkelbach's method."""
    inverse = np.sort(np.longdouble(1.0) / best.astype(np.longdouble))
    levels = (np.longdouble(BUDGET_W) + np.cumsum(inverse)) / np.arange(1, inverse.size + 1)
    full = levels[np.flatnonzero(levels > inverse)[-1]]

    def value(level: np.longdouble) -> np.longdouble:
        power = np.maximum(level - inverse, 0)
        rate = np.log(np.maximum(level / inverse, 1)).sum()
        return rate if name.startswith("P1") else rate / (power.sum() + CIRCUIT_W)

    found = value(full)
    while name.startswith("P3") and (better := value(min(1 / found, full))) > found * (1 + np.longdouble(1e-18)):
        found = better
    return found


def closed(count: int) -> None:
    """Errors over all draws, times on the first; each time is the least of many."""
    rows: list[list[str]] = []
    for shape in SHAPES:
        some = list(draws(*shape, count if shape[1] < 1000 else 1))
        gains = [snr_per_w(estimate, SHANNON)[np.newaxis] for estimate in some]
        for name, contestants in CONTENDERS.items():
            error = max(_error(name, gain, contestants["kernel"](gain)()[0]) for gain in gains)
            problem = Problem(OBJECTIVES[name])
            wa.decide(some[0], problem)
            kernel = fastest(contestants["kernel"](gains[0]))
            decide = fastest(lambda one=some[0], asked=problem: wa.decide(one, asked))
            plain = fastest(contestants["numpy"](gains[0]))
            peers = _peers(name, contestants["cvxpy"], gains[0]) if shape in CVXPY_SHAPES else [np.nan] * 3
            times = [f"{duration(one)} ({one / kernel:,.0f}×)" if one == one else "–" for one in (plain, *peers)]
            size = f"{shape[0]}×{shape[1]}"
            rows.append([name, size, f"{error:.1e}", duration(kernel), duration(decide), *times])
    header = ("problem", "size", "worst error", "kernel", "wa.decide", "NumPy", "Clarabel alone", "cvxpy, compiled",
              "cvxpy, anew")  # fmt: skip
    title = f"Bar 3. P1 and P3 at {BUDGET_W:g} W, {CIRCUIT_W:g} W circuit; {count} draws (1 at 256×3276)"
    table(title, header, rows)


def _error(name: str, gain: FloatArray, power: FloatArray) -> float:
    best = gain[0].max(axis=0)
    rate = np.log1p(power.astype(np.longdouble) * best).sum()
    value = rate if name.startswith("P1") else rate / (power.sum() + CIRCUIT_W)
    return float(abs(value / best_value(name, best) - 1))


def _peers(name: str, write: Callable[[FloatArray], Callable[[], Any]], gain: FloatArray) -> list[float]:
    """Least times of Clarabel alone, of a compiled program and of one written anew."""
    try:
        import cvxpy as cp
    except ModuleNotFoundError:
        return [np.nan] * 3
    solve, optimum = write(gain), float(best_value(name, gain[0].max(axis=0)))
    if not abs(solve() / optimum - 1.0) <= 1e-4:
        raise SystemExit(f"{name}: the optimum is {optimum!r}, but cvxpy finds {solve()!r}")
    alone: list[float] = []
    original = cp.Problem.unpack_results

    def noting(program: Any, *args: Any, **kwargs: Any) -> None:
        original(program, *args, **kwargs)
        alone.append(program.solver_stats.solve_time)

    cp.Problem.unpack_results = noting
    try:
        compiled = fastest(solve, at_least_s=1.5)
    finally:
        cp.Problem.unpack_results = original
    anew = fastest(lambda: write(gain)(), at_least_s=1.0)
    return [min(alone), compiled, anew]

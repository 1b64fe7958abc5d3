"""Throughput: 10,000 problems at 8×20 through the batch call, for each objective."""

from __future__ import annotations

import os
import time

import numpy as np
from bar_objectives import PROBLEMS
from channels import FIRST_SEED, SHANNON, gains, known
from measuring import table

import wirelessagent as wa
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.problem import Problem

BATCH = 10_000
ALL = {
    "max rate": Problem("max_rate"),
    "min power, 0.5 Mbit/s each": Problem("min_power", min_rate_bps=0.5e6),
    "max efficiency": Problem("max_energy_efficiency"),
    **PROBLEMS,
}


def batches(count: int) -> None:
    """Problems per second, once warm."""
    del count
    gain = gains(8 * BATCH, 20, FIRST_SEED)[0].reshape(BATCH, 8, 20)
    rows: list[list[str]] = []
    for case, problem in ALL.items():
        try:
            one_by_one = _one_by_one(gain[:200], problem)
        except UnsupportedProblemError:
            rows.append([case, "refused", "", "", ""])
            continue
        found = wa.decide_batch(gain[:64], problem, SHANNON)
        speed: list[str] = []
        for workers in (1, None):
            start = time.perf_counter()
            found = wa.decide_batch(gain, problem, SHANNON, workers=workers)
            speed.append(f"{BATCH / (time.perf_counter() - start):,.0f}")
        rows.append([case, f"{one_by_one:,.0f}", *speed, f"{100 * np.mean(found.is_usable):.1f} %"])
    threads = f"batch, {os.cpu_count()} threads"
    header = ("objective", "wa.decide, one by one", "batch, 1 thread", threads, "with an allocation")
    table(f"Problems per second at 8×20, {BATCH:,} problems, {SHANNON.max_power_w:g} W", header, rows)


def _one_by_one(gain: np.ndarray, problem: Problem) -> float:
    estimates = [known(one) for one in gain]
    wa.decide(estimates[0], problem, SHANNON)
    start = time.perf_counter()
    for estimate in estimates:
        wa.decide(estimate, problem, SHANNON)
    return len(estimates) / (time.perf_counter() - start)

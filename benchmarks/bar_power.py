"""Bars 1 and 2: the least power for promised rates (P2)."""

from __future__ import annotations

import dataclasses

import numpy as np
from channels import SHANNON, draws, slots
from measuring import Tally, contenders, duration, percent, proven, spread, table, worse_by

from wirelessagent import plugins
from wirelessagent.model.problem import Problem

RATES_BPS = (0.2e6, 0.5e6, 1e6, 2e6)
AMPLE = dataclasses.replace(SHANNON, max_power_w=1e6)
HEADER = (
    "rate each",
    "method",
    "usable",
    "to optimum: median",
    "max",
    "certified: median",
    "max",
    "time: median",
    "max",
)


def small(count: int) -> None:
    """Bar 1: against the true optimum at 8×20."""
    rows: list[list[str]] = []
    for rate in RATES_BPS:
        problem = Problem("min_power", min_rate_bps=rate)
        tallies = {label: Tally() for label in contenders()}
        for estimate in draws(8, 20, count):
            optimum = np.nan
            for label, (method, options) in reversed(contenders().items()):
                decision = tallies[label].ask(estimate, problem, AMPLE, method, optimum=optimum, **options)
                optimum = proven(decision) if label == "exact" else optimum
        rows += [_row(f"{rate / 1e6:g} Mbit/s", label, tally) for label, tally in tallies.items()]
    table(f"Bar 1. P2 at 8×20, budget {AMPLE.max_power_w:g} W, {count} draws", HEADER, rows)


def budget(count: int) -> None:
    """Bar 1 at the cell's 20 W: what is feasible, and who knows."""
    rows: list[list[str]] = []
    for users, subcarriers in ((8, 20), (64, 273)):
        chosen = contenders() if users == 8 else contenders("greedy", "dual fast")
        for rate in RATES_BPS:
            problem = Problem("min_power", min_rate_bps=rate)
            for label, (method, options) in chosen.items():
                tally = Tally()
                for estimate in draws(users, subcarriers, count):
                    tally.ask(estimate, problem, SHANNON, method, timed=False, **options)
                shares = [tally.share("optimal", "feasible"), tally.share("infeasible"), tally.share("undecided")]
                rows.append([f"{users}×{subcarriers} {rate / 1e6:g} Mbit/s", label, *shares, *spread(tally.gap)])
    header = ("size, rate each", "method", "usable", "proven infeasible", "undecided", "certified: median", "max")
    table(f"P2 at {SHANNON.max_power_w:g} W, {count} draws", header, rows)


def large(count: int) -> None:
    """Bar 2: certified gaps at 64×273."""
    rows: list[list[str]] = []
    chosen = contenders("paper's rule", "greedy", "dual fast", "dual thorough")
    for rate in RATES_BPS:
        problem = Problem("min_power", min_rate_bps=rate)
        for label, (method, options) in chosen.items():
            tally = Tally()
            for estimate in draws(64, 273, count):
                tally.ask(estimate, problem, AMPLE, method, **options)
            rows.append(_row(f"{rate / 1e6:g} Mbit/s", label, tally))
    table(f"Bar 2. P2 at 64×273, budget {AMPLE.max_power_w:g} W, {count} draws", HEADER, rows)


def warm(count: int) -> None:
    """Bar 2: from slot to slot at 3 km/h, 1 ms apart, starting from the previous slot's decision."""
    if "dual" not in plugins.names("method"):
        print("\nBar 2, warm start: no method that starts from an earlier decision is installed")
        return
    problem = Problem("min_power", min_rate_bps=1e6)
    rows: list[list[str]] = []
    for seed in (1000, 1001, 1002):
        cold, hot, dearer = Tally(), Tally(), list[float]()
        previous = None
        for estimate in slots(64, 273, count, seed=seed):
            first = cold.ask(estimate, problem, AMPLE, "dual")
            if previous is not None:
                previous = hot.ask(estimate, problem, AMPLE, "dual", after=previous)
                assert previous is not None
                assert first is not None
                dearer.append(worse_by(previous.value, first.value, first))
            previous = previous or first
        for label, tally in (("cold", cold), ("warm", hot)):
            extra = spread(dearer)[1] if label == "warm" else ""
            rows.append([f"seed {seed}", label, *spread(tally.gap), *spread(tally.time_s, duration), extra])
    header = ("cell", "start", "certified: median", "max", "time: median", "max", "worst over cold")
    table(f"Bar 2. P2 at 64×273, 1 Mbit/s, {count} slots of 1 ms at 3 km/h", header, rows)


def huge(count: int) -> None:
    """Bar 2: nearly as many users as subcarriers."""
    problem = Problem("min_power", min_rate_bps=0.1e6)
    tallies = {label: Tally() for label in contenders("greedy", "dual fast", "dual thorough")}
    over: list[float] = []
    for estimate in draws(256, 273, count):
        found = {
            label: tallies[label].ask(estimate, problem, AMPLE, method, **options)
            for label, (method, options) in contenders(*tallies).items()
        }
        fast, thorough = found.get("dual fast"), found.get("dual thorough")
        if fast is not None and thorough is not None:
            over.append(worse_by(fast.value, thorough.value, fast))
    rows = [_row("0.1 Mbit/s", label, tally) for label, tally in tallies.items()]
    table(f"Bar 2. P2 at 256×273, budget {AMPLE.max_power_w:g} W, {count} draws", HEADER, rows)
    if over:
        print(f"  fast over thorough: median {percent(float(np.median(over)))}, max {percent(max(over))}")


def _row(case: str, label: str, tally: Tally) -> list[str]:
    usable = tally.share("optimal", "feasible")
    return [case, label, usable, *tally.figures(is_exact=label == "exact")]

"""The bar of deadlines, measured: ``python benchmarks/bars_deadline.py [--sizes 8x20,64x273] [--deadlines 0.05,5]``.

Every objective at every size under every deadline, by the fast and the thorough search and the exact method. A deadline
holds if the answer is there within 20 % or 50 ms of it, whichever is more. On a machine that does other work as well
the clock runs on while nothing is computed here, so beside the time on the clock stands what was computed after the
deadline, in CPU time; either may be what holds. Channels are those of :mod:`channels`.
"""

from __future__ import annotations

import argparse
import threading
import time
from collections.abc import Sequence
from typing import Any

from channels import SHANNON, draws
from measuring import duration, percent, table

import wirelessagent as wa
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

RATE_BPS = {8: 5e5, 64: 5e5, 256: 1e5}
"""Promised to each of so many users where rates are promised."""
OBJECTIVES = {"max_rate": True, "min_power": True, "max_energy_efficiency": True, "proportional_fairness": False,
              "max_min_rate": False}  # fmt: skip
"""Whether rates are promised: without, the most rate and the best efficiency are closed forms."""
METHODS: dict[str, tuple[str, dict[str, Any]]] = {
    "dual fast": ("dual", {}),
    "dual thorough": ("dual", {"effort": "thorough"}),
    "exact": ("exact", {}),
    "greedy": ("greedy", {}),
}
ALLOWED_SHARE, ALLOWED_S = 0.2, 0.05
HEADER = ("size", "objective", "method", "deadline", "clock", "CPU after it", "allowed", "held", "status", "gap")


def problem_of(objective: str, users: int) -> Problem:
    return Problem(objective, min_rate_bps=RATE_BPS[users]) if OBJECTIVES[objective] else Problem(objective)


def measure(estimate: ChannelEstimate, problem: Problem, label: str, deadline_s: float) -> list[str]:
    """One answer: its times, whether the deadline held, and what it is worth."""
    method, options = METHODS[label]
    passed: list[float] = []
    bell = threading.Timer(deadline_s, lambda: passed.append(time.process_time()))
    begun = time.perf_counter()
    bell.start()
    decision = wa.decide(estimate, problem, SHANNON, method, deadline_s=deadline_s, **options)
    elapsed, ended = time.perf_counter() - begun, time.process_time()
    bell.cancel()
    after = ended - passed[0] if passed else 0.0
    allowed = max(ALLOWED_SHARE * deadline_s, ALLOWED_S)
    held = "yes" if min(after, elapsed - deadline_s) <= allowed else "NO"
    return [duration(elapsed), duration(after), duration(allowed), held, decision.status, percent(decision.gap)]


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", default="8x20,64x273,256x273", help="separated by commas: %(default)s")
    parser.add_argument("--deadlines", default="0.05,0.5,5", help="in s, separated by commas: %(default)s")
    parser.add_argument("--methods", default=",".join(METHODS), help="separated by commas: %(default)s")
    chosen = parser.parse_args(arguments)
    labels = chosen.methods.split(",")
    small = next(draws(8, 20, 1))
    for label in labels:  # compile and load before anything is timed, promises that cannot be kept included
        for objective in OBJECTIVES:
            measure(small, problem_of(objective, 8), label, 1.0)
            wa.decide(small, Problem(objective, min_rate_bps=5e6), SHANNON, METHODS[label][0], deadline_s=1.0)
    rows: list[list[str]] = []
    for size in chosen.sizes.split(","):
        users, subcarriers = map(int, size.split("x"))
        estimate = next(draws(users, subcarriers, 1))
        for objective in OBJECTIVES:
            for label in labels:
                for deadline_s in map(float, chosen.deadlines.split(",")):
                    found = measure(estimate, problem_of(objective, users), label, deadline_s)
                    rows.append([size, objective, label, duration(deadline_s), *found])
    table("Deadlines: what was computed after them", HEADER, rows)
    print(f"{sum(row[7] != 'yes' for row in rows)} of {len(rows)} were not held")


if __name__ == "__main__":
    main()

"""Interpreted kernels beside compiled ones: the same decisions and repairs?

Bars: the same status; value and bound within 1e-9 relative or, in at most 1 % of the problems, another allocation of
which each is inside the other's gap. Repairs: gains within 1e-9 of the user's largest one, variances within 1e-9 of its
square, whose rounding is theirs where next to nothing is uncertain.

Each half runs in a process of its own: one with the machine code that is there (``wirelessagent warm-up`` first), one
with an empty cache, in which ``WIRELESSAGENT_COMPILE=never`` has every kernel interpreted.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np

import wirelessagent as wa
from wirelessagent.testing.random_problems import random_problem

TOLERANCE = 1e-9
DEADLINE_S = 600.0
"""So long that the slower half is not cut short."""
REPAIRERS = ("kriging", "predictor", "learned_covariance", "nncf", "nncf_paper", "linear")


def decided(problems: int) -> Iterator[dict[str, Any]]:
    """Random problems of every objective, each by the default method, every tenth thoroughly."""
    objectives = wa.plugins.names("objective")
    for number in range(problems):
        objective = wa.plugins.objective(objectives[number % len(objectives)])
        size = {"num_users": 3 + number % 3, "num_subcarriers": 6 + number % 7}
        case = random_problem(number, objective, **size)
        effort = "thorough" if number % 10 == 9 else "fast"
        found = wa.decide(case.estimate, case.problem, case.cell, "dual", effort=effort, deadline_s=DEADLINE_S)
        yield {
            "case": f"{objective.name}, seed {number}, {effort}",
            "kernels": found.kernels,
            "status": found.status,
            "figures": [found.value, found.bound],
            "gap": found.gap,
            "min": objective.direction == "min",
            "owner": found.owner.tolist(),
        }


def repaired(observations: int) -> Iterator[dict[str, Any]]:
    """Random observations with holes and whole rows lost, some with history, some noisy, by every repairer."""
    for number in range(observations):
        rng = np.random.default_rng(number)
        scene = wa.simulate(
            "rayleigh", num_users=4, num_subcarriers=12, seed=number, num_slots=1 + 5 * (number % 2),
            rms_delay_spread_s=float(rng.choice([30e-9, 300e-9, 1e-6])), snr_db=[None, 20.0][number // 2 % 2],
            speed_km_per_h=float(rng.choice([3.0, 30.0])), user_correlation=float(rng.choice([0.0, 0.9])),
        )  # fmt: skip
        seen = scene.observe(wa.loss.random(float(rng.uniform(0.1, 0.5))), seed=number)
        name = REPAIRERS[number % len(REPAIRERS)]
        found = wa.repair(seen, name)
        yield {
            "case": f"{name}, seed {number}",
            "kernels": found.kernels,
            "gain": found.gain.tolist(),
            "variance": found.gain_variance.tolist(),
        }


def work(problems: int, observations: int) -> None:
    """Print one half's results as JSON lines."""
    for one in (*decided(problems), *repaired(observations)):
        print(json.dumps(one), flush=True)


def half(problems: int, observations: int, **environment: str) -> list[dict[str, Any]]:
    """One half's results, made by another process."""
    command = [sys.executable, "-W", "error", __file__, "--work", str(problems), str(observations)]
    done = subprocess.run(
        command, env={**os.environ, "WIRELESSAGENT_COMPILE": "never", **environment}, check=True, stdout=subprocess.PIPE
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


def close(one: Any, other: Any, scale: Any = None) -> bool:
    """Whether figures agree, relative to the largest of their row, or to a ``scale`` for each row."""
    a, b = np.array(one, dtype=float), np.array(other, dtype=float)
    if scale is None:
        scale = np.nanmax(np.abs(np.where(np.isfinite(a), a, np.nan)), axis=-1, keepdims=True, initial=0.0)
    with np.errstate(invalid="ignore"):
        same = (a == b) | (np.isnan(a) & np.isnan(b)) | (np.abs(a - b) <= TOLERANCE * scale)
    return bool(same.all())


def inside(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether each value is on the right side of the other's bound."""
    for a, b in ((one, other), (other, one)):
        value, bound = a["figures"][0], b["figures"][1]
        beyond = bound - value if a["min"] else value - bound
        if beyond > TOLERANCE * abs(bound):
            return False
    return True


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=500, help="how many (%(default)s)")
    parser.add_argument("--repairs", type=int, default=120, help="how many (%(default)s)")
    parser.add_argument("--work", nargs=2, type=int, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        work(*given.work)
        return 0
    with tempfile.TemporaryDirectory() as empty:
        interpreted = half(given.problems, given.repairs, XDG_CACHE_HOME=empty)
    compiled = half(given.problems, given.repairs)
    wrong, other = [], []
    for one, two in zip(interpreted, compiled, strict=True):
        if "gain" in one:
            squared = np.max(np.square(one["gain"]), axis=-1, keepdims=True)
            if not (close(one["gain"], two["gain"]) and close(one["variance"], two["variance"], squared)):
                wrong.append(f"{one['case']}: gains or variances differ")
        elif one["status"] != two["status"]:
            wrong.append(f"{one['case']}: {one['status']} interpreted, {two['status']} compiled")
        elif not all(close([a], [b]) for a, b in zip(one["figures"], two["figures"], strict=True)):
            (other if inside(one, two) else wrong).append(f"{one['case']}: {one['figures']} and {two['figures']}")
    ran = {kind: sum(one["kernels"] == kind for one in half_) for half_, kind in
           ((interpreted, "interpreted"), (compiled, "compiled"))}  # fmt: skip
    print(f"{len(interpreted)} cases; {ran['interpreted']} interpreted, {ran['compiled']} compiled")
    print(f"not the same: {len(wrong)}; another allocation inside the other's gap: {len(other)} of {given.problems}")
    print(*wrong, *other, sep="\n")
    return 1 if wrong or len(other) > 0.01 * given.problems else 0


if __name__ == "__main__":
    sys.exit(main())

"""Deciding, timed by pytest-benchmark: ``pytest benchmarks``; ``python benchmarks/bench_decide.py`` prints ratios.

P1 and P3 beside NumPy and cvxpy, every registered method on every objective that it solves, and batches. How good the
answers are is another matter: ``python benchmarks/bars_decide.py``.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import pytest
from channels import FIRST_SEED, SHANNON, gains, known, snr_per_w
from closed_forms import CONTENDERS, CVXPY_SHAPES, SHAPES

import wirelessagent as wa
from wirelessagent import chain, plugins
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import InputError
from wirelessagent.model.problem import Problem

PROMISED_BPS = 0.5e6
LARGE = ("greedy", "dual")
"""Methods timed at 64×273 as well."""


def one_gain(num_users: int, num_subcarriers: int, batch: int = 1) -> FloatArray:
    """a = g/(N0 B), shape (batch, user, subcarrier)."""
    flat = known(gains(num_users * batch, num_subcarriers, FIRST_SEED)[0])
    return snr_per_w(flat, SHANNON).reshape(batch, num_users, num_subcarriers)


CLOSED = [
    pytest.param(problem, contender, shape, id=f"{problem}-{contender}-{shape[0]}x{shape[1]}")
    for problem, contenders in CONTENDERS.items()
    for shape in SHAPES[:2]
    for contender in contenders
    if contender != "cvxpy" or shape in CVXPY_SHAPES
]


def decided() -> Iterator[Any]:
    """Each objective with each method that solves it; 0.5 Mbit/s for each user where power is to be least."""
    for objective in plugins.names("objective"):
        problem = Problem(objective, min_rate_bps=PROMISED_BPS if objective == "min_power" else None)
        for shape in SHAPES[:2]:
            for method in plugins.names("method") if shape == SHAPES[0] else LARGE:
                with contextlib.suppress(InputError):  # not installed, or it refuses such problems
                    chain.check_solvable(problem, method)
                    yield pytest.param(problem, method, shape, id=f"{objective}-{method}-{shape[0]}x{shape[1]}")


@pytest.mark.parametrize(("problem", "contender", "shape"), CLOSED)
def test_closed_form(benchmark: Any, problem: str, contender: str, shape: tuple[int, int]) -> None:
    benchmark.group = f"{problem} {shape[0]}x{shape[1]}"
    if contender == "cvxpy":
        pytest.importorskip("cvxpy")
    benchmark(CONTENDERS[problem][contender](one_gain(*shape)))


@pytest.mark.parametrize("problem", CONTENDERS)
def test_batch_of_1000(benchmark: Any, problem: str) -> None:
    benchmark.group = "batch of 1000 at 8x20"
    benchmark(CONTENDERS[problem]["kernel"](one_gain(8, 20, batch=1000)))


@pytest.mark.parametrize(("problem", "method", "shape"), list(decided()))
def test_decide(benchmark: Any, problem: Problem, method: str, shape: tuple[int, int]) -> None:
    """``wa.decide`` as a Python caller sees it."""
    estimate = known(gains(*shape, FIRST_SEED)[0])
    benchmark.group = f"decide {problem.objective} {shape[0]}x{shape[1]}"
    benchmark.pedantic(wa.decide, (estimate, problem, SHANNON, method), rounds=7, warmup_rounds=1)


if __name__ == "__main__":
    from bars_decide import main

    main(["--only", "closed,batches", "--draws", "5"])

"""P1 and P3 beside NumPy and cvxpy with Clarabel, and P2's search, in one run: ``python benchmarks/bench_decide.py``.

All three are given the same normalised gains and do the whole problem: best user on each subcarrier, then power. NumPy
is the same algorithm without compilation; cvxpy is given the best users and solves the convex rest with parameters, so
that it compiles the problem once and each solve is timed alone. Before anything is timed the optima are compared.

Channels are those of the reference figures: 35–300 m, 128.1 + 37.6 log10(d_km) dB, 6 dB shadowing, Rayleigh fading.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from wirelessagent.deciding.core.exclusive_sets_kernel import grow_sets, least_power
from wirelessagent.deciding.core.fractional_kernel import max_efficiency
from wirelessagent.deciding.core.water_filling_kernel import max_rate
from wirelessagent.model.arrays import FloatArray

SHAPES = ((8, 20), (64, 273), (256, 3276))
CVXPY_SHAPES = SHAPES[:2]
BUDGET_W, CIRCUIT_W, RATE_NATS = 20.0, 5.0, 1e6 / 180e3 * np.log(2)
NOISE_W = 1.8e-12


def snr_per_w(num_users: int, num_subcarriers: int, batch: int = 1) -> FloatArray:
    """a = g/(N0 B), shape (batch, user, subcarrier)."""
    rng = np.random.default_rng(1)
    distance_km = np.sqrt(rng.uniform(0.035**2, 0.3**2, (batch, num_users, 1)))
    loss_db = 128.1 + 37.6 * np.log10(distance_km) + rng.normal(0.0, 6.0, distance_km.shape)
    return 10.0 ** (-loss_db / 10) * rng.exponential(size=(batch, num_users, num_subcarriers)) / NOISE_W


def kernel_p1(snr: FloatArray) -> Callable[[], FloatArray]:
    cap_w, budget_w = np.full(snr.shape[2], np.inf), np.full(len(snr), BUDGET_W)
    return lambda: max_rate(snr, cap_w, np.inf, budget_w)[1]


def kernel_p3(snr: FloatArray) -> Callable[[], FloatArray]:
    cap_w, budget_w = np.full(snr.shape[2], np.inf), np.full(len(snr), BUDGET_W)
    return lambda: max_efficiency(snr, cap_w, np.inf, budget_w, CIRCUIT_W)[1]


def numpy_level(best: FloatArray, budget_w: float) -> float:
    """Water-filling by sorting: the level of the most subcarriers that all stay wet."""
    inverse = np.sort(1.0 / best)
    level = (budget_w + np.cumsum(inverse)) / np.arange(1, inverse.size + 1)
    return float(level[np.flatnonzero(level > inverse)[-1]])


def numpy_p1(snr: FloatArray) -> FloatArray:
    owner = snr.argmax(axis=0)
    best = snr[owner, np.arange(owner.size)]
    return np.maximum(numpy_level(best, BUDGET_W) - 1.0 / best, 0.0)


def numpy_p3(snr: FloatArray) -> FloatArray:
    owner = snr.argmax(axis=0)
    best = snr[owner, np.arange(owner.size)]
    inverse = 1.0 / best
    full = numpy_level(best, BUDGET_W)
    power = np.maximum(full - inverse, 0.0)
    efficiency = np.log1p(power * best).sum() / (power.sum() + CIRCUIT_W)
    while True:
        power = np.maximum(min(1.0 / efficiency, full) - inverse, 0.0)
        better = np.log1p(power * best).sum() / (power.sum() + CIRCUIT_W)
        if better <= efficiency * (1 + 1e-15):
            return power
        efficiency = better


def cvxpy_p1(snr: FloatArray) -> Callable[[], float]:
    """max Σ ln(1 + p a), Σ p ≤ P, with a as parameter."""
    import cvxpy as cp

    power, gain = cp.Variable(snr.shape[1], nonneg=True), cp.Parameter(snr.shape[1], nonneg=True)
    problem = cp.Problem(cp.Maximize(cp.sum(cp.log1p(cp.multiply(gain, power)))), [cp.sum(power) <= BUDGET_W])

    def solve() -> float:
        gain.value = snr.max(axis=0)
        return float(problem.solve(solver=cp.CLARABEL))

    return solve


def cvxpy_p3(snr: FloatArray) -> Callable[[], float]:
    """P3 after Charnes and Cooper: y = p t, max Σ t ln(1 + a y/t), Σ y + C t ≤ 1, Σ y ≤ P t."""
    import cvxpy as cp

    scaled, gain = cp.Variable(snr.shape[1], nonneg=True), cp.Parameter(snr.shape[1], nonneg=True)
    t = cp.Variable(nonneg=True)
    rate = cp.sum(-cp.rel_entr(t * np.ones(snr.shape[1]), t + cp.multiply(gain, scaled)))
    limits = [cp.sum(scaled) + CIRCUIT_W * t <= 1, cp.sum(scaled) <= BUDGET_W * t]
    problem = cp.Problem(cp.Maximize(rate), limits)

    def solve() -> float:
        gain.value = snr.max(axis=0)
        return float(problem.solve(solver=cp.CLARABEL))

    return solve


CONTENDERS: dict[str, dict[str, Callable[[FloatArray], Callable[[], Any]]]] = {
    "P1 max rate": {
        "kernel": kernel_p1,
        "numpy": lambda snr: lambda: numpy_p1(snr[0]),
        "cvxpy": lambda snr: cvxpy_p1(snr[0]),
    },
    "P3 max energy efficiency": {
        "kernel": kernel_p3,
        "numpy": lambda snr: lambda: numpy_p3(snr[0]),
        "cvxpy": lambda snr: cvxpy_p3(snr[0]),
    },
}
CASES = [
    pytest.param(problem, contender, shape, id=f"{problem}-{contender}-{shape[0]}x{shape[1]}")
    for problem, contenders in CONTENDERS.items()
    for shape in SHAPES
    for contender in contenders
    if contender != "cvxpy" or shape in CVXPY_SHAPES
]


@pytest.mark.parametrize(("problem", "contender", "shape"), CASES)
def test_solve(benchmark: Any, problem: str, contender: str, shape: tuple[int, int]) -> None:
    benchmark.group = f"{problem} {shape[0]}x{shape[1]}"
    if contender == "cvxpy":
        pytest.importorskip("cvxpy")
    benchmark(CONTENDERS[problem][contender](snr_per_w(*shape)))


@pytest.mark.parametrize("problem", CONTENDERS)
def test_batch_of_1000(benchmark: Any, problem: str) -> None:
    benchmark.group = "batch of 1000 at 8x20"
    benchmark(CONTENDERS[problem]["kernel"](snr_per_w(8, 20, batch=1000)))


@pytest.mark.parametrize("shape", CVXPY_SHAPES, ids=lambda shape: f"{shape[0]}x{shape[1]}")
def test_exclusive_sets(benchmark: Any, shape: tuple[int, int]) -> None:
    benchmark.group = "P2 min power, sets and powers at 1 Mbit/s"
    assert np.isfinite(benchmark(_exclusive_sets(snr_per_w(*shape)[0])))


def _exclusive_sets(snr: FloatArray) -> Callable[[], float]:
    log_snr, ceiling = np.log(snr), np.full(snr.shape, np.inf)
    nats = np.full(snr.shape[0], RATE_NATS)

    def solve() -> float:
        owner = np.full(snr.shape[1], -1)
        grow_sets(snr, log_snr, ceiling, nats, owner)
        return least_power(snr, ceiling, nats, owner, np.empty(owner.size), np.empty(nats.size))

    return solve


def _seconds(solve: Callable[[], Any], *, at_least_s: float = 0.5) -> float:
    """The median time of a call, over at least ``at_least_s`` of them."""
    solve()
    times: list[float] = []
    while sum(times) < at_least_s:
        start = time.perf_counter()
        solve()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def _check(problem: str, solve: Callable[[], float], snr: FloatArray) -> None:
    """cvxpy must reach the kernel's optimum, and no more, within its own accuracy."""
    power = CONTENDERS[problem]["kernel"](snr[np.newaxis])()[0]
    ours = float(np.log1p(power * snr.max(axis=0)).sum())
    if problem.startswith("P3"):
        ours /= float(power.sum()) + CIRCUIT_W
    theirs = solve()
    if abs(theirs / ours - 1.0) > 1e-4:
        raise SystemExit(f"{problem}: the kernel's optimum is {ours!r}, cvxpy's {theirs!r}")


def main() -> None:
    print(f"{'problem':26} {'size':>9} {'kernel':>10} {'NumPy':>16} {'cvxpy+Clarabel':>20}")
    for problem, contenders in CONTENDERS.items():
        for shape in SHAPES:
            snr = snr_per_w(*shape)
            kernel = _seconds(contenders["kernel"](snr))
            plain = _seconds(contenders["numpy"](snr))
            peer = ""
            if shape in CVXPY_SHAPES:
                solve = contenders["cvxpy"](snr)
                _check(problem, solve, snr[0])
                seconds = _seconds(solve, at_least_s=1.0)
                peer = f"{1e3 * seconds:.1f} ms {seconds / kernel:8.0f}×"
            size = f"{shape[0]}×{shape[1]}"
            numpy = f"{1e6 * plain:.0f} µs {plain / kernel:4.1f}×"
            print(f"{problem:26} {size:>9} {1e6 * kernel:>7.1f} µs {numpy:>16} {peer:>20}")
    for problem, contenders in CONTENDERS.items():
        for batch, shape in ((1000, (8, 20)), (64, (64, 273))):
            seconds = _seconds(contenders["kernel"](snr_per_w(*shape, batch=batch)))
            print(f"{problem:26} batch of {batch} at {shape[0]}×{shape[1]}: {batch / seconds:,.0f} problems per second")


if __name__ == "__main__":
    main()

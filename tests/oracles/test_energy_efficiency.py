"""The kernel of P3 against Dinkelbach's method in 60 decimal digits, on gains, caps, budgets and circuits far apart."""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest

from wirelessagent.deciding.core.fractional_kernel import max_efficiency
from wirelessagent.model.arrays import FloatArray

EXACT = 2e-15
NOISE_W = 1.8e-12


def best_efficiency(snr_per_w: FloatArray, cap_w: FloatArray, budget_w: float, circuit_w: float) -> float:
    """The most nats per joule within the budget; only the two loops' ends are rounded."""
    usable = [(1 / Decimal(float(a)), Decimal(float(u))) for a, u in zip(snr_per_w, cap_w, strict=True) if a > 0 < u]

    def powers(level: Decimal) -> list[Decimal]:
        return [min(max(level - floor, Decimal(0)), cap) for floor, cap in usable]

    def efficiency(level: Decimal) -> Decimal:
        poured = powers(level)
        rate = sum((1 + p / floor).ln() for p, (floor, _) in zip(poured, usable, strict=True))
        return rate / (sum(poured) + Decimal(circuit_w))

    best = efficiency(min(floor for floor, _ in usable) + Decimal(budget_w) / 2**20)
    while (better := efficiency(1 / best)) > best * (1 + Decimal("1e-25")):
        best = better
    if sum(powers(1 / best)) <= Decimal(budget_w):
        return float(best)
    low, high = Decimal(0), 1 / best
    for _ in range(220):
        middle = (low + high) / 2
        low, high = (low, middle) if sum(powers(middle)) > Decimal(budget_w) else (middle, high)
    return float(efficiency(low))


def draw(seed: int) -> tuple[FloatArray, FloatArray, float, float]:
    """SNR per watt (subcarrier,), caps, a budget and a circuit power; some gains tied, some zero, some caps zero."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 25))
    snr = 10.0 ** (rng.uniform(rng.choice([-20.0, -4.0, -1.0]), 0.0, size) - rng.choice([2.0, 8.0, 12.0])) / NOISE_W
    snr[rng.uniform(size=size) < rng.choice([0.0, 0.3])] = 0.0
    if rng.uniform() < 0.3:
        snr[size // 2 :] = snr[-1]
    snr[int(rng.integers(size))] = 10.0 ** rng.uniform(-10.0, 0.0) / NOISE_W
    cap_w = np.full(size, np.inf)
    budget_w = 10.0 ** rng.uniform(-6.0, 4.0)
    if rng.uniform() < 0.5:
        some = rng.uniform(size=size) < 0.7
        cap_w[some] = budget_w * 10.0 ** rng.uniform(-6.0, 0.3, np.count_nonzero(some))
        cap_w[: size // 3] = 0.0
        cap_w[-1], snr[-1] = budget_w, snr.max()
    return snr, cap_w, budget_w, 10.0 ** rng.uniform(-3.0, 3.0)


@pytest.mark.parametrize("seed", range(120))
def test_equals_dinkelbach_in_sixty_digits(seed: int) -> None:
    snr, cap_w, budget_w, circuit_w = draw(seed)
    _, power, price, steps = max_efficiency(snr[np.newaxis, np.newaxis], cap_w, np.inf, np.array([budget_w]), circuit_w)
    with localcontext() as context:
        context.prec = 60
        best = best_efficiency(snr, cap_w, budget_w, circuit_w)
    found = np.log1p(power[0] * snr).sum() / (power[0].sum() + circuit_w)
    assert abs(found / best - 1.0) <= EXACT
    assert np.all((power[0] >= 0) & (power[0] <= cap_w))
    assert power[0].sum() <= budget_w * (1 + 1e-12)
    assert steps[0] <= 20
    binds = power[0].sum() >= budget_w * (1 - 1e-12)
    assert price[0] >= best * (1 - EXACT) if binds else abs(price[0] / best - 1.0) <= EXACT


def test_the_best_subcarrier_may_have_no_room() -> None:
    snr, cap_w = np.array([[[1e6, 1.0, 2.0]]]), np.array([0.0, np.inf, 3.0])
    owner, power, price, _ = max_efficiency(snr, cap_w, np.inf, np.array([1e-3]), 5.0)
    assert np.array_equal(owner, [[-1, -1, 0]])
    assert np.allclose(power, [[0.0, 0.0, 1e-3]], rtol=1e-12)
    assert price[0] > 0

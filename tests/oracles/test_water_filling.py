"""Water-filling against exact rational arithmetic, and its optimality conditions element by element.

The oracle works in fractions on the very same floating-point inputs, so every difference is the kernel's error.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from wirelessagent.deciding.core.least_power_kernel import least_power
from wirelessagent.deciding.core.water_filling_kernel import max_rate
from wirelessagent.model.arrays import FloatArray, IntArray

NOISE_W = 1.8e-12
EXACT = 1e-12


def exact_power(snr_per_w: FloatArray, cap_w: FloatArray, budget_w: float) -> tuple[list[Fraction], Fraction | None]:
    """Power per subcarrier and water level, exactly; no level where every cap is reached or nothing can be used.

    The filled volume is piecewise linear in the level, with kinks at the floors 1/a and at 1/a + cap.
    """
    usable = [n for n in range(snr_per_w.size) if snr_per_w[n] > 0 and cap_w[n] > 0]
    power = [Fraction(0)] * snr_per_w.size
    floor = {n: 1 / Fraction(float(snr_per_w[n])) for n in usable}
    cap = {n: None if np.isinf(cap_w[n]) else Fraction(float(cap_w[n])) for n in usable}
    budget = Fraction(budget_w)
    if not usable or (None not in cap.values() and sum(cap.values()) <= budget):
        for n in usable:
            power[n] = cap[n]
        return power, None

    def depth(n: int, level: Fraction) -> Fraction:
        wet = max(level - floor[n], Fraction(0))
        return wet if cap[n] is None else min(wet, cap[n])

    kinks = sorted({*floor.values(), *(floor[n] + cap[n] for n in usable if cap[n] is not None)})
    below = max(kink for kink in kinks if sum(depth(n, kink) for n in usable) <= budget)
    slope = sum(1 for n in usable if floor[n] <= below and (cap[n] is None or below < floor[n] + cap[n]))
    level = below + (budget - sum(depth(n, below) for n in usable)) / slope if slope else below
    for n in usable:
        power[n] = depth(n, level)
    return power, level


def draw(seed: int, *, capped: bool) -> tuple[FloatArray, FloatArray, float]:
    """SNR per watt (user, subcarrier), caps and a budget: gains 1e-40 … 1, zeros, near ties, zero rows, 1 nW … 1 MW."""
    rng = np.random.default_rng(seed)
    users, subcarriers = rng.integers(1, 5), rng.integers(1, 25)
    lowest = rng.choice([-40.0, -12.0, -3.0])
    gain = 10.0 ** rng.uniform(lowest, 0.0, (users, subcarriers)) * 10.0 ** rng.choice([0.0, -8.0, -14.0])
    gain[rng.uniform(size=gain.shape) < rng.choice([0.0, 0.3])] = 0.0
    if rng.uniform() < 0.3:
        gain[:, rng.integers(subcarriers)] = gain[:, 0]
        gain[:, subcarriers // 2 :] = gain[:, -1:]
    if rng.uniform() < 0.3:
        gain[:] = gain.max() * (1.0 + 10.0 ** rng.uniform(-15.0, -6.0, gain.shape))
    if rng.uniform() < 0.3:
        gain[rng.integers(users)] = 0.0
    budget_w = 10.0 ** rng.uniform(-9.0, 6.0)
    cap_w = np.full(subcarriers, np.inf)
    if capped:
        some = rng.uniform(size=subcarriers) < 0.8
        cap_w[some] = budget_w * 10.0 ** rng.uniform(-3.0, 0.3, np.count_nonzero(some))
    return gain / NOISE_W, cap_w, budget_w


def solve(snr_per_w: FloatArray, cap_w: FloatArray, budget_w: float) -> tuple[IntArray, FloatArray, float]:
    owner, power, price = max_rate(snr_per_w[np.newaxis], cap_w, np.inf, np.array([budget_w]))
    return owner[0], power[0], float(price[0])


@pytest.mark.parametrize("capped", [False, True])
@pytest.mark.parametrize("seed", range(150))
def test_equals_exact_arithmetic(seed: int, capped: bool) -> None:
    snr, cap_w, budget_w = draw(seed, capped=capped)
    best = snr.max(axis=0)
    _, power, price = solve(snr, cap_w, budget_w)
    exact, level = exact_power(best, cap_w, budget_w)

    truth = np.array([float(p) for p in exact])
    # Each power to its own scale, down to a thousandth of the total: below, the total is what rounding is relative to.
    assert np.all(np.abs(power - truth) <= EXACT * np.maximum(truth, 1e-3 * truth.sum()))
    assert abs(power.sum() - truth.sum()) <= EXACT * truth.sum()

    rate, true_rate = np.log1p(power * best).sum(), np.log1p(truth * best).sum()
    assert abs(rate - true_rate) <= EXACT * true_rate
    assert abs(price * float(level) - 1.0) <= EXACT if level is not None else price == 0.0


@pytest.mark.parametrize("capped", [False, True])
@pytest.mark.parametrize("seed", range(1000, 1040))
def test_optimality_conditions_hold_on_each_subcarrier(seed: int, capped: bool) -> None:
    """At the price μ the marginal rate a/(1 + p a) equals μ between 0 and the cap, is no more at 0, no less at the cap.

    Relative, per element; μ itself is what the dual bound is built from.
    """
    snr, cap_w, budget_w = draw(seed, capped=capped)
    best = snr.max(axis=0)
    owner, power, price = solve(snr, cap_w, budget_w)
    marginal = best / (1.0 + power * best)
    usable = best > 0
    idle, full = power == 0, power == cap_w
    between = usable & ~idle & ~full
    assert np.all(np.abs(marginal[between] - price) <= EXACT * price)
    assert np.all(best[usable & idle] <= price * (1 + EXACT))
    assert np.all(marginal[usable & full] >= price * (1 - EXACT))
    assert power.sum() <= budget_w * (1 + EXACT)
    assert power.sum() >= budget_w * (1 - EXACT) or np.all(full[usable])
    assert np.all(snr[owner[~idle], np.flatnonzero(~idle)] == best[~idle])
    assert np.all(owner[idle] == -1)


@pytest.mark.parametrize("seed", range(20))
def test_a_full_rate_is_a_power_cap(seed: int) -> None:
    snr, _, budget_w = draw(seed, capped=False)
    best, max_snr = snr.max(axis=0), 10.0 ** np.random.default_rng(seed).uniform(-2, 4)
    with np.errstate(divide="ignore"):
        cap_w = np.where(best > 0, max_snr / best, 0.0)
    by_rate = max_rate(snr[np.newaxis], np.full(best.size, np.inf), max_snr, np.array([budget_w]))
    by_power = solve(snr, cap_w, budget_w)
    assert np.array_equal(by_rate[1][0], by_power[1])
    assert by_rate[2][0] == by_power[2]


def test_a_batch_is_its_problems_one_by_one() -> None:
    rng = np.random.default_rng(5)
    snr = rng.exponential(size=(7, 3, 11)) * 10.0 ** rng.uniform(0, 6, (7, 3, 1))
    cap_w, budget_w = np.full(11, np.inf), 10.0 ** rng.uniform(-6, 2, 7)
    owner, power, price = max_rate(snr, cap_w, np.inf, budget_w)
    for b in range(7):
        alone = solve(snr[b], cap_w, float(budget_w[b]))
        assert np.array_equal(owner[b], alone[0])
        assert np.array_equal(power[b], alone[1])
        assert price[b] == alone[2]


def test_ties_share_evenly_and_go_to_the_first_user() -> None:
    owner, power, price = solve(np.full((3, 4), 2.0), np.full(4, np.inf), 1e-9)
    assert np.array_equal(owner, np.zeros(4))
    assert np.array_equal(power, np.full(4, 1e-9 / 4))
    assert price == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize("share", [1, 3, 5, 8])
def test_a_budget_of_so_many_caps_fills_just_these(share: int) -> None:
    snr = np.array([[8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0]]) * 1e-3
    _, power, _ = solve(snr, np.full(8, 0.25), 0.25 * share)
    assert np.allclose(power, np.where(np.arange(8) < share, 0.25, 0.0), rtol=EXACT, atol=EXACT)


@pytest.mark.parametrize("budget_w", [1e-9, 1e6])
def test_nothing_to_fill(budget_w: float) -> None:
    owner, power, price = solve(np.zeros((2, 5)), np.full(5, np.inf), budget_w)
    assert np.array_equal(owner, np.full(5, -1))
    assert np.array_equal(power, np.zeros(5))
    assert price == 0.0


@pytest.mark.parametrize("seed", range(30))
def test_least_power_fills_rates_to_one_level(seed: int) -> None:
    """Each user gets its rate exactly; p + 1/a is one level below the ceiling, less at it, more where p is 0."""
    rng = np.random.default_rng(seed)
    users, subcarriers = 3, 12
    snr = 10.0 ** rng.uniform(-6, 6, (users, subcarriers))
    snr[:, 3] = snr[:, 4]
    ceiling = np.full(snr.shape, rng.choice([np.inf, 0.5, 1e-4]))
    nats = 10.0 ** rng.uniform(-9, 2, users)
    owner = np.arange(subcarriers) % users
    power, log_price = np.empty(subcarriers), np.empty(users)
    total = least_power(snr, ceiling, nats, owner, power, log_price)
    capacity = np.array([ceiling[k, owner == k].sum() for k in range(users)])
    assert np.isinf(total) == bool(np.any(capacity < nats * (1 - 1e-9)))
    for k in np.flatnonzero(capacity >= nats):
        mine = owner == k
        a, p = snr[k, mine], power[mine]
        rate = np.log1p(p * a)
        assert rate.sum() == pytest.approx(nats[k], rel=EXACT)
        full, idle = rate >= ceiling[k, mine] * (1 - EXACT), p == 0
        level = np.exp(log_price[k])
        assert np.all(np.abs(p + 1 / a - level)[~full & ~idle] <= EXACT * level)
        assert np.all(1 / a[idle] >= level * (1 - EXACT))
        assert np.all((p + 1 / a)[full] <= level * (1 + EXACT))

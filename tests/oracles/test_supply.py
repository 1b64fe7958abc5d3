"""What groups are worth and supply at given prices: against their definitions, term by term and by differences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from wirelessagent.deciding.core.sets_kernel import Channel

USERS, SUBCARRIERS, MAX_NATS = 9, 14, 2.5
SEEDS = range(20)


def channel(seed: int, capped: bool) -> tuple[FloatArray, FloatArray, float, IntArray, FloatArray]:
    """a in 1/W, caps in W, the highest SNR, groups of one to three subcarriers, and λ in W per nat near ties."""
    random = np.random.default_rng(seed)
    snr = random.exponential(size=(USERS, SUBCARRIERS)) * 10.0 ** random.uniform(0, 6, size=(USERS, 1))
    snr[random.random(snr.shape) < 0.1] = 0.0
    price = random.uniform(0.5, 8.0, size=USERS) / np.median(snr, axis=1)
    cap_w = random.uniform(0.5, 2.0, size=SUBCARRIERS) * np.median(price) if capped else np.full(SUBCARRIERS, np.inf)
    start = np.array([0, 1, 2, 5, 6, 8, 9, 12, 13, SUBCARRIERS]) if seed % 2 else np.arange(SUBCARRIERS + 1)
    return snr, cap_w, float(np.expm1(MAX_NATS)) if capped else np.inf, start, price


def terms(snr: FloatArray, cap_w: FloatArray, max_snr: float, start: IntArray, price: FloatArray) -> FloatArray:
    """t_kg = Σ λ r − (e^r − 1)/a by its definition, shape (user, group)."""
    known = np.where(snr > 0, snr, 1.0)
    best = np.log(np.maximum(price[:, None] * snr, 1.0))
    nats = np.minimum(best, np.log1p(np.minimum(cap_w * known, max_snr)))
    worth = price[:, None] * nats - np.expm1(nats) / known
    return np.add.reduceat(np.where(snr > 0, worth, 0.0), start[:-1], axis=1)


def read(snr: FloatArray, cap_w: FloatArray, max_snr: float, start: IntArray) -> Channel:
    """The channel as the kernels have it."""
    from wirelessagent.deciding.core.ask_kernel import SUM, Ask
    from wirelessagent.deciding.core.dual_kernel import channel_of

    rows, share, work = np.zeros((USERS, 6)), np.zeros((USERS, 3)), TimeLimit().work
    return channel_of(snr, Ask(SUM, cap_w, float(np.log1p(max_snr)), start, rows, share, 1.0, 1.0, 0.0, work))


@pytest.mark.parametrize("capped", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_worth_of_groups_is_the_sum_of_their_largest_terms(seed: int, capped: bool) -> None:
    from wirelessagent.deciding.core.terms_kernel import worth_of_groups

    given = channel(seed, capped)
    assert worth_of_groups(*given) == pytest.approx(terms(*given).max(axis=0).sum(), rel=1e-11)


@pytest.mark.parametrize("apart", [1e-15, 1e-9, 1e-6, 1e-3])
def test_the_worth_of_groups_is_found_where_users_nearly_tie(apart: float) -> None:
    from wirelessagent.deciding.core.terms_kernel import worth_of_groups

    random = np.random.default_rng(3)
    snr = 10.0 ** random.uniform(-3, 3, size=(1, 400)) * (1.0 + apart * random.random((USERS, 400)))
    given = snr, np.full(400, np.inf), np.inf, np.arange(401), np.full(USERS, 50.0)
    assert worth_of_groups(*given) == pytest.approx(terms(*given).max(axis=0).sum(), rel=1e-12)


@pytest.mark.parametrize("temperature", [0.3, 0.02])
@pytest.mark.parametrize("capped", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_supply_and_its_curvature_are_those_of_the_smoothed_maximum(
    seed: int, capped: bool, temperature: float
) -> None:
    from wirelessagent.deciding.core.supply_kernel import groups_of, supply

    snr, cap_w, max_snr, start, price = channel(seed, capped)
    groups = groups_of(read(snr, cap_w, max_snr, start), start, capped)
    exact = terms(snr, cap_w, max_snr, start, price).max(axis=0).sum()
    warmth = temperature * exact / (start.size - 1)

    def smoothed(log_price: FloatArray) -> float:
        by_group = terms(snr, cap_w, max_snr, start, np.exp(log_price)) / warmth
        return float(warmth * np.logaddexp.reduce(by_group, axis=0).sum())

    def slope(log_price: FloatArray) -> FloatArray:
        ways = 1e-5 * np.eye(USERS)
        return np.array([smoothed(log_price + way) - smoothed(log_price - way) for way in ways]) / 2e-5

    supplied, rising, cooling = np.empty(USERS), np.empty(USERS), np.empty(USERS + 1)
    hessian = np.empty((USERS + 1, USERS + 1))
    found = supply(groups, np.log(price), warmth, supplied, rising, cooling, hessian)
    assert found[0] == pytest.approx(smoothed(np.log(price)), rel=1e-4)
    assert found[1] == pytest.approx(exact, rel=1e-11)
    assert price * supplied == pytest.approx(slope(np.log(price)), rel=1e-3, abs=1e-4 * exact)
    ways = 1e-3 * np.eye(USERS)
    curvature = np.array([slope(np.log(price) + way) - slope(np.log(price) - way) for way in ways]) / 2e-3
    lower = np.tril(hessian[:USERS, :USERS]) + np.diag(price * supplied)
    assert lower == pytest.approx(np.tril(curvature), rel=2e-2, abs=5e-3 * exact)

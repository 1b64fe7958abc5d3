"""Prices of columns against the linear programme of all sets, and one step of theirs against a general solver."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.optimize import linprog, minimize, minimize_scalar

from wirelessagent.deciding.core.column_prices import column_prices
from wirelessagent.deciding.core.market import NOTHING, Market, Sets
from wirelessagent.deciding.core.mixture_kernel import mix
from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import FloatArray

USERS, COLUMNS = 4, 6
NOBODY = Sets(user=np.empty(0, np.int64), first=np.zeros(1, np.int64), member=np.empty(0, np.int64))
ROWS = {
    "promise": lambda nats: [nats, nats, nats, 0.0, 0.0, 0.0],
    "rate": lambda nats: [0.3 * nats, np.inf, 1.0, 1.0, 0.0, 1.0],
    "fair": lambda nats: [0.0, np.inf, 1.0, 1.0, 1.0, 0.0],
}


def market_of(kind: str, seed: int, budget_w: float) -> tuple[Market, FloatArray]:
    """A market of a few users, and prices of its columns that are not the best."""
    rng = np.random.default_rng([seed, list(ROWS).index(kind)])
    snr = rng.exponential(size=(USERS, COLUMNS)) * 10.0 ** rng.uniform(1, 3, size=(USERS, 1))
    rows = np.array([ROWS[kind](nats) for nats in rng.uniform(0.5, 4.0, USERS)])
    market = Market.of(
        rows, snr, np.full(snr.shape, 4.0), np.arange(COLUMNS + 1),
        cost_per_w=1.0 if np.isinf(budget_w) else 0.0, budget_w=budget_w,
    )  # fmt: skip
    return market, rng.uniform(0.0, 0.2, COLUMNS)


def every_set() -> Sets:
    """All sets of columns, for each user."""
    chosen = [c for size in range(COLUMNS + 1) for c in itertools.combinations(range(COLUMNS), size)]
    lengths = np.tile([len(c) for c in chosen], USERS)
    return Sets(
        user=np.repeat(np.arange(USERS), len(chosen)),
        first=np.concatenate([[0], np.cumsum(lengths)]),
        member=np.tile(np.concatenate([np.array(c, dtype=np.int64) for c in chosen]), USERS),
    )


def programme(market: Market, log_mu: float) -> float:
    """The most that mixtures of all sets are worth at a price of power, no column taken more than once."""
    sets = every_set()
    worth, _ = market.worths(sets, log_mu)
    usable = np.flatnonzero(worth > NOTHING)
    taken = np.zeros((COLUMNS, len(sets)))
    taken[sets.member, np.repeat(np.arange(len(sets)), sets.size)] = 1.0
    each = (sets.user == np.arange(USERS)[:, np.newaxis]).astype(float)
    result = linprog(
        -worth[usable], A_ub=taken[:, usable], b_ub=np.ones(COLUMNS), A_eq=each[:, usable], b_eq=np.ones(USERS)
    )  # fmt: skip
    return -float(result.fun) + market.left_w(log_mu) if result.status == 0 else -np.inf


@pytest.mark.parametrize("kind", ROWS)
@pytest.mark.parametrize("seed", range(6))
def test_without_a_budget_the_prices_prove_what_the_programme_is_worth(kind: str, seed: int) -> None:
    market, price = market_of(kind, seed, np.inf)
    wanted = programme(market, 0.0)
    assert np.isfinite(wanted)
    found = column_prices(market, price, 0.0, NOBODY)
    assert found.bound == pytest.approx(wanted, rel=1e-8)
    assert found.bound >= wanted - 1e-10 * abs(wanted)


@pytest.mark.parametrize("kind", ["rate", "fair"])
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("start", [-3.0, 0.0, 3.0])
def test_within_a_budget_the_price_of_power_is_found_as_well(kind: str, seed: int, start: float) -> None:
    market, price = market_of(kind, seed, 0.5)
    least = minimize_scalar(lambda log_mu: programme(market, log_mu), bounds=(-6.0, 8.0), options={"xatol": 1e-7})
    found = column_prices(market, price, start, NOBODY)
    assert found.bound == pytest.approx(least.fun, rel=1e-6)
    assert found.bound >= least.fun - 1e-6 * abs(least.fun)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("step_mu", [0.0, 0.3])
def test_a_step_minimises_what_is_known_near_the_centre(seed: int, step_mu: float) -> None:
    rng = np.random.default_rng(seed)
    per_user = 5
    member = [np.sort(rng.choice(COLUMNS, rng.integers(0, 4), replace=False)) for _ in range(USERS * per_user)]
    first = np.concatenate([[0], np.cumsum([m.size for m in member])])
    utility, power = rng.uniform(0.5, 2.0, first.size - 1), rng.uniform(0.0, 1.0, first.size - 1)
    begin = np.arange(0, USERS * per_user + 1, per_user)
    center, center_mu, step, least_mu, budget_w = rng.uniform(0.0, 0.5, COLUMNS), 0.7, 0.2, 0.1, 1.5
    weight, price = np.zeros(utility.size), np.empty(COLUMNS)
    weight[begin[:-1]] = 1.0
    mu, model, inexact = mix(
        begin, first, np.concatenate(member), utility, power, center, center_mu, step, step_mu, least_mu, budget_w,
        1e-12, 10**5, weight, price, TimeLimit().work,
    )  # fmt: skip
    incidence = np.zeros((utility.size, COLUMNS))
    for s, columns in enumerate(member):
        incidence[s, columns] = 1.0

    def known(price: FloatArray, mu: float) -> float:
        net = (utility - mu * power - incidence @ price).reshape(USERS, per_user)
        return float(price.sum() + net.max(axis=1).sum()) + ((mu - least_mu) * budget_w if step_mu else 0.0)

    def proximal(price: FloatArray, mu: float) -> float:
        away = float(((price - center) ** 2).sum()) / (2 * step)
        return known(price, mu) + away + ((mu - center_mu) ** 2 / (2 * step_mu) if step_mu else 0.0)

    def limit(x: FloatArray) -> FloatArray:
        """Slack of each set's worth under its user's part, x being π, μ and the users' parts."""
        net = utility - (x[COLUMNS] if step_mu else center_mu) * power - incidence @ x[:COLUMNS]
        return np.repeat(x[COLUMNS + 1 :], per_user) - net

    def cost(x: FloatArray) -> float:
        away = ((x[:COLUMNS] - center) ** 2).sum() / (2 * step)
        mine = (x[COLUMNS] - least_mu) * budget_w + (x[COLUMNS] - center_mu) ** 2 / (2 * step_mu) if step_mu else 0.0
        return float(x[:COLUMNS].sum() + x[COLUMNS + 1 :].sum() + away + mine)

    bounds = [(0.0, None)] * COLUMNS + [(least_mu, None)] + [(None, None)] * USERS
    start = np.concatenate([center, [center_mu], np.full(USERS, 3.0)])
    best = minimize(
        cost, start, bounds=bounds, constraints={"type": "ineq", "fun": limit}, method="SLSQP",
        options={"ftol": 1e-13, "maxiter": 500},
    )  # fmt: skip
    assert model == pytest.approx(known(price, mu), rel=1e-12)
    assert inexact <= 1e-12
    assert weight.reshape(USERS, per_user).sum(axis=1) == pytest.approx(1.0)
    assert proximal(price, mu) == pytest.approx(float(best.fun), rel=1e-7)

"""The methods against independent solutions: exhaustive search on small cases, closed forms, and the paper's formulas.

The oracles share no code with the methods: plain bisection on the water level, for each possible assignment.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import lambertw

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.decision import Bracket
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.testing.channels import known, rayleigh_gain

USERS, SUBCARRIERS = 3, 4
ASSIGNMENTS = [np.array(owner) for owner in itertools.product(range(USERS), repeat=SUBCARRIERS)]
CELLS = {"Shannon": wa.Cell(), "practical": wa.Cell.nr(), "tight": wa.Cell(max_spectral_efficiency_bps_per_hz=1.5)}


def small(seed: int) -> FloatArray:
    """A (3, 4) gain with levels up to 20 dB apart and, in some draws, holes."""
    rng = np.random.default_rng(seed)
    gain = rng.exponential(size=(USERS, SUBCARRIERS)) * 10.0 ** rng.uniform(-13, -11, (USERS, 1))
    gain[rng.uniform(size=gain.shape) < rng.choice([0.0, 0.0, 0.25])] = 0.0
    return gain


def snr_of(gain: FloatArray, cell: wa.Cell) -> FloatArray:
    return gain / (10 ** (cell.snr_gap_db / 10) * cell.noise_psd_w_per_hz * cell.subcarrier_bandwidth_hz)


def rates(snr: FloatArray, power_w: FloatArray, cell: wa.Cell) -> FloatArray:
    most = cell.max_spectral_efficiency_bps_per_hz or np.inf
    return cell.subcarrier_bandwidth_hz * (1 - cell.overhead) * np.minimum(np.log2(1 + power_w * snr), most)


def filled(snr: FloatArray, level: float, cell: wa.Cell, cap_w: float = np.inf) -> FloatArray:
    """[level − 1/a]⁺ up to the caps, in W."""
    most = 2.0 ** (cell.max_spectral_efficiency_bps_per_hz or np.inf) - 1
    with np.errstate(divide="ignore"):
        return np.where(snr > 0, np.clip(level - 1 / snr, 0, np.minimum(cap_w, most / snr)), 0.0)


def level_for(wanted: float, reached: Callable[[float], float]) -> float:
    """The level at which the increasing function ``reached`` is ``wanted``; inf if it never is."""
    low, high = np.log(1e-15), np.log(1e30)
    if reached(float(np.exp(high))) < wanted:
        return np.inf
    for _ in range(65):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reached(float(np.exp(middle))) < wanted else (low, middle)
    return float(np.exp(high))


def most_rate(snr: FloatArray, budget_w: float, cell: wa.Cell, cap_w: float = np.inf) -> float:
    """The sum rate of one assignment by water-filling."""
    level = level_for(budget_w, lambda level: filled(snr, level, cell, cap_w).sum())
    return float(rates(snr, filled(snr, min(level, 1e30), cell, cap_w), cell).sum())


def best_efficiency(snr: FloatArray, budget_w: float, cell: wa.Cell) -> float:
    """Energy efficiency of one assignment by Dinkelbach's method with the level as its inner variable."""
    full = level_for(budget_w, lambda level: filled(snr, level, cell).sum())
    unit = cell.subcarrier_bandwidth_hz * (1 - cell.overhead) / np.log(2)
    level = min(full, 1e30)
    best = 0.0
    for _ in range(60):
        power = filled(snr, level, cell)
        best = max(
            best, rates(snr, power, cell).sum() / (power.sum() / cell.amplifier_efficiency + cell.circuit_power_w)
        )
        level = min(full, unit * cell.amplifier_efficiency / best) if best > 0 else level
    return float(best)


def least_power(snr: FloatArray, rate_bps: FloatArray, cell: wa.Cell) -> float:
    """The least power over all assignments that carry every user's rate; inf if none does."""
    subsets = [np.array(mask) for mask in itertools.product((False, True), repeat=SUBCARRIERS)]
    power = {
        (user, tuple(mask)): power_of(snr[user, mask], rate_bps[user], cell)
        for user in range(USERS)
        for mask in subsets
    }
    return min(sum(power[user, tuple(owner == user)] for user in range(USERS)) for owner in ASSIGNMENTS)


def power_of(snr: FloatArray, rate_bps: float, cell: wa.Cell) -> float:
    """The least power for one user's rate on its own subcarriers; inf if they cannot carry it."""
    if rate_bps == 0:
        return 0.0
    level = level_for(rate_bps * (1 - 1e-13), lambda level: float(rates(snr, filled(snr, level, cell), cell).sum()))
    return np.inf if np.isinf(level) else float(filled(snr, level, cell).sum())


def column(snr: FloatArray, owner: IntArray) -> FloatArray:
    return snr[owner, np.arange(owner.size)]


@pytest.mark.parametrize("link", CELLS)
@pytest.mark.parametrize("seed", range(4))
def test_max_rate_is_the_best_of_all_assignments(seed: int, link: str) -> None:
    cell, gain = CELLS[link], small(seed)
    snr, budget_w = snr_of(gain, cell), float(10.0 ** np.random.default_rng(seed).uniform(-3, 1))
    cap_w = 0.3 * budget_w if seed % 2 else np.inf
    best = max(most_rate(column(snr, owner), budget_w, cell, cap_w) for owner in ASSIGNMENTS)
    problem = wa.Problem("max_rate", max_power_w=budget_w, subcarrier_max_power_w=cap_w)
    decision = wa.decide(known(gain), problem, cell)
    assert decision.status == "optimal"
    assert decision.value == pytest.approx(best, rel=1e-10)
    assert decision.bound == pytest.approx(best, rel=1e-10)


@pytest.mark.parametrize("link", CELLS)
@pytest.mark.parametrize("seed", range(4))
def test_max_energy_efficiency_is_the_best_of_all_assignments(seed: int, link: str) -> None:
    cell, gain = CELLS[link], small(seed)
    snr, budget_w = snr_of(gain, cell), float(10.0 ** np.random.default_rng(seed).uniform(-3, 1))
    best = max(best_efficiency(column(snr, owner), budget_w, cell) for owner in ASSIGNMENTS)
    decision = wa.decide(known(gain), wa.Problem("max_energy_efficiency", max_power_w=budget_w), cell)
    assert decision.status == "optimal"
    assert decision.value == pytest.approx(best, rel=1e-12)
    assert decision.bound == pytest.approx(best, rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_max_energy_efficiency_is_lamberts_closed_form(seed: int) -> None:
    """On m active subcarriers v = −c/W(−c e^(L/m − 1)), c = (S − P_c)/m, S = Σ 1/a, L = Σ ln a; the best is 1/v."""
    gain = rayleigh_gain(8, 20, seed=seed)[0]
    cell = wa.Cell(max_power_w=1e6)
    best = snr_of(gain, cell).max(axis=0)
    decision = wa.decide(known(gain), wa.Problem("max_energy_efficiency"), cell)
    found = []
    for m in range(1, best.size + 1):
        a = np.sort(best)[::-1][:m]
        c = (np.sum(1 / a) - cell.circuit_power_w) / m
        for branch in (0, -1):
            root = lambertw(-c * np.exp(np.log(a).mean() - 1), branch)
            level = float((-c / root).real)
            if root.imag == 0 and level >= 1 / a[-1] and (m == best.size or level <= 1 / np.sort(best)[::-1][m]):
                found.append(1 / level)
    assert decision.value == pytest.approx(max(found) * cell.subcarrier_bandwidth_hz / np.log(2), rel=1e-13)


@pytest.mark.parametrize("seed", range(3))
def test_no_power_scan_beats_the_exact_efficiency(seed: int) -> None:
    estimate = known(rayleigh_gain(4, 12, seed=seed)[0])
    problem = wa.Problem("max_energy_efficiency")
    exact = wa.decide(estimate, problem)
    coarse, fine = (wa.decide(estimate, problem, method="paper_scan", num_levels=levels) for levels in (100, 20000))
    assert exact.value * (1 + 1e-14) >= fine.value >= coarse.value
    assert fine.value >= exact.value * (1 - 1e-6)
    assert coarse.bound == pytest.approx(exact.value, rel=1e-13)


@pytest.mark.parametrize("link", CELLS)
@pytest.mark.parametrize("seed", range(8))
def test_promised_rates_against_all_assignments(seed: int, link: str) -> None:
    """The bound is below the true least power, what was found above it; infeasible and scaling are as true."""
    cell, gain = CELLS[link], small(seed)
    rng = np.random.default_rng(seed)
    rate = rng.choice([0.0, 0.3, 1.0, 2.5], USERS) * cell.subcarrier_bandwidth_hz
    rate[0] = cell.subcarrier_bandwidth_hz
    budget_w = float(10.0 ** rng.uniform(-1, 1))
    snr = snr_of(gain, cell)
    best = least_power(snr, rate, cell)
    problem = wa.Problem("min_power", min_rate_bps=rate, max_power_w=budget_w)
    for method in ("dual", "greedy", "paper_inversion", "equal_power", "round_robin"):
        decision = wa.decide(known(gain), problem, cell, method)
        needed, scaling = decision.needed_power_w, decision.rate_scaling
        assert needed is not None
        assert scaling is not None
        assert needed.at_least <= best * (1 + 1e-9)
        assert np.isnan(needed.at_most) or needed.at_most >= best * (1 - 1e-9)
        assert scaling.at_least <= scaling.at_most * (1 + 1e-9)
        if decision.is_usable:
            assert decision.bound <= best * (1 + 1e-9)
            assert best * (1 - 1e-9) <= decision.value <= budget_w * (1 + 1e-9)
            assert np.all(decision.rate_bps >= rate * (1 - 1e-9))
        else:
            assert decision.status == "undecided" or best > budget_w
            assert decision.reason
            assert np.all(decision.owner == -1)
            assert not decision.power_w.any()
        if method in ("dual", "greedy"):
            assert least_power(snr, scaling.at_least * (1 - 1e-9) * rate, cell) <= budget_w * (1 + 1e-9)
            assert least_power(snr, scaling.at_most * (1 + 1e-6) * rate, cell) > budget_w


@pytest.mark.parametrize("method", ["dual", "greedy"])
def test_an_allocation_is_found_wherever_there_is_one_with_room(method: str) -> None:
    """As many users as subcarriers, each of use to some only: a matching is needed, and greedy turns alone miss it."""
    forbidden = np.ones((3, 3), dtype=bool)
    for user, subcarrier in ((0, 0), (0, 1), (1, 0), (2, 1), (2, 2)):
        forbidden[user, subcarrier] = False
    gain = np.array([[1.0, 0.9, 1.0], [5.0, 1.0, 1.0], [1.0, 9.0, 0.1]]) * 1e-11
    problem = wa.Problem("min_power", min_rate_bps=1e5, forbidden=forbidden)
    decision = wa.decide(known(gain), problem, method=method)
    assert decision.is_usable
    assert np.array_equal(decision.owner, [1, 0, 2])


@pytest.mark.parametrize(
    ("users", "subcarriers", "rate_bps", "cell", "words"),
    [
        (4, 3, 1e3, wa.Cell(), "3 of them can have one"),
        (2, 8, 1e8, wa.Cell(), "more than the budget of 20 W"),
        (1, 2, 1e8, wa.Cell.nr(), "at any power"),
        (3, 4, 2.5e6, wa.Cell.nr(), "at least 6 subcarriers"),
    ],
)
def test_impossible_rates_are_proven_so(
    users: int, subcarriers: int, rate_bps: float, cell: wa.Cell, words: str
) -> None:
    gain = np.full((users, subcarriers), 1e-8)
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=rate_bps), cell)
    assert decision.status == "infeasible"
    assert words in decision.reason
    assert np.isnan(decision.value)


@pytest.mark.parametrize(
    ("gain", "limits", "words"),
    [
        (
            np.array([[0.0, 0.0], [1e-8, 1e-8]]),
            {"min_rate_bps": [1e3, 0.0]},
            "user 1 is asked to get a rate, but no sub",
        ),
        (np.array([[0.0, 1e-8], [0.0, 1e-8]]), {"min_rate_bps": 1e3}, "with 1 usable subcarrier only 1 of them"),
        (np.zeros((2, 2)), {"min_rate_bps": 1e3}, "with 0 usable subcarriers none of them"),
        (np.full((2, 3), 1e-8), {"min_rate_bps": 1e6, "subcarrier_max_power_w": 1e-3}, "add up to 2 Mbit/s, but"),
    ],
)
def test_why_no_power_is_enough(gain: FloatArray, limits: dict[str, FloatArray], words: str) -> None:
    decision = wa.decide(known(gain), wa.Problem("min_power", **limits), wa.Cell())
    assert decision.status == "infeasible"
    assert words in decision.reason
    assert decision.needed_power_w == Bracket(at_least=np.inf, at_most=np.inf)


@pytest.mark.parametrize("method", ["dual", "greedy", "paper_inversion", "equal_power", "round_robin"])
@pytest.mark.parametrize("rate_bps", [2e7, 1e8, 2e8])
def test_rates_far_beyond_the_budget_are_proven_impossible(rate_bps: float, method: str) -> None:
    """At least what one user with the best gains needs for them all: ln v = (R − Σ ln a)/N and P = N v − Σ 1/a."""
    gain, cell = rayleigh_gain(8, 20, seed=0)[0], wa.Cell()
    best = snr_of(gain, cell).max(axis=0)
    nats = 8 * rate_bps / cell.subcarrier_bandwidth_hz * np.log(2)
    needed_w = 20 * np.exp((nats - np.log(best).sum()) / 20) - (1 / best).sum()
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=rate_bps, max_power_w=1), cell, method)
    assert decision.status == "infeasible"
    assert needed_w * (1 - 1e-9) <= decision.needed_power_w.at_least < needed_w * 1e3
    assert decision.rate_scaling.at_most * 8 * rate_bps <= most_rate(best, 1.0, cell) * (1 + 1e-9)
    assert "need more than 1e12 W on this channel, more than the budget of 1 W" in decision.reason


def test_one_user_with_a_huge_rate_is_bounded_as_if_alone() -> None:
    """The others need next to nothing, but one price for all would let the strong ones carry the rate."""
    gain = rayleigh_gain(4, 6, seed=3)[0] * np.array([[1e-4], [1.0], [1.0], [1.0]])
    rate = np.array([9e7, 1.0, 1.0, 1.0])
    cell = wa.Cell()
    alone_w = power_of(snr_of(gain, cell)[0], rate[0], cell)
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=rate, max_power_w=1), cell)
    assert decision.status == "infeasible"
    assert decision.needed_power_w.at_least >= alone_w * (1 - 1e-9)


@pytest.mark.parametrize("rate_bps", [1e-6, 1.0])
@pytest.mark.parametrize("seed", range(3))
def test_tiny_rates_need_what_each_user_needs_on_its_best_subcarrier(seed: int, rate_bps: float) -> None:
    """To first order P = R/a, and where users would meet on a subcarrier they share its time in the bound."""
    gain, cell = rayleigh_gain(8, 20, seed=seed)[0], wa.Cell()
    nats = rate_bps / cell.subcarrier_bandwidth_hz * np.log(2)
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=rate_bps), cell)
    needed_w = float((nats / snr_of(gain, cell).max(axis=1)).sum())
    assert decision.needed_power_w.at_least == pytest.approx(needed_w, rel=1e-3)


def test_paper_inversion_is_the_papers_formula() -> None:
    """Eq. (10) on sets without overlap: two users, four subcarriers, both best on the same two."""
    gain = np.array([[8.0, 6.0, 2.0, 1.0], [8.0, 7.0, 4.0, 3.0]]) * 1e-11
    cell = wa.Cell()
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=2e5), cell, "paper_inversion")
    assert np.array_equal(decision.owner, [0, 1, 0, 1])  # in turn: 0 takes its best, 1 its best free one, …
    noise_w = cell.noise_psd_w_per_hz * cell.subcarrier_bandwidth_hz
    expected = (2 ** (2e5 / (cell.subcarrier_bandwidth_hz * 2)) - 1) * noise_w / gain[decision.owner, np.arange(4)]
    assert np.allclose(decision.power_w, expected, rtol=1e-12, atol=0)
    assert np.allclose(decision.rate_bps, 2e5, rtol=1e-12, atol=0)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6, 0.0])
def test_paper_bisection_stays_within_the_budget_and_its_gap_tells_its_error(tolerance: float) -> None:
    estimate = known(rayleigh_gain(4, 12, seed=3)[0])
    exact = wa.decide(estimate, wa.Problem("max_rate"))
    decision = wa.decide(estimate, wa.Problem("max_rate"), method="paper_bisection", tolerance=tolerance)
    assert 20 * (1 - tolerance - 1e-12) <= decision.total_power_w <= 20
    assert decision.bound >= exact.value * (1 - 1e-14)
    error = 1 - decision.value / exact.value
    assert error <= decision.gap + 1e-14 <= 2 * tolerance + 1e-12


@pytest.mark.parametrize("objective", ["max_rate", "max_energy_efficiency"])
@pytest.mark.parametrize("budget_w", [1e-3, 0.1, 20.0])
def test_price_of_power_predicts_a_little_more(objective: str, budget_w: float) -> None:
    estimate = known(rayleigh_gain(4, 12, seed=1)[0])
    less, more = (wa.decide(estimate, wa.Problem(objective, max_power_w=budget_w * (1 + step))) for step in (-1e-4, 0))
    slope = (more.value - less.value) / (1e-4 * budget_w)
    assert slope == pytest.approx(more.price_of_power, rel=1e-3, abs=1e-6 * more.value / budget_w)


@pytest.mark.parametrize("link", CELLS)
@pytest.mark.parametrize("seed", range(4))
def test_power_costs_nothing_where_the_budget_does_not_bind(seed: int, link: str) -> None:
    estimate = known(rayleigh_gain(8, 20, seed=seed)[0])
    free = wa.decide(estimate, wa.Problem("max_energy_efficiency"), CELLS[link])
    assert free.total_power_w < 20
    assert free.price_of_power == 0
    problem = wa.Problem("max_energy_efficiency", max_power_w=0.5 * free.total_power_w)
    assert wa.decide(estimate, problem, CELLS[link]).price_of_power > 0


@pytest.mark.parametrize("rate_bps", [1e3, 3e5])
@pytest.mark.parametrize("seed", range(4))
def test_rate_prices_are_the_best(seed: int, rate_bps: float) -> None:
    """No prices found by a direct search around them prove more than a thousandth above the bound."""
    gain, cell = rayleigh_gain(4, 10, seed=seed)[0], wa.Cell()
    decision = wa.decide(known(gain), wa.Problem("min_power", min_rate_bps=rate_bps, max_power_w=20), cell)
    unit = cell.subcarrier_bandwidth_hz / np.log(2)

    def negative_dual(log_price: FloatArray) -> float:
        price = np.exp(log_price)[:, np.newaxis]
        snr = np.maximum(price * snr_of(gain, cell), 1.0)
        worth = price * np.log(snr) - (snr - 1) / snr_of(gain, cell)
        return float(worth.max(axis=0).sum() - np.exp(log_price).sum() * rate_bps / unit)

    start = np.log(decision.price_of_rate * unit)
    assert -negative_dual(start) == pytest.approx(decision.needed_power_w.at_least, rel=1e-9)
    for spread in (1e-1, 1e-3, 1e-5):
        simplex = start + spread * np.vstack([np.zeros(4), np.eye(4)])
        found = minimize(negative_dual, start, method="Nelder-Mead", options={"initial_simplex": simplex, "fatol": 0})
        assert -found.fun <= decision.needed_power_w.at_least * (1 + 1e-3)


@pytest.mark.parametrize("method", ["dual", "greedy"])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.98])
def test_rate_scaling_brackets_the_largest_common_rate(share: float, method: str) -> None:
    """What the sets at hand carry is no more than the largest common rate, and what the prices exclude no less."""
    estimate = known(rayleigh_gain(4, 48, seed=2)[0])
    most = wa.decide(estimate, wa.Problem("max_min_rate"))
    rate_bps = share * most.value
    decision = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=rate_bps), method=method)
    scaling = decision.rate_scaling
    assert scaling is not None
    assert 1.0 <= scaling.at_least <= most.bound / rate_bps * (1 + 1e-9)
    assert scaling.at_most >= most.value / rate_bps * (1 - 1e-9)
    if share > 0.9 and method == "dual":
        assert scaling.at_most <= 1.05 * scaling.at_least


def test_price_of_rate_predicts_a_little_more() -> None:
    """The bound is concave in the rates' prices, so its change is what the prices say, within their accuracy."""
    estimate, rate = known(rayleigh_gain(4, 24, seed=1)[0]), np.array([3e5, 2e5, 0.0, 5e5])
    decision = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=rate))
    assert decision.price_of_rate[2] == 0
    for user in (0, 1, 3):
        step = np.where(np.arange(4) == user, 1e3, 0.0)
        more = wa.decide(estimate, wa.Problem("min_power", min_rate_bps=rate + step))
        assert more.bound - decision.bound == pytest.approx(decision.price_of_rate[user] * 1e3, rel=0.2)


@pytest.mark.parametrize("budget_w", [1e-20, 20.0])
def test_without_circuit_power_the_efficiency_is_its_supremum(budget_w: float) -> None:
    gain = rayleigh_gain(4, 12, seed=2)[0]
    cell = wa.Cell(circuit_power_w=0.0)
    decision = wa.decide(known(gain), wa.Problem("max_energy_efficiency", max_power_w=budget_w), cell)
    assert decision.total_power_w == pytest.approx(min(budget_w, 1e-12 / snr_of(gain, cell).max()), rel=1e-3)
    supremum = snr_of(gain, cell).max() * cell.subcarrier_bandwidth_hz / np.log(2)
    assert decision.status == "optimal"
    assert supremum * (1 - 1e-11) <= decision.value <= supremum
    assert "only approached" in decision.reason
    assert not wa.decide(known(gain), wa.Problem("max_energy_efficiency", max_power_w=budget_w)).reason


def test_more_users_do_not_own_what_they_may_not() -> None:
    gain = rayleigh_gain(4, 12, seed=2)[0]
    for name in ("dual", "greedy", "paper_bisection", "equal_power", "round_robin"):
        decision = wa.decide(known(gain), wa.Problem("max_rate", users=("user 3",)), method=name)
        assert set(decision.owner) <= {-1, 2}
        assert decision.bound == pytest.approx(most_rate(snr_of(gain, wa.Cell())[2], 20.0, wa.Cell()), rel=1e-6)


def test_equal_power_radiates_what_it_is_told() -> None:
    estimate = known(rayleigh_gain(4, 12, seed=2)[0])
    decision = wa.decide(estimate, wa.Problem("max_rate"), method="equal_power", power_w=3.0)
    assert np.allclose(decision.power_w, 0.25, rtol=1e-15, atol=0)
    with pytest.raises(InputError, match=r"power_w = 30 W is above the budget of 20 W"):
        wa.decide(estimate, wa.Problem("max_rate"), method="equal_power", power_w=30.0)


def test_what_is_not_honoured_is_refused() -> None:
    estimate = known(rayleigh_gain(2, 4, seed=2)[0])
    with pytest.raises(UnsupportedProblemError, match="does not honour weights: leave it out or"):
        wa.decide(estimate, wa.Problem("max_rate", weights=[1.0, 2.0]), method="round_robin")
    with pytest.raises(UnsupportedProblemError, match="min_rate_bps, weights: leave them out or"):
        wa.decide(estimate, wa.Problem("max_rate", weights=[1.0, 2.0], min_rate_bps=1.0), method="paper_bisection")
    with pytest.raises(InputError, match="shape"):
        wa.decide(estimate, wa.Problem("max_rate", forbidden=np.zeros((4, 2), dtype=bool)))
    with pytest.raises(InputError, match="no user is called 'user 3'"):
        wa.decide(estimate, wa.Problem("max_rate", users=("user 3",)))
    with pytest.raises(InputError, match="out of range"):
        wa.decide(known(np.full((2, 4), 1e99)), wa.Problem("max_rate"))

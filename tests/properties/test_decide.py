"""What must hold of every decision, on channels from ordinary to extreme."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.testing.channels import known, rayleigh_gain

METHODS = {
    "max_rate": ("dual", "greedy", "paper_bisection", "equal_power", "round_robin"),
    "min_power": ("dual", "greedy", "paper_inversion", "equal_power", "round_robin"),
    "max_energy_efficiency": ("dual", "greedy", "paper_scan", "equal_power", "round_robin"),
}
PAIRS = [(objective, method) for objective, methods in METHODS.items() for method in methods]
EXACT = [("max_rate", "dual"), ("max_energy_efficiency", "dual")]
CELLS = (wa.Cell(max_power_w=1e6), wa.Cell.nr(max_power_w=1e6))

quick = settings(max_examples=25, deadline=None, derandomize=True)


@st.composite
def gains(draw: st.DrawFn, *, extreme: bool = False) -> FloatArray:
    """A (user, subcarrier) gain: levels up to 30 dB apart; or 1e-30 … 1 with zero entries, rows, columns and ties."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    users, subcarriers = draw(st.integers(1, 5)), draw(st.integers(1, 9))
    if not extreme:
        return rng.exponential(size=(users, subcarriers)) * 10.0 ** rng.uniform(-13, -10, (users, 1))
    gain = 10.0 ** rng.uniform(-30, 0, (users, subcarriers))
    gain[rng.uniform(size=gain.shape) < draw(st.sampled_from([0.0, 0.3, 1.0]))] = 0.0
    if draw(st.booleans()):
        gain[rng.integers(users)] = 0.0
        gain[:, rng.integers(subcarriers)] = 0.0
    if draw(st.booleans()):
        gain[:] = gain[:, :1]
    return gain


def solve(gain: FloatArray, objective: str, method: str, cell: wa.Cell, **limits: Any) -> wa.Decision:
    return wa.decide(known(gain), wa.Problem(objective, **limits), cell, method)


def check(decision: wa.Decision, gain: FloatArray, budget_w: float, promised_bps: float) -> None:
    """Figures are sane; usable decisions keep every limit, others hold nothing; the bound is on its side."""
    assert np.all(np.isfinite(decision.power_w))
    assert np.all(np.isfinite(decision.rate_bps))
    if not decision.is_usable:
        assert decision.reason
        assert np.isnan(decision.value)
        assert not decision.power_w.any()
        return
    assert np.all(decision.power_w >= 0)
    assert decision.total_power_w <= budget_w * (1 + 1e-9)
    assert not decision.power_w[decision.owner < 0].any()
    rate = user_rate_bps(gain, decision.owner, decision.power_w, decision.cell)
    assert np.allclose(decision.rate_bps, rate, rtol=1e-12, atol=0)
    assert np.all(rate >= promised_bps * (1 - 1e-9))
    assert np.isfinite(decision.value)
    sign = -1 if decision.problem.objective.direction == "min" else 1  # pyright: ignore
    assert sign * (decision.bound - decision.value) >= -1e-12 * abs(decision.bound)
    assert (decision.status == "optimal") == (decision.gap <= 1e-9)


@pytest.mark.parametrize(("objective", "method"), PAIRS)
@given(gain=gains(extreme=True), log_budget=st.floats(-9, 6), link=st.sampled_from(CELLS), nothing=st.booleans())
@quick
def test_extreme_input_is_decided_sanely(
    objective: str, method: str, gain: FloatArray, log_budget: float, link: wa.Cell, nothing: bool
) -> None:
    budget_w = 10.0**log_budget
    cell = dataclasses.replace(link, circuit_power_w=0.0 if nothing else 5.0)
    decision = solve(gain, objective, method, cell, max_power_w=budget_w)
    check(decision, gain, budget_w, 0.0)
    if (objective, method) in EXACT:
        assert decision.status == "optimal"
        assert decision.value > 0 or not gain.any()


@pytest.mark.parametrize("method", METHODS["min_power"])
@given(
    gain=gains(extreme=True),
    log_budget=st.floats(-9, 6),
    link=st.sampled_from(CELLS),
    promised_bps=st.sampled_from([1e-3, 1e3, 1e6, 1e9]),
)
@quick
def test_extreme_promises_are_decided_sanely(
    method: str, gain: FloatArray, log_budget: float, link: wa.Cell, promised_bps: float
) -> None:
    budget_w = 10.0**log_budget
    decision = solve(gain, "min_power", method, link, max_power_w=budget_w, min_rate_bps=promised_bps)
    check(decision, gain, budget_w, promised_bps)
    needed, scaling = decision.needed_power_w, decision.rate_scaling
    assert needed is not None
    assert scaling is not None
    assert not needed.at_least > needed.at_most * (1 + 1e-9)
    assert 0 <= scaling.at_least <= scaling.at_most * (1 + 1e-9)
    if np.any(~gain.any(axis=1)) or gain.shape[0] > np.count_nonzero(gain.any(axis=0)):
        assert decision.status == "infeasible"
        assert needed.at_least == np.inf


@pytest.mark.parametrize(("objective", "method"), PAIRS)
@given(gain=gains(), budget_w=st.sampled_from([0.01, 1.0, 20.0]), cap_w=st.sampled_from([np.inf, 0.2]), data=st.data())
@quick
def test_every_limit_is_kept(
    objective: str, method: str, gain: FloatArray, budget_w: float, cap_w: float, data: st.DataObject
) -> None:
    forbidden = np.random.default_rng(data.draw(st.integers(0, 99))).uniform(size=gain.shape) < 0.2
    users = data.draw(st.sets(st.integers(0, gain.shape[0] - 1), min_size=1).map(tuple))
    promised_bps = data.draw(st.sampled_from([0.0, 5e4])) if objective == "min_power" else 0.0
    limits: dict[str, Any] = {"min_rate_bps": promised_bps} if promised_bps else {}
    decision = solve(
        gain, objective, method, CELLS[0],
        max_power_w=budget_w, subcarrier_max_power_w=cap_w, forbidden=forbidden,
        users=[f"user {user + 1}" for user in users], **limits,
    )  # fmt: skip
    check(decision, gain, budget_w, np.isin(np.arange(gain.shape[0]), users) * promised_bps)
    served = decision.owner >= 0
    assert np.all(decision.power_w <= cap_w * (1 + 1e-12))
    assert not forbidden[decision.owner[served], np.flatnonzero(served)].any()
    assert set(decision.owner[served]) <= set(users)


@pytest.mark.parametrize(("objective", "method"), EXACT)
@given(gain=gains(), link=st.sampled_from(CELLS), seed=st.integers(0, 99))
@quick
def test_order_does_not_matter(objective: str, method: str, gain: FloatArray, link: wa.Cell, seed: int) -> None:
    rng = np.random.default_rng(seed)
    users, subcarriers = rng.permutation(gain.shape[0]), rng.permutation(gain.shape[1])
    decision = solve(gain, objective, method, link)
    permuted = solve(gain[users][:, subcarriers], objective, method, link)
    assert permuted.value == pytest.approx(decision.value, rel=1e-13)
    assert permuted.bound == pytest.approx(decision.bound, rel=1e-13)
    assert np.allclose(permuted.power_w, decision.power_w[subcarriers], rtol=1e-9, atol=1e-12 * decision.total_power_w)
    assert np.allclose(permuted.rate_bps, decision.rate_bps[users], rtol=1e-9, atol=1e-9 * decision.rate_bps.max())


@given(gain=gains(), seed=st.integers(0, 99), rate_bps=st.sampled_from([1e4, 2e5]))
@quick
def test_the_bound_on_power_hardly_depends_on_order(gain: FloatArray, seed: int, rate_bps: float) -> None:
    """The search for prices starts from a heuristic, so its bound may differ a little; the true optimum does not."""
    rng = np.random.default_rng(seed)
    moved = gain[rng.permutation(gain.shape[0])][:, rng.permutation(gain.shape[1])]
    first, second = (solve(g, "min_power", "dual", CELLS[0], min_rate_bps=rate_bps) for g in (gain, moved))
    assert first.status == second.status or "undecided" in (first.status, second.status)
    if gain.shape[0] <= gain.shape[1]:
        assert first.needed_power_w is not None
        assert second.needed_power_w is not None
        assert second.needed_power_w.at_least == pytest.approx(first.needed_power_w.at_least, rel=1e-2)


@pytest.mark.parametrize(("objective", "method"), PAIRS)
@given(gain=gains(), exponent=st.integers(-20, 20))
@quick
def test_gains_and_noise_together_change_nothing(objective: str, method: str, gain: FloatArray, exponent: int) -> None:
    """By a power of two, so that not even rounding differs."""
    scaled_cell = dataclasses.replace(CELLS[0], noise_psd_w_per_hz=CELLS[0].noise_psd_w_per_hz * 2.0**exponent)
    limits: dict[str, Any] = {"min_rate_bps": 5e4} if objective == "min_power" else {}
    decision = solve(gain, objective, method, CELLS[0], **limits)
    scaled = solve(gain * 2.0**exponent, objective, method, scaled_cell, **limits)
    assert np.array_equal(scaled.owner, decision.owner)
    assert np.array_equal(scaled.power_w, decision.power_w)
    assert np.array_equal([scaled.value, scaled.bound], [decision.value, decision.bound], equal_nan=True)


@pytest.mark.parametrize("method", METHODS["max_rate"])
@given(gain=gains(), low_w=st.floats(1e-9, 1e3), factor=st.floats(1.0, 1e3), link=st.sampled_from(CELLS))
@quick
def test_rate_never_falls_with_budget(
    method: str, gain: FloatArray, low_w: float, factor: float, link: wa.Cell
) -> None:
    low, high = (solve(gain, "max_rate", method, link, max_power_w=budget) for budget in (low_w, low_w * factor))
    slack = {"paper_bisection": 2e-6, "greedy": 1e-9}.get(method, 1e-13)  # the bisection leaves up to 1e-6 unspent
    assert high.value >= low.value * (1 - slack)
    assert high.bound >= low.bound * (1 - min(slack, 1e-9))


@given(gain=gains(), low_w=st.floats(1e-9, 1e3), factor=st.floats(1.0, 1e3), link=st.sampled_from(CELLS))
@quick
def test_efficiency_never_falls_with_budget_nor_rises_beyond_the_best_ratio(
    gain: FloatArray, low_w: float, factor: float, link: wa.Cell
) -> None:
    low = solve(gain, "max_energy_efficiency", "dual", link, max_power_w=low_w)
    high = solve(gain, "max_energy_efficiency", "dual", link, max_power_w=low_w * factor)
    assert high.value >= low.value * (1 - 1e-13)
    assert high.total_power_w >= low.total_power_w * (1 - 1e-6)
    most = solve(gain, "max_rate", "dual", link, max_power_w=high.total_power_w)
    assert high.rate_bps.sum() == pytest.approx(most.value, rel=1e-12)


@given(gain=gains(), budget_w=st.floats(1e-6, 1e3), link=st.sampled_from(CELLS))
@quick
def test_one_user_round_trip(gain: FloatArray, budget_w: float, link: wa.Cell) -> None:
    """The least power for the best rate of a budget is that budget, and both are proven so."""
    alone = gain[:1]
    best = solve(alone, "max_rate", "dual", link, max_power_w=budget_w)
    back = solve(
        alone, "min_power", "dual", link, max_power_w=budget_w, min_rate_bps=best.value * (1 - 1e-13)
    )  # fmt: skip
    assert back.gap <= 1e-6
    assert back.value == pytest.approx(best.total_power_w, rel=1e-9)
    assert back.rate_scaling is not None
    assert back.rate_scaling.at_least == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize("method", METHODS["min_power"])
@pytest.mark.parametrize("link", range(len(CELLS)))
def test_from_one_bit_to_a_petabit_per_second(method: str, link: int) -> None:
    """Once infeasible always infeasible, more power and less scaling step by step, and brackets the right way round."""
    gain = rayleigh_gain(8, 20, seed=link)[0]
    impossible, needed_w, most_bps = False, 0.0, np.inf
    for rate_bps in np.concatenate([10.0 ** np.arange(0, 5), 10.0 ** np.arange(5, 10, 0.5), 10.0 ** np.arange(10, 16)]):
        decision = solve(gain, "min_power", method, CELLS[link], max_power_w=1.0, min_rate_bps=rate_bps)
        needed, scaling = decision.needed_power_w, decision.rate_scaling
        assert needed is not None
        assert scaling is not None
        assert needed.at_least > 0
        assert not needed.at_least > needed.at_most * (1 + 1e-9)
        assert 0 <= scaling.at_least <= scaling.at_most * (1 + 1e-9) < np.inf
        assert needed.at_least >= needed_w * (1 - 1e-9)
        assert scaling.at_most * rate_bps <= most_bps * 1.05
        assert decision.status == "infeasible" or not impossible
        impossible, needed_w = decision.status == "infeasible", needed.at_least
        most_bps = min(most_bps, scaling.at_most * rate_bps)
    assert impossible


@given(gain=gains(), rate_bps=st.floats(1e3, 1e6), factor=st.floats(1.01, 3.0), link=st.sampled_from(CELLS))
@quick
def test_more_rate_needs_more_power(gain: FloatArray, rate_bps: float, factor: float, link: wa.Cell) -> None:
    less, more = (solve(gain, "min_power", "dual", link, min_rate_bps=rate) for rate in (rate_bps, rate_bps * factor))
    assert less.needed_power_w is not None
    assert more.needed_power_w is not None
    assert more.needed_power_w.at_least >= less.needed_power_w.at_least * (1 - 1e-2)
    assert more.status != "optimal" or less.status != "infeasible"

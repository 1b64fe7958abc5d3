"""Every registered method against exhaustive search on 1,000 random small problems of every combination.

No bound is beaten, nothing that has an allocation is called infeasible, nothing optimal is beaten, every limit is kept;
and the default method's value is the best one in the median. Run with -s to see how far from the best methods are.
"""

from __future__ import annotations

import functools
import itertools
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import MissingDependencyError, UnsupportedProblemError
from wirelessagent.testing.judge import Verdict, faults, shortfall, verdict_on
from wirelessagent.testing.random_problems import RandomProblem, random_problem


@dataclass(frozen=True, kw_only=True)
class AlphaFairness(wa.Objective):
    """Σ r^(1−α)/(1−α) with r in Mbit/s: one that is not built in, and below 0 for α > 1."""

    name = "alpha_fairness"
    alpha: float = 2.0

    def utility(self, rate: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore"):
            return (rate / 1e6) ** (1 - self.alpha) / (1 - self.alpha)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        with np.errstate(divide="ignore", over="ignore"):
            rate = np.clip(1e6 * (price * 1e6) ** (-1 / self.alpha), min_rate, max_rate)
        free = price == 0
        return self.utility(rate) - np.where(free, 0.0, price) * np.where(free, 0.0, rate), rate


@dataclass(frozen=True, kw_only=True)
class FirstBits(wa.Objective):
    """Σ min(r, 300 kbit/s) + r/10: a utility with a corner."""

    name = "first_bits"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.minimum(rate, 3e5) + 0.1 * rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        rate = np.where(price < 0.1, max_rate, np.where(price < 1.1, np.clip(3e5, min_rate, max_rate), min_rate))
        return np.minimum(rate, 3e5) + np.where(rate > 0, (0.1 - price) * rate, 0.0), rate


OBJECTIVES: dict[str, wa.Objective] = {name: wa.plugins.objective(name) for name in wa.plugins.names("objective")} | {
    "proportional_fairness with a past": wa.plugins.objective(
        "proportional_fairness", {"past_average_bps": (1e5, 3e6, 0.0)}
    ),
    "square roots": AlphaFairness(alpha=0.5),
    "alpha_fairness": AlphaFairness(),
    "first_bits": FirstBits(),
}
every_objective = pytest.mark.parametrize("objective", OBJECTIVES)
needs_dual = pytest.mark.skipif("dual" not in wa.plugins.names("method"), reason="the method dual is not installed")
PROBLEMS = 1000
SEEDS = -(-PROBLEMS // len(OBJECTIVES))
SAME = 1e-9


@functools.cache
def judged(objective: str) -> list[tuple[int, RandomProblem, Verdict]]:
    cases = ((seed, random_problem(seed, OBJECTIVES[objective])) for seed in range(SEEDS))
    return [(seed, case, verdict_on(*case[:3])) for seed, case in cases]


def decisions(objective: str, method: str) -> Iterator[tuple[int, RandomProblem, Verdict, Decision]]:
    """The problems of the objective that the method solves, with its decisions."""
    for seed, case, verdict in judged(objective):
        try:
            yield seed, case, verdict, wa.decide(case.estimate, case.problem, case.cell, method)
        except UnsupportedProblemError:
            continue
        except MissingDependencyError as error:
            pytest.skip(str(error))


def features(case: RandomProblem) -> Iterator[str]:
    """The combinations that a problem belongs to."""
    yield "all"
    yield case.link
    yield from (name for name in case.problem.constraints() if name != "max_power_w")


def test_the_problems_meet_every_pair_of_constraints() -> None:
    """Every pair but two links and, for each objective, every constraint that it takes, possible and impossible."""
    met: set[tuple[str, str]] = set()
    for name, objective in OBJECTIVES.items():
        found = [set(features(case)) for _, case, _ in judged(name)]
        met |= {pair for one in found for pair in itertools.permutations(one, 2)}
        assert len(set().union(*found)) == (11 if objective.measure == "power" else 12), name
        impossible = np.mean([verdict.best is None for _, _, verdict in judged(name)])
        assert 0.1 < impossible < 0.6, name
    names, links = {name for pair in met for name in pair}, {"shannon", "practical", "capped", "gap"}
    assert set(itertools.permutations(names, 2)) - set(itertools.permutations(links, 2)) == met


@pytest.mark.parametrize("method", wa.plugins.names("method"))
@every_objective
def test_no_decision_is_refuted(objective: str, method: str) -> None:
    found = [
        (seed, fault)
        for seed, case, verdict, decision in decisions(objective, method)
        for fault in faults(decision, case.estimate, verdict)
    ]
    assert not found, "\n".join(f"random_problem({seed}, {objective}): {fault}" for seed, fault in found[:10])


@needs_dual
@every_objective
def test_dual_finds_the_best_in_the_median(objective: str) -> None:
    away: defaultdict[str, list[float]] = defaultdict(list)
    missed: defaultdict[str, int] = defaultdict(int)
    for _, case, verdict, decision in decisions(objective, "dual"):
        for name in features(case):
            if verdict.best is not None and decision.is_usable:
                away[name].append(shortfall(decision, verdict))
            elif verdict.best is not None:
                missed[name] += 1
    print(f"\n{objective}: distance from the best by exhaustive search")  # noqa: T201
    for name, values in away.items():
        middle, high, higher, most = np.quantile(values, [0.5, 0.9, 0.99, 1.0])
        print(  # noqa: T201
            f"  {name:26s} {len(values):4d} decided, {missed[name]:2d} missed; "
            f"median {middle:.1e}, 90 % {high:.1e}, 99 % {higher:.1e}, most {most:.1e}"
        )
    for name, values in away.items():
        assert np.median(values) <= SAME, name
    assert missed["all"] <= 0.05 * len(away["all"])


@needs_dual
@pytest.mark.parametrize("link", ["shannon", "nr"])
@pytest.mark.parametrize(
    ("objective", "min_rate_bps"),
    [
        ("min_power", 2e5),
        ("max_rate", 2e5),
        ("max_energy_efficiency", 2e5),
        ("proportional_fairness", None),
        ("max_min_rate", None),
    ],
)
def test_three_users_on_six_subcarriers(objective: str, min_rate_bps: float | None, link: str) -> None:
    """The channels of the reference figures: users in 35–300 m, 300 ns rms delay spread."""
    cell = wa.Cell() if link == "shannon" else wa.Cell.nr()
    problem = wa.Problem(wa.plugins.objective(objective), min_rate_bps=min_rate_bps)
    away: list[float] = []
    for seed in range(30):
        scene = wa.simulate("rayleigh", cell, num_users=3, num_subcarriers=6, rms_delay_spread_s=300e-9, seed=seed)
        estimate = wa.perfect(scene)
        verdict = verdict_on(estimate, problem, cell)
        decision = wa.decide(estimate, problem, cell, "dual")
        assert not faults(decision, estimate, verdict), seed
        if verdict.best is not None:
            away.append(shortfall(decision, verdict) if decision.is_usable else np.inf)
    print(f"\n{objective}, {link}: median {np.median(away):.1e}, most {np.max(away):.1e} of {len(away)}")  # noqa: T201
    assert len(away) >= 20
    assert np.median(away) <= SAME

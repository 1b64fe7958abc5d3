"""The bar of ``exact``, measured: ``python benchmarks/bars_exact.py [--problems 739]``.

Tiny random problems (two to four users, three to eight subcarriers; every objective, with and without promised rates,
caps, groups, weights and forbidden pairs). Each must be proven optimal or infeasible, or say why it is not; no decision
may be worse than that of ``dual`` with ``effort="thorough"``; and a bound that the other's value beats is wrong.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Sequence

import numpy as np
from measuring import table

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.deciding.methods.exact import Exact
from wirelessagent.model.decision import Decision
from wirelessagent.testing.judge import faults
from wirelessagent.testing.random_problems import tiny_problem

OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")
WORSE = 1e-12
"""Relative, from which on a value is worse than another and not the same."""


def worse_by(decision: Decision, other: Decision, sign: float) -> float:
    """How much worse a value is than another's, relative to it; infinite where only the other is usable."""
    if not other.is_usable:
        return 0.0
    if not decision.is_usable:
        return np.inf
    if decision.value == other.value:
        return 0.0
    return sign * (other.value - decision.value) / abs(other.value)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=int, default=739, help="how many (739)")
    chosen = parser.parse_args(arguments)
    begun, told = time.process_time(), list[list[str]]()
    counts: dict[str, Counter[str]] = {name: Counter() for name in OBJECTIVES}
    objectives = tuple(plugins.objective(name) for name in OBJECTIVES)
    for number in range(chosen.problems):
        case = tiny_problem(number, objectives)
        exact, thorough = (
            wa.decide(case.estimate, case.problem, case.cell, method) for method in (Exact(), Dual(effort="thorough"))
        )
        name = OBJECTIVES[number % len(OBJECTIVES)]
        sign = 1.0 if objectives[number % len(OBJECTIVES)].direction == "max" else -1.0
        worse, found = worse_by(exact, thorough, sign), faults(exact, case.estimate)
        beaten = thorough.is_usable and sign * (thorough.value - exact.bound) > WORSE * abs(exact.bound)
        counts[name].update([exact.status])
        counts[name].update(worse=worse > WORSE, beaten=beaten, faulty=bool(found))
        if exact.status not in ("optimal", "infeasible") or worse > WORSE or beaten or found:
            told.append([str(number), name, exact.status, f"{exact.gap:.1e}", f"{worse:.1e}", exact.reason, *found[:1]])
    header = ("objective", "optimal", "infeasible", "feasible", "undecided", "worse", "beaten", "faulty")
    rows = [[name, *(str(counts[name][column]) for column in header[1:])] for name in OBJECTIVES]
    title = f"exact on {chosen.problems} tiny problems, beside thorough, {time.process_time() - begun:.0f} s of CPU"
    table(title, header, rows)
    for line in told:
        print("  " + "; ".join(line))


if __name__ == "__main__":
    main()

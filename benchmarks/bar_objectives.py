"""Bar 4: rates promised beside a sum rate or an efficiency, and the fair objectives, on both links."""

from __future__ import annotations

import numpy as np
from channels import LINKS, draws
from measuring import Tally, contenders, proven, table, worse_by

from wirelessagent import chain
from wirelessagent.model.problem import Problem

QOS_BPS = 0.5e6
PROBLEMS: dict[str, Problem] = {
    f"max rate, {QOS_BPS / 1e6:g} Mbit/s each": Problem("max_rate", min_rate_bps=QOS_BPS),
    f"max efficiency, {QOS_BPS / 1e6:g} Mbit/s each": Problem("max_energy_efficiency", min_rate_bps=QOS_BPS),
    "proportional fairness": Problem("proportional_fairness"),
    "max-min rate": Problem("max_min_rate"),
}
HEADER = ("objective", "method", "link", "usable", "infeasible", "to optimum: median", "max",
          "certified: median", "max", "time: median", "max")  # fmt: skip
FULL_LINE = ("greedy", "dual fast", "dual thorough", "exact")


def small(count: int) -> None:
    """Against the true optimum at 8×20 and 20 W."""
    rows: list[list[str]] = []
    for case, problem in PROBLEMS.items():
        for link, cell in LINKS.items():
            tallies = {label: Tally() for label in contenders(*FULL_LINE)}
            for estimate in draws(8, 20, count):
                optimum = np.nan
                for label, (method, options) in reversed(contenders(*FULL_LINE).items()):
                    decision = tallies[label].ask(estimate, problem, cell, method, optimum=optimum, **options)
                    optimum = proven(decision) if label == "exact" else optimum
            rows += [_row(case, link, label, tally) for label, tally in tallies.items()]
    table(f"Bar 4. 8×20 at 20 W, {count} draws", HEADER, rows)


def large(count: int) -> None:
    """Certified gaps at 64×273 and 20 W."""
    rows: list[list[str]] = []
    for case, problem in PROBLEMS.items():
        for link, cell in LINKS.items():
            for label, (method, options) in contenders(*FULL_LINE[:-1]).items():
                tally = Tally()
                for estimate in draws(64, 273, count):
                    tally.ask(estimate, problem, cell, method, **options)
                rows.append(_row(case, link, label, tally))
    table(f"Bar 4. 64×273 at 20 W, {count} draws", HEADER, rows)


def tiny(count: int) -> None:
    """Against exhaustive search at 3×6 and 20 W."""
    from wirelessagent.testing.exhaustive import best_allocation

    rows: list[list[str]] = []
    chosen = contenders("greedy", "dual fast", "dual thorough", "exact")
    for case, problem in {**PROBLEMS, "min power, 0.5 Mbit/s each": Problem("min_power", min_rate_bps=QOS_BPS)}.items():
        for link, cell in LINKS.items():
            tallies = {label: Tally() for label in chosen}
            wrong = dict.fromkeys(chosen, 0)
            for estimate in draws(3, 6, count):
                best = best_allocation(estimate, chain.resolve(problem), cell)
                for label, (method, options) in chosen.items():
                    optimum = np.nan if best is None else best.value
                    decision = tallies[label].ask(estimate, problem, cell, method, optimum=optimum, **options)
                    if decision is None:
                        continue
                    lying = decision.is_usable if best is None else decision.status == "infeasible"
                    beaten = best is not None and worse_by(best.value, decision.bound, decision) < -1e-9
                    wrong[label] += lying or beaten
            rows += [[*_row(case, link, label, tally), str(wrong[label])] for label, tally in tallies.items()]
    table(f"Bar 4. 3×6 at 20 W against exhaustive search, {count} draws", (*HEADER, "untrue claims"), rows)


def _row(case: str, link: str, label: str, tally: Tally) -> list[str]:
    shares = [tally.share("optimal", "feasible"), tally.share("infeasible")]
    figures = tally.figures(is_exact=label == "exact" and not tally.distance_known)
    return [case, label, link, *shares, *figures] if tally.statuses else [case, label, link, "refused"] + [""] * 7

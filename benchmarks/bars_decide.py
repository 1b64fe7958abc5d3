"""The bars of Decide, measured: ``python benchmarks/bars_decide.py [--draws 30] [--only p2-small,closed]``.

One table per bar, with medians and maxima over fresh channels, rates and budgets stated, and peers in the same run.
Times are those of a Python caller who has an estimate at hand: ``wa.decide`` from call to decision, the median of
several calls on each draw. Distances to the optimum are to the true one, by the method ``exact`` where it has proven
it (at 8×20) or by exhaustive search (at 3×6); "certified" is the decision's own gap. cvxpy is optional: without it the
peers are left out (``uv sync --group bench`` brings it).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence

import bar_batches
import bar_bounds
import bar_closed
import bar_objectives
import bar_power
from channels import LINKS, draws
from measuring import Tally, contenders

from wirelessagent.model.problem import Problem

SECTIONS: dict[str, Callable[[int], None]] = {
    "p2-small": bar_power.small,
    "p2-budget": bar_power.budget,
    "p2-large": bar_power.large,
    "p2-warm": bar_power.warm,
    "p2-huge": bar_power.huge,
    "closed": bar_closed.closed,
    "objectives-tiny": bar_objectives.tiny,
    "objectives-small": bar_objectives.small,
    "objectives-large": bar_objectives.large,
    "bounds": bar_bounds.bounds,
    "milp": bar_bounds.milp,
    "batches": bar_batches.batches,
}
NEED_CVXPY = ("bounds", "milp")


def warm_up() -> None:
    """Compile every kernel, on both links, before anything is timed."""
    for estimate in draws(8, 20, 1):
        for problem in (Problem("min_power", min_rate_bps=0.5e6), *bar_objectives.PROBLEMS.values()):
            for method, options in contenders().values():
                for cell in LINKS.values():
                    Tally().ask(estimate, problem, cell, method, timed=False, **options)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=30, help="channels per case (30)")
    parser.add_argument("--only", default=",".join(SECTIONS), help="sections, separated by commas: %(default)s")
    chosen = parser.parse_args(arguments)
    names = chosen.only.split(",")
    if unknown := set(names) - SECTIONS.keys():
        parser.error(f"no such section: {', '.join(sorted(unknown))}; there are {', '.join(SECTIONS)}")
    warm_up()
    for name in names:
        start = time.perf_counter()
        try:
            SECTIONS[name](chosen.draws)
        except ModuleNotFoundError as error:
            if name not in NEED_CVXPY:
                raise
            print(f"\n{name}: left out, {error}")
        print(f"  [{name}: {time.perf_counter() - start:.0f} s]", flush=True)


if __name__ == "__main__":
    main()

"""What a decision trades: its best value at other budgets, or the least power for other promises.

The problem stays as it was decided but for one figure. Where power is what is minimised, that figure is the size of all
promised rates together, as a factor; else it is the power budget, up to the cell's limit.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import TYPE_CHECKING, cast

import numpy as np

from wirelessagent.model.errors import NothingRecordedError
from wirelessagent.operations.hosted_answers import TradeOffAnswer, TradeOffPoint
from wirelessagent.operations.operation import Event, Progress

if TYPE_CHECKING:
    from wirelessagent.agent.turn import Run
    from wirelessagent.model.objective import Objective
    from wirelessagent.model.problem import Problem

_STEPS = 8
"""Points of a curve, beside the decision itself."""

_MOST_PROMISED = 1.6
"""How far a curve over promises goes, as a factor of what is promised."""


def trade_off(run: Run | None, progress: Progress) -> TradeOffAnswer:
    """The curve that the decision of a run lies on.

    Raises:
        NothingRecordedError: nothing was decided.
    """
    from wirelessagent import chain

    if run is None:
        raise NothingRecordedError("this turn decided nothing, so there is no trade-off to show")
    problem, cell, tools = run.decision.problem, run.decision.cell, run.tools
    objective = cast("Objective", problem.objective)
    least = objective.direction == "min"
    here = 1.0 if least else problem.budget_w(cell)
    points = list[TradeOffPoint]()
    varied = list(_promises(problem) if least else _budgets(problem, here, cell.max_power_w))
    for done, (at, other) in enumerate(varied):
        progress(Event(stage="decide", message=objective.name, done=done + 1, total=len(varied)))
        found = chain.decide(run.estimate, other, cell, tools.method, **tools.method_options)
        served = found.rate_bps[found.served]
        points.append(
            TradeOffPoint(
                at=at, status=found.status, value=found.value, bound=found.bound, total_power_w=found.total_power_w,
                total_rate_bps=float(found.rate_bps.sum()), lowest_rate_bps=float(served.min()),
            )
        )  # fmt: skip
    varies = "promises" if least else "max_power_w"
    return TradeOffAnswer(
        varies=varies, here=here, objective=objective.name, unit=run.decision.unit, points=points
    )  # fmt: skip


def _promises(problem: Problem) -> Iterator[tuple[float, Problem]]:
    for factor in np.linspace(0.0, _MOST_PROMISED, _STEPS + 1)[1:].round(12).tolist():
        promised = np.multiply(factor, 0.0 if problem.min_rate_bps is None else problem.min_rate_bps)
        yield factor, dataclasses.replace(problem, min_rate_bps=promised)


def _budgets(problem: Problem, here: float, most: float) -> Iterator[tuple[float, Problem]]:
    for budget in sorted({here, *np.linspace(0.0, most, _STEPS + 1)[1:].tolist()}):
        yield budget, dataclasses.replace(problem, max_power_w=budget)

"""compare: several methods on one problem, side by side."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.operations.answers import DecisionAnswer
from wirelessagent.operations.fields import Names, OptionsOf, PluginOptions
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.outputs import check_picture, draw_comparison
from wirelessagent.operations.record import Block, Conclusion, Files, Record, Table, of_decision
from wirelessagent.operations.solve import ProblemOnFile

if TYPE_CHECKING:
    from wirelessagent.comparison import Compared


class CompareRequest(ProblemOnFile):
    methods: Names | None = Field(
        None, description="methods, as dual,exact or one by one; all that solve the problem if not given"
    )
    method_options: Annotated[PluginOptions, OptionsOf("method")] = Field(
        default_factory=dict, description="options of the methods; each goes to every method that has it"
    )
    plot: Path | None = Field(None, description="picture of the comparison: PNG, SVG or PDF")


class MethodAnswer(Record):
    """One method's decision, or why it has none, and the time it took."""

    method: str
    refusal: str
    time_s: float
    decision: DecisionAnswer | None


class CompareRecord(Record):
    """The methods' answers to one problem."""

    objective: str
    facts: dict[str, str]
    answers: list[MethodAnswer]
    plot: Path | None

    @property
    def conclusion(self) -> Conclusion:
        """Done where a method has an allocation; unmet where some tried and none has; unclear where all refused."""
        tried = [of_decision(answer.decision.status) for answer in self.answers if answer.decision is not None]
        return "unclear" if not tried else "done" if "done" in tried else "unmet"

    def blocks(self) -> list[Block]:
        rows = tuple(_row(answer) for answer in self.answers)
        columns = ("method", "status", "value", "bound", "gap", "power", "time")
        usable = any(_is_usable(answer.decision) for answer in self.answers)
        title = f"Methods for {self.objective}{', the best first' if usable else ': none has an allocation'}"
        table = Table(title=title, columns=columns, rows=rows)
        refusals = [f"{answer.method}: {answer.refusal}" for answer in self.answers if answer.refusal]
        return [table, *self._why(), *refusals, *([Files("written to", (self.plot,))] if self.plot else [])]

    def _why(self) -> list[str]:
        """Why there is no allocation, in the words of the first method that has none, if no method has one."""
        decisions = [answer.decision for answer in self.answers if answer.decision is not None]
        reasons = [decision.reason for decision in decisions if decision.reason]
        usable = any(map(_is_usable, decisions))
        return [] if usable or not reasons else [f"{decisions[0].status}: {reasons[0]}"]


def _is_usable(decision: DecisionAnswer | None) -> bool:
    return decision is not None and of_decision(decision.status) == "done"


def _row(answer: MethodAnswer) -> tuple[str, ...]:
    from wirelessagent.model.units import human, percent

    decision = answer.decision
    if decision is None:
        return (answer.method, "refused", *["–"] * 5)
    return (
        answer.method,
        decision.status,
        human(decision.value, decision.unit),
        human(decision.bound, decision.unit),
        percent(decision.gap),
        human(decision.total_power_w, "W"),
        human(answer.time_s, "s"),
    )


def _place(one: Compared) -> tuple[int, float, float, float]:
    """Where a method stands: the best value first, of equal ones what proves the most, then the fastest; then those
    without an allocation, then those that refuse.
    """
    from wirelessagent.model.objective import Objective

    decision = one.decision
    if decision is None:
        return 3, 0.0, 0.0, 0.0
    if not decision.is_usable:
        return (1 if decision.status == "infeasible" else 2), 0.0, 0.0, one.time_s
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    value = float(f"{decision.value:.9e}")  # what differs by rounding is equal
    gap = 0.0 if decision.status == "optimal" else math.inf if math.isnan(decision.gap) else decision.gap
    return 0, value if objective.direction == "min" else -value, gap, one.time_s


def run(request: CompareRequest, progress: Progress) -> CompareRecord:
    from wirelessagent.comparison import compare

    check_picture(request.plot)
    scene, estimate, problem = request.posed(progress)
    found = sorted(compare(estimate, problem, scene.cell, request.methods, **request.method_options), key=_place)
    if not found:
        raise UnsupportedProblemError(f"no registered method solves {request.objective!r} with these constraints")
    answers = [
        MethodAnswer(
            method=one.method,
            refusal=one.refusal,
            time_s=one.time_s,
            decision=None if one.decision is None else DecisionAnswer.of(one.decision),
        )
        for one in found
    ]
    if request.plot is not None:
        draw_comparison(request.plot, found)
    return CompareRecord(objective=request.objective, facts=dict(scene.facts), answers=answers, plot=request.plot)


COMPARE = Operation(
    name="compare",
    request=CompareRequest,
    record=CompareRecord,
    run=run,
    examples=(
        "compare gains.csv --objective max_energy_efficiency --plot compared.png",
        "compare repaired.npz --objective PF --methods dual,greedy",
    ),
)

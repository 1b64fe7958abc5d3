"""compare: several methods on one problem, side by side."""

from __future__ import annotations

from pydantic import Field

from wirelessagent import chain
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.model.units import human
from wirelessagent.operations.answers import DecisionAnswer, percent
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.record import Block, Record, Table
from wirelessagent.operations.solve import ProblemOnFile


class CompareRequest(ProblemOnFile):
    methods: list[str] | None = Field(None, description="methods; all that solve the problem if not given")


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

    def blocks(self) -> list[Block]:
        rows = tuple(_row(answer) for answer in self.answers)
        columns = ("method", "status", "value", "bound", "gap", "power", "time")
        return [Table(title=f"Methods for {self.objective}", columns=columns, rows=rows)]


def _row(answer: MethodAnswer) -> tuple[str, ...]:
    decision = answer.decision
    if decision is None:
        return (answer.method, answer.refusal, *["–"] * 5)
    return (
        answer.method,
        decision.status,
        human(decision.value, decision.unit),
        human(decision.bound, decision.unit),
        percent(decision.gap),
        human(decision.total_power_w, "W"),
        human(answer.time_s, "s"),
    )


def run(request: CompareRequest, progress: Progress) -> CompareRecord:
    scene, estimate, problem = request.posed(progress)
    found = chain.compare(estimate, problem, scene.cell, request.methods)
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
    return CompareRecord(objective=request.objective, facts=dict(scene.facts), answers=answers)


COMPARE = Operation(
    name="compare",
    summary="Show several methods on one problem side by side: value, bound, gap, time",
    request=CompareRequest,
    record=CompareRecord,
    run=run,
)

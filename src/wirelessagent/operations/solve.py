"""solve: decide on a gain matrix from a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import Field

from wirelessagent.operations.answers import DecisionAnswer, ReportAnswer
from wirelessagent.operations.channel_file import ChannelFile
from wirelessagent.operations.operation import Event, Operation, Progress
from wirelessagent.operations.outputs import check_allocation, check_picture, draw_run
from wirelessagent.operations.problem_options import ProblemOptions
from wirelessagent.operations.record import Block, Conclusion, Files, Table, of_decision
from wirelessagent.operations.tool_options import MethodOptions, RepairerOptions

if TYPE_CHECKING:
    from wirelessagent.model.estimate import ChannelEstimate
    from wirelessagent.model.problem import Problem
    from wirelessagent.model.scene import Scene


class ProblemOnFile(ProblemOptions, RepairerOptions, ChannelFile):
    """A problem on a channel in a file, repaired where it has holes."""

    panel = "Options"

    def posed(self, progress: Progress) -> tuple[Scene, ChannelEstimate, Problem]:
        """The scene, its estimate and the problem on it."""
        from wirelessagent import chain

        scene = self.scene(progress, wanted_power_w=self.max_power_w)
        problem = self.problem(scene.sensed.user_names, scene.sensed.num_subcarriers)
        estimate = chain.repair(scene.sensed, self.repairer, **self.repairer_options)
        if estimate.repaired.any():
            progress(
                Event(stage="repair", message=f"gains filled by {estimate.method}: {int(estimate.repaired.sum())}")
            )
        return scene, estimate, problem


class SolveRequest(MethodOptions, ProblemOnFile):
    out: Path | None = Field(None, description="file to write the allocation to: JSON, CSV or NPZ")
    plot: Path | None = Field(None, description="picture of the allocation: PNG, SVG or PDF")


class SolveRecord(DecisionAnswer):
    """The decision, its predicted figures and an explanation."""

    facts: dict[str, str]
    repaired: int
    report: ReportAnswer
    explanation: list[str]
    out: Path | None
    plot: Path | None
    summary: str = Field(exclude=True)
    tables: list[Table] = Field(exclude=True)

    @property
    def conclusion(self) -> Conclusion:
        return of_decision(self.status)

    def blocks(self) -> list[Block]:
        said: list[Block] = [self.summary, *self.tables, " ".join(self.explanation)]
        return [*said, *(Files("written to", (path,)) for path in (self.out, self.plot) if path)]


def run(request: SolveRequest, progress: Progress) -> SolveRecord:
    from wirelessagent import chain
    from wirelessagent.acting.file import FileBaseStation
    from wirelessagent.telling.explanation import explain, summary_line
    from wirelessagent.telling.report import decision_tables, report

    check_allocation(request.out)
    check_picture(request.plot)
    scene, estimate, problem = request.posed(progress)
    decision = chain.decide(estimate, problem, scene.cell, request.method, **request.method_options)
    if request.out is not None:
        FileBaseStation(scene, path=request.out).apply(decision)
    if request.plot is not None:
        draw_run(request.plot, scene.sensed, estimate, decision)
    made = report(decision)
    return SolveRecord(
        **DecisionAnswer.fields_of(decision),
        facts=dict(scene.facts),
        repaired=int(estimate.repaired.sum()),
        report=ReportAnswer.of(made),
        explanation=explain(estimate, made),
        out=request.out,
        plot=request.plot,
        summary=summary_line(decision),
        tables=decision_tables(made, estimate),
    )


SOLVE = Operation(
    name="solve",
    request=SolveRequest,
    record=SolveRecord,
    run=run,
    examples=(
        "solve gains.csv --objective min_power --min-rate-bps 500e3 --out allocation.json",
        "solve repaired.npz --objective PF --users 'user 1,user 3' --max-power-w 10",
    ),
)

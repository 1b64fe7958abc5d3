"""ask: the whole chain as an operation, on a simulated cell or on a channel from a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from wirelessagent import __version__
from wirelessagent.model.errors import WirelessAgentError
from wirelessagent.operations.answers import DecisionAnswer, EstimateAnswer, ReportAnswer
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.intent import IntentRecord
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.outputs import check_allocation, check_picture, draw_run
from wirelessagent.operations.record import Block, Conclusion, Files, Matrix, Record, Table, of_decision
from wirelessagent.operations.recording import RecordingOptions
from wirelessagent.operations.site_options import SiteOptions
from wirelessagent.operations.turn_record import LinesAnswer, OutcomeAnswer
from wirelessagent.telling.catalogue import message

if TYPE_CHECKING:
    from wirelessagent.agent.turn import Run, Turn


class AskRequest(RecordingOptions, SiteOptions):
    panel = "Options"

    text: Annotated[str, Positional()] = Field(description="what the cell should do, in English or Chinese")
    full: bool = Field(False, description="show everything: all tables, what was assumed, and why")
    out: Path | None = Field(None, description="file to write the allocation to: JSON, CSV or NPZ")
    plot: Path | None = Field(None, description="picture of the run: PNG, SVG or PDF")


class AskRecord(Record):
    """The whole record of a run; everything from ``facts`` on is null where a question was asked back."""

    intent: IntentRecord
    reply: str
    lines: LinesAnswer
    stage: str
    facts: dict[str, str] | None = None
    observed_gain: Matrix | None = None
    estimate: EstimateAnswer | None = None
    decision: DecisionAnswer | None = None
    outcome: OutcomeAnswer | None = None
    report: ReportAnswer | None = None
    notes: list[str] = Field(default_factory=list)
    explanation: list[str] = Field(default_factory=list)
    seed: int
    version: str
    stored: int | None = None
    out: Path | None = None
    plot: Path | None = None
    waits: bool = Field(False, description="whether nothing was applied yet, for want of a yes")
    served: Table | None = Field(default=None, exclude=True)
    tables: list[Table] = Field(default_factory=list[Table], exclude=True)
    full: bool = Field(default=False, exclude=True)
    faulty: bool = Field(False, description="whether what is in effect is not as it was decided or promised")

    @property
    def conclusion(self) -> Conclusion:
        if self.decision is None or self.waits:
            return "unclear"
        return "failed" if self.faulty or self.stage == "reverted" else of_decision(self.decision.status)

    def blocks(self) -> list[Block]:
        said: list[Block] = [self.lines.said]
        language = self.intent.language
        if self.full:
            notes = (message(language, "text.note", note=note) for note in self.notes)
            said += [*self.tables, *notes, tuple(self.explanation)]
        elif self.served is not None:
            said.append(self.served)
        if self.waits:
            said.append(message(language, "written.yes"))
        files = (("allocation", self.out), ("picture", self.plot))
        return [*said, *(Files(message(language, f"written.{what}"), (path,)) for what, path in files if path)]


def run(request: AskRequest, progress: Progress) -> AskRecord:
    check_allocation(request.out)
    check_picture(request.plot)
    session = request.session(progress, raises=True)
    turn, stored = request.said(session, request.text)
    record = AskRecord(
        intent=IntentRecord.of(request.text, turn.intent),
        reply=turn.reply,
        lines=LinesAnswer.of(turn.lines),
        stage=turn.stage,
        seed=request.seed,
        version=__version__,
        stored=stored,
        faulty=turn.faulty,
        waits=session.state.awaits == "confirmation",
    )
    return record if turn.run is None else _with_run(record, request, turn, turn.run)


def _with_run(record: AskRecord, request: AskRequest, turn: Turn, run: Run) -> AskRecord:
    """The record with what was decided and done, written and drawn where that was asked for."""
    from wirelessagent.telling.report import served_table

    if run.decision.is_usable and turn.stage == "nothing":  # the base station failed, which the reply says
        raise WirelessAgentError(turn.reply)
    out = request.out if run.decision.is_usable else None
    if out is not None:
        from wirelessagent.acting.file import FileBaseStation

        FileBaseStation(run.scene, path=out).apply(run.decision)
    if request.plot is not None:
        draw_run(request.plot, run.observation, run.estimate, run.decision, run.outcome)
    found = {
        "facts": dict(run.scene.facts),
        "observed_gain": run.observation.current.tolist(),
        "estimate": EstimateAnswer.of(run.estimate),
        "decision": DecisionAnswer.of(run.decision),
        "outcome": OutcomeAnswer.of(run.outcome),
        "report": ReportAnswer.of(run.report),
        "notes": list(run.notes),
        "explanation": list(run.explanation),
        "out": out,
        "plot": request.plot,
        "served": (served_table(run.report, turn.intent.language) if run.decision.is_usable else turn.tables[0]),
        "tables": list(turn.tables),
        "full": request.full,
    }
    return record.model_copy(update=found)


ASK = Operation(
    name="ask",
    request=AskRequest,
    record=AskRecord,
    run=run,
    recorded=True,
    examples=(
        'ask "Higher speed for video streaming"',
        'ask "At least 1 Mbit/s each, at most 10 W" --num-users 6',
        'ask "能效最高" --csi gains.csv --unit db --plot run.png',
    ),
)

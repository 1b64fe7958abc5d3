"""ask: the whole chain as an operation, on a simulated cell or on a channel from a file."""

from __future__ import annotations

import dataclasses
import uuid
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from pydantic import Field

from wirelessagent import __version__, chain
from wirelessagent.acting.file import FileBaseStation
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.explain.tables import decision_tables
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import recognise
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene
from wirelessagent.operations.answers import DecisionAnswer, EstimateAnswer, ReportAnswer
from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.chain_run import Answer, Tools, act_on
from wirelessagent.operations.channel_file import file_scene
from wirelessagent.operations.fields import OptionsOf, PluginName, PluginOptions, Positional
from wirelessagent.operations.intent import IntentRecord
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.outputs import check_allocation, check_picture, draw_run
from wirelessagent.operations.record import Block, Matrix, Record, Table
from wirelessagent.operations.recording import RecordingOptions
from wirelessagent.operations.simulate import LOSS_USAGE
from wirelessagent.operations.tool_options import MethodOptions, RepairerOptions
from wirelessagent.sensing.loss import parse as parse_loss


class AskRequest(RecordingOptions, MethodOptions, RepairerOptions, CellOptions):
    panel = "Options"

    text: Annotated[str, Positional()] = Field(description="what the cell should do, in English or Chinese")
    csi: Path | None = Field(None, description="gain matrix to work on; a simulated cell if not given")
    source: Annotated[str, PluginName("channel_source")] = Field("rayleigh", description="channel source without --csi")
    source_options: Annotated[PluginOptions, OptionsOf("channel_source", but=("path",))] = Field(
        default_factory=dict, description="options of the channel source; with --csi, how to read the file"
    )
    loss: list[str] | None = Field(
        None,
        description=f"what gets lost, several joined by +: {LOSS_USAGE}; "
        "random:0.2 for a simulated cell and nothing for a file if not given",
    )
    base_station: Annotated[str | None, PluginName("base_station")] = Field(
        None, description="base station; simulated where the true channel is known"
    )
    base_station_options: Annotated[PluginOptions, OptionsOf("base_station")] = Field(
        default_factory=dict, description="options of the base station"
    )
    seed: int = Field(1, description="seed of every draw")
    out: Path | None = Field(None, description="file to write the allocation to: JSON, CSV or NPZ")
    plot: Path | None = Field(None, description="picture of the run: PNG, SVG or PDF")


class OutcomeAnswer(Record):
    """What the base station did, read back."""

    base_station: str
    written_to: Path | None


class AskRecord(Record):
    """The whole record of a run; everything after ``intent`` is null where a question was asked back."""

    intent: IntentRecord
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
    tables: list[Table] = Field(default_factory=list[Table], exclude=True)

    @property
    def needs_answer(self) -> bool:
        return self.decision is None

    def blocks(self) -> list[Block]:
        if self.decision is None:
            return [self.intent.reply]
        said: list[Block] = [*self.tables, *(f"Note: {note}" for note in self.notes), "\n".join(self.explanation)]
        if self.out is not None:
            said.append(f"allocation written to {self.out}")
        return [*said, f"picture written to {self.plot}"] if self.plot else said


def run(request: AskRequest, progress: Progress) -> AskRecord:
    check_allocation(request.out)
    check_picture(request.plot)
    intent = recognise(request.text)
    understood = IntentRecord.of(request.text, intent)
    if intent.kind != "allocate" or intent.objective is None:
        stored = request.remember(_turn(request, intent, None))
        return AskRecord(intent=understood, seed=request.seed, version=__version__, stored=stored)
    scene = _scene(request, progress)
    default_loss = [] if request.csi else ["random:0.2"]
    losses = [parse_loss(text) for text in (default_loss if request.loss is None else request.loss)]
    tools = Tools(**{item.name: getattr(request, item.name) for item in dataclasses.fields(Tools)})
    answer = act_on(intent, scene, *losses, seed=request.seed, tools=tools, progress=progress)
    out = request.out if answer.decision.is_usable else None
    if out is not None:
        FileBaseStation(answer.scene, path=out).apply(answer.decision)
    if request.plot is not None:
        draw_run(request.plot, answer.observation, answer.estimate, answer.decision, answer.outcome)
    return AskRecord(
        intent=understood,
        facts=dict(scene.facts),
        observed_gain=answer.observation.current,  # pyright: ignore[reportArgumentType]  # the validator takes arrays
        estimate=EstimateAnswer.of(answer.estimate),
        decision=DecisionAnswer.of(answer.decision),
        outcome=_outcome(answer.outcome),
        report=ReportAnswer.of(answer.report),
        notes=list(answer.notes),
        explanation=list(answer.explanation),
        seed=request.seed,
        version=__version__,
        stored=request.remember(_turn(request, intent, answer)),
        out=out,
        plot=request.plot,
        tables=decision_tables(answer.report, answer.estimate, intent.language),
    )


def _turn(request: AskRequest, intent: Intent, answer: Answer | None) -> Turn:
    """A conversation of one turn, for the record."""
    usable = answer is not None and answer.decision.is_usable
    done = "nothing" if not usable else "planned" if answer.outcome is None else "applied"
    return Turn(
        number=1, session=uuid.uuid4().hex[:12], text=request.text, intent=intent, reply=intent.reply,
        stage="asked" if answer is None else done, run=None if answer is None else Run(**vars(answer)),
        at_utc=datetime.now(UTC).isoformat(timespec="milliseconds"), version=__version__, seed=request.seed,
        recogniser=intent.recogniser,
    )  # fmt: skip


def _scene(request: AskRequest, progress: Progress) -> Scene:
    if request.csi is not None:
        return file_scene(request, request.csi, request.source_options, progress)
    return chain.simulate(request.source, request.cell(), seed=request.seed, **request.source_options)


def _outcome(outcome: Outcome | None) -> OutcomeAnswer | None:
    if outcome is None:
        return None
    return OutcomeAnswer(base_station=outcome.base_station, written_to=outcome.written_to)


ASK = Operation(
    name="ask",
    summary="Say what the cell should do: understand, sense, repair, decide, act, read back, explain",
    request=AskRequest,
    record=AskRecord,
    run=run,
)

"""ask: the whole chain from a sentence. Understand, sense, repair, decide, act, read back, explain."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, cast

import numpy as np
from pydantic import Field

from wirelessagent import __version__, chain, plugins
from wirelessagent.acting.base_station import BaseStation
from wirelessagent.acting.file import FileBaseStation
from wirelessagent.explain.report import Report, report
from wirelessagent.explain.words import explain
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import recognise
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnclearRequestError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.model.units import human
from wirelessagent.operations.answers import (
    DecisionAnswer,
    EstimateAnswer,
    ReportAnswer,
    certificate_line,
    report_table,
    user_table,
)
from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.channel_file import file_scene
from wirelessagent.operations.fields import OptionsOf, PluginName, PluginOptions, Positional
from wirelessagent.operations.intent import IntentRecord
from wirelessagent.operations.operation import Event, Operation, Progress, silent
from wirelessagent.operations.outputs import check_allocation, check_picture
from wirelessagent.operations.record import Block, Matrix, Record, Table
from wirelessagent.operations.simulate import LOSS_USAGE, describe
from wirelessagent.operations.solve import figures_of_infeasibility
from wirelessagent.sensing.loss import parse as parse_loss

ASSUMED_MIN_RATE_BPS = 200e3
"""Rate promised to each user where the least power is asked for and no rate was named."""


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What came of a sentence: every stage's result, the notes made on the way and the explanation."""

    intent: Intent
    scene: Scene
    observation: ChannelObservation
    estimate: ChannelEstimate
    decision: Decision
    outcome: Outcome | None
    report: Report
    notes: tuple[str, ...]
    explanation: tuple[str, ...]

    def __str__(self) -> str:
        return "\n".join([certificate_line(self.decision), *self.notes, *self.explanation, str(self.report)])


@dataclass(frozen=True, kw_only=True)
class Tools:
    """The plug-ins that a run of the chain uses, by name, and their options."""

    repairer: str = chain.DEFAULT_REPAIRER
    repairer_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    method: str | None = None
    method_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    base_station: str | None = None
    base_station_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])


def ask(
    text: str,
    scene: Scene,
    *losses: Loss,
    seed: int = 0,
    tools: Tools | None = None,
    progress: Progress = silent,
) -> Answer:
    """Run the chain on a scene as a sentence asks, with what ``losses`` leave of the channel.

    Raises:
        UnclearRequestError: the sentence is not clear; the message is the question to the operator.
    """
    intent = recognise(text)
    if intent.kind != "allocate" or intent.objective is None:
        raise UnclearRequestError(intent.reply)
    progress(Event(stage="understand", message=f"{intent.reply} ({intent.recogniser}, {intent.confidence:.0%} sure)"))
    return act_on(intent, scene, *losses, seed=seed, tools=tools or Tools(), progress=progress)


def act_on(intent: Intent, scene: Scene, *losses: Loss, seed: int, tools: Tools, progress: Progress = silent) -> Answer:
    """Run the chain from sensing to explaining for an intent that is clear."""
    problem, cell, notes = _pose(intent, scene.cell)
    scene = dataclasses.replace(scene, cell=cell)
    seen = scene.observe(*losses, seed=seed)
    progress(Event(stage="sense", message=describe(seen)))
    estimate = chain.repair(seen, tools.repairer, **tools.repairer_options)
    missing = int(seen.missing.sum())
    repaired = f"{missing} gains filled by {estimate.method}" if missing else "nothing missing, nothing repaired"
    progress(Event(stage="repair", message=repaired))
    decision = chain.decide(estimate, problem, cell, tools.method, **tools.method_options)
    progress(Event(stage="decide", message=certificate_line(decision)))
    outcome = _apply(decision, scene, tools)
    progress(Event(stage="act", message=_applied(decision, outcome)))
    made = report(decision, outcome)
    return Answer(
        intent=intent,
        scene=scene,
        observation=seen,
        estimate=estimate,
        decision=decision,
        outcome=outcome,
        report=made,
        notes=tuple(notes),
        explanation=tuple(explain(estimate, made, language=intent.language)),
    )


def _pose(intent: Intent, cell: Cell) -> tuple[Problem, Cell, list[str]]:
    """The problem that an intent states, the cell it states it for, and notes on what was assumed."""
    assert intent.objective is not None
    notes: list[str] = []
    constraints = dict(intent.constraints)
    circuit_power_w = constraints.pop("circuit_power_w", None)
    if circuit_power_w is not None:
        cell = dataclasses.replace(cell, circuit_power_w=circuit_power_w)
    asked = constraints.get("max_power_w")
    if asked is not None and asked > cell.max_power_w:
        constraints["max_power_w"] = cell.max_power_w
        notes.append(
            f"{human(asked, 'W')} is above the cell's limit of {human(cell.max_power_w, 'W')}, which holds; "
            "--cell-max-power-w changes it"
        )
    if intent.objective == "min_power" and "min_rate_bps" not in constraints:
        constraints["min_rate_bps"] = ASSUMED_MIN_RATE_BPS
        notes.append(
            f"no rate was named, so {human(ASSUMED_MIN_RATE_BPS, 'bit/s')} for each user is assumed; "
            "say for example '500 kbit/s each' to change it"
        )
    return Problem(plugins.objective(intent.objective), **cast("dict[str, Any]", constraints)), cell, notes


def _apply(decision: Decision, scene: Scene, tools: Tools) -> Outcome | None:
    """What the base station did; None where the decision cannot be applied or there is no base station for it."""
    name = tools.base_station or ("simulated" if scene.truth is not None else None)
    if name is None or not decision.is_usable:
        return None
    station = cast(BaseStation, plugins.create("base_station", name, tools.base_station_options, scene))
    return station.apply(decision)


def _applied(decision: Decision, outcome: Outcome | None) -> str:
    if not decision.is_usable:
        return f"nothing applied: {decision.reason}"
    if outcome is None:
        return "nothing applied: the true channel is not known; --out FILE writes the allocation"
    if outcome.written_to is not None:
        return f"allocation written to {outcome.written_to}"
    kept = int(np.count_nonzero((decision.rate_bps > 0) & ~outcome.missed))
    served = int(np.count_nonzero(decision.rate_bps > 0))
    return f"{outcome.base_station}: applied and read back; {kept} of {served} promised rates kept"


class AskRequest(CellOptions):
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
    repairer: Annotated[str, PluginName("repairer")] = Field(chain.DEFAULT_REPAIRER, description="repairer")
    repairer_options: Annotated[PluginOptions, OptionsOf("repairer")] = Field(
        default_factory=dict, description="options of the repairer"
    )
    method: Annotated[str | None, PluginName("method")] = Field(
        None, description="method; the objective's own if not given"
    )
    method_options: Annotated[PluginOptions, OptionsOf("method")] = Field(
        default_factory=dict, description="options of the method"
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
        return AskRecord(intent=understood, seed=request.seed, version=__version__)
    progress(Event(stage="understand", message=f"{intent.reply} ({intent.recogniser}, {intent.confidence:.0%} sure)"))
    scene = _scene(request, progress)
    default_loss = [] if request.csi else ["random:0.2"]
    losses = [parse_loss(text) for text in (default_loss if request.loss is None else request.loss)]
    tools = Tools(**{item.name: getattr(request, item.name) for item in dataclasses.fields(Tools)})
    answer = act_on(intent, scene, *losses, seed=request.seed, tools=tools, progress=progress)
    out = request.out if answer.decision.is_usable else None
    if out is not None:
        FileBaseStation(answer.scene, path=out).apply(answer.decision)
    if request.plot is not None:
        _draw(answer, request.plot)
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
        out=out,
        plot=request.plot,
        tables=_tables(answer),
    )


def _scene(request: AskRequest, progress: Progress) -> Scene:
    if request.csi is not None:
        return file_scene(request, request.csi, request.source_options, progress)
    return chain.simulate(request.source, request.cell(), seed=request.seed, **request.source_options)


def _outcome(outcome: Outcome | None) -> OutcomeAnswer | None:
    if outcome is None:
        return None
    return OutcomeAnswer(base_station=outcome.base_station, written_to=outcome.written_to)


def _tables(answer: Answer) -> list[Table]:
    if answer.decision.is_usable:
        return [user_table(answer.report, answer.estimate), report_table(answer.report)]
    return [figures_of_infeasibility(answer.decision)]


def _draw(answer: Answer, path: Path) -> None:
    from wirelessagent.pictures.chain_picture import draw_chain

    draw_chain(
        observation=answer.observation,
        estimate=answer.estimate,
        decision=answer.decision,
        outcome=answer.outcome,
        path=path,
    )


ASK = Operation(
    name="ask",
    summary="Say what the cell should do: understand, sense, repair, decide, act, read back, explain",
    request=AskRequest,
    record=AskRecord,
    run=run,
)

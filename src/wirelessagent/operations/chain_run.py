"""The whole chain from a sentence or an intent: understand, sense, repair, decide, act, read back, explain."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.acting.base_station import BaseStation
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
from wirelessagent.operations.answers import certificate_line
from wirelessagent.operations.operation import Event, Progress, silent
from wirelessagent.operations.simulate import describe

ASSUMED_MIN_RATE_BPS = 200e3
"""Rate promised to each user where the least power is asked for and no rate was named."""


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What came of a sentence: every stage's result, the notes made on the way, the explanation and the tools."""

    intent: Intent
    scene: Scene
    observation: ChannelObservation
    estimate: ChannelEstimate
    decision: Decision
    outcome: Outcome | None
    report: Report
    notes: tuple[str, ...]
    explanation: tuple[str, ...]
    tools: Tools

    def __str__(self) -> str:
        return "\n".join([certificate_line(self.decision), *self.notes, *self.explanation, str(self.report)])


@dataclass(frozen=True, kw_only=True)
class Tools:
    """The plug-ins that a run of the chain uses, by name, and their options."""

    repairer: str | None = None
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
    return act_on(intent, scene, *losses, seed=seed, tools=tools or Tools(), progress=progress)


def _understood(intent: Intent) -> Event:
    """What to tell the listener of an intent that is clear."""
    return Event(stage="understand", message=f"{intent.reply} ({intent.recogniser}, {intent.confidence:.0%} sure)")


def act_on(intent: Intent, scene: Scene, *losses: Loss, seed: int, tools: Tools, progress: Progress = silent) -> Answer:
    """Run the chain for an intent that is clear: say what was understood and assumed, then sense to explain."""
    progress(_understood(intent))
    problem, cell, notes = _pose(intent, scene.cell)
    for note in notes:
        progress(Event(stage="note", message=note))
    chain.check_solvable(problem, tools.method)
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
        tools=tools,
    )


def _pose(intent: Intent, cell: Cell) -> tuple[Problem, Cell, list[str]]:
    """The problem that an intent states, the cell it states it for, and notes on what was assumed."""
    assert intent.objective is not None
    notes: list[str] = []
    constraints = dict(intent.constraints)
    circuit_power_w = constraints.pop("circuit_power_w", None)
    if circuit_power_w is not None:
        cell = dataclasses.replace(cell, circuit_power_w=circuit_power_w)
    asked = cast("float | None", constraints.get("max_power_w"))
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
    rates = "promised" if decision.problem.promises_rates else "committed"
    return f"{outcome.base_station}: applied and read back; {kept} of {served} {rates} rates kept"

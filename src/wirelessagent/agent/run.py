"""The chain from an intent to a decision and back from the base station: sense, repair, decide, report, explain."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias, cast

import numpy as np

from wirelessagent import chain, plugins
from wirelessagent.acting.base_station import BaseStation
from wirelessagent.agent.events import Event, Progress, silent
from wirelessagent.agent.posing import Posed
from wirelessagent.agent.tools import Tools
from wirelessagent.agent.turn import Run
from wirelessagent.language.intent import Intent
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.model.units import percent
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.certificates import decided_line
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.report import report

Decide: TypeAlias = Callable[[ChannelEstimate, Problem, Cell, Tools], Decision]
"""What decides."""


def decided(estimate: ChannelEstimate, problem: Problem, cell: Cell, tools: Tools) -> Decision:
    """The decision of the method that the tools name."""
    return chain.decide(estimate, problem, cell, tools.method, **tools.method_options)


@dataclass(frozen=True, kw_only=True)
class Sight:
    """What is known of a scene's channel: what was seen, and what was made of it."""

    scene: Scene
    observation: ChannelObservation
    estimate: ChannelEstimate


def look(
    scene: Scene, losses: Sequence[Loss], seed: int, tools: Tools, *, language: str = "en", progress: Progress = silent
) -> Sight:
    """Observe a scene, with what ``losses`` leave of it, and repair what is missing."""
    seen = scene.observe(*losses, seed=seed)
    progress(Event(stage="sense", message=describe(seen, language), language=language))
    estimate = chain.repair(seen, tools.repairer, **tools.repairer_options)
    missing = int(seen.missing.sum())
    repaired = message(
        language, "stage.repaired" if missing else "stage.complete", missing=missing, method=estimate.method
    )
    progress(Event(stage="repair", message=repaired, language=language))
    return Sight(scene=scene, observation=seen, estimate=estimate)


def describe(seen: ChannelObservation, language: str = "en") -> str:
    """The size of an observation and what is missing, in one sentence."""
    missing = int(seen.missing.sum())
    history = message(language, "stage.slots", slots=seen.num_slots) if seen.num_slots > 1 else ""
    return message(
        language, "stage.sensed", users=seen.num_users, subcarriers=seen.num_subcarriers, history=history,
        missing=missing, entries=seen.missing.size, share=percent(missing / seen.missing.size),
    )  # fmt: skip


def plan(
    intent: Intent, posed: Posed, sight: Sight, tools: Tools, *, decide: Decide = decided, progress: Progress = silent
) -> Run:
    """Decide on what was posed; nothing is applied."""
    decision = decide(sight.estimate, posed.problem, posed.cell, tools)
    progress(Event(stage="decide", message=decided_line(decision, intent.language), language=intent.language))
    made = report(decision)
    return Run(
        intent=intent,
        scene=dataclasses.replace(sight.scene, cell=posed.cell),
        observation=sight.observation,
        estimate=sight.estimate,
        decision=decision,
        outcome=None,
        report=made,
        notes=posed.notes,
        explanation=tuple(explain(sight.estimate, made, language=intent.language)),
        tools=tools,
    )


def with_outcome(run: Run, outcome: Outcome | None) -> Run:
    """The run after the base station did something, with its report and its explanation."""
    made = report(run.decision, outcome)
    explained = explain(run.estimate, made, language=run.intent.language)
    return dataclasses.replace(run, outcome=outcome, report=made, explanation=tuple(explained))


def station_of(tools: Tools, scene: Scene) -> BaseStation | None:
    """The base station that is named, else a simulated one where the true channel is known; else None."""
    name = tools.base_station or ("simulated" if scene.truth is not None else None)
    if name is None:
        return None
    return cast(BaseStation, plugins.create("base_station", name, tools.base_station_options, scene))


def applied_line(run: Run) -> str:
    """What the base station made of a run, in one sentence."""
    language, outcome = run.intent.language, run.outcome
    assert outcome is not None
    if outcome.written_to is not None:
        return message(language, "applied.written", path=outcome.written_to)
    if outcome.achieved is None:
        return message(language, "applied.unmeasured", station=outcome.base_station)
    promised = outcome.promised_bps > 0
    kept, served = int(np.count_nonzero(promised & ~outcome.missed)), int(np.count_nonzero(promised))
    count = message(language, "applied.all" if kept == served > 1 else "applied.some", kept=kept, served=served)
    key = f"applied.{run.decision.problem.firmness}"
    return message(language, key, station=outcome.base_station, count=count)

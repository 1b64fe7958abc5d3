"""The cell that a conversation is about: what is seen of its channel, how decisions are made, and its base station.

The chain from an intent to a decision and back: sense, repair, decide, report, explain, act.
"""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Generator, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import TypeAlias, cast

from wirelessagent import chain, plugins
from wirelessagent.acting.base_station import BaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.agent import acting
from wirelessagent.agent.posing import ABOVE_THE_LIMIT, RefusedError, pose
from wirelessagent.agent.turn import Run, Tools
from wirelessagent.language.intent import Intent
from wirelessagent.language.request import Request
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.model.units import percent
from wirelessagent.sensing.loss import random
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.explanation import decided_line, explain
from wirelessagent.telling.report import report
from wirelessagent.telling.told import Event, Progress, silent

Decide: TypeAlias = Callable[[ChannelEstimate, Problem, Cell, Tools], Decision]
"""What decides."""


def decided(estimate: ChannelEstimate, problem: Problem, cell: Cell, tools: Tools) -> Decision:
    """The decision of the method that the tools name."""
    return chain.decide(estimate, problem, cell, tools.method, **tools.method_options)


@dataclass(frozen=True, kw_only=True)
class Sight:
    """What is known of a scene's channel: what was seen, and what was made of it."""

    observation: ChannelObservation
    estimate: ChannelEstimate


def describe(seen: ChannelObservation, language: str = "en") -> str:
    """The size of an observation and what is missing, in one sentence."""
    missing = int(seen.missing.sum())
    history = message(language, "stage.slots", slots=seen.num_slots) if seen.num_slots > 1 else ""
    return message(
        language, "stage.sensed", users=seen.num_users, subcarriers=seen.num_subcarriers, history=history,
        missing=missing, entries=seen.missing.size, share=percent(missing / seen.missing.size),
    )  # fmt: skip


def station_of(tools: Tools, scene: Scene) -> BaseStation | None:
    """The base station that is named, else a simulated one where the true channel is known; else None."""
    name = tools.base_station or ("simulated" if scene.truth is not None else None)
    if name is None:
        return None
    return cast(BaseStation, plugins.create("base_station", name, tools.base_station_options, scene))


@dataclass(eq=False)
class Site:
    """One scene with its losses, the tools that work on it, and the rules of acting; see the session's arguments.

    The channel is looked at once, when it is first needed.

    Attributes:
        touched: whether anything was tried at the base station.
        read_last: what was read back last; None where nothing was, or where that could not be read.
        telling: the run that the base station is being told; until its turn is over, what is in effect is not known.
    """

    scene: Scene
    losses: Sequence[Loss]
    _: KW_ONLY
    seed: int
    tools: Tools
    base_station: BaseStation | None = None
    confirm: bool | None = None
    tolerance: float = acting.TOLERANCE
    progress: Progress = silent
    station_of: Callable[[Tools, Scene], BaseStation | None] = station_of
    decide: Decide = decided
    touched: bool = field(default=False, init=False)
    read_last: Outcome | None = field(default=None, init=False)
    telling: Run | None = field(default=None, init=False)
    _sight: Sight | None = field(default=None, init=False)

    @property
    def user_names(self) -> tuple[str, ...]:
        return self.scene.sensed.user_names

    def sight(self, language: str, *, missing: float | None = None, tools: Tools | None = None) -> Sight:
        """What is known of the channel, if another share of the gains were ``missing``, or by other ``tools``."""
        own = missing is None and tools is None
        if own and self._sight is not None:
            return self._sight
        losses, tools = (
            self.losses if missing is None else [random(missing)] if missing > 0 else [],
            tools or self.tools,
        )
        seen = self.scene.observe(*losses, seed=self.seed)
        self.tell("sense", describe(seen, language), language)
        estimate, gaps = chain.repair(seen, tools.repairer, **tools.repairer_options), int(seen.missing.sum())
        key = "stage.repaired" if gaps else "stage.complete"
        self.tell("repair", message(language, key, missing=gaps, method=estimate.method), language)
        found = Sight(observation=seen, estimate=estimate)
        self._sight = found if own else self._sight
        return found

    def tell(self, stage: str, said: str, language: str) -> None:
        """Tell who listens what was just done."""
        self.progress(Event(stage=stage, message=said, language=language))

    def plan(self, intent: Intent, request: Request, *, sight: Sight | None = None, tools: Tools | None = None) -> Run:
        """The decision for a request; nothing is applied.

        Raises:
            UnclearRequestError: the request does not fit the channel; the message is the question to the operator.
            RefusedError: the method does not solve it; the message is for the operator.
        """
        language, tools = intent.language, tools or self.tools_of(request)
        posed = pose(request, self.scene.cell, self.user_names, language)
        for note in posed.notes:
            if note.key == ABOVE_THE_LIMIT:  # contradicts what was asked, which nobody should have to wait for
                self.tell("note", note, language)
        try:
            chain.check_solvable(posed.problem, tools.method)
        except UnsupportedProblemError as refusal:
            raise RefusedError(refusal, posed.problem, tools.method, language) from refusal
        seen = sight or self.sight(language)
        decision = self.decide(seen.estimate, posed.problem, posed.cell, tools)
        self.tell("decide", decided_line(decision, language), language)
        made, scene = report(decision), dataclasses.replace(self.scene, cell=posed.cell)
        return Run(
            intent=intent, scene=scene, observation=seen.observation, estimate=seen.estimate, decision=decision,
            outcome=None, report=made, notes=posed.notes, tools=tools,
            explanation=tuple(explain(seen.estimate, made, language=language)),
        )  # fmt: skip

    def tools_of(self, request: Request) -> Tools:
        """The tools, with the method that the operator named."""
        return self.tools if request.method in (None, self.tools.method) else self.with_method(request.method)

    def station(self, run: Run) -> BaseStation | None:
        """The base station that a run would be applied at; None where there is none."""
        return self.base_station or self.station_of(self.tools, run.scene)

    def asks(self, station: BaseStation) -> bool:
        """Whether the operator has to say yes before anything is applied."""
        return station.name != SimulatedBaseStation.name if self.confirm is None else self.confirm

    def carry_out(self, run: Run, station: BaseStation, last_good: Run | None) -> acting.Effect:
        """Apply a run, read back, and go back to the last good one where it is at fault."""
        with self._told(run):
            effect = acting.carry_out(run, station, last_good, self.tolerance)
            self.read_last = effect.restored or effect.run.outcome
        return effect

    def put_back(self, run: Run, station: BaseStation) -> tuple[Outcome | None, str]:
        """Apply again what was in effect before: what was read back, and what went wrong."""
        with self._told(run):
            outcome, trouble = acting.put_back(run, station, run.intent.language)
            self.read_last = outcome
        return outcome, trouble

    @contextlib.contextmanager
    def _told(self, run: Run) -> Generator[None]:
        before = self.touched, self.read_last
        self.touched, self.read_last, self.telling = True, None, run
        try:
            yield
        except InputError:  # nothing was touched
            (self.touched, self.read_last), self.telling = before, None
            raise

    def foreseen(self, run: Run) -> Run:
        """A run with what it would achieve, where the true channel is known; nothing is applied."""
        if run.outcome is not None or run.scene.truth is None or not run.decision.is_usable:
            return run
        return run.with_outcome(SimulatedBaseStation(run.scene).apply(run.decision))

    def with_method(self, name: str) -> Tools:
        """The tools with another method, at its own defaults."""
        return dataclasses.replace(self.tools, method=name, method_options={})

"""Where a conversation stands, and what one turn makes of it.

The site is the cell that it is about: what is seen of its channel, how decisions are made, and its base station; by it
goes the chain from an intent to a decision and back: sense, repair, decide, report, explain, act. The state is what
holds; states never change, each turn may bring a new one. A talk is both as a line finds them, a reply what comes of
it.
"""

from __future__ import annotations

import contextlib
import dataclasses
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, TypeAlias, TypeVar, cast

from wirelessagent import chain, plugins
from wirelessagent.acting.base_station import BaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.agent import acting
from wirelessagent.agent.posing import ABOVE_THE_LIMIT, ASSUMED_OUTAGE_PROBABILITY, RefusedError, pose
from wirelessagent.agent.turn import Done, Lines, Run, Tools, Turn, restated
from wirelessagent.language.acts import Act, Press
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Awaited, Question
from wirelessagent.language.request import Request
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.model.shown import Plain
from wirelessagent.model.units import percent, reliability
from wirelessagent.sensing.loss import random
from wirelessagent.telling.catalogue import Event, Progress, Table, Voice, capital, message, silent
from wirelessagent.telling.explanation import decided_line, explain
from wirelessagent.telling.report import report, side_by_side

_Found = TypeVar("_Found")

Column: TypeAlias = tuple[str, Run]
"""A run and what it is called."""


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
        losses = self.losses if missing is None else [random(missing)] if missing > 0 else []
        tools = tools or self.tools
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

    def put_back(self, run: Run, station: BaseStation) -> tuple[Run, Outcome | None, str]:
        """Apply again what was in effect before: the run, what was read back, and what went wrong."""
        with self._told(run):
            back, self.read_last, trouble = acting.put_back(run, station, run.intent.language)
        return back, self.read_last, trouble

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


@dataclass(frozen=True, kw_only=True, repr=False)
class State(Plain):
    """What holds in a conversation.

    Attributes:
        request: what is asked for; None at the start.
        run: the decision for it; None where there is none yet.
        planned: what a yes would apply; None where nothing waits.
        undoes: whether that is for a request that an undo went back to.
        on_air: what is in effect at the base station, as it was read back; None where that is nothing or not known.
        last_good: what to go back to; None where nothing was good yet.
        question: what the last turn asked back; None where it asked nothing.
        supposed: the request of the what-if that was the last turn; None where it was something else.
        offers: what can be met instead of the request, each as the acts that ask for it; the next lines may take one.
        noted: whether it was told that rates are promised at a probability that nobody named.
    """

    request: Request | None = None
    run: Run | None = None
    planned: Run | None = None
    undoes: bool = False
    on_air: Run | None = None
    last_good: Run | None = None
    question: Question | None = None
    supposed: Request | None = None
    offers: tuple[tuple[Act, ...], ...] = ()
    noted: bool = False

    @property
    def awaits(self) -> Awaited:
        """What the agent asked for last."""
        if self.question is not None:
            return "clarification"
        return "nothing" if self.planned is None else "confirmation"

    @property
    def waiting(self) -> Question | None:
        """Limits that were said, and wait for their aim: they outlast what is asked in between; None where none do."""
        if self.request is not None or self.question is None or not self.question.pending:
            return None
        return Question(pending=self.question.pending)

    @property
    def radiated_w(self) -> float:
        """Power of the last decision; 0 where there is none."""
        return 0.0 if self.run is None or not self.run.decision.is_usable else self.run.decision.total_power_w

    def noted_after(self, run: Run | None, *, requested: bool) -> bool:
        """Whether it is known what is assumed, after a turn with this run; another probability requested forgets it."""
        if run is None:
            return self.noted
        if _assumed(run.intent.language) in run.notes:
            return True
        return self.noted and not (requested and run.decision.problem.outage_probability is not None)

    @property
    def settled(self) -> State:
        """The same with nothing open: no plan that waits, no question, no what-if."""
        return dataclasses.replace(self, planned=None, undoes=False, question=None, supposed=None, offers=())


@dataclass(frozen=True, kw_only=True)
class Talk(Voice):
    """A conversation as one line finds it.

    Attributes:
        site: the cell.
        state: what holds.
        past: the states before other requests, the last one last.
        turns: what was said so far.
        intent: what was understood of the line.
        text: the line.
        language: the operator's.
        pressed: the button that it stands for; None where it was said.
    """

    site: Site
    state: State
    past: Sequence[State]
    turns: Sequence[Turn]
    intent: Intent
    text: str
    language: str
    pressed: Press | None = None

    def needed(self, found: _Found | None) -> _Found:
        """What a line needs that a decision brings; before there is one, that is the reply."""
        if found is None:
            raise InsteadError(Reply(needs=self.say("refused.nothing_yet")))
        return found

    def plan(self, request: Request | None) -> str:
        """What is asked for, as a part of a sentence."""
        plan = "–" if request is None else restated(request, self.language).rstrip(".。")
        return plan[:1].lower() + plan[1:]

    def tried(self, request: Request, **by: Any) -> Run:
        """The run for a request with what it would achieve, where that is known; nothing is applied."""
        return self.site.foreseen(self.site.plan(self.intent, request, **by))

    def beside(self, columns: Sequence[Column]) -> tuple[Table, ...]:
        """A table of runs beside each other."""
        return (side_by_side([(name, run.report) for name, run in columns], self.language),)

    def notes(self, run: Run, *, noted: bool = False, before: Sequence[str] = ()) -> list[str]:
        """The notes of a run as sentences, without those of ``before`` and, where they were ``noted``, the 95 %."""
        language = run.intent.language
        known = {*before, *([_assumed(language)] if noted or self.state.noted else [])}
        return [message(language, "text.note", note=capital(note)) for note in run.notes if note not in known]


class InsteadError(Exception):
    """A line cannot be answered as it stands; the reply that it gets instead."""

    def __init__(self, reply: Reply) -> None:
        super().__init__(reply)
        self.reply = reply


@dataclass(frozen=True, kw_only=True)
class Reply(Lines, Done):
    """What a line comes to, and what is said.

    Attributes:
        state: what holds now; None where nothing changed.
        undone: how many requests were taken back; that can't itself be undone.
    """

    state: State | None = None
    undone: int = 0


Replies: TypeAlias = Mapping[type[Act], Callable[[Talk, Any], Reply]]
"""What becomes of a question or a command, by the kind of its act."""


def asked_back(question: str, state: State | None = None) -> Reply:
    """A reply that only asks."""
    return Reply(needs=question, stage="asked", state=state)


def _assumed(language: str) -> str:
    return message(language, "assumed.outage", sure=reliability(ASSUMED_OUTAGE_PROBABILITY))

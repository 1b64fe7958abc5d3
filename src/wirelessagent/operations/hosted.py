"""A conversation that goes on for a caller elsewhere: its lines come one by one, and it can be taken up again.

Nothing reaches the base station by a line: what is decided waits, and :meth:`Hosted.press` applies it or drops it. A
conversation that was lost with its process is taken up by saying its recorded lines again. What they meant and what was
decided is what was recorded, and what the base station did is what was read back of it, or that it failed: nothing is
understood or decided otherwise, and nobody is told anything twice. A press that broke off with its process is told as
that (:meth:`Hosted.broke_off`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.state import decided, station_of
from wirelessagent.agent.turn import Tools, Turn
from wirelessagent.chain import resolve
from wirelessagent.language.acts import Press
from wirelessagent.language.conversation import understood
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, NothingRecordedError, StoreError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Scene
from wirelessagent.operations.chat import ChatRequest
from wirelessagent.operations.hosted_answers import CellFacts, ChannelAnswer, HostedTurn, SeenAnswer, TradeOffAnswer
from wirelessagent.operations.operation import Event, Progress
from wirelessagent.operations.pseudonyms import hidden_text
from wirelessagent.operations.recording import opened
from wirelessagent.operations.simulate import scene_arrays
from wirelessagent.operations.trade_off import trade_off
from wirelessagent.operations.turn_record import LinesAnswer, TurnRecord
from wirelessagent.sensing.npz import write_npz
from wirelessagent.store.plain import plain
from wirelessagent.store.rebuilt import decision_of, intent_of, outcome_of
from wirelessagent.store.record_of import problem_columns
from wirelessagent.store.stored import StoredTurn
from wirelessagent.telling.catalogue import message

Attempts: TypeAlias = list[Outcome | BaseException]
"""What came of each time that a base station was told something."""


class _FailedThenError(Exception):
    """The base station failed when it was told; nothing more is known of it."""


class _BrokenOffError(BaseException):
    """The process ended while the base station was told; no fault of the base station's, so that none is told of."""


@dataclass(frozen=True)
class _Kept(BaseStation):
    """In a base station's place: does nothing, and lets happen what it is told of, attempt by attempt.

    Attributes:
        real: the base station.
        attempts: what came of each: what was read back, or why nothing was, as of all that follow the last.
        why: nothing may be tried where there is none.
    """

    real: BaseStation = field(kw_only=True)
    attempts: Attempts = field(kw_only=True)
    why: str = field(kw_only=True)

    def __post_init__(self) -> None:
        for name in ("name", "power_resolution_w"):
            object.__setattr__(self, name, getattr(self.real, name))

    def apply(self, decision: Decision) -> Outcome:
        if not self.attempts:
            raise InputError(self.why)
        came_of_it = self.attempts.pop(0) if len(self.attempts) > 1 else self.attempts[0]
        if isinstance(came_of_it, BaseException):
            raise came_of_it
        return self.real.apply(decision) if isinstance(self.real, SimulatedBaseStation) else came_of_it


class Hosted:
    """A conversation about a cell; ``turns`` are those that were said so far.

    Args:
        request: the cell, and where its turns are recorded.
        identity: of the conversation; its recorded turns, if there are any, are said again.
        recalled: lines to be said again that were recorded elsewhere.
    """

    def __init__(
        self, request: ChatRequest, identity: str, progress: Progress, *, recalled: Sequence[tuple[str, bool]] = ()
    ) -> None:
        self._request, self._progress = request, progress
        self.turns = list[HostedTurn]()
        self._attempts: Attempts | None = []
        self._again: StoredTurn | None = None
        self._session = request.session(
            self._tell, confirm=True, station_of=self._station, decide=self._decide, understand=self._understand
        )
        self._session.id = identity
        for text, pressed in recalled:
            self._attempts = None if pressed else []
            self._keep(self._session.say(text, pressed="yes" if pressed else None), None)
        self._attempts = []
        self.catch_up(progress)

    @property
    def number(self) -> int:
        """Of the last turn; 0 before the first."""
        return len(self._session.turns)

    def catch_up(self, progress: Progress) -> None:
        """Say again what was recorded and not said here.

        Raises:
            StoreError: it is not what it was, or comes to something else by now.
        """
        self._progress = progress
        stored = [turn for turn in self._stored() if turn.turn > self.number]
        try:
            for done, turn in enumerate(stored, 1):
                self._again, self._attempts = turn, _attempts(turn)
                by, pressed = str(turn.intent.get("by", "")), turn.intent.get("pressed")
                said = self._session.say(turn.text, by=by, pressed=pressed)
                self._check_same(said, turn)
                self._keep(said, turn.number)
                self._tell(
                    Event(stage="recall", message="", done=done, total=len(stored), language=said.intent.language)
                )
        finally:
            self._again, self._attempts = None, []

    def say(self, text: str, progress: Progress, *, by: str = "") -> None:
        """Take a line; it applies nothing."""
        self._take(hidden_text(text, self._session.user_names), progress, by)

    def press(self, what: Press, progress: Progress, *, by: str = "") -> None:
        """Take a button; it means what it is, whatever was said before."""
        self._press(what, progress, by, attempts=None if what == "yes" else [])

    def broke_off(self, what: Press, progress: Progress, *, by: str = "") -> None:
        """Tell of a button that was pressed, and of which no more is known than that its process ended."""
        self._press(what, progress, by, attempts=[_BrokenOffError()])

    def channel(self) -> ChannelAnswer | None:
        """What is known of the channel by the last decision; None where there is none yet."""
        run = self._session.state.run
        if run is None:
            return None
        seen, estimate = run.observation, run.estimate
        frequencies = seen.subcarrier_frequencies_hz
        return ChannelAnswer(
            user_names=list(estimate.user_names),
            frequencies_hz=None if frequencies is None else frequencies.tolist(),
            observed_gain=seen.current.tolist(),
            gain=estimate.gain.tolist(),
            gain_sd=(estimate.gain_variance**0.5).tolist(),
            repaired=estimate.repaired.tolist(),
        )

    def _press(self, what: Press, progress: Progress, by: str, *, attempts: Attempts | None) -> None:
        """Have a button's turn; what comes of its attempts is what the base station makes of them, where None."""
        self._attempts = attempts
        try:
            self._take(message(self._session.language, f"pressed.{what}"), progress, by, pressed=what)
        finally:
            self._attempts = []

    def _take(self, text: str, progress: Progress, by: str, *, pressed: Press | None = None) -> None:
        """Have a turn and record it; one that was broken off after the base station was told is a turn, too.

        Raises:
            WirelessAgentError: it could not be taken, or not be recorded: then nobody is told of it as a turn.
        """
        self._progress, before = progress, self.number
        try:
            self._session.say(text, by=by, pressed=pressed)
        except (Exception, _BrokenOffError):
            if self.number == before:
                raise
        finally:
            for turn in self._session.turns[before:]:
                self._keep(turn, self._request.recorded(turn))

    def trade_off(self, number: int, progress: Progress) -> TradeOffAnswer:
        """The curve that the decision of a turn lies on.

        Raises:
            NothingRecordedError: there is no such turn, or it decided nothing.
        """
        runs = {turn.number: turn.run for turn in self._session.turns}
        return trade_off(runs.get(number), progress)

    def _keep(self, turn: Turn, stored: int | None) -> None:
        record = TurnRecord.of(turn, self._session, stored)
        kept = HostedTurn(
            record=record if self._again is None else record.model_copy(update=_told_then(self._again)),
            language=turn.intent.language,
            by=turn.by,
            in_effect=self._in_effect(),
            waits=self._session.state.awaits == "confirmation",
        )
        self.turns.append(kept)

    def _tell(self, event: Event) -> None:
        self._progress(event)

    def _in_effect(self) -> int | None:
        """The turn that decided what is in effect."""
        on_air = self._session.state.on_air
        if on_air is None:
            return None
        numbers = [
            turn.number
            for turn in self._session.turns
            if turn.run is not None and turn.stage == "applied" and same_allocation(turn.run.decision, on_air.decision)
        ]
        return numbers[-1] if numbers else None

    def _station(self, tools: Tools, scene: Scene) -> BaseStation | None:
        """The base station where a button was pressed; one in its place where lines are said, or said again."""
        station = station_of(tools, scene)
        if station is None or self._attempts is None:
            return station
        why = message(self._session.language, "pressed.only")
        return _Kept(scene=scene, real=station, attempts=list(self._attempts), why=why)

    def _decide(self, estimate: ChannelEstimate, problem: Problem, cell: Cell, tools: Tools) -> Decision:
        """What was decided where a line is said again and that is what it decided; else what is decided now."""
        again, names = self._again, estimate.user_names
        posed = problem_columns(resolve(problem).for_users(names))
        if again is None or not again.decided or (plain(posed), plain(cell)) != (again.problem, again.cell):
            return decided(estimate, problem, cell, tools)
        ran = "interpreted" if again.platform.get("kernels") == "interpreted" else "compiled"
        return decision_of(again, names).knowing(estimate, ran)

    def _understand(self, text: str, context: Context, recogniser: Recogniser) -> Intent:
        """What a line was understood to mean where it is said again; else what it means."""
        meant = None if self._again is None else intent_of(self._again)
        return meant or understood(text, context, recogniser)

    def _check_same(self, said: Turn, stored: StoredTurn) -> None:
        """Refuse to go on where a line comes to something else by now: what is in effect could be told wrongly."""
        diff = stored.intent.get("diff")
        if said.stage != stored.stage or (diff is not None and plain(said.diff) != diff):
            raise StoreError(
                f"turn {stored.turn} of the conversation {self._session.id}, {stored.text!r:.80}, comes to something "
                "else than it did then: begin a new conversation"
            )

    def _stored(self) -> list[StoredTurn]:
        try:
            with opened(self._request) as store:
                return [turn.whole() for turn in store.turns(self._session.id)]
        except NothingRecordedError:
            return []
        except StoreError as error:
            raise StoreError(f"the conversation {self._session.id} cannot be taken up again: {error}") from error


def _attempts(turn: StoredTurn) -> Attempts:
    """What came of each time that the base station was told something in a recorded turn.

    A plan is applied first, unless that is put back which was in effect before; then the last good one may be put back.
    """
    if not turn.decided:  # which touched nothing
        return []
    read = [turn.restored] if turn.stage == "undone" else [turn.applied, turn.restored]
    failed = _FailedThenError(turn.reply)
    found = [None if one is None else outcome_of(dataclasses.replace(turn, applied=one)) for one in read]
    return [*(failed if one is None else one for one in found), failed]


def _told_then(stored: StoredTurn) -> dict[str, Any]:
    """What a recorded turn said, for the record of one that was said again."""
    told = {name: getattr(stored, name) for name in ("at_utc", "version", "reply", "intent")}
    lines = stored.intent.get("lines")
    return told if lines is None else {**told, "lines": LinesAnswer(**lines)}


def facts_of(request: ChatRequest, progress: Progress) -> CellFacts:
    """What the cell of a request is.

    Raises:
        InputError: no conversation about it could begin.
    """
    request.losses()
    request.chosen_recogniser()
    scene = request.scene(progress)
    station = station_of(Tools(base_station=request.base_station), scene)
    return CellFacts(
        facts=dict(scene.facts),
        user_names=list(scene.sensed.user_names),
        num_subcarriers=scene.sensed.num_subcarriers,
        base_station=None if station is None else station.name,
        max_power_w=scene.cell.max_power_w,
    )


def seen_in(request: ChatRequest, progress: Progress, out: Path | None = None) -> SeenAnswer:
    """What is seen of the channel that a request is about, with nothing lost; written to ``out``, if given."""
    scene = request.scene(progress)
    seen = scene.sensed
    if out is not None:
        write_npz(out, *scene_arrays(scene, seen))
    return SeenAnswer(
        facts=dict(scene.facts),
        user_names=list(seen.user_names),
        num_users=seen.num_users,
        num_subcarriers=seen.num_subcarriers,
        num_slots=seen.num_slots,
        missing=int(seen.missing.sum()),
        gain=seen.current.tolist(),
    )

"""A conversation that goes on for a caller elsewhere: its lines come one by one, and it can be taken up again.

Nothing reaches the base station by a line: what is decided waits, and :meth:`Hosted.press` applies it or drops it. A
conversation that was lost with its process is taken up by saying its recorded lines again; what the base station did
then is what was read back of it, so that it is told nothing twice.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.site import station_of
from wirelessagent.agent.turn import Tools, Turn
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, NothingRecordedError, StoreError
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene
from wirelessagent.operations.chat import ChatRequest
from wirelessagent.operations.operation import Event, Progress
from wirelessagent.operations.record import Matrix, Record, SwitchMatrix, Vector
from wirelessagent.operations.recording import opened
from wirelessagent.operations.turn_record import TurnRecord
from wirelessagent.store.rebuilt import outcome_of
from wirelessagent.store.stored import StoredTurn
from wirelessagent.telling.catalogue import message

Press: TypeAlias = Literal["yes", "no", "undo"]
"""What is pressed: apply the plan that waits, drop it, or take back the last change."""


class ChannelAnswer(Record):
    """What is known of the channel: as it was sensed (null = missing), and repaired with standard deviations."""

    user_names: list[str]
    frequencies_hz: Vector | None
    observed_gain: Matrix
    gain: Matrix
    gain_sd: Matrix
    repaired: SwitchMatrix


class HostedTurn(Record):
    """A turn with what holds after it.

    Attributes:
        in_effect: the turn whose allocation is in effect; None where none is, or where that is not known.
        waits: whether a plan waits to be applied.
    """

    record: TurnRecord
    language: str
    by: str
    in_effect: int | None
    waits: bool


class CellFacts(Record):
    """What a cell is, for people to choose among several."""

    facts: dict[str, str]
    user_names: list[str]
    num_subcarriers: int
    base_station: str | None
    max_power_w: float


@dataclass(frozen=True)
class _Kept(BaseStation):
    """In a base station's place: does nothing, and tells what it is told to."""

    outcomes: list[Outcome] = dataclasses.field(default_factory=list[Outcome])
    why: str = ""

    def apply(self, decision: Decision) -> Outcome:
        if not self.outcomes:
            raise InputError(self.why)
        return self.outcomes.pop(0)


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
        self._pressed = False
        self._again: StoredTurn | None = None
        self._session = request.session(self._tell, confirm=True, station_of=self._station)
        self._session.id = identity
        self._take_up(recalled)

    @property
    def number(self) -> int:
        """Of the last turn; 0 before the first."""
        return len(self._session.turns)

    def say(self, text: str, progress: Progress, *, by: str = "") -> None:
        """Take a line; it applies nothing."""
        self._progress = progress
        turn, stored = self._request.said(self._session, text, by=by)
        self._keep(turn, stored)

    def press(self, what: Press, progress: Progress, *, by: str = "") -> None:
        """Take a button."""
        self._pressed = what == "yes"
        try:
            self.say(message(self._session.language, f"pressed.{what}"), progress, by=by)
        finally:
            self._pressed = False

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

    def _keep(self, turn: Turn, stored: int | None) -> None:
        kept = HostedTurn(
            record=TurnRecord.of(turn, self._session, stored),
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
        outcomes = [] if self._again is None else _outcomes(self._again)
        if station is None or self._pressed or (outcomes and isinstance(station, SimulatedBaseStation)):
            return station
        kept = _Kept(scene=scene, outcomes=outcomes, why=message(self._session.language, "pressed.only"))
        object.__setattr__(kept, "name", station.name)
        object.__setattr__(kept, "power_resolution_w", station.power_resolution_w)
        return kept

    def _take_up(self, recalled: Sequence[tuple[str, bool]]) -> None:
        """Say again what was said: lines recorded elsewhere, then those in the store."""
        for text, pressed in recalled:
            self._pressed = pressed
            self._keep(self._session.say(text), None)
        self._pressed = False
        for turn in self._stored():
            self._again = turn
            self._keep(self._session.say(turn.text, by=str(turn.intent.get("by", ""))), turn.number)
        self._again = None

    def _stored(self) -> list[StoredTurn]:
        try:
            with opened(self._request) as store:
                return [turn.whole() for turn in store.turns(self._session.id)]
        except NothingRecordedError:
            return []
        except StoreError as error:
            raise StoreError(f"the conversation {self._session.id} cannot be taken up again: {error}") from error


def _outcomes(turn: StoredTurn) -> list[Outcome]:
    """What was read back in a recorded turn, in order."""
    read = (turn.applied, turn.restored)
    found = [outcome_of(dataclasses.replace(turn, applied=one)) for one in read if one is not None]
    return [one for one in found if one is not None]


def facts_of(request: ChatRequest, progress: Progress) -> CellFacts:
    """What the cell of a request is."""
    scene = request.scene(progress)
    station = station_of(Tools(base_station=request.base_station), scene)
    return CellFacts(
        facts=dict(scene.facts),
        user_names=list(scene.sensed.user_names),
        num_subcarriers=scene.sensed.num_subcarriers,
        base_station=None if station is None else station.name,
        max_power_w=scene.cell.max_power_w,
    )


class SeenAnswer(Record):
    """What a file with gains holds; ``gain`` is the current slot, null = missing."""

    facts: dict[str, str]
    user_names: list[str]
    num_users: int
    num_subcarriers: int
    num_slots: int
    missing: int
    gain: Matrix


def seen_in(request: ChatRequest, progress: Progress) -> SeenAnswer:
    """What is seen of the channel that a request is about, with nothing lost."""
    scene = request.scene(progress)
    seen = scene.sensed
    return SeenAnswer(
        facts=dict(scene.facts),
        user_names=list(seen.user_names),
        num_users=seen.num_users,
        num_subcarriers=seen.num_subcarriers,
        num_slots=seen.num_slots,
        missing=int(seen.missing.sum()),
        gain=seen.current.tolist(),
    )

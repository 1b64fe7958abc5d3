"""Where a conversation stands, and what one turn makes of it. States never change; each turn may bring a new one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeVar

from wirelessagent.agent.dialogue import restated
from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY
from wirelessagent.agent.site import Site
from wirelessagent.agent.turn import Lines, Run, Stage, Turn
from wirelessagent.language.acts import Act, Press
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Awaited, Question
from wirelessagent.language.request import Request
from wirelessagent.model.errors import WirelessAgentError
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.shown import Plain
from wirelessagent.model.units import reliability
from wirelessagent.telling.catalogue import Voice, message
from wirelessagent.telling.report import side_by_side
from wirelessagent.telling.told import Table

_Found = TypeVar("_Found")

Column: TypeAlias = tuple[str, Run]
"""A run and what it is called."""


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
        told = (note[:1].upper() + note[1:] for note in run.notes if note not in known)
        return [message(language, "text.note", note=note) for note in told]


class InsteadError(Exception):
    """A line cannot be answered as it stands; the reply that it gets instead."""

    def __init__(self, reply: Reply) -> None:
        super().__init__(reply)
        self.reply = reply


@dataclass(frozen=True, kw_only=True)
class Reply(Lines):
    """What a turn came to, beside what it says.

    Attributes:
        stage: see :data:`~wirelessagent.agent.turn.Stage`.
        state: what holds now; None where nothing changed.
        run: the run that was made or applied.
        tables: figures that belong to the text.
        restored: what was read back after the last good allocation was put back.
        undone: how many requests were taken back; that can't itself be undone.
        error: what the reply tells of, where something could not be done.
        faulty: whether what is in effect now is not as it was decided or promised.
    """

    stage: Stage = "answered"
    state: State | None = None
    run: Run | None = None
    tables: tuple[Table, ...] = ()
    restored: Outcome | None = None
    undone: int = 0
    error: WirelessAgentError | None = None
    faulty: bool = False


Replies: TypeAlias = Mapping[type[Act], Callable[[Talk, Any], Reply]]
"""What becomes of a question or a command, by the kind of its act."""


def asked_back(question: str, state: State | None = None) -> Reply:
    """A reply that only asks."""
    return Reply(needs=question, stage="asked", state=state)


def _assumed(language: str) -> str:
    return message(language, "assumed.outage", sure=reliability(ASSUMED_OUTAGE_PROBABILITY))

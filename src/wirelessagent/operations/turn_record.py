"""A turn of a conversation as a record."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import Field

from wirelessagent.model.errors import InputError
from wirelessagent.operations.answers import DecisionAnswer, ReportAnswer
from wirelessagent.operations.record import Block, Conclusion, Integers, Record, Vector, of_decision
from wirelessagent.telling.catalogue import Table

if TYPE_CHECKING:
    from wirelessagent.agent.session import Session
    from wirelessagent.agent.turn import Lines, Turn
    from wirelessagent.model.outcome import Outcome


class OutcomeAnswer(Record):
    """What the base station did, read back."""

    base_station: str
    written_to: Path | None
    owner: Integers
    power_w: Vector
    promised_bps: Vector

    @classmethod
    def of(cls, outcome: Outcome | None) -> OutcomeAnswer | None:
        return None if outcome is None else cls(**{name: getattr(outcome, name) for name in cls.model_fields})


class RequestAnswer(Record):
    """What is asked for after a turn."""

    objective: str
    constraints: dict[str, Any]
    method: str | None = None


class LinesAnswer(Record):
    """What a turn says, in three lines: what was decided, what changed, and what it needs from the operator."""

    decided: str
    changed: str
    needs: str

    @classmethod
    def of(cls, lines: Lines) -> LinesAnswer:
        return cls(decided=str(lines.decided), changed=str(lines.changed), needs=str(lines.needs))

    @property
    def said(self) -> tuple[str, ...]:
        """The lines that say something."""
        return tuple(line for part in (self.decided, self.changed, self.needs) if part for line in part.split("\n"))


class TurnRecord(Record):
    """One turn: what was said and understood, what it came to, and what holds after it.

    ``request`` is what is asked for, ``supposed`` what a what-if was about instead.
    """

    number: int
    session: str
    at_utc: str
    text: str
    intent: dict[str, Any]
    stage: str
    reply: str
    lines: LinesAnswer
    request: RequestAnswer | None
    supposed: RequestAnswer | None
    awaits: str
    decision: DecisionAnswer | None
    outcome: OutcomeAnswer | None
    restored: OutcomeAnswer | None
    report: ReportAnswer | None
    notes: list[str]
    explanation: list[str]
    tables: list[Table]
    recogniser: str
    seed: int
    version: str
    stored: int | None
    came_to: Conclusion = Field(exclude=True)

    @classmethod
    def of(cls, turn: Turn, session: Session, stored: int | None) -> TurnRecord:
        from wirelessagent.store.plain import plain
        from wirelessagent.store.record_of import understood

        run, request, supposed = turn.run, session.request, session.state.supposed
        same = ("number", "session", "at_utc", "text", "stage", "reply", "recogniser", "seed", "version")
        return cls(
            **{name: getattr(turn, name) for name in same},
            lines=LinesAnswer.of(turn.lines),
            intent=understood(turn),
            request=None if request is None else RequestAnswer(**plain(request)),
            supposed=None if supposed is None else RequestAnswer(**plain(supposed)),
            awaits=session.state.awaits,
            decision=None if run is None else DecisionAnswer.of(run.decision),
            outcome=None if run is None else OutcomeAnswer.of(run.outcome),
            restored=OutcomeAnswer.of(turn.restored),
            report=None if run is None else ReportAnswer.of(run.report),
            notes=[] if run is None else list(run.notes),
            explanation=[] if run is None else list(run.explanation),
            tables=list(turn.tables),
            stored=stored,
            came_to=_came_to(turn, session),
        )

    @property
    def conclusion(self) -> Conclusion:
        return self.came_to

    def blocks(self) -> list[Block]:
        """The three lines; tables belong to answers, and to what cannot be met."""
        shown = self.stage in ("answered", "asked") or (
            self.decision is not None and of_decision(self.decision.status) != "done"
        )
        return [self.lines.said, *(self.tables if shown else ())]


def _came_to(turn: Turn, session: Session) -> Conclusion:
    if turn.stage == "asked" or session.state.awaits == "confirmation" or isinstance(turn.error, InputError):
        return "unclear"
    if turn.error is not None or turn.faulty or turn.stage == "reverted":
        return "failed"
    if turn.stage != "nothing" or turn.run is None:
        return "done"
    tried = of_decision(turn.run.decision.status)
    return "failed" if tried == "done" and turn.run.outcome is None else tried  # the base station failed

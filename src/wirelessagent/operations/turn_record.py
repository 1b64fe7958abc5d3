"""A turn of a conversation as a record."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.explain.table import Table
from wirelessagent.model.outcome import Outcome
from wirelessagent.operations.answers import DecisionAnswer, ReportAnswer
from wirelessagent.operations.record import Block, Integers, Record, Vector
from wirelessagent.store.plain import plain


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


class TurnRecord(Record):
    """One turn: what was said and understood, what it came to, and what holds after it."""

    number: int
    session: str
    at_utc: str
    text: str
    intent: dict[str, Any]
    stage: str
    reply: str
    request: RequestAnswer | None
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

    @classmethod
    def of(cls, turn: Turn, session: Session, stored: int | None) -> TurnRecord:
        run, request = turn.run, session.request
        same = ("number", "session", "at_utc", "text", "stage", "reply", "recogniser", "seed", "version")
        return cls(
            **{name: getattr(turn, name) for name in same},
            intent=plain(turn.intent),
            request=None if request is None else RequestAnswer(**plain(request)),
            awaits=session.state.awaits,
            decision=None if run is None else DecisionAnswer.of(run.decision),
            outcome=None if run is None else OutcomeAnswer.of(run.outcome),
            restored=OutcomeAnswer.of(turn.restored),
            report=None if run is None else ReportAnswer.of(run.report),
            notes=[] if run is None else list(run.notes),
            explanation=[] if run is None else list(run.explanation),
            tables=list(turn.tables),
            stored=stored,
        )

    @property
    def needs_answer(self) -> bool:
        return self.stage == "asked" or self.awaits == "confirmation"

    def blocks(self) -> list[Block]:
        return [tuple(self.reply.split("\n")), *self.tables]

"""history: what was asked, decided and done, from the audit store; shown, done again and handed on."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, BinaryIO

import numpy as np
from pydantic import Field

from wirelessagent.model.arrays import whole
from wirelessagent.model.atomic import writable_target, write_atomically
from wirelessagent.model.errors import InputError, NothingRecordedError, SealedError, StoreError
from wirelessagent.model.units import human, percent
from wirelessagent.operations.answers import DecisionAnswer
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.record import Block, Conclusion, Files, Record, Table
from wirelessagent.operations.recording import StoreOptions, opened, place_of
from wirelessagent.store.content import estimate_of
from wirelessagent.store.export import exported
from wirelessagent.store.plain import canonical
from wirelessagent.store.rebuilt import decision_of, outcome_of
from wirelessagent.store.stored import StoredTurn, number_of
from wirelessagent.telling.catalogue import has_message, message
from wirelessagent.telling.explanation import summary_line
from wirelessagent.telling.report import decision_tables, report

if TYPE_CHECKING:
    from wirelessagent.store.store import Store

_TEXT_SHOWN = 48
_SESSION_SHOWN = 12
_SESSIONS_LOOKED_AT, _SESSIONS_SHOWN = 100, 3
"""The latest turns whose sessions are named where one is not there, and how many of these."""


class HistoryRequest(StoreOptions):
    panel = "Options"

    session: str | None = Field(None, description="only the turns of this session")
    last: int = Field(20, description="only so many, the latest ones")


class HistoryLine(Record):
    """One turn in a list; of one that was changed since it was recorded only what its columns are good for."""

    number: int | None
    at_utc: str
    session: str
    turn: int | None
    text: str
    stage: str
    objective: str | None = None
    status: str | None = None
    value: float | None = None
    gap: float | None = None
    unit: str | None = None
    applied: str | None = None
    put_back: str | None = None
    by: str | None = None

    @classmethod
    def of(cls, turn: StoredTurn) -> HistoryLine:
        if not turn.is_whole:
            return cls(
                number=number_of(turn.number), at_utc=str(turn.at_utc), session=str(turn.session),
                turn=number_of(turn.turn), text=str(turn.text), stage="changed",
            )  # fmt: skip
        same = {name: getattr(turn, name) for name in cls.model_fields if name not in ("applied", "put_back", "by")}
        applied, put_back = (None if one is None else one["base_station"] for one in (turn.applied, turn.restored))
        return cls(**same, applied=applied, put_back=put_back, by=turn.intent.get("by"))

    def row(self) -> tuple[str, ...]:
        """What a list shows of it."""
        value = "–" if self.value is None else human(self.value, self.unit or "")
        return (
            _counted(self.number), self.at_utc[:16].replace("T", " "),
            f"{self.session[:_SESSION_SHOWN]} {_counted(self.turn)}",
            " ".join(_clipped(self.text).split()), self.objective or "–", self.status or self.stage, value,
            "–" if self.gap is None else percent(self.gap),
            f"{self.put_back} (put back)" if self.put_back else self.applied or "–",
        )  # fmt: skip


def _counted(number: int | None) -> str:
    return "–" if number is None else str(number)


class HistoryRecord(Record):
    """The turns asked for, the oldest first."""

    store: str
    turns: list[HistoryLine]

    def blocks(self) -> list[Block]:
        if not self.turns:
            return [Files("nothing is recorded yet in", (self.store,))]
        columns = ("turn", "time (UTC)", "session", "said", "objective", "status", "value", "gap", "applied by")
        return [
            Files("Recorded in", (self.store,)),
            Table(title="Turns", columns=columns, rows=tuple(line.row() for line in self.turns)),
            "history show N tells all of a turn, history replay N does its work again.",
        ]


def list_turns(request: HistoryRequest, progress: Progress) -> HistoryRecord:
    del progress
    last = whole("last", request.last)
    try:
        with opened(request) as store:
            turns = [HistoryLine.of(turn) for turn in store.turns(request.session, last=last)]
            if not turns:
                check_session(store, request.session)
            return HistoryRecord(store=store.place, turns=turns)
    except NothingRecordedError:
        return HistoryRecord(store=place_of(request), turns=[])


def check_session(store: Store, session: str | None) -> None:
    """Refuse a session that has no turns where others have."""
    there = list(dict.fromkeys(str(turn.session) for turn in store.turns(last=_SESSIONS_LOOKED_AT)))
    if session is not None and there:
        shown = ", ".join(there[-_SESSIONS_SHOWN:])
        raise InputError(f"there is no session {session!r} in {store.place}: the latest are {shown}")


class TurnRequest(StoreOptions):
    panel = "Options"

    number: Annotated[int, Positional()] = Field(description="number of the turn, as history lists it")
    sealed: Path | None = Field(None, description="file that 'history seal' wrote, where the turn is a sealed one")


class ShowRecord(Record):
    """All that is recorded of a turn, and what was changed or removed since in its session."""

    turn: dict[str, Any]
    tampering: list[str]
    paragraphs: list[Block] = Field(exclude=True)

    @property
    def conclusion(self) -> Conclusion:
        return "failed" if self.tampering else "done"

    def blocks(self) -> list[Block]:
        return list(self.paragraphs)


def show_turn(request: TurnRequest, progress: Progress) -> ShowRecord:
    del progress
    with opened(request, archive=request.sealed) as store:
        turn = store.turn(request.number)
        faults = store.faults(turn.session)
        told = _there(turn)
        if turn.is_whole:
            try:
                told = [*_said(turn), *_decided(store, turn)]
            except SealedError as error:
                told = [*_said(turn), message(_language(turn), "history.sealed", error=error)]
            except StoreError:  # the channel that it saw was changed, which the faults tell
                pass
        return ShowRecord(turn=turn.held(), tampering=faults, paragraphs=[*told, *_kept(turn, faults)])


def _there(turn: StoredTurn) -> list[Block]:
    """What the columns of a changed turn hold: it is no longer what was said and done."""
    rows = tuple((name, _clipped(canonical(held))) for name, held in turn.held().items())
    return [Table(title=f"Turn {turn.number} as it is now", columns=("column", "holds"), rows=rows)]


def _clipped(text: str) -> str:
    return text if len(text) <= _TEXT_SHOWN else text[: _TEXT_SHOWN - 1] + "…"


def _said(turn: StoredTurn) -> Iterator[Block]:
    language, intent = _language(turn), turn.intent
    stage = message(language, f"came_to.{turn.stage}") if has_message("en", f"came_to.{turn.stage}") else turn.stage
    yield message(
        language, "history.head", number=turn.number, turn=turn.turn, session=turn.session, at=turn.at_utc, stage=stage
    )
    yield message(language, "history.said", text=turn.text)
    parts = (intent["kind"], intent["topic"], intent["objective"], canonical(intent["constraints"] or None))
    meant = ", ".join(part for part in parts if part not in (None, "null"))
    sure = f"{intent['confidence']:.0%}"
    yield message(language, "history.understood", recogniser=turn.recogniser, sure=sure, meant=meant)
    yield tuple(message(language, "history.replied", reply=turn.reply).split("\n"))


def _language(turn: StoredTurn) -> str:
    """The operator's, as it was read then."""
    return str(turn.intent.get("language", "en"))


def _decided(store: Store, turn: StoredTurn) -> Iterator[Block]:
    """The decision as it was told then."""
    if turn.estimate is None:
        return
    language, estimate = _language(turn), estimate_of(store.content(turn.estimate))
    decision, outcome = decision_of(turn, estimate.user_names), outcome_of(turn)
    yield summary_line(decision, language)
    yield from decision_tables(report(decision, outcome), estimate, language)
    yield from (message(language, "text.note", note=note) for note in turn.notes or ())
    yield tuple(turn.explanation or ())
    if outcome is not None:
        pairs = ((outcome.owner, decision.owner), (outcome.power_w, decision.power_w))
        key = "history.as_decided" if all(np.array_equal(*pair) for pair in pairs) else "history.otherwise"
        yield message(language, key, station=outcome.base_station, power=human(float(outcome.power_w.sum()), "W"))
    if turn.restored is not None:
        power = human(float(np.sum(turn.restored["power_w"])), "W")
        yield message(language, "history.put_back", station=turn.restored["base_station"], power=power)


def _kept(turn: StoredTurn, faults: list[str]) -> Iterator[Block]:
    """How the turn is kept, and whether it still is what it was."""
    language = "en"
    if turn.is_whole:
        language = _language(turn)
        yield _seal(turn, language)
    yield message(language, "history.changed" if faults else "history.unchanged", faults="; ".join(faults))


def _seal(turn: StoredTurn, language: str) -> Block:
    platform = ", ".join(f"{part} {version}" for part, version in turn.platform.items())
    return (
        message(language, "history.setting", seed=turn.seed, version=turn.version, platform=platform),
        message(language, "history.hash", hash=turn.hash),
    )


class ReplayRecord(Record):
    """What came of doing a turn's work again."""

    number: int
    verdict: str
    same_setting: bool
    summary: str
    differences: list[str]
    decision: DecisionAnswer
    certificate: str = Field(exclude=True)
    language: str = Field(exclude=True)

    @property
    def conclusion(self) -> Conclusion:
        return "failed" if self.verdict == "different" else "done"

    def blocks(self) -> list[Block]:
        found = message(self.language, f"history.{self.verdict}")
        setting = message(self.language, "history.same_setting" if self.same_setting else "history.other_setting")
        head = message(self.language, "history.replayed", number=self.number, verdict=found, setting=setting)
        return [head, *self.differences, self.certificate]


def replay_turn(request: TurnRequest, progress: Progress) -> ReplayRecord:
    del progress
    with opened(request, archive=request.sealed) as store:
        replay = store.replay(request.number)
    language = _language(replay.turn)
    return ReplayRecord(
        number=request.number,
        verdict=replay.verdict,
        same_setting=replay.same_setting,
        summary=replay.summary,
        differences=list(replay.differences),
        decision=DecisionAnswer.of(replay.decision),
        certificate=summary_line(replay.decision, language),
        language=language,
    )


class ExportRequest(StoreOptions):
    panel = "Options"

    out: Annotated[Path, Positional()] = Field(description="file to write, JSON lines")
    session: str | None = Field(None, description="only the turns of this session")


class ExportRecord(Record):
    """The file written."""

    out: Path
    turns: int
    contents: int

    def blocks(self) -> list[Block]:
        written = f"{self.turns} turns and the {self.contents} channels that they speak of written to"
        return [Files(written, (self.out,))]


def export_turns(request: ExportRequest, progress: Progress) -> ExportRecord:
    del progress
    writable_target(request.out)
    written = {"turn": 0, "content": 0, "seal": 0}

    with opened(request) as store:
        if request.session is not None and next(store.turns(request.session, last=1), None) is None:
            check_session(store, request.session)

        def write(stream: BinaryIO) -> None:
            for line in exported(store, request.session):
                written[line["kind"]] += 1
                stream.write(json.dumps(line, ensure_ascii=False, allow_nan=False).encode() + b"\n")

        write_atomically(request.out, write)
    return ExportRecord(out=request.out, turns=written["turn"], contents=written["content"])


HISTORY = Operation(
    name="history",
    request=HistoryRequest,
    record=HistoryRecord,
    run=list_turns,
    examples=("history", "history --last 5", "history show 3"),
)

HISTORY_SHOW = Operation(
    name="history show",
    request=TurnRequest,
    record=ShowRecord,
    run=show_turn,
    examples=("history show 3",),
)

HISTORY_REPLAY = Operation(
    name="history replay",
    request=TurnRequest,
    record=ReplayRecord,
    run=replay_turn,
    examples=("history replay 3",),
)

HISTORY_EXPORT = Operation(
    name="history export",
    request=ExportRequest,
    record=ExportRecord,
    run=export_turns,
    examples=("history export turns.jsonl",),
)

"""export: a request and what came of it, from the audit store, as a document of a standard."""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast

from pydantic import Field, model_serializer

from wirelessagent.model.atomic import writable_target, write_atomically
from wirelessagent.model.errors import InputError
from wirelessagent.model.outcome import Outcome
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.record import Block, Record, Table
from wirelessagent.operations.recording import StoreOptions, opened
from wirelessagent.standards import tmf921, ts28312
from wirelessagent.standards.expectations import Expectation, expectations
from wirelessagent.standards.subject import OBSERVATION_PERIOD_S, Subject
from wirelessagent.store.content import estimate_of
from wirelessagent.store.rebuilt import decision_of, outcome_of
from wirelessagent.store.stored import StoredTurn

if TYPE_CHECKING:
    from wirelessagent.store.store import Store

Format = Literal["ts28312", "tmf921"]


class ExportRequest(StoreOptions):
    panel = "Options"

    number: Annotated[int | None, Positional()] = Field(
        None, description="number of the turn, as history lists it; the latest that decided something if not given"
    )
    format: Format = Field("ts28312", description="3GPP TS 28.312, or TM Forum's TMF921 v5: ts28312, tmf921")
    observation_period_s: int = Field(
        OBSERVATION_PERIOD_S, description="for how long the allocation is taken to hold, where energy is counted, s"
    )
    out: Path | None = Field(None, description="file to write the document to, JSON; --json prints it")


class ExportRecord(Record):
    """The document; its JSON is the standard's."""

    number: int
    format: Format
    document: dict[str, Any]
    out: Path | None
    found: list[Expectation] = Field(exclude=True)

    @model_serializer
    def _as_the_standard_has_it(self) -> dict[str, Any]:
        return self.document

    def blocks(self) -> list[Block]:
        columns = ("expectation", "target", "wanted", "promised", "achieved", "status")
        rows = tuple(_row(one) for one in self.found)
        told = f"written to {self.out}" if self.out else "--json prints the document, --out FILE writes it"
        return [Table(title=f"Turn {self.number} as {_TITLES[self.format]}", columns=columns, rows=rows), told]


_TITLES: dict[Format, str] = {"ts28312": "3GPP TS 28.312", "tmf921": "TMF921 v5"}


def _row(one: Expectation) -> tuple[str, ...]:
    relation = (">" if one.strict else "≥") if one.more_is_better else ("<" if one.strict else "≤")
    promised, achieved = ("–" if value is None else f"{value:.6g}" for value in (one.promised, one.achieved))
    wanted = f"{relation} {one.wanted:.6g} {one.metric.unit}"
    return one.name, one.metric.name, wanted, promised, achieved, one.progress


def run(request: ExportRequest, progress: Progress) -> ExportRecord:
    del progress
    if request.out is not None:
        writable_target(request.out)
    with opened(request) as store:
        turn = _decided(store, request.number)
        subject = _subject(store, turn, request.observation_period_s)
    text = _text(subject, request.format)
    if request.out is not None:
        write_atomically(request.out, lambda stream: stream.write(text.encode() + b"\n"))
    return ExportRecord(
        number=turn.number,
        format=request.format,
        document=cast("dict[str, Any]", json.loads(text)),
        out=request.out,
        found=expectations(subject),
    )


def _text(subject: Subject, standard: Format) -> str:
    if standard == "ts28312":
        return ts28312.to_json(ts28312.document(subject))
    return tmf921.to_json(tmf921.document(subject))


def _decided(store: Store, number: int | None) -> StoredTurn:
    """The turn of this number, or the latest that made a decision."""
    if number is not None:
        turn = store.turn(number)
        if not turn.decided:
            raise InputError(
                f"turn {number} decided nothing ({turn.stage}): export one that history lists a status for"
            )
        return turn
    latest: StoredTurn | None = None
    for turn in store.turns():
        latest = turn if turn.decided else latest
    if latest is None:
        raise InputError(f"no turn in {store.place} decided anything yet: ask for something first")
    return latest


def _subject(store: Store, turn: StoredTurn, observation_period_s: int) -> Subject:
    assert turn.estimate is not None
    estimate = estimate_of(store.content(turn.estimate))
    names = estimate.user_names
    return Subject(
        name=re.sub(r"[^A-Za-z0-9_.-]", "-", f"{turn.session}-{turn.turn}"),
        text=turn.text,
        language=turn.intent["language"],
        decision=decision_of(turn, names).knowing(estimate),
        outcome=outcome_of(turn),
        at=datetime.fromisoformat(turn.at_utc),
        current=_in_effect(store.turns(turn.session), turn, len(names)),
        observation_period_s=observation_period_s,
    )


def _in_effect(turns: Iterator[StoredTurn], until: StoredTurn, users: int) -> Outcome | None:
    """What the session last read back before this turn, for as many users; None where there was nothing."""
    found: Outcome | None = None
    for turn in turns:
        if turn.turn >= until.turn:
            break
        if turn.restored is not None:
            found = outcome_of(dataclasses.replace(turn, applied=turn.restored))
        elif turn.stage == "applied":
            found = outcome_of(turn)
    if found is None or found.promised_bps.size != users:
        return None
    return found


EXPORT = Operation(
    name="export",
    summary="Hand a request and what came of it on as a document of 3GPP TS 28.312 or TMF921",
    request=ExportRequest,
    record=ExportRecord,
    run=run,
)

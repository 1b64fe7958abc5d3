"""export: a request and what came of it, from the audit store, as a document of a standard."""

from __future__ import annotations

import dataclasses
import json
import re
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast

from pydantic import Field, model_serializer

from wirelessagent.model.atomic import writable_target, write_atomically
from wirelessagent.model.errors import InputError
from wirelessagent.model.outcome import Outcome
from wirelessagent.operations.fields import Advanced, Positional
from wirelessagent.operations.in_effect import Followed, followed, is_request
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.record import Block, Files, Record, Table
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
        None, description="number of the turn, as history lists it; the one that is in effect if not given"
    )
    format: Format = Field("ts28312", description="3GPP TS 28.312, or TM Forum's TMF921 v5: ts28312, tmf921")
    observation_period_s: Annotated[int, Advanced()] = Field(
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
        how = "--json prints the document, --out FILE writes it"
        told = Files("written to", (self.out,)) if self.out else how
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
        chosen = _latest(store) if request.number is None else _numbered(store, request.number)
        subject = _subject(store, chosen, request.observation_period_s)
    text = _text(subject, request.format)
    if request.out is not None:
        write_atomically(request.out, lambda stream: stream.write(text.encode() + b"\n"))
    return ExportRecord(
        number=chosen.turn.number,
        format=request.format,
        document=cast("dict[str, Any]", json.loads(text)),
        out=request.out,
        found=expectations(subject),
    )


def _text(subject: Subject, standard: Format) -> str:
    if standard == "ts28312":
        return ts28312.to_json(ts28312.document(subject))
    return tmf921.to_json(tmf921.document(subject))


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Chosen:
    """A turn to export, what was said to ask for it, and what came of it."""

    turn: StoredTurn
    asked: StoredTurn
    outcome: Outcome | None
    at_utc: str
    before: Outcome | None
    taken_back: bool = False


def _numbered(store: Store, number: int) -> _Chosen:
    """The request of this number and what came of it in that turn."""
    turn = store.turn(number).whole()
    if not turn.decided:
        raise InputError(f"turn {number} decided nothing ({turn.stage}): export one that history lists a status for")
    (found,) = (one for one in followed(store.turns(turn.session)) if one.turn.number == number)
    if not is_request(turn):
        what = "took something back" if turn.stage == "undone" else "only answered a question"
        held = None if found.after is None else found.after.request
        holds = "" if held is None else f", such as turn {held.number}, which was in effect then"
        raise InputError(f"turn {number} {what} and is no request ({turn.text!r}): export one that is{holds}")
    return _made(found)


def _made(found: Followed) -> _Chosen:
    turn, after = found.turn, found.after
    outcome = after.outcome if after is not None and after.request is turn else outcome_of(turn)
    return _Chosen(
        turn=turn,
        asked=found.asked,
        outcome=outcome,
        at_utc=turn.at_utc,
        before=None if found.before is None else found.before.outcome,
        taken_back=turn.restored is not None,
    )


def _latest(store: Store) -> _Chosen:
    """The request that is in effect in the session that asked last; its last request where none is."""
    session: str | None = None
    for turn in store.turns():
        session = turn.session if is_request(turn) else session
    if session is None:
        raise InputError(f"no turn in {store.place} decided anything yet: ask for something first")
    turns = list(followed(store.turns(session)))
    effect = turns[-1].after
    if effect is None or effect.request is None:
        return _made([one for one in turns if is_request(one.turn)][-1])
    (found,) = (one for one in turns if one.turn is effect.request)
    return dataclasses.replace(_made(found), outcome=effect.outcome, at_utc=effect.at_utc, before=effect.before)


def _subject(store: Store, chosen: _Chosen, observation_period_s: int) -> Subject:
    turn, asked = chosen.turn, chosen.asked
    assert turn.estimate is not None
    estimate = estimate_of(store.content(turn.estimate))
    names = estimate.user_names
    before = chosen.before
    return Subject(
        name=re.sub(r"[^A-Za-z0-9_.-]", "-", f"{turn.session}-{turn.turn}"),
        text=asked.text,
        language=asked.intent["language"],
        decision=decision_of(turn, names).knowing(estimate),
        outcome=chosen.outcome,
        at=datetime.fromisoformat(chosen.at_utc),
        current=before if before is not None and before.promised_bps.size == len(names) else None,
        taken_back=chosen.taken_back,
        observation_period_s=observation_period_s,
    )


EXPORT = Operation(
    name="export",
    request=ExportRequest,
    record=ExportRecord,
    run=run,
    examples=("export --json", "export 3 --format tmf921 --out intent.json"),
)

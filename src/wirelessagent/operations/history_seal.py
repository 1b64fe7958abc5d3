"""history seal: old sessions to a file, and what they saw of the channel out of the store."""

from __future__ import annotations

import contextlib
import datetime
from collections.abc import Generator
from pathlib import Path
from typing import Annotated

from pydantic import Field

from wirelessagent.model.atomic import writable_target
from wirelessagent.model.errors import InputError
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.history import check_session
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.record import Block, Files, Record
from wirelessagent.operations.recording import StoreOptions, opened
from wirelessagent.telling.catalogue import message


class SealRequest(StoreOptions):
    panel = "Options"

    out: Annotated[Path, Positional()] = Field(description="file to write the sessions to, JSON lines; keep it")
    session: str | None = Field(None, description="the session to seal")
    before: datetime.date | None = Field(
        None, description="seal every session whose last turn is older than this day (UTC), as in 2026-01-31"
    )


class SealRecord(Record):
    """The file written; ``sha256`` is what the seals in the store know it by."""

    out: Path
    sha256: str
    sessions: list[str]
    turns: int
    contents: int

    def blocks(self) -> list[Block]:
        told = message(
            "en", "history.sealed_now", sessions=len(self.sessions), turns=self.turns, contents=self.contents
        )
        return [Files(told, (self.out,)), f"SHA-256 {self.sha256}"]


def seal_sessions(request: SealRequest, progress: Progress) -> SealRecord:
    from wirelessagent.store.ledger import Ledger
    from wirelessagent.store.sealing import old_sessions, seal

    del progress
    if (request.session is None) == (request.before is None):
        raise InputError("what is to be sealed? Give --session NAME or --before DAY, one of them")
    writable_target(request.out)
    with opened(request) as store, _new_file(request.out):
        ledger = Ledger.there(request.store)
        used = set[str]() if ledger is None else {cell.data["session"] for cell in ledger.all("cell")}
        if request.session in used:
            raise InputError(
                f"the session {request.session!r} is a cell's current one: begin a new one there, or remove the cell"
            )
        if request.session is not None:
            if next(store.turns(request.session, last=1), None) is None:
                check_session(store, request.session)
            sessions = (request.session,)
        else:
            sessions = tuple(one for one in old_sessions(store, str(request.before)) if one not in used)
        done = seal(store, sessions, request.out)
        if ledger is not None:
            for session in done.sessions:
                ledger.forget_conversation(session)
            ledger.close()
    return SealRecord(
        out=request.out, sha256=done.archive, sessions=list(done.sessions), turns=done.turns, contents=done.contents
    )


@contextlib.contextmanager
def _new_file(path: Path) -> Generator[None]:
    """A file that was not there, also where somebody else seals at the same time; gone again if nothing was written.

    Raises:
        InputError: it was there.
    """
    try:
        path.open("xb").close()
    except FileExistsError:
        told = f"{path} is there already: a sealed session lives in its file, so name a new one"
        raise InputError(told) from None
    try:
        yield
    finally:
        if not path.stat().st_size:
            path.unlink()


HISTORY_SEAL = Operation(
    name="history seal",
    request=SealRequest,
    record=SealRecord,
    run=seal_sessions,
    examples=("history seal 2025.jsonl --before 2026-01-01",),
)

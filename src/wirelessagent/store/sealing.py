"""Sealing: the channels of old sessions go from the store into an export, and a seal of each stays.

Turns stay as they are, with the hashes of their channels, so the chain holds and shows what was changed. With the
export at hand, they are shown and replayed as before.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError, StoreError
from wirelessagent.store.archive import Archive
from wirelessagent.store.export import exported
from wirelessagent.store.stored import sealed

if TYPE_CHECKING:
    from wirelessagent.store.store import Store


@dataclass(frozen=True, kw_only=True)
class Sealed:
    """What was sealed.

    Attributes:
        sessions: whose turns are in the export.
        turns: how many these are.
        contents: how many channels are sealed now that were not.
        archive: SHA-256 of the export.
    """

    sessions: tuple[str, ...]
    turns: int
    contents: int
    archive: str


def old_sessions(store: Store, before_utc: str) -> tuple[str, ...]:
    """The sessions whose last turn was before a time, ISO 8601."""
    last = {turn.session: str(turn.at_utc) for turn in store.turns()}
    return tuple(session for session, at in last.items() if at < before_utc)


def seal(store: Store, sessions: Iterable[str], out: Path) -> Sealed:
    """Write sessions to a file, and let go of the channels that no other session speaks of.

    Raises:
        InputError: there is nothing to seal.
        StoreError: the store is not as it was recorded, or the file does not hold what it should; nothing was sealed.
    """
    chosen, spoken_of, others = tuple(sessions), set[str](), set[str]()
    for turn in store.turns():
        contents = spoken_of if turn.session in chosen else others
        contents.update(hash for hash in (turn.observation, turn.estimate) if hash is not None)
    going = sorted(hash for hash in spoken_of - others if store.holds(hash))
    if not going:
        raise InputError("there is nothing to seal: no channel is left that only these sessions speak of")
    for session in chosen:
        for fault in store.faults(session):
            raise StoreError(f"{fault} in the session {session!r}: nothing was sealed")

    def write(stream: BinaryIO) -> None:
        told = set[str]()
        for session in chosen:
            for line in exported(store, session, told):
                stream.write(json.dumps(line, ensure_ascii=False, allow_nan=False).encode() + b"\n")

    write_atomically(out, write)
    turns = _checked(Archive(out), going)
    with out.open("rb") as stream:
        archive = hashlib.file_digest(stream, "sha256").hexdigest()
    store.latest_schema()
    gone = store.put_seals(going, archive, chosen)
    return Sealed(sessions=chosen, turns=turns, contents=gone, archive=archive)


def _checked(archive: Archive, going: Iterable[str]) -> int:
    """How many turns the export holds, once it is known to hold them and the channels as they were recorded."""
    missing = [hash for hash in going if archive.content(hash) is None]
    turns = list(archive.turns())
    if missing or not all(sealed(turn) == turn["hash"] for turn in turns):
        raise StoreError(f"{archive.path} does not hold what was recorded: nothing was sealed; try another disk")
    return len(turns)

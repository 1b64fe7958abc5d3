"""The audit store: turns go in, each in one transaction, and stay as they are.

>>> from wirelessagent.store.store import Store
>>> with Store.open("audit.sqlite3", create=True) as store:
...     [turn.text for turn in store.turns()]
[]
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Generator, Iterable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from sqlalchemy import URL, Connection, Engine, Row, func, select, update
from sqlalchemy.exc import IntegrityError

from wirelessagent.agent.turn import Turn
from wirelessagent.model.errors import NothingRecordedError, SealedError, StoreError
from wirelessagent.store.archive import Archive
from wirelessagent.store.content import Content
from wirelessagent.store.place import migrate, opened, shown, told, url_of, version_of, writing
from wirelessagent.store.record_of import record_of
from wirelessagent.store.schema import CONTENT, SEAL, SEALS_SINCE, TURN, triggers
from wirelessagent.store.stored import StoredTurn, number_of, sealed

if TYPE_CHECKING:
    from wirelessagent.store.replay import Replay

_AT_ONCE = 100
"""Rows fetched at a time where all are read."""


class Store:
    """An open audit store. It is opened with :meth:`open` and closes as a context."""

    def __init__(self, engine: Engine, url: URL, archive: Archive | None = None) -> None:
        self._engine, self._url, self._archive = engine, url, archive

    @classmethod
    def open(cls, where: str | Path | None = None, *, create: bool = False, archive: Path | None = None) -> Store:
        """The store at a SQLAlchemy URL or in an SQLite file; where the settings say if not given.

        Args:
            where: the place.
            create: whether it is written to: it is made, or led to the latest schema, where it needs that.
            archive: an export with channels that were sealed.

        Raises:
            InputError: it is no such place.
            NothingRecordedError: there is none yet, and it is not to be made.
            StoreError: it cannot be opened or made, or is something else.
        """
        url = url_of(where)
        return cls(opened(url, create=create), url, None if archive is None else Archive(archive))

    @property
    def place(self) -> str:
        """Where it is, as people name it, without a password."""
        return shown(self._url)

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._engine.dispose()

    def append(self, turn: Turn) -> int:
        """Keep a turn, whole or not at all, and return its number in the store.

        Raises:
            StoreError: it cannot be written, or the session has a turn of this number already.
        """
        row, contents = record_of(turn)
        with told(self._url), writing(self._engine, alone=TURN) as connection:
            row["number"] = self._next_number(connection)
            row["previous"] = self._last_hash(connection, row["session"])
            row["hash"] = sealed(row)
            for content in contents:
                same = CONTENT.c.hash == content.hash
                there = connection.execute(select(func.length(CONTENT.c.data)).where(same)).scalar()
                if there is None:
                    connection.execute(CONTENT.insert(), {"hash": content.hash, "data": content.packed()})
                elif not there:  # it was sealed, and is seen again
                    connection.execute(update(CONTENT).where(same).values(data=content.packed()))
            try:
                connection.execute(TURN.insert(), row)
            except IntegrityError as error:
                raise StoreError(
                    f"turn {turn.number} of the session {turn.session!r} is recorded already in {self.place}: "
                    "nothing recorded is ever changed"
                ) from error
        return int(row["number"])

    def turns(self, session: str | None = None, *, last: int | None = None) -> Iterator[StoredTurn]:
        """The turns in the order in which they were recorded: all, those of a session, or the last so many."""
        chosen = select(TURN) if session is None else select(TURN).where(TURN.c.session == session)
        if last is not None:
            numbers = chosen.with_only_columns(TURN.c.number).order_by(TURN.c.number.desc()).limit(last)
            chosen = select(TURN).where(TURN.c.number.in_(numbers.scalar_subquery()))
        with self._reading() as connection:
            rows = connection.execution_options(yield_per=_AT_ONCE).execute(chosen.order_by(TURN.c.number))
            for row in rows:
                yield _turn(row)

    def turn(self, number: int) -> StoredTurn:
        """The turn of this number in the store.

        Raises:
            NothingRecordedError: there is none.
            StoreError: there was one.
        """
        with self._reading() as connection:
            storable = abs(number) < 1 << 63  # what a database can hold, and compare with
            row = connection.execute(select(TURN).where(TURN.c.number == number)).first() if storable else None
            if row is not None:
                return _turn(row)
            count, last = connection.execute(select(func.count(), func.max(TURN.c.number))).one()
        most = max(count, number_of(last) or 0)
        if 1 <= number <= most:
            raise StoreError(f"turn {number} is missing in {self.place}, where turns up to {most} are: it was removed")
        known = f"turns 1 to {most} are" if most else "nothing is"
        raise NothingRecordedError(f"there is no turn {number}: {known} recorded in {self.place}")

    def content(self, hash: str) -> Content:
        """The arrays of this hash.

        Raises:
            SealedError: they are in a file elsewhere.
            StoreError: they are not there, or not what was stored.
        """
        with self._reading() as connection:
            data = connection.execute(select(CONTENT.c.data).where(CONTENT.c.hash == hash)).scalar()
        if data is None:
            raise StoreError(f"the content {hash[:12]}… is missing in {self.place}")
        seal = self.seal(hash) if not data else None
        if seal is None:
            return Content.unpacked(hash, data)
        found = None if self._archive is None else self._archive.content(hash)
        if found is None:
            where = "" if self._archive is None else f" {self._archive.path} does not hold it."
            raise SealedError(
                f"this channel was sealed on {seal['sealed_utc'][:10]}: it is in the export whose SHA-256 is "
                f"{seal['archive']}.{where} Name that file with --sealed"
            )
        return found

    def seal(self, hash: str) -> dict[str, str] | None:
        """The last seal of a content; None where it has none."""
        with self._reading() as connection:
            if (version_of(connection) or 0) < SEALS_SINCE:
                return None
            row = connection.execute(select(SEAL).where(SEAL.c.hash == hash).order_by(SEAL.c.sealed_utc.desc())).first()
        return None if row is None else dict(row._mapping)  # pyright: ignore[reportPrivateUsage]  # as below

    def holds(self, hash: str) -> bool:
        """Whether the bytes of a content are here."""
        with self._reading() as connection:
            return bool(connection.execute(select(func.length(CONTENT.c.data)).where(CONTENT.c.hash == hash)).scalar())

    def put_seals(self, hashes: Iterable[str], archive: str, sessions: Collection[str]) -> int:
        """Let channels go that only these sessions speak of, and whose bytes are in the file with this SHA-256.

        How many they are; a session that has begun to speak of one meanwhile keeps it.
        """
        gone, now = 0, datetime.now(UTC).isoformat(timespec="seconds")
        with told(self._url), writing(self._engine, alone=TURN) as connection:
            for hash in hashes:
                spoken_of = (TURN.c.observation == hash) | (TURN.c.estimate == hash)
                if connection.execute(select(TURN.c.number).where(spoken_of, TURN.c.session.not_in(sessions))).first():
                    continue
                connection.execute(SEAL.insert(), {"hash": hash, "archive": archive, "sealed_utc": now})
                connection.execute(update(CONTENT).where(CONTENT.c.hash == hash).values(data=b""))
                gone += 1
        return gone

    def latest_schema(self) -> None:
        """Lead a store of an earlier schema to the latest."""
        with told(self._url):
            migrate(self._engine)

    def replay(self, number: int) -> Replay:
        """Do a turn's repair and decision again, and say how the outcome compares."""
        from wirelessagent.store.replay import replay

        return replay(self, self.turn(number))

    def faults(self, session: str | None = None) -> list[str]:
        """What was changed or removed since it was recorded, a sentence each; empty where all is as it was.

        Whoever can write to the database can remove the last turns of a session, or write all of it anew: hold its
        last hash against one that was noted elsewhere.
        """
        found = self._missing_triggers()
        last: dict[str, StoredTurn] = {}
        checked: set[str] = set()
        last_number = 0
        for turn in self.turns(session):
            name = f"turn {turn.number}"
            number = number_of(turn.number) or last_number
            if session is None and number > last_number + 1:
                found.append(f"{_named(last_number + 1, number - 1)} missing")
            before = last.get(turn.session)
            if not turn.is_whole:
                found.append(f"{name} was changed")
            if turn.previous != ("" if before is None else before.hash):
                found.append(f"{name} does not follow the turn before it in the session {turn.session!r}")
            for content in {turn.observation, turn.estimate} - checked - {None}:
                checked.add(str(content))
                found += self._content_fault(name, str(content))
            last[turn.session], last_number = turn, number
        return found

    def _content_fault(self, name: str, hash: str) -> list[str]:
        try:
            self.content(hash)
        except SealedError:
            return []
        except StoreError as error:
            return [f"{name}: {error}"]
        return []

    def _missing_triggers(self) -> list[str]:
        """The triggers that were taken away, by which turns could be changed unseen by the database."""
        table, column = {"sqlite": ("sqlite_master", "name")}.get(self._engine.dialect.name, ("pg_trigger", "tgname"))
        with self._reading() as connection:
            there = set(connection.exec_driver_sql(f"SELECT {column} FROM {table}").scalars())
            expected = triggers(self._engine.dialect.name, version_of(connection) or 0)
        return [f"the trigger {name} is missing" for name in expected if name not in there]

    @contextlib.contextmanager
    def _reading(self) -> Generator[Connection]:
        with told(self._url), self._engine.connect() as connection:
            yield connection

    def _next_number(self, connection: Connection) -> int:
        number = connection.execute(select(func.coalesce(func.max(TURN.c.number), 0) + 1)).scalar_one()
        there = connection.execute(select(func.count()).select_from(TURN)).scalar_one()
        if not isinstance(number, int) or number <= there:
            raise StoreError(f"the numbers of the turns in {self.place} were changed, so none can follow")
        return number

    @staticmethod
    def _last_hash(connection: Connection, session: str) -> str:
        before = select(TURN.c.hash).where(TURN.c.session == session).order_by(TURN.c.number.desc()).limit(1)
        return connection.execute(before).scalar() or ""


def _turn(row: Row[Any]) -> StoredTurn:
    return StoredTurn(**row._mapping)  # pyright: ignore[reportPrivateUsage]  # its public name in SQLAlchemy


def _named(first: int, last: int) -> str:
    return f"turn {first} is" if first == last else f"turns {first} to {last} are"

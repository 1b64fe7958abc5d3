"""What servers keep beside the turns, and may change: cells, sessions, plans, tokens, files. Each item has a version.

An item changes only from the version that its writer has seen, so that of two who want the same one wins, whatever
process or machine they are in. Turns are no items: they are never changed.

>>> from wirelessagent.store.ledger import Ledger
>>> ledger = Ledger.open("audit.sqlite3")
>>> ledger.put("cell", "demo", {"name": "Demo"}, seen=0)
1
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from sqlalchemy import (
    URL,
    Column,
    Connection,
    Engine,
    Integer,
    LargeBinary,
    MetaData,
    Row,
    Table,
    Text,
    delete,
    inspect,
    select,
    update,
)
from sqlalchemy.dialects import postgresql, sqlite

from wirelessagent.model.errors import StoreError
from wirelessagent.store.place import opened, shown, told, url_of, writing
from wirelessagent.store.schema import Json

_METADATA = MetaData()

_ITEM = Table(
    "service_item",
    _METADATA,
    Column("kind", Text, primary_key=True),
    Column("id", Text, primary_key=True),
    Column("version", Integer, nullable=False),
    Column("changed_utc", Text, nullable=False),
    Column("data", Json, nullable=False),
)

_BLOB = Table(
    "service_blob",
    _METADATA,
    Column("id", Text, primary_key=True),
    Column("data", LargeBinary, nullable=False),
)


class ChangedError(StoreError):
    """An item is not as its writer has seen it."""


@dataclass(frozen=True, kw_only=True)
class Item:
    """What is kept under a kind and an identifier.

    Attributes:
        version: how often it was written; 1 after the first time.
        changed_utc: when, ISO 8601.
        data: plain data.
    """

    kind: str
    id: str
    version: int
    changed_utc: str
    data: Mapping[str, Any]


class Ledger:
    """The items in the database of an audit store. It is opened with :meth:`open`."""

    def __init__(self, engine: Engine, url: URL) -> None:
        self._engine, self._url = engine, url

    @classmethod
    def open(cls, where: str | Path | None = None) -> Ledger:
        """The ledger in the store at a place, as in :meth:`.store.Store.open`; store and table are made first.

        Raises:
            InputError: it is no such place.
            StoreError: it cannot be opened or made, or is something else.
        """
        url = url_of(where)
        engine = opened(url, create=True)
        with told(url), writing(engine) as connection:
            _METADATA.create_all(connection)
        return cls(engine, url)

    @classmethod
    def there(cls, where: str | Path | None = None) -> Ledger | None:
        """The ledger in the store at a place; None where no server has used that."""
        url = url_of(where)
        engine = opened(url, create=False)
        with told(url), engine.connect() as connection:
            used = all(inspect(connection).has_table(table) for table in _METADATA.tables)
        return cls(engine, url) if used else None

    @property
    def place(self) -> str:
        """Where it is, as people name it, without a password."""
        return shown(self._url)

    def close(self) -> None:
        """Let go of the database."""
        self._engine.dispose()

    def find(self, kind: str, id: str) -> Item | None:
        """The item; None where there is none."""
        chosen = select(_ITEM).where(_ITEM.c.kind == kind, _ITEM.c.id == id)
        with told(self._url), self._engine.connect() as connection:
            row = connection.execute(chosen).first()
        return None if row is None else _item(row)

    def all(self, kind: str, *, start: str = "") -> list[Item]:
        """The items of a kind (those whose identifiers begin with ``start``) by their identifiers."""
        chosen = select(_ITEM).where(_ITEM.c.kind == kind).order_by(_ITEM.c.id)
        if start:
            chosen = chosen.where(_ITEM.c.id.startswith(start, autoescape=True))
        with told(self._url), self._engine.connect() as connection:
            return [_item(row) for row in connection.execute(chosen)]

    def put(self, kind: str, id: str, data: Mapping[str, Any], *, seen: int | None = None) -> int:
        """Write an item and return its version.

        Args:
            kind, id: the item.
            data: plain data.
            seen: the version that the writer has seen, 0 for none; None writes whatever is there.

        Raises:
            ChangedError: it has another version by now.
        """
        row = {"changed_utc": _now(), "data": dict(data)}
        same = (_ITEM.c.kind == kind, _ITEM.c.id == id)
        with told(self._url), writing(self._engine) as connection:
            if seen:
                chosen = update(_ITEM).where(*same, _ITEM.c.version == seen).values(version=seen + 1, **row)
                if not connection.execute(chosen).rowcount:
                    raise ChangedError(f"the {kind} {id!r} was changed meanwhile")
                return seen + 1
            made = _insert(connection, _ITEM).values(kind=kind, id=id, version=1, **row)
            if seen is None:
                again = {"version": _ITEM.c.version + 1, **row}
                made = made.on_conflict_do_update(index_elements=[_ITEM.c.kind, _ITEM.c.id], set_=again)
            else:
                made = made.on_conflict_do_nothing()
            version = connection.execute(made.returning(_ITEM.c.version)).scalar()
            if version is None:
                raise ChangedError(f"the {kind} {id!r} was changed meanwhile")
            return version

    def drop(self, kind: str, id: str, *, seen: int | None = None) -> bool:
        """Remove an item, if it has the version ``seen``; whether it was there."""
        chosen = delete(_ITEM).where(_ITEM.c.kind == kind, _ITEM.c.id == id)
        if seen is not None:
            chosen = chosen.where(_ITEM.c.version == seen)
        with told(self._url), writing(self._engine) as connection:
            return connection.execute(chosen).rowcount > 0

    def forget_conversation(self, session: str) -> None:
        """Remove what servers keep of a conversation beside its turns in the store."""
        own = (_ITEM.c.kind.in_(("session", "channel")) & (_ITEM.c.id == session)) | (
            (_ITEM.c.kind == "turn") & _ITEM.c.id.startswith(f"{session}/", autoescape=True)
        )
        with told(self._url), writing(self._engine) as connection:
            connection.execute(delete(_ITEM).where(own))

    def sweep(self, kind: str, *, unchanged_s: float) -> None:
        """Remove the items of a kind that nobody has written for so long."""
        before = _ITEM.c.changed_utc < _at(datetime.now(UTC) - timedelta(seconds=unchanged_s))
        with told(self._url), writing(self._engine) as connection:
            connection.execute(delete(_ITEM).where(_ITEM.c.kind == kind, before))

    def put_blob(self, id: str, data: bytes) -> None:
        """Keep a file's bytes under an identifier that nothing else has."""
        with told(self._url), writing(self._engine) as connection:
            connection.execute(_BLOB.insert().values(id=id, data=data))

    def blob(self, id: str) -> bytes | None:
        """The bytes of a file; None where there is none."""
        with told(self._url), self._engine.connect() as connection:
            return connection.execute(select(_BLOB.c.data).where(_BLOB.c.id == id)).scalar()

    def drop_blob(self, id: str) -> None:
        """Remove a file's bytes."""
        with told(self._url), writing(self._engine) as connection:
            connection.execute(delete(_BLOB).where(_BLOB.c.id == id))


def _now() -> str:
    return _at(datetime.now(UTC))


def _at(time: datetime) -> str:
    return time.isoformat(timespec="milliseconds")


def _insert(connection: Connection, table: Table) -> sqlite.Insert | postgresql.Insert:
    """An insertion that says what to do where the row is there."""
    return (postgresql if connection.dialect.name == "postgresql" else sqlite).insert(table)


def _item(row: Row[Any]) -> Item:
    return Item(**row._mapping)  # pyright: ignore[reportPrivateUsage]  # its public name in SQLAlchemy

"""What a server keeps beside the turns, and may change: cells, sessions, plans, tokens. Each item has a version.

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
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sqlalchemy import URL, Column, Engine, Integer, MetaData, Row, Table, Text, delete, insert, inspect, select, update
from sqlalchemy.exc import IntegrityError

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
            if not inspect(connection).has_table(_ITEM.name):
                _METADATA.create_all(connection)
        return cls(engine, url)

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
        row = {"changed_utc": datetime.now(UTC).isoformat(timespec="milliseconds"), "data": dict(data)}
        with told(self._url), writing(self._engine) as connection:
            there = select(_ITEM.c.version).where(_ITEM.c.kind == kind, _ITEM.c.id == id)
            version = connection.execute(there).scalar() or 0
            if seen is not None and version != seen:
                raise ChangedError(f"the {kind} {id!r} was changed meanwhile")
            if version:
                same = (_ITEM.c.kind == kind, _ITEM.c.id == id)
                connection.execute(update(_ITEM).where(*same).values(version=version + 1, **row))
            else:
                try:
                    connection.execute(insert(_ITEM).values(kind=kind, id=id, version=1, **row))
                except IntegrityError as error:
                    raise ChangedError(f"the {kind} {id!r} was changed meanwhile") from error
        return version + 1

    def drop(self, kind: str, id: str, *, seen: int | None = None) -> bool:
        """Remove an item, if it has the version ``seen``; whether it was there."""
        chosen = delete(_ITEM).where(_ITEM.c.kind == kind, _ITEM.c.id == id)
        if seen is not None:
            chosen = chosen.where(_ITEM.c.version == seen)
        with told(self._url), writing(self._engine) as connection:
            return connection.execute(chosen).rowcount > 0


def _item(row: Row[Any]) -> Item:
    return Item(**row._mapping)  # pyright: ignore[reportPrivateUsage]  # its public name in SQLAlchemy

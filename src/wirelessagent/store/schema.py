"""The tables of the audit store and the triggers that keep what is in them.

Rows are added and never changed: triggers refuse UPDATE, DELETE and, on PostgreSQL, TRUNCATE. SQLite lets a row be
replaced without asking its DELETE triggers, so a third one refuses to insert what is there already. One change is let
through: a channel's bytes may go once a seal says in which file they are. Turns name channels by their hashes, so the
chain of turns holds as before.

A store has a row in ``audit_schema`` for each schema that it has had, the last one counts. :data:`STEPS` lead from one
schema to the next; whoever writes takes them, whoever reads needs none.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from sqlalchemy import (
    DDL,
    BigInteger,
    Column,
    Connection,
    Dialect,
    Double,
    ForeignKey,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    Text,
    TypeDecorator,
    UniqueConstraint,
    event,
)

from wirelessagent.store.plain import canonical
from wirelessagent.store.stored import Unreadable

SCHEMA_VERSION = 2


class Json(TypeDecorator[Any]):
    """Plain data as its canonical text, so that a row has one hash whatever database holds it."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: Any, dialect: Dialect) -> str | None:
        return None if value is None else canonical(value)

    def process_result_value(self, value: Any, dialect: Dialect) -> Any:
        try:
            return None if value is None else json.loads(value)
        except (ValueError, TypeError, RecursionError):
            return Unreadable(value)


METADATA = MetaData()

SCHEMA = Table(
    "audit_schema",
    METADATA,
    Column("version", Integer, primary_key=True, autoincrement=False),
    Column("package_version", Text, nullable=False),
    Column("made_utc", Text, nullable=False),
)

CONTENT = Table(
    "audit_content",
    METADATA,
    Column("hash", Text, primary_key=True),
    Column("data", LargeBinary, nullable=False),
)

TURN = Table(
    "audit_turn",
    METADATA,
    Column("number", BigInteger, primary_key=True, autoincrement=False),
    Column("session", Text, nullable=False),
    Column("turn", BigInteger, nullable=False),
    Column("at_utc", Text, nullable=False),
    Column("text", Text, nullable=False),
    Column("intent", Json, nullable=False),
    Column("recogniser", Text, nullable=False),
    Column("reply", Text, nullable=False),
    Column("stage", Text, nullable=False),
    Column("seed", Json, nullable=False),
    Column("version", Text, nullable=False),
    Column("platform", Json, nullable=False),
    Column("objective", Text),
    Column("facts", Json),
    Column("observation", Text, ForeignKey("audit_content.hash")),
    Column("repairer", Json),
    Column("estimate", Text, ForeignKey("audit_content.hash")),
    Column("problem", Json),
    Column("cell", Json),
    Column("method", Json),
    Column("status", Text),
    Column("value", Double),
    Column("bound", Double),
    Column("gap", Double),
    Column("unit", Text),
    Column("allocation", Json),
    Column("certificate", Json),
    Column("applied", Json),
    Column("restored", Json),
    Column("notes", Json),
    Column("explanation", Json),
    Column("previous", Text, nullable=False),
    Column("hash", Text, nullable=False, unique=True),
    UniqueConstraint("session", "turn"),
)

SEAL = Table(
    "audit_seal",
    METADATA,
    Column("hash", Text, ForeignKey("audit_content.hash"), primary_key=True),
    Column("archive", Text, primary_key=True),
    Column("sealed_utc", Text, nullable=False),
)
"""Channels whose bytes are in a file elsewhere, ``archive`` by its SHA-256."""

_REFUSAL = "the audit store is append-only"

_SQLITE = """
CREATE TRIGGER {table}_no_{name} BEFORE {event} ON {table} {when}
BEGIN SELECT RAISE(ABORT, '{refusal}'); END
"""

_SQLITE_THERE = "WHEN EXISTS (SELECT 1 FROM {table} WHERE {key} = NEW.{key}{more})"

_POSTGRESQL_FUNCTION = """
CREATE OR REPLACE FUNCTION audit_refuse() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN RAISE EXCEPTION '{refusal}'; END $$
"""

_POSTGRESQL = """
CREATE TRIGGER {table}_no_{name} BEFORE {event} ON {table} FOR EACH {each} EXECUTE FUNCTION audit_refuse()
"""

_SEALED = (
    "NEW.hash = OLD.hash AND ({length}(OLD.data) = 0 OR ({length}(NEW.data) = 0 AND EXISTS "
    "(SELECT 1 FROM audit_seal WHERE hash = OLD.hash)))"
)
"""The change of a channel that is let through: it goes once it is sealed, and comes again where it is seen again."""

_SQLITE_SEALED = f"WHEN NOT ({_SEALED.format(length='length')})"

_POSTGRESQL_SEALED = f"""
CREATE OR REPLACE FUNCTION audit_refuse_unless_sealed() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN IF {_SEALED.format(length="octet_length")} THEN RETURN NEW; END IF; RAISE EXCEPTION '{_REFUSAL}'; END $$
"""

_GUARDED = {
    SCHEMA: ("version", ""),
    CONTENT: ("hash", ""),
    TURN: ("number", " OR hash = NEW.hash OR (session = NEW.session AND turn = NEW.turn)"),
    SEAL: ("hash", " AND archive = NEW.archive"),
}
"""The tables, each with its key and what else is unique in it."""

SEALS_SINCE = 2
"""The schema that brought seals."""


def triggers(dialect: str, version: int = SCHEMA_VERSION) -> list[str]:
    """The names of the triggers that a database of this dialect and schema has."""
    third = "replace" if dialect == "sqlite" else "truncate"
    there = [table for table in _GUARDED if table is not SEAL or version >= SEALS_SINCE]
    return [f"{table.name}_no_{name}" for table in there for name in ("update", "delete", third)]


def _seals(connection: Connection) -> None:
    """From 1 to 2: channels can be sealed."""
    SEAL.create(connection)
    on = "" if connection.dialect.name == "sqlite" else f" ON {CONTENT.name}"
    connection.exec_driver_sql(f"DROP TRIGGER {CONTENT.name}_no_update{on}")
    for text in _updates_of_content(connection.dialect.name):
        connection.exec_driver_sql(text)


STEPS: dict[int, Callable[[Connection], None]] = {SEALS_SINCE: _seals}
"""What leads to a schema from the one before."""


def _updates_of_content(dialect: str) -> list[str]:
    """The statements that guard channels against every change but the one after a seal."""
    name = {"table": CONTENT.name, "name": "update"}
    if dialect == "sqlite":
        return [_SQLITE.format(**name, event="UPDATE", when=_SQLITE_SEALED, refusal=_REFUSAL)]
    guard = _POSTGRESQL.format(**name, event="UPDATE", each="ROW").replace(
        "audit_refuse()", "audit_refuse_unless_sealed()"
    )
    return [_POSTGRESQL_SEALED, guard]


def _guard(table: Table, key: str, more: str) -> None:
    """Have the table's triggers made right after the table."""
    there = _SQLITE_THERE.format(table=table.name, key=key, more=more)
    changed = _SQLITE_SEALED if table is CONTENT else ""
    for name, what, when in (("update", "UPDATE", changed), ("delete", "DELETE", ""), ("replace", "INSERT", there)):
        text = _SQLITE.format(table=table.name, name=name, event=what, when=when, refusal=_REFUSAL)
        event.listen(table, "after_create", DDL(text).execute_if(dialect="sqlite"))
    function = DDL(_POSTGRESQL_FUNCTION.format(refusal=_REFUSAL))
    event.listen(table, "after_create", function.execute_if(dialect="postgresql"))
    for name, each in (("update", "ROW"), ("delete", "ROW"), ("truncate", "STATEMENT")):
        if table is CONTENT and name == "update":
            for text in _updates_of_content("postgresql"):
                event.listen(table, "after_create", DDL(text).execute_if(dialect="postgresql"))
            continue
        text = _POSTGRESQL.format(table=table.name, name=name, event=name.upper(), each=each)
        event.listen(table, "after_create", DDL(text).execute_if(dialect="postgresql"))


for _table, (_key, _more) in _GUARDED.items():
    _guard(_table, _key, _more)

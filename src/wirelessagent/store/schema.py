"""The tables of the audit store and the triggers that keep what is in them.

Rows are added and never changed: triggers refuse UPDATE, DELETE and, on PostgreSQL, TRUNCATE. SQLite lets a row be
replaced without asking its DELETE triggers, so a third one refuses to insert what is there already.
"""

from __future__ import annotations

import json
from typing import Any

from sqlalchemy import (
    DDL,
    BigInteger,
    Column,
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

SCHEMA_VERSION = 1


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

_GUARDED = {
    SCHEMA: ("version", ""),
    CONTENT: ("hash", ""),
    TURN: ("number", " OR hash = NEW.hash OR (session = NEW.session AND turn = NEW.turn)"),
}
"""The tables, each with its key and what else is unique in it."""


def triggers(dialect: str) -> list[str]:
    """The names of the triggers that a database of this dialect has."""
    third = "replace" if dialect == "sqlite" else "truncate"
    return [f"{table.name}_no_{name}" for table in _GUARDED for name in ("update", "delete", third)]


def _guard(table: Table, key: str, more: str) -> None:
    """Have the table's triggers made right after the table."""
    there = _SQLITE_THERE.format(table=table.name, key=key, more=more)
    for name, what, when in (("update", "UPDATE", ""), ("delete", "DELETE", ""), ("replace", "INSERT", there)):
        text = _SQLITE.format(table=table.name, name=name, event=what, when=when, refusal=_REFUSAL)
        event.listen(table, "after_create", DDL(text).execute_if(dialect="sqlite"))
    function = DDL(_POSTGRESQL_FUNCTION.format(refusal=_REFUSAL))
    event.listen(table, "after_create", function.execute_if(dialect="postgresql"))
    for name, each in (("update", "ROW"), ("delete", "ROW"), ("truncate", "STATEMENT")):
        text = _POSTGRESQL.format(table=table.name, name=name, event=name.upper(), each=each)
        event.listen(table, "after_create", DDL(text).execute_if(dialect="postgresql"))


for _table, (_key, _more) in _GUARDED.items():
    _guard(_table, _key, _more)

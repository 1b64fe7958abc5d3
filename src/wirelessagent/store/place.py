"""Where the audit store is: found, made privately, opened, and known for one of ours before anything is written.

SQLite runs in WAL mode with ``synchronous=FULL``: what is committed is on the disk, a process that is killed leaves
nothing half done, and readers never wait. A transaction that writes begins with IMMEDIATE, so that two processes take
turns instead of failing half way.
"""

from __future__ import annotations

import contextlib
import os
import re
import sqlite3
import time
from collections.abc import Callable, Generator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote

import platformdirs
from sqlalchemy import URL, Connection, Engine, Table, create_engine, event, inspect, make_url, select
from sqlalchemy.exc import ArgumentError, DataError, DBAPIError, NoSuchModuleError, OperationalError, SQLAlchemyError
from sqlalchemy.pool import NullPool

from wirelessagent import __version__
from wirelessagent.model.errors import InputError, NothingRecordedError, StoreError
from wirelessagent.settings import Settings
from wirelessagent.store.schema import METADATA, SCHEMA, SCHEMA_VERSION, STEPS

_PATIENCE_S = 10.0
"""How long a writer waits for another."""

_BEGIN = "wirelessagent_begin"
"""The execution option that says how a transaction begins on SQLite."""


def url_of(where: str | Path | None) -> URL:
    """The URL of a store named by a URL or a file; as the settings say, or in the user's data folder, if not given.

    Raises:
        InputError: it is no URL, or of a database that cannot hold a store.
    """
    named = str(where or Settings.read().store_url or platformdirs.user_data_path("wirelessagent") / "audit.sqlite3")
    if "://" not in named:
        return URL.create("sqlite", database=str(_absolute(named)))
    try:
        url = make_url(named)
        url.get_dialect()
    except (ArgumentError, NoSuchModuleError, ValueError) as error:  # ValueError: a port that is no number
        place, why = _unsecret(named), _unsecret(str(error))
        raise InputError(f"the audit store cannot be at {place!r}: {why}; name a file or a SQLAlchemy URL") from error
    if url.get_backend_name() not in ("sqlite", "postgresql"):
        raise InputError(
            f"the audit store cannot be at {shown(url)}: only SQLite and PostgreSQL are known to keep it append-only"
        )
    if url.get_backend_name() == "sqlite" and file_of(url) is None:
        raise InputError(
            f"the audit store needs a file; got {_unsecret(named)!r}: as in sqlite:////var/lib/audit.sqlite3"
        )
    if url.get_backend_name() == "sqlite" and (url.query or url.get_driver_name() != "pysqlite"):
        raise InputError(
            f"the audit store takes an SQLite file without options or another driver; got {_unsecret(named)!r}: as in "
            "sqlite:////var/lib/audit.sqlite3"
        )
    return url


def _unsecret(named: str) -> str:
    """A URL without its password, also where it is none that could be parsed."""
    return re.sub(r"(password=)[^&]*", r"\1***", re.sub(r"(://[^:/@]*):.*@", r"\1:***@", named))


def _absolute(path: str) -> Path:
    try:
        return Path(path).expanduser().absolute()
    except RuntimeError as error:  # nobody's home
        raise StoreError(f"the audit store cannot be at {path}: {error}; name another place") from error


def shown(url: URL) -> str:
    """The place as people name it: a file by its path, anything else without its password."""
    path = file_of(url)
    return _unsecret(url.render_as_string(hide_password=True)) if path is None else str(path)


def file_of(url: URL) -> Path | None:
    """The file of an SQLite database; None for another database, or one without a file."""
    if url.get_backend_name() != "sqlite" or url.database in (None, "", ":memory:"):
        return None
    return None if str(url.database).startswith("file:") else Path(str(url.database))


def opened(url: URL, *, create: bool) -> Engine:
    """The store's engine, once it is known to be a store of this schema; made first where ``create`` says so.

    Raises:
        NothingRecordedError: there is none and it is not to be made.
        StoreError: it cannot be opened or made, or is something else.
    """
    with told(url):
        path = file_of(url)
        if path is not None:
            _prepare_file(path, create=create)
        engine = _engine(url)
        try:
            _patiently(lambda: _check(engine, create=create))
        except OperationalError:
            if create or path is None or not _is_settled(path):
                raise
            engine = _engine_that_writes_nothing(path)
            _check(engine, create=False)
        return engine


@contextlib.contextmanager
def told(url: URL) -> Generator[None]:
    """Have what a database or a disk refuses told in one sentence."""
    try:
        yield
    except ImportError as error:
        raise StoreError(f"the audit store at {shown(url)} needs a driver that is not installed: {error}") from error
    except OSError as error:
        said = f"{error.strerror or error}: {error.filename or ''}".strip(": ")
        raise StoreError(f"the audit store at {shown(url)} cannot be used: {said}") from error
    except (DataError, UnicodeEncodeError) as error:
        said = " ".join(str(error.orig if isinstance(error, DataError) else error).split())
        raise InputError(f"a text or number here is one that no audit store can keep: {said}; leave it out") from error
    except SQLAlchemyError as error:
        said = " ".join(str(error.orig if isinstance(error, DBAPIError) else error).split())
        damaged = any(sign in said for sign in ("malformed", "not a database", "disk image"))
        how = "; nothing was changed: move it away, or name another store" if damaged else ""
        raise StoreError(f"the audit store at {shown(url)} cannot be used: {said}{how}") from error


@contextlib.contextmanager
def writing(engine: Engine, alone: Table | None = None) -> Generator[Connection]:
    """A transaction that writes, on SQLite or where ``alone`` names a table as the only one; an error undoes it."""
    with engine.connect().execution_options(**{_BEGIN: "BEGIN IMMEDIATE"}) as connection, connection.begin():
        if engine.dialect.name == "postgresql" and alone is not None:
            connection.exec_driver_sql(f"LOCK TABLE {alone.name} IN EXCLUSIVE MODE")
        yield connection


def _prepare_file(path: Path, *, create: bool) -> None:
    """Make sure of a file that only its owner can read."""
    if not create:
        if not path.exists():
            raise NothingRecordedError(f"nothing is recorded yet: there is no audit store at {path}")
        return
    if path.parent == platformdirs.user_data_path("wirelessagent"):
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    if path.is_dir():
        raise StoreError(f"the audit store cannot be at {path}: that is a folder; name a file in it")
    os.close(os.open(path, os.O_RDWR | os.O_CREAT, 0o600))


def _engine(url: URL) -> Engine:
    if url.get_backend_name() != "sqlite":
        return create_engine(url, pool_pre_ping=True)  # a database that was started again has ended them all
    engine = create_engine(url, connect_args={"timeout": _PATIENCE_S})
    event.listen(engine, "connect", _set_up)
    event.listen(engine, "begin", _begin)
    return engine


def _engine_that_writes_nothing(path: Path) -> Engine:
    """For reading where even a reader's own files cannot be made: on a full disk, or a read-only file system."""
    place = f"file:{quote(str(path))}?mode=ro&immutable=1"
    engine = create_engine("sqlite://", creator=lambda: sqlite3.connect(place, uri=True), poolclass=NullPool)
    event.listen(engine, "connect", _set_up)
    event.listen(engine, "begin", _begin)
    return engine


def _is_settled(path: Path) -> bool:
    """Whether the file is all there is: what was committed last is in a file beside it until that is taken over."""
    beside = Path(f"{path}-wal")
    return path.is_file() and not (beside.is_file() and beside.stat().st_size > 0)


def _set_up(connection: Any, _: object) -> None:
    """Leave transactions to us, and take no commit for done before it is on the disk."""
    connection.isolation_level = None
    connection.text_factory = _text
    connection.execute("PRAGMA synchronous=FULL")
    connection.execute("PRAGMA foreign_keys=ON")


def _text(held: bytes) -> str | bytes:
    """Text as it is; bytes where a column was changed to something that is no text, for its reader to tell."""
    try:
        return held.decode()
    except UnicodeDecodeError:
        return held


def _begin(connection: Connection) -> None:
    how = connection.get_execution_options().get(_BEGIN, "BEGIN")
    if how:
        connection.exec_driver_sql(how)


def _patiently(check: Callable[[], None]) -> None:
    """Do it again while another process that makes the same store holds it: SQLite does not wait for that by itself."""
    until = time.monotonic() + _PATIENCE_S
    while True:
        try:
            check()
        except DBAPIError as error:
            if "locked" not in str(error.orig) or time.monotonic() > until:
                raise
            time.sleep(0.02)
        else:
            return


def _check(engine: Engine, *, create: bool) -> None:
    """Refuse what is not a store that can be read; for whoever writes, make it one of the latest schema."""
    with engine.connect() as connection:
        version = version_of(connection)
    if version is None and not create:
        raise NothingRecordedError(f"nothing is recorded yet in {shown(engine.url)}")
    if create and version != SCHEMA_VERSION:
        migrate(engine)


def migrate(engine: Engine) -> None:
    """Make a store where nothing is, or lead the one that is there to the latest schema."""
    if engine.dialect.name == "sqlite":
        with engine.connect().execution_options(**{_BEGIN: ""}) as connection:
            connection.exec_driver_sql("PRAGMA journal_mode=WAL")
    with writing(engine) as connection:
        if engine.dialect.name == "postgresql":
            connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock(hashtext('{SCHEMA.name}'))")
        there = version_of(connection)  # another process may have been faster
        if there is None:
            METADATA.create_all(connection)
            there = SCHEMA_VERSION - 1
        else:
            for version in range(there + 1, SCHEMA_VERSION + 1):
                STEPS[version](connection)
        if there < SCHEMA_VERSION:
            now = datetime.now(UTC).isoformat(timespec="seconds")
            row = {"version": SCHEMA_VERSION, "package_version": __version__, "made_utc": now}
            connection.execute(SCHEMA.insert(), row)


def version_of(connection: Connection) -> int | None:
    """The schema of a store; None where the database holds nothing that could be meant to be one.

    Raises:
        StoreError: it holds something else, or a store of a newer schema.
    """
    place = shown(connection.engine.url)
    tables = set(inspect(connection).get_table_names())
    if SCHEMA.name not in tables:
        foreign = tables if connection.dialect.name == "sqlite" else tables & set(METADATA.tables)
        if foreign:
            raise StoreError(
                f"{place} is not an audit store but a database with the tables {', '.join(sorted(foreign)[:5])}; "
                "nothing was changed: name another store"
            )
        return None
    rows = connection.execute(select(SCHEMA.c.version, SCHEMA.c.package_version).order_by(SCHEMA.c.version)).all()
    version, package = rows[-1] if rows else ("none", "?")
    if not isinstance(version, int) or not 1 <= version <= SCHEMA_VERSION:
        raise StoreError(
            f"the audit store at {place} has the schema version {version}, made by wirelessagent {package}, and this "
            f"one ({__version__}) knows those up to {SCHEMA_VERSION}; nothing was changed: use the newer one, or name "
            "another store"
        )
    return version

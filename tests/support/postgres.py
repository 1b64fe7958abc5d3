"""A PostgreSQL of the tests' own: the system's programs, run as another user where we are root."""

from __future__ import annotations

import contextlib
import os
import pwd
import secrets
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import pytest

_FOLDERS = [None, *map(str, sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True))]


def program(name: str) -> str | None:
    """Where a program of PostgreSQL is; None where there is none."""
    return next(filter(None, (shutil.which(name, path=folder) for folder in _FOLDERS)), None)


@contextlib.contextmanager
def running() -> Iterator[str]:
    """The URL of a database in a new cluster, until the end of the context.

    Its folder is none of pytest's, which are closed to other users and swept by other runs.
    """
    user, folder = _user(), Path(tempfile.mkdtemp(prefix="wirelessagent-postgresql-"))
    data = folder / "data"
    if user is not None:
        os.chown(folder, user.pw_uid, user.pw_gid)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    url, said = f"postgresql+psycopg://agent@127.0.0.1:{port}/postgres", folder / "said"
    options = ("listen_addresses=127.0.0.1", "unix_socket_directories=", "fsync=off")
    try:
        with said.open("wb") as log:
            made = _started(
                log, user, "initdb", "-D", str(data), "-U", "agent", "-A", "trust", "-E", "UTF8", "--no-sync"
            )
            assert made.wait(120) == 0
            server = _started(
                log, user, "postgres", "-D", str(data), "-p", str(port), *(f"-c{option}" for option in options)
            )
        try:
            _wait(url, server)
            yield url
            assert server.poll() is None  # it did not end by itself
        finally:
            server.send_signal(signal.SIGQUIT)  # end at once
            server.wait(120)
    except BaseException as error:
        error.add_note(said.read_text())
        raise
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextlib.contextmanager
def running_or_skipped() -> Iterator[str]:
    """The same, or a skip where PostgreSQL or its driver is not here."""
    pytest.importorskip("psycopg")
    if program("initdb") is None:
        pytest.skip("there is no PostgreSQL here")
    with running() as url:
        yield url


def new_database(cluster: str) -> str:
    """The URL of an empty database in a cluster."""
    import psycopg

    name = f"test_{secrets.token_hex(4)}"
    with psycopg.connect(plain(cluster), autocommit=True) as connection:
        connection.execute(f"CREATE DATABASE {name}".encode())
    return f"{cluster.rsplit('/', 1)[0]}/{name}"


def plain(url: str) -> str:
    """A database's URL as PostgreSQL's own programs take it."""
    return url.replace("+psycopg", "")


def _user() -> pwd.struct_passwd | None:
    """Whom to run it as: somebody else where we are root, who may not."""
    if os.geteuid() != 0:
        return None
    known = {one.pw_name: one for one in pwd.getpwall()}
    return known.get("postgres") or known["nobody"]


def _started(log: IO[bytes], user: pwd.struct_passwd | None, name: str, *arguments: str) -> subprocess.Popen[bytes]:
    command = program(name)
    assert command is not None
    who = {} if user is None else {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
    return subprocess.Popen(
        [command, *arguments], stdout=log, stderr=subprocess.STDOUT, cwd="/",
        env={"PATH": os.environ["PATH"], "LANG": "C.UTF-8", "HOME": "/tmp"}, **who,  # type: ignore[arg-type]
    )  # fmt: skip


def _wait(url: str, server: subprocess.Popen[bytes]) -> None:
    """Until it answers."""
    import psycopg

    until = time.monotonic() + 120
    while True:
        try:
            return psycopg.connect(plain(url)).close()
        except psycopg.OperationalError:
            if server.poll() is not None or time.monotonic() > until:
                raise
            time.sleep(0.1)

"""A PostgreSQL of the tests' own: the system's programs, run as another user where we are root."""

from __future__ import annotations

import contextlib
import os
import pwd
import secrets
import shutil
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

_FOLDERS = [None, *map(str, sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True))]


def program(name: str) -> str | None:
    """Where a program of PostgreSQL is; None where there is none."""
    return next(filter(None, (shutil.which(name, path=folder) for folder in _FOLDERS)), None)


@contextlib.contextmanager
def running(folder: Path) -> Iterator[str]:
    """The URL of a database in a new cluster, until the end of the context."""
    user = _user()
    folder.mkdir(parents=True)
    data = folder / "data"
    if user is not None:
        for above in (folder, *folder.parents):
            if above.is_relative_to("/tmp") and above != Path("/tmp"):
                above.chmod(0o755)
        os.chown(folder, user.pw_uid, user.pw_gid)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    _do(user, program("initdb"), "-D", str(data), "-U", "agent", "-A", "trust", "-E", "UTF8", "--no-sync")
    options = f"-p {port} -c listen_addresses=127.0.0.1 -c unix_socket_directories= -c fsync=off"
    _do(user, program("pg_ctl"), "-D", str(data), "-w", "-o", options, "-l", str(folder / "log"), "start")
    try:
        yield f"postgresql+psycopg://agent@127.0.0.1:{port}/postgres"
    finally:
        with contextlib.suppress(subprocess.CalledProcessError):  # it may have ended, or be slow to: it is nobody's
            _do(user, program("pg_ctl"), "-D", str(data), "-m", "immediate", "stop")


@contextlib.contextmanager
def running_or_skipped(folder: Path) -> Iterator[str]:
    """The same, or a skip where PostgreSQL or its driver is not here."""
    pytest.importorskip("psycopg")
    if program("initdb") is None:
        pytest.skip("there is no PostgreSQL here")
    with running(folder) as url:
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


def _do(user: pwd.struct_passwd | None, command: str | None, *arguments: str) -> None:
    assert command is not None
    who = {} if user is None else {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
    subprocess.run(
        [command, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, cwd="/",
        env={"PATH": os.environ["PATH"], "LANG": "C.UTF-8", "HOME": "/tmp"}, **who,  # type: ignore[arg-type]
    )  # fmt: skip

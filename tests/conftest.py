"""No test may speak to the network (servers on this machine are none), compile, or record among the user's turns."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import postgres
import pytest
from hypothesis import settings

settings.register_profile("untimed", deadline=None)  # what is slow on a busy machine is no fault
settings.load_profile("untimed")

os.environ.setdefault("WIRELESSAGENT_COMPILE", "never")  # the machine code that is there is used, the rest interpreted


@pytest.fixture(autouse=True, scope="session")
def _no_network() -> Iterator[None]:
    def guarded(self: socket.socket, address: Any) -> None:
        here = self.family == getattr(socket, "AF_UNIX", None) or address[0] in ("127.0.0.1", "::1", "localhost")
        if not here:
            raise RuntimeError(f"a test tried to connect to {address!r}")
        connect(self, address)

    with pytest.MonkeyPatch.context() as patch:
        connect = socket.socket.connect
        patch.setattr(socket.socket, "connect", guarded)
        yield


@pytest.fixture(autouse=True, scope="session")
def _own_store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """An audit store of the suite's own, for this process and those that it starts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(os.environ, "WIRELESSAGENT_STORE_URL", str(tmp_path_factory.mktemp("store") / "audit.sqlite3"))
        yield


@pytest.fixture(scope="session")
def cluster() -> Iterator[str]:
    """The URL of a PostgreSQL."""
    with postgres.running_or_skipped() as url:
        yield url


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Where a store may be."""
    if request.param == "sqlite":
        return str(tmp_path / "store.sqlite3")
    return postgres.new_database(request.getfixturevalue("cluster"))

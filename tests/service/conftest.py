"""A server of this package as its own process, as an operator starts it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from servers import Server, Signed, started


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server on a demonstration cell that only this machine reaches, without tokens."""
    with started(tmp_path_factory.mktemp("server") / "store.sqlite3") as server:
        yield server


@pytest.fixture(scope="session")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Signed]:
    """A server whose callers have tokens."""
    store: Path = tmp_path_factory.mktemp("guarded") / "store.sqlite3"
    with Signed.started(store) as signed:
        yield signed

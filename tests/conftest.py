"""What holds for the whole suite: nothing is recorded among the user's own turns."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session", autouse=True)
def audit_store(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """An audit store of the suite's own, for this process and those that it starts."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(os.environ, "WIRELESSAGENT_STORE_URL", str(tmp_path_factory.mktemp("store") / "audit.sqlite3"))
        yield

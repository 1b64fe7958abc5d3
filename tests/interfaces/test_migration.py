"""A store that was written before there was a service is read, checked, replayed and carried on.

The two files were written by the commit before (05529ef8): a conversation about a channel from a file, one about a
simulated cell. The one of PostgreSQL is what pg_dump made of it.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import postgres
import pytest
from sqlalchemy import create_engine

from wirelessagent.interfaces.cli import run
from wirelessagent.store.ledger import Ledger
from wirelessagent.store.schema import SCHEMA_VERSION
from wirelessagent.store.sealing import seal
from wirelessagent.store.store import Store

pytestmark = pytest.mark.machine_code

STORES = Path(__file__).parent.parent / "stores"


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Such a store."""
    if request.param == "sqlite":
        shutil.copy(STORES / "before_the_service.sqlite3", tmp_path / "store.sqlite3")
        return str(tmp_path / "store.sqlite3")
    url = postgres.new_database(request.getfixturevalue("cluster"))
    with pytest.importorskip("psycopg").connect(postgres.plain(url)) as connection:
        connection.execute((STORES / "before_the_service.postgresql.sql").read_bytes())
    return url


def versions(place: str) -> list[int]:
    """The schemas that a store has had."""
    engine = create_engine(place if "://" in place else f"sqlite:///{place}")
    with engine.connect() as connection:
        found = connection.exec_driver_sql("SELECT version FROM audit_schema ORDER BY version").scalars().all()
    engine.dispose()
    return list(found)


def test_it_is_read_checked_and_replayed_and_left_as_it_is(place: str) -> None:
    with Store.open(place) as store:
        turns = list(store.turns())
        assert [turn.stage for turn in turns[:4]] == ["planned", "planned", "answered", "undone"]
        assert store.faults() == []
        for turn in turns:
            assert turn.is_whole
            if turn.decided:
                assert store.replay(turn.number).verdict in ("identical", "close"), turn.number
    assert versions(place) == [1]


def test_it_is_carried_on(place: str, tmp_path: Path) -> None:
    command = ["--store", place, "--seed", "3", "--say", "highest total rate, at most 10 W"]
    assert run(["chat", *command]) in (0, 2)
    ledger = Ledger.open(place)
    ledger.put("cell", "one", {"session": "none"}, seen=0)
    ledger.close()
    assert versions(place) == list(range(1, SCHEMA_VERSION + 1))
    with Store.open(place) as store:
        assert [turn.number for turn in store.turns()] == [1, 2, 3, 4, 5, 6, 7]
        assert store.faults() == []
        old = store.turn(1).session
        assert seal(store, [old], tmp_path / "old.jsonl").contents > 0
        assert store.faults() == []
    assert run(["history", "replay", "1", "--store", place, "--sealed", str(tmp_path / "old.jsonl")]) == 0
    assert run(["export", "5", "--store", place]) == 0


def test_sealing_alone_leads_it_to_the_latest_schema(place: str, tmp_path: Path) -> None:
    with Store.open(place) as store:
        seal(store, [store.turn(5).session], tmp_path / "old.jsonl")
        assert store.faults() == []
    assert versions(place)[-1] == SCHEMA_VERSION

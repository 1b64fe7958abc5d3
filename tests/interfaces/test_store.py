"""The audit store: what is recorded stays, whole, in order and unchanged, whatever happens to it."""

from __future__ import annotations

import dataclasses
import os
import random
import re
import signal
import sqlite3
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from sqlalchemy import create_mock_engine

from wirelessagent.agent.turn import Stage, Tools
from wirelessagent.model.errors import InputError, NothingRecordedError, StoreError, WirelessAgentError
from wirelessagent.settings import Settings
from wirelessagent.store.content import Content, estimate_of, observation_of
from wirelessagent.store.place import url_of
from wirelessagent.store.plain import canonical
from wirelessagent.store.rebuilt import cell_of, decision_of, intent_of, outcome_of, problem_of
from wirelessagent.store.record_of import record_of, understood
from wirelessagent.store.schema import METADATA, TURN
from wirelessagent.store.store import Store
from wirelessagent.store.stored import StoredTurn
from wirelessagent.testing.turns import SENTENCES, random_turn, turn_of

pytestmark = pytest.mark.machine_code

WRITER = """
import sys
from wirelessagent.store.store import Store
from wirelessagent.testing.turns import random_turn

place, session, seed, first, last = sys.argv[1:]
with Store.open(place, create=True) as store:
    for number in range(int(first), int(last) + 1):
        print(store.append(random_turn(number, session=session, seed=int(seed))), flush=True)
"""


def writer(place: Path, session: str, *, seed: int, first: int, last: int) -> subprocess.Popen[str]:
    """A process that records turns and prints the number of each once it is committed."""
    arguments = [str(place), session, str(seed), str(first), str(last)]
    return subprocess.Popen([sys.executable, "-c", WRITER, *arguments], stdout=subprocess.PIPE, text=True)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "audit.sqlite3"


@pytest.fixture
def store(place: Path) -> Iterator[Store]:
    with Store.open(place, create=True) as opened:
        yield opened


def recorded(store: Store, turns: int, *, seed: int = 1) -> list[StoredTurn]:
    """The turns of a session that were just recorded."""
    return [store.turn(store.append(random_turn(number, seed=seed))) for number in range(1, turns + 1)]


def changed(place: Path, *statements: str) -> None:
    """Do to the file what a tamperer with the SQLite shell would."""
    with closing(sqlite3.connect(place)) as connection:
        for statement in statements:
            connection.execute(statement)
        connection.commit()


def test_the_columns_are_the_fields_of_a_stored_turn() -> None:
    assert [column.name for column in TURN.columns] == list(StoredTurn.__dataclass_fields__)


def test_a_turn_comes_back_as_it_went_in(store: Store) -> None:
    for number in range(1, 30):
        turn = random_turn(number, seed=3)
        found = store.turn(store.append(turn))
        assert canonical(understood(turn)) == canonical(found.intent)
        assert canonical(intent_of(found)) == canonical(turn.intent)
        assert (found.session, found.turn, found.stage, found.seed) == ("one", number, turn.stage, number)
        assert found.is_whole
        assert found.decided == (turn.run is not None)
        if turn.run is None or found.observation is None or found.estimate is None:
            continue
        seen = observation_of(store.content(found.observation))
        np.testing.assert_array_equal(seen.gain, turn.run.observation.gain)
        assert seen.user_names == turn.run.observation.user_names
        np.testing.assert_array_equal(estimate_of(store.content(found.estimate)).gain, turn.run.estimate.gain)
        assert cell_of(found) == turn.run.decision.cell
        assert canonical(vars(problem_of(found, seen.user_names))) == canonical(vars(turn.run.decision.problem))
        again = turn_of(
            dataclasses.replace(
                turn.run, decision=decision_of(found, seen.user_names), outcome=outcome_of(found)
            ),
            number=number, text=turn.text,
        )  # fmt: skip
        assert canonical(record_of(again)[0]) == canonical(record_of(turn)[0])
    assert store.faults() == []


@pytest.mark.parametrize("text", [*SENTENCES, "x" * 1_000_000, "".join(map(chr, range(256))), "\u202eevil\u202c"])
def test_any_text_is_kept_as_far_as_a_database_can(store: Store, text: str) -> None:
    found = store.turn(store.append(turn_of(None, text=text)))
    assert found.text == text.replace("\x00", "\\x00").replace("\ud83d", "\\ud83d")
    assert store.faults() == []


def test_what_is_no_plain_data_is_refused_and_nothing_is_recorded(store: Store) -> None:
    turn = random_turn(2, seed=3)
    assert turn.run is not None
    tools = Tools(method_options={"callback": print})
    with pytest.raises(InputError, match="builtin_function_or_method cannot be recorded"):
        store.append(turn_of(dataclasses.replace(turn.run, tools=tools)))
    assert list(store.turns()) == []


@pytest.mark.parametrize("stage", get_args(Stage))
def test_only_what_was_applied_is_recorded_as_applied(store: Store, stage: Stage) -> None:
    run = random_turn(1, seed=1).run
    assert run is not None
    assert run.outcome is not None
    found = store.turn(store.append(turn_of(run, stage=stage)))
    assert (found.applied is not None) == (stage in ("applied", "reverted"))
    put_back = dataclasses.replace(turn_of(run, stage=stage, number=2), restored=run.outcome)
    restored = store.turn(store.append(put_back)).restored
    assert restored is not None
    assert restored["power_w"] == run.outcome.power_w.tolist()


def test_a_channel_is_stored_once(store: Store, place: Path) -> None:
    turn = next(turn for turn in (random_turn(number, seed=1) for number in range(1, 9)) if turn.run is not None)
    for number in range(1, 4):
        store.append(turn_of(turn.run, number=number))
    with closing(sqlite3.connect(place)) as connection:
        assert connection.execute("SELECT count(*) FROM audit_content").fetchone() == (2,)
        assert connection.execute("SELECT count(*) FROM audit_turn").fetchone() == (3,)


def test_turns_are_listed_by_session_and_from_the_end(store: Store) -> None:
    for number in range(1, 6):
        for session in ("one", "other"):
            store.append(random_turn(number, session=session, seed=1))
    assert [turn.number for turn in store.turns()] == list(range(1, 11))
    assert [turn.turn for turn in store.turns("other")] == [1, 2, 3, 4, 5]
    assert [turn.number for turn in store.turns("other", last=2)] == [8, 10]
    assert [turn.number for turn in store.turns(last=3)] == [8, 9, 10]
    with pytest.raises(NothingRecordedError, match="there is no turn 11: turns 1 to 10 are recorded"):
        store.turn(11)


def test_a_number_is_given_once_in_a_session(store: Store) -> None:
    store.append(random_turn(1, seed=1))
    with pytest.raises(StoreError, match="turn 1 of the session 'one' is recorded already"):
        store.append(random_turn(1, seed=2))
    assert len(list(store.turns())) == 1


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE audit_turn SET reply = 'nothing was done'",
        "DELETE FROM audit_turn WHERE number = 2",
        "UPDATE audit_content SET data = x'00'",
        "DELETE FROM audit_content",
        "UPDATE audit_schema SET version = 0",
        "DELETE FROM audit_schema",
        "INSERT OR REPLACE INTO audit_turn SELECT * FROM audit_turn WHERE number = 2",
        "REPLACE INTO audit_content SELECT hash, x'00' FROM audit_content",
        "UPDATE OR REPLACE audit_turn SET number = 1 WHERE number = 2",
    ],
)
def test_the_database_refuses_to_change_what_is_there(store: Store, place: Path, statement: str) -> None:
    before = recorded(store, 4)
    with pytest.raises(sqlite3.IntegrityError, match="the audit store is append-only"):
        changed(place, statement)
    assert list(store.turns()) == before
    assert store.faults() == []


def without_triggers(place: Path) -> list[str]:
    with closing(sqlite3.connect(place)) as connection:
        names = connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall()
    return [f"DROP TRIGGER {name}" for (name,) in names]


OBSERVATION, ESTIMATE = (f"(SELECT {name} FROM audit_turn WHERE number = 3)" for name in ("observation", "estimate"))


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("UPDATE audit_turn SET value = value * 1.0000001 WHERE number = 3", "turn 3 was changed"),
        ("UPDATE audit_turn SET text = 'save power' WHERE number = 3", "turn 3 was changed"),
        ("UPDATE audit_turn SET bound = NULL WHERE number = 3", "turn 3 was changed"),
        ("DELETE FROM audit_turn WHERE number = 3", "turn 3 is missing"),
        ("DELETE FROM audit_turn WHERE number < 3", "turns 1 to 2 are missing"),
        ("UPDATE audit_turn SET number = 9 WHERE number = 3", "turn 9 was changed"),
        (f"UPDATE audit_content SET data = x'00' WHERE hash = {OBSERVATION}",
         "turn 3: the content [0-9a-f]{12}… was changed: it can no longer be read"),
        (f"UPDATE audit_content SET data = (SELECT data FROM audit_content LIMIT 1) WHERE hash = {ESTIMATE}",
         "turn 3: the content [0-9a-f]{12}… was changed"),
        (f"DELETE FROM audit_content WHERE hash = {ESTIMATE}", "turn 3: the content [0-9a-f]{12}… is missing"),
    ],
)  # fmt: skip
def test_tampering_shows(store: Store, place: Path, statement: str, told: str) -> None:
    assert recorded(store, 5)[2].decided
    changed(place, *without_triggers(place), statement)
    faults = store.faults()
    assert [fault for fault in faults if re.match(told, fault)], faults
    assert sum("the trigger" in fault for fault in faults) == 12


def test_a_turn_made_up_with_its_hash_breaks_the_chain(store: Store, place: Path) -> None:
    from wirelessagent.store.stored import sealed

    turn = recorded(store, 4)[1]
    made_up = {**vars(turn), "reply": "something else was said"}
    changed(
        place, *without_triggers(place),
        f"UPDATE audit_turn SET reply = '{made_up['reply']}', hash = '{sealed(made_up)}' WHERE number = {turn.number}",
    )  # fmt: skip
    assert "turn 3 does not follow the turn before it in the session 'one'" in store.faults("one")


def test_what_was_committed_survives_being_killed(place: Path) -> None:
    """Bar: 200 random writes, killed at any moment, lose no committed turn and break no store."""
    chance, written, kills = random.Random(7), 0, 0
    while written < 200:
        process = writer(place, "killed", seed=kills, first=written + 1, last=200)
        assert process.stdout is not None
        told = [int(process.stdout.readline()) for _ in range(min(chance.randrange(1, 90), 200 - written))]
        os.kill(process.pid, signal.SIGKILL)
        told += [int(line) for line in process.stdout.read().split("\n")[:-1]]
        process.wait()
        process.stdout.close()
        kills += 1
        with Store.open(place) as store:
            turns = list(store.turns())
            assert [turn.number for turn in turns] == list(range(1, len(turns) + 1))
            assert told[-1] <= len(turns) <= told[-1] + 1
            assert store.faults() == []
        written = len(turns)
    assert kills >= 3
    with closing(sqlite3.connect(place)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_processes_write_at_once(place: Path) -> None:
    processes = [writer(place, session, seed=1, first=1, last=40) for session in ("one", "other", "third")]
    numbers = [int(line) for process in processes for line in process.communicate()[0].split()]
    assert [process.returncode for process in processes] == [0, 0, 0]
    assert sorted(numbers) == list(range(1, 121))
    with Store.open(place) as store:
        assert store.faults() == []
        for session in ("one", "other", "third"):
            assert [turn.turn for turn in store.turns(session)] == list(range(1, 41))


def test_a_reader_sees_what_is_committed_while_others_write(store: Store, place: Path) -> None:
    recorded(store, 120)
    with Store.open(place) as reader:
        turns = reader.turns()
        first = next(turns)
        store.append(random_turn(121, seed=1))
        assert [first.number, *(turn.number for turn in turns)] == list(range(1, 121))


def test_a_store_that_another_process_holds_is_waited_for_and_told(
    store: Store, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wirelessagent.store.place._PATIENCE_S", 0.1)
    with closing(sqlite3.connect(place, isolation_level=None)) as holder, Store.open(place) as waiting:
        holder.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError, match="database is locked"):
            waiting.append(random_turn(1, seed=1))
        holder.execute("ROLLBACK")
        assert waiting.append(random_turn(1, seed=1)) == 1


def contents(kind: str, place: Path) -> bytes:
    """What stands where the store should be."""
    if kind == "text":
        return b"my shopping list\n"
    if kind == "long text":
        return b"0123456789abcdef" * 4096
    if kind == "foreign":
        changed(place, "CREATE TABLE budget (year INTEGER)")
        return place.read_bytes()
    with Store.open(place, create=True) as made:
        recorded(made, 8)
    if kind == "newer":
        changed(place, *without_triggers(place), "UPDATE audit_schema SET version = 3")
    whole = place.read_bytes()
    middle = len(whole) // 2
    damaged = {
        "newer": whole, "cut off": whole[:middle], "header": b"\x00" * 100 + whole[100:],
        "pages": whole[:100] + bytes(random.Random(1).randbytes(len(whole) - 100)),
    }  # fmt: skip
    return damaged[kind]


@pytest.mark.parametrize(
    ("kind", "told"),
    [
        ("text", "file is not a database; nothing was changed"),
        ("long text", "file is not a database; nothing was changed"),
        ("header", "file is not a database; nothing was changed"),
        ("pages", "malformed|not a database"),
        ("cut off", "malformed"),
        ("foreign", "is not an audit store but a database with the tables budget; nothing was changed"),
        (
            "newer",
            r"has the schema version 3, made by wirelessagent \S+, and this one \(\S+\) knows those up to 2; nothing",
        ),
    ],
)
def test_what_is_no_store_is_refused_and_left_as_it_is(place: Path, kind: str, told: str) -> None:
    content = contents(kind, place)
    place.write_bytes(content)
    for create in (False, True):
        with pytest.raises(StoreError, match=told) as refused, Store.open(place, create=create) as store:
            list(store.turns())
        assert "\n" not in str(refused.value)
        assert str(place) in str(refused.value)
        assert place.read_bytes() == content


def test_an_empty_file_is_where_a_store_can_be_made(place: Path) -> None:
    place.touch()
    with pytest.raises(NothingRecordedError, match="nothing is recorded yet"):
        Store.open(place)
    with Store.open(place, create=True) as store:
        assert store.append(random_turn(1, seed=1)) == 1


def test_reading_makes_no_store(place: Path) -> None:
    with pytest.raises(NothingRecordedError, match="there is no audit store at"):
        Store.open(place)
    assert not place.exists()


def test_a_store_is_private(place: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("WIRELESSAGENT_STORE_URL")
    monkeypatch.setattr("platformdirs.user_data_path", lambda name: tmp_path / "data" / name)
    with Store.open(create=True) as store:
        store.append(random_turn(1, seed=1))
        made = Path(store.place)
        assert made.parent == tmp_path / "data" / "wirelessagent"
        assert stat.S_IMODE(made.parent.stat().st_mode) == 0o700
        assert {stat.S_IMODE(path.stat().st_mode) for path in made.parent.iterdir()} == {0o600}


def test_a_commit_is_on_the_disk_and_no_reader_waits(store: Store) -> None:
    with store._reading() as connection:
        pragmas = [connection.exec_driver_sql(f"PRAGMA {name}").scalar() for name in ("journal_mode", "synchronous")]
    assert pragmas == ["wal", 2]


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ("nosuch://host/audit", "nosuch"),
        ("://", "Could not parse|name a file"),
        ("mysql+pymysql://root:secret@host/audit", "only SQLite and PostgreSQL|dialects"),
        ("sqlite://", "needs a file"),
        ("sqlite:///:memory:", "needs a file"),
        ("postgresql+nosuch://host/audit", "nosuch"),
        ("~nobody-of-that-name/audit.sqlite3", "cannot be at ~nobody-of-that-name"),
        ("postgresql+psycopg2://me:secret@localhost/audit", "needs a driver that is not installed"),
        ("postgresql://me:secret@localhost:port/audit", "cannot be at 'postgresql://me:.*@localhost:port/audit'"),
        ("postgresql+psycopg2://localhost/audit?user=me&password=secret", "needs a driver that is not installed"),
        ("nosuch://me:secret@host/audit", "nosuch"),
        ("nosuch://me:sec@secret@host/audit", "nosuch"),
    ],
)
def test_a_place_that_cannot_be_is_told(where: str, told: str) -> None:
    with pytest.raises(WirelessAgentError, match=told) as refused:
        Store.open(where, create=True)
    assert "secret" not in str(refused.value)


@pytest.mark.parametrize("form", ["sqlite:///{place}?mode=ro", "sqlite+aiosqlite:///{place}"])
def test_a_file_with_options_or_another_driver_is_refused_and_not_made(form: str, place: Path) -> None:
    with pytest.raises(WirelessAgentError, match="without options or another driver"):
        Store.open(form.format(place=place), create=True)
    assert not place.exists()


@pytest.mark.parametrize("number", [2**63, -(2**63), 10**30])
def test_a_number_that_no_database_holds_is_no_turn(store: Store, number: int) -> None:
    store.append(random_turn(1, seed=1))
    with pytest.raises(NothingRecordedError, match=f"there is no turn {number}: turns 1 to 1 are recorded"):
        store.turn(number)


@pytest.mark.parametrize("unsettled", [False, True])
def test_where_nothing_can_be_written_what_is_settled_is_read(place: Path, *, unsettled: bool) -> None:
    with Store.open(place, create=True) as store:
        recorded(store, 3)
    place.with_name(f"{place.name}-shm" if unsettled else f"{place.name}-wal").mkdir()  # a reader's file cannot be made
    if unsettled:
        place.with_name(f"{place.name}-wal").write_bytes(b"x" * 4096)
        with pytest.raises(StoreError, match="cannot be used"):
            Store.open(place)
        return
    with Store.open(place) as store:
        assert [turn.number for turn in store.turns()] == [1, 2, 3]
        assert store.faults() == []
        with pytest.raises(StoreError, match="readonly"):
            store.append(random_turn(4, seed=1))


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"cannot be used: (Not a directory|No such file)"):
        Store.open(tmp_path / "none" / "audit.sqlite3", create=True)
    with pytest.raises(StoreError, match="that is a folder; name a file in it"):
        Store.open(tmp_path, create=True)


@pytest.mark.skipif(getattr(os, "geteuid", int)() == 0, reason="nothing is read-only to the superuser")
def test_a_read_only_folder_is_told(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(StoreError, match="cannot be used: Permission denied"):
        Store.open(tmp_path / "audit.sqlite3", create=True)
    tmp_path.chmod(0o700)


def test_the_settings_say_where(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WIRELESSAGENT_STORE_URL", f"sqlite:///{place}")
    assert url_of(None).database == str(place)
    assert url_of(place.with_name("other")).database == str(place.with_name("other"))
    monkeypatch.setenv("WIRELESSAGENT_STORE", "perhaps")
    with pytest.raises(InputError, match=r"WIRELESSAGENT_STORE: should be a valid boolean.*'perhaps'"):
        Settings.read()


def test_the_hash_of_a_content_is_that_of_what_it_holds() -> None:
    arrays = {"gain": np.array([[1.0, np.nan]]), "words": np.frombuffer(b"{}", dtype=np.uint8)}
    content = Content.of(arrays)
    assert content.hash == Content.of(dict(reversed(arrays.items()))).hash
    assert content.hash != Content.of({**arrays, "gain": arrays["gain"].T}).hash
    assert content.hash != Content.of({**arrays, "gain": arrays["gain"].astype(np.float32)}).hash
    assert Content.unpacked(content.hash, content.packed()).hash == content.hash


def test_postgresql_gets_tables_and_triggers() -> None:
    """The statements are PostgreSQL's; tests have no such server."""
    said: list[str] = []
    engine = create_mock_engine(
        "postgresql+pg8000://", lambda statement, *_: said.append(str(statement.compile(dialect=engine.dialect)))
    )
    METADATA.create_all(engine, checkfirst=False)
    text = "\n".join(said)
    assert text.count("CREATE TRIGGER") == 12
    assert "BEFORE TRUNCATE ON audit_turn FOR EACH STATEMENT EXECUTE FUNCTION audit_refuse()" in text
    assert "data BYTEA NOT NULL" in text
    assert "RAISE(ABORT" not in text

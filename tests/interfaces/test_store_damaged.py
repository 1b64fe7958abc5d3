"""Whatever a column of the store holds by now is told as tampering; no command breaks over it."""

from __future__ import annotations

import re
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wirelessagent.interfaces.cli import run
from wirelessagent.store.schema import CONTENT, TURN

pytestmark = pytest.mark.machine_code

CELL = ("--num-users", "2", "--num-subcarriers", "4")
RNG = np.random.default_rng(7)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store of three turns, without the triggers that guard it."""
    place = tmp_path_factory.mktemp("recorded") / "audit.sqlite3"
    said = ("Least power, 10 kbit/s each", "at least 20 kbit/s", "what is in effect?")
    assert run(["chat", *CELL, "--store", str(place), *(word for line in said for word in ("--say", line))]) == 0
    with closing(sqlite3.connect(place)) as connection:
        for (trigger,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            connection.execute(f"DROP TRIGGER {trigger}")
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return place


def damaging(held: Any) -> list[object]:
    """Five values in the place of what a column holds: other bytes, other types, other data, nearly the same."""
    text = held.decode("latin-1") if isinstance(held, bytes) else str(held)
    place = int(RNG.integers(len(text)))
    values = [
        RNG.bytes(20), b"\xff" + text.encode(), "\x00\x1b[2J\u202e", "", "[" * 3000, "{}", "null", '"text"', "1e999",
        "9" * 5000, -1, 2**62, 0.5, text[:place], text[:place] + chr(ord(text[place]) ^ 1) + text[place + 1 :],
    ]  # fmt: skip
    there = [value for value in values if not (held is None and value in ("null", None))]
    return [there[int(one)] for one in RNG.permutation(len(there))[:5]]


def damage(place: Path, table: str, column: str, value: object) -> bool:
    """Write a value into a column of the second row; whether the database took it."""
    with closing(sqlite3.connect(place)) as connection, connection:
        try:
            changed = f"UPDATE {table} SET {column} = ? WHERE rowid = 2"
            connection.execute(changed, (value,))
            if isinstance(value, str) and value.startswith("\x00"):  # bytes that are no text, as text
                connection.execute(changed.replace("?", "CAST(? AS TEXT)"), (b"\xff\xfe",))
        except sqlite3.IntegrityError:
            return False
    return True


COLUMNS = [(table.name, column.name) for table in (TURN, CONTENT) for column in table.columns]


@pytest.mark.parametrize(("table", "column"), COLUMNS, ids=[".".join(each) for each in COLUMNS])
def test_a_damaged_column_is_told(
    table: str, column: str, recorded: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with closing(sqlite3.connect(recorded)) as connection:
        (held,) = connection.execute(f"SELECT {column} FROM {table} WHERE rowid = 2").fetchone()
    taken = 0
    for number, value in enumerate(damaging(held)):
        place = tmp_path / f"{number}.sqlite3"
        shutil.copy(recorded, place)
        if not damage(place, table, column, value):
            continue
        taken += 1
        store = ("--store", str(place))
        assert run(["history", *store]) == 0, value
        codes = [run(["history", command, "2", *store]) for command in ("show", "replay")]
        streams = capsys.readouterr()
        assert "internal error" not in streams.err, value
        assert codes[1] == 1 if table == TURN.name else codes[1] in (0, 1), value
        told = " ".join((streams.out + streams.err).split())
        assert re.search(r"turn 2 was changed|turn 2 is missing|turn [12]: the content \w+… ", told), value
    assert taken > 2


@pytest.mark.parametrize("column", ["number", "session", "hash", "text", "intent"])
def test_a_conversation_goes_on_with_a_damaged_store(
    column: str, recorded: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for number, value in enumerate((b"\xff", "text", 2**63 - 1)):
        place = tmp_path / f"{number}.sqlite3"
        shutil.copy(recorded, place)
        assert damage(place, TURN.name, column, value)
        assert run(["chat", *CELL, "--say", "help", "--store", str(place)]) == 0
        told = capsys.readouterr().err
        assert "internal error" not in told
        assert ("not recorded: the numbers of the turns" in told) == (column == "number")

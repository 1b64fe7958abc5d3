"""Where users are known by pseudonyms, no name of theirs is anywhere in a store, and nothing else is different."""

from __future__ import annotations

from pathlib import Path

import pytest
from servers import Server, started

from wirelessagent.interfaces.cli import run
from wirelessagent.operations.pseudonyms import hidden_text, pseudonym
from wirelessagent.store.store import Store

pytestmark = pytest.mark.machine_code

KEY = "a key that nobody knows"
GAINS = "alice,1e-9,2e-9,,4e-9\nBob Smith,2e-9,1e-9,3e-9,1e-9\n王芳,2e-9,3e-9,1e-9,1e-9\n"
NAMES = ("alice", "Bob Smith", "王芳")


@pytest.mark.parametrize("text", ["at least 1 Mbit/s for {}", "{}, {} and user 3", "给{}至少2 Mbit/s", "ALICE{}"])
def test_names_in_a_sentence(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setenv("WIRELESSAGENT_PSEUDONYM_KEY", KEY)
    known = [pseudonym(name, KEY) for name in NAMES]
    for name, said in zip(NAMES, known, strict=True):
        if text == "ALICE{}":
            assert hidden_text("alices ALICE", known) == f"alices {known[0]}"
        else:
            assert hidden_text(text.replace("{}", name), known) == text.replace("{}", said)
    assert hidden_text("save power", known) == "save power"


def test_they_are_stable_and_keyed() -> None:
    assert pseudonym("alice", KEY) != pseudonym("alice", KEY + "!")
    assert pseudonym(pseudonym("alice", KEY), KEY) == pseudonym("alice", KEY)
    assert pseudonym("user 3", KEY) == "user 3"
    assert len({pseudonym(f"name {number}", KEY) for number in range(10_000)}) == 10_000


def test_no_name_is_in_the_store_of_a_server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    key = tmp_path / "key"
    key.write_text(KEY + "\n")
    with started(tmp_path / "store.sqlite3", "--pseudonym-key-file", str(key)) as server:
        turns = _talk(server)
        server.end_workers()  # so that the conversation is taken up
        assert server.say(str(turns[0]["session"]), "how sure is this?")["number"] == 3
        server.kill()
    for path in (tmp_path / "store.sqlite3", tmp_path / "store.sqlite3-wal", *tmp_path.glob("store.cache/**/*.*")):
        if path.exists():
            for name in NAMES:
                assert name.encode() not in path.read_bytes(), path
    with Store.open(tmp_path / "store.sqlite3") as store:
        assert store.faults() == []
        assert store.turn(1).text.endswith(pseudonym("alice", KEY))
        assert store.replay(1).verdict in ("identical", "close")


def _talk(server: Server) -> list[dict[str, object]]:
    octets = {"Content-Type": "application/octet-stream"}
    seen = server.post("v1/observations?name=gains.csv", content=GAINS.encode(), headers=octets).json()
    assert seen["user_names"] == [pseudonym(name, KEY) for name in NAMES]
    cell = server.post("v1/cells", {"name": "measured", "options": {"csi": seen["id"]}}).json()
    turns = [server.say(cell["session"], "save power, at least 100 kbit/s for alice")]
    assert turns[0]["request"]["constraints"]["min_rate_bps"] == {pseudonym("alice", KEY): 1e5}
    return [*turns, server.say(cell["session"], "and 200 kbit/s for Bob Smith")]


def test_a_short_key_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "key").write_text("short")
    assert run(["serve", "--pseudonym-key-file", str(tmp_path / "key"), "--store", str(tmp_path / "s.sqlite3")]) == 2
    assert "16 or more" in capsys.readouterr().err
    monkeypatch.setenv("WIRELESSAGENT_PSEUDONYM_KEY", "short")
    (tmp_path / "gains.csv").write_text(GAINS, encoding="utf-8")
    assert run(["ask", "save power", "--csi", str(tmp_path / "gains.csv")]) == 2
    error = capsys.readouterr().err
    assert "WIRELESSAGENT_PSEUDONYM_KEY" in error
    assert "'short'" not in error

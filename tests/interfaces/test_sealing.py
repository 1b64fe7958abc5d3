"""Old sessions are sealed: their channels are in a file, the chain holds, and nothing is lost or taken on trust."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from sqlalchemy import create_engine
from sqlalchemy.exc import DBAPIError

from wirelessagent import chain
from wirelessagent.agent.turn import Turn
from wirelessagent.interfaces.cli import run
from wirelessagent.model.errors import FileFormatError, InputError, SealedError
from wirelessagent.model.problem import Problem
from wirelessagent.operations import history_seal
from wirelessagent.sensing import loss
from wirelessagent.store.ledger import Ledger
from wirelessagent.store.sealing import old_sessions, seal
from wirelessagent.store.store import Store
from wirelessagent.testing.turns import decided_turn, random_turn

pytestmark = pytest.mark.machine_code


def test_the_chain_holds_and_the_file_gives_back_what_was_seen(place: str, tmp_path: Path) -> None:
    scene = chain.simulate("rayleigh", num_users=2, num_subcarriers=6, seed=1)
    with Store.open(place, create=True) as store:
        for number in (1, 2):
            store.append(decided_turn(scene, Problem("max_rate"), loss.random(0.2), number=number))
        store.append(random_turn(3, seed=3, session="another"))
        session = "one"
        seen = [(turn.number, turn.observation) for turn in store.turns(session) if turn.observation is not None]
        contents = {hash: store.content(hash) for _, hash in seen if hash is not None}
        done = seal(store, [session], tmp_path / "old.jsonl")
        assert done.contents >= len(contents)
        assert store.faults() == []
        number, hash = seen[0]
        assert hash is not None
        with pytest.raises(SealedError, match=done.archive):
            store.content(hash)
        with pytest.raises(InputError, match="nothing to seal"):
            seal(store, [session], tmp_path / "again.jsonl")
    with Store.open(place, archive=tmp_path / "old.jsonl") as store:
        for hash, content in contents.items():
            assert store.content(hash).exported() == content.exported()
        assert store.replay(number).verdict in ("identical", "close")
        assert store.faults() == []


def test_a_file_is_not_taken_on_trust(tmp_path: Path) -> None:
    place, out = tmp_path / "store.sqlite3", tmp_path / "old.jsonl"
    with Store.open(place, create=True) as store:
        store.append(random_turn(1, seed=1))
        turn = store.turn(1)
        assert turn.observation is not None
        seal(store, [turn.session], out)
    lines = [json.loads(line) for line in out.read_text().splitlines()]
    for line in lines:
        if line["kind"] == "content":
            line["arrays"]["gain"]["values"][0] = 1.0
    out.write_text("".join(json.dumps(line) + "\n" for line in lines))
    with Store.open(place, archive=out) as store, pytest.raises(FileFormatError, match="was changed"):
        store.content(turn.observation)
    out.write_text("gain,1,2\n")
    with Store.open(place, archive=out) as store, pytest.raises(FileFormatError, match="cannot be read as an export"):
        store.content(turn.observation)


def test_what_is_not_sealed_cannot_be_taken_away(place: str, tmp_path: Path) -> None:
    with Store.open(place, create=True) as store:
        store.append(random_turn(1, seed=1))
        store.append(random_turn(2, seed=2, session="another"))
        seal(store, ["another"], tmp_path / "old.jsonl")
    engine = create_engine(place if "://" in place else f"sqlite:///{place}")
    for statement in (
        "UPDATE audit_content SET data = '' WHERE length(data) > 0", "UPDATE audit_content SET hash = 'x'",
        "DELETE FROM audit_content", "DELETE FROM audit_seal", "UPDATE audit_seal SET archive = 'x'",
        "UPDATE audit_turn SET text = 'x'",
    ):  # fmt: skip
        with engine.connect() as connection, pytest.raises(DBAPIError, match="append-only"):
            connection.exec_driver_sql(statement)
    engine.dispose()


def test_a_channel_that_others_speak_of_stays_and_one_that_is_seen_again_comes_back(place: str, tmp_path: Path) -> None:
    def turn(session: str) -> Turn:
        return random_turn(1, seed=1, session=session)

    with Store.open(place, create=True) as store:
        store.append(turn("one"))
        store.append(turn("two"))
        channel = store.turn(1).observation
        assert channel is not None
        with pytest.raises(InputError, match="nothing to seal"):
            seal(store, ["one"], tmp_path / "one.jsonl")
        assert seal(store, ["one", "two"], tmp_path / "both.jsonl").contents == 2
        assert not store.holds(channel)
        store.append(turn("three"))
        assert store.content(channel).hash == channel
        assert seal(store, ["one", "two", "three"], tmp_path / "all.jsonl").contents == 2
        assert store.faults() == []
        assert store.put_seals([channel], "elsewhere", ["one"]) == 0


def test_by_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    place, out = tmp_path / "store.sqlite3", tmp_path / "old.jsonl"
    scene = chain.simulate("rayleigh", num_users=2, num_subcarriers=6, seed=1)
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, Problem("max_rate"), loss.random(0.2)))
        session = store.turn(1).session
        assert old_sessions(store, "1999-01-01") == ()
    at = ["--store", str(place)]
    assert run(["history", "seal", str(out), *at]) == 2
    assert "--session" in capsys.readouterr().err
    ledger = Ledger.open(place)
    ledger.put("cell", "one", {"session": session})
    assert run(["history", "seal", str(out), "--session", session, *at]) == 2
    ledger.drop("cell", "one")
    ledger.put("channel", session, {"channel": None})
    ledger.put("turn", f"{session}/00000001", {})
    assert run(["history", "seal", str(out), "--before", "2999-01-01", *at, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["sessions"] == [session]
    assert ledger.all("turn") == ledger.all("channel") == []
    ledger.close()
    assert run(["history", "show", "1", *at]) == 0
    assert "--sealed" in capsys.readouterr().out
    assert run(["history", "show", "1", "--sealed", str(out), *at]) == 0
    assert "--sealed" not in capsys.readouterr().out
    assert run(["history", "replay", "1", *at]) == 2
    assert run(["history", "replay", "1", "--sealed", str(out), *at]) == 0
    assert run(["history", "export", str(tmp_path / "all.jsonl"), *at]) == 0
    assert run(["history", "seal", str(out), "--before", "2999-01-01", *at]) == 2
    assert "is there already" in capsys.readouterr().err


def test_of_two_who_seal_into_one_file_one_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place, out = tmp_path / "store.sqlite3", tmp_path / "old.jsonl"
    scene = chain.simulate("rayleigh", num_users=2, num_subcarriers=6, seed=1)
    with Store.open(place, create=True) as store:
        store.append(decided_turn(scene, Problem("max_rate"), loss.random(0.2)))
    opened = history_seal.opened

    def sealed_meanwhile(request: history_seal.SealRequest) -> Store:
        out.write_text("what somebody else has sealed")
        return opened(request)

    monkeypatch.setattr(history_seal, "opened", sealed_meanwhile)
    assert run(["history", "seal", str(out), "--before", "2999-01-01", "--store", str(place)]) == 2
    assert out.read_text() == "what somebody else has sealed"
    monkeypatch.undo()
    out.unlink()
    assert run(["history", "seal", str(out), "--before", "1999-01-01", "--store", str(place)]) == 2
    assert not out.exists()

"""The store behind a server: SQLite and PostgreSQL, several servers on one, and servers that are killed."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2
import postgres
import pytest
from servers import Server, started

from wirelessagent.store.ledger import ChangedError, Ledger
from wirelessagent.store.store import Store

pytestmark = pytest.mark.machine_code


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """Where a store may be."""
    if request.param == "sqlite":
        yield str(tmp_path / "store.sqlite3")
        return
    pytest.importorskip("psycopg")
    if postgres.program("initdb") is None:
        pytest.skip("there is no PostgreSQL here")
    with postgres.running(tmp_path / "cluster") as url:
        yield url


def test_of_two_who_want_an_item_one_wins(place: str) -> None:
    ledgers = [Ledger.open(place) for _ in range(4)]
    seen = ledgers[0].put("plan", "cell", {"owner": -1})

    def take(number: int) -> bool:
        try:
            ledgers[number].put("plan", "cell", {"owner": number}, seen=seen)
        except ChangedError:
            return False
        return True

    with ThreadPoolExecutor(4) as pool:
        won = list(pool.map(take, range(4)))
    assert sum(won) == 1
    item = ledgers[0].find("plan", "cell")
    assert item is not None
    assert (item.data["owner"], item.version) == (won.index(True), seen + 1)
    with ThreadPoolExecutor(4) as pool:
        dropped = list(pool.map(lambda ledger: ledger.drop("plan", "cell", seen=item.version), ledgers))
    assert sum(dropped) == 1
    with pytest.raises(ChangedError):
        ledgers[0].put("plan", "cell", {}, seen=3)
    for ledger in ledgers:
        ledger.close()


def test_items_are_found_by_how_their_names_begin(place: str) -> None:
    ledger = Ledger.open(place)
    for id in ("a/1", "a/2", "a%/1", "b/1"):
        ledger.put("turn", id, {"id": id})
    assert [item.id for item in ledger.all("turn", start="a/")] == ["a/1", "a/2"]
    assert [item.id for item in ledger.all("turn", start="a%")] == ["a%/1"]
    ledger.close()


def test_two_servers_are_one(place: str, tmp_path: Path) -> None:
    with started(tmp_path / "one", at=place) as one, started(tmp_path / "two", at=place) as two:
        session = one.cell()["session"]
        assert two.say(session, "Save power, at least 1 Mbit/s each")["number"] == 1
        plan = one.plan(session)

        def press(server: Server) -> int:
            return server.post(f"v1/sessions/{session}/confirm", {"plan": plan}).status_code

        with ThreadPoolExecutor(4) as pool:
            answers = sorted(pool.map(press, [one, two, one, two]))
        assert answers == [200, 409, 409, 409]
        turn = one.say(session, "and user 3 at least 2 Mbit/s")
        assert (turn["number"], turn["request"]["objective"]) == (3, "min_power")
        stages = [turn["stage"] for turn in two.get(f"v1/sessions/{session}")["turns"]]
        assert stages == ["planned", "applied", "planned"]


def test_killed_under_load_every_answered_turn_is_kept_and_nothing_applied_twice(place: str, tmp_path: Path) -> None:
    answered, applied, over = list[tuple[str, int]](), list[str](), threading.Event()

    def talk(server: Server, session: str) -> None:
        with contextlib.suppress(httpx2.HTTPError):
            for watts in range(1, 40):
                if over.is_set():
                    return
                said = server.post(f"v1/sessions/{session}/turns", {"text": f"highest rate, at most {watts} W"})
                if said.status_code == 200:
                    answered.append((session, said.json()["number"]))
                plan = server.get(f"v1/sessions/{session}")["plan"]
                if plan is not None:
                    done = server.post(f"v1/sessions/{session}/confirm", {"plan": plan["id"]})
                    if done.status_code == 200:
                        applied.append(plan["id"])
                        answered.append((session, done.json()["number"]))

    with started(tmp_path / "one", at=place) as server:
        sessions = [server.cell()["session"] for _ in range(3)]
        talking = [threading.Thread(target=talk, args=(server, session)) for session in sessions]
        for one in talking:
            one.start()
        over.wait(6)
        server.kill()
        over.set()
        for one in talking:
            one.join()
    assert len(answered) > 3
    with Store.open(place) as store:
        kept = {(turn.session, turn.turn): turn for turn in store.turns()}
        assert store.faults() == []
    assert set(answered) <= set(kept)
    assert len(set(applied)) == len(applied)
    with started(tmp_path / "two", at=place) as server:
        for session in sessions:
            turn = server.say(session, "how sure is this?")
            before = max((number for of, number in kept if of == session), default=0)
            since = server.get(f"v1/sessions/{session}")["turns"][before:]
            told = [one["lines"]["changed"] for one in since[:-1]]
            assert since[-1] == turn
            assert all("what is in effect there is not known" in one for one in told)
            assert len(told) <= 1

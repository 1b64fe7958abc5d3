"""The store behind a server: SQLite and PostgreSQL, several servers on one, and servers that are killed."""

from __future__ import annotations

import asyncio
import contextlib
import sqlite3
import subprocess
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2
import postgres
import pytest
from servers import Server, started

from wirelessagent.operations.operation import InputError
from wirelessagent.service import leases
from wirelessagent.service.leases import Leases
from wirelessagent.service.limits import Budgets, Limits
from wirelessagent.service.problems import TooMuchError
from wirelessagent.store.ledger import ChangedError, Ledger
from wirelessagent.store.store import Store

pytestmark = pytest.mark.machine_code


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


@pytest.mark.parametrize("id", ["a\x00b", "\ud800"])
def test_a_name_that_no_store_can_keep(place: str, id: str) -> None:
    ledger = Ledger.open(place)
    if place.startswith("postgresql") or id != "a\x00b":  # which SQLite keeps
        with pytest.raises(InputError, match="no audit store can keep"):
            ledger.find("cell", id)
    assert ledger.find("cell", "ab") is None
    ledger.close()


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def pair(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Server, Server]]:
    """Two servers on one store."""
    folder = tmp_path_factory.mktemp("pair")
    if request.param == "sqlite":
        place = str(folder / "store.sqlite3")
    else:
        place = postgres.new_database(request.getfixturevalue("cluster"))
    with started(folder / "one", at=place) as one, started(folder / "two", at=place) as two:
        yield one, two


def test_two_servers_are_one(pair: tuple[Server, Server]) -> None:
    one, two = pair
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


def test_what_one_server_was_sent_the_other_works_on(pair: tuple[Server, Server]) -> None:
    one, two = pair
    seen = _observed(one)
    assert two.get(f"v1/observations/{seen['id']}") == seen
    cell = two.post("v1/cells", {"name": "measured", "options": {"csi": seen["id"]}}).json()
    assert two.say(cell["session"], "highest total rate")["stage"] == "planned"
    made = two.post("v1/operations/repair", {"observation": seen["id"]}).json()
    assert one.post("v1/operations/repair", {"observation": seen["id"]}).json()["record"] == made["record"]
    with one.client as client:
        assert client.delete(f"v1/cells/{cell['id']}").status_code == 204
        assert client.delete(f"v1/observations/{seen['id']}").status_code == 204
    assert two.post("v1/operations/repair", {"observation": seen["id"]}).status_code == 404


def test_a_key_sent_to_two_servers_is_done_once(pair: tuple[Server, Server]) -> None:
    one, two = pair
    session, key = one.cell()["session"], {"Idempotency-Key": "sent to both"}

    def say(server: Server) -> dict[str, object]:
        return server.say(session, "highest total rate", headers=key)

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(say, [one, two, one, two]))
    assert all(turn == found[0] for turn in found)
    assert len(one.get(f"v1/sessions/{session}")["turns"]) == 1
    assert two.post(f"v1/sessions/{session}/turns", {"text": "undo"}, headers=key).status_code == 409


def test_a_job_is_followed_and_ended_at_another_server(pair: tuple[Server, Server]) -> None:
    one, two = pair
    later = {"Prefer": "respond-async"}
    session = one.cell()["session"]
    said = one.post(f"v1/sessions/{session}/turns", {"text": "fair"}, headers=later).json()
    with one.client as here, two.client as client:
        there, told = (
            [line for line in asked.get(f"v1/jobs/{said['id']}/events").text.split("\n") if line[:3] == "id:"]
            for asked in (here, client)
        )
        assert told == there
        assert client.get(f"v1/jobs/{said['id']}").json()["result"]["stage"] == "planned"
        endless = one.post("v1/operations/evaluate%20repair", {"draws": 100_000}, headers=later).json()
        seen = client.get(f"v1/jobs/{endless['id']}").json()
        assert seen["state"] == "running", seen
        until = time.monotonic() + 30
        while client.get(f"v1/jobs/{endless['id']}").json()["state"] == "running" and time.monotonic() < until:
            assert client.delete(f"v1/jobs/{endless['id']}").status_code == 204
            time.sleep(0.2)
        assert client.get(f"v1/jobs/{endless['id']}").json()["state"] == "cancelled"
    assert one.get(f"v1/jobs/{endless['id']}")["state"] == "cancelled"


def test_a_copy_of_a_store_in_use_is_a_store(pair: tuple[Server, Server], tmp_path: Path) -> None:
    """As docs/serve.md says: a backup while servers go on, and a server on it."""
    server, over = pair[0], threading.Event()
    session, seen = server.cell()["session"], _observed(server)

    def talk() -> None:
        for watts in range(1, 200):
            if over.is_set():
                return
            server.say(session, f"highest rate, at most {watts} W")

    talking = threading.Thread(target=talk)
    talking.start()
    until = time.monotonic() + 60
    while len(server.get(f"v1/sessions/{session}")["turns"]) < 3 and time.monotonic() < until:
        time.sleep(0.1)
    copy = _copied(server.at, tmp_path)
    over.set()
    talking.join()
    with Store.open(copy) as store:
        turns = list(store.turns(session))
        assert len(turns) >= 2
        assert store.faults() == []
        assert store.replay(turns[0].number).verdict in ("identical", "close")
    with started(tmp_path / "on_it", at=copy) as again:
        assert again.get(f"v1/observations/{seen['id']}") == seen
        assert again.say(session, "at most 2 W")["number"] == len(turns) + 1
        assert again.post("v1/operations/repair", {"observation": seen["id"]}).status_code == 200


def _observed(server: Server) -> dict[str, object]:
    octets, gains = {"Content-Type": "application/octet-stream"}, "1e-9,2e-9,,4e-9\n2e-9,1e-9,3e-9,1e-9\n"
    return server.post("v1/observations?name=gains.csv", content=gains, headers=octets).json()


def _copied(place: str, folder: Path) -> str:
    """A store's place, copied with the means of its database."""
    if "://" not in place:
        copy = str(folder / "copy.sqlite3")
        with contextlib.closing(sqlite3.connect(place)) as source, contextlib.closing(sqlite3.connect(copy)) as target:
            source.backup(target)
        return copy
    copy = postgres.new_database(place)
    for program, *options in (
        ("pg_dump", "--format=custom", f"--file={folder / 'dump'}", f"--dbname={postgres.plain(place)}"),
        ("pg_restore", "--no-owner", f"--dbname={postgres.plain(copy)}", str(folder / "dump")),
    ):
        subprocess.run([str(postgres.program(program)), *options], check=True, capture_output=True)
    return copy


def test_a_limit_holds_for_all_servers_together(place: str) -> None:
    async def spend() -> tuple[list[bool], float]:
        ledgers = [Ledger.open(place) for _ in range(2)]
        servers = [Budgets(Limits(requests_per_s=1.0), ledger) for ledger in ledgers]
        began, taken = time.monotonic(), list[bool]()
        for _ in range(90):
            for budgets in servers:
                try:
                    await budgets.spend("somebody")
                except TooMuchError:
                    taken.append(False)
                else:
                    taken.append(True)
        for ledger in ledgers:
            ledger.close()
        return taken, time.monotonic() - began

    taken, lasted_s = asyncio.run(spend())
    assert all(taken[:100])
    assert not all(taken)
    assert sum(taken) <= 121 + lasted_s


def test_no_servers_clock_says_whose_turn_it_is(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leases, "_LASTS_S", 1.0)
    monkeypatch.setattr(leases, "_RENEWED_S", 0.2)
    clock, real = {"ahead_s": 0.0}, time.time
    monkeypatch.setattr(time, "time", lambda: real() + clock["ahead_s"])

    async def take_turns() -> None:
        ledgers = [Ledger.open(place) for _ in range(2)]
        one, two = (Leases(ledger, 5.0) for ledger in ledgers)
        async with one.of("cell"):
            clock["ahead_s"] = 3600.0  # at the other server
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(2.0), two.of("cell"):
                    pass
        gone = {"server": "another", "until": time.time(), "telling": {"by": "somebody"}}
        clock["ahead_s"] = 0.0
        ledgers[0].put("going", "cell", gone)
        async with asyncio.timeout(4.0), two.of("cell") as lease:
            assert lease.telling == gone["telling"]
        for ledger in ledgers:
            ledger.close()

    asyncio.run(take_turns())


def test_a_clock_that_is_set_back_locks_nobody_out(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    ledger, now = Ledger.open(place), time.time()
    monkeypatch.setattr(time, "time", lambda: now)

    async def spend() -> None:
        budgets = Budgets(Limits(requests_per_s=20.0, burst=3), ledger)
        for _ in range(3):
            await budgets.spend("somebody")
        with pytest.raises(TooMuchError):
            await budgets.spend("somebody")
        monkeypatch.setattr(time, "time", lambda: now - 3600.0)
        await asyncio.sleep(0.2)
        await budgets.spend("somebody")

    asyncio.run(spend())
    ledger.close()


def test_a_database_that_was_started_again_is_found_again(cluster: str) -> None:
    import psycopg

    place = postgres.new_database(cluster)
    ledger = Ledger.open(place)
    ledger.put("cell", "demo", {})
    with psycopg.connect(postgres.plain(place)) as connection:
        connection.execute(
            "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
            "WHERE datname = current_database() AND pid <> pg_backend_pid()"
        )
    assert ledger.find("cell", "demo") is not None
    ledger.close()


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
        quiet, sent = server.cell()["session"], {"Idempotency-Key": "sent before and after"}
        first = server.say(quiet, "Save power, at least 1 Mbit/s each", headers=sent)
        server.post(f"v1/sessions/{quiet}/confirm", {"plan": server.plan(quiet)})
        server.say(quiet, "and user 3 at least 2 Mbit/s")
        before = server.get(f"v1/sessions/{quiet}")
        sessions = [server.cell()["session"] for _ in range(3)]
        talking = [threading.Thread(target=talk, args=(server, session)) for session in sessions]
        for one in talking:
            one.start()
        until = time.monotonic() + 60
        while len(answered) < 8 and time.monotonic() < until:
            over.wait(0.1)
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
        assert server.get(f"v1/sessions/{quiet}") == before
        assert server.say(quiet, "Save power, at least 1 Mbit/s each", headers=sent) == first
        done = server.post(f"v1/sessions/{quiet}/confirm", {"plan": before["plan"]["id"]}).json()
        assert (done["number"], done["stage"], done["by"]) == (4, "applied", "local")
        assert done["request"]["constraints"]["min_rate_bps"] == {"all": 1e6, "3": 2e6}
        for session in sessions:
            turn = server.say(session, "how sure is this?")
            last = max((number for of, number in kept if of == session), default=0)
            since = server.get(f"v1/sessions/{session}")["turns"][last:]
            told = [one["lines"]["changed"] for one in since[:-1]]
            assert since[-1] == turn
            assert all("what is in effect there is not known" in one for one in told), told
            assert len(told) <= 1

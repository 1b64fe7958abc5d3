"""What happened at a base station is told as it happened: also where it failed, or its worker or server ended."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sqlite3
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx2
import pytest
from llm_stub import StubLlm, meaning
from servers import Server, started

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import StoreError
from wirelessagent.model.outcome import Outcome
from wirelessagent.operations import hosted
from wirelessagent.operations.chat import ChatRequest
from wirelessagent.operations.hosted import Hosted
from wirelessagent.operations.operation import silent
from wirelessagent.service.jobs import Jobs
from wirelessagent.service.names import PublicNames
from wirelessagent.service.problems import TooMuchError
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import Ledger

pytestmark = pytest.mark.machine_code

LIMIT_S = 8.0
"""For one piece of work: one test waits for it, the others stay below it."""

_RADIO = '''
import os
import pathlib
import time
from dataclasses import dataclass

from wirelessagent.acting.base_station import BaseStation


@dataclass(frozen=True, kw_only=True)
class Radio(BaseStation):
    """A base station that does what a file says."""

    name = "radio"

    def apply(self, decision):
        here = pathlib.Path(__file__)
        with here.with_name("told").open("a") as told:
            told.write(f"{decision.total_power_w}\\n")
        match here.with_name("order").read_text():
            case "refuse":
                raise OSError(f"the amplifier is off, says {here}")
            case "die":
                os._exit(9)
            case "wait":
                time.sleep(600)
            case "dawdle":
                time.sleep(2)
        return self.read_back(decision)
'''


class Radio:
    """The base station of a server, and how to tell it what to do."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        info = folder / "radio-1.0.dist-info"
        info.mkdir()
        (folder / "radio.py").write_text(_RADIO)
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: radio\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text("[wirelessagent.base_station]\nradio = radio:Radio\n")
        self.will("obey")

    def will(self, order: str) -> None:
        (self.folder / "order").write_text(order)

    @property
    def told(self) -> int:
        """How often it was told something."""
        file = self.folder / "told"
        return len(file.read_text().splitlines()) if file.exists() else 0


class Operator:
    """Somebody at a server whose cells are on that base station; it can be started again on its store."""

    def __init__(self, store: Path, servers: contextlib.ExitStack) -> None:
        self._store, self._servers = store, servers
        self.start()

    def start(self) -> None:
        self.server = self._servers.enter_context(started(self._store, "--work-limit-s", str(LIMIT_S)))

    def begin(self) -> str:
        """A new cell's conversation, with something in effect and a plan that waits."""
        made = self.server.post("v1/cells", {"name": "radio", "options": {"seed": 1, "base_station": "radio"}})
        assert made.status_code == 201, made.text
        session = made.json()["session"]
        self.server.say(session, "highest total rate")
        assert _press(self.server, session)["stage"] == "applied"
        self.server.say(session, "at most 10 W")
        return session


@pytest.fixture(scope="module")
def stations(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Radio]:
    radio = Radio(tmp_path_factory.mktemp("radio"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join([str(radio.folder), os.environ.get("PYTHONPATH", "")]))
        yield radio


@pytest.fixture(scope="module")
def operator(stations: Radio, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Operator]:
    del stations
    with contextlib.ExitStack() as servers:
        yield Operator(tmp_path_factory.mktemp("operator") / "store.sqlite3", servers)


@pytest.fixture
def radio(stations: Radio) -> Radio:
    stations.will("obey")
    return stations


@pytest.fixture
def talking(radio: Radio, operator: Operator) -> tuple[Server, str]:
    """The server, and a conversation there about a cell on that base station; something is in effect."""
    told = radio.told
    session = operator.begin()
    assert radio.told == told + 1
    return operator.server, session


def _press(server: Server, session: str) -> dict[str, Any]:
    done = server.post(f"v1/sessions/{session}/confirm", {"plan": server.plan(session)})
    assert done.status_code == 200, done.text
    return done.json()


def test_a_base_station_that_refuses(talking: tuple[Server, str], radio: Radio) -> None:
    server, session = talking
    radio.will("refuse")
    reply = _press(server, session)["reply"]
    assert "the amplifier is off" in reply
    assert str(radio.folder) not in reply
    before = server.get(f"v1/sessions/{session}")
    assert (before["in_effect"], before["plan"]) == (None, None)
    told = radio.told
    server.end_workers()
    server.say(session, "how sure is this?")
    after = server.get(f"v1/sessions/{session}")
    assert (after["in_effect"], after["plan"], after["turns"][:4]) == (None, None, before["turns"])
    assert radio.told == told


def test_a_worker_that_dies_while_it_applies(talking: tuple[Server, str], radio: Radio) -> None:
    (server, session), told = talking, radio.told
    radio.will("die")
    broken_off = _press(server, session)
    assert (broken_off["stage"], broken_off["outcome"]) == ("nothing", None)
    assert "not known" in broken_off["lines"]["changed"]
    held = server.get(f"v1/sessions/{session}")
    assert (held["in_effect"], held["plan"], held["awaits"]) == (None, None, "nothing")
    radio.will("obey")
    server.say(session, "how sure is this?")
    server.say(session, "at most 8 W")
    assert _press(server, session)["stage"] == "applied"
    assert radio.told == told + 2
    assert server.get(f"v1/sessions/{session}")["in_effect"] == 7
    assert server.get(f"v1/history?session={session}")["turns"][3]["stage"] == "nothing"


def test_a_base_station_that_never_answers(talking: tuple[Server, str], radio: Radio) -> None:
    (server, session), told = talking, radio.told
    radio.will("wait")
    assert "not known" in _press(server, session)["lines"]["changed"]
    assert server.get(f"v1/sessions/{session}")["in_effect"] is None
    assert radio.told == told + 1


def test_a_server_that_dies_while_it_applies(talking: tuple[Server, str], radio: Radio, operator: Operator) -> None:
    server, session = talking
    radio.will("wait")
    plan, told = server.plan(session), radio.told

    def press() -> None:
        with pytest.raises(httpx2.HTTPError):
            server.post(f"v1/sessions/{session}/confirm", {"plan": plan})

    pressing = threading.Thread(target=press)
    pressing.start()
    while radio.told == told:
        time.sleep(0.05)
    server.kill()
    pressing.join()
    radio.will("obey")
    operator.start()
    again = operator.server
    held = again.get(f"v1/sessions/{session}")
    assert (held["in_effect"], held["plan"]) == (None, None)
    assert again.post(f"v1/sessions/{session}/confirm", {"plan": plan}).status_code == 409
    turns = again.get(f"v1/sessions/{session}")["turns"]
    assert (len(turns), turns[-1]["by"]) == (4, "local")
    assert "not known" in turns[-1]["lines"]["changed"]
    again.say(session, "at most 8 W")
    assert _press(again, session)["stage"] == "applied"
    assert radio.told == told + 2


def test_a_store_that_fails_once_the_base_station_was_told(talking: tuple[Server, str], radio: Radio) -> None:
    (server, session), told = talking, radio.told
    with contextlib.closing(sqlite3.connect(server.store, isolation_level=None)) as store:
        store.execute("CREATE TRIGGER full BEFORE INSERT ON audit_turn BEGIN SELECT RAISE(ABORT, 'disk full'); END")
        done = server.post(f"v1/sessions/{session}/confirm", {"plan": server.plan(session)})
        store.execute("DROP TRIGGER full")
    assert (done.status_code, radio.told) == (500, told + 1)
    assert server.get(f"v1/sessions/{session}")["in_effect"] is None
    server.say(session, "how sure is this?")
    held = server.get(f"v1/sessions/{session}")
    assert (held["in_effect"], held["plan"], len(held["turns"])) == (None, None, 5)
    assert "not known" in held["turns"][3]["lines"]["changed"]


def test_a_worker_that_died_idle_is_replaced_and_nobody_notices(talking: tuple[Server, str]) -> None:
    server, session = talking
    for line in ("how sure is this?", "at most 8 W"):
        server.end_workers()
        assert server.say(session, line)["stage"] in ("answered", "planned")


def test_what_is_being_applied_can_be_neither_cancelled_nor_removed(talking: tuple[Server, str], radio: Radio) -> None:
    server, session = talking
    radio.will("dawdle")
    told, plan = radio.told, server.plan(session)
    path, prefer = f"v1/sessions/{session}/confirm", {"Prefer": "respond-async"}
    job = server.post(path, {"plan": plan}, headers=prefer).json()
    while radio.told == told:
        time.sleep(0.05)
    assert server.get(f"v1/sessions/{session}")["in_effect"] is None
    with server.client as client:
        assert client.delete(f"v1/jobs/{job['id']}").status_code == 204
        assert client.delete(f"v1/cells/{server.get(f'v1/sessions/{session}')['cell']}").status_code == 204
        ended = client.get(f"v1/jobs/{job['id']}").json()
    assert (ended["state"], ended["result"]["stage"]) == ("done", "applied")
    assert server.get(f"v1/sessions/{session}")["plan"] is None


class _Failing(BaseStation):
    """A base station that fails at every second attempt."""

    name = "failing"
    attempts = 0

    def apply(self, decision: Decision) -> Outcome:
        type(self).attempts += 1
        if type(self).attempts % 2 == 0:
            raise OSError("no answer")
        return self.read_back(decision)


def test_taken_up_it_is_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Refused, put back, broken off: each turn told again is as it was told, and nothing is decided or told anew."""

    def failing(tools: object, scene: Any) -> BaseStation:
        del tools
        return _Failing(scene)

    def nothing_is_decided(*_: object) -> Decision:
        raise AssertionError("a decision was made again")

    monkeypatch.setenv("WIRELESSAGENT_STORE", "yes")
    monkeypatch.setattr(hosted, "station_of", failing)
    monkeypatch.setattr(_Failing, "attempts", 0)
    request = ChatRequest(seed=1, store=str(tmp_path / "store.sqlite3"))
    talk = Hosted(request, "one", silent)
    for line in ("highest total rate", "at most 10 W", "at most 9 W", "undo", "at most 8 W"):
        talk.say(line, silent)
        talk.say("yes", silent)
        if talk.turns[-1].waits:
            talk.press("yes", silent)
    talk.say("at most 7 W", silent)
    talk.broke_off("yes", silent)
    assert {turn.record.stage for turn in talk.turns} >= {"planned", "applied", "reverted", "nothing"}
    told = _Failing.attempts
    monkeypatch.setattr(hosted, "decided", nothing_is_decided)
    again = Hosted(request, "one", silent)
    for line in ("how sure is this?", "status"):
        Hosted(request, "one", silent).say(line, silent)
        talk.catch_up(silent)
        again.catch_up(silent)
    assert _Failing.attempts == told
    for one, other in zip(talk.turns, again.turns, strict=True):
        assert (one.in_effect, one.waits) == (other.in_effect, other.waits)
        for name in ("stage", "lines", "intent", "at_utc", "request", "awaits", "reply"):
            assert getattr(one.record, name) == getattr(other.record, name), name


def test_taken_up_no_language_model_is_asked_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What its line meant is what was recorded, however the model would read it by now."""
    pytest.importorskip("pydantic_ai")
    limits = [{"constraint": "max_power_w", "figure": 10}]
    said = {"kind": "allocate", "objective_words": "the crowd is uploading", "constraints": limits}
    first, later = (meaning(**said, objective=aim) for aim in ("max_rate", "max_min_rate"))
    monkeypatch.setenv("WIRELESSAGENT_STORE", "yes")
    with StubLlm([first, *[later] * 9]) as stub:
        for name, value in (("BASE_URL", stub.url), ("MODEL", "stub"), ("API_KEY", "none")):
            monkeypatch.setenv(f"WIRELESSAGENT_LLM_{name}", value)
        request = ChatRequest(seed=1, recogniser="llm", store=str(tmp_path / "store.sqlite3"))
        talk = Hosted(request, "one", silent)
        talk.say("the crowd is uploading, keep it at most 10 W", silent)
        talk.press("yes", silent)
        asked = len(stub.requests)
        again = Hosted(request, "one", silent)
        assert (len(stub.requests), asked) == (1, 1)
    assert talk.turns[0].record.intent["objective"] == "max_rate"
    assert [turn.record.stage for turn in again.turns] == ["planned", "applied"]
    for one, other in zip(talk.turns, again.turns, strict=True):
        assert (one.in_effect, one.record.request) == (other.in_effect, other.record.request)
        assert (one.record.recogniser, one.record.intent) == (other.record.recogniser, other.record.intent)


def test_a_press_is_what_it_is_behind_any_line() -> None:
    talk = Hosted(ChatRequest(seed=1, no_store=True), "one", silent)
    talk.say("highest total rate", silent)
    talk.say("export this as TS 28.312", silent)
    assert talk.turns[-1].waits
    talk.press("yes", silent)
    assert (talk.turns[-1].record.stage, talk.turns[-1].in_effect) == ("applied", 3)


def test_a_worker_that_is_gone_before_it_has_begun_is_replaced_once() -> None:
    async def work() -> None:
        environment = {"WIRELESSAGENT_COMPILE": "never"}
        workers = Workers(time_limit_s=60, environment=environment, names=PublicNames({}, []))
        first = await workers.do("forms", _unheard)
        command = ["pgrep", "-P", str(os.getpid()), "-f", "service.worker"]
        found = subprocess.run(command, capture_output=True, text=True, check=True)
        for number in found.stdout.split():
            os.kill(int(number), signal.SIGKILL)  # which the event loop has not heard of yet
        assert await workers.do("forms", _unheard) == first
        await workers.close()

    asyncio.run(work())


def test_no_caller_takes_all_the_room_for_jobs(tmp_path: Path) -> None:
    async def endless(tell: Callable[[dict[str, Any]], None]) -> None:
        del tell
        await asyncio.Event().wait()

    async def work() -> None:
        with contextlib.closing(Ledger.open(str(tmp_path / "store.sqlite3"))) as ledger:
            jobs = Jobs(ledger, 4)
            going = [jobs.start("viewer", endless) for _ in range(3)]
            with pytest.raises(TooMuchError, match="3 jobs of yours"):
                jobs.start("viewer", endless)
            going.append(jobs.start("operator", endless))
            with pytest.raises(TooMuchError, match="4 jobs go on"):
                jobs.start("operator", endless)
            for job in going:
                job.cancel()

    asyncio.run(work())


def test_a_store_that_refuses_once_is_told_of_a_job_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wirelessagent.service.jobs._BEAT_S", 0.05)

    async def work() -> None:
        with contextlib.closing(Ledger.open(str(tmp_path / "store.sqlite3"))) as ledger:
            put, refused, over = ledger.put, list[str](), asyncio.Event()

            def refusing(kind: str, id: str, *args: Any, **kwargs: Any) -> int:
                if kwargs["seen"] and not refused:
                    refused.append(id)
                    raise StoreError("the database is locked")
                return put(kind, id, *args, **kwargs)

            async def wait(tell: Callable[[dict[str, Any]], None]) -> None:
                del tell
                await over.wait()

            monkeypatch.setattr(ledger, "put", refusing)
            jobs = Jobs(ledger, 4)
            job = jobs.start("viewer", wait)
            await jobs.share(job)
            while (item := ledger.find("job", job.id)) is None or item.version < 3:
                await asyncio.sleep(0.02)
            over.set()
            await jobs.settled(job)
            assert refused == [job.id]
            assert ledger.find("job", job.id).data["state"] == "done"

    asyncio.run(asyncio.wait_for(work(), 20))


def _unheard(event: dict[str, Any]) -> None:
    del event

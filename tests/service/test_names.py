"""Nothing that leaves the server names a path of its machine."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import pytest
from servers import Server, started

from wirelessagent.service.names import PublicNames

pytestmark = pytest.mark.machine_code

OCTETS = {"Content-Type": "application/octet-stream"}


def test_places_have_names() -> None:
    names = PublicNames({"/srv/cell/store.db": "this server"}, ["/srv/cell"])

    def told(said: Any) -> Any:
        line = json.dumps(said, ensure_ascii=True).encode()
        return json.loads(names.told(line, {"/srv/cell/observations/1f.csv": "señal.csv"}))

    assert told("no table in /srv/cell/store.db") == "no table in this server"
    assert told(["/srv/cell/observations/1f.csv: line 2"]) == ["señal.csv: line 2"]
    assert told({"a": "/srv/cell/other/é.csv\nnext"}) == {"a": "é.csv\nnext"}
    assert told("in\n/srv/cell/a.db or sqlite:////srv/cell/b.db") == "in\na.db or sqlite:///b.db"
    assert told("at '/srv/cell', or \"/srv/cell/x y") == "at 'cell', or \"x y"
    for said in ("/srv/cellar/a.csv", "/srv", "a bit/s/Hz", "https://example.com/srv/cell", "1/2 of /etc/passwd"):
        assert told(said) == said


def test_what_fails_names_no_path(server: Server) -> None:
    folder = str(server.store.parent)
    answers = [
        server.post("v1/observations?name=my.csv", content=b"1,x\n", headers=OCTETS),
        server.post("v1/observations?name=my.h5", content=b"\x89HDF\r\n\x1a\n" + bytes(400), headers=OCTETS),
    ]
    seen = server.post("v1/observations?name=mine.csv", content=b"1,2\n3,4\n", headers=OCTETS)
    solved = server.post("v1/operations/solve", {"observation": seen.json()["id"], "objective": "max_rate"},
                         headers={"Prefer": "respond-async"})  # fmt: skip
    with server.client as client:
        events = client.get(f"{solved.headers['Location']}/events")
        answers += [
            seen, events, client.get("v1/history"), client.get("v1/history?session=nobody"),
            client.get("v1/allocations/99999"), client.get("v1/intents/99999"),
        ]  # fmt: skip
    assert "my.csv" in answers[0].json()["detail"]
    assert "mine.csv: " in events.text
    assert server.get("v1/history")["store"] == "this server"
    for answer in answers:
        assert folder not in answer.text


def test_a_store_that_fails_is_told_of_in_the_log(tmp_path: Path) -> None:
    store = tmp_path / "store.sqlite3"
    with started(store) as server, server.client as client:
        assert client.get("readyz").status_code == 200  # it is up before its store fails
        with sqlite3.connect(store) as broken:
            broken.execute("ALTER TABLE service_item RENAME TO gone")
        for answer in (client.get("v1/cells"), client.get("readyz"), client.post("v1/operations/simulate", json={})):
            assert str(tmp_path) not in answer.text
        failed = client.get("readyz")
        assert (failed.status_code, failed.headers["content-type"]) == (503, "application/problem+json")
        assert "gone" not in failed.text
    assert "service_item" in store.with_suffix(".log").read_text()


def test_behind_a_proxy_the_log_and_the_cache_judge_the_path_that_routes_know(tmp_path: Path) -> None:
    from servers import token_for

    store = tmp_path / "store.sqlite3"
    token = token_for(store, "operator", "operator")
    with started(store, "--base-path", "/cell", token=token) as server, server.client as client:
        root = server.url.removesuffix("/cell/")
        for prefix in ("", "/cell"):
            page = client.get(f"{root}{prefix}/console/")
            assert (page.status_code, page.headers.get("cache-control")) == (200, None), prefix
            assert client.get(f"{root}{prefix}/healthz").status_code == 200
            headers = {"Content-Type": "text/csv"}
            refused = client.post(f"{root}{prefix}/plugin/sense", content=b"1,2", headers=headers)
            assert (refused.status_code, refused.json()["ok"]) == (200, False)
            job = client.post(f"{root}{prefix}/v1/operations/plugins", json={}, headers={"Prefer": "respond-async"})
            assert job.headers["location"].startswith("/cell/v1/jobs/")
    told = [json.loads(line) for line in store.with_suffix(".log").read_text().splitlines() if line.startswith("{")]
    paths = {line["path"] for line in told if "path" in line}
    assert "/healthz" not in paths
    assert {"/console/", "/plugin/sense", "/v1/operations/plugins"} <= paths
    assert not any(path.startswith("/cell") for path in paths)

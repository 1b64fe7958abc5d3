"""Conversations over REST: a plan waits, is applied once, and nothing that was answered is lost."""

from __future__ import annotations

import json
import threading
import time
from pathlib import Path

import httpx2
import pytest
from servers import Server

pytestmark = pytest.mark.machine_code

_FILE = {"Content-Type": "application/octet-stream"}


def test_the_first_screen_is_alive_and_nothing_was_computed_for_it(server: Server) -> None:
    cell = next(cell for cell in server.get("v1/console")["cells"] if cell["demonstration"])
    session = server.get(f"v1/sessions/{cell['session']}")
    assert [turn["stage"] for turn in session["turns"]] == ["planned", "applied", "planned"]
    assert session["in_effect"] == 2
    assert session["plan"]["turn"] == 3
    assert len(server.get(f"v1/sessions/{session['id']}/channel")["gain"]) == len(cell["user_names"])


def test_a_line_applies_nothing_and_a_plan_is_applied_once(server: Server) -> None:
    session = server.cell()["session"]
    assert server.say(session, "Save power, at least 1 Mbit/s each")["stage"] == "planned"
    refused = server.say(session, "yes, apply it")
    assert refused["stage"] == "nothing"
    assert refused["outcome"] is None
    plan = server.plan(session)
    answers = list[httpx2.Response]()

    def press() -> None:
        answers.append(server.post(f"v1/sessions/{session}/confirm", {"plan": plan}))

    pressing = [threading.Thread(target=press) for _ in range(6)]
    for one in pressing:
        one.start()
    for one in pressing:
        one.join()
    assert sorted(answer.status_code for answer in answers) == [200, 409, 409, 409, 409, 409]
    turns = server.get(f"v1/sessions/{session}")["turns"]
    assert [turn["stage"] for turn in turns] == ["planned", "nothing", "applied"]


def test_a_plan_that_was_dropped_cannot_be_applied(server: Server) -> None:
    session = server.cell()["session"]
    server.say(session, "highest total rate")
    plan = server.plan(session)
    assert server.post(f"v1/sessions/{session}/discard", {"plan": plan}).status_code == 200
    assert server.post(f"v1/sessions/{session}/confirm", {"plan": plan}).status_code == 409
    assert server.get(f"v1/sessions/{session}")["plan"] is None


def test_who_has_it_already_is_told_so(server: Server) -> None:
    session = server.cell()["session"]
    with server.client as client:
        first = client.get(f"v1/sessions/{session}")
        again = {"If-None-Match": first.headers["etag"]}
        assert client.get(f"v1/sessions/{session}", headers=again).status_code == 304
        server.say(session, "highest total rate")
        assert client.get(f"v1/sessions/{session}", headers=again).status_code == 200


def test_the_curve_that_a_decision_lies_on(server: Server) -> None:
    session = server.cell("small", num_users=3, num_subcarriers=6)["session"]
    rate = server.say(session, "highest total rate, at most 10 W")["decision"]["value"]
    least = server.say(session, "save power, at least 100 kbit/s each")["decision"]["value"]
    over_budgets = server.get(f"v1/sessions/{session}/turns/1/trade-off")
    over_promises = server.get(f"v1/sessions/{session}/turns/2/trade-off")
    for curve, value in ((over_budgets, rate), (over_promises, least)):
        points = curve["points"]
        assert [point["value"] for point in points if point["at"] == curve["here"]] == [pytest.approx(value, rel=1e-9)]
        rising = [point["value"] for point in points if point["status"] in ("optimal", "feasible")]
        assert len(rising) > 2
        assert rising == sorted(set(rising))
    assert over_budgets["points"][-1]["at"] == 20.0
    assert (over_promises["varies"], over_promises["unit"]) == ("promises", "W")
    with server.client as client:
        assert client.get(f"v1/sessions/{session}/turns/3/trade-off").status_code == 404


def test_a_picture_is_there_where_it_is_asked_for(server: Server) -> None:
    pytest.importorskip("matplotlib")
    kept = server.post("v1/observations?name=hall.csv", content=b"1e-9,2e-9\n2e-9,1e-9\n", headers=_FILE).json()
    asked = {"observation": kept["id"], "objective": "max_rate"}
    drawn = server.post("v1/operations/solve", {**asked, "picture": True}).json()
    assert drawn["picture"].startswith("<?xml")
    assert drawn["record"]["plot"] is None
    assert "picture.svg" not in str(drawn["blocks"])
    assert server.post("v1/operations/solve", asked).json()["picture"] is None


def test_a_file_is_spoken_of_by_the_name_that_its_sender_gave(server: Server) -> None:
    refused = server.post("v1/observations?name=hall.csv", content=b"1,2\nthree,4\n", headers=_FILE).json()
    assert refused["detail"].startswith("hall.csv: ")


def test_undo_waits_for_its_own_yes(server: Server) -> None:
    session = server.cell()["session"]
    for line in ("highest total rate", "at most 10 W"):
        server.say(session, line)
        server.post(f"v1/sessions/{session}/confirm", {"plan": server.plan(session)})
    assert server.get(f"v1/sessions/{session}")["in_effect"] == 4
    assert server.post(f"v1/sessions/{session}/undo").json()["stage"] == "planned"
    assert server.get(f"v1/sessions/{session}")["in_effect"] == 4
    done = server.post(f"v1/sessions/{session}/confirm", {"plan": server.plan(session)})
    assert done.json()["stage"] == "undone"
    assert server.get(f"v1/sessions/{session}")["in_effect"] == 2


def test_the_same_request_sent_twice_is_done_once(server: Server) -> None:
    session = server.cell()["session"]
    first = server.say(session, "highest total rate", headers={"Idempotency-Key": "once"})
    assert server.say(session, "highest total rate", headers={"Idempotency-Key": "once"}) == first
    assert len(server.get(f"v1/sessions/{session}")["turns"]) == 1
    other = server.post(f"v1/sessions/{session}/turns", {"text": "undo"}, headers={"Idempotency-Key": "once"})
    assert other.status_code == 409


def test_a_request_with_a_key_is_done_though_its_caller_went_away(server: Server) -> None:
    session, key = server.cell()["session"], {"Idempotency-Key": "gone"}
    body = b'{"text":"highest total rate"}'
    head = (
        f"POST /v1/sessions/{session}/turns HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        f"Idempotency-Key: gone\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    with server.line() as line:
        line.sendall(head.encode() + body)
        time.sleep(0.05)
    assert server.say(session, "highest total rate", headers=key)["number"] == 1
    assert len(server.get(f"v1/sessions/{session}")["turns"]) == 1


def test_the_stages_of_a_job_can_be_followed_from_any_of_them(server: Server) -> None:
    session = server.cell()["session"]
    job = server.post(f"v1/sessions/{session}/turns", {"text": "fair"}, headers={"Prefer": "respond-async"})
    assert job.status_code == 202
    with server.client as client:
        events = _events(client.get(f"{job.headers['Location']}/events").text)
        later = _events(client.get(f"{job.headers['Location']}/events", headers={"Last-Event-ID": "2"}).text)
    assert [kind for _, kind, _ in events][-1] == "done"
    assert {"sense", "repair", "decide"} <= {said.get("stage") for _, kind, said in events if kind == "stage"}
    assert later == events[2:]


def _events(text: str) -> list[tuple[int, str, dict[str, object]]]:
    found = list[tuple[int, str, dict[str, object]]]()
    for block in text.strip().split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.split("\n") if not line.startswith(":"))
        if fields:
            found.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))
    return found


def test_a_job_is_cancelled_and_the_conversation_goes_on(server: Server) -> None:
    session = server.cell()["session"]
    server.say(session, "highest total rate")
    job = server.post(f"v1/sessions/{session}/turns", {"text": "fair"}, headers={"Prefer": "respond-async"}).json()
    with server.client as client:
        assert client.delete(f"v1/jobs/{job['id']}").status_code == 204
        state = client.get(f"v1/jobs/{job['id']}").json()["state"]
    assert state in ("running", "cancelled", "done")
    assert server.say(session, "at most 10 W")["request"]["constraints"] == {"max_power_w": 10.0}


def test_a_file_becomes_a_cell_and_its_allocation_a_file(server: Server, tmp_path: Path) -> None:
    gains = "1e-9,2e-9,,4e-9\n2e-9,1e-9,3e-9,1e-9\n"
    seen = server.post("v1/observations?name=gains.csv", content=gains,
                       headers={"Content-Type": "application/octet-stream"}).json()  # fmt: skip
    assert (seen["num_users"], seen["num_subcarriers"], seen["missing"]) == (2, 4, 1)
    assert seen["gain"][0][2] is None
    cell = server.post("v1/cells", {"name": "measured", "options": {"csi": seen["id"]}}).json()
    turn = server.say(cell["session"], "highest total rate")
    with server.client as client:
        for form, start in (
            ("csv", b"subcarrier"),
            ("json", b"{"),
            ("npz", b"PK"),
            ("png", b"\x89PNG"),
            ("svg", b"<?xml"),
        ):
            content = client.get(f"v1/allocations/{turn['stored']}?format={form}").content
            assert content.startswith(start), (form, content[:40])
        assert client.delete(f"v1/observations/{seen['id']}").status_code == 409
        assert client.delete(f"v1/cells/{cell['id']}").status_code == 204
        assert client.delete(f"v1/observations/{seen['id']}").status_code == 204

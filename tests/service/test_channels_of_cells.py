"""A cell whose observation is gone says so, and goes on with another."""

from __future__ import annotations

import pytest
from servers import Server

from wirelessagent.store.ledger import Ledger

pytestmark = pytest.mark.machine_code

OCTETS = {"Content-Type": "application/octet-stream"}


def _observe(server: Server, gains: str, **more: str) -> str:
    seen = server.post("v1/observations", content=gains, headers=OCTETS, params={"name": "gains.csv", **more})
    assert seen.status_code == 201, seen.text
    return seen.json()["id"]


def test_a_cell_whose_observation_is_gone(server: Server) -> None:
    with server.client as client:
        first = _observe(server, "-80,-90\n-85,-95\n", unit="db")
        cell = server.post("v1/cells", {"name": "north", "options": {"csi": first}}).json()
        server.say(cell["session"], "highest total rate")
        ledger = Ledger.open(server.at)
        ledger.drop("observation", first)
        ledger.close()
        gone = server.post(f"v1/sessions/{cell['session']}/turns", {"text": "fair"})
        assert gone.status_code == 409
        assert all(part in gone.json()["detail"] for part in (first, "'north'", f"/v1/cells/{cell['id']}/observation"))
        missing = client.put(f"v1/cells/{cell['id']}/observation", json={"observation": first})
        assert missing.status_code == 404
        second = _observe(server, "1e-9,2e-9,3e-9\n2e-9,1e-9,1e-9\n1e-9,1e-9,1e-9\n")
        moved = client.put(f"v1/cells/{cell['id']}/observation", json={"observation": second}).json()
        assert (moved["num_subcarriers"], len(moved["user_names"])) == (3, 3)
        assert moved["session"] != cell["session"]
        turn = server.say(moved["session"], "highest total rate")
        assert len(turn["decision"]["owner"]) == 3
        assert client.delete(f"v1/observations/{second}").status_code == 409
        own = client.put(f"v1/cells/{cell['id']}/observation", json={"observation": None}).json()
        assert len(own["user_names"]) > 3
        assert client.delete(f"v1/observations/{second}").status_code == 204
        assert server.say(own["session"], "highest total rate")["stage"] == "planned"

"""The plug-in document by the rules of those who import it, and the plug-in by its document."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from openapi_spec_validator import OpenAPIV30SpecValidator
from servers import Server, Signed, started

pytestmark = pytest.mark.machine_code

ANSWERED = ("ok", "error")


@pytest.fixture(scope="module")
def document(server: Server) -> dict[str, Any]:
    return server.get("plugin/openapi.json")


def operations(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            yield path, method, operation


def parts(of: Any) -> Iterator[dict[str, Any]]:
    """All objects inside of a document."""
    if isinstance(of, dict):
        yield of
        for one in of.values():
            yield from parts(one)
    elif isinstance(of, list):
        for one in of:
            yield from parts(one)


def test_it_is_openapi_3_0_3(document: dict[str, Any]) -> None:
    assert document["openapi"] == "3.0.3"
    OpenAPIV30SpecValidator(document).validate()


def test_it_keeps_the_rules_of_importers(document: dict[str, Any], server: Server) -> None:
    assert document["servers"] == [{"url": server.url.rstrip("/")}]
    assert len(document["info"]["description"]) > 50
    assert document["security"] == [{"token": []}]
    scheme = document["components"]["securitySchemes"]["token"]
    assert (scheme["type"], scheme["scheme"]) == ("http", "bearer")
    found = list(operations(document))
    assert len(found) <= 12
    assert len({operation["operationId"] for _, _, operation in found}) == len(found)
    for path, method, operation in found:
        assert path.startswith("/plugin/")
        assert method in ("get", "post")
        assert operation["operationId"].isidentifier()
        assert 5 < len(operation["summary"]) <= 60
        assert 40 < len(operation["description"]) <= 500
        assert list(operation["responses"]) == ["200"]
        answer = operation["responses"]["200"]["content"]
        assert list(answer) == ["application/json"]
        assert answer["application/json"]["schema"]["type"] == "object"
        assert answer["application/json"]["schema"]["required"] == ["ok"]
        assert set(ANSWERED) < set(answer["application/json"]["schema"]["properties"])
        assert ("requestBody" in operation) == (method == "post")
        for parameter in operation.get("parameters", ()):
            assert parameter["in"] == "query"
            assert parameter["description"]
            assert parameter["schema"]["type"] in ("string", "integer", "number", "boolean")
        if method == "post":
            (content,) = operation["requestBody"]["content"].items()
            assert content[0] == "application/json"
            assert content[1]["schema"]["type"] == "object"
            for field in content[1]["schema"]["properties"].values():
                assert field["type"] in ("string", "integer", "number", "boolean")
                assert field["description"]
    for part in parts(document):
        assert "$ref" not in part
        assert "anyOf" not in part
        assert "const" not in part
        assert part.get("type") != "null"
        assert not isinstance(part.get("type"), list)
        assert isinstance(part.get("exclusiveMinimum", True), bool)


def test_it_has_what_the_paper_has(document: dict[str, Any]) -> None:
    names = {operation["operationId"] for _, _, operation in operations(document)}
    assert names == {
        "cells", "sense", "repair", "solve_max_rate", "solve_min_power", "solve_max_energy_efficiency", "ask",
        "move_cell", "propose", "apply", "explain", "history",
    }  # fmt: skip
    assert len(names) <= 12  # most platforms take a dozen


def test_a_public_address(tmp_path: Path) -> None:
    with started(tmp_path / "store.sqlite3", "--public-url", "https://cells.example/wa/") as server:
        host = {"Host": "cells.example"}
        assert server.get("plugin/openapi.json", headers=host)["servers"] == [{"url": "https://cells.example/wa"}]


def call(server: Server, operation: str, **body: Any) -> dict[str, Any]:
    answer = server.post(f"plugin/{operation}", body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_collector_predictor_and_solvers(server: Server) -> None:
    seen = call(server, "sense", users=4, subcarriers=12, lost_share=0.3)
    assert (seen["ok"], seen["users"], seen["subcarriers"]) == (True, 4, 12)
    assert seen["missing"] > 0
    assert str(server.store.parent) not in json.dumps(seen)
    mended = call(server, "repair", observation=seen["observation"], method="nncf_paper")
    assert mended["missing"] == 0
    for solver, more, unit in (
        ("solve-max-rate", {"max_power_w": 10}, "bit/s"), ("solve-max-rate", {"method": "paper"}, "bit/s"),
        ("solve-min-power", {"min_rate_bps": 1e5}, "W"), ("solve-max-energy-efficiency", {}, "bit/J"),
    ):  # fmt: skip
        decided = call(server, solver, observation=mended["observation"], **more)
        assert decided["status"] in ("optimal", "feasible"), decided
        assert decided["unit"] == unit
        owned = [n for user in decided["allocation"] for n in user["subcarriers"]]
        assert len(owned) == len(set(owned)) <= 12
        power_w = sum(user["power_w"] for user in decided["allocation"])
        assert power_w == pytest.approx(decided["total_power_w"])
    unmet = call(server, "solve-min-power", observation=mended["observation"], min_rate_bps=1e9)
    assert (unmet["ok"], unmet["status"]) == (True, "infeasible")
    assert "allocation" not in unmet


def test_a_cell_is_moved_to_an_observation(server: Server) -> None:
    cell = server.cell()
    server.say(cell["session"], "highest total rate")
    seen = call(server, "sense", users=3, subcarriers=6)
    moved = call(server, "move-cell", cell=cell["id"], observation=seen["observation"])
    assert (moved["ok"], moved["cell"]["users"], moved["cell"]["subcarriers"]) == (True, 3, 6)
    assert server.get(f"v1/cells/{cell['id']}")["session"] != cell["session"]
    proposed = call(server, "propose", cell=cell["id"], text="highest total rate")
    assert proposed["plan"]
    for wrong in ({"observation": ""}, {"observation": "nobody"}):
        refused = call(server, "move-cell", cell=cell["id"], **wrong)
        assert (refused["ok"], bool(refused["error"])) == (False, True)
    assert server.plan(server.get(f"v1/cells/{cell['id']}")["session"]) == proposed["plan"]


def test_what_a_platform_leaves_blank_is_left_out(server: Server) -> None:
    seen = call(server, "sense", users=None, subcarriers="", lost_share=0, seed="7")
    assert (seen["users"], seen["subcarriers"], seen["missing"]) == (8, 20, 0)
    assert call(server, "repair", observation="") == {"ok": False, "error": "observation: Field required"}
    assert len(server.get("plugin/history?last=")["turns"]) <= 10


def test_a_plan_is_proposed_explained_and_applied_once(server: Server) -> None:
    cell = server.cell()
    proposed = call(server, "propose", cell=cell["id"], text="Save power, at least 1 Mbit/s each")
    assert proposed["stage"] == "planned"
    assert "Nothing was applied" in proposed["said"]
    assert call(server, "explain", cell=cell["id"])["stage"] == "answered"
    assert call(server, "apply", plan="another")["ok"] is False
    assert call(server, "apply", plan=proposed["plan"])["stage"] == "applied"
    again = call(server, "apply", plan=proposed["plan"])
    assert again == {"ok": False, "error": "this plan does not wait any more: look at what holds now"}
    told = server.get("plugin/history?last=1")["turns"]
    assert [turn["stage"] for turn in told] == ["applied"]
    known = server.get("plugin/cells")["cells"]
    assert cell["id"] in {one["id"] for one in known}


def test_the_record_of_a_solver_is_that_of_rest(server: Server) -> None:
    seen = call(server, "sense", users=3, subcarriers=8)["observation"]
    mine = call(server, "solve-min-power", observation=seen, min_rate_bps=2e5)
    form = {"observation": seen, "objective": "min_power", "min_rate_bps": 2e5}
    theirs = server.post("v1/operations/solve", form).json()["record"]
    assert {name: mine[name] for name in ("value", "bound", "status")} == {
        name: theirs[name] for name in ("value", "bound", "status")
    }
    assert [user["rate_bps"] for user in mine["allocation"]] == theirs["rate_bps"]


class TestErrors:
    @pytest.mark.parametrize(
        "body",
        [b"", b"{", b"[]", b"5", b'{"text": NaN}', b'{"users": 65}', b'{"more": 1}', b"[" * 50_000, b" " * 300_000],
    )
    def test_stand_inside_of_an_answer(self, server: Server, body: bytes) -> None:
        headers = {"Content-Type": "application/json"}
        for operation in ("sense", "repair", "propose", "apply"):
            answer = server.post(f"plugin/{operation}", content=body, headers=headers)
            assert answer.status_code == 200
            told = answer.json()
            if operation == "sense" and body == b"":
                assert told["ok"]
                continue
            assert set(told) == {"ok", "error"}
            assert told["ok"] is False
            assert "Traceback" not in told["error"]

    def test_of_another_type(self, server: Server) -> None:
        told = server.post("plugin/sense", content=b"a=1", headers={"Content-Type": "text/plain"}).json()
        assert told["ok"] is False

    def test_are_sent_where_they_must_be(self, guarded: Signed) -> None:
        with guarded.nobody.client as client:
            assert client.get("plugin/openapi.json").status_code == 200
            assert client.get("plugin/cells").status_code == 401
            assert client.post("plugin/sense", json={}).status_code == 401
            assert client.post("plugin/sense", content=b"x").status_code == 401
        assert guarded.viewer.post("plugin/sense", {}).status_code == 403
        assert guarded.viewer.get("plugin/cells")["ok"] is True
        with guarded.operator.client as client:
            assert client.get("plugin/sense").status_code == 405
            assert client.get("plugin/cells", headers={"X-API-Key": guarded.operator.token}).status_code == 200

"""The ready-made files for other agents and platforms work."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from servers import Server

pytestmark = pytest.mark.machine_code

ROOT = Path(__file__).parents[2]
FILES = ROOT / "examples" / "integrations"
WORKFLOWS = json.loads((FILES / "workflow.json").read_text(encoding="utf-8"))["workflows"]


def operations(server: Server) -> dict[str, tuple[str, str]]:
    paths = server.get("plugin/openapi.json")["paths"]
    return {one["operationId"]: (method, path) for path, methods in paths.items() for method, one in methods.items()}


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda workflow: workflow["name"])
def test_a_workflow_runs_node_by_node(server: Server, workflow: dict[str, Any]) -> None:
    known, cell = operations(server), server.cell()["id"]
    answers: dict[str, Any] = {"start": workflow["inputs"]}

    def filled(value: Any) -> Any:
        place = re.fullmatch(r"\{\{(\w+)\.(\w+)\}\}", value) if isinstance(value, str) else None
        return value if place is None else answers[place[1]][place[2]]

    for node in workflow["nodes"]:
        if "operation" not in node:
            assert filled(node["ask_a_person"])
            continue
        method, path = known[node["operation"]]
        body = {name: filled(value) for name, value in node["input"].items()}
        body |= {"cell": cell} if node["operation"] == "propose" else {}
        assert method == "post"
        answers[node["id"]] = server.post(path.lstrip("/"), body).json()
        assert answers[node["id"]]["ok"], answers[node["id"]]
    assert filled(workflow["output"])


def test_prompts_and_pages_name_operations_that_there_are(server: Server) -> None:
    known = set(operations(server))
    fields = {"said", "plan", "stage", "asked", "ok", "error"}
    prompt = (FILES / "agent_prompt.md").read_text(encoding="utf-8")
    assert set(re.findall(r"`(\w+)`", prompt)) <= known | fields
    page = (ROOT / "docs" / "integrations.md").read_text(encoding="utf-8")
    assert known <= set(re.findall(r"`(\w+)`", page))
    for name in re.findall(r"`(\w+\.(?:json|py|md))`", page):
        assert (FILES / name).is_file(), name
    for name in re.findall(r"\]\(([\w.]+)\)", (FILES / "README.md").read_text(encoding="utf-8")):
        assert (FILES / name).is_file(), name


def test_the_client_in_python_applies_after_a_yes(tmp_path: Path) -> None:
    environment = {**os.environ, "WIRELESSAGENT_STORE_URL": str(tmp_path / "store.sqlite3")}
    done = subprocess.run(
        [sys.executable, FILES / "mcp_client.py", "user 3 at least 1.5 Mbit/s"], input="yes\n", capture_output=True,
        text=True, env=environment, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Nothing was applied. The plan" in done.stdout
    assert "Set on the simulated base station and checked" in done.stdout


def test_configurations_start_what_there_is() -> None:
    local = json.loads((FILES / "mcp_stdio.json").read_text(encoding="utf-8"))["mcpServers"]["wirelessagent"]
    command = [sys.executable, "-m", local["command"], *local["args"], "--help"]
    assert "MCP" in subprocess.run(command, capture_output=True, text=True, check=True).stdout
    remote = json.loads((FILES / "mcp_http.json").read_text(encoding="utf-8"))["mcpServers"]["wirelessagent"]
    assert remote["url"].endswith("/mcp")
    assert remote["headers"]["Authorization"].startswith("Bearer wa_")

"""The operations as an LLM's tools: typed, reading only, and all that it can call."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from llm_stub import Reply, StubLlm, call, error, say
from pydantic import ValidationError

from wirelessagent.language.llm.client import LlmSettings
from wirelessagent.model.errors import InputError
from wirelessagent.operations.catalogue import OPERATIONS, load
from wirelessagent.operations.forms import form_of
from wirelessagent.operations.llm_tools import OFFERED, llm_tools, tool_of
from wirelessagent.plugins import names

pytest.importorskip("pydantic_ai")

CHANNEL = Path(__file__).parents[2] / "examples" / "data" / "measured_wifi.npz"


def tools_by_name(channel: Path | None = CHANNEL) -> dict[str, Any]:
    return {tool.name: tool for tool in llm_tools(channel)}


def test_the_set_is_what_reads_only() -> None:
    assert set(tools_by_name()) == {"simulate", "repair", "solve", "compare", "plugins"}
    assert set(tools_by_name(None)) == {"simulate", "plugins"}


def test_no_operation_that_acts_or_records_is_offered() -> None:
    acting = ("apply", "ask", "chat", "undo", "history", "reproduce", "evaluate", "export", "serve", "run")
    assert not [operation.name for operation in OFFERED if operation.name.split()[0] in acting]


@pytest.mark.parametrize("name", OPERATIONS)
def test_no_form_has_a_path(name: str) -> None:
    """Not even of the operations that are not offered: forms leave out every path, also among plug-in options."""
    schema = form_of(load(name)).model_json_schema()
    assert '"format": "path"' not in json.dumps(schema)
    fields = {field for form in [schema, *schema.get("$defs", {}).values()] for field in form.get("properties", {})}
    assert not fields & {"path", "csi", "out", "plot", "file"}


def test_plugins_are_choices(tmp_path: Path) -> None:
    schema = json.dumps(tools_by_name()["solve"].form.model_json_schema())
    for kind in ("objective", "method", "repairer"):
        assert all(f'"{name}"' in schema for name in names(kind))  # type: ignore[arg-type]
    sources = json.dumps(tools_by_name()["simulate"].form.model_json_schema()["properties"]["source"])
    assert '"rayleigh"' in sources
    assert '"file"' not in sources  # it needs a path


@pytest.mark.parametrize(
    ("name", "filled"),
    [
        ("simulate", {"out": "x.npz"}), ("simulate", {"source": "file"}),
        ("simulate", {"source_options": {"path": "/etc/passwd"}}), ("solve", {"path": "/etc/passwd"}),
        ("solve", {"plot": "x.png"}), ("solve", {"objective": "steal"}), ("solve", {"apply": True}),
        ("compare", {"plot": "x.png"}), ("repair", {"out": "x.npz"}),
    ],
)  # fmt: skip
def test_what_a_form_lacks_is_refused(name: str, filled: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        tools_by_name()[name].form.model_validate(filled)


def test_tools_compute_and_write_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    tools = tools_by_name()
    solved = tools["solve"].run(tools["solve"].form(objective="min_power", min_rate_bps=1e6))
    assert "optimal" in solved
    assert "antenna 1 | " in solved
    drawn = tools["simulate"].run(tools["simulate"].form.model_validate({"source_options": {"num_users": 3}}))
    assert "user 3" in drawn
    assert "max_min_rate" in tools["plugins"].run(tools["plugins"].form(kind="objective"))
    assert list(tmp_path.iterdir()) == []


def test_bad_values_are_told_in_words() -> None:
    tools = tools_by_name()
    with pytest.raises(InputError):
        tools["solve"].run(tools["solve"].form(max_power_w=-1.0))
    with pytest.raises(InputError):
        tool_of(OFFERED[-1]).run(tools["plugins"].form(kind="weapons"))


def test_memory_is_not_for_an_llm_to_fill() -> None:
    tool = tools_by_name()["simulate"]
    for options in ({"num_users": 10**9}, {"num_users": 5000, "num_subcarriers": 3000}):
        with pytest.raises(InputError, match="too large"):
            tool.run(tool.form.model_validate({"source_options": options}))


class TestAssistant:
    """Questions answered with tools, before a real server."""

    def ask(self, *replies: Reply, timeout_s: float = 120.0) -> tuple[str, StubLlm]:
        from wirelessagent.language.llm.tools import LlmAssistant

        with StubLlm(list(replies)) as stub:
            settings = LlmSettings(base_url=stub.url, model="m", timeout_s=timeout_s)
            assistant = LlmAssistant(llm_tools(CHANNEL), settings)
            return assistant.answer("What power would 1 Mbit/s each need?"), stub

    def why_not(self, *replies: Reply) -> str:
        from wirelessagent.language.llm.client import NoAnswer

        with pytest.raises(NoAnswer) as caught:
            self.ask(*replies)
        return str(caught.value)

    solve = call("solve", {"objective": "min_power", "min_rate_bps": 1e6})

    def test_calls_a_tool_and_repeats_it(self) -> None:
        answer, stub = self.ask(self.solve, say("It would take 967 µW."))
        assert answer == "It would take 967 µW."
        result = stub.requests[1]["messages"][-1]
        assert result["role"] == "tool"
        assert "967 µW" in result["content"]
        assert {tool["function"]["name"] for tool in stub.requests[0]["tools"]} == set(tools_by_name())

    def test_refusals_of_tools_go_back(self) -> None:
        bad = call("solve", {"objective": "min_power", "min_rate_bps": 1e6, "max_power_w": -1})
        answer, stub = self.ask(bad, self.solve, say("967 µW."))
        assert answer == "967 µW."
        assert "-1" in json.dumps(stub.requests[1]["messages"][-1])

    def test_invented_figures_are_asked_back_once(self) -> None:
        assert self.ask(self.solve, say("About 3 W."), say("967 µW."))[0] == "967 µW."
        assert "not said" in self.why_not(self.solve, say("About 3 W."), say("About 3 W."))

    def test_unknown_tools_do_nothing(self) -> None:
        assert "no answer" in self.why_not(call("apply", {}), call("apply", {}))
        assert "no answer" in self.why_not(*[call("shell", {"command": "reboot"})] * 9)

    def test_endless_calls_end(self) -> None:
        assert "no answer" in self.why_not(*[call("plugins", {"kind": "objective"})] * 50)

    def test_server_error(self) -> None:
        assert "HTTP 500" in self.why_not(self.solve, error(500))

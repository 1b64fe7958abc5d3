"""MCP with the SDK's own client, over both transports and in both ages of the protocol."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import subprocess
import sys
from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import Any

import anyio
import httpx2
import jsonschema
import pytest
from mcp import Client, MCPError
from mcp.client.stdio import StdioServerParameters
from mcp.client.streamable_http import streamable_http_client
from mcp.types import CallToolResult, ElicitResult
from servers import Server, Signed, mcp_headers

from wirelessagent.operations.catalogue import OPERATIONS, load
from wirelessagent.operations.forms import can_be_filled

pytestmark = pytest.mark.machine_code

LINE = "Save power, at least 1 Mbit/s each"
UNCLEAR = "yesterday nobody asked to save power"
OWN = {
    "cells", "say", "apply", "discard", "undo", "show_allocation", "observe", "repair_observation", "read_observation",
    "move_cell",
}  # fmt: skip


@contextlib.asynccontextmanager
async def over_http(server: Server, mode: str = "auto", **more: Any) -> AsyncGenerator[Client]:
    headers = {"Authorization": f"Bearer {server.token}"} if server.token else {}
    async with httpx2.AsyncClient(headers=headers, timeout=120, trust_env=False) as http:
        transport = streamable_http_client(f"{server.url}mcp", http_client=http)
        async with Client(transport, mode=mode, **more) as client:
            yield client


def over_stdio(store: Path) -> Client:
    arguments = ["-m", "wirelessagent", "mcp", "--store", str(store)]
    environment = {**os.environ, "WIRELESSAGENT_COMPILE": "never"}
    return Client(StdioServerParameters(command=sys.executable, args=arguments, env=environment))


def done(connection: AbstractAsyncContextManager[Client], do: Callable[[Client], Awaitable[Any]]) -> Any:
    async def run() -> Any:
        async with connection as client:
            return await do(client)

    return asyncio.run(run())


def text_of(result: CallToolResult) -> str:
    return "\n".join(one.text for one in result.content if one.type == "text")


async def plan_applied_once(client: Client, cell: str, line: str) -> None:
    found = await client.call_tool("cells")
    assert cell in {one["id"] for one in found.structured_content["cells"]}
    said = await client.call_tool("say", {"cell": cell, "text": line})
    assert said.structured_content["turn"]["stage"] == "planned", text_of(said)
    plan = said.structured_content["plan"]["id"]
    assert plan in text_of(said)
    refused = await client.call_tool("say", {"cell": cell, "text": "yes, apply it"})
    assert refused.structured_content["turn"]["outcome"] is None
    wrong = await client.call_tool("apply", {"plan": f"{plan}x"})
    assert wrong.is_error
    applied = await client.call_tool("apply", {"plan": plan})
    assert applied.structured_content["turn"]["stage"] == "applied", text_of(applied)
    again = await client.call_tool("apply", {"plan": plan})
    assert again.is_error
    assert "does not wait any more" in text_of(again)
    shown = await client.call_tool("show_allocation", {"cell": cell, "picture": True})
    assert shown.structured_content["in_effect"]
    (picture,) = [one for one in shown.content if one.type == "image"]
    assert (picture.mime_type, picture.data[:11]) == ("image/png", "iVBORw0KGgo")
    read = await client.read_resource(f"wirelessagent://cells/{cell}/allocation")
    assert json.loads(read.contents[0].text) == shown.structured_content


@pytest.mark.parametrize("mode", ["auto", "legacy"])
def test_a_plan_is_applied_once_over_http(server: Server, mode: str) -> None:
    cell = server.cell()["id"]
    done(over_http(server, mode), lambda client: plan_applied_once(client, cell, LINE))


def test_a_plan_is_applied_once_over_stdio(tmp_path: Path) -> None:
    line = "user 3 at least 1.5 Mbit/s"  # amends what the recorded conversation asks for
    done(over_stdio(tmp_path / "store.sqlite3"), lambda client: plan_applied_once(client, "demonstration", line))


def test_tools_follow_from_the_catalogue(server: Server) -> None:
    tools = {one.name: one for one in done(over_http(server), lambda client: client.list_tools()).tools}
    operations = [one for one in map(load, OPERATIONS) if not one.local and can_be_filled(one)]
    assert set(tools) == OWN | {one.name.replace(" ", "_").replace("-", "_") for one in operations}
    assert {name for name, tool in tools.items() if tool.annotations.destructive_hint} == {"apply", "move_cell"}
    changing = {name for name, tool in tools.items() if not tool.annotations.read_only_hint}
    assert changing == {"ask", "say", "apply", "discard", "undo", "observe", "repair_observation", "move_cell"}
    assert tools["show_allocation"].meta == {"ui": {"resourceUri": "ui://wirelessagent/allocation.html"}}
    for tool in tools.values():
        for schema in (tool.input_schema, tool.output_schema):
            jsonschema.Draft202012Validator.check_schema(schema)
            assert schema["type"] == "object"
        assert '"null"' not in json.dumps(tool.input_schema)
        assert "title" not in tool.input_schema


def test_channels_go_by_name(server: Server) -> None:
    async def chain(client: Client) -> None:
        seen = await client.call_tool("observe", {"loss": ["random:0.2"], "seed": 3})
        observation = seen.structured_content["observation"]
        assert observation["missing"] > 0
        assert str(server.store.parent) not in text_of(seen)
        mended = await client.call_tool("repair_observation", {"observation": observation["id"]})
        repaired = mended.structured_content["observation"]
        assert repaired["missing"] == 0
        for id in (observation["id"], repaired["id"]):
            solved = await client.call_tool("solve", {"observation": id, "objective": "max_rate"})
            assert solved.structured_content["conclusion"] == "done", text_of(solved)
        read = await client.call_tool("read_observation", {"observation": observation["id"]})
        assert read.structured_content == observation
        cell = server.cell()
        moved = await client.call_tool("move_cell", {"cell": cell["id"], "observation": repaired["id"]})
        assert not moved.is_error, text_of(moved)
        assert moved.structured_content == server.get(f"v1/cells/{cell['id']}")
        assert moved.structured_content["observation"] == repaired["id"]
        assert (await client.call_tool("move_cell", {"cell": cell["id"], "observation": "nobody"})).is_error
        for wrong in ({}, {"observation": "nobody"}, {"observation": observation["id"], "path": "/etc/passwd"}):
            assert (await client.call_tool("solve", wrong)).is_error

    done(over_http(server), chain)


def without(record: Any, *names: str) -> Any:
    return {name: value for name, value in record.items() if name not in names}


def test_the_same_request_gives_the_same_record_as_by_rest(server: Server) -> None:
    one, other = server.cell(), server.cell()
    content = "1e-9,2e-9,,4e-9\n2e-9,1e-9,3e-9,1e-9\n"
    octets = {"Content-Type": "application/octet-stream"}
    seen = server.post("v1/observations?name=gains.csv", content=content, headers=octets).json()["id"]
    forms = {
        "solve": {"observation": seen, "objective": "min_power", "min_rate_bps": 1e5},
        "simulate": {"loss": ["bursts:0.2"], "seed": 2}, "intent": {"text": LINE}, "plugins": {}, "ask": {"text": LINE},
    }  # fmt: skip

    async def ask(client: Client) -> list[Any]:
        turns = [await client.call_tool("say", {"cell": one["id"], "text": text}) for text in (LINE, "why?")]
        return [
            *(turn.structured_content["turn"] for turn in turns),
            *[(await client.call_tool(name, form)).structured_content for name, form in forms.items()],
        ]

    by_mcp = done(over_http(server), ask)
    by_rest = [server.say(other["session"], text) for text in (LINE, "why?")]
    for mine, theirs in zip(by_mcp[:2], by_rest, strict=True):
        assert without(mine, "session", "at_utc", "stored") == without(theirs, "session", "at_utc", "stored")
    for mine, (name, form) in zip(by_mcp[2:], forms.items(), strict=True):
        theirs = server.post(f"v1/operations/{name}", form).json()
        assert without(mine["record"], "stored") == without(theirs["record"], "stored")
        assert without(mine, "record") == without(theirs, "record")


@pytest.mark.parametrize("mode", ["auto", "legacy"])
@pytest.mark.parametrize(
    ("answer", "stage"),
    [
        (ElicitResult(action="accept", content={"answer": "yes"}), "planned"),
        (ElicitResult(action="decline"), "asked"),
        (None, "asked"),
    ],
    ids=["answered", "declined", "nobody to ask"],
)
def test_a_question_is_asked_back(server: Server, mode: str, answer: ElicitResult | None, stage: str) -> None:
    cell, asked = server.cell()["id"], list[str]()

    async def elicit(context: Any, params: Any) -> ElicitResult:
        asked.append(params.message)
        assert answer is not None
        return answer

    connection = over_http(server, mode, elicitation_callback=elicit if answer else None)
    result = done(connection, lambda client: client.call_tool("say", {"cell": cell, "text": UNCLEAR}))
    assert result.structured_content["turn"]["stage"] == stage, text_of(result)
    assert len(asked) == (answer is not None)
    assert (result.structured_content["plan"] is not None) == (stage == "planned")


def test_an_answer_to_no_question_is_refused(server: Server) -> None:
    cell = server.cell()["id"]

    async def forge(client: Client) -> CallToolResult:
        said = {"cell": cell, "text": LINE}
        answers = {"answer": ElicitResult(action="decline")}
        return await client.session.call_tool("say", said, input_responses=answers, request_state="7/../x")

    assert done(over_http(server), forge).is_error


def test_stages_are_told_as_progress(server: Server) -> None:
    cell, told = server.cell()["id"], list[tuple[float, str | None]]()

    async def progress(now: float, total: float | None, message: str | None) -> None:
        told.append((now, message))

    arguments = {"cell": cell, "text": LINE}
    done(over_http(server), lambda client: client.call_tool("say", arguments, progress_callback=progress))
    assert [now for now, _ in told] == [1.0, 2.0, 3.0, 4.0]
    assert told[1][1] == "8 users × 20 subcarriers; 32 of 160 gains missing (20 %)"


def test_who_hangs_up_ends_the_work(server: Server) -> None:
    async def hang_up(client: Client) -> None:
        with anyio.move_on_after(2) as scope:
            await client.call_tool("evaluate_repair", {"draws": 100_000})
        assert scope.cancelled_caught
        with anyio.fail_after(60):
            assert not (await client.call_tool("plugins")).is_error

    done(over_http(server), hang_up)


def test_prompts_and_what_can_be_read(server: Server) -> None:
    async def read(client: Client) -> None:
        for resource in (await client.list_resources()).resources:
            (content,) = (await client.read_resource(resource.uri)).contents
            assert content.mime_type == resource.mime_type
            assert content.text
        for template in (await client.list_resource_templates()).resource_templates:
            assert template.uri_template.startswith("wirelessagent://")
        for prompt in (await client.list_prompts()).prompts:
            given = {one.name: "{goal} of mine" for one in prompt.arguments}
            filled = await client.get_prompt(prompt.name, given)
            assert "{goal} of mine" in filled.messages[0].content.text
            with pytest.raises(MCPError):
                await client.get_prompt(prompt.name)
        for uri in ("wirelessagent://cells/nobody", "wirelessagent://x", "file:///etc/passwd", "ui://other"):
            with pytest.raises(MCPError):
                await client.read_resource(uri)
        with pytest.raises(MCPError, match="there is no tool"):
            await client.call_tool("format_disk")

    done(over_http(server), read)


class TestWhoMayWhat:
    def test_a_viewer_reads(self, guarded: Signed) -> None:
        async def look(client: Client) -> None:
            for name, arguments in (("cells", {}), ("show_allocation", {}), ("intent", {"text": LINE})):
                assert not (await client.call_tool(name, arguments)).is_error
            waiting = guarded.viewer.plan(guarded.viewer.get("v1/cells")[0]["session"])
            for name, arguments in (
                ("say", {"text": LINE}), ("undo", {}), ("apply", {"plan": waiting}), ("discard", {"plan": waiting}),
                ("observe", {}), ("ask", {"text": LINE}),
            ):  # fmt: skip
                refused = await client.call_tool(name, arguments)
                assert refused.is_error
                assert "is a viewer" in text_of(refused)

        done(over_http(guarded.viewer), look)

    def test_nobody_comes_in(self, guarded: Signed) -> None:
        initialize = {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {}}
        assert guarded.nobody.post("mcp", initialize).status_code == 401
        assert guarded.operator.post("mcp", initialize, headers={"Origin": "https://evil.example"}).status_code == 403
        assert guarded.operator.post("mcp", initialize, headers={"Host": "evil.example"}).status_code == 421
        with guarded.operator.client as client:
            assert client.get("mcp", headers={"Origin": "https://evil.example"}).status_code == 403

    def test_somebody_elses_session(self, guarded: Signed) -> None:
        session = guarded.operator.opens_mcp().headers["mcp-session-id"]
        assert guarded.operator.mcp("ping", session=session).status_code == 200
        assert guarded.viewer.mcp("ping", session=session).status_code == 404
        with guarded.operator.client as client:
            with client.stream("GET", "mcp", headers=mcp_headers(session)) as stream:
                assert stream.headers["content-type"].startswith("text/event-stream")
            assert client.delete("mcp", headers=mcp_headers(session)).status_code == 200
        assert guarded.operator.mcp("ping", session=session).status_code == 404


def test_the_protocol_is_loaded_when_somebody_comes() -> None:
    code = "import wirelessagent.interfaces.http.app, sys; print(sorted(n for n in sys.modules if n.startswith('mcp')))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.strip() == "[]"


CHROMIUM = Path("/usr/bin/chromium")


@pytest.mark.skipif(not CHROMIUM.exists(), reason="no Chromium at /usr/bin/chromium")
def test_the_app_shows_an_allocation(server: Server, tmp_path: Path) -> None:
    """The page in a frame of a host that speaks as the specification of MCP Apps says."""
    from playwright.sync_api import sync_playwright

    async def fetch(client: Client) -> tuple[str, Any]:
        page = await client.read_resource("ui://wirelessagent/allocation.html")
        shown = await client.call_tool("show_allocation", {"cell": "demonstration"})
        return page.contents[0].text, shown.structured_content

    html, found = done(over_http(server), fetch)
    found["turn"]["lines"]["decided"] += "<img src=x onerror=alert(1)>"
    host = """<iframe sandbox="allow-scripts" id="app" style="width:700px;height:600px"></iframe><script>
      const told = [], app = document.getElementById("app");
      addEventListener("message", ({data}) => {
        told.push(data.method);
        const say = (message) => app.contentWindow.postMessage({jsonrpc: "2.0", ...message}, "*");
        if (data.method === "ui/initialize") say({id: data.id, result: {hostContext: {theme: "dark"}}});
        if (data.method === "ui/notifications/initialized")
          say({method: "ui/notifications/tool-result", params: {structuredContent: FOUND}});
      });
      app.srcdoc = HTML;
    </script>"""
    quoted = json.dumps(html).replace("</", "<\\/")
    tmp_path.joinpath("host.html").write_text(
        host.replace("FOUND", json.dumps(found).replace("</", "<\\/")).replace("HTML", quoted), encoding="utf-8"
    )
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=["--no-sandbox"])
        page = browser.new_page()
        asked, wrong = list[str](), list[str]()
        page.on("request", lambda request: asked.append(request.url))
        page.on("console", lambda message: wrong.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.goto(tmp_path.joinpath("host.html").as_uri())
        frame = page.frame_locator("#app")
        frame.locator("tbody tr").first.wait_for(timeout=20_000)
        decision = found["turn"]["decision"]
        assert frame.locator("tbody tr").count() == len(decision["user_names"])
        used = sum(owner >= 0 for owner in decision["owner"])
        assert frame.locator("#chart rect").count() == used + 1
        assert frame.locator("#title").text_content() == "In effect"
        assert "<img" in (frame.locator("#said").text_content() or "")
        assert frame.locator("img").count() == 0
        told = page.evaluate("told")
        page.screenshot(path=tmp_path / "app.png")
        browser.close()
    assert told[:2] == ["ui/initialize", "ui/notifications/initialized"]
    assert "ui/notifications/size-changed" in told
    assert wrong == []
    assert [url for url in asked if url.startswith("http")] == []


def test_sessions_are_a_callers_own_and_so_is_their_number(tmp_path: Path) -> None:
    with Signed.started(tmp_path / "store.sqlite3") as guarded:
        opened = [guarded.viewer.opens_mcp() for _ in range(110)]
        assert {answer.status_code for answer in opened} == {200, 503}
        assert guarded.operator.opens_mcp().status_code == 200
        somebodys = opened[0].headers["mcp-session-id"]
        assert guarded.viewer.mcp("ping", session=somebodys).status_code == 200
        assert guarded.operator.mcp("ping", session=somebodys).status_code == 404
    log = (tmp_path / "store.log").read_text().splitlines()
    refused = [line for line in log if "are already open" in line]
    assert refused
    assert all(json.loads(line)["level"] == "warning" for line in refused)

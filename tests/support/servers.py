"""Servers for tests: started as an operator starts them, and ended."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx2
import platformdirs

from wirelessagent.interfaces.cli import run

_URL = re.compile(r"http://[^\s]+/")


@dataclass
class Server:
    """A running server."""

    url: str
    store: Path
    process: subprocess.Popen[str]
    token: str = ""
    at: str = ""

    @property
    def client(self) -> httpx2.Client:
        """Somebody who calls it."""
        headers = {"Authorization": f"Bearer {self.token}"} if self.token else {}
        return httpx2.Client(base_url=self.url, headers=headers, timeout=120, trust_env=False)

    def get(self, path: str, **more: Any) -> Any:
        """What is there."""
        with self.client as client:
            return client.get(path, **more).raise_for_status().json()

    def post(self, path: str, body: Any = None, **more: Any) -> httpx2.Response:
        """The answer to a request that changes something."""
        with self.client as client:
            return client.post(path, **({} if body is None else {"json": body}), **more)

    def line(self, timeout_s: float = 40) -> socket.socket:
        """A connection to it, to send on what no client sends."""
        host, _, port = self.url.removeprefix("http://").rstrip("/").partition(":")
        return socket.create_connection((host, int(port)), timeout=timeout_s)

    def cell(self, name: str = "a cell", **source_options: Any) -> dict[str, Any]:
        """A new simulated cell."""
        made = self.post("v1/cells", {"name": name, "options": {"seed": 1, "source_options": source_options}})
        assert made.status_code == 201, made.text
        return made.json()

    def say(self, session: str, text: str, **more: Any) -> dict[str, Any]:
        """The turn of a line."""
        said = self.post(f"v1/sessions/{session}/turns", {"text": text}, **more)
        assert said.status_code == 200, said.text
        return said.json()

    def plan(self, session: str) -> str:
        """The plan that waits."""
        return self.get(f"v1/sessions/{session}")["plan"]["id"]

    def opens_mcp(self) -> httpx2.Response:
        """The answer to a client that opens a session of MCP without the SDK."""
        hello = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "x", "version": "1"}}
        return self.mcp("initialize", hello)

    def mcp(self, method: str, params: Mapping[str, Any] | None = None, session: str = "") -> httpx2.Response:
        """The answer to a message of MCP; a notification has none."""
        message = {"jsonrpc": "2.0", "method": method, **({} if params is None else {"params": params})}
        number = {} if method.startswith("notifications/") else {"id": 1}
        return self.post("mcp", {**message, **number}, headers=mcp_headers(session))

    def end_workers(self) -> None:
        """End what works for it without a word."""
        found = subprocess.run(["pgrep", "-P", str(self.process.pid)], capture_output=True, text=True, check=True)
        for number in found.stdout.split():
            os.kill(int(number), signal.SIGKILL)

    def kill(self) -> None:
        """End it without a word, with its workers; what one is just writing is there then, or never will be."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        ends = ["pgrep", "-g", str(self.process.pid), "-r", "D,R,S"]
        while subprocess.run(ends, capture_output=True, check=False).returncode == 0:
            time.sleep(0.01)


def mcp_headers(session: str = "") -> dict[str, str]:
    """What a client of MCP sends with each message."""
    named = {"Mcp-Session-Id": session} if session else {}
    return {"Accept": "application/json, text/event-stream", **named}


@contextlib.contextmanager
def started(store: Path, *options: str, token: str = "", at: str = "") -> Iterator[Server]:
    """A server on a store (in that file, or ``at`` a URL), until the end of the context."""
    environment = {
        **os.environ, "WIRELESSAGENT_COMPILE": "never", "PYTHONUNBUFFERED": "",
        "XDG_CACHE_HOME": str(_cache(store.with_suffix(".cache"))),
    }  # fmt: skip
    log = store.with_suffix(".log").open("a")
    process = subprocess.Popen(
        [sys.executable, "-m", "wirelessagent", "serve", "--port", "0", "--store", at or str(store),
         *(() if "--requests-per-s" in options else ("--requests-per-s", "1000")), *options],
        stdout=subprocess.PIPE, stderr=log, text=True, env=environment, start_new_session=True,
    )  # fmt: skip
    assert process.stdout is not None
    try:
        found = next(filter(None, map(_URL.search, process.stdout)), None)
        assert found is not None, store.with_suffix(".log").read_text()
        yield Server(found[0], store, process, token, at or str(store))
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        process.stdout.close()
        log.close()


def _cache(folder: Path) -> Path:
    """A cache of a server's own, as another machine would have, with the machine code that is there."""
    ours = folder / "wirelessagent"
    ours.mkdir(parents=True, exist_ok=True)
    with contextlib.suppress(FileExistsError):
        (ours / "kernels").symlink_to(platformdirs.user_cache_path("wirelessagent") / "kernels")
    return folder


def token_for(store: Path, name: str, role: str) -> str:
    """A token, made as an administrator makes it."""
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert run(["token", name, "--role", role, "--store", str(store), "--json"]) == 0
    return json.loads(said.getvalue())["token"]


@dataclass
class Signed:
    """A server with an operator and a viewer."""

    operator: Server
    viewer: Server
    nobody: Server

    @classmethod
    @contextlib.contextmanager
    def started(cls, store: Path, *options: str) -> Iterator[Signed]:
        """Such a server, until the end of the context."""
        tokens = {name: token_for(store, name, name) for name in ("operator", "viewer")}
        with started(store, *options) as server:
            yield cls(
                Server(server.url, store, server.process, tokens["operator"]),
                Server(server.url, store, server.process, tokens["viewer"]),
                Server(server.url, store, server.process),
            )

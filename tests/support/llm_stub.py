"""A server of the OpenAI protocol that says what it is told to say, well-behaved or not.

``StubLlm(script)`` is a context manager. The script gets the request's JSON and returns a reply, one of the functions
below; :func:`truthful` makes a script that answers from a table of utterances, such as the development set. As a
program it serves such a table: ``python tests/support/llm_stub.py tests/intents/development.jsonl --port 8088``.
"""

from __future__ import annotations

import argparse
import json
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

Json = dict[str, Any]


@dataclass(frozen=True)
class Reply:
    """What the server does: after ``delay_s`` a status and either a chat message or raw bytes.

    ``cut`` closes the connection after so many bytes of the body; ``pause_s`` waits between bytes, a drip.
    """

    message: Json | None = None
    status: int = 200
    raw: bytes | None = None
    content_type: str = "application/json"
    delay_s: float = 0.0
    cut: int | None = None
    pause_s: float = 0.0
    finish: str = "stop"
    headers: Mapping[str, str] = field(default_factory=dict)


def call(name: str, arguments: Json | str) -> Reply:
    """A tool call."""
    text = arguments if isinstance(arguments, str) else json.dumps(arguments)
    called = {"id": "call_1", "type": "function", "function": {"name": name, "arguments": text}}
    return Reply(message={"role": "assistant", "content": None, "tool_calls": [called]}, finish="tool_calls")


def meaning(**filled: Any) -> Reply:
    """The typed answer to a sentence, by a tool call."""
    return call("meaning", {"language": "en"} | filled)


def say(text: str | None) -> Reply:
    """Plain words."""
    return Reply(message={"role": "assistant", "content": text})


def refuse(text: str = "I can't help with that.") -> Reply:
    return Reply(message={"role": "assistant", "content": None, "refusal": text})


def error(status: int, told: str = "no") -> Reply:
    body = json.dumps({"error": {"message": told, "type": "server_error", "code": None}})
    return Reply(status=status, raw=body.encode())


def raw(body: bytes, content_type: str = "application/json", status: int = 200) -> Reply:
    return Reply(raw=body, content_type=content_type, status=status)


class StubLlm:
    """The server, from ``__enter__`` to ``__exit__``; ``requests`` and ``headers`` are what it was sent."""

    def __init__(self, script: Callable[[Json], Reply] | Iterable[Reply], port: int = 0) -> None:
        replies = None if callable(script) else iter(script)
        self._script: Callable[[Json], Reply] = script if callable(script) else lambda _: next(replies or iter(()))
        self.requests: list[Json] = []
        self.headers: list[dict[str, str]] = []
        self._closing = threading.Event()
        self._server = ThreadingHTTPServer(("127.0.0.1", port), self._handler())
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.01,), daemon=True)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_address[1]}/v1"

    def __enter__(self) -> StubLlm:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._closing.set()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        stub = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self) -> None:
                request = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                stub.requests.append(request)
                stub.headers.append({name.lower(): value for name, value in self.headers.items()})
                stub._answer(self, request)

            def log_message(self, format: str, *args: Any) -> None:
                del format, args

        return Handler

    def _answer(self, handler: BaseHTTPRequestHandler, request: Json) -> None:
        reply = self._script(request)
        self._closing.wait(reply.delay_s)
        streams = bool(request.get("stream")) and reply.message is not None
        body = reply.raw if reply.raw is not None else (_streamed if streams else _whole)(reply)
        try:
            handler.send_response(reply.status)
            handler.send_header("Content-Type", "text/event-stream" if streams else reply.content_type)
            handler.send_header("Content-Length", str(len(body)))
            for name, value in reply.headers.items():
                handler.send_header(name, value)
            handler.end_headers()
            sent = body if reply.cut is None else body[: reply.cut]
            if reply.pause_s:
                for place in range(len(sent)):
                    handler.wfile.write(sent[place : place + 1])
                    handler.wfile.flush()
                    if self._closing.wait(reply.pause_s):
                        break
            else:
                handler.wfile.write(sent)
            if reply.cut is not None:
                handler.close_connection = True
        except (BrokenPipeError, ConnectionResetError):
            handler.close_connection = True


def _whole(reply: Reply) -> bytes:
    choice = {"index": 0, "message": reply.message, "finish_reason": reply.finish}
    usage = {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2}
    body = _head("chat.completion") | {"choices": [choice], "usage": usage}
    return json.dumps(body).encode()


def _streamed(reply: Reply) -> bytes:
    """The same as server-sent events, tool arguments and words in two pieces."""
    message = reply.message or {}
    deltas: list[Json] = [{"role": "assistant"}]
    for called in message.get("tool_calls") or []:
        text = called["function"]["arguments"]
        half = len(text) // 2
        first = called | {"index": 0, "function": called["function"] | {"arguments": text[:half]}}
        deltas.append({"tool_calls": [first]})
        deltas.append({"tool_calls": [{"index": 0, "function": {"arguments": text[half:]}}]})
    deltas.extend({name: message[name]} for name in ("content", "refusal") if message.get(name))
    choices: list[Json] = [{"index": 0, "delta": delta} for delta in deltas]
    choices.append({"index": 0, "delta": {}, "finish_reason": reply.finish})
    events = [_head("chat.completion.chunk") | {"choices": [choice]} for choice in choices]
    return "".join(f"data: {json.dumps(event)}\n\n" for event in events).encode() + b"data: [DONE]\n\n"


def _head(kind: str) -> Json:
    return {"id": "stub", "object": kind, "created": int(time.time()), "model": "stub"}


def case_of(request: Json) -> Json:
    """The sentence with its figures, as the recogniser sent it."""
    first = next(message for message in request["messages"] if message["role"] == "user")
    content = first["content"]
    text = content if isinstance(content, str) else "".join(part.get("text", "") for part in content)
    return json.loads(text)


def truthful(rows: Iterable[Json]) -> Callable[[Json], Reply]:
    """A script that answers each sentence with the meaning that the table gives it.

    A row has ``text``, ``kind``, ``objective`` and ``constraints`` as in tests/intents, and may have ``topic``,
    ``details``, ``amends``, ``dropped`` and ``reply``. Figures are given by value.
    """
    table = {row["text"]: row for row in rows}

    def script(request: Json) -> Reply:
        case = case_of(request)
        row = table.get(case["sentence"])
        return say("I don't know this sentence.") if row is None else meaning(**_meaning_of(row))

    return script


def _meaning_of(row: Json) -> Json:
    stated: list[Json] = []
    lists: Json = {}
    details = dict(row.get("details", {}))
    constraints = {**(row.get("constraints") or {}), **details.pop("constraints", {})}
    for name, value in constraints.items():
        if name in ("users", "leave_out"):
            lists[name] = [str(user) for user in value]
        elif isinstance(value, dict):
            for user, each in value.items():
                whose = {} if user == "all" else {"users": [user]}
                stated.append({"constraint": name, "figure": each} | whose)
        else:
            stated.append({"constraint": name, "figure": value})
    supposed = details.pop("objective", None)
    if "with" in details:
        details["compared_with"] = details.pop("with")
    if "user" in details:
        details["user"] = str(details["user"])
    filled: Json = {
        "kind": row["kind"],
        "objective": row.get("objective") or supposed,
        "constraints": stated,
        "amends": row.get("amends", False),
        "drops": list(row.get("dropped", [])),
        "topic": row.get("topic"),
        "details": details,
        "language": row.get("language", "en"),
    } | lists
    if row["kind"] == "allocate":
        filled["objective_words"] = row.get("words", "" if filled["amends"] else row["text"])
    if row["kind"] == "clarify":
        filled["question"] = row.get("reply") or "What should the cell aim for?"
    return filled


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument("--port", type=int, default=8088)
    given = parser.parse_args()
    rows = [json.loads(line) for line in given.table.read_text(encoding="utf-8").splitlines() if line.strip()]
    with StubLlm(truthful(rows), port=given.port) as stub:
        print(f"WIRELESSAGENT_LLM_BASE_URL={stub.url} WIRELESSAGENT_LLM_MODEL=stub", flush=True)  # noqa: T201
        threading.Event().wait()


if __name__ == "__main__":
    main()

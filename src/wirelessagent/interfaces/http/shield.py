"""What every request passes before it reaches a route: host, origin, size, time, who asks, how often.

What is refused is answered by a problem in the sense of RFC 9457, and every answer carries the headers that keep a
browser from running, framing or sniffing what we did not send.
"""

from __future__ import annotations

import asyncio
import json
import time
import uuid
from collections.abc import Mapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Any, TypeAlias

from starlette.datastructures import Headers
from starlette.requests import ClientDisconnect
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from wirelessagent.interfaces.http.logs import REQUESTS
from wirelessagent.service.access import LOCAL, Caller
from wirelessagent.service.limits import Budgets
from wirelessagent.service.problems import (
    ForbiddenError,
    NotSignedInError,
    ProblemError,
    TooLargeError,
    UnusableError,
    problem_of,
)
from wirelessagent.service.service import Service

COOKIE = "wirelessagent"
"""The name of the cookie of a browser session."""

LOCAL_NAMES = frozenset({"127.0.0.1", "localhost", "::1"})
"""What this machine calls itself."""

_SAFE = frozenset({"GET", "HEAD", "OPTIONS"})
_OPEN = frozenset({"/", "/sign-in", "/sign-out", "/favicon.ico", "/plugin/openapi.json"})
"""What needs no token: the way in, and what a platform reads to import the plug-in."""

_ALWAYS = frozenset({"/healthz", "/readyz"})
"""What whoever watches over the server may ask as often as they like."""

_MCP = "/mcp"
"""Where reading is asked for by POST, too: there each tool says whether a viewer may call it."""

_PLUGIN = "/plugin/"
_UPLOADS = "/v1/observations"
_HUNG_UP = 499
"""The status that is counted and logged where a caller hung up while sending, whom nothing can be answered."""

_CALLERS_S = 1.0
"""For how long it is taken that nobody has a token, so that not each request asks the store."""

_MEDIA_TYPES = frozenset({"application/json", "application/octet-stream"})

_HEADERS: Mapping[str, str] = {
    "content-security-policy": "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}

Body: TypeAlias = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Doors:
    """How a server can be reached.

    Attributes:
        hosts: the names that requests may be for.
        only_local: whether only this machine reaches it, so that no token is needed while there is none.
        base_path: what a proxy in front takes off the path.
        public_url: where others reach it, for the document that they import.
    """

    hosts: frozenset[str]
    only_local: bool
    base_path: str = ""
    public_url: str = ""


class Shield:
    """The middleware around an application."""

    def __init__(self, app: ASGIApp, *, service: Service, doors: Doors) -> None:
        self._app, self._service, self._doors = app, service, doors
        self._budgets = Budgets(service.limits, service.ledger)
        self._callers, self._callers_until = bool(service.access.callers), 0.0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": 1008})
                return
            await self._app(scope, receive, send)
            return
        began, identity, status, started = time.monotonic(), uuid.uuid4().hex[:16], 500, False
        path = _path_of(scope)
        scope["path"] = scope.get("root_path", "").rstrip("/") + path  # as a proxy was asked for that leaves it on

        async def sent(message: Message) -> None:
            nonlocal status, started
            if message["type"] == "http.response.start":
                status, started = message["status"], True
                message["headers"] = [*message.get("headers", []), *self._added(path, message, identity)]
            await send(message)

        try:
            caller = await self._checked(scope, path)
            scope.setdefault("state", {})["caller"] = caller
            if scope["method"] not in _SAFE:
                self._check_content(Headers(scope=scope), path)
            await self._app(scope, self._limited(path, receive), sent)
        except ClientDisconnect:
            status = _HUNG_UP
        except Exception as error:
            if started:  # what was said cannot be taken back
                raise
            problem = problem_of(error)
            await _answer(problem, in_plugin(problem) if path.startswith(_PLUGIN) and _known(scope) else None, sent)
        finally:
            route = getattr(scope.get("route"), "path", "") or "other"
            self._service.metrics.answered(route, status, time.monotonic() - began)
            told = {
                "request": identity, "method": scope["method"], "path": path[:200], "status": status,
                "ms": round(1000 * (time.monotonic() - began), 1), "by": self._name(scope),
            }  # fmt: skip
            if path not in _ALWAYS:
                REQUESTS.info("request", extra={"request": told})

    @staticmethod
    def _name(scope: Scope) -> str:
        caller = _known(scope)
        return "-" if caller is None else caller.name

    @staticmethod
    def _added(path: str, message: Message, identity: str) -> list[tuple[bytes, bytes]]:
        there = {name for name, _ in message.get("headers", [])}
        added = {**_HEADERS, "x-request-id": identity}
        if not path.startswith("/console/"):
            added["cache-control"] = "no-store"
        return [(name.encode(), value.encode()) for name, value in added.items() if name.encode() not in there]

    async def _checked(self, scope: Scope, path: str) -> Caller | None:
        headers, method = Headers(scope=scope), scope["method"]
        self._check_host(headers)
        if method not in _SAFE or path == _MCP:
            self._check_origin(headers)
        if path in _ALWAYS:
            return None
        peer = (scope.get("client") or ("unknown", 0))[0]
        try:
            caller = await self._caller(headers)
        except NotSignedInError:
            await self._budgets.spend(f"address {peer}")
            if path in _OPEN or path.startswith(("/console/", "/v1/words/")):
                return None
            raise
        await self._budgets.spend(f"caller {caller.name}" if caller is not LOCAL else f"address {peer}")
        if not caller.may_change and method not in _SAFE and path not in _OPEN and path != _MCP:
            raise ForbiddenError(f"{caller.name!r} is a viewer and changes nothing: ask an operator")
        return caller

    def _check_host(self, headers: Headers) -> None:
        host = _host_of(headers.get("host", ""))
        if host not in self._doors.hosts:
            raise ProblemError(
                f"this server does not go by the name {host[:100]!r}: start it with --allowed-host to have it so",
                status=421,
                title="Misdirected request",
            )

    def _check_origin(self, headers: Headers) -> None:
        """Refuse what another site's page sends in its visitor's name."""
        origin, site = headers.get("origin"), headers.get("sec-fetch-site", "same-origin")
        if site not in ("same-origin", "none") or (origin is not None and not self._is_ours(origin, headers)):
            raise ForbiddenError("this request comes from another site's page")

    @staticmethod
    def _is_ours(origin: str, headers: Headers) -> bool:
        return origin.partition("://")[2].lower() == headers.get("host", "").lower()

    def _check_content(self, headers: Headers, path: str) -> None:
        said = headers.get("content-length", "0")
        length = int(said) if said.isdecimal() else 0
        if length > self._most_bytes(path):
            raise TooLargeError(f"at most {self._most_bytes(path)} bytes are taken here; got {length}")
        media_type = headers.get("content-type", "").partition(";")[0].strip().lower()
        empty = length == 0 and "transfer-encoding" not in headers
        if not (empty and not media_type) and media_type not in _MEDIA_TYPES:
            raise UnusableError(
                f"send application/json (files with gains: application/octet-stream); got {media_type[:100]!r}"
            )
        if headers.get("content-encoding", "identity") != "identity":
            raise UnusableError("send it without compression")

    def _most_bytes(self, path: str) -> int:
        limits = self._service.limits
        return limits.upload_bytes if path == _UPLOADS else limits.body_bytes

    async def _caller(self, headers: Headers) -> Caller:
        """Who asks: by a token in a header, else by the cookie of a browser session."""
        access = self._service.access
        kind, _, token = headers.get("authorization", "").partition(" ")
        token = headers.get("x-api-key", "") or (token.strip() if kind.lower() == "bearer" else "")
        if token:
            return await asyncio.to_thread(access.by_token, token)
        here = self._doors.only_local and _host_of(headers.get("host", "")) in LOCAL_NAMES
        if here and not await self._has_callers():  # a cookie is another server's, since they know no ports
            return LOCAL
        cookie = cookie_of(headers)
        if not cookie:
            raise NotSignedInError
        return await asyncio.to_thread(access.by_cookie, cookie)

    async def _has_callers(self) -> bool:
        """Whether anybody has a token, or had one: the last one that is taken back opens nothing."""
        if not self._callers and time.monotonic() > self._callers_until:
            self._callers = bool(await asyncio.to_thread(lambda: self._service.access.callers))
            self._callers_until = time.monotonic() + _CALLERS_S
        return self._callers

    def _limited(self, path: str, receive: Receive) -> Receive:
        """What is received, as long as it comes in time and is not too much."""
        most, until = self._most_bytes(path), time.monotonic() + self._service.limits.receive_s
        got, whole = 0, False

        async def limited() -> Message:
            nonlocal got, whole
            if whole:
                return await receive()
            try:
                message = await asyncio.wait_for(receive(), max(until - time.monotonic(), 0.0))
            except TimeoutError as error:
                raise ProblemError("the request did not arrive in time", status=408, title="Too slow") from error
            got += len(message.get("body", b""))
            if got > most:
                raise TooLargeError(f"at most {most} bytes are taken here")
            whole = not message.get("more_body", False)
            return message

        return limited


def cookie_of(headers: Headers) -> str:
    """The browser session that a request names; empty where it names none."""
    try:
        found = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return "" if found is None else found.value


def in_plugin(problem: ProblemError) -> Body | None:
    """A problem as the plug-in tells it; None where HTTP has to tell it."""
    return None if problem.status in (401, 403, 405, 429) else {"ok": False, "error": problem.detail}


def _path_of(scope: Scope) -> str:
    """The path as routes know it, without what a proxy in front takes off."""
    path, root = scope["path"], scope.get("root_path", "").rstrip("/")
    return path.removeprefix(root) or "/" if root and f"{path}/".startswith(f"{root}/") else path


def _host_of(host: str) -> str:
    """The name in a Host header, without its port."""
    if host.startswith("["):
        return host.partition("]")[0].strip("[").lower()
    return host.partition(":")[0].lower()


def _known(scope: Scope) -> Caller | None:
    """Who was let in; None where nobody has to be known, or nobody was let in."""
    caller = scope.get("state", {}).get("caller")
    return caller if isinstance(caller, Caller) else None


async def _answer(problem: ProblemError, told: Body | None, send: Send) -> None:
    """Send a problem, or what is told in its place to a platform that was let in."""
    body = json.dumps(told or problem.body).encode()
    media_type = "application/json" if told else "application/problem+json"
    headers = {"content-type": media_type, "content-length": str(len(body)), **problem.headers}
    pairs = [(name.lower().encode(), value.encode()) for name, value in headers.items()]
    await send({"type": "http.response.start", "status": 200 if told else problem.status, "headers": pairs})
    await send({"type": "http.response.body", "body": body})

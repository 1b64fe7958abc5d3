"""The door of the MCP server in the web application; all behind it is loaded when somebody first comes.

The shield stands before it: token, host, origin, size, rate.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from starlette.requests import Request
from starlette.types import Receive, Scope, Send

from wirelessagent.service.access import Caller
from wirelessagent.service.service import Service

if TYPE_CHECKING:
    from mcp.server.context import ServerRequestContext
    from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

_MOST_SESSIONS = 500


class Door:
    """Streamable HTTP as an ASGI application."""

    def __init__(self, service: Service) -> None:
        self._service = service
        self._opening = asyncio.Lock()
        self._closing = asyncio.Event()
        self._manager: StreamableHTTPSessionManager | None = None
        self._running: asyncio.Task[None] | None = None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        manager = await self._open()
        scope["user"] = _user(scope["state"]["caller"])
        await manager.handle_request(scope, receive, send)

    async def close(self) -> None:
        """End all sessions."""
        self._closing.set()
        if self._running is not None:
            await self._running

    async def _open(self) -> StreamableHTTPSessionManager:
        async with self._opening:
            if self._manager is None:
                self._manager = await asyncio.to_thread(_manager, self._service)
                opened = asyncio.Event()
                self._running = asyncio.create_task(self._run(self._manager, opened))
                await opened.wait()
            return self._manager

    async def _run(self, manager: StreamableHTTPSessionManager, opened: asyncio.Event) -> None:
        """Keep the sessions, in a task of their own as they outlive the request that opened the door."""
        async with manager.run():
            opened.set()
            await self._closing.wait()


def _manager(service: Service) -> StreamableHTTPSessionManager:
    from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

    from wirelessagent.interfaces.mcp.server import make_server

    server = make_server(service, _caller_of)
    limits = service.limits
    return StreamableHTTPSessionManager(
        app=server, max_request_body_size=limits.body_bytes, max_sessions=_MOST_SESSIONS
    )


def _caller_of(context: ServerRequestContext[Any, Any]) -> Caller:
    """Who the shield found a request to come from; it belongs to each request, not to its session."""
    request = context.request
    assert isinstance(request, Request)
    caller = request.scope["state"]["caller"]
    assert isinstance(caller, Caller)
    return caller


def _user(caller: Caller) -> Any:
    """A caller as the owner of a session, which nobody else can go on with."""
    from mcp.server.auth.middleware.bearer_auth import AuthenticatedUser
    from mcp.server.auth.provider import AccessToken

    return AuthenticatedUser(AccessToken(token="", client_id=caller.name, scopes=[]))

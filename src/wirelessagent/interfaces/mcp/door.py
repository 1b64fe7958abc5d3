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

_MOST_SESSIONS = 100
"""Of one caller."""


class Door:
    """Streamable HTTP as an ASGI application; sessions are a caller's own, and nobody can use up those of others."""

    def __init__(self, service: Service) -> None:
        self._service = service
        self._opening = asyncio.Lock()
        self._closing = asyncio.Event()
        self._managers: dict[str, StreamableHTTPSessionManager] = {}
        self._running: list[asyncio.Task[None]] = []

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        manager = await self._open(scope["state"]["caller"])
        await manager.handle_request(scope, receive, send)

    async def close(self) -> None:
        """End all sessions."""
        self._closing.set()
        await asyncio.gather(*self._running)

    async def _open(self, caller: Caller) -> StreamableHTTPSessionManager:
        async with self._opening:
            if caller.name not in self._managers:
                manager = await asyncio.to_thread(_manager, self._service)
                opened = asyncio.Event()
                self._running.append(asyncio.create_task(self._run(manager, opened)))
                await opened.wait()
                self._managers[caller.name] = manager
            return self._managers[caller.name]

    async def _run(self, manager: StreamableHTTPSessionManager, opened: asyncio.Event) -> None:
        """Keep the sessions, in a task of their own as they outlive the request that opened the door."""
        async with manager.run():
            opened.set()
            await self._closing.wait()


def _manager(service: Service) -> StreamableHTTPSessionManager:
    from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

    from wirelessagent.interfaces.mcp.server import make_server

    return StreamableHTTPSessionManager(
        app=make_server(service, _caller_of),
        max_request_body_size=service.limits.body_bytes,
        max_sessions=_MOST_SESSIONS,
    )


def _caller_of(context: ServerRequestContext[Any, Any]) -> Caller:
    """Who the shield found a request to come from, with the role that they have now."""
    request = context.request
    assert isinstance(request, Request)
    caller = request.scope["state"]["caller"]
    assert isinstance(caller, Caller)
    return caller

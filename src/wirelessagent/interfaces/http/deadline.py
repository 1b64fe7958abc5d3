"""A deadline for the head of a request: a client that sends it drop by drop is hung up on.

Uvicorn waits for ever for a request to begin; what comes after its head is timed by the shield.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol


def within(seconds: float) -> type[HttpToolsProtocol]:
    """HTTP in which a request's head arrives within so much time."""
    return type("WithinProtocol", (DeadlineProtocol,), {"head_s": seconds})


class DeadlineProtocol(HttpToolsProtocol):
    """HTTP whose requests begin in time."""

    head_s: float
    _deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        self._wait()

    def on_headers_complete(self) -> None:
        self._stop()
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        if not self.transport.is_closing():
            self._stop()
            self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop()
        super().connection_lost(exc)

    def _wait(self) -> None:
        self._deadline = self.loop.call_later(self.head_s, self._hang_up)

    def _stop(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _hang_up(self) -> None:
        self._deadline = None
        self.transport.close()

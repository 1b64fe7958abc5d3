"""Limits for the head of a request: a client that sends it drop by drop, or without end, is hung up on.

Uvicorn waits for ever for a request to begin, and keeps whatever comes as its head; what comes after that is timed and
counted by the shield.
"""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

_MOST_HEAD_BYTES = 64 << 10
"""As much as other servers take."""


def within(seconds: float) -> type[HttpToolsProtocol]:
    """HTTP in which a request's head arrives within so much time."""
    return type("WithinProtocol", (DeadlineProtocol,), {"head_s": seconds})


class DeadlineProtocol(HttpToolsProtocol):
    """HTTP whose requests begin in time, with a head (and what may stand behind a body) of a bounded size."""

    head_s: float
    _deadline: asyncio.TimerHandle | None = None
    _head_bytes = 0

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        self._wait()

    def data_received(self, data: bytes) -> None:
        self._head_bytes += len(data)
        super().data_received(data)
        if self._head_bytes > _MOST_HEAD_BYTES and not self.transport.is_closing():
            self.send_400_response(f"The head of a request has at most {_MOST_HEAD_BYTES} bytes.")

    def on_headers_complete(self) -> None:
        self._stop()
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        self._head_bytes = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        self._head_bytes = 0
        super().on_message_complete()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        if not self.transport.is_closing() and self.cycle.response_complete:  # no other request has come meanwhile
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

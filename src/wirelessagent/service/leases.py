"""One turn of a cell at a time, whatever server it comes to, and what became of one whose server ended.

In a server turns wait for each other; among servers the ledger says who has a turn. Its server says again and again
that it goes on; whoever waits and has not heard of it for a while, by a clock of their own, takes it to be gone, since
the clocks of servers differ and are set. A turn in which the base station is told something is marked as that before it
is, so that whoever comes next after its server or its worker ended knows that what is in effect is not known.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import time
import weakref
from collections.abc import AsyncGenerator, Mapping
from typing import Any

from wirelessagent.operations.operation import WirelessAgentError
from wirelessagent.service.problems import ConflictError
from wirelessagent.store.ledger import ChangedError, Item, Ledger

_KIND = "going"
_LASTS_S, _RENEWED_S, _ASKED_S = 10.0, 3.0, 0.2
"""How long a lease is good for without a word, how often it is renewed, and how often one that somebody else has is
looked at."""

_NOBODY = ""


class Lease:
    """The turn that somebody has of a cell.

    Attributes:
        telling: what the base station is told in it, or was when it broke off; None where that is nothing.
    """

    def __init__(self, ledger: Ledger, cell: str, server: str, version: int, telling: Mapping[str, Any] | None) -> None:
        self._ledger, self._cell, self._server, self._version = ledger, cell, server, version
        self._writing, self._over = asyncio.Lock(), asyncio.Event()
        self.telling = telling

    async def keep(self, telling: Mapping[str, Any] | None, *, by: str | None = None) -> None:
        """Have it known what is told in it, and that it goes on at this server, or at nobody's.

        Raises:
            ConflictError: somebody else has the cell by now.
        """
        async with self._writing:
            self.telling = telling
            held = {"server": self._server if by is None else by, "telling": telling}
            put = asyncio.to_thread(self._ledger.put, _KIND, self._cell, held, seen=self._version)
            try:
                self._version = await put
            except ChangedError as error:
                raise ConflictError("somebody else was faster: look at what holds now") from error

    async def renew(self) -> None:
        """Say again and again that it goes on, until it ends."""
        while not self._over.is_set():
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._over.wait(), _RENEWED_S)
                return
            with contextlib.suppress(ConflictError, WirelessAgentError):  # which its turn meets, too
                await self.keep(self.telling)

    async def end(self, renewing: asyncio.Task[None]) -> None:
        """Give the cell back; what was told in the turn stays known until somebody has told of it."""
        self._over.set()
        await renewing
        if self.telling is not None:
            await self.keep(self.telling, by=_NOBODY)
        else:
            async with self._writing:
                await asyncio.to_thread(self._ledger.drop, _KIND, self._cell, seen=self._version)


class Leases:
    """The leases of one server.

    Args:
        ledger: where they are known.
        patience_s: how long one waits for another server; longer than a lease lasts, in any case.
    """

    def __init__(self, ledger: Ledger, patience_s: float) -> None:
        self._ledger, self._patience_s, self._server = ledger, max(patience_s, 2 * _LASTS_S), secrets.token_hex(6)
        self._locks: weakref.WeakValueDictionary[str, asyncio.Lock] = weakref.WeakValueDictionary()

    @contextlib.asynccontextmanager
    async def of(self, cell: str) -> AsyncGenerator[Lease]:
        """The lease of a cell, once nobody else has it.

        Raises:
            ConflictError: somebody else keeps it.
        """
        async with self._locks.setdefault(cell, asyncio.Lock()):
            lease = await self._taken(cell)
            renewing = asyncio.create_task(lease.renew())
            try:
                yield lease
            finally:
                await asyncio.shield(lease.end(renewing))

    async def telling(self, cell: str) -> Mapping[str, Any] | None:
        """What the base station of a cell is being told, or was when that broke off; None where that is nothing."""
        item = await asyncio.to_thread(self._ledger.find, _KIND, cell)
        return None if item is None else item.data["telling"]

    async def _taken(self, cell: str) -> Lease:
        while True:
            lease = await self._free(cell)
            with contextlib.suppress(ConflictError):  # somebody was faster, and will be done with it
                await lease.keep(lease.telling)
                return lease

    async def _free(self, cell: str) -> Lease:
        until, last, heard = time.monotonic() + self._patience_s, None, 0.0
        while True:
            item: Item | None = await asyncio.to_thread(self._ledger.find, _KIND, cell)
            if item is None:
                return Lease(self._ledger, cell, self._server, 0, None)
            if item != last:
                last, heard = item, time.monotonic()
            if item.data["server"] in (self._server, _NOBODY) or time.monotonic() > heard + _LASTS_S:
                return Lease(self._ledger, cell, self._server, item.version, item.data["telling"])
            if time.monotonic() > until:
                raise ConflictError("somebody has a turn of this cell just now: try again in a while")
            await asyncio.sleep(_ASKED_S)

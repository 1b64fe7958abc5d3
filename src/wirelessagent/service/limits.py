"""How much anybody may ask of a server."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import math
import time
from collections import OrderedDict
from dataclasses import dataclass, field

from wirelessagent.service.kept import kept
from wirelessagent.service.problems import TooMuchError
from wirelessagent.store.ledger import ChangedError, Ledger


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What is allowed.

    Attributes:
        body_bytes, upload_bytes: of a request, and of a file with gains.
        receive_s: for a request to arrive whole.
        work_s: for one piece of work.
        requests_per_s, burst: of one caller.
        running_jobs: at one time, of all callers; three quarters of them for one.
        plan_s: how long a plan may wait before it has to be made again.
        cells, observations: kept at one time.
        gains: of an observation, users times subcarriers.
    """

    body_bytes: int = 256 << 10
    upload_bytes: int = 32 << 20
    receive_s: float = 20.0
    work_s: float = 120.0
    requests_per_s: float = 20.0
    burst: int = 120
    running_jobs: int = 64
    plan_s: float = 900.0
    cells: int = 100
    observations: int = 200
    gains: int = 1_000_000


_SHARES = 10
"""A server takes such a part of a burst at a time."""

_SWEPT_S = 60.0


class Budgets:
    """How much each caller has left: it fills up with time and is spent by requests, at all servers of a store.

    What is left stands in the store. A server takes a share of it at a time and spends that by itself, so that few
    requests have to write.
    """

    _MOST_CALLERS = 10_000

    def __init__(self, limits: Limits, ledger: Ledger) -> None:
        self._limits, self._ledger = limits, ledger
        self._shares: OrderedDict[str, _Share] = OrderedDict()
        self._swept = 0.0

    async def spend(self, caller: str) -> None:
        """Take one request off what a caller has left.

        Raises:
            TooMuchError: nothing is left.
        """
        share = self._shares.setdefault(caller, _Share())
        self._shares.move_to_end(caller)
        if len(self._shares) > self._MOST_CALLERS:
            self._shares.popitem(last=False)
        async with share.taking:
            if not share.left and time.monotonic() >= share.empty_until:
                share.left, wait_s = await kept(self._take, caller)
                share.empty_until = time.monotonic() + wait_s
            if not share.left:
                rate, wait_s = self._limits.requests_per_s, share.empty_until - time.monotonic()
                told = f"at most {rate:g} requests a second; try again in {max(wait_s, 0.0):.1f} s"
                raise TooMuchError(told, Retry_After=str(math.ceil(max(wait_s, 1.0))))
            share.left -= 1

    def _take(self, caller: str) -> tuple[int, float]:
        """How many requests this server may let a caller make, or for how long none."""
        rate, burst, id = self._limits.requests_per_s, self._limits.burst, hashlib.sha256(caller.encode()).hexdigest()
        if time.monotonic() > self._swept + _SWEPT_S:
            self._swept = time.monotonic()
            self._ledger.sweep("budget", unchanged_s=max(burst / rate, _SWEPT_S))  # which are full again
        while True:
            item, now = self._ledger.find("budget", id), time.time()
            left = float(burst)
            if item is not None:
                left = min(left, item.data["left"] + abs(now - item.data["at"]) * rate)  # clocks are set back, too
            if left < 1.0:
                return 0, (1.0 - left) / rate
            taken = min(max(int(max(burst, rate)) // _SHARES, 1), int(left))
            with contextlib.suppress(ChangedError):  # another server took some meanwhile
                self._ledger.put(
                    "budget", id, {"left": left - taken, "at": now}, seen=0 if item is None else item.version
                )
                return taken, 0.0


@dataclass
class _Share:
    """What a server may spend for a caller by itself, and until when the store had nothing more."""

    left: int = 0
    empty_until: float = 0.0
    taking: asyncio.Lock = field(default_factory=asyncio.Lock)

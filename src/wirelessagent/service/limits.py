"""How much anybody may ask of a server."""

from __future__ import annotations

import time
from collections import OrderedDict
from dataclasses import dataclass

from wirelessagent.service.problems import TooMuchError


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What is allowed.

    Attributes:
        body_bytes, upload_bytes: of a request, and of a file with gains.
        receive_s: for a request to arrive whole.
        work_s: for one piece of work.
        requests_per_s, burst: of one caller.
        running_jobs: at one time, of all callers.
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


class Budgets:
    """How much each caller has left: it fills up with time and is spent by requests."""

    _MOST_CALLERS = 10_000

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def spend(self, caller: str) -> None:
        """Take one request off what a caller has left.

        Raises:
            TooMuchError: nothing is left.
        """
        rate, burst, now = self._limits.requests_per_s, self._limits.burst, time.monotonic()
        left, then = self._left.pop(caller, (float(burst), now))
        left = min(float(burst), left + (now - then) * rate)
        self._left[caller] = (max(left - 1.0, 0.0), now)
        if len(self._left) > self._MOST_CALLERS:
            self._left.popitem(last=False)
        if left < 1.0:
            wait = (1.0 - left) / rate
            raise TooMuchError(f"at most {rate:g} requests a second; try again in {wait:.1f} s", Retry_After="1")

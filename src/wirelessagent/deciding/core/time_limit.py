"""When a search ends: at its deadline, or after so many steps.

Kernels cannot look at a clock. So a thread does, and sets a flag that every loop which may take long looks at
(:mod:`.work_kernel`); they also count their steps. A search that its deadline ended after so many steps ends at the
same place again when it is given that number instead: nothing else in it depends on time, except how long the integer
programmes of HiGHS may take.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Generator
from contextlib import contextmanager
from contextvars import ContextVar

import numpy as np

from wirelessagent.model.arrays import IntArray

_EVER = np.iinfo(np.int64).max
_LEAST_S = 0.025
"""What a search that has begun is left at least, which suffices for most: nothing is begun after the deadline."""
_DONE, _MOST, _STOP = 0, 1, 2
"""As in :mod:`.work_kernel`, which is not imported here: it would load the compiler."""


class TimeLimit:
    """The time and the steps that a search may take; none, unless it is said.

    Attributes:
        work: the steps done, the most to do, and whether to stop at once, shape (3,); shared with the kernels.
        deadline: in s on the clock; infinite for none.
    """

    def __init__(self, steps: int | None = None) -> None:
        self.work: IntArray = np.array([0, _EVER if steps is None else steps, 0], dtype=np.int64)
        self.deadline = np.inf
        self._is_timed = steps is None

    @classmethod
    def in_force(cls) -> TimeLimit:
        """That of the method which is at work; none elsewhere."""
        return _in_force.get() or cls()

    @classmethod
    @contextmanager
    def of(cls, seconds: float | None, steps: int | None) -> Generator[TimeLimit]:
        """The limit of all that is done inside, within that of what it is part of."""
        enclosing = _in_force.get()
        limit = cls(steps) if enclosing is None else enclosing
        token = _in_force.set(limit)
        try:
            with limit.within(np.inf if seconds is None else seconds):
                yield limit
        finally:
            _in_force.reset(token)

    @property
    def steps(self) -> int:
        """Steps done."""
        return int(self.work[_DONE])

    @property
    def now_s(self) -> float:
        """The clock, in s."""
        return time.perf_counter()

    @property
    def left_s(self) -> float:
        """The time that is left, in s."""
        return max(self.deadline - self.now_s, 0.0)

    def is_over(self) -> bool:
        """Whether the search has to end; if not, one more step is counted."""
        if self.work[_STOP] or self.work[_DONE] >= self.work[_MOST]:
            return True
        self.work[_DONE] += 1
        return False

    def go_back(self, steps: int) -> None:
        """Count no more than so many steps: what came after them, and had to end, is forgotten."""
        self.work[_DONE] = steps

    @contextmanager
    def within(self, seconds: float) -> Generator[None]:
        """Stop in so many seconds unless all is done by then, for good; nothing new where it has to stop earlier.

        Steps that are given take the place of the clock.
        """
        before = self.deadline
        deadline = self.now_s + seconds if self._is_timed and seconds < np.inf else np.inf
        if deadline >= before:
            yield
            return
        alarm = threading.Timer(min(max(seconds, _LEAST_S), threading.TIMEOUT_MAX), self._stop)
        alarm.daemon = True
        self.deadline = deadline
        alarm.start()
        try:
            yield
        finally:
            alarm.cancel()
            self.deadline = before

    def _stop(self) -> None:
        self.work[_STOP] = 1


_in_force: ContextVar[TimeLimit | None] = ContextVar("the time limit in force", default=None)

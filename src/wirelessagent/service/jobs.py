"""Jobs: work that goes on while its caller waits, watches, or comes back later."""

from __future__ import annotations

import asyncio
import secrets
from collections import OrderedDict
from collections.abc import AsyncGenerator, Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from wirelessagent.service.problems import NotFoundError, ProblemError, problem_of

State: TypeAlias = Literal["running", "done", "failed", "cancelled"]

Tell: TypeAlias = Callable[[dict[str, Any]], None]
"""Is told of each stage."""

_MOST_KEPT = 500


@dataclass(eq=False)
class Job:
    """A piece of work.

    Attributes:
        id: its identifier, which nobody can guess.
        owner: who asked for it.
        state: how far it is.
        result: what came of it.
        problem: why it failed.
        events: what was told of it, in order; the last one is its end.
    """

    owner: str
    id: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: State = "running"
    result: Any = None
    problem: ProblemError | None = None
    events: list[tuple[str, Any]] = field(default_factory=list[tuple[str, Any]])
    _changed: asyncio.Event = field(default_factory=asyncio.Event)
    _task: asyncio.Task[None] | None = None

    @property
    def body(self) -> dict[str, Any]:
        """The job as JSON."""
        problem = None if self.problem is None else self.problem.body
        return {"id": self.id, "state": self.state, "result": self.result, "error": problem}

    def start(self, work: Callable[[Tell], Awaitable[Any]]) -> None:
        """Begin with the work."""
        self._task = asyncio.create_task(self._run(work))

    def cancel(self) -> None:
        """End the work, if it goes on."""
        if self._task is not None and self.state == "running":
            self._task.cancel()

    async def finished(self) -> Any:
        """What came of it.

        Raises:
            ProblemError: it failed, or was cancelled.
        """
        while self.state == "running":
            await self._changed.wait()
        if self.problem is not None:
            raise self.problem
        return self.result

    async def told(self, after: int = 0) -> AsyncGenerator[tuple[int, str, Any]]:
        """The events behind number ``after``, as they come, with their numbers."""
        number = max(after, 0)
        while True:
            changed = self._changed
            while number < len(self.events):
                number += 1
                yield number, *self.events[number - 1]
            if self.state != "running":
                return
            await changed.wait()

    async def _run(self, work: Callable[[Tell], Awaitable[Any]]) -> None:
        try:
            self.result = await work(lambda stage: self._tell("stage", stage))
        except asyncio.CancelledError:
            self.problem = ProblemError("the work was cancelled", status=409, title="Cancelled")
            self._end("cancelled", self.problem.body)
        except Exception as error:  # noqa: BLE001  # whoever waits is told
            self.problem = problem_of(error)
            self._end("failed", self.problem.body)
        else:
            self._end("done", self.result)

    def _end(self, state: State, said: Any) -> None:
        self.state = state
        self._tell(state, said)

    def _tell(self, kind: str, said: Any) -> None:
        self.events.append((kind, said))
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()


class Jobs:
    """The jobs of a server; the oldest that have ended are forgotten."""

    def __init__(self) -> None:
        self._jobs: OrderedDict[str, Job] = OrderedDict()

    def start(self, owner: str, work: Callable[[Tell], Awaitable[Any]]) -> Job:
        """A new job, begun."""
        job = Job(owner)
        self._jobs[job.id] = job
        for old in [one for one in self._jobs.values() if one.state != "running"][: len(self._jobs) - _MOST_KEPT]:
            del self._jobs[old.id]
        job.start(work)
        return job

    def find(self, id: str, owner: str) -> Job:
        """The job of this owner.

        Raises:
            NotFoundError: there is none, or it is somebody else's.
        """
        job = self._jobs.get(id)
        if job is None or job.owner != owner:
            raise NotFoundError(f"there is no job {id!r}, or it ended long ago")
        return job

    @property
    def running(self) -> int:
        """How many go on."""
        return sum(job.state == "running" for job in self._jobs.values())

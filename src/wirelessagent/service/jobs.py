"""Jobs: work that goes on while its caller waits, watches, or comes back later.

A job that its caller may come back for is told of in the store while it goes on, and kept there for a day with what
came of it. So each server can be asked about it, and a request with a key is done once, whichever server it reaches.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import time
from collections import OrderedDict
from collections.abc import AsyncGenerator, Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from wirelessagent.model.errors import StoreError
from wirelessagent.service.kept import kept
from wirelessagent.service.problems import (
    ConflictError,
    NotFoundError,
    ProblemError,
    TooMuchError,
    UnavailableError,
    problem_of,
)
from wirelessagent.store.ledger import ChangedError, Item, Ledger

State: TypeAlias = Literal["running", "done", "failed", "cancelled"]

Tell: TypeAlias = Callable[[dict[str, Any]], None]
"""Is told of each stage."""

Work: TypeAlias = Callable[[Tell], Awaitable[Any]]

_MOST_KEPT = 500
_BEAT_S = 1.0
"""How often a job that goes on is told of in the store."""

_LOST_S = 15.0
"""Without a word for this time, its server is taken to be gone."""

_FOLLOWED_S = 0.2
"""How often another server looks."""

_KEPT_S = 86_400.0
_SWEPT_S = 600.0


@dataclass(eq=False)
class Job:
    """A piece of work.

    Attributes:
        id: its identifier, which nobody can guess.
        owner: who asked for it.
        state: how far it is.
        result: what came of it.
        problem: why it failed.
        elsewhere: whether another server does it, and this one looks on.
        events: what was told of it, in order; the last one is its end.
    """

    owner: str
    id: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: State = "running"
    result: Any = None
    problem: ProblemError | None = None
    elsewhere: bool = False
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

    @property
    def worth_keeping(self) -> bool:
        """Whether who asks for the same again gets this, and not another try."""
        return self.state != "cancelled" and (self.problem is None or self.problem.status < 500)

    @property
    def stored(self) -> dict[str, Any]:
        """The job as the store keeps it; whatever it gave is the last event, too."""
        events = self.events if self.state == "running" else self.events[:-1]
        return {**self.body, "owner": self.owner, "events": events}

    def take_over(self, told: dict[str, Any]) -> None:
        """Be as the store tells it."""
        for kind, said in told["events"][len(self.events) :]:
            self._tell(kind, said)
        if told["state"] == "running" or self.state != "running":
            return
        self.result, error = told["result"], told["error"]
        if error is not None:
            self.problem = ProblemError(error["detail"], status=error["status"], title=error["title"])
        self._end(told["state"], self.result if error is None else error)

    def lose(self) -> None:
        """Be over, since whoever did it is gone."""
        detail = "the server that did this is gone, and what came of it is not known: look at what holds now"
        self.problem = UnavailableError(detail, title="The work broke off")
        self._end("failed", self.problem.body)

    def _end(self, state: State, said: Any) -> None:
        self.state = state
        self._tell(state, said)

    def _tell(self, kind: str, said: Any) -> None:
        self.events.append((kind, said))
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()


class Jobs:
    """The jobs of a server, and those of others that it was asked about; the oldest that have ended are forgotten.

    Args:
        ledger: where they are told of.
        most_running: at one time; one caller leaves a quarter of them to others.
    """

    def __init__(self, ledger: Ledger, most_running: int) -> None:
        self._ledger, self._most_running = ledger, most_running
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._told, self._followed = dict[str, asyncio.Task[None]](), dict[str, asyncio.Task[None]]()
        self._swept = 0.0

    def start(self, owner: str, work: Work) -> Job:
        """A new job, begun.

        Raises:
            TooMuchError: too much goes on already.
        """
        self._check_room(owner)
        job = Job(owner)
        self._remember(job)
        job.start(work)
        return job

    async def share(self, job: Job) -> None:
        """Have other servers know of a job, from now to a day after its end."""
        version = await kept(self._ledger.put, "job", job.id, job.stored, seen=0)
        self._told[job.id] = task = asyncio.create_task(self._tell_of(job, version))
        task.add_done_callback(lambda _: self._told.pop(job.id))

    async def once(self, owner: str, key: str, request: str, work: Work) -> Job:
        """The job of a key: the one that it has, or a new one where that was cancelled or its server failed.

        Raises:
            ConflictError: the key was used for another request.
        """
        while True:
            item = await kept(self._ledger.find, "key", key)
            if item is not None:
                if item.data["request"] != request:
                    raise ConflictError("this Idempotency-Key was used for another request")
                with contextlib.suppress(NotFoundError):
                    job = await self.find(item.data["job"], owner)
                    if job.worth_keeping:
                        return job
            self._check_room(owner)
            job = Job(owner)
            await self.share(job)
            named = {"request": request, "job": job.id}
            try:
                await kept(self._ledger.put, "key", key, named, seen=0 if item is None else item.version)
            except ChangedError:  # another one with this key came first
                job.lose()
                continue
            self._remember(job)
            job.start(work)
            return job

    async def settled(self, job: Job) -> Any:
        """What came of a job, once the store has it.

        Raises:
            ProblemError: it failed, or was cancelled.
        """
        came_of_it = await job.finished()
        if job.id in self._told:
            await asyncio.shield(self._told[job.id])
        return came_of_it

    async def find(self, id: str, owner: str) -> Job:
        """The job of this owner.

        Raises:
            NotFoundError: there is none, or it is somebody else's.
        """
        job = self._jobs.get(id)
        if job is None:
            item = await kept(self._ledger.find, "job", id)
            job = None if item is None else self._jobs.get(id) or self._seen(item)
        if job is None or job.owner != owner:
            raise NotFoundError(f"there is no job {id!r}, or it ended long ago")
        return job

    async def cancel(self, id: str, owner: str) -> None:
        """End the work of a job, if it goes on; where another server does it, that is told to."""
        job = await self.find(id, owner)
        if not job.elsewhere:
            job.cancel()
            return
        item = await kept(self._ledger.find, "job", id)
        if item is not None and item.data["state"] == "running":
            with contextlib.suppress(ChangedError):  # a beat or its end came first: whoever wants it asks again
                await kept(self._ledger.put, "job", id, item.data, seen=item.version)

    def _check_room(self, owner: str) -> None:
        going = [job for job in self._jobs.values() if job.state == "running" and not job.elsewhere]
        share = self._most_running * 3 // 4
        if len(going) >= self._most_running:
            raise TooMuchError(f"{self._most_running} jobs go on already; try again in a while", Retry_After="5")
        if sum(job.owner == owner for job in going) >= share:
            raise TooMuchError(f"{share} jobs of yours go on already; wait for one, or cancel it", Retry_After="5")

    def _remember(self, job: Job) -> None:
        self._jobs[job.id] = job
        for old in [one for one in self._jobs.values() if one.state != "running"][: len(self._jobs) - _MOST_KEPT]:
            del self._jobs[old.id]

    def _seen(self, item: Item) -> Job:
        """A job that another server does, as far as it is."""
        job = Job(item.data["owner"], item.id, elsewhere=True)
        job.take_over(dict(item.data))
        self._remember(job)
        if job.state == "running":
            self._followed[job.id] = task = asyncio.create_task(self._follow(job, item.version))
            task.add_done_callback(lambda _: self._followed.pop(job.id))
        return job

    async def _follow(self, job: Job, version: int) -> None:
        """Look on until the end, or until nothing was heard of it for too long."""
        heard = time.monotonic()
        while job.state == "running":
            await asyncio.sleep(_FOLLOWED_S)
            item = await kept(self._ledger.find, "job", job.id)
            if item is not None and item.version != version:
                version, heard = item.version, time.monotonic()
                job.take_over(dict(item.data))
            elif item is None or time.monotonic() > heard + _LOST_S:
                job.lose()

    async def _tell_of(self, job: Job, version: int) -> None:
        """Keep the store up with a job; whoever else writes there wants it cancelled."""
        while True:
            with contextlib.suppress(TimeoutError, ProblemError):
                await asyncio.wait_for(job.finished(), _BEAT_S)
            over = job.state != "running"
            try:
                version = await kept(self._ledger.put, "job", job.id, job.stored, seen=None if over else version)
            except ChangedError:
                job.cancel()
            except StoreError:  # one beat less; whoever waits for the end is told
                if over:
                    raise
            if over:
                break
        if time.monotonic() > self._swept + _SWEPT_S:
            self._swept = time.monotonic()
            for kind in ("key", "job"):
                await kept(self._ledger.sweep, kind, unchanged_s=_KEPT_S)

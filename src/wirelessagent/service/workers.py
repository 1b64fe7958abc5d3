"""The server's side of its workers: starts them when they are needed, tells them what to do, ends them when it must."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import os
import sys
import zlib
from collections.abc import AsyncGenerator, Callable, Mapping
from typing import Any

from wirelessagent.service.names import PublicNames
from wirelessagent.service.problems import BrokeOffError, ProblemError, TimedOutError

TAKEN_UP = "recall"
"""The stage of a turn that was said again, for a conversation that is taken up."""

_LONGEST_ANSWER_BYTES = 256 << 20


class Workers:
    """So many processes, each of which does one thing at a time.

    Args:
        number: of processes; none is started before it has something to do.
        time_limit_s: how long one thing may take before its process is ended.
        environment: what the processes know beside this one's environment.
        names: what is told of what they say.
    """

    def __init__(
        self, number: int = 1, *, time_limit_s: float, environment: Mapping[str, str], names: PublicNames
    ) -> None:
        self._time_limit_s = time_limit_s
        self._processes = [_Process(environment, names) for _ in range(number)]

    async def do(
        self, what: str, tell: Callable[[dict[str, Any]], None], *, of: str = "",
        called: Mapping[str, str] | None = None, **told: Any,
    ) -> Any:  # fmt: skip
        """Have one thing done by the worker that conversation ``of`` belongs to, or by the least busy one.

        Where the worker has to start, or the conversation to be taken up first, that and each of its turns have the
        time that one thing has. A worker
        that turns out to be gone before it has begun is replaced once, so that who did nothing wrong notices nothing.
        ``called`` says what the paths that it is told are called in what it says.

        Raises:
            TimedOutError: it took too long; the worker was ended.
            ProblemError: it failed.
        """
        mine = self._processes[zlib.crc32(of.encode()) % len(self._processes)]
        process = mine if of else min(self._processes, key=lambda one: one.waiting)
        return await process.do({"do": what, **told}, tell, self._time_limit_s, called or {})

    async def close(self) -> None:
        """End all processes."""
        for process in self._processes:
            await process.end()


class _Process:
    def __init__(self, environment: Mapping[str, str], names: PublicNames) -> None:
        self._environment, self._names = environment, names
        self._process: asyncio.subprocess.Process | None = None
        self._turn = asyncio.Lock()
        self._numbers = itertools.count(1)
        self.waiting = 0

    async def do(
        self, told: Mapping[str, Any], tell: Callable[[dict[str, Any]], None], time_limit_s: float,
        called: Mapping[str, str],
    ) -> Any:  # fmt: skip
        self.waiting += 1
        try:
            async with self._turn:
                try:
                    async with asyncio.timeout(time_limit_s) as limit:

                        def heard(event: dict[str, Any]) -> None:
                            if event["stage"] == TAKEN_UP:
                                anew()
                            tell(event)

                        def anew() -> None:
                            limit.reschedule(asyncio.get_running_loop().time() + time_limit_s)

                        return await self._done(told, heard, called, anew)
                except TimeoutError as error:
                    await self.end()
                    raise TimedOutError(
                        f"the work took longer than {time_limit_s:g} s and was ended; ask for less, or for a faster "
                        "method (option deadline_s)"
                    ) from error
                except ProblemError:
                    raise
                except BaseException:  # cancelled, or an answer that cannot be read: what it says next is of no use
                    await self.end()
                    raise
        finally:
            self.waiting -= 1

    async def end(self) -> None:
        """End the process, if there is one."""
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
            await process.wait()

    async def _done(
        self, told: Mapping[str, Any], tell: Callable[[dict[str, Any]], None], called: Mapping[str, str],
        begins: Callable[[], None],
    ) -> Any:  # fmt: skip
        for _ in range(2):
            begun = False
            async with contextlib.aclosing(self._answers(told, called)) as answers:
                async for answer in answers:
                    if "begun" in answer:
                        begun = True
                        begins()
                    elif "event" in answer:
                        tell(answer["event"])
                    elif "failed" in answer:
                        problem = answer["failed"]
                        raise ProblemError(problem["detail"], status=problem["status"], title=problem["title"])
                    else:
                        return answer["done"]
            await self.end()
            if begun:
                break
        raise BrokeOffError

    async def _answers(self, told: Mapping[str, Any], called: Mapping[str, str]) -> AsyncGenerator[dict[str, Any]]:
        """What the process answers, as long as it is there."""
        process = await self._running()
        assert process.stdin is not None
        assert process.stdout is not None
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            process.stdin.write(json.dumps({"id": next(self._numbers), **told}).encode() + b"\n")
            await process.stdin.drain()
            while line := await process.stdout.readline():
                yield json.loads(self._names.told(line, called))

    async def _running(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            self._process = await asyncio.create_subprocess_exec(
                sys.executable, "-m", "wirelessagent.service.worker",
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                limit=_LONGEST_ANSWER_BYTES,
                env={**os.environ, **self._environment},
            )  # fmt: skip
        return self._process

"""How routes read requests and write answers: strict JSON in, problems out, long work as jobs."""

from __future__ import annotations

import asyncio
import hashlib
import json
import math
from collections.abc import AsyncGenerator, Awaitable, Callable
from typing import Any, NoReturn

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, StreamingResponse
from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException

from wirelessagent.service.access import Caller
from wirelessagent.service.jobs import Job, Tell
from wirelessagent.service.problems import (
    NotSignedInError,
    ProblemError,
    UnusableError,
    problem_of,
)
from wirelessagent.service.service import Service

_KEEP_ALIVE_S = 15.0


class StrictRequest(Request):
    """A request whose JSON is JSON: whole characters, finite numbers, and not nested without end."""

    async def json(self) -> Any:
        if not hasattr(self, "_json"):
            self._json = strict_json(await self.body())
        return self._json


class StrictRoute(APIRoute):
    """A route with such requests."""

    def get_route_handler(self) -> Callable[[Request], Any]:
        handle = super().get_route_handler()

        async def strict(request: Request) -> Response:
            return await handle(StrictRequest(request.scope, request.receive))

        return strict


def strict_json(body: bytes) -> Any:
    """What a body says.

    Raises:
        UnusableError: it is not JSON.
    """
    try:
        found = json.loads(body, parse_constant=_refuse, parse_float=_finite, object_pairs_hook=_unique)
        json.dumps(found, ensure_ascii=False).encode()  # fails at half a character, which nothing could keep or tell
        return found
    except UnicodeEncodeError as error:
        half = error.object[error.start]
        raise UnusableError(f"a text in the body holds {half!r}, half of a character: leave it out") from error
    except (ValueError, RecursionError) as error:
        raise UnusableError(f"the body is not JSON that can be used: {error}") from error


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is no number of JSON's")


def _finite(number: str) -> float:
    if math.isinf(found := float(number)):
        raise ValueError(f"{number[:50]} is larger than any number here can be")
    return found


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a name stands twice in one object")
    return found


def current(request: Request, found: Any) -> Response:
    """What is there now, or 304 where the caller has it already."""
    answer = JSONResponse(found)
    tag = f'"{hashlib.sha256(answer.body).hexdigest()[:32]}"'
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers={"ETag": tag})
    answer.headers["ETag"] = tag
    return answer


def problem_in(error: Exception) -> ProblemError:
    """Whatever went wrong with a request as a problem."""
    match error:
        case RequestValidationError():
            first = error.errors()[0]
            place = ".".join(str(part) for part in first["loc"] if part != "body") or "the body"
            return UnusableError(f"{place}: {first['msg'].removeprefix('Value error, ')}")
        case HTTPException(__cause__=ProblemError() as problem):  # from reading the body
            return problem
        case HTTPException():
            headers = dict(error.headers or {})
            return ProblemError(str(error.detail), status=error.status_code, title=str(error.detail), **headers)
        case _:
            return problem_of(error)


def caller_of(request: Request) -> Caller:
    """Who asks.

    Raises:
        NotSignedInError: nobody who is known.
    """
    caller = request.scope["state"]["caller"]
    if not isinstance(caller, Caller):
        raise NotSignedInError
    return caller


def service_of(request: Request) -> Service:
    """What is asked."""
    return request.app.state.service


async def worked(request: Request, work: Callable[[Tell], Awaitable[Any]], *, status: int = 200) -> Response:
    """The answer to a request that needs work: what came of it, or 202 and the job where the caller prefers that.

    A caller who goes away ends the work. A request with an ``Idempotency-Key`` is done once, also where its caller goes
    away: who sends it again gets the same answer, and has it done again only where the server had failed.
    """
    service, caller = service_of(request), caller_of(request)
    key = request.headers.get("idempotency-key")
    later = "respond-async" in request.headers.get("prefer", "")
    if key:
        job = await service.jobs.once(caller.name, _key(request, key), await _request(request), work)
    else:
        job = service.job(caller, work)
        if later:
            await service.jobs.share(job)
    if later:
        place = request.url_for("read_job", id=job.id).path
        headers = {"Location": place, "Preference-Applied": "respond-async"}
        return JSONResponse(job.body, status_code=202, headers=headers)
    came_of_it = await (service.jobs.settled(job) if key else finished(request, job))
    return JSONResponse(came_of_it, status_code=status)


async def finished(request: Request, job: Job) -> Any:
    """What comes of a job, which ends when its caller hangs up, or sends what is not taken.

    Raises:
        ProblemError: it failed, or was cancelled.
    """
    gone = asyncio.create_task(_gone(request))
    done = asyncio.create_task(job.finished())
    try:
        await asyncio.wait({gone, done}, return_when=asyncio.FIRST_COMPLETED)
        if not done.done():
            job.cancel()
            await gone
        return await done
    finally:
        gone.cancel()


async def _gone(request: Request) -> None:
    while (await request.receive())["type"] != "http.disconnect":
        pass


def _key(request: Request, key: str) -> str:
    return hashlib.sha256(f"{caller_of(request).name}\n{request.url.path}\n{key}".encode()).hexdigest()


async def _request(request: Request) -> str:
    """By what a request is known again."""
    return hashlib.sha256(request.url.query.encode() + b"\n" + await request.body()).hexdigest()


def streamed(job: Job, after: int) -> StreamingResponse:
    """The events of a job as server-sent events, from behind number ``after``."""

    async def events() -> AsyncGenerator[bytes]:
        told = job.told(after)
        following = asyncio.ensure_future(anext(told, None))
        while True:
            done, _ = await asyncio.wait({following}, timeout=_KEEP_ALIVE_S)
            if not done:
                yield b": still at work\n\n"
                continue
            event = following.result()
            if event is None:
                return
            number, kind, said = event
            yield f"id: {number}\nevent: {kind}\ndata: {json.dumps(said, ensure_ascii=False)}\n\n".encode()
            following = asyncio.ensure_future(anext(told, None))

    return StreamingResponse(events(), media_type="text/event-stream", headers={"X-Accel-Buffering": "no"})

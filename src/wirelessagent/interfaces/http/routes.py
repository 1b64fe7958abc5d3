"""The REST interface: operations, observations, cells, conversations, jobs, history."""

from __future__ import annotations

import base64
from collections.abc import Awaitable, Callable
from typing import Annotated, Any, cast

from fastapi import APIRouter, Depends, Path, Query, Request, Response
from fastapi.responses import JSONResponse

from wirelessagent.interfaces.http import forms
from wirelessagent.interfaces.http.answers import (
    StrictRoute,
    caller_of,
    current,
    service_of,
    streamed,
    strict_json,
    worked,
)
from wirelessagent.operations.hosted_answers import ChannelAnswer, Press, TradeOffAnswer
from wirelessagent.operations.operation import installed_version
from wirelessagent.operations.recognisers import llm_model
from wirelessagent.service.jobs import Tell
from wirelessagent.service.observations import SUFFIXES
from wirelessagent.service.problems import UnusableError
from wirelessagent.service.words import LANGUAGES, words

PROBLEMS: dict[int | str, dict[str, Any]] = {
    status: {"model": forms.Problem, "description": said, "content": {"application/problem+json": {}}}
    for status, said in {
        400: "This cannot be done", 401: "Sign in first", 403: "Not allowed", 404: "There is no such thing",
        408: "Too slow", 409: "Things have changed", 413: "Too large", 421: "Misdirected",
        422: "This cannot be used", 429: "Too many requests", 500: "This failed", 503: "Not just now",
        504: "This took too long",
    }.items()
}  # fmt: skip
"""What any request may be answered by instead."""

router = APIRouter(prefix="/v1", route_class=StrictRoute, responses=PROBLEMS, dependencies=[Depends(caller_of)])
texts = APIRouter(prefix="/v1", route_class=StrictRoute, responses=PROBLEMS)

Id = Annotated[str, Path(min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$")]


def _as(model: Any, status: int = 200) -> dict[int | str, dict[str, Any]]:
    """A documented answer beside the job that stands for it where it is preferred."""
    return {status: {"model": model}, 202: {"model": forms.JobAnswer, "description": "The work goes on"}}


@router.get("/console", response_model=forms.Start, tags=["console"])
async def start(request: Request) -> Any:
    """What the console starts from."""
    caller = caller_of(request)
    return {
        "version": installed_version(), "name": caller.name, "role": caller.role,
        "signed_in": caller.name != "local", "languages": LANGUAGES, "llm": llm_model(),
        "cells": await service_of(request).cells(),
    }  # fmt: skip


@texts.get("/words/{language}", tags=["console"])
async def read_words(language: Annotated[str, Path(pattern="^[a-z]{2}$")]) -> dict[str, str]:
    """All texts in a language, by their keys."""
    return words(language)


@router.get("/cells", response_model=list[forms.CellAnswer], tags=["cells"])
async def list_cells(request: Request) -> Any:
    """All cells."""
    return current(request, await service_of(request).cells())


@router.post("/cells", status_code=201, responses=_as(forms.CellAnswer, 201), tags=["cells"])
async def make_cell(request: Request, form: forms.NewCell) -> Response:
    """A new cell: a simulated one, or one on an observation."""
    service = service_of(request)
    return await worked(request, lambda tell: service.make_cell(form.name, form.options, tell), status=201)


@router.get("/cells/{id}", response_model=forms.CellAnswer, tags=["cells"])
async def read_cell(request: Request, id: Id) -> Any:
    """One cell."""
    return await service_of(request).cell(id)


@router.put("/cells/{id}/observation", responses=_as(forms.CellAnswer), tags=["cells"])
async def move_cell(request: Request, id: Id, form: forms.WorksOn) -> Response:
    """Have a cell work on another observation, as where the one it had is gone. A new conversation begins with it."""
    service = service_of(request)
    return await worked(request, lambda tell: service.move_cell(id, form.observation, tell))


@router.delete("/cells/{id}", status_code=204, tags=["cells"])
async def drop_cell(request: Request, id: Id) -> None:
    """Remove a cell; what was said of it stays in the history."""
    await service_of(request).drop_cell(id)


NAMES = rf"(?i)\.({'|'.join(sorted(suffix[1:] for suffix in SUFFIXES))})$"


@router.post("/observations", status_code=201, responses=_as(forms.ObservationAnswer, 201), tags=["observations"],
             openapi_extra={"requestBody": {"required": True, "content": {"application/octet-stream": {
                 "schema": {"type": "string", "format": "binary"}}}}})  # fmt: skip
async def observe(
    request: Request,
    name: Annotated[
        str,
        Query(min_length=1, max_length=200, description="the file's name, whose end says its format", pattern=NAMES),
    ],
    unit: Annotated[str | None, Query(max_length=40, description="unit of the gains, such as db")] = None,
    axes: Annotated[str | None, Query(max_length=40, description="what rows and columns are")] = None,
) -> Response:
    """Send a file with gains; the answer says what was understood of it."""
    content, service = await request.body(), service_of(request)
    options = {option: value for option, value in (("unit", unit), ("axes", axes)) if value is not None}
    return await worked(request, lambda tell: service.observations.add(name, content, options, tell), status=201)


@router.get("/observations/{id}", response_model=forms.ObservationAnswer, tags=["observations"])
async def read_observation(request: Request, id: Id) -> Any:
    """What was understood of a file."""
    return await service_of(request).observations.one(id)


@router.delete("/observations/{id}", status_code=204, tags=["observations"])
async def drop_observation(request: Request, id: Id) -> None:
    """Remove a file."""
    await service_of(request).observations.drop(id)


@router.post("/sessions", status_code=201, response_model=forms.SessionAnswer, tags=["conversations"])
async def open_session(request: Request, form: forms.NewSession) -> Any:
    """Begin a new conversation about a cell, in the place of the one it has."""
    return await service_of(request).open_session(form.cell)


@router.get("/sessions/{id}", response_model=forms.SessionAnswer, tags=["conversations"])
async def read_session(request: Request, id: Id) -> Any:
    """A conversation with its turns and the plan that waits."""
    return current(request, await service_of(request).session(id))


@router.get("/sessions/{id}/channel", response_model=ChannelAnswer | None, tags=["conversations"])
async def read_channel(request: Request, id: Id) -> Any:
    """What is known of the channel that a conversation is about; null before anything was sensed."""
    return current(request, await service_of(request).channel(id))


@router.get("/sessions/{id}/turns/{number}/trade-off", responses=_as(TradeOffAnswer), tags=["conversations"])
async def trade_off(request: Request, id: Id, number: Annotated[int, Path(ge=1, le=2**31)]) -> Response:
    """What a turn's decision trades: its best value at other budgets, or the least power for other promises."""
    service = service_of(request)
    return await worked(request, lambda tell: service.trade_off(id, number, tell))


@router.post("/sessions/{id}/turns", responses=_as(forms.TurnAnswer), tags=["conversations"])
async def say(request: Request, id: Id, form: forms.Said) -> Response:
    """Say a line. It applies nothing: a plan that it leads to waits to be confirmed."""
    service, caller = service_of(request), caller_of(request)
    return await worked(request, lambda tell: service.say(id, form.text, caller, tell))


@router.post("/sessions/{id}/confirm", responses=_as(forms.TurnAnswer), tags=["conversations"])
async def confirm(request: Request, id: Id, form: forms.Pressed) -> Response:
    """Apply the plan that was seen; whoever else changed something meanwhile makes it stale."""
    return await worked(request, _pressed(request, id, "yes", form.plan))


@router.post("/sessions/{id}/discard", responses=_as(forms.TurnAnswer), tags=["conversations"])
async def discard(request: Request, id: Id, form: forms.Pressed) -> Response:
    """Drop the plan that was seen; what is in effect goes on."""
    return await worked(request, _pressed(request, id, "no", form.plan))


@router.post("/sessions/{id}/undo", responses=_as(forms.TurnAnswer), tags=["conversations"])
async def undo(request: Request, id: Id) -> Response:
    """Take the last change back; going back to an earlier allocation waits to be confirmed, too."""
    return await worked(request, _pressed(request, id, "undo", None))


def _pressed(request: Request, id: str, what: Press, plan: str | None) -> Callable[[Tell], Awaitable[Any]]:
    service, caller = service_of(request), caller_of(request)
    return lambda tell: service.press(id, what, caller, tell, plan=plan)


@router.get("/jobs/{id}", response_model=forms.JobAnswer, tags=["jobs"])
async def read_job(request: Request, id: Id) -> Any:
    """How far a job is, and what came of it."""
    return JSONResponse((await service_of(request).jobs.find(id, caller_of(request).name)).body)


@router.delete("/jobs/{id}", status_code=204, tags=["jobs"])
async def cancel_job(request: Request, id: Id) -> None:
    """End a job."""
    await service_of(request).jobs.cancel(id, caller_of(request).name)


@router.get("/jobs/{id}/events", tags=["jobs"], response_class=Response,
            responses={200: {"content": {"text/event-stream": {}}}})  # fmt: skip
async def follow_job(request: Request, id: Id) -> Response:
    """The stages of a job as server-sent events (stage, then done, failed or cancelled), from Last-Event-ID on."""
    after = request.headers.get("last-event-id", "0")
    job = await service_of(request).jobs.find(id, caller_of(request).name)
    return streamed(job, int(after) if after.isdecimal() and len(after) < 10 else 0)


@router.get("/operations", tags=["operations"])
async def list_operations(request: Request) -> dict[str, Any]:
    """What can be asked, each with the JSON Schema of its form."""
    return await service_of(request).forms()


@router.post("/operations/{name}", responses=_as(forms.OperationAnswer), tags=["operations"],
             openapi_extra={"requestBody": {"required": False, "content": {"application/json": {
                 "schema": {"type": "object"}}}}})  # fmt: skip
async def operate(request: Request, name: Annotated[str, Path(min_length=1, max_length=40)]) -> Response:
    """Run an operation of the catalogue: ``observation`` names the channel, ``picture`` asks for its picture."""
    body, service = await request.body(), service_of(request)
    given: Any = strict_json(body) if body.strip() else {}
    if not isinstance(given, dict):
        raise UnusableError("the body is an object with the fields of the operation's form")
    form = cast("dict[str, Any]", given)
    return await worked(request, lambda tell: service.operate(name, form, tell))


@router.get("/history", tags=["history"])
async def history(
    request: Request,
    last: Annotated[int, Query(ge=1, le=1000)] = 50,
    session: Annotated[str | None, Query(max_length=64)] = None,
) -> Response:
    """What was said, decided and done, the latest turns."""
    service = service_of(request)
    form: dict[str, Any] = {"last": last, **({"session": session} if session else {})}

    async def listed(tell: Tell) -> Any:
        return (await service.operate("history", form, tell))["record"]

    return await worked(request, listed)


@router.get("/allocations/{number}", tags=["history"], response_class=Response)
async def allocation(
    request: Request,
    number: Annotated[int, Path(ge=1, le=2**53)],
    format: Annotated[str, Query(pattern="^(json|csv|npz|png|svg)$")] = "json",
) -> Response:
    """The allocation of a turn in the history, as a file."""
    found = await service_of(request).allocation(number, format)
    name = f"allocation-{number}.{format}"
    return Response(
        base64.b64decode(found["content"]),
        media_type=found["media_type"],
        headers={"Content-Disposition": f'attachment; filename="{name}"'},
    )


@router.post("/intents", status_code=201, responses=_as(forms.TurnAnswer, 201), tags=["conversations"],
             openapi_extra={"requestBody": {"required": True, "content": {"application/json": {
                 "schema": {"type": "object"}}}}})  # fmt: skip
async def intend(
    request: Request,
    cell: Annotated[str, Query(min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$", description="the cell's id")],
) -> Response:
    """Ask for what an Intent of TMF921 says, in a new conversation about the cell; what it leads to waits, too.

    What an intent can say and a cell cannot be asked is refused by its name. The answer is that of a line; the same
    request as TMF921 has it is at `/v1/intents/{stored}`.
    """
    given: Any = strict_json(await request.body())
    if not isinstance(given, dict):
        raise UnusableError("the body is an Intent of TMF921, an object")
    service, caller, said = service_of(request), caller_of(request), cast("dict[str, Any]", given)
    return await worked(request, lambda tell: service.intend(cell, said, caller, tell), status=201)


@router.get("/intents/{number}", tags=["history"])
async def intent(request: Request, number: Annotated[int, Path(ge=1, le=2**53)]) -> Response:
    """A request in the history and what came of it, in the shape of TMF921."""
    service = service_of(request)

    async def exported(tell: Tell) -> Any:
        return (await service.operate("export", {"number": number, "format": "tmf921"}, tell))["record"]

    return await worked(request, exported)

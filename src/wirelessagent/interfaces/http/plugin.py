"""The plug-in that low-code platforms import: a dozen operations at most, and their document in OpenAPI 3.0.3.

Whoever was let in is always answered with 200, errors inside the object, since these platforms drop the bodies of
other answers and their models never learn what was wrong. The document is written here and not by the framework: its
importers want exactly one absolute server, one media type, no null and no reference with siblings.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from fastapi import FastAPI, Request, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from starlette.routing import Route

from wirelessagent.interfaces.http import plugin_forms as forms
from wirelessagent.interfaces.http.answers import caller_of, finished, problem_in, service_of, strict_json
from wirelessagent.interfaces.http.plugin_desk import Desk
from wirelessagent.interfaces.http.shield import in_plugin
from wirelessagent.interfaces.schemas import asked, inlined
from wirelessagent.operations.forms import telling_what_is_wrong
from wirelessagent.operations.operation import installed_version
from wirelessagent.service.jobs import Tell
from wirelessagent.service.problems import UnusableError

Json: TypeAlias = dict[str, Any]


@dataclass(frozen=True)
class _Skin:
    """An operation; ``description`` is for the language model that chooses among them."""

    name: str
    method: str
    summary: str
    description: str
    form: type[forms.PluginForm]
    answer: type[forms.Answer]
    run: Callable[[Desk, Any], Awaitable[Json]]


_THEN_SOLVE = " Give the observation's id to a solver; never retype gains."
_SOLVED = (
    "It computes only: nothing is sent to a base station. The answer says value, bound and gap (a certificate) and who "
    "has which subcarriers. Missing gains are repaired first."
)

_SKINS = (
    _Skin("cells", "GET", "List the cells", "List the cells with their ids, sizes, limits and base stations. Call it "
          "first where another operation asks which cell is meant.", forms.CellsForm, forms.CellsTold, Desk.cells),
    _Skin("sense", "POST", "Collect channel state (simulated)", "The collector: draw a channel, lose some of its "
          "reports, and keep it as an observation." + _THEN_SOLVE, forms.SenseForm, forms.ObservationTold, Desk.sense),
    _Skin("repair", "POST", "Predict missing channel state", "The predictor: fill the holes of an observation, with "
          "how sure each filled gain is, and keep the result as a new observation." + _THEN_SOLVE, forms.RepairForm,
          forms.ObservationTold, Desk.repair),
    _Skin("solve_max_rate", "POST", "Highest total rate (P1)", "The paper's solver P1: the highest total rate within a "
          "power budget, with a rate for every user if wanted. " + _SOLVED, forms.SolveForm, forms.DecisionTold,
          Desk.max_rate),
    _Skin("solve_min_power", "POST", "Least power (P2)", "The paper's solver P2: the least radiated power that gives "
          "every user a rate; min_rate_bps is needed. " + _SOLVED, forms.SolveForm, forms.DecisionTold,
          Desk.min_power),
    _Skin("solve_max_energy_efficiency", "POST", "Most bits per joule (P3)", "The paper's solver P3: the most bits per "
          "joule, circuit power included. " + _SOLVED, forms.SolveForm, forms.DecisionTold,
          Desk.max_energy_efficiency),
    _Skin("ask", "POST", "Try a request in plain words", "The whole chain from plain words on a channel of its own: "
          "understand, sense, repair, decide, explain. For trying something out: no cell changes. For a real cell use "
          "propose.", forms.AskForm, forms.DecisionTold, Desk.ask),
    _Skin("move_cell", "POST", "Have a cell work on an observation", "Have a cell work on another observation from now "
          "on. A new conversation begins with it: a plan that waits is dropped; what the base station does goes on.",
          forms.MoveForm, forms.MovedTold, Desk.move_cell),
    _Skin("propose", "POST", "Plan a change of a cell", "Say in the user's own words what a cell should do. Nothing is "
          "applied: show the user what would change (said), and call apply with plan only after their yes. Follow-ups "
          "such as 'user 3 at least 2 Mbit/s' amend the last request; 'undo' takes it back.", forms.ProposeForm,
          forms.TurnTold, Desk.propose),
    _Skin("apply", "POST", "Apply a plan after the user's yes", "Have the base station do what a plan says, and read "
          "back what happened. The id works once, while nothing else was applied, for a limited time. Never call it "
          "without the user's yes to exactly this plan.", forms.ApplyForm, forms.TurnTold, Desk.apply),
    _Skin("explain", "POST", "Explain a cell's allocation", "Answer a question about a cell's allocation: why, how "
          "sure, what it would take, what if. Applies nothing.", forms.ExplainForm, forms.TurnTold, Desk.explain),
    _Skin("history", "GET", "List what was said and done", "The latest turns with what was decided and who applied "
          "it.", forms.HistoryForm, forms.HistoryTold, Desk.history),
)  # fmt: skip
"""All operations; most platforms let a model choose among a dozen and no more."""


def add_plugin(app: FastAPI) -> None:
    """Have an application serve the plug-in and its document."""

    async def described(request: Request) -> Response:
        del request
        return JSONResponse(document(app.state.doors.public_url))

    app.router.routes.append(Route("/plugin/openapi.json", described, methods=["GET"]))
    app.router.routes.extend(Route(_path(skin), _endpoint(skin), methods=[skin.method]) for skin in _SKINS)


def _path(skin: _Skin) -> str:
    return f"/plugin/{skin.name.replace('_', '-')}"


def _endpoint(skin: _Skin) -> Callable[[Request], Awaitable[Response]]:
    async def endpoint(request: Request) -> Response:
        try:
            return JSONResponse(await _done(skin, request))
        except Exception as error:  # noqa: BLE001  # whatever it is, a platform's model has to be told
            problem = problem_in(error)
            body = in_plugin(problem)
            return JSONResponse(
                body or problem.body, status_code=200 if body else problem.status, headers=problem.headers
            )

    return endpoint


async def _done(skin: _Skin, request: Request) -> Json:
    given = dict(request.query_params) if skin.method == "GET" else strict_json(await request.body() or b"{}")
    if not isinstance(given, dict):
        raise UnusableError("the body is an object")
    with telling_what_is_wrong(skin.name):
        form = skin.form(**given)
    service, caller = service_of(request), caller_of(request)

    async def work(tell: Tell) -> Json:
        return await skin.run(Desk(service=service, caller=caller, tell=tell), form)

    found = await finished(request, service.job(caller, work))
    return skin.answer(ok=True, **found).model_dump(mode="json", exclude_none=True)


def document(public_url: str) -> Json:
    """The document, for a server at an address."""
    return {
        "openapi": "3.0.3",
        "info": {
            "title": "WirelessAgent",
            "version": installed_version(),
            "description": "Plan downlink OFDMA cells: collect and repair channel state, decide who gets which "
            "subcarrier at what power with a certificate, and apply it to a base station after a yes.",
        },
        "servers": [{"url": public_url}],
        "security": [{"token": []}],
        "paths": {_path(skin): {skin.method.lower(): _described(skin)} for skin in _SKINS},
        "components": {
            "securitySchemes": {
                "token": {
                    "type": "http", "scheme": "bearer",
                    "description": "a token made with `wirelessagent token NAME --role operator`",
                }
            }
        },
    }  # fmt: skip


def _described(skin: _Skin) -> Json:
    form = _schema(skin.form)
    required = form.get("required", [])
    said: Json = {"operationId": skin.name, "summary": skin.summary, "description": skin.description}
    if skin.method == "GET":
        said["parameters"] = [
            {"name": name, "in": "query", "required": name in required,
             "description": schema.pop("description"), "schema": schema}
            for name, schema in form["properties"].items()
        ]  # fmt: skip
    else:
        said["requestBody"] = {"required": True, "content": {"application/json": {"schema": form}}}
    answer = {"description": "What came of it", "content": {"application/json": {"schema": _schema(skin.answer)}}}
    return {**said, "responses": {"200": answer}}


def _schema(model: type[BaseModel]) -> Json:
    found = inlined(asked(model.model_json_schema()))
    found.pop("description", None)
    found.setdefault("properties", {})
    return found

"""The tools of a cell: its conversation, the plan that waits, its allocation, and observations.

A line never applies anything. What it leads to waits under a one-time id, which is good for that plan, while nothing
else was applied at the cell, for a while; `apply` takes it.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

from mcp.types import ImageContent, InputRequiredResult, Tool, ToolAnnotations
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from wirelessagent.interfaces.http.forms import CellAnswer, ObservationAnswer, PlanAnswer, TurnAnswer
from wirelessagent.interfaces.mcp.calls import Call
from wirelessagent.interfaces.mcp.tool import Json, Result, ServerTool, annotated, answer, failure
from wirelessagent.interfaces.schemas import Schema, answered, asked
from wirelessagent.operations.paragraphs import plain_text
from wirelessagent.service.assistant import told
from wirelessagent.service.problems import ProblemError, UnusableError

APP = "ui://wirelessagent/allocation.html"
"""The page that shows an allocation inside a client."""

_MOST_QUESTIONS = 3
"""How often a client's user is asked within one call, as people lose patience."""


class Form(BaseModel):
    model_config = ConfigDict(extra="forbid")


class NoForm(Form):
    """Nothing to say."""


class CellForm(Form):
    cell: str | None = Field(None, max_length=64, description="id of the cell; may be left out where there is only one")


class SayForm(CellForm):
    text: str = Field(
        min_length=1, max_length=4000,
        description="what the operator wants or asks, in their own words: English, Chinese, Spanish, French or German",
    )  # fmt: skip


class PlanForm(Form):
    plan: str = Field(min_length=1, max_length=64, description="one-time id of the plan, as a proposal gave it")


class ShowForm(CellForm):
    picture: bool = Field(False, description="whether a picture is wanted, too")


class ObservationForm(Form):
    observation: str = Field(min_length=1, max_length=64, description="id of the observation")


class MoveForm(CellForm, ObservationForm):
    """A cell and an observation."""


class ProposalAnswer(BaseModel):
    """A turn, and the plan that waits after it."""

    cell: str
    turn: TurnAnswer
    plan: PlanAnswer | None


class CellsAnswer(BaseModel):
    cells: list[CellAnswer]


class AllocationAnswer(BaseModel):
    cell: str
    in_effect: bool = Field(description="whether this allocation is what the base station does")
    turn: TurnAnswer


class DerivedAnswer(BaseModel):
    """An observation that was made, and what it was made by."""

    model_config = ConfigDict(extra="allow")

    observation: ObservationAnswer


FormT = TypeVar("FormT", bound=Form)


def cell_tools(forms: Json) -> list[ServerTool]:
    """The tools; some take what the forms of operations say."""
    by_name = {form["name"]: form for form in forms["operations"]}
    proposal = answered(ProposalAnswer.model_json_schema())
    return [
        _tool("cells", "The cells of this server", "List the cells with their users, limits and base stations.",
              NoForm, answered(CellsAnswer.model_json_schema()), _cells, annotated("List cells", only_reads=True)),
        _tool("say", "Say a line in a cell's conversation",
              "Pass on what the operator wants or asks about a cell, word for word. The answer says what was decided, "
              "how sure it is, and what would change. It NEVER applies anything: where a plan comes of it, `plan.id` "
              "is the one-time id for `apply`, to be used only after the operator has seen the changes and said yes.",
              SayForm, proposal, _say, annotated("Propose or ask")),
        _tool("apply", "Apply the plan that waits",
              "Have the base station do what a proposal planned, and read back what happened. Call it only after the "
              "operator has said yes to exactly this plan. The id works once, while nothing else was applied, and "
              "for a limited time; otherwise ask for the plan again with `say`.",
              PlanForm, proposal, _pressed("yes"), annotated("Apply", destroys=True)),
        _tool("discard", "Drop the plan that waits", "Drop a plan that the operator does not want; what is in effect "
              "goes on.", PlanForm, proposal, _pressed("no"), annotated("Discard")),
        _tool("undo", "Take back the last change", "Take back the last change of a cell's request. Where that brings "
              "another allocation, it waits as a plan of its own until `apply`.", CellForm, proposal, _undo,
              annotated("Undo")),
        _tool("show_allocation", "Show a cell's allocation", "Show who has which subcarrier at what power and rate, "
              "with the certificate: what is in effect, else what was decided last.", ShowForm,
              answered(AllocationAnswer.model_json_schema()), _show, annotated("Show allocation", only_reads=True),
              meta={"ui": {"resourceUri": APP}}),
        _derived("observe", by_name["simulate"], "Observe a channel",
                 "Sense a simulated channel and keep it as an observation, to be named by its id in repair, solve and "
                 "compare. To look at one that is there already, use `read_observation`."),
        _derived("repair_observation", by_name["repair"], "Repair an observation",
                 "Fill the holes of an observation and keep the result, with how sure each filled gain is, as a new "
                 "observation."),
        _tool("move_cell", "Have a cell work on another observation", "Have a cell work on an observation from now on. "
              "A new conversation begins with it: a plan that waits is dropped; what the base station does goes on.",
              MoveForm, answered(CellAnswer.model_json_schema()), _move, annotated("Move cell", destroys=True)),
        _tool("read_observation", "Look at an observation", "What an observation holds: users, subcarriers, gains "
              "(linear power gains, null = missing).", ObservationForm,
              answered(ObservationAnswer.model_json_schema()), _read_observation,
              annotated("Read observation", only_reads=True)),
    ]  # fmt: skip


def _tool(
    name: str, title: str, description: str, form: type[FormT], output: Schema,
    run: Callable[[Call, FormT], Awaitable[Result]], annotations: ToolAnnotations, meta: Json | None = None,
) -> ServerTool:  # fmt: skip
    async def checked(call: Call, arguments: Json) -> Result:
        try:
            given = form(**arguments)
        except ValidationError as error:
            first = error.errors()[0]
            raise UnusableError(f"{'.'.join(map(str, first['loc'])) or name}: {first['msg']}") from error
        return await run(call, given)

    schema = asked(form.model_json_schema())
    schema.pop("description", None)
    shown = Tool(
        name=name, title=title, description=description, input_schema=schema, output_schema=output,
        annotations=annotations, _meta=meta,
    )  # fmt: skip
    return ServerTool(shown=shown, run=checked)


def _derived(name: str, form: Json, title: str, description: str) -> ServerTool:
    """A tool whose gains are kept under an id."""
    operation: str = form["name"]
    schema = asked(form["schema"])
    if form["channel"] == "needed":
        named = asked(ObservationForm.model_json_schema())
        schema["properties"] = {**named["properties"], **schema["properties"]}
        schema["required"] = [*schema.get("required", ()), "observation"]

    async def run(call: Call, arguments: Json) -> Result:
        done = await call.work(lambda tell: call.service.observations.derive(operation, arguments, tell))
        seen = done["observation"]
        text = f"Kept as observation {seen['id']}.\n\n{plain_text(done['blocks'])}"
        return answer(text, {"observation": seen})

    shown = Tool(
        name=name, title=title, description=description, input_schema=schema,
        output_schema=answered(DerivedAnswer.model_json_schema()), annotations=annotated(title),
    )  # fmt: skip
    return ServerTool(shown=shown, run=run)


async def _cells(call: Call, form: NoForm) -> Result:
    del form
    found = await call.service.cells()
    lines = "\n".join(map(_described, found))
    return answer(lines or "There is no cell yet: make one in the console.", {"cells": found})


def _described(cell: Json) -> str:
    return (
        f"{cell['id']}: {cell['name']!r}, {len(cell['user_names'])} users, {cell['num_subcarriers']} subcarriers, at "
        f"most {cell['max_power_w']:g} W, base station {cell['base_station'] or 'none'}"
    )


async def _say(call: Call, form: SayForm) -> Result:
    text = form.text
    if call.state is not None:
        if call.answer is None:
            return await _earlier(call, form.cell)
        text = call.answer
    done = await _said(call, form.cell, text)
    for _ in range(_MOST_QUESTIONS):
        turn = done["turn"]
        if turn["stage"] != "asked" or not call.may_ask:
            break
        answered_by = await call.ask(turn["reply"], str(turn["number"]))
        if isinstance(answered_by, InputRequiredResult):
            return answered_by
        if answered_by is None:
            break
        done = await _said(call, form.cell, answered_by)
    return answer(told(done), done)


async def _said(call: Call, cell: str | None, text: str) -> Json:
    return await call.work(lambda tell: call.assistant.say(cell, text, call.caller, tell))


async def _earlier(call: Call, cell: str | None) -> Result:
    """The turn with a question that nobody answered."""
    state = call.state or ""
    if not state.isdecimal() or len(state) > 9:
        raise UnusableError("requestState: this is not what the question came with")
    session = (await call.assistant.cell(cell))["session"]
    done = await call.assistant.turn(session, int(state))
    return answer(told(done), done)


def _pressed(what: Any) -> Callable[[Call, PlanForm], Awaitable[Result]]:
    async def run(call: Call, form: PlanForm) -> Result:
        done = await call.work(lambda tell: call.assistant.decide(what, form.plan, call.caller, tell))
        return answer(told(done), done)

    return run


async def _undo(call: Call, form: CellForm) -> Result:
    done = await call.work(lambda tell: call.assistant.undo(form.cell, call.caller, tell))
    return answer(told(done), done)


async def _move(call: Call, form: MoveForm) -> Result:
    moved = await call.work(lambda tell: call.assistant.move(form.cell, form.observation, tell))
    return answer(f"From now on, as a new conversation: {_described(moved)}.", moved)


async def _show(call: Call, form: ShowForm) -> Result:
    found = await call.assistant.last_decided(form.cell)
    turn = found["turn"]
    if turn is None:
        return failure("Nothing was decided for this cell yet: say what it should do first.")
    state = "In effect" if found["in_effect"] else "Decided, but not in effect"
    text = plain_text([f"{state}: {turn['lines']['decided']}", *turn["tables"]])
    pictures: list[ImageContent] = []
    if form.picture and turn["stored"] is not None:
        try:
            drawn = await call.service.allocation(turn["stored"], "png")
        except ProblemError as problem:
            text += f"\n\nNo picture: {problem.detail}"
        else:
            pictures.append(ImageContent(type="image", data=drawn["content"], mime_type=drawn["media_type"]))
    elif form.picture:
        text += "\n\nNo picture: this turn comes from a recording."
    return answer(text, found, *pictures)


async def _read_observation(call: Call, form: ObservationForm) -> Result:
    found = await call.service.observations.one(form.observation)
    facts = "; ".join(f"{label}: {text}" for label, text in found["facts"].items())
    text = (
        f"{found['name']}: {found['num_users']} users on {found['num_subcarriers']} subcarriers, {found['missing']} "
        f"gains missing. {facts}"
    )
    return answer(text, found)

"""A tool for each operation of the catalogue: its form is the input, its record the output."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mcp.types import Tool

from wirelessagent.interfaces.mcp.calls import Call
from wirelessagent.interfaces.mcp.tool import Json, Result, ServerTool, annotated, answer
from wirelessagent.interfaces.schemas import Schema, answered, asked
from wirelessagent.operations.paragraphs import plain_text

_OBSERVATION: Schema = {
    "type": "string",
    "description": "id of the observation to work on, as `observe` and `repair_observation` give it",
}


def operation_tools(forms: Mapping[str, Any]) -> list[ServerTool]:
    """The tools of the forms that a service has."""
    return [_tool(form) for form in forms["operations"]]


def _tool(form: Mapping[str, Any]) -> ServerTool:
    name: str = form["name"]

    async def run(call: Call, arguments: Json) -> Result:
        done = await call.work(lambda tell: call.service.operate(name, arguments, tell))
        return answer(plain_text(done["blocks"]), done)

    return ServerTool(
        shown=Tool(
            name=name.replace(" ", "_").replace("-", "_"),
            title=name.capitalize().replace("-", " "),
            description=_description(form),
            input_schema=_with_observation(asked(form["schema"]), form["channel"]),
            output_schema=_output(form["record"]),
            annotations=annotated(form["summary"], only_reads=not form["recorded"]),
        ),
        run=run,
    )


def _description(form: Mapping[str, Any]) -> str:
    said = f"{form['summary']}."
    if form["channel"] == "needed":
        said += " Works on an observation, which is named and never retyped."
    if form["recorded"]:
        said += " Works on a channel of its own and is recorded in the history; no cell is touched."
    return said


def _with_observation(schema: Schema, channel: str) -> Schema:
    if channel == "no":
        return schema
    required = [*schema.get("required", ()), *(["observation"] if channel == "needed" else ())]
    found = {**schema, "properties": {"observation": _OBSERVATION, **schema.get("properties", {})}}
    return {**found, "required": required} if required else found


def _output(record: Mapping[str, Any]) -> Schema:
    schema = answered(record)
    defined = schema.pop("$defs", None)
    found: Schema = {
        "type": "object",
        "properties": {
            "record": schema,
            "blocks": {"type": "array", "description": "the same for people: paragraphs, lines, tables"},
            "conclusion": {"type": "string", "enum": ["done", "failed", "unclear", "unmet"]},
        },
        "required": ["record", "blocks", "conclusion"],
    }
    return {**found, "$defs": defined} if defined else found

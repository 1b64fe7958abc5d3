"""The operations as tools for an LLM: typed forms that follow from the requests, and nothing that changes anything.

Offered are the operations that only work something out. What a form leaves out, an LLM cannot reach: fields and
options that hold paths, so that it neither writes a file nor chooses one to read. The channel is the one that the
caller hands over. Applying an allocation is no tool: the operator confirms it, in plain words.
"""

from __future__ import annotations

import math
import types
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, cast, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model
from pydantic.fields import FieldInfo

from wirelessagent.language.llm_tool import LlmTool
from wirelessagent.operations.compare import COMPARE
from wirelessagent.operations.fields import OptionsOf, PluginName, described, mark_of, plugin_options
from wirelessagent.operations.list_plugins import PLUGINS
from wirelessagent.operations.operation import AnyOperation, InputError, silent
from wirelessagent.operations.record import Block, Files, Table
from wirelessagent.operations.repair import REPAIR
from wirelessagent.operations.simulate import SIMULATE
from wirelessagent.operations.solve import SOLVE
from wirelessagent.plugins import Option, plugins

OFFERED: tuple[AnyOperation, ...] = (SIMULATE, REPAIR, SOLVE, COMPARE, PLUGINS)
"""What an LLM may call. Only operations that change nothing once their paths are taken away belong here."""

_CHANNEL = "path"  # the field of a request that names the channel's file
_MOST_CHARACTERS = 20_000
_MOST_GAINS = 1_000_000


def llm_tools(channel: Path | str | None = None, operations: Sequence[AnyOperation] = OFFERED) -> tuple[LlmTool, ...]:
    """The tools for a channel in a file; those that need one are left out where there is none."""
    return tuple(
        tool_of(operation, channel)
        for operation in operations
        if channel is not None or _CHANNEL not in operation.request.model_fields
    )


def tool_of(operation: AnyOperation, channel: Path | str | None = None) -> LlmTool:
    """One operation as a tool."""

    def run(form: BaseModel) -> str:
        values = form.model_dump(exclude_unset=True, exclude_none=True)
        _check_size(values)
        if _CHANNEL in operation.request.model_fields:
            values[_CHANNEL] = channel
        try:
            request = operation.request(**values)
        except ValidationError as error:
            first = error.errors()[0]
            place = ".".join(map(str, first["loc"])) or operation.name
            raise InputError(f"{place}: {first['msg'].removeprefix('Value error, ')}") from error
        return as_text(operation.run(request, silent).blocks())

    name = operation.name.replace(" ", "_").replace("-", "_")
    return LlmTool(name=name, summary=operation.summary, form=form_of(operation), run=run)


def _check_size(values: Mapping[str, Any]) -> None:
    """Refuse options that together ask for more than a conversation needs: an LLM must not fill the memory."""
    for name, given in values.items():
        options = cast("dict[str, Any]", given) if isinstance(given, dict) else {}
        if math.prod(value for value in options.values() if isinstance(value, int) and value > 1) > _MOST_GAINS:
            raise InputError(f"{name}: too large for a tool; got {options!r}")


def form_of(operation: AnyOperation) -> type[BaseModel]:
    """The request without its paths, plug-ins as choices and their options spelt out."""
    fields: dict[str, Any] = {}
    for name, info in operation.request.model_fields.items():
        kind = _kind(info)
        if kind is not None:
            fields[name] = (kind, _described(info))
    make = cast("Any", create_model)
    name = f"{operation.name.title().replace(' ', '')}Form"
    return cast("type[BaseModel]", make(name, __config__=ConfigDict(extra="forbid"), **fields))


def as_text(blocks: Sequence[Block]) -> str:
    """Paragraphs and tables as plain text, cut where it would be too long."""
    text = "\n\n".join(_paragraph(block) for block in blocks)
    return text if len(text) <= _MOST_CHARACTERS else f"{text[:_MOST_CHARACTERS]}\n… (cut)"


def _paragraph(block: Block) -> str:
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Files):
        return " ".join([block.done, *map(str, block.paths)])
    return block if isinstance(block, str) else "\n".join(block)


def _table(table: Table) -> str:
    return "\n".join([table.title, *(" | ".join(row) for row in (table.columns, *table.rows))])


def _kind(info: FieldInfo) -> Any:
    """The type of a form's field; None for one that is left out."""
    for mark in info.metadata:
        if isinstance(mark, OptionsOf):
            return _options_form(mark)
        if isinstance(mark, PluginName):
            return _choice(mark) | None if type(None) in get_args(info.annotation) else _choice(mark)
    if _holds_path(info.annotation):
        return None
    return Annotated[(info.annotation, *info.metadata)] if info.metadata else info.annotation


def _described(info: FieldInfo) -> Any:
    said = described(info) if mark_of(info, PluginName) is None else info.description  # a form has them as choices
    if info.is_required():
        return Field(description=said)
    if info.default_factory is not None:
        return Field(default_factory=dict, description=said)
    return Field(info.default, description=said)


def _holds_path(annotation: Any) -> bool:
    return annotation is Path or any(_holds_path(part) for part in get_args(annotation))


def _choice(mark: PluginName) -> Any:
    """The names of the plug-ins of a kind that load and need no path."""
    names = [
        found.name
        for found in plugins(mark.kind)
        if found.cls is not None and not any(option.required and option.type is Path for option in found.options)
    ]
    return cast("Any", Literal)[tuple(names)]


def _options_form(mark: OptionsOf) -> type[BaseModel] | None:
    """A form of the options of all plug-ins of a kind, but those that hold paths."""
    fields: dict[str, Any] = {}
    for name, owners in _by_name(mark):
        kinds = [_option_kind(option) for _, option in owners]
        kind = kinds[0]
        for other in kinds[1:]:
            kind = kind | other
        said = "; ".join(dict.fromkeys(f"{option.help or name} (of {owner})" for owner, option in owners))
        fields[name] = (kind | None, Field(None, description=said))
    make = cast("Any", create_model)
    title = f"{mark.only or mark.kind}_options".title().replace("_", "")
    form = cast("type[BaseModel]", make(title, __config__=ConfigDict(extra="forbid"), **fields))
    return form if fields else None


def _by_name(mark: OptionsOf) -> Iterator[tuple[str, list[tuple[str, Option]]]]:
    found: dict[str, list[tuple[str, Option]]] = {}
    for owner, option in plugin_options(mark):
        found.setdefault(option.name, []).append((owner, option))
    for name, owners in found.items():
        if all(option.type is not Path for _, option in owners):
            yield name, owners


def _option_kind(option: Option) -> Any:
    kind: Any = cast("Any", Literal)[option.choices] if option.choices else option.type
    return kind | types.GenericAlias(list, (kind,)) if option.several else kind

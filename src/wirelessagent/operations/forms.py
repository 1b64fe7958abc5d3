"""Requests as forms for callers who do not sit at the machine: an LLM, a browser, another program.

A form is a request without what is only for whoever sits there: fields and options that hold paths, and those marked
:class:`~wirelessagent.operations.fields.Local`. What a form leaves out cannot be reached, so no caller chooses a file
to read or to write. The channel's file is the one that the caller was given.
"""

from __future__ import annotations

import contextlib
import math
import types
from collections.abc import Generator, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, cast, get_args

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model
from pydantic.fields import FieldInfo

from wirelessagent.operations.fields import Local, OptionsOf, PluginName, described, mark_of, plugin_options
from wirelessagent.operations.operation import AnyOperation, InputError, Request
from wirelessagent.plugins import Option, plugins

CHANNELS = ("path", "csi")
"""The fields of requests that name the channel's file."""

_MOST_GAINS = 1_000_000


def needs_channel(operation: AnyOperation) -> bool:
    """Whether the operation cannot be done without a channel in a file."""
    return any(
        name in operation.request.model_fields and operation.request.model_fields[name].is_required()
        for name in CHANNELS
    )


def takes_channel(operation: AnyOperation) -> bool:
    """Whether the operation can work on a channel in a file."""
    return any(name in operation.request.model_fields for name in CHANNELS)


def can_be_filled(operation: AnyOperation) -> bool:
    """Whether a form holds all that the operation cannot do without, beside a channel."""
    form = form_of(operation).model_fields
    return all(
        name in form or name in CHANNELS for name, info in operation.request.model_fields.items() if info.is_required()
    )


def filled(operation: AnyOperation, form: BaseModel, channel: Path | str | None = None) -> Request:
    """The request of a form that somebody filled in, on the channel in a file.

    Raises:
        InputError: it cannot be used.
    """
    values = form.model_dump(exclude_unset=True, exclude_none=True)
    _check_size(values)
    if channel is not None:
        values |= {name: channel for name in CHANNELS if name in operation.request.model_fields}
    with telling_what_is_wrong(operation.name):
        return operation.request(**values)


@contextlib.contextmanager
def telling_what_is_wrong(about: str) -> Generator[None]:
    """Have the first thing that is wrong with a request told in one sentence, the value named."""
    try:
        yield
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"])) or about
        raise InputError(f"{place}: {first['msg'].removeprefix('Value error, ')}") from error


def _check_size(values: Mapping[str, Any]) -> None:
    """Refuse options that together ask for more than a conversation needs: nobody far away must fill the memory."""
    for name, given in values.items():
        options = cast("dict[str, Any]", given) if isinstance(given, dict) else {}
        if math.prod(value for value in options.values() if isinstance(value, int) and value > 1) > _MOST_GAINS:
            raise InputError(f"{name}: too large; got {options!r}")


def form_of(operation: AnyOperation) -> type[BaseModel]:
    """The request without its paths and what is local, plug-ins as choices and their options spelt out."""
    fields: dict[str, Any] = {}
    for name, info in operation.request.model_fields.items():
        kind = _kind(info)
        if kind is not None:
            fields[name] = (kind, _described(info))
    make = cast("Any", create_model)
    name = f"{operation.name.title().replace(' ', '')}Form"
    return cast("type[BaseModel]", make(name, __config__=ConfigDict(extra="forbid"), **fields))


def _kind(info: FieldInfo) -> Any:
    """The type of a form's field; None for one that is left out."""
    for mark in info.metadata:
        if isinstance(mark, Local):
            return None
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
    """The names of the plug-ins of a kind that load and need no path; base stations may not even take one."""
    names = [
        found.name
        for found in plugins(mark.kind)
        if found.cls is not None
        and not any(
            option.type is Path and (option.required or mark.kind == "base_station") for option in found.options
        )
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

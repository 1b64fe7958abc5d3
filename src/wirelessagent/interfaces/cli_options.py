"""Request fields as parameters of a command: arguments, options, and the options of every plug-in."""

from __future__ import annotations

import inspect
import types
import typing
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

import typer
from pydantic.fields import FieldInfo

from wirelessagent.operations.fields import Option, OptionsOf, PluginName, Positional, plugin_names, plugin_options
from wirelessagent.operations.operation import Request

_SIMPLE = (str, int, float, bool, Path)


def as_flag(name: str) -> str:
    """The option that sets a field.

    >>> as_flag("min_rate_bps")
    '--min-rate-bps'
    """
    return "--" + name.replace("_", "-")


def is_positional(request: type[Request], field: str) -> bool:
    """Whether a field is given by place."""
    info = request.model_fields.get(field)
    return info is not None and _mark(info, Positional) is not None


class Parameters:
    """The parameters of the command for a request, and how their values become the request's fields."""

    def __init__(self, request: type[Request]) -> None:
        self._fields = request.model_fields
        self._parameters: list[inspect.Parameter] = []
        self._plugin_fields: dict[str, list[tuple[str, str]]] = {}
        for name, info in self._fields.items():
            if _mark(info, OptionsOf) is None:
                self._add(name, *_field_parameter(name, info, _panel(request, name)))
        for name, info in self._fields.items():
            mark = _mark(info, OptionsOf)
            if mark is not None:
                self._add_plugin_options(name, mark)
        self._add("json", Annotated[bool, typer.Option("--json", help="Print the record as JSON.")], False)

    def _add(self, name: str, annotation: Any, default: Any = None) -> None:
        self._parameters.append(
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=annotation, default=default)
        )

    def _add_plugin_options(self, field: str, mark: OptionsOf) -> None:
        """One option per name that plug-ins of this kind have; with the kind in front where the name is taken."""
        by_name: dict[str, list[tuple[str, Option]]] = {}
        for plugin, option in plugin_options(mark):
            by_name.setdefault(option.name, []).append((plugin, option))
        taken = {parameter.name for parameter in self._parameters}
        for option_name, owners in by_name.items():
            name = f"{mark.kind}_{option_name}" if option_name in taken else option_name
            self._plugin_fields.setdefault(field, []).append((name, option_name))
            self._add(name, _plugin_parameter(name, owners, f"Options of {mark.kind.replace('_', ' ')}s"))

    def signature(self) -> inspect.Signature:
        return inspect.Signature(self._parameters)

    def annotations(self) -> dict[str, Any]:
        return {parameter.name: parameter.annotation for parameter in self._parameters}

    @staticmethod
    def empty() -> inspect.Signature:
        return inspect.Signature([])

    def values(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The request's field values from the command's; what was not given is left to the request's defaults."""
        found = {name: given[name] for name in self._fields if given.get(name) not in (None, [])}
        for field, names in self._plugin_fields.items():
            options = {option: given[name] for name, option in names if given[name] is not None}
            if options:
                found[field] = options
        return found


def _mark(info: FieldInfo, mark: type[Any]) -> Any:
    return next((item for item in info.metadata if isinstance(item, mark)), None)


def _panel(request: type[Request], name: str) -> str:
    """The panel of the class that declares a field."""
    owner = next(cls for cls in request.__mro__ if name in inspect.get_annotations(cls))
    return getattr(owner, "panel", "Options")


def _field_parameter(name: str, info: FieldInfo, panel: str) -> tuple[Any, Any]:
    """A field's annotation for Typer, and its default there: None for "not given"."""
    plugin = _mark(info, PluginName)
    text = info.description or ""
    if plugin is not None:
        text += f": {', '.join(plugin_names(plugin.kind))}"
    kind = _parameter_type(info.annotation)
    if _mark(info, Positional) is not None:
        required = info.is_required()
        return Annotated[kind if required else kind | None, typer.Argument(help=text)], ... if required else None
    default = info.default if not info.is_required() and info.default_factory is None else None
    shown = str(default) if default is not None else False
    kind, metavar = _as_text(kind)
    option = typer.Option(as_flag(name), help=text, show_default=shown, rich_help_panel=panel, metavar=metavar)
    return Annotated[kind | None, option], None


def _plugin_parameter(name: str, owners: list[tuple[str, Option]], panel: str) -> Any:
    """An option that one or several plug-ins share."""
    from rich.markup import escape

    kinds = {option.type for _, option in owners}
    kind, metavar = _as_text(kinds.pop() if len(kinds) == 1 else str)
    if all(option.choices for _, option in owners):  # the plug-in reads them, whatever their capitals
        choices = dict.fromkeys(str(choice) for _, option in owners for choice in option.choices)
        kind, metavar = str, f"<{'|'.join(choices)}>"
    if any(option.several for _, option in owners):
        kind, metavar = str, f"{metavar}[,{metavar}…]"
    flags = [f"{as_flag(name)}/--no-{name.replace('_', '-')}"] if kind is bool else [as_flag(name)]
    option = typer.Option(
        *flags, help=escape(_plugin_help(owners)), show_default=False, rich_help_panel=panel, metavar=metavar
    )
    return Annotated[kind | None, option]


def _plugin_help(owners: list[tuple[str, Option]]) -> str:
    """What an option is, whose it is and its default; once for all plug-ins of which the same can be said."""
    said: dict[str, dict[str, list[str]]] = {}
    for plugin, option in owners:
        default = "needed" if option.required else "" if option.default is None else f"default {option.default}"
        said.setdefault(option.help, {}).setdefault(default, []).append(plugin)
    parts: list[str] = []
    for text, defaults in said.items():
        of = "; ".join(f"of {'; '.join([', '.join(names), *filter(None, [how])])}" for how, names in defaults.items())
        parts.append(f"{text} [{of}]".lstrip())
    return "; ".join(parts)


def _as_text(kind: Any) -> tuple[Any, str | None]:
    """Numbers are taken as text, so that the request's own check names the value; and how the help shows them."""
    return (str, kind.__name__.upper()) if kind in (int, float) else (kind, None)


def _parameter_type(annotation: Any) -> Any:
    """The type that Typer reads a field as; text for whatever the request parses itself."""
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is typing.Union:
        kinds = [_parameter_type(part) for part in get_args(annotation) if part is not type(None)]
        return kinds[0] if len(kinds) == 1 else str
    if get_origin(annotation) is list:
        return list[_parameter_type(get_args(annotation)[0])]  # type: ignore[misc]
    if get_origin(annotation) is Literal or annotation in _SIMPLE:
        return annotation
    return str

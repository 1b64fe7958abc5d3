"""Request fields as parameters of a command: arguments, options, and the options of every plug-in."""

from __future__ import annotations

import inspect
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, cast, get_args, get_origin

import click
from click.shell_completion import CompletionItem
from pydantic.fields import FieldInfo

from wirelessagent.operations.fields import (
    Advanced,
    Option,
    OptionsOf,
    PluginName,
    Positional,
    mark_of,
    plugin_names,
    plugin_options,
)
from wirelessagent.operations.operation import Request


def as_flag(name: str) -> str:
    """The option that sets a field.

    >>> as_flag("min_rate_bps")
    '--min-rate-bps'
    """
    return "--" + name.replace("_", "-")


def is_positional(request: type[Request], field: str) -> bool:
    """Whether a field is given by place."""
    info = request.model_fields.get(field)
    return info is not None and mark_of(info, Positional) is not None


class _Text(click.ParamType[str]):
    """Text as it was given, since the request checks it; known are values that a shell may complete."""

    name = "text"

    def __init__(self, known: Callable[[], Iterable[str]] = tuple) -> None:
        self._known = known

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        del ctx, param
        return [CompletionItem(value) for value in self._known() if value.startswith(incomplete)]


class FieldArgument(click.Argument):
    """A field that is given by place."""

    def __init__(self, name: str, info: FieldInfo) -> None:
        kind = _core(info.annotation)
        several = get_origin(kind) is list
        super().__init__(
            [name], required=info.is_required(), nargs=-1 if several else 1, type=_value_type(kind, info),
            metavar=f"{name.upper()}{' …' if several else ''}",
        )  # fmt: skip
        self.info = info


class FieldOption(click.Option):
    """A field that is given by name.

    Attributes:
        panel: the heading that it stands under where all are shown.
        advanced: whether only those who ask for everything are shown it.
        default_shown: its default; "" for none.
    """

    def __init__(self, name: str, info: FieldInfo, panel: str) -> None:
        kind = _core(info.annotation)
        how: dict[str, Any] = {"is_flag": True}
        if kind is not bool:
            how = {
                "type": _value_type(kind, info),
                "metavar": _metavar(kind, info),
                "multiple": get_origin(kind) is list,
            }
        super().__init__([as_flag(name), name], default=None, help=info.description, **how)
        self.info, self.panel, self.advanced = info, panel, mark_of(info, Advanced) is not None
        default = None if info.is_required() or info.default_factory is not None else info.default
        self.default_shown = "" if default in (None, False) else str(default)


class PluginOption(click.Option):
    """An option that one or several plug-ins share; ``field`` and ``key`` say where its value goes in the request."""

    def __init__(self, name: str, mark: OptionsOf, field: str, owners: list[tuple[str, Option]]) -> None:
        options = [option for _, option in owners]
        switch = {option.type for option in options} == {bool}
        flags = f"{as_flag(name)}/--no-{name.replace('_', '-')}" if switch else as_flag(name)
        how: dict[str, Any] = {} if switch else {"type": _plugin_type(options), "metavar": _plugin_metavar(options)}
        super().__init__([flags, name], default=None, help=_plugin_help(owners), **how)
        self.field, self.key = field, options[0].name
        self.panel = f"Options of {mark.kind.replace('_', ' ')}s"


class Parameters:
    """The parameters of the command for a request, and how their values become the request's fields.

    Those of plug-ins are added when they are wanted, since every plug-in is loaded for them.
    """

    def __init__(self, request: type[Request]) -> None:
        self._fields = request.model_fields
        self._plugins: list[PluginOption] | None = None
        self._own: list[click.Parameter] = []
        for owner, name in _nearest_first(request):
            info = self._fields[name]
            if mark_of(info, Positional) is not None:
                self._own.append(FieldArgument(name, info))
            elif mark_of(info, OptionsOf) is None:
                self._own.append(FieldOption(name, info, getattr(owner, "panel", "Options")))
        self._own.append(click.Option(["--json", "json"], is_flag=True, help="print the record as JSON"))

    def found(self) -> list[click.Parameter]:
        """Those of the request itself, and those of the plug-ins once these were looked for."""
        return [*self._own, *(self._plugins or ())]

    def find_plugins(self) -> None:
        """One option per name that plug-ins of a kind have; with the kind in front where the name is taken."""
        if self._plugins is not None:
            return
        self._plugins, taken = [], {parameter.name for parameter in self._own}
        for field, info in self._fields.items():
            mark = mark_of(info, OptionsOf)
            by_name: dict[str, list[tuple[str, Option]]] = {}
            for plugin, option in plugin_options(mark) if mark else ():
                by_name.setdefault(option.name, []).append((plugin, option))
            for key, owners in by_name.items():
                assert mark is not None
                name = f"{mark.kind}_{key}" if key in taken else key
                taken.add(name)
                self._plugins.append(PluginOption(name, mark, field, owners))

    def values(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The request's field values from the command's; what was not given is left to the request's defaults."""
        found = {name: given[name] for name in self._fields if given.get(name) not in (None, ())}
        for option in self._plugins or ():
            value = given.get(option.name or "")
            if value is not None:
                found.setdefault(option.field, {})[option.key] = value
        return {name: [*cast("Any", value)] if isinstance(value, tuple) else value for name, value in found.items()}


def _nearest_first(request: type[Request]) -> Iterator[tuple[type[Any], str]]:
    """The fields with the classes that declare them: those of the request itself before those of its bases."""
    seen: set[str] = set()
    for cls in request.__mro__:
        for name in inspect.get_annotations(cls):
            if name in request.model_fields and name not in seen:
                seen.add(name)
                yield cls, name


def _core(annotation: Any) -> Any:
    """An annotation without None and marks; several types together are text, which the request reads itself."""
    if annotation == _PER_ENTRY:
        return annotation
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    if isinstance(annotation, types.UnionType) or get_origin(annotation) is typing.Union:
        kinds = [_core(part) for part in get_args(annotation) if part is not type(None)]
        return kinds[0] if len(kinds) == 1 else str
    return annotation


def _value_type(kind: Any, info: FieldInfo) -> click.ParamType[Any]:
    """How a value is taken: as text, which the request's own check reads and names, and how a shell completes it."""
    plugin = mark_of(info, PluginName)
    if plugin is not None:
        return _Text(lambda: plugin_names(plugin.kind))
    if get_origin(kind) is Literal:
        return _Text(lambda: [str(choice) for choice in get_args(kind)])
    return click.Path() if kind is Path or kind == list[Path] else _Text()


_PER_ENTRY = float | list[float]
_METAVARS: dict[Any, str] = {int: "NUMBER", float: "NUMBER", Path: "PATH", _PER_ENTRY: "NUMBER[,NUMBER…]"}


def _metavar(kind: Any, info: FieldInfo) -> str:
    if get_origin(kind) is Literal:
        return f"<{'|'.join(map(str, get_args(kind)))}>"
    return "NAME" if mark_of(info, PluginName) else _METAVARS.get(kind, "TEXT")


def _plugin_type(options: list[Option]) -> click.ParamType[Any]:
    choices = _choices(options)
    if choices:
        return _Text(lambda: choices)
    return click.Path() if all(option.type is Path for option in options) else _Text()


def _plugin_metavar(options: list[Option]) -> str:
    choices = _choices(options)
    kinds = {_METAVARS.get(option.type, "TEXT") for option in options}
    shown = f"<{'|'.join(choices)}>" if choices else kinds.pop() if len(kinds) == 1 else "TEXT"
    return f"{shown}[,{shown}…]" if any(option.several for option in options) else shown


def _choices(options: list[Option]) -> list[str]:
    """The values that may be given; none where any of the plug-ins takes others too."""
    if not all(option.choices for option in options):
        return []
    return list(dict.fromkeys(str(choice) for option in options for choice in option.choices))


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

"""Marks on request fields that tell a surface what a plain type cannot."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias, TypeVar, cast

from pydantic import BeforeValidator
from pydantic.fields import FieldInfo

from wirelessagent.plugins import Kind, Option, plugin, plugins
from wirelessagent.plugins import names as plugin_names

__all__ = [
    "Advanced", "Kind", "Known", "Local", "Names", "Option", "OptionsOf", "PerEntry", "PluginName", "PluginOptions",
    "Positional", "described", "mark_of", "plugin_names", "plugin_options",
]  # fmt: skip


@dataclass(frozen=True)
class Positional:
    """The field is given by place, not by name."""


@dataclass(frozen=True)
class Advanced:
    """The field is one that few people set: a surface shows it to those who ask for everything."""


@dataclass(frozen=True)
class Local:
    """The field is only for whoever sits at the machine: no form for callers elsewhere has it."""


@dataclass(frozen=True)
class PluginName:
    """The field names a plug-in of a kind."""

    kind: Kind


@dataclass(frozen=True)
class Known:
    """What may stand in the field is known, but looking it up takes time."""

    listed: Callable[[], Iterable[str]]


@dataclass(frozen=True)
class OptionsOf:
    """The field holds options for plug-ins of a kind (of ``only`` one of them), except ``but`` some."""

    kind: Kind
    only: str = ""
    but: tuple[str, ...] = ()


PluginOptions: TypeAlias = dict[str, Any]
"""Options of a plug-in by name, as in {"alpha": 2.0}."""


Mark = TypeVar("Mark")


def mark_of(info: FieldInfo, mark: type[Mark]) -> Mark | None:
    """The mark of this type that a field has."""
    return next((item for item in info.metadata if isinstance(item, mark)), None)


def described(info: FieldInfo, *, briefly: bool = False) -> str:
    """What is said of a field, with what may stand in it; ``briefly`` only what is known without a look at it."""
    known, plugin = mark_of(info, Known), mark_of(info, PluginName)
    listed = plugin_names(plugin.kind) if plugin else known.listed() if known and not briefly else ()
    return ": ".join(filter(None, (info.description, ", ".join(listed))))


def plugin_options(mark: OptionsOf) -> list[tuple[str, Option]]:
    """(plug-in, option) for every option that a field with this mark may hold."""
    chosen = [plugin(mark.kind, mark.only)] if mark.only else plugins(mark.kind)
    return [(found.name, option) for found in chosen for option in found.options if option.name not in mark.but]


def _several(value: Any) -> Any:
    """Text such as "1e6, 2e6", in brackets or not, as a list; anything else as it is."""
    if isinstance(value, str) and "," in value:
        return [part.strip() for part in value.strip().removeprefix("[").removesuffix("]").split(",")]
    return value


def _listed(value: Any) -> Any:
    """Text such as "dual, exact", or several of such, as one list; anything else as it is."""
    given = cast("list[Any]", value if isinstance(value, list) else [value])
    texts = [text for text in given if isinstance(text, str)]
    if len(texts) < len(given):  # for the field's own check to refuse
        return given
    return [part.strip() for text in texts for part in text.split(",") if part.strip()]


Names: TypeAlias = Annotated[list[str], BeforeValidator(_listed)]
"""Several names; "dual,exact" or the option twice on a command line."""

PerEntry: TypeAlias = Annotated[float | list[float], BeforeValidator(_several)]
"""One number for all, or one per user (or subcarrier); "1e6,2e6" on a command line."""

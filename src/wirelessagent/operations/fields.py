"""Marks on request fields that tell a surface what a plain type cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias, cast

from pydantic import BeforeValidator

from wirelessagent.plugins import Kind, Option, plugin, plugins
from wirelessagent.plugins import names as plugin_names

__all__ = [
    "Kind", "Names", "Option", "OptionsOf", "PerEntry", "PluginName", "PluginOptions", "Positional", "plugin_names",
    "plugin_options",
]  # fmt: skip


@dataclass(frozen=True)
class Positional:
    """The field is given by place, not by name."""


@dataclass(frozen=True)
class PluginName:
    """The field names a plug-in of a kind."""

    kind: Kind


@dataclass(frozen=True)
class OptionsOf:
    """The field holds options for plug-ins of a kind (of ``only`` one of them), except ``but`` some."""

    kind: Kind
    only: str = ""
    but: tuple[str, ...] = ()


PluginOptions: TypeAlias = dict[str, Any]
"""Options of a plug-in by name, as in {"alpha": 2.0}."""


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

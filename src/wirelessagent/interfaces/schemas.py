"""JSON Schemas as language models and clients read them best: short, and true of what is sent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias, cast

Schema: TypeAlias = dict[str, Any]


def asked(schema: Mapping[str, Any]) -> Schema:
    """A form's schema without what only repeats its names, and without null for what can be left out.

    >>> asked({"type": "object", "properties": {"n": {"title": "N", "anyOf": [{"type": "integer"}, {"type": "null"}]}}})
    {'type': 'object', 'properties': {'n': {'type': 'integer'}}}
    """
    return cast("Schema", _asked(schema, named=False))


def _asked(part: Any, *, named: bool) -> Any:
    """``named``: whether the keys of ``part`` are names that people chose, as of properties."""
    if isinstance(part, list):
        return [_asked(one, named=False) for one in cast("list[Any]", part)]
    if not isinstance(part, Mapping):
        return part
    found = dict(cast("Mapping[str, Any]", part))
    if named:
        return {name: _asked(one, named=False) for name, one in found.items()}
    found.pop("title", None)
    if found.get("default", ...) is None:
        del found["default"]
    choices: list[Any] = [one for one in found.get("anyOf", ()) if one != {"type": "null"}]
    if len(choices) == 1:
        del found["anyOf"]
        found = {**choices[0], **found}
        found.pop("title", None)
    elif choices:
        found["anyOf"] = choices
    return {name: _asked(one, named=name in ("properties", "$defs")) for name, one in found.items()}


def answered(schema: Mapping[str, Any]) -> Schema:
    """A record's schema with null for every number, since infinity and NaN are sent as null."""
    return cast("Schema", _answered(schema))


def _answered(part: Any) -> Any:
    if isinstance(part, list):
        return [_answered(one) for one in cast("list[Any]", part)]
    if not isinstance(part, Mapping):
        return part
    found = {
        name: _answered(one)
        for name, one in cast("Mapping[str, Any]", part).items()
        if isinstance(one, Mapping) or name not in ("title", "default")
    }
    if found.get("type") == "number":
        found["type"] = ["number", "null"]
    return found


def inlined(schema: Mapping[str, Any]) -> Schema:
    """A schema without references: each stands where it is used. It must not refer to itself."""
    return cast(
        "Schema", _inlined({name: one for name, one in schema.items() if name != "$defs"}, schema.get("$defs", {}))
    )


def _inlined(part: Any, defined: Mapping[str, Any]) -> Any:
    if isinstance(part, list):
        return [_inlined(one, defined) for one in cast("list[Any]", part)]
    if not isinstance(part, Mapping):
        return part
    found = cast("Mapping[str, Any]", part)
    if "$ref" in found:
        return _inlined(defined[found["$ref"].rpartition("/")[2]], defined)
    return {name: _inlined(one, defined) for name, one in found.items()}

"""The options of a plug-in: its fields that hold a simple value, with what its docstring says of them."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import re
import types
import typing
from collections.abc import Iterable
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any, Literal, cast, get_args

from wirelessagent.model.errors import InputError

_SIMPLE_TYPES: tuple[type, ...] = (bool, int, float, str, Path)


@dataclass(frozen=True, kw_only=True)
class Option:
    """A field of a plug-in that a user may set: on the command line, in a request, from the LLM.

    Attributes:
        name: the field's name.
        type: the simple type of its values.
        default: its default; None where it has none, or where None is the default.
        required: whether it must be given.
        help: what it is, the first sentence on it under "Attributes:" in the docstring; empty if that says nothing.
        choices: the values of its Literal; empty if any value of the type may be given.
        several: whether it may also be a tuple of such values, as in "1e6,2e6" on a command line.
    """

    name: str
    type: type
    default: Any
    required: bool
    help: str = ""
    choices: tuple[Any, ...] = ()
    several: bool = False


@functools.cache
def options_of(cls: type[Any]) -> tuple[Option, ...]:
    """The fields of a plug-in class that hold a simple value (number, text, switch, path, or None)."""
    hints = typing.get_type_hints(cls)
    described = _attribute_docs(cls)
    options: list[Option] = []
    for item in dataclasses.fields(cls):
        hint, several = _one_or_several(hints[item.name])
        simple = _simple_type(hint)
        if item.init and simple is not None:
            has_default = item.default is not dataclasses.MISSING
            factory = item.default_factory is not dataclasses.MISSING
            options.append(
                Option(
                    name=item.name,
                    type=simple,
                    default=item.default if has_default else None,
                    required=not has_default and not factory,
                    help=described.get(item.name, ""),
                    choices=_choices(hint),
                    several=several,
                )
            )
    return tuple(options)


def converted(option: Option, value: Any) -> Any:
    """An option's value in its field's type; text from a command line is read."""
    if option.several and isinstance(value, str) and "," in value:
        value = [part.strip() for part in value.split(",")]
    elif option.several:
        value = getattr(value, "tolist", lambda: value)()  # of an array
    if option.several and isinstance(value, list | tuple):
        return tuple(_converted(option, part) for part in cast("Iterable[Any]", value))
    return _converted(option, value)


def _converted(option: Option, value: Any) -> Any:
    """One value in the field's type."""
    if value is None:
        return value
    if option.choices:
        return _chosen(option, value)
    if isinstance(value, option.type) and not (option.type is int and isinstance(value, bool)):
        return value
    if option.type is bool and isinstance(value, str):
        switches = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
        if value.lower() in switches:
            return switches[value.lower()]
    elif option.type is not bool and not isinstance(value, bool) and isinstance(value, str | Real):
        try:
            converted: Any = option.type(cast("Any", value))
        except (ValueError, TypeError, OverflowError):
            pass
        else:
            if isinstance(value, str) or option.type is not int or converted == value:
                return converted
    raise InputError(f"{option.name} must be of type {option.type.__name__}; got {value!r}")


def _attribute_docs(cls: type[Any]) -> dict[str, str]:
    """The first sentence on each name under "Attributes:" in the docstrings of a class and its bases."""
    found: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        _, _, section = inspect.cleandoc(vars(base).get("__doc__") or "").partition("\nAttributes:\n")
        section = re.split(r"\n(?=\S)", section)[0]  # it ends where the text is no longer indented
        for item in re.split(r"\n(?=\S)", inspect.cleandoc(section)):
            name, _, text = item.partition(":")
            sentence = re.split(r"\.\s+(?=[A-Z])", " ".join(text.split()))[0]
            if text and re.fullmatch(r"\w+(\s*\(.*\))?", name):
                found[name.split("(")[0].strip()] = sentence.removesuffix(".").replace("``", "")
    return found


def _one_or_several(hint: Any) -> tuple[Any, bool]:
    """What a field of this annotation holds besides None; whether that may be several, as in float | tuple[float, …].

    The annotation itself if it is any other mix of types.
    """
    union = isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union
    parts = [part for part in get_args(hint) if part is not type(None)] if union else [hint]
    several = len(parts) == 2 and parts[0] in _SIMPLE_TYPES and parts[1] == tuple[parts[0], ...]
    return (parts[0], several) if several or len(parts) == 1 else (hint, False)


def _choices(hint: Any) -> tuple[Any, ...]:
    """The values of a Literal; none for any other annotation."""
    if typing.get_origin(hint) is not Literal:
        return ()
    return tuple(value for value in get_args(hint) if value is not None)


def _simple_type(hint: Any) -> type[Any] | None:
    """The simple type of an annotation without None, that of the first value for a Literal; None if it is another."""
    choices = _choices(hint)
    kind = cast("Any", type(choices[0])) if choices else hint
    return kind if kind in _SIMPLE_TYPES else None


def _chosen(option: Option, value: Any) -> Any:
    """The choice that a value is; text may be written with any capitals."""
    for choice in option.choices:
        if type(value) is type(choice) and value == choice:
            return choice
    written = str(value).strip().casefold() if isinstance(value, str | Real) else None
    meant = [choice for choice in option.choices if str(choice).casefold() == written]
    if len(meant) == 1:
        return meant[0]
    raise InputError(f"{option.name} must be one of {', '.join(map(str, option.choices))}; got {value!r}")

"""JSON: nested lists of numbers, null where missing; alone or as values of an object.

Complex coefficients are an object of two lists, {"real": [[…]], "imag": [[…]]}. Single values beside the lists, or an
object called "meta", describe them. NaN, which JSON does not know but many programs write, means missing as null does.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import Contents, Entry, decoding, never_loaded
from wirelessagent.sensing.formats.text import decode
from wirelessagent.sensing.wording import shown

_COMPLEX = {"real", "imag"}
_DEEPEST = 16  # of lists in lists: no array of gains has more than the four known axes


def read_json(data: bytes, *, max_bytes: int) -> Contents:
    """The arrays of a JSON file and its single values."""
    value = parse(decode(data))
    if isinstance(value, list) or _is_complex(value):
        return Contents(entries=(_entry("", value),))
    if not isinstance(value, dict):
        raise FileFormatError(
            f"holds {shown(value)} where a list of lists of gains (or an object with one) is expected"
        )
    named = cast("dict[str, Any]", value)
    arrays: dict[str, Any] = {
        name: item for name, item in named.items() if isinstance(item, list | dict) and name != "meta"
    }
    return Contents(
        entries=tuple(_entry(name, item) for name, item in arrays.items()),
        metadata={name: item for name, item in named.items() if name not in arrays},
    )


def parse(text: str) -> Any:
    """The value of a JSON text; names that stand twice in an object are an error, since one would be lost."""
    with decoding("JSON"):
        try:
            return json.loads(text, object_pairs_hook=_unique)
        except RecursionError as error:
            raise FileFormatError("is nested too deeply; it must be a list of lists of gains") from error


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise FileFormatError(f"has {twice!r} twice in one object; keep one of them")
    return found


def _is_complex(value: Any) -> bool:
    return isinstance(value, dict) and set(cast("dict[str, Any]", value)) == _COMPLEX


def _entry(name: str, value: Any) -> Entry:
    """A list, or an object of real and imaginary lists, judged by its first elements."""
    if not isinstance(value, list) and not _is_complex(value):
        return Entry(name=name, shape=(), dtype="an object", kind="refused", read=never_loaded(name, "an object"))
    shape, leaf = _peek(value["real"] if isinstance(value, dict) else value)
    if len(shape) > _DEEPEST:
        deep = f"nested {len(shape)} deep"
        return Entry(name=name, shape=(), dtype=deep, kind="refused", read=never_loaded(name, deep))
    if isinstance(value, dict):
        return Entry(
            name=name, shape=shape, dtype="complex numbers", kind="complex", read=partial(_complex, name, value)
        )
    items = cast("list[Any]", value)
    if isinstance(leaf, str) and len(shape) == 1:
        return Entry(name=name, shape=shape, dtype="text", kind="text", read=partial(_texts, name, items))
    if isinstance(leaf, bool):
        switches = partial(_switches, name, items, shape)
        return Entry(name=name, shape=shape, dtype="true or false", kind="switches", read=switches)
    return Entry(name=name, shape=shape, dtype="numbers", kind="real", read=partial(_numbers, name, items, shape))


def _peek(value: Any) -> tuple[tuple[int, ...], Any]:
    """The shape that the first elements promise, and the first number (or what stands in its place)."""
    shape: list[int] = []
    while isinstance(value, list):
        items = cast("list[Any]", value)
        shape.append(len(items))
        value = items[0] if items else None
    return tuple(shape), value


def _texts(name: str, items: list[Any]) -> NDArray[Any]:
    for i, item in enumerate(items):
        if not isinstance(item, str):
            raise FileFormatError(f"{name}[{i}] is {shown(item)}, which is not text; write it in quotes")
    return np.array(items)


def _switches(name: str, items: list[Any], shape: tuple[int, ...]) -> NDArray[np.bool_]:
    with decoding("JSON"):
        return np.array(items, dtype=np.bool_).reshape(shape)


def _complex(name: str, value: dict[str, Any]) -> NDArray[Any]:
    shape, _ = _peek(value["real"])
    real = _numbers(f"{name or 'the object'}.real", value["real"], shape)
    imaginary = _numbers(f"{name or 'the object'}.imag", value["imag"], shape)
    result = np.empty(shape, dtype=np.complex128)
    result.real, result.imag = real, imaginary  # a sum would turn one missing part into two
    return result


def _numbers(name: str, value: Any, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Nested lists as an array; whatever is not a number of the promised shape is an error that says where."""
    flat: list[float] = []
    _collect(flat, value, shape, name, [])
    return np.array(flat, dtype=np.float64).reshape(shape)


def _collect(flat: list[float], value: Any, shape: tuple[int, ...], name: str, path: list[int]) -> None:
    if not shape:
        flat.append(_number(value, name, path))
        return
    if not isinstance(value, list):
        raise FileFormatError(
            f"is ragged: {_place(name, path)} is {shown(value)} where a list of {shape[0]} numbers is expected"
        )
    items = cast("list[Any]", value)
    if len(items) != shape[0]:
        first = _place(name, [0] * len(path))
        raise FileFormatError(
            f"is ragged: {_place(name, path)} has {len(items)} entries, {first} has {shape[0]}; "
            "write null where missing"
        )
    for i, item in enumerate(items):
        path.append(i)
        _collect(flat, item, shape[1:], name, path)
        path.pop()


def _number(value: Any, name: str, path: Sequence[int]) -> float:
    if value is None:
        return float("nan")
    if isinstance(value, int | float) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            pass
    raise FileFormatError(
        f"{_place(name, path)} is {shown(value)}, which is not a number that a gain can have; "
        "write null if it is missing"
    )


def _place(name: str, path: Sequence[int]) -> str:
    """An element in the usual notation, counted from 0: gain[2][5]."""
    return (name or "the matrix") + "".join(f"[{i}]" for i in path)

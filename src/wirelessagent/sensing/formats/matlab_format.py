"""MATLAB's MAT-file version 5 (also written by versions 6 and 7): numeric variables by name.

Format: MathWorks, "MAT-File Format", chapter "Version 5 MAT-file format". Read here and not by SciPy, whose reader
(1.17) ends the process on some damaged files and unpacks a compressed variable at once, whatever its size. Cells,
structures, sparse matrices and objects are named and never loaded. Version 7.3 is HDF5.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import (
    Contents,
    Entry,
    Kind,
    check_size,
    decoding,
    kind_of,
    never_loaded,
)

_HEADER_BYTES = 128
_STEP = 2**20
_MATRIX, _COMPRESSED = 14, 15  # table "MAT-file data types"
_STORED = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_TEXTS = {1: "latin-1", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
_CLASSES = {
    1: "cell", 2: "struct", 3: "object", 4: "char", 5: "sparse", 6: "float64", 7: "float32", 8: "int8", 9: "uint8",
    10: "int16", 11: "uint16", 12: "int32", 13: "uint32", 14: "int64", 15: "uint64", 16: "function", 17: "opaque",
}  # fmt: skip  # table "MATLAB array types"; the numeric ones under NumPy's names
_OPAQUE = 17
_COMPLEX_FLAG, _LOGICAL_FLAG = 0x800, 0x200


@dataclass(frozen=True)
class _Variable:
    """A variable's header, and its data elements as (type, bytes): real part, then imaginary part if there is one."""

    name: str
    shape: tuple[int, ...]
    matlab_class: str
    is_logical: bool
    order: str
    parts: tuple[tuple[int, memoryview], ...]


def read_matlab(data: bytes, *, max_bytes: int) -> Contents:
    """The variables of a MAT-file."""
    with decoding("MATLAB v5"):
        order = "<" if data[126:128] == b"IM" else ">"
        return Contents(entries=tuple(_entry(_variable(order, body)) for body in _matrices(order, data, max_bytes)))


def _entry(variable: _Variable) -> Entry:
    known = partial(Entry, name=variable.name, shape=variable.shape, dtype=variable.matlab_class)
    if variable.matlab_class == "char":
        return known(kind="text", read=partial(_text, variable))
    if variable.matlab_class not in _CLASSES.values() or not hasattr(np, variable.matlab_class):
        return known(kind="refused", read=never_loaded(variable.name, f"a MATLAB {variable.matlab_class} array"))
    if variable.is_logical:
        return known(kind="switches", dtype="logical", read=partial(_numbers, variable))
    kind: Kind = kind_of(np.dtype(variable.matlab_class)) if len(variable.parts) == 1 else "complex"
    return known(kind=kind, read=partial(_numbers, variable))


def _matrices(order: str, data: bytes, max_bytes: int) -> Iterator[memoryview]:
    """The bodies of the file's variables, unpacked, as long as all of them together stay below ``max_bytes``."""
    view, room = memoryview(data), max_bytes
    for kind, body in _elements(order, view[_HEADER_BYTES:], padded=False):
        if kind == _COMPRESSED:
            unpacked = _inflated(body, room, max_bytes)
            room -= len(unpacked)
            kind, body = next(_elements(order, memoryview(unpacked), padded=False))
        if kind == _MATRIX and len(body):
            yield body


def _elements(order: str, view: memoryview, *, padded: bool = True) -> Iterator[tuple[int, memoryview]]:
    """(type, bytes) of each data element; short ones hold their bytes within the tag."""
    place = 0
    while place < len(view):
        first, size = struct.unpack_from(f"{order}II", view, place)
        if first >> 16:
            kind, size, start, step = first & 0xFFFF, first >> 16, place + 4, 8
            if size > 4:
                raise FileFormatError(f"is damaged: a short element claims {size} bytes; write it again")
        else:
            kind, start, step = first, place + 8, 8 + size + (-size % 8 if padded else 0)
        if start + size > len(view):
            raise FileFormatError(
                f"is cut short: an element of {size} bytes starts {len(view) - start} bytes before the end; "
                "copy or write it again"
            )
        yield kind, view[start : start + size]
        place += step


def _variable(order: str, body: memoryview) -> _Variable:
    """A variable from its body: flags, dimensions, name, data."""
    elements = _elements(order, body)
    flags = struct.unpack_from(f"{order}I", next(elements)[1])[0]
    code = flags & 0xFF
    matlab_class = _CLASSES.get(code, f"class {code}")
    second = next(elements)[1]
    if code == _OPAQUE:  # these have no dimensions: the name comes at once
        return _Variable(bytes(second).decode("latin-1"), (), matlab_class, False, order, ())
    shape = tuple(int(length) for length in np.frombuffer(second, dtype=f"{order}i4"))
    if len(shape) < 2 or any(length < 0 for length in shape):
        raise FileFormatError(f"is damaged: a variable has the dimensions {shape}; write it again")
    name = bytes(next(elements)[1]).decode("latin-1")
    if not name:
        matlab_class = "function workspace"
    count = 2 if flags & _COMPLEX_FLAG else 1
    numeric = 4 <= code <= 15 and code != 5
    parts = tuple(next(elements) for _ in range(count)) if numeric else ()
    return _Variable(name, shape, matlab_class, bool(flags & _LOGICAL_FLAG), order, parts)


def _numbers(variable: _Variable) -> NDArray[Any]:
    with decoding("MATLAB v5"):
        parts = [_part(variable, kind, body) for kind, body in variable.parts]
        if len(parts) == 1:
            return parts[0]
        result = np.empty(variable.shape, dtype=np.complex128)
        result.real, result.imag = parts
        return result


def _part(variable: _Variable, kind: int, body: memoryview) -> NDArray[Any]:
    """One part's numbers; MATLAB stores them column by column, and in a smaller type where nothing is lost."""
    stored = np.frombuffer(body, dtype=f"{variable.order}{_STORED[kind]}")
    return stored.astype(variable.matlab_class).reshape(variable.shape, order="F")


def _text(variable: _Variable) -> NDArray[Any]:
    """A char matrix as one text per row."""
    with decoding("MATLAB text"):
        kind, body = variable.parts[0]
        encoding = _TEXTS[kind]
        suffix = {"<": "-le", ">": "-be"}[variable.order] if encoding in ("utf-16", "utf-32") else ""
        letters = np.array(list(bytes(body).decode(encoding + suffix)), dtype=np.str_)
        rows = letters.reshape((variable.shape[0], -1), order="F")
        return np.array(["".join(row.tolist()).rstrip() for row in rows])


def _inflated(packed: memoryview, room: int, max_bytes: int) -> bytes:
    """A zlib stream unpacked, as long as that takes no more than ``room`` bytes."""
    inflater = zlib.decompressobj()
    parts: list[bytes] = []
    size = 0

    def take(part: bytes) -> None:
        nonlocal size
        size += len(part)
        if size > room:
            check_size("what the file unpacks to, or more than that,", max_bytes - room + size, max_bytes)
        parts.append(part)

    for start in range(0, len(packed), _STEP):
        waiting = bytes(packed[start : start + _STEP])
        while waiting:
            take(inflater.decompress(waiting, _STEP))
            waiting = inflater.unconsumed_tail
    while rest := inflater.decompress(b"", _STEP):
        take(rest)
    if not inflater.eof:
        raise FileFormatError("is cut short: a compressed variable ends too early; copy or write it again")
    return b"".join(parts)

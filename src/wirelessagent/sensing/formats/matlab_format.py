"""MATLAB's MAT-file version 5 (and 6, 7): numeric variables by name.

SciPy reads it; before that, the file is walked through without being kept, because SciPy unpacks a compressed
variable at once whatever its size. Format: MathWorks, "MAT-File Format", level 5. Version 7.3 is HDF5.
"""

from __future__ import annotations

import io
import struct
import zlib
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import (
    Contents,
    Entry,
    Kind,
    array_bytes,
    check_size,
    decoding,
    kind_of,
    never_loaded,
)

_HEADER_BYTES = 128
_COMPRESSED = 15  # miCOMPRESSED
_STEP = 2**20
_NUMERIC = {"double", "single", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
_LARGEST_ITEM_BYTES = 8


def read_matlab(data: bytes, *, max_bytes: int) -> Contents:
    """The variables of a MAT-file; cells, structures, sparse matrices and objects are named and never loaded."""
    from scipy.io import whosmat

    with decoding("MATLAB v5"):
        check_size("what the file unpacks to", _unpacked_bytes(data, max_bytes), max_bytes)
        stream: Any = io.BytesIO(data)  # SciPy takes streams; its stubs know names only
        variables = whosmat(stream)
    return Contents(entries=tuple(_entry(data, name, tuple(shape), cls, max_bytes) for name, shape, cls in variables))


def _entry(data: bytes, name: str, shape: tuple[int, ...], matlab_class: str, max_bytes: int) -> Entry:
    known = partial(Entry, name=name, shape=shape, dtype=matlab_class)
    if matlab_class == "char":
        return known(kind="text", read=partial(_load, data, name))
    if matlab_class == "logical":
        return known(kind="switches", read=partial(_load, data, name))
    if matlab_class not in _NUMERIC:
        return known(kind="refused", read=never_loaded(name, f"a MATLAB {matlab_class} array"))
    check_size(f"variable {name!r}", array_bytes(shape, _LARGEST_ITEM_BYTES), max_bytes)
    kind: Kind = "real"  # whether it is complex shows when it is read
    return known(kind=kind, read=partial(_load, data, name))


def _load(data: bytes, name: str) -> NDArray[Any]:
    from scipy.io import loadmat

    with decoding("MATLAB v5"):
        stream: Any = io.BytesIO(data)
        loaded: Any = loadmat(stream, variable_names=[name])[name]
        array = np.asarray(loaded)
    if kind_of(array.dtype) == "refused":
        raise FileFormatError(f"{name!r} holds {array.dtype}, which are no plain numbers; save it as a numeric matrix")
    return np.char.rstrip(array) if array.dtype.kind == "U" else array


def _unpacked_bytes(data: bytes, max_bytes: int) -> int:
    """What the file's elements unpack to, counted no further than just above ``max_bytes``."""
    order = "<" if data[126:128] == b"IM" else ">"
    total, place = 0, _HEADER_BYTES
    while place < len(data) and total <= max_bytes:
        kind, size = struct.unpack_from(f"{order}II", data, place)
        place += 8
        if place + size > len(data):
            raise FileFormatError(
                f"is cut short: an element of {size} bytes starts {len(data) - place} bytes before the end; "
                "copy it again"
            )
        total += _inflated(data[place : place + size], max_bytes - total) if kind == _COMPRESSED else size
        place += size
    return total


def _inflated(packed: bytes, limit: int) -> int:
    """The unpacked size of a zlib stream, counted no further than just above ``limit``."""
    inflater = zlib.decompressobj()
    total = 0
    for start in range(0, len(packed), _STEP):
        waiting = packed[start : start + _STEP]
        while waiting and total <= limit:
            total += len(inflater.decompress(waiting, _STEP))
            waiting = inflater.unconsumed_tail
    while total <= limit and (rest := inflater.decompress(b"", _STEP)):
        total += len(rest)
    if total <= limit and not inflater.eof:
        raise FileFormatError("is damaged: a compressed element ends too early; copy it again")
    return total

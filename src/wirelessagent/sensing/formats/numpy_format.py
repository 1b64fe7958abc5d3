"""NPZ and NPY, read without NumPy's own loader so that no header can make us unpickle or allocate.

Specification: NEP 1 and numpy.lib.format. An array's header is judged first (no objects, no records; the shape times
the item size must be what the file holds), then exactly that many bytes are read.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from functools import partial
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import (
    Contents,
    Entry,
    array_bytes,
    check_size,
    decoding,
    kind_of,
    never_loaded,
)

_COMPRESSIONS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)  # the two that NumPy writes; the others read unbounded


def read_npy(data: bytes, *, max_bytes: int) -> Contents:
    """The one array of an NPY file."""
    with decoding("NPY"):
        return Contents(entries=(_entry("", io.BytesIO(data), len(data), max_bytes, partial(io.BytesIO, data)),))


def read_npz(data: bytes, *, max_bytes: int) -> Contents:
    """The arrays of an NPZ file, a ZIP archive with one NPY file per array."""
    with decoding("NPZ"), zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = [info for info in archive.infolist() if info.filename.endswith(".npy")]
        if not members:
            inside = ", ".join(archive.namelist()[:3]) or "nothing"
            raise FileFormatError(
                f"is a ZIP archive with no .npy array in it (it holds {inside}); write it with numpy.savez"
            )
        check_size("what the archive unpacks to", sum(info.file_size for info in members), max_bytes)
        return Contents(entries=tuple(_member(archive, info, data, max_bytes) for info in members))


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, data: bytes, max_bytes: int) -> Entry:
    if info.compress_type not in _COMPRESSIONS or info.flag_bits & 1:
        raise FileFormatError(
            f"{info.filename!r} is encrypted or compressed in a way that NumPy does not write; use numpy.savez"
        )

    def reopen() -> IO[bytes]:
        return zipfile.ZipFile(io.BytesIO(data)).open(info)

    with archive.open(info) as stream:
        return _entry(info.filename.removesuffix(".npy"), stream, info.file_size, max_bytes, reopen)


def _entry(name: str, stream: IO[bytes], size: int, max_bytes: int, reopen: Callable[[], IO[bytes]]) -> Entry:
    """The array whose NPY header ``stream`` starts with; ``size`` is what the stream can deliver."""
    shape, _, dtype, start = _header(stream)
    known = partial(Entry, name=name, shape=shape)
    if dtype.hasobject:
        objects = "an array of Python objects (a pickle)"
        return known(dtype="Python objects", kind="refused", read=never_loaded(name, objects))
    kind = kind_of(dtype)
    if kind == "refused":
        return known(dtype=str(dtype), kind="refused", read=never_loaded(name, f"an array of type {dtype}"))
    needed = array_bytes(shape, dtype.itemsize)
    check_size(f"array {name!r}", needed, max_bytes)
    if start + needed != size:
        raise FileFormatError(
            f"is damaged or cut short: array {name!r} of shape {shape} needs {needed} bytes, "
            f"the file holds {size - start}; copy or write it again"
        )
    return known(dtype=str(dtype), kind=kind, read=partial(_read, reopen))


def _header(stream: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any], int]:
    """Shape, column-major order, element type and header length of an NPY stream."""
    version = npy.read_magic(stream)
    if version == (1, 0):
        shape, by_columns, dtype = npy.read_array_header_1_0(stream)
    elif version == (2, 0):
        shape, by_columns, dtype = npy.read_array_header_2_0(stream)
    else:
        raise FileFormatError(f"NPY version {version[0]}.{version[1]} holds no plain numbers; write it with numpy.save")
    if any(length < 0 for length in shape):
        raise FileFormatError(f"is damaged: an array has the shape {shape}; write it again")
    return shape, by_columns, dtype, stream.tell()


def _read(reopen: Callable[[], IO[bytes]]) -> NDArray[Any]:
    with decoding("NumPy's format"), reopen() as stream:
        shape, by_columns, dtype, _ = _header(stream)
        flat = np.frombuffer(stream.read(array_bytes(shape, dtype.itemsize)), dtype=dtype)
        array = flat.reshape(shape[::-1]).T if by_columns else flat.reshape(shape)
        return np.char.decode(array, "utf-8") if dtype.kind == "S" else array

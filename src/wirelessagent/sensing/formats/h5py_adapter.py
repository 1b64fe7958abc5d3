# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false, reportUnknownParameterType=false
"""The only door to h5py, and a process of its own: HDF5's library ends its process on some damaged files.

:func:`serve` runs in a child of :mod:`~wirelessagent.sensing.formats.hdf5_process` and needs nothing but NumPy and
h5py. Requests and answers are lines of JSON, and bytes follow where a line says how many:

- ``{"file": n, "limit_s": t}`` and n bytes: the file to read from now on; the answer lists its datasets and attributes.
- ``{"dataset": name, "limit_s": t}``: the answer has ``dtype`` and ``shape``, and the array's bytes follow it.
- An answer ``{"error": text}`` says what went wrong.
"""

from __future__ import annotations

import contextlib
import faulthandler
import io
import json
import sys
import warnings
from typing import Any, BinaryIO

import h5py
import numpy as np
from numpy.typing import NDArray

_ABOUT_DATA = {
    "_FillValue", "missing_value", "scale_factor", "add_offset", "units", "MATLAB_class", "MATLAB_empty",
}  # fmt: skip
_MATLAB_STORES = ("#refs#", "#subsystem#")  # where MATLAB keeps the contents of cells and objects
_LIBRARY_BYTES = 2**30  # address space that Python, NumPy and HDF5 take before a file is read, generously
_COPIES = 5  # of the largest allowed array: the file, stored, unpacked, as text, on its way out


def serve(max_bytes: int) -> None:
    """Answer requests until standard input ends, with arrays of at most ``max_bytes``."""
    _limit(max_bytes)
    warnings.simplefilter("ignore")  # as of a type whose metadata are not passed on
    source, sink = sys.stdin.buffer, sys.stdout.buffer
    session = _Session(max_bytes)
    _say(sink, {"ready": True})
    while line := source.readline():
        request = json.loads(line)
        # should the parent be gone, nobody else would stop a request that never ends
        faulthandler.dump_traceback_later(2 * request["limit_s"], exit=True)
        try:
            session.answer(request, source, sink)
        except Exception as error:  # noqa: BLE001  # damaged bytes make HDF5 fail in any way
            _say(sink, {"error": f"{type(error).__name__}: {' '.join(str(error).split()):.160}"})
        faulthandler.cancel_dump_traceback_later()


def _limit(max_bytes: int) -> None:
    """Bound this process's memory where the system can, and have it die quietly: no core file, no dialogue box."""
    with contextlib.suppress(ImportError):
        import msvcrt

        msvcrt.SetErrorMode(msvcrt.SEM_FAILCRITICALERRORS | msvcrt.SEM_NOGPFAULTERRORBOX)
    with contextlib.suppress(ImportError):
        import resource

        for kind, most in (
            (resource.RLIMIT_CORE, 0),
            (resource.RLIMIT_AS, _LIBRARY_BYTES + _COPIES * max_bytes),
        ):
            with contextlib.suppress(ValueError, OSError):  # the system allows less already, or does not limit this
                resource.setrlimit(kind, (most, resource.getrlimit(kind)[1]))


def _say(sink: BinaryIO, answer: dict[str, Any], array: NDArray[Any] | None = None) -> None:
    sink.write(json.dumps(answer).encode() + b"\n")
    if array is not None:
        sink.write(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data if array.size else b"")
    sink.flush()


class _Session:
    """The file that is being read."""

    def __init__(self, max_bytes: int) -> None:
        self._max_bytes = max_bytes
        self._data = b""
        self._file: Any = None

    def answer(self, request: dict[str, Any], source: BinaryIO, sink: BinaryIO) -> None:
        if "file" in request:
            self._data = source.read(request["file"])
            self._file = h5py.File(io.BytesIO(self._data), "r")
            _say(sink, _listing(self._file))
        else:
            array = self._load(request["dataset"])
            if array.nbytes > self._max_bytes:
                raise ValueError(f"a dataset unpacks to {array.nbytes} bytes")
            if array.dtype.names is not None:
                array = array.astype([tuple(part) for part in _type(array.dtype)])  # without gaps between its parts
            _say(sink, {"dtype": _type(array.dtype), "shape": array.shape}, array)

    def _load(self, name: str) -> NDArray[Any]:
        """A dataset's values as stored; strings as an array of str."""
        item: Any = self._file[name]
        if h5py.check_string_dtype(item.dtype) is not None:
            self._check_text_lengths(item)
            return np.asarray(item.asstr()[()], dtype=np.str_)
        return np.asarray(item[()])

    def _check_text_lengths(self, item: Any) -> None:
        """Refuse texts that claim to be longer than the file, for which HDF5 would allocate up to 4 GiB each.

        A text of variable length is stored as length (4 bytes), heap address (8) and index (4); HDF5 specification,
        IV.B.
        """
        start = item.id.get_offset()
        if h5py.check_string_dtype(item.dtype).length is not None or start is None:
            return
        stored = np.frombuffer(self._data, dtype="<u4", count=4 * item.size, offset=start)
        if stored.size and int(stored[::4].max()) > len(self._data):
            raise ValueError(f"a text in {item.name} claims {stored[::4].max()} bytes")


def _listing(file: Any) -> dict[str, Any]:
    """Every dataset in an HDF5 file; links out of the file are not followed."""
    found: list[dict[str, Any]] = []

    def visit(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and not name.startswith(_MATLAB_STORES) and item.shape is not None:
            found.append(_dataset(name, item))

    file.visititems(visit)
    return {"datasets": found, "attributes": _attributes(file)}


def _type(dtype: np.dtype[Any]) -> str | list[list[str]]:
    """An element type in NumPy's notation; a record as the names and types of its parts."""
    if dtype.names is None:
        return dtype.str
    return [[part, dtype[part].str] for part in dtype.names]


def _dataset(name: str, item: Any) -> dict[str, Any]:
    return {
        "name": name,
        "shape": item.shape,
        "dtype": _type(item.dtype),
        "is_text": h5py.check_string_dtype(item.dtype) is not None,
        "chunk_shape": item.chunks or (),
        "is_outside": bool(item.is_virtual or item.external),
        "dimensions": [_dimension(dimension) for dimension in item.dims],
        "attributes": _attributes(item, _ABOUT_DATA),
    }


def _dimension(dimension: Any) -> str:
    """The name of an axis: its label, else that of its scale."""
    if dimension.label:
        return str(dimension.label)
    return str(dimension[0].name).rpartition("/")[2] if len(dimension) else ""


def _attributes(item: Any, wanted: set[str] | None = None) -> dict[str, Any]:
    """Those of the wanted attributes (all if None) that are one number or one text."""
    found: dict[str, Any] = {}
    for name in item.attrs:
        if wanted is not None and name not in wanted:
            continue
        value = item.attrs[name]
        if isinstance(value, np.ndarray) and value.size == 1 and value.dtype.names is None:
            value = value.reshape(-1)[0]
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        if isinstance(value, str | int | float):
            found[str(name)] = value
    return found

"""HDF5, netCDF-4 and MATLAB v7.3, which are all HDF5 inside.

- MATLAB writes its column-major arrays as they lie in memory, so their axes come reversed; they are turned back.
- netCDF marks missing values with the attributes _FillValue and missing_value, fills what was never written with a
  value of its own, and may pack numbers with scale_factor and add_offset (CF conventions, 8.1).
- Complex numbers are records of two numbers called real and imag (MATLAB) or r and i (h5py).
- A dataset whose data lie outside the file (external storage, virtual datasets) is never read.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

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
from wirelessagent.sensing.formats.hdf5_heap import check_heaps
from wirelessagent.sensing.formats.hdf5_process import Dataset, Hdf5Process

_NETCDF_FILL = float(np.float32(9.9692099683868690e36))  # NC_FILL_FLOAT and NC_FILL_DOUBLE, netcdf.h
_PARTS = (("real", "imag"), ("r", "i"), ("re", "im"))
_TEXT_BYTES = 64  # at least this much memory for a string

_Load: TypeAlias = Callable[[Dataset], NDArray[Any]]


def read_hdf5(data: bytes, *, max_bytes: int, matlab: bool = False) -> Contents:
    """The datasets of an HDF5 file by their path; ``matlab`` says that it is MATLAB's, with its axes reversed."""
    check_heaps(data)
    process = Hdf5Process(max_bytes)
    try:
        with decoding("HDF5"):
            listing = process.listing(data)
            netcdf = "_NCProperties" in listing.attributes
            load = partial(_load, process, max_bytes)
            entries = tuple(_entry(found, load, matlab, netcdf) for found in listing.datasets)
    except BaseException:
        process.close()
        raise
    return Contents(entries=entries, metadata=listing.attributes, close=process.close)


def _entry(found: Dataset, load: _Load, matlab: bool, netcdf: bool) -> Entry:
    kind, dtype = _kind(found)
    known = partial(Entry, name=found.name, dtype=dtype, kind=kind)
    if kind == "refused":
        return known(shape=found.shape, read=never_loaded(found.name, f"a dataset of {dtype}"))
    return known(
        shape=found.shape[::-1] if matlab else found.shape,
        axes=found.dimensions[::-1] if matlab else found.dimensions,
        units=str(found.attributes.get("units", "")),
        read=partial(_text if kind == "text" else _numbers, load, found, matlab, netcdf),
        notes=_notes(found, matlab),
    )


def _kind(found: Dataset) -> tuple[Kind, str]:
    """What a dataset holds, and its element type in words."""
    matlab_class = found.attributes.get("MATLAB_class", "")
    if found.is_outside:
        return "refused", "data outside the file"
    if found.is_text or matlab_class == "char":
        return "text", "text"
    if found.attributes.get("MATLAB_empty"):
        return "refused", "nothing"
    if matlab_class == "logical":
        return "switches", "true or false"
    if found.dtype.kind == "O":
        return "refused", "references"
    if _parts(found.dtype) is not None:
        return "complex", "complex numbers"
    return kind_of(found.dtype), str(found.dtype)


def _parts(dtype: np.dtype[Any]) -> tuple[str, str] | None:
    """The fields that hold the real and the imaginary part."""
    fields = dtype.fields or {}
    for real, imaginary in _PARTS:
        if set(fields) == {real, imaginary} and all(part[0].kind in "fiu" for part in fields.values()):
            return real, imaginary
    return None


def _notes(found: Dataset, matlab: bool) -> dict[str, str]:
    notes = {"storage": "MATLAB v7.3 stores arrays transposed: turned back"} if matlab else {}
    named = [
        f"{name} {found.attributes[name]:g}" for name in ("scale_factor", "add_offset") if name in found.attributes
    ]
    if named:
        notes["packing"] = f"unpacked with {' and '.join(named)}"
    return notes


def _load(process: Hdf5Process, max_bytes: int, found: Dataset) -> NDArray[Any]:
    """The stored values, once it is clear that neither they nor a single chunk of them take too much memory."""
    item_bytes = max(found.dtype.itemsize, _TEXT_BYTES if found.is_text else 1)
    check_size(f"dataset {found.name!r}", array_bytes(found.shape, item_bytes), max_bytes)
    if found.chunk_shape:
        check_size(f"a chunk of dataset {found.name!r}", array_bytes(found.chunk_shape, item_bytes), max_bytes)
    with decoding("HDF5"):
        return process.load(found.name)


def _text(load: _Load, found: Dataset, matlab: bool, netcdf: bool) -> NDArray[Any]:
    stored = load(found)
    if stored.dtype.kind == "U":
        return stored
    rows = np.atleast_2d(stored.T)  # MATLAB's char matrix: UTF-16 code units, a row per text
    with decoding("MATLAB text"):
        return np.array([row.astype("<u2").tobytes().decode("utf-16-le").rstrip() for row in rows])


def _numbers(load: _Load, found: Dataset, matlab: bool, netcdf: bool) -> NDArray[Any]:
    stored = load(found)
    names = _parts(stored.dtype)
    parts = [stored] if names is None else [stored[name] for name in names]
    if stored.dtype.kind == "b":
        return stored.T if matlab else stored
    missing = np.zeros(stored.shape, dtype=bool)
    for value in _fill_values(found, netcdf):
        for part in parts:
            missing |= part == part.dtype.type(value) if part.dtype.kind == "f" else part == value
    values = parts[0] if len(parts) == 1 else _complex(*parts)
    scale, offset = (found.attributes.get(name) for name in ("scale_factor", "add_offset"))
    if scale is not None or offset is not None:
        values = values * _plain(scale, "scale_factor", 1.0) + _plain(offset, "add_offset", 0.0)
    if missing.any():
        values = np.where(missing, np.nan, values)
    return values.T if matlab else values


def _complex(real: NDArray[Any], imaginary: NDArray[Any]) -> NDArray[np.complex128]:
    result = np.empty(real.shape, dtype=np.complex128)
    result.real, result.imag = real, imaginary
    return result


def _fill_values(found: Dataset, netcdf: bool) -> list[float]:
    """The values that mean "missing" in this dataset."""
    stated = [found.attributes[name] for name in ("_FillValue", "missing_value") if name in found.attributes]
    values = [_plain(value, "_FillValue", np.nan) for value in stated]
    return [*values, _NETCDF_FILL] if netcdf and found.dtype.kind == "f" else values


def _plain(value: Any, name: str, default: float) -> float:
    if value is None:
        return default
    if isinstance(value, str):
        raise FileFormatError(f"the attribute {name} is {value!r:.40}, which is not a number; correct it")
    return float(value)

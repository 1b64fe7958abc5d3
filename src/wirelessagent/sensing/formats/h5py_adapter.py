# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false, reportUnknownParameterType=false
"""The only door to h5py, which has no type annotations: HDF5 datasets as plain typed values."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError

_ABOUT_DATA = {
    "_FillValue", "missing_value", "scale_factor", "add_offset", "units", "MATLAB_class", "MATLAB_empty",
}  # fmt: skip
_MATLAB_STORES = ("#refs#", "#subsystem#")  # where MATLAB keeps the contents of cells and objects


@dataclass(frozen=True, kw_only=True)
class Dataset:
    """What a dataset's header says of it.

    Attributes:
        name: its path in the file, without the leading slash.
        shape: its shape as stored.
        dtype: its element type.
        is_text: whether it holds strings.
        chunk_shape: how it is cut up for compression; empty if it is not.
        is_outside: whether its data lie in other files.
        dimensions: the names of its axes, "" where they have none.
        attributes: its attributes that are single numbers or text.
    """

    name: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    is_text: bool
    chunk_shape: tuple[int, ...]
    is_outside: bool
    dimensions: tuple[str, ...]
    attributes: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Listing:
    """A file's datasets in order, and the attributes of the file as a whole."""

    datasets: tuple[Dataset, ...]
    attributes: Mapping[str, Any]


def listing(data: bytes) -> Listing:
    """Every dataset in an HDF5 file; links out of the file are not followed."""
    found: list[Dataset] = []

    def visit(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and not name.startswith(_MATLAB_STORES) and item.shape is not None:
            found.append(_dataset(name, item))

    with h5py.File(io.BytesIO(data), "r") as file:
        file.visititems(visit)
        return Listing(datasets=tuple(found), attributes=_attributes(file))


def load(data: bytes, name: str) -> NDArray[Any]:
    """A dataset's values as stored; strings as an array of str."""
    with h5py.File(io.BytesIO(data), "r") as file:
        item: Any = file[name]
        if h5py.check_string_dtype(item.dtype) is not None:
            _check_text_lengths(item, data)
            return np.asarray(item.asstr()[()], dtype=np.str_)
        return np.asarray(item[()])


def _check_text_lengths(item: Any, data: bytes) -> None:
    """Refuse texts that claim to be longer than the file, for which HDF5 would allocate up to 4 GiB each.

    A text of variable length is stored as length (4 bytes), heap address (8) and index (4); HDF5 specification, IV.B.
    """
    start = item.id.get_offset()
    if h5py.check_string_dtype(item.dtype).length is not None or start is None:
        return
    stored = np.frombuffer(data, dtype="<u4", count=4 * item.size, offset=start)
    if stored.size and int(stored[::4].max()) > len(data):
        raise FileFormatError(f"is damaged: a text in {item.name} claims {stored[::4].max()} bytes; write it again")


def _dataset(name: str, item: Any) -> Dataset:
    return Dataset(
        name=name,
        shape=tuple(int(length) for length in item.shape),
        dtype=item.dtype,
        is_text=h5py.check_string_dtype(item.dtype) is not None,
        chunk_shape=tuple(int(length) for length in item.chunks or ()),
        is_outside=bool(item.is_virtual or item.external),
        dimensions=tuple(_dimension(dimension) for dimension in item.dims),
        attributes=_attributes(item, _ABOUT_DATA),
    )


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

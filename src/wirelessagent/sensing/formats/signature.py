"""Which format a file has: by its first bytes where the format has a signature, by its suffix where it has none."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Protocol

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import Contents
from wirelessagent.sensing.formats.csv_format import read_csv
from wirelessagent.sensing.formats.hdf5_format import read_hdf5
from wirelessagent.sensing.formats.json_format import read_json
from wirelessagent.sensing.formats.matlab_format import read_matlab
from wirelessagent.sensing.formats.numpy_format import read_npy, read_npz


class Reader(Protocol):
    """Turns a file's bytes into its arrays."""

    def __call__(self, data: bytes, *, max_bytes: int) -> Contents: ...


@dataclass(frozen=True, kw_only=True)
class Format:
    """A file format: its name, the suffixes it goes by, how it is read, and whether its first bytes tell it."""

    name: str
    suffixes: tuple[str, ...]
    read: Reader
    has_signature: bool = True


CSV = Format(name="CSV", suffixes=(".csv", ".tsv", ".txt", ".dat", ""), read=read_csv, has_signature=False)
JSON = Format(name="JSON", suffixes=(".json",), read=read_json, has_signature=False)
NPZ = Format(name="NPZ", suffixes=(".npz",), read=read_npz)
NPY = Format(name="NPY", suffixes=(".npy",), read=read_npy)
MATLAB = Format(name="MATLAB v5", suffixes=(".mat",), read=read_matlab)
MATLAB_HDF5 = Format(name="MATLAB v7.3", suffixes=(".mat",), read=partial(read_hdf5, matlab=True))
HDF5 = Format(name="HDF5", suffixes=(".h5", ".hdf5", ".hdf", ".he5", ".nc", ".nc4"), read=read_hdf5)

FORMATS = (CSV, JSON, NPZ, NPY, MATLAB, MATLAB_HDF5, HDF5)

_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_HDF5_STARTS = (0, 512, 1024, 2048, 4096)  # HDF5 format specification, II.A: behind a user block of 512·2^n bytes

_UNREADABLE = {
    b"\x80": "looks like a Python pickle, which can run code and is never loaded; save the array with numpy.savez",
    b"CDF": "is a classic netCDF file; convert it with: nccopy -k nc4 IN.nc OUT.nc",
    b"\x1f\x8b": "is compressed with gzip; unpack it first",
    b"BZh": "is compressed with bzip2; unpack it first",
    b"\xfd7zXZ": "is compressed with xz; unpack it first",
    b"\x28\xb5\x2f\xfd": "is compressed with zstd; unpack it first",
}


def recognise(data: bytes, suffix: str) -> Format:
    """The format of a file with these bytes and this suffix (with its dot).

    Raises:
        FileFormatError: it is empty, or of no format that can be read.
    """
    if not data or data.isspace():
        raise FileFormatError("is empty; it must hold a matrix of gains")
    suffix = suffix.lower()
    signed = _by_signature(data, suffix)
    if signed is not None:
        return signed
    for signature, complaint in _UNREADABLE.items():
        if data.startswith(signature):
            raise FileFormatError(complaint)
    named = [form for form in FORMATS if suffix in form.suffixes]
    if named and named[0].has_signature:
        raise FileFormatError(
            f"is called {suffix} but does not start as {named[0].name} does; "
            "it is damaged, or another format under a wrong name"
        )
    if b"\0" in data and not data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise FileFormatError(f"has an unknown format; what can be read is {known()}")
    if JSON in named or data.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"[", b"{"):
        return JSON
    return CSV


def known() -> str:
    """The formats that can be read, with their suffixes."""
    return ", ".join(f"{form.name} ({' '.join(filter(None, form.suffixes))})" for form in FORMATS)


def _by_signature(data: bytes, suffix: str) -> Format | None:
    if any(data.startswith(_HDF5_SIGNATURE, start) for start in _HDF5_STARTS):
        return MATLAB_HDF5 if data.startswith(b"MATLAB 7.3") or suffix == ".mat" else HDF5
    if data.startswith(b"\x93NUMPY"):
        return NPY
    if data.startswith((b"PK\x03\x04", b"PK\x05\x06")):
        return NPZ
    if data[126:128] in (b"IM", b"MI") and (data.startswith(b"MATLAB") or suffix == ".mat"):
        return MATLAB
    return None

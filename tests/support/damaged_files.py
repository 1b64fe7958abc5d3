"""Files of every format that can be read, damaged in seeded ways: cut off, bits flipped, blocks swapped, ranges zeroed,
numbers that look like lengths changed.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
from scipy.io import savemat

NAMES = ("Ann", "Bo", "Chloé", "user 4", "5G-CPE")
META = json.dumps({"units": "linear power gain", "carrier_hz": 3.5e9, "axes": "user,subcarrier"})


def gains(rng: np.random.Generator) -> np.ndarray:
    """Five users on 8 subcarriers, some of them missing."""
    gain = 1e-10 * rng.exponential(size=(len(NAMES), 8))
    gain[rng.random(gain.shape) < 0.15] = np.nan
    return gain


def csv(rng: np.random.Generator) -> bytes:
    gain, separator = gains(rng), str(rng.choice([",", ";", "\t"]))
    rows = [
        [name, *("" if np.isnan(cell) else repr(cell) for cell in row)]
        for name, row in zip(NAMES, gain.tolist(), strict=True)
    ]
    lines = [["user", *(f"f{n}" for n in range(1, 9))], *rows]
    if rng.random() < 0.3:
        lines = [line[1:] for line in lines[1:]]
    text = "\n".join(separator.join(line) for line in lines)
    return (text.replace(".", ",") if separator != "," and rng.random() < 0.5 else text).encode()


def json_(rng: np.random.Generator) -> bytes:
    gain = [[None if np.isnan(cell) else cell for cell in row] for row in gains(rng).tolist()]
    return json.dumps({"gain": gain, "user_names": NAMES, "meta": json.loads(META)}).encode()


def npz(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    write = np.savez_compressed if rng.random() < 0.5 else np.savez
    write(stream, gain=gains(rng), user_names=np.array(NAMES), meta=np.array(META))
    return stream.getvalue()


def npy(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    gain = gains(rng)
    np.save(stream, np.asfortranarray(gain) if rng.random() < 0.5 else gain)
    return stream.getvalue()


def matlab_5(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    variables = {
        "gain": gains(rng),
        "h": gains(rng) * 1j,
        "note": "text",
        "meta": META,
        "cells": np.array([1, "a"], object),
    }
    savemat(stream, variables, do_compression=bool(rng.random() < 0.5))
    return stream.getvalue()


def matlab_73(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    with h5py.File(stream, "w", userblock_size=512) as file:
        data = file.create_dataset("gain", data=gains(rng).T, compression="gzip" if rng.random() < 0.5 else None)
        data.attrs["MATLAB_class"] = np.bytes_("double")
        text = file.create_dataset("meta", data=np.frombuffer(META.encode("utf-16-le"), dtype="<u2")[:, None])
        text.attrs["MATLAB_class"] = np.bytes_("char")
        cell = file.create_dataset("cells", shape=(1, 1), dtype=h5py.ref_dtype)
        cell[0, 0] = data.ref
    return b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM" + stream.getvalue()[128:]


def hdf5(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    with h5py.File(stream, "w", libver=str(rng.choice(["earliest", "latest"]))) as file:
        file.attrs["units"], file.attrs["carrier_hz"] = "linear power gain", 3.5e9
        options = {"compression": "gzip", "shuffle": True, "fletcher32": True} if rng.random() < 0.5 else {}
        file.create_dataset("gain", data=gains(rng), **options)
        file["user_names"] = list(NAMES)  # of variable length: these lie in a heap
        file["run/1/truth"] = np.nan_to_num(gains(rng))
        file["run/2"] = h5py.SoftLink("/run/1")
        file.create_dataset("records", data=np.zeros(3, dtype=[("a", "f4"), ("b", "S3"), ("c", "i8", (2,))]))
    return stream.getvalue()


def netcdf_4(rng: np.random.Generator) -> bytes:
    stream = io.BytesIO()
    gain = gains(rng)
    with h5py.File(stream, "w") as file:
        file.attrs["_NCProperties"] = "version=2,netcdf=4.9.2,hdf5=1.14.3"
        packed = np.where(np.isnan(gain), -1, gain / 1e-14).astype("i4")
        data = file.create_dataset(
            "gain", data=packed, chunks=(2, 4), compression="gzip" if rng.random() < 0.5 else None
        )
        data.attrs.update({"_FillValue": np.int32([-1]), "scale_factor": 1e-14, "units": "linear"})
        for axis, name in enumerate(("user", "subcarrier")):
            scale = file.create_dataset(name, data=np.arange(gain.shape[axis]))
            scale.make_scale("This is a netCDF dimension but not a netCDF variable.")
            data.dims[axis].attach_scale(scale)
    return stream.getvalue()


FORMATS: dict[str, tuple[str, Callable[[np.random.Generator], bytes]]] = {
    "CSV": (".csv", csv),
    "JSON": (".json", json_),
    "NPZ": (".npz", npz),
    "NPY": (".npy", npy),
    "MATLAB 5": (".mat", matlab_5),
    "MATLAB 7.3": (".mat", matlab_73),
    "HDF5": (".h5", hdf5),
    "netCDF-4": (".nc", netcdf_4),
}
"""What each format is called, its suffix, and what writes a file of it."""


def _cut(rng: np.random.Generator, data: bytearray) -> None:
    del data[int(rng.integers(len(data))) :]


def _flip(rng: np.random.Generator, data: bytearray) -> None:
    for place in rng.integers(len(data), size=rng.integers(1, 17)).tolist():
        data[place] ^= 1 << int(rng.integers(8))


def _swap(rng: np.random.Generator, data: bytearray) -> None:
    size = int(rng.integers(1, max(2, len(data) // 8)))
    first, second = sorted(rng.integers(0, len(data) - size + 1, size=2).tolist())
    data[first : first + size], data[second : second + size] = data[second : second + size], data[first : first + size]


def _zero(rng: np.random.Generator, data: bytearray) -> None:
    size = int(rng.integers(1, max(2, min(256, len(data)))))
    start = int(rng.integers(len(data) - size + 1))
    data[start : start + size] = bytes(size)


def _length(rng: np.random.Generator, data: bytearray) -> None:
    """Up to four numbers of 1 to 8 bytes, small ones as lengths are, become other small ones or very large ones."""
    for _ in range(rng.integers(1, 5)):
        width = int(rng.choice([1, 2, 4, 8]))
        places = [
            i
            for i in range(0, len(data) - width, min(width, 4))
            if 0 < int.from_bytes(data[i : i + width], "little") < 4096
        ]
        if not places:
            continue
        place = int(rng.choice(places))
        old, most = int.from_bytes(data[place : place + width], "little"), 256**width - 1
        new = int(rng.choice([0, 1, old + 1, old - 1, 2 * old, 255]))
        large = rng.random() < 0.4
        data[place : place + width] = (most - int(rng.integers(16)) if large else min(new, most)).to_bytes(
            width, "little"
        )


DAMAGES = (_cut, _flip, _swap, _zero, _length)


def damaged(form: str, number: int) -> tuple[str, bytes]:
    """File ``number`` of a format: its suffix and its damaged bytes, the same ones each time."""
    rng = np.random.default_rng([sum(map(ord, form)), number])
    suffix, write = FORMATS[form]
    data = bytearray(write(rng))
    DAMAGES[number % len(DAMAGES)](rng, data)
    return suffix, bytes(data)


def write_damaged(folder: Path, form: str, number: int) -> Path:
    suffix, data = damaged(form, number)
    path = folder / f"damaged{suffix}"
    path.write_bytes(data)
    return path

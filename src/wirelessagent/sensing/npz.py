"""Channel files of our own: NPZ, written whole or not at all, and read back by ``sensing.files``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike

from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError


def check_npz(path: Path) -> None:
    """Raise an error where the name says that the file is not to be NPZ."""
    if path.suffix.lower() != ".npz":
        raise InputError(
            f"gains are written as NPZ; call the file {path.with_suffix('.npz').name!r} instead of {path.name!r}"
        )


def write_npz(path: Path, arrays: Mapping[str, ArrayLike], meta: Mapping[str, Any] | None = None) -> None:
    """Write named arrays and, as a JSON text called ``meta``, what describes them.

    The keys that are read back are listed in :mod:`wirelessagent.sensing.files` and
    :mod:`wirelessagent.sensing.file_metadata`. The same content gives the same bytes.

    Raises:
        InputError: the name does not end in .npz, the folder cannot be written to, or a value is not plain data.
    """
    path = Path(path)
    check_npz(path)
    content = {name: np.asarray(value) for name, value in arrays.items()}
    for name, array in content.items():
        if array.dtype.hasobject or name == "meta":
            raise InputError(f"{name!r} cannot be written as an array ({array.dtype}); give plain numbers or text")
    if meta is not None:
        try:
            content["meta"] = np.array(json.dumps(dict(meta), ensure_ascii=False, allow_nan=False))
        except (TypeError, ValueError) as error:
            raise InputError(f"meta must be values that JSON can hold: {error}") from error

    def write(stream: BinaryIO) -> None:
        np.savez(stream, **content)  # pyright: ignore[reportArgumentType]  # its last parameter is a switch

    write_atomically(path, write)

"""HDF5 is read by a child process, since HDF5's own library ends its process on some damaged files.

The child runs :mod:`~wirelessagent.sensing.formats.h5py_adapter`, gets the file's bytes over a pipe and answers with
headers, then with plain arrays for which it is asked; never with a pickle. It sets its own limit of memory where the
system knows one; a request that takes too long ends it from here. One child serves one file.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError, WirelessAgentError
from wirelessagent.sensing.formats.contents import array_bytes, damaged

_LIMIT_S = 20.0
_SLOWEST_BYTES_PER_S = 4 * 2**20  # of the file; a busy machine of two cores unpacks 40 MiB/s
_ADAPTER = Path(__file__).with_name("h5py_adapter.py")
_CHILD = """
import json, runpy, sys
sys.path[:], adapter, *limits = json.loads(sys.argv[1])
runpy.run_path(adapter)["serve"](*limits)
"""
_READY = b'{"ready": true}\n'
_LINE_BYTES = 2**20  # a list of datasets may be this much longer than what is in them
_ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""NumPy's linear algebra, which is not needed here, else reserves memory for every core."""


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

    @classmethod
    def of(cls, answer: Mapping[str, Any]) -> Dataset:
        return cls(
            name=str(answer["name"]),
            shape=_shape(answer["shape"]),
            dtype=_dtype(answer["dtype"]),
            is_text=bool(answer["is_text"]),
            chunk_shape=_shape(answer["chunk_shape"]),
            is_outside=bool(answer["is_outside"]),
            dimensions=tuple(map(str, answer["dimensions"])),
            attributes=dict(answer["attributes"]),
        )


@dataclass(frozen=True, kw_only=True)
class Listing:
    """A file's datasets in order, and the attributes of the file as a whole."""

    datasets: tuple[Dataset, ...]
    attributes: Mapping[str, Any]


class Hdf5Process:
    """A child that reads HDF5. Each request may take ``limit_s`` seconds, and more for a large file."""

    def __init__(self, max_bytes: int, *, limit_s: float = _LIMIT_S) -> None:
        self._max_bytes = max_bytes
        self._limit_s = limit_s
        self._is_late = False
        given = json.dumps([_paths(), str(_ADAPTER), max_bytes])
        try:
            self._child = subprocess.Popen(
                [sys.executable, "-I", "-c", _CHILD, given],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                env={**os.environ, **_ONE_THREAD},
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except (OSError, ValueError) as error:
            raise WirelessAgentError(
                f"HDF5 is read by a second Python process, and {sys.executable!r} cannot be started: {error}"
            ) from error
        try:
            with self._limited():
                is_ready = self._line() == _READY
        except BaseException:
            self.close()
            raise
        if not is_ready:
            self.close()
            raise WirelessAgentError(
                "HDF5 is read by a second Python process, which does not start: check that "
                f"{sys.executable} -c 'import h5py' works"
            )

    def listing(self, data: bytes) -> Listing:
        """What is in a file."""
        self._limit_s += len(data) / _SLOWEST_BYTES_PER_S
        answer = self._asked({"file": len(data)}, data)
        return Listing(
            datasets=tuple(map(Dataset.of, answer["datasets"])),
            attributes=dict(answer["attributes"]),
        )

    def load(self, name: str) -> NDArray[Any]:
        """A dataset's values as stored; strings as an array of str."""
        return self._asked({"dataset": name})["array"]

    def close(self) -> None:
        """End the child, which has nothing to save."""
        self._child.kill()
        self._child.wait()
        for pipe in (self._child.stdin, self._child.stdout):
            assert pipe is not None
            try:
                pipe.close()
            except OSError:  # what was still to be sent
                continue

    def _asked(self, request: dict[str, Any], data: bytes = b"") -> dict[str, Any]:
        """The answer to a request; an array that follows it is under ``array``."""
        sink = self._child.stdin
        assert sink is not None
        with self._limited():
            try:
                sink.write(json.dumps({**request, "limit_s": self._limit_s}).encode() + b"\n")
                sink.write(data)
                sink.flush()
            except OSError:  # the child has gone, and the answer will say so
                pass
            line = self._line()
            answer: dict[str, Any] | None = json.loads(line) if line else None
            if answer is not None and "dtype" in answer:
                answer["array"] = self._array(_dtype(answer["dtype"]), _shape(answer["shape"]))
        if answer is None or answer.get("array", answer) is None:
            raise self._death()
        if "error" in answer:
            raise damaged("HDF5", str(answer["error"]))
        return answer

    def _line(self) -> bytes:
        """The next line of the child; nothing if it has gone."""
        source = self._child.stdout
        assert source is not None
        line = source.readline(_LINE_BYTES + self._max_bytes)
        return line if line.endswith(b"\n") else b""

    def _array(self, dtype: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any] | None:
        """The array that follows a line; None if the child has gone."""
        source = self._child.stdout
        assert source is not None
        size = array_bytes(shape, dtype.itemsize)
        if size > self._max_bytes:  # only a child gone astray says so
            self._child.kill()
            return None
        data = source.read(size)
        return np.frombuffer(data, dtype=dtype).reshape(shape) if len(data) == size else None

    @contextmanager
    def _limited(self) -> Generator[None]:
        """End the child where this takes too long."""

        def stop() -> None:
            self._is_late = True
            self._child.kill()

        timer = threading.Timer(self._limit_s, stop)
        timer.daemon = True
        timer.start()
        try:
            yield
        finally:
            timer.cancel()

    def _death(self) -> FileFormatError:
        code = self._child.wait()
        if self._is_late:
            return damaged("HDF5", f"reading it did not end within {self._limit_s:.0f} s")
        names = {-number.value: number.name for number in signal.Signals}
        return damaged("HDF5", f"HDF5's own library broke down over it, {names.get(code, f'exit code {code}')}")


def _paths() -> list[str]:
    """Where the child finds NumPy and h5py: where this process does, but never relative to the working folder."""
    return [*(path for path in sys.path if Path(path).is_absolute()), str(Path(np.__file__).parents[1])]


def _shape(lengths: Any) -> tuple[int, ...]:
    return tuple(int(length) for length in lengths)


def _dtype(described: Any) -> np.dtype[Any]:
    """An element type; JSON has made lists of the parts of a record."""
    return np.dtype(described if isinstance(described, str) else [tuple(part) for part in described])

"""What becomes of a file that is read, and a reader of HDF5 that serves many files, as one per file takes time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import wirelessagent as wa
from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats import hdf5_format
from wirelessagent.sensing.formats.hdf5_process import Hdf5Process


class LastingProcess(Hdf5Process):
    """Stays when a file is closed, unless it broke down."""

    def close(self) -> None:
        if self._child.poll() is not None:
            super().close()

    @classmethod
    @contextmanager
    def for_every_file(cls) -> Iterator[None]:
        """Let one process read all HDF5 files, and another after it when it has broken down."""
        kept: list[LastingProcess] = []

        def process(max_bytes: int, **options: Any) -> LastingProcess:
            if kept and kept[0]._child.poll() is not None:
                Hdf5Process.close(kept.pop())
            if not kept:
                kept.append(cls(max_bytes, **options))
            return kept[0]

        with patch.object(hdf5_format, "Hdf5Process", process):
            try:
                yield
            finally:
                for one in kept:
                    Hdf5Process.close(one)


def outcome(path: Path) -> tuple[str, str]:
    """ "read", "refused", "guarded" (refused, since HDF5's library broke down over it) or "fault", and the words."""
    try:
        gain = wa.read(path).sensed.gain
    except FileFormatError as error:
        words = str(error)
        if not words.startswith(f"{path}: ") or "\n" in words or len(words) > len(str(path)) + 500:
            return "fault", f"not one line that begins with the path: {words[:300]!r}"
        return ("guarded" if "broke down" in words or "did not end" in words else "refused"), words
    except Exception as error:  # noqa: BLE001  # that is what is looked for
        return "fault", f"{type(error).__name__}: {error}".replace("\n", " ")
    if not np.all(np.isnan(gain) | ((gain >= 0) & np.isfinite(gain))):
        return "fault", "gains that are none"
    return "read", "-"

"""The only door to Numba.

Numba keys its cache by the calling file alone: after an edit of an imported kernel, or with a newer wheel, it would
serve the old code. Here the cache lives in a private folder of the user, named by a hash of all kernel sources and
the Numba version, so that old code is never found. Where that folder cannot be written there is no cache; the shared
temporary folder is never used, because a cache is a pickle.

Kernels are plain functions on arrays in files named ``<algorithm>_kernel.py``, imported inside the method that uses
them. They release the GIL; fast-math is off.
"""

from __future__ import annotations

import functools
import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar, cast

import numba
import platformdirs
from numba.core import config as numba_config

P = ParamSpec("P")
R = TypeVar("R")


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function`` at its first call, cached per user and per version of the kernel sources."""
    folder = cache_folder(_sources_of(function))
    before: object = getattr(numba_config, "CACHE_DIR")  # noqa: B009  # Numba sets its configuration at run time
    setattr(numba_config, "CACHE_DIR", "" if folder is None else str(folder))  # noqa: B010
    try:
        decorate = numba.njit(nogil=True, cache=folder is not None, error_model="numpy")  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
        return cast("Callable[P, R]", decorate(function))
    finally:
        setattr(numba_config, "CACHE_DIR", before)  # noqa: B010


@functools.cache
def cache_folder(sources: tuple[Path, ...]) -> Path | None:
    """The private cache folder for kernels of these sources; None where it cannot be made, written or trusted."""
    try:
        folder = platformdirs.user_cache_path("wirelessagent") / "kernels" / _fingerprint(sources)
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if os.access(folder, os.W_OK | os.X_OK) and _is_private(folder):
            return folder
    except (OSError, RuntimeError):
        pass
    return None


def _is_private(folder: Path) -> bool:
    """Whether nobody else could have put files there; on systems without such permissions, yes."""
    if not hasattr(os, "getuid"):
        return True
    status = folder.stat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022


def _fingerprint(sources: tuple[Path, ...]) -> str:
    """A hash of the sources, of this door, of Numba's and of Python's version."""
    digest = hashlib.sha256(f"numba {numba.__version__} python {sys.version}".encode())
    for source in (Path(__file__), *sources):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _sources_of(function: Callable[..., object]) -> tuple[Path, ...]:
    """Every kernel source that ``function`` may call: its own file, and all kernels of its package and of ours."""
    own = Path(function.__code__.co_filename).resolve()
    depth = function.__module__.count(".")
    folders = {Path(__file__).resolve().parent, *([own.parents[depth - 1]] if depth else [])}
    kernels = {path for folder in folders for path in _kernels_below(folder)}
    return tuple(sorted({own, *kernels}))


@functools.cache
def _kernels_below(folder: Path) -> frozenset[Path]:
    return frozenset(folder.rglob("*_kernel.py"))

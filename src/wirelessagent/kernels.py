"""The only door to Numba.

Numba keys its cache by the calling file alone: after an edit of an imported kernel, or with a newer wheel, it would
serve the old code. Here the cache lives in a private folder of the user, named by a hash of all kernel sources and
the Numba version, so that old code is never found. Where that folder cannot be written, or others could write to it,
there is no cache; the shared temporary folder is never used, because a cache is a pickle.

Kernels are plain functions on arrays in files named ``<algorithm>_kernel.py``, imported inside the method that uses
them. They may import other kernels of their package, but no constants from elsewhere, which Numba would freeze. They
release the GIL; fast-math is off.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import logging
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba
import platformdirs
from numba.core import caching, config

P = ParamSpec("P")
R = TypeVar("R")

_numba: Any = numba  # Numba has no types of its own
_config: Any = config
_FunctionCache: Any = caching.FunctionCache

_log = logging.getLogger(__name__)
_compiling = logging.getLogger(f"{__name__}.compiling")
_lock = threading.Lock()


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function`` at its first call, cached per user and per version of the kernel sources.

    >>> import numpy as np
    >>> @kernel
    ... def total(values):
    ...     found = 0.0
    ...     for value in values:
    ...         found += value
    ...     return found
    >>> total(np.array([1.0, 2.0]))
    3.0
    """
    compiled: Any = _numba.njit(nogil=True, error_model="numpy")(function)
    folder = cache_folder(_sources_of(function))
    cache = None if folder is None else _cache_in(folder, function)
    if cache is not None and hasattr(compiled, "enable_caching"):  # a plain function where NUMBA_DISABLE_JIT is set
        compiled._cache = cache
    return cast("Callable[P, R]", compiled)


class _Cache(_FunctionCache):
    """Numba's cache, except that a file that cannot be read or written costs a compilation and not the answer."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            loaded = _FunctionCache.load_overload(self, sig, target_context)
        except Exception as error:  # noqa: BLE001  # a pickle that a crash cut short fails in any way
            _log.info("the kernel cache %s cannot be read and is made anew: %r", self.cache_path, error)
            with contextlib.suppress(OSError):
                self.flush()
            loaded = None
        if loaded is None:
            _say_compiling()
        return loaded

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            _FunctionCache.save_overload(self, sig, data)
        except OSError as error:
            _log.info("the kernel cache %s cannot be written: %r", self.cache_path, error)


@functools.cache
def _say_compiling() -> None:
    """Log, once in a process, that what comes now takes its time."""
    _compiling.info("compiling what this machine needs for the first time, which may take a minute")


def _cache_in(folder: Path, function: Callable[..., object]) -> _Cache | None:
    """A cache of ``function`` in ``folder``; None where Numba would put it anywhere else.

    Numba reads its setting while the cache is made, so that is when it must point to the folder.
    """
    with _lock:
        before = _config.CACHE_DIR
        _config.CACHE_DIR = str(folder)
        try:
            cache = _Cache(function)
        except (OSError, RuntimeError):  # no place that can be written, or no source file
            return None
        finally:
            _config.CACHE_DIR = before
    return cache if Path(str(cache.cache_path)).is_relative_to(folder) else None


@functools.cache
def cache_folder(sources: tuple[Path, ...]) -> Path | None:
    """The private cache folder for kernels of these sources; None where it cannot be made, written or trusted."""
    try:
        home = platformdirs.user_cache_path("wirelessagent")
        folder = home / "kernels" / _fingerprint(sources)
        for part in (home, home / "kernels", folder):
            part.mkdir(mode=0o700, parents=True, exist_ok=True)
            if not _is_private(part):
                _log.warning("others can write to %s, so no kernels are cached there: chmod 700 it", part)
                return None
        return folder if os.access(folder, os.W_OK | os.X_OK) else None
    except (OSError, RuntimeError) as error:
        _log.info("no kernels are cached: %r", error)
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
        content = source.read_bytes()
        digest.update(f"{source.name} {len(content)} ".encode() + content)
    return digest.hexdigest()[:16]


def _sources_of(function: Callable[..., object]) -> tuple[Path, ...]:
    """Every kernel source that ``function`` may call: its own file, and all kernels of its package and of ours."""
    own = Path(function.__code__.co_filename).resolve()
    depth = min(function.__module__.count("."), len(own.parents))
    beside = _kernels_below(own.parents[depth - 1]) if depth else frozenset(own.parent.glob("*_kernel.py"))
    return tuple(sorted({own, *beside, *_kernels_below(Path(__file__).resolve().parent)}))


@functools.cache
def _kernels_below(folder: Path) -> frozenset[Path]:
    return frozenset(folder.rglob("*_kernel.py"))

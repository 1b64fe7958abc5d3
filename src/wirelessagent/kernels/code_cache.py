"""Where machine code is kept: a private folder of the user, named by what the kernels are and not by where they lie.

Numba keys its cache by the calling file alone: after an edit of a kernel that is called from another file, or with a
newer wheel, it would serve the old code. Here the folder's name is a hash of all kernel sources, of the versions of
Numba and Python and of the processor, so that old code is never found, and a second checkout or environment of the same
version compiles nothing. A folder that cannot be written, or that others could write to, is no cache; the shared
temporary folder is never one, because a cache is a pickle.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import logging
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import platformdirs
from numba.core import caching, codegen, config, runtime
from numba.core.environment import Environment

_numba: Any = numba  # neither has types of its own
_codegen: Any = codegen
_config: Any = config
_runtime: Any = runtime
_Environment: Any = Environment
_FunctionCache: Any = caching.FunctionCache
_CompileResultCacheImpl: Any = caching.CompileResultCacheImpl

PACKAGE = Path(__file__).resolve().parent.parent
_log = logging.getLogger(__name__)


def cache_of(function: Callable[..., object]) -> CodeCache | None:
    """The cache of a kernel's machine code; None where it has no source file or no folder can be trusted."""
    if not Path(function.__code__.co_filename).is_file():
        return None
    folder = cache_folder(_sources_of(function))
    return None if folder is None else CodeCache(function, folder)


class _Place:
    """What Numba asks of a cache's place. The folder stands for the sources, so that they need no stamp."""

    def __init__(self, function: Callable[..., object], folder: Path) -> None:
        self._py_file = function.__code__.co_filename
        self._folder, self._line = folder, function.__code__.co_firstlineno

    def ensure_cache_path(self) -> None:
        self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        return str(self._folder)

    def get_source_stamp(self) -> str:
        return ""

    def get_disambiguator(self) -> str:
        return str(self._line)


class CodeCache(_FunctionCache):
    """Numba's cache, except that a file that cannot be read or written costs a compilation and not the answer."""

    def __init__(self, function: Callable[..., object], folder: Path) -> None:
        class Files(_CompileResultCacheImpl):
            def __init__(self, function: Any) -> None:
                self._lineno, self._locator = function.__code__.co_firstlineno, _Place(function, folder)
                name = f"{function.__module__}.{function.__qualname__}"
                self._filename_base = self.get_filename_base(name, getattr(sys, "abiflags", ""))

            def reduce(self, cres: Any) -> Any:
                *payload, environments = _CompileResultCacheImpl.reduce(self, cres)
                return *payload, [(one.globals["__name__"], one.consts, one.env_name) for one in environments]

            def rebuild(self, target_context: Any, payload: Any) -> Any:
                *payload, environments = payload
                payload = *payload, [_environment(*one) for one in environments]
                return _CompileResultCacheImpl.rebuild(self, target_context, payload)

        self._impl_class = Files
        self.folder = folder
        _FunctionCache.__init__(self, function)

    def has(self, signature: Any, target: Any) -> bool:
        """Whether machine code for a signature is there."""
        try:
            index = self._cache_file._load_index()
        except Exception:  # noqa: BLE001  # what cannot be read will be made anew by :meth:`load_overload`
            return False
        return self._index_key(signature, target.codegen()) in index

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The machine code for a signature; None where it is not there.

        Numba would load all that it can compile first, half a second; code that is made needs its runtime only.
        """
        try:
            _runtime.rtsys.initialize(target_context)
            return self._load_overload(sig, target_context)
        except Exception as error:  # noqa: BLE001  # a pickle that a crash cut short fails in any way
            _log.info("the kernel cache %s cannot be read and is made anew: %r", self.cache_path, error)
            with contextlib.suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            _FunctionCache.save_overload(self, sig, data)
        except OSError as error:
            _log.info("the kernel cache %s cannot be written: %r", self.cache_path, error)


def _environment(module: str, consts: list[Any], name: str) -> Any:
    """The constants of a function that a kernel was made from.

    Numba would import the function's module, which machine code has no use for; some bring half of SciPy.
    """
    found = _Environment._memo.get(name)
    if found is None:
        known = sys.modules.get(module)
        found = _Environment({"__name__": module} if known is None else vars(known))
        found.consts[:], found.env_name = consts, name
        _Environment._memo[name] = found
    return found


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
    """A hash of the sources, of how they are compiled and kept, of Numba's and Python's version, of the processor."""
    digest = hashlib.sha256(f"numba {_numba.__version__} python {sys.version} {_processor()}".encode())
    here = Path(__file__)
    for source in sorted((here, here.with_name("dispatcher.py"), *sources), key=lambda source: (source.name, source)):
        content = source.read_bytes()
        digest.update(f"{source.name} {len(content)} ".encode() + content)
    return digest.hexdigest()[:16]


@functools.cache
def _processor() -> str:
    """The processor that code is made for, as Numba would have it."""
    name = _config.CPU_NAME or _codegen.ll.get_host_cpu_name()
    return f"{name} {_config.CPU_FEATURES or _codegen.ll.get_host_cpu_features().flatten()}"


def _sources_of(function: Callable[..., object]) -> tuple[Path, ...]:
    """Every kernel source that ``function`` may call: its own file, and all kernels of its package and of ours."""
    own = Path(function.__code__.co_filename).resolve()
    depth = min(function.__module__.count("."), len(own.parents))
    beside = kernel_sources(own.parents[depth - 1]) if depth else frozenset(own.parent.glob("*_kernel.py"))
    return tuple({own, *beside, *kernel_sources(PACKAGE)})


@functools.cache
def kernel_sources(folder: Path) -> frozenset[Path]:
    """The kernel sources in a folder and below."""
    return frozenset(folder.rglob("*_kernel.py"))

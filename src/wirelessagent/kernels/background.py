"""The process in the background that compiles: asking for code, starting it, waiting for it, and its own work.

Whoever misses code leaves a note in the cache and starts the process, where none is at work. The process compiles what
the notes ask for, and then the rest of the set (:mod:`wirelessagent.operations.warm_up`). It holds a lock that the
operating system lets go however it ends, and the code that it made by then stays.
"""

from __future__ import annotations

import contextlib
import functools
import logging
import os
import pickle
import re
import subprocess
import sys
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from wirelessagent.kernels.code_cache import PACKAGE, cache_folder, kernel_sources
from wirelessagent.kernels.lock import Lock

LOOK_S = 0.5
"""How often a wait looks around."""

START_S = 60.0
"""How long a process waits before it starts a compiler again, and for the first signs of one."""

log = logging.getLogger("wirelessagent.kernels.compiling")
_started_at = -START_S


@dataclass(frozen=True)
class Made:
    """What machine code there is.

    Attributes:
        done: how many of this package's kernels have some.
        total: how many there are.
        folder: where it lies; None where it cannot be kept.
    """

    done: int
    total: int
    folder: Path | None


def made() -> Made:
    """What machine code there is of this package's kernels."""
    folder = _folder()
    return Made(0 if folder is None else len(list(folder.glob("*.nbi"))), _number_of_kernels(), folder)


def ask_for(function: Callable[..., object], signature: Any) -> None:
    """Leave a note of what is to be compiled first, and start the process that does it, where none is at work."""
    global _started_at
    folder = _folder()
    if folder is None:
        return
    note = pickle.dumps((f"{function.__module__}:{function.__qualname__}", signature))
    with contextlib.suppress(OSError):
        (folder / f"{sha256(note).hexdigest()[:16]}.wanted").write_bytes(note)
        if time.monotonic() - _started_at > START_S and _lock(folder).is_free:
            _started_at = time.monotonic()
            _start()


def _start() -> None:
    log.info("machine code for this computer is made in the background; until it is there, small work runs interpreted")
    quiet: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    if sys.platform == "win32":
        quiet["creationflags"] = subprocess.BELOW_NORMAL_PRIORITY_CLASS | subprocess.CREATE_NO_WINDOW
    path = os.pathsep.join(entry for entry in sys.path if entry)
    subprocess.Popen(
        [sys.executable, "-P", "-m", "wirelessagent", "warm-up", "--background"],
        env={**os.environ, "WIRELESSAGENT_COMPILE": "foreground", "PYTHONPATH": path},
        start_new_session=True,
        **quiet,
    )


def wait_for(is_there: Callable[[], bool]) -> None:
    """Wait for machine code, or until nobody is at work on it any more."""
    folder = _folder()
    if folder is None:
        return
    log.info("this work is large, so it waits for its machine code, which takes a minute or two")
    while not is_there() and (time.monotonic() - _started_at < START_S or not _lock(folder).is_free):
        now = made()
        log.debug("machine code", extra={"done": min(now.done, now.total - 1), "total": now.total})
        time.sleep(LOOK_S)
    log.debug("machine code", extra={"done": _number_of_kernels(), "total": _number_of_kernels()})


@contextmanager
def sole_compiler(*, wait: bool) -> Generator[bool]:
    """Be the one process that compiles; False where another is and it was not to be waited for."""
    folder = _folder()
    if folder is None:
        yield True
        return
    lock = _lock(folder)
    while not (held := lock.seize()) and wait:
        time.sleep(LOOK_S)
    try:
        yield held
    finally:
        lock.release()


def compile_requests() -> None:
    """Compile what the notes ask for, and take them away."""
    folder = _folder()
    for path in [] if folder is None else sorted(folder.glob("*.wanted")):
        try:
            name, signature = pickle.loads(path.read_bytes())
            resolve_name(name).compile(signature)
        except Exception as error:  # noqa: BLE001  # it is interpreted, and tells what is wrong when it is called
            log.info("machine code that %s asks for cannot be made: %r", path, error)
        path.unlink(missing_ok=True)


def _folder() -> Path | None:
    return cache_folder(tuple(kernel_sources(PACKAGE)))


def _lock(folder: Path) -> Lock:
    return Lock(folder / "compiling.lock")


@functools.cache
def _number_of_kernels() -> int:
    # What only training needs is compiled where that is run.
    sources = (one for one in kernel_sources(PACKAGE) if "training" not in one.parts)
    return sum(len(re.findall(r"^@kernel$", one.read_text("utf-8"), re.MULTILINE)) for one in sources)

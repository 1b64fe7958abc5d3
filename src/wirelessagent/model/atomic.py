"""Files that are written whole or not at all.

The content goes to a temporary file in the same folder, is flushed to the disk and then takes the name of the
target in one step, so that a reader sees the old file or the new one and never half of either.
"""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from wirelessagent.model.errors import InputError, WirelessAgentError


def write_atomically(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Let ``write`` fill the file ``path``; where anything fails, ``path`` is left as it was.

    A symbolic link is followed: its target is replaced, the link stays.

    Raises:
        InputError: the folder does not exist or cannot be written to, or ``path`` is no ordinary file.
        WirelessAgentError: the disk refused, for example because it is full.
    """
    target = writable_target(path)
    temporary = target.with_name(f".wirelessagent-{secrets.token_hex(8)}.part")
    try:
        stream = temporary.open("xb")
    except OSError as error:
        raise InputError(
            f"cannot write {path}: {error.strerror or error} in the folder {target.parent}; choose another one"
        ) from error
    try:
        with stream:
            write(stream)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(target)
    except OSError as error:
        raise WirelessAgentError(f"cannot write {path}: {error.strerror or error}; nothing was changed") from error
    finally:
        temporary.unlink(missing_ok=True)
    _flush_folder(target.parent)


def writable_target(path: Path) -> Path:
    """The file that ``path`` names, behind links, if one can stand there; an :class:`InputError` if none can.

    Long work calls this before it starts, so that a mistyped name is not found out at its end.
    """
    try:
        target = Path(os.path.realpath(path))
        if target.is_dir():
            raise InputError(f"cannot write {path}: it is a folder; name a file in it")
        if target.exists() and not target.is_file():
            raise InputError(f"cannot write {path}: it is not an ordinary file; name another one")
        if target.exists() and not os.access(target, os.W_OK):
            raise InputError(f"cannot write {path}: it is write-protected; name another file or allow writing")
        if not target.parent.is_dir():
            raise InputError(f"cannot write {path}: the folder {target.parent} does not exist; create it first")
    except (OSError, ValueError) as error:  # a name that is too long, or holds a NUL
        if isinstance(error, WirelessAgentError):
            raise
        raise InputError(f"cannot write {str(path)!r}: {error}; choose another name") from error
    return target


def _flush_folder(folder: Path) -> None:
    """Make the new name durable where the system can do that (POSIX); the file itself is complete either way."""
    if hasattr(os, "O_DIRECTORY"):
        with contextlib.suppress(OSError):
            descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
            try:
                os.fsync(descriptor)
            finally:
                os.close(descriptor)

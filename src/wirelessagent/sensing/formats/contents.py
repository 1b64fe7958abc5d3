"""What every format reader delivers: a file as a set of named arrays, known by their headers and read on demand.

A header is enough to choose an array and to refuse one that is too large or not made of numbers, so nothing is
unpacked before it was judged.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import FileFormatError, WirelessAgentError
from wirelessagent.sensing.wording import option

Kind: TypeAlias = Literal["real", "complex", "switches", "text", "refused"]
"""What an array holds. Refused is what is never loaded: pickled objects, cells, references, records."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One array in a file.

    Attributes:
        name: its name in the file; "" where the format has none.
        shape: its shape as it will be read.
        dtype: the type of its elements, in words.
        kind: what it holds.
        read: reads it; real and complex arrays come as numbers with NaN for what the format itself marks as missing,
            text as an array of str.
        axes: names of its axes in order where the file states them.
        units: its unit as the file states it, in free text.
        notes: what reading does to it that the user should know, as (label, text).
    """

    name: str
    shape: tuple[int, ...]
    dtype: str
    kind: Kind
    read: Callable[[], NDArray[Any]]
    axes: tuple[str, ...] = ()
    units: str = ""
    notes: Mapping[str, str] = field(default_factory=dict[str, str])

    def __str__(self) -> str:
        return f"{self.name or 'the matrix'} ({sizes(self.shape)}, {self.dtype})"


@dataclass(frozen=True, kw_only=True)
class Contents:
    """A file: its arrays, and what else it says of itself.

    Attributes:
        entries: every array, in the file's order.
        metadata: single values that the file states, by name, besides those in an array called ``meta``.
        notes: what was understood of the file as a whole, as (label, text).
        close: gives back what reading entries needs; after it no entry can be read. Leaving a ``with`` calls it.
    """

    entries: tuple[Entry, ...]
    metadata: Mapping[str, Any] = field(default_factory=dict[str, Any])
    notes: Mapping[str, str] = field(default_factory=dict[str, str])
    close: Callable[[], None] = lambda: None

    def __enter__(self) -> Contents:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def entry(self, name: str) -> Entry | None:
        """The array of this name; an error where two have it."""
        found = [entry for entry in self.entries if entry.name == name]
        if len(found) > 1:
            raise FileFormatError(f"holds {len(found)} arrays called {name!r}; keep one of them")
        return found[0] if found else None


def sizes(shape: tuple[int, ...]) -> str:
    """A shape in words.

    >>> sizes((8, 20)), sizes(())
    ('8 × 20', 'a single value')
    """
    return " × ".join(str(size) for size in shape) or "a single value"


def megabytes(size: int) -> str:
    """A size in bytes as people read it.

    >>> megabytes(268435456), megabytes(12)
    ('256 MiB', '12 bytes')
    """
    return f"{size} bytes" if size < 2**20 else f"{size / 2**20:.4g} MiB"


def check_size(what: str, size: int, max_bytes: int) -> None:
    """Refuse what would take more than ``max_bytes`` of memory."""
    if size > max_bytes:
        raise FileFormatError(
            f"{what} takes {megabytes(size)}, above the limit of {megabytes(max_bytes)}; "
            f"give a smaller file or {option('max_bytes', size)}"
        )


def array_bytes(shape: tuple[int, ...], itemsize: int) -> int:
    """The memory of an array, in Python's integers, which a hostile header cannot overflow."""
    size = itemsize
    for length in shape:
        size *= int(length)
    return size


def never_loaded(name: str, what: str) -> Callable[[], NDArray[Any]]:
    """A reader for what must not be read: it says why."""

    def refuse() -> NDArray[Any]:
        raise FileFormatError(
            f"{name!r} is {what}, which is never loaded because it can run code or holds no plain numbers; "
            "save it as a plain numeric array"
        )

    return refuse


@contextmanager
def decoding(form: str) -> Generator[None]:
    """Turn whatever a parser of foreign bytes raises into one clear error, and keep its warnings to ourselves."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except WirelessAgentError:
        raise
    except Exception as error:  # damaged bytes make foreign parsers fail in any way
        raise damaged(form, f"{type(error).__name__}: {' '.join(str(error).split()):.160}") from error


def damaged(form: str, reason: str) -> FileFormatError:
    """The error for a file that is not what its format wants."""
    return FileFormatError(f"cannot be read as {form}: it is damaged or cut short ({reason}); copy or write it again")


_KINDS: dict[str, Kind] = {
    "f": "real", "i": "real", "u": "real", "c": "complex", "b": "switches", "U": "text", "S": "text"
}  # fmt: skip


def kind_of(dtype: np.dtype[Any]) -> Kind:
    """What an array of this element type holds."""
    return _KINDS.get(dtype.kind, "refused")

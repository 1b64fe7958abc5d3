"""Which of a file's arrays holds the gains."""

from __future__ import annotations

import math

from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import Contents, Entry
from wirelessagent.sensing.wording import option

COMPANIONS = (
    "truth", "noise_variance", "gain_variance", "repaired", "user_names", "subcarrier_frequencies_hz", "slot_times_s",
    "meta",
)  # fmt: skip
"""Arrays that describe the gains, and are taken for them only when asked for by name."""


def choose(contents: Contents, key: str | None) -> tuple[Entry, str]:
    """The array of gains and why it is that one: asked for, called "gain", or the only one that can be it.

    Raises:
        FileFormatError: there is none, several are possible, or it does not hold numbers.
    """
    named = contents.entry("gain" if key is None else key)
    if named is not None:
        return _of_numbers(named), "by its name" if key is None else "as asked for"
    if key is not None:
        raise FileFormatError(f"has no array called {key!r}; it holds {listed(contents.entries)}")
    others = tuple(entry for entry in contents.entries if entry.name not in COMPANIONS)
    numeric = tuple(entry for entry in others if entry.kind in ("real", "complex"))
    matrices = tuple(entry for entry in numeric if len(entry.shape) in (2, 3) and math.prod(entry.shape) > 1)
    candidates = matrices or numeric or others
    if not candidates:
        raise FileFormatError(f"holds no array of gains; it holds {listed(contents.entries)}")
    first = candidates[0]
    if len(candidates) > 1:
        raise FileFormatError(
            f"holds several arrays and none is called 'gain': {listed(candidates)}; "
            f"say which one, for example {option('key', first.name)}"
        )
    return _of_numbers(first), "the only one" if len(others) == 1 else "the only numeric matrix"


def _of_numbers(entry: Entry) -> Entry:
    if entry.kind == "refused":
        entry.read()  # says why
    if entry.kind in ("text", "switches"):
        raise FileFormatError(f"{entry} holds {entry.kind} where gains are expected; save the gains as numbers")
    return entry


def listed(entries: tuple[Entry, ...]) -> str:
    """Arrays in words, at most ten of them."""
    more = f" and {len(entries) - 10} more" if len(entries) > 10 else ""
    return (", ".join(str(entry) for entry in entries[:10]) or "nothing") + more

"""The arrays beside the gains that our own files hold: truth, variances, user names, frequencies, slot times."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.errors import FileFormatError
from wirelessagent.sensing.formats.contents import Contents, Entry, Kind, sizes
from wirelessagent.sensing.wording import counted, whole_characters


def truth_of(
    contents: Contents,
    source: Entry,
    gain: FloatArray,
    estimated: BoolArray | None,
    as_gain: Callable[[NDArray[Any]], FloatArray],
) -> tuple[FloatArray | None, str]:
    """The true channel, if the file knows it, and how: an array ``truth``, else complete gains that were measured."""
    stored = _like(contents, "truth", source, ("real", "complex"))
    if stored is not None:
        truth = as_gain(stored)
        missing = int(np.isnan(truth).sum())
        if missing:
            raise FileFormatError(
                f"its truth has {counted(missing, 'missing entry', 'missing entries')}; the truth must be complete"
            )
        return truth, "from the file's array 'truth'"
    if estimated is not None:
        marked = counted(int(estimated.sum()), "entry is", "entries are")
        return None, f"not known: {marked} marked as repaired, so not measured"
    missing = int(np.isnan(gain).sum())
    if missing:
        return None, f"not known: {counted(missing, 'entry is', 'entries are')} missing"
    return gain, "the gains are complete; as measured, they are taken as the truth"


def estimated_of(
    contents: Contents, source: Entry, arranged: Callable[[NDArray[Any]], NDArray[Any]]
) -> BoolArray | None:
    """True where the gain is the estimate of an earlier repair; None if none of them is."""
    stored = _like(contents, "repaired", source, ("switches", "real"))
    if stored is None:
        return None
    if not np.all((stored == 0) | (stored == 1)):
        raise FileFormatError("its repaired has entries that are neither 0 nor 1; write 1 where a gain was repaired")
    estimated = arranged(stored) == 1
    return estimated if estimated.any() else None


def noise_variance_of(
    contents: Contents, source: Entry, is_linear: bool, arranged: Callable[[NDArray[Any]], NDArray[Any]]
) -> tuple[FloatArray | None, str]:
    """The variance of each gain's error: of the measurement or, in a repaired file, of the estimate."""
    for name in ("noise_variance", "gain_variance"):
        entry = contents.entry(name)
        if entry is None or source.name != "gain":
            continue
        if not is_linear:
            return None, f"{name} left out: it is not known in which unit it is"
        scalar = math.prod(entry.shape) == 1
        stored = _numbers(entry) if scalar else _like(contents, name, source, ("real",))
        if stored is None:
            continue
        variance = stored.astype(np.float64)
        if not np.all((variance >= 0) & (variance < np.inf) | np.isnan(variance)):
            raise FileFormatError(f"its {name} has negative or infinite entries; a variance is finite and zero or more")
        return variance.reshape(()) if scalar else arranged(variance), f"from the file's array {name!r}"
    return None, ""


def user_names_of(contents: Contents, num_users: int) -> tuple[str, ...]:
    """The users' names; none if the file has none that can be read."""
    entry = contents.entry("user_names")
    if entry is None or entry.kind != "text":
        return ()
    names = tuple(whole_characters(str(name)) for name in entry.read().reshape(-1))
    if len(names) != num_users:
        raise FileFormatError(f"has {len(names)} user names for {num_users} users; give one name per user")
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise FileFormatError(f"two users are called {twice[0]!r}; give each user its own name")
    return names


def axis_values_of(contents: Contents, name: str, size: int) -> FloatArray | None:
    """A number for each step along an axis: subcarrier frequencies or slot times."""
    entry = contents.entry(name)
    if entry is None or entry.kind != "real":
        return None
    if math.prod(entry.shape) != size:
        raise FileFormatError(f"its {name} holds {sizes(entry.shape)} values where {size} are expected")
    return _numbers(entry).astype(np.float64).reshape(-1)


def _like(contents: Contents, name: str, source: Entry, kinds: tuple[Kind, ...]) -> NDArray[Any] | None:
    """An array that describes the gains entry by entry; None if the file has none for this array."""
    entry = contents.entry(name)
    if entry is None or entry.kind not in kinds or source.name != "gain":
        return None
    if entry.shape != source.shape:
        raise FileFormatError(
            f"its {name} has the shape {sizes(entry.shape)}, its gain {sizes(source.shape)}; they must be the same"
        )
    return entry.read()


def _numbers(entry: Entry) -> NDArray[Any]:
    if entry.kind != "real":
        raise FileFormatError(f"{entry} must hold real numbers")
    return entry.read()

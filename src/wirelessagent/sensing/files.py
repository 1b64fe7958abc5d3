"""The data unifier: a matrix of channel gains from a file in any usual format.

| format | where the gains are |
|---|---|
| CSV | one line per user; see :mod:`~wirelessagent.sensing.formats.csv_format` for headers, names and slots |
| JSON | nested lists, or an object with them |
| NPZ, NPY | an array; never a pickle |
| MATLAB v5 and v7.3, HDF5, netCDF-4 | a numeric variable |

Of several arrays the one called ``gain`` is taken. Beside it may stand ``truth``, ``noise_variance`` (or, from a
repair, ``gain_variance`` and ``repaired``), ``user_names``, ``subcarrier_frequencies_hz``, ``slot_times_s``, and the
metadata of :mod:`~wirelessagent.sensing.file_metadata`. What was understood is in the scene's facts.

No file, whatever its bytes, ends or hangs the process: sizes are judged before memory is taken, HDF5 is read by a child
(:mod:`~wirelessagent.sensing.formats.hdf5_process`), and what is no ordinary file is not opened.
"""

from __future__ import annotations

import functools
import os
import stat
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import FloatArray, positive
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import FileFormatError, InputError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import human
from wirelessagent.sensing.array_choice import COMPANIONS, choose, listed
from wirelessagent.sensing.axes import Axes
from wirelessagent.sensing.companions import (
    axis_values_of,
    estimated_of,
    noise_variance_of,
    truth_of,
    user_names_of,
)
from wirelessagent.sensing.file_metadata import (
    metadata_of,
    stated_cell,
    stated_frequencies_hz,
    stated_slot_times_s,
    states_noise,
)
from wirelessagent.sensing.formats.contents import Contents, Entry, check_size
from wirelessagent.sensing.formats.signature import Format, recognise
from wirelessagent.sensing.gains import Scale, Unit, doubt, missing_fact, range_fact, shape_fact
from wirelessagent.sensing.source import ChannelSource
from wirelessagent.sensing.wording import one_line, whole_characters

_CHUNK_BYTES = 2**20


@dataclass(frozen=True, kw_only=True)
class File(ChannelSource):
    """Channel gains from a file: CSV, JSON, NPZ, NPY, MATLAB, HDF5 or netCDF-4.

    Attributes:
        path: the file with the gains; an ordinary one.
        unit: what its numbers are: "linear" power gain, power gain in "db", or "complex" for coefficients h whose
            squared magnitude is taken; if not set what the file states, else linear. Complex numbers are always
            coefficients.
        axes: names of the array's axes in order, of drop, slot, user and subcarrier, as in "subcarrier,user"; if not
            set what the file states, else user,subcarrier or slot,user,subcarrier.
        missing_value: a number that marks missing entries, beside NaN and what the format itself has for that.
        key: name of the array; if not set ``gain``, else the only one that can be meant.
        drop: which of several independent drops to take, counted from 0.
        max_bytes: limit on the file's size and on what it unpacks to.
    """

    name = "file"

    path: Path
    unit: Unit | None = None
    axes: str | None = None
    missing_value: float | None = None
    key: str | None = None
    drop: int = 0
    max_bytes: int = 256 * 2**20

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", Path(self.path))
        if isinstance(self.unit, str):
            object.__setattr__(self, "unit", self.unit.lower())
        if self.unit is not None and self.unit not in get_args(Unit):
            raise InputError(f"unit must be one of {', '.join(get_args(Unit))}; got {self.unit!r}")
        if self.axes is not None:
            Axes.parse(self.axes, "as given")
        if self.drop < 0:
            raise InputError(f"drop counts from 0; got {self.drop}")
        positive("max_bytes", self.max_bytes)

    def num_drops(self) -> int:
        """How many independent drops the file holds, 1 where it has no such axis.

        Raises:
            FileFormatError: the file cannot be read or does not hold gains; the message begins with its path.
        """
        try:
            data = read_bounded(self.path, self.max_bytes)
            with recognise(data, self.path.suffix).read(data, max_bytes=self.max_bytes) as contents:
                entry, _ = choose(contents, self.key)
                axes = self._axes(contents, entry)
        except InputError as error:
            raise FileFormatError(f"{self.path}: {one_line(str(error))}") from error
        return entry.shape[axes.names.index("drop")] if "drop" in axes.names else 1

    def _axes(self, contents: Contents, entry: Entry) -> Axes:
        """The axes of the gains: as given, else as the file has them."""
        given = None if self.axes is None else Axes.parse(self.axes, "as given")
        return Axes.of(entry, given, metadata_of(contents).get("axes"))

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        """The gains in the file as measured; bandwidth and noise of ``cell`` give way to what the file states.

        A file has no chance in it: ``seed`` changes nothing.

        Raises:
            FileFormatError: the file cannot be read or does not hold gains; the message begins with its path.
        """
        try:
            return self._scene(cell)
        except InputError as error:
            raise FileFormatError(f"{self.path}: {one_line(str(error))}") from error

    def _scene(self, cell: Cell) -> Scene:
        data = read_bounded(self.path, self.max_bytes)
        form = recognise(data, self.path.suffix)
        with form.read(data, max_bytes=self.max_bytes) as contents:
            return self._understood(cell, form, contents)

    def _understood(self, cell: Cell, form: Format, contents: Contents) -> Scene:
        metadata = metadata_of(contents)
        entry, reason = choose(contents, self.key)
        axes = self._axes(contents, entry)
        values = entry.read()
        stated_unit = entry.units or str(metadata.get("units", ""))
        scale = Scale.of(values, self.unit, stated_unit, self.missing_value)
        arranged = functools.partial(axes.arranged, drop=self.drop)
        gain = scale.gain(arranged(values))
        if np.isnan(gain).all():
            raise FileFormatError(f"has no gain at all: all {gain.size} entries are missing")
        facts = {
            "format": _format_fact(form, self.path),
            **contents.notes,
            "array": f"{entry} ({reason})",
            **entry.notes,
            "axes": _axes_fact(axes, entry, self.drop) + axes.doubt(gain),
            "shape": shape_fact(gain),
            "unit": str(scale),
            "missing": missing_fact(gain, self.missing_value),
            "range": range_fact(gain),
        }
        unused = tuple(other for other in contents.entries if other is not entry and not _is_used(other))
        if unused:
            facts["not used"] = listed(unused)
        cell = stated_cell(cell, metadata, facts)
        if not states_noise(metadata) and (question := doubt(gain, scale)):
            facts["check"] = question
        sensed = _observation(contents, entry, gain, scale, arranged, cell, metadata, facts)
        truth, facts["truth"] = truth_of(
            contents, entry, gain, sensed.estimated, lambda stored: scale.gain(arranged(stored))
        )
        facts = {label: whole_characters(text) for label, text in facts.items()}
        return Scene(cell=cell, sensed=sensed, truth=truth, facts=facts)


def read(path: Path | str, cell: Cell | None = None, **options: Any) -> Scene:
    """The scene in a file; ``options`` are the fields of :class:`File`.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "gains.csv"
    ...     _ = path.write_text("-80,-90,\\n-85,NaN,-100\\n")
    ...     scene = read(path, unit="db")
    >>> scene.sensed.gain[0, :2]
    array([1.e-08, 1.e-09])
    >>> scene.facts["missing"]
    '2 of 6 entries (33.3 %)'
    """
    return File(path=Path(path), **options).observe(Cell() if cell is None else cell)


def read_bounded(path: Path, max_bytes: int) -> bytes:
    """An ordinary file's bytes, never more than ``max_bytes`` of them; others might never end, or never begin."""
    chunks: list[bytes] = []
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise FileFormatError("is a folder; name a file in it")
        if not stat.S_ISREG(mode):
            kind = "a pipe" if stat.S_ISFIFO(mode) else "a socket" if stat.S_ISSOCK(mode) else "a device"
            raise FileFormatError(f"is {kind} and not an ordinary file; save the gains to a file and name that")
        with path.open("rb") as stream:
            size = os.fstat(stream.fileno()).st_size
            while size <= max_bytes and (chunk := stream.read(_CHUNK_BYTES)):
                chunks.append(chunk)
                size = max(size, sum(map(len, chunks)))
    except FileNotFoundError as error:
        raise FileFormatError("there is no such file; check the path") from error
    except FileFormatError:
        raise
    except (OSError, ValueError) as error:
        raise FileFormatError(f"cannot be opened: {error}; check its permissions") from error
    check_size("the file", size, max_bytes)
    return b"".join(chunks)


def _observation(
    contents: Contents,
    entry: Entry,
    gain: FloatArray,
    scale: Scale,
    arranged: Callable[[NDArray[Any]], NDArray[Any]],
    cell: Cell,
    metadata: Mapping[str, Any],
    facts: dict[str, str],
) -> ChannelObservation:
    """The gains with all that the file says of users, subcarriers, slots and errors."""
    num_slots = gain.shape[0] if gain.ndim == 3 else 1
    names = user_names_of(contents, gain.shape[-2])
    if names:
        facts["users"] = ", ".join(names[:8]) + (" …" if len(names) > 8 else "")
    variance, origin = noise_variance_of(contents, entry, scale.unit == "linear", arranged)
    if origin:
        facts["noise variance"] = origin
    frequencies_hz = axis_values_of(contents, "subcarrier_frequencies_hz", gain.shape[-1])
    if frequencies_hz is None:
        frequencies_hz = stated_frequencies_hz(cell, metadata, gain.shape[-1])
    if frequencies_hz is not None:
        facts["frequencies"] = f"{frequencies_hz[0] / 1e6:.10g} to {frequencies_hz[-1] / 1e6:.10g} MHz"
    times_s = axis_values_of(contents, "slot_times_s", num_slots)
    if times_s is None and gain.ndim == 3:
        times_s = stated_slot_times_s(metadata, num_slots)
    if times_s is not None and num_slots > 1:
        facts["slot times"] = f"{human(times_s[0], 's')} to {human(times_s[-1], 's')}"
    return ChannelObservation(
        gain=gain,
        noise_variance=variance,
        estimated=estimated_of(contents, entry, arranged),
        user_names=names,
        subcarrier_frequencies_hz=frequencies_hz,
        slot_times_s=times_s,
    )


def _format_fact(form: Format, path: Path) -> str:
    if path.suffix.lower() in form.suffixes:
        return form.name
    return f"{form.name}, judged by its content; the name ends in {path.suffix or 'nothing'}"


def _axes_fact(axes: Axes, entry: Entry, drop: int) -> str:
    if "drop" not in axes.names:
        return str(axes)
    drops = entry.shape[axes.names.index("drop")]
    return f"{axes}; drop {drop} of {drops}, counted from 0"


def _is_used(entry: Entry) -> bool:
    return entry.name in COMPANIONS and entry.kind != "refused"

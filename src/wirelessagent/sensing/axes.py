"""The axes of a stored array: their names in order, and who said so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import FileFormatError, InputError
from wirelessagent.sensing.formats.contents import Entry
from wirelessagent.sensing.wording import option

AXES = ("drop", "slot", "user", "subcarrier")
"""Axes in the library's order. Drops are independent draws of a cell and no history of each other."""

_ASSUMED = f"assumed; others are named with {option('axes', '…')}"

_USUAL = {2: ("user", "subcarrier"), 3: ("slot", "user", "subcarrier")}


@dataclass(frozen=True, kw_only=True)
class Axes:
    """The names of an array's axes in order, and where they come from."""

    names: tuple[str, ...]
    origin: str

    @classmethod
    def parse(cls, text: str, origin: str) -> Axes:
        """Axes from a text such as "slot,user,subcarrier".

        Raises:
            InputError: a name is unknown or stands twice, or user or subcarrier is not there.
        """
        names = tuple(part.strip().lower() for part in text.split(","))
        for name in names:
            if name not in AXES:
                raise InputError(
                    f"unknown axis {name!r} in axes={text!r} ({origin}); known are {', '.join(AXES)}, "
                    "to be given in the array's order"
                )
            if names.count(name) > 1:
                raise InputError(f"axis {name!r} stands twice in axes={text!r} ({origin}); name each axis once")
        if not {"user", "subcarrier"} <= set(names):
            raise InputError(f"axes={text!r} ({origin}) must name both user and subcarrier")
        return cls(names=names, origin=origin)

    @classmethod
    def of(cls, entry: Entry, given: Axes | None, stated: object) -> Axes:
        """The axes of an array: given by the user, else stated in the file, else the usual ones.

        Raises:
            FileFormatError: it does not have that many dimensions, or one of them is empty.
        """
        dimensions = len(entry.shape)
        if 0 in entry.shape:
            raise FileFormatError(f"{entry} is empty; it must hold at least one user and one subcarrier")
        axes = given
        if axes is None and isinstance(stated, str):
            axes = cls.parse(stated, "from the file's metadata")
        if axes is None and {"user", "subcarrier"} <= set(entry.axes) <= set(AXES):
            axes = cls.parse(",".join(entry.axes), "from the file")
        if axes is None and dimensions in _USUAL:
            axes = cls(names=_USUAL[dimensions], origin=_ASSUMED)
        if axes is None:
            raise FileFormatError(
                f"{entry} has {dimensions} dimension{'' if dimensions == 1 else 's'}; it must have two "
                "(user, subcarrier) or three (slot, user, subcarrier)"
            )
        if len(axes.names) != dimensions:
            raise FileFormatError(
                f"{entry} has {dimensions} dimensions, but {len(axes.names)} axes are named: "
                f"{','.join(axes.names)} ({axes.origin}); give the axes of this array with {option('axes', '…')}"
            )
        return axes

    def arranged(self, array: NDArray[Any], drop: int) -> NDArray[Any]:
        """The array as (user, subcarrier) or (slot, user, subcarrier), with one drop chosen.

        Raises:
            InputError: there is no such drop.
        """
        turned = array.transpose([self.names.index(name) for name in self._order])
        drops = len(turned) if "drop" in self.names else 1
        if drop >= drops:
            raise InputError(f"there is no drop {drop}; the file has {drops}, counted from 0")
        return turned[drop] if "drop" in self.names else turned

    @property
    def _order(self) -> tuple[str, ...]:
        return tuple(name for name in AXES if name in self.names)

    def doubt(self, gain: FloatArray) -> str:
        """A question where axes that nobody stated make more users than subcarriers of ``gain``; else nothing."""
        if self.origin != _ASSUMED or gain.shape[-2] <= gain.shape[-1]:
            return ""
        other = ",".join((*self.names[:-2], "subcarrier", "user"))
        return f"; more users than subcarriers: is it transposed? Then say {option('axes', other)}"

    def __str__(self) -> str:
        turned = "" if self._order == self.names else f", turned to {', '.join(self._order)}"
        return f"{', '.join(self.names)} ({self.origin}){turned}"

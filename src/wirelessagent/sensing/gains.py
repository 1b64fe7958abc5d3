"""From stored numbers to linear power gains: unit, missing entries, and what no gain can be."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.errors import FileFormatError
from wirelessagent.model.units import db, from_db
from wirelessagent.sensing.wording import counted, option

Unit: TypeAlias = Literal["linear", "db", "complex"]

UNITS: dict[Unit, str] = {
    "linear": "linear power gain",
    "db": "dB, converted to linear power gain",
    "complex": "channel coefficients h, taken as power gain |h|²",
}


@dataclass(frozen=True, kw_only=True)
class Scale:
    """How stored numbers become gains.

    Attributes:
        unit: what the numbers are.
        origin: who said so; "assumed" if nobody did.
        missing_value: a number that means "missing" beside NaN; None if there is none.
    """

    unit: Unit
    origin: str
    missing_value: float | None

    @classmethod
    def of(cls, values: NDArray[Any], given: Unit | None, stated: str, missing_value: float | None) -> Scale:
        """The unit as given or, if None is given, as stated in the file; complex numbers are always coefficients.

        Raises:
            FileFormatError: given and stated unit contradict each other, or the stated one is a power such as dBm.
        """
        decibels = re.search(r"\bdB(\w*)", stated)
        says_linear = "linear" in stated.lower()
        says_db = decibels is not None and not says_linear
        if values.dtype.kind == "c":
            unit, origin = "complex", "the numbers are complex"
        elif given is None:
            if decibels is not None and says_db and decibels[1]:
                raise FileFormatError(
                    f"says that its unit is {stated!r}, which is no power gain; "
                    f"convert it to gains, or take the numbers as dB with {option('unit', 'db')}"
                )
            origin = f"the file says {stated!r}" if says_db or says_linear else "assumed"
            unit = "db" if says_db else "linear"
        else:
            unit, origin = given, f"unit={given}"
        if given == "db" and unit == "complex":
            raise FileFormatError(f"holds complex numbers, which no values in dB are; leave out {option('unit', 'db')}")
        if given == "linear" and says_db:
            raise FileFormatError(f"says that its unit is {stated!r}; read it with {option('unit', 'db')}")
        return cls(unit=unit, origin=origin, missing_value=missing_value)

    def missing(self, values: NDArray[Any]) -> BoolArray:
        """True where the stored value is NaN or the missing value, as written in the array's own precision."""
        missing: BoolArray = np.isnan(values)
        if self.missing_value is not None:
            mark = np.asarray(self.missing_value)
            if values.dtype.kind in "fc":
                with np.errstate(over="ignore"):
                    mark = mark.astype(values.dtype)
            missing |= values == mark
        return missing

    def gain(self, values: NDArray[Any]) -> FloatArray:
        """Linear power gains, NaN where missing; ``values`` is (user, subcarrier) or (slot, user, subcarrier).

        −∞ dB is a gain of zero.

        Raises:
            FileFormatError: a value that no power gain can have, with its place.
        """
        missing = self.missing(values)
        with np.errstate(over="ignore", invalid="ignore"):
            gain = np.where(missing, np.nan, self._linear(values))
            bad = np.argwhere(~missing & ~((gain >= 0) & (gain < np.inf)))
        if len(bad):
            raise FileFormatError(self._complaint(values, tuple(int(i) for i in bad[0]), len(bad)))
        return gain

    def _linear(self, values: NDArray[Any]) -> FloatArray:
        if self.unit == "db":
            return from_db(values.astype(np.float64))
        if self.unit == "complex":
            wide = values.astype(np.complex128)
            return wide.real**2 + wide.imag**2
        return values.astype(np.float64)

    def _complaint(self, values: NDArray[Any], index: tuple[int, ...], count: int) -> str:
        names = ("slot", "user", "subcarrier")[-len(index) :]
        place = ", ".join(f"{name} {i + 1}" for name, i in zip(names, index, strict=True))
        where = f"at {place} (counted from 1)" + (f" and {counted(count - 1, 'more place')}" if count > 1 else "")
        value = values[index]
        if self.unit == "linear" and np.isfinite(value):
            return (
                f"holds a negative gain, {value:g} {where}; "
                f"if it is in dB, give {option('unit', 'db')}; "
                f"if it marks a missing entry, give {option('missing_value', format(value, 'g'))}"
            )
        written = f"{value:g}{' dB' if self.unit == 'db' else ''}"
        return f"holds a gain that is infinite, {written} {where}; leave missing entries empty or write NaN"

    def __str__(self) -> str:
        return f"{UNITS[self.unit]} ({self.origin})"


def missing_fact(gain: FloatArray, missing_value: float | None) -> str:
    """How much is missing: in all, and in the current slot where there are several."""
    missing = np.isnan(gain)
    text = f"{missing.sum()} of {missing.size} entries ({100 * missing.mean():.3g} %)"
    if missing.ndim == 3 and len(missing) > 1:
        text += f", {missing[-1].sum()} of {missing[-1].size} in the current (last) slot"
    return text if missing_value is None else f"{text}; NaN and {missing_value:g} count as missing"


def range_fact(gain: FloatArray) -> str:
    """Smallest and largest gain in dB, and how many are exactly zero."""
    known = gain[~np.isnan(gain)]
    positive = known[known > 0]
    zeros = known.size - positive.size
    if not positive.size:
        return "the only known entry is zero" if zeros == 1 else f"all {zeros} known entries are zero"
    text = f"{float(db(positive.min())):.1f} to {float(db(positive.max())):.1f} dB"
    return f"{text}, and {counted(zeros, 'exact zero')}" if zeros else text


def doubt(gain: FloatArray, scale: Scale) -> str:
    """A question where gains are above 1, which no radio channel has, and nobody said linear; else nothing."""
    largest = float(np.nanmax(gain))
    if largest <= 1 or not (scale.unit == "db" or scale.origin == "assumed"):
        return ""
    snr = "Are they SNRs? State the noise power in the file"
    if scale.unit == "db":
        above = f"gains above 0 dB, up to {float(db(largest)):.4g} dB, are no power gains of a radio channel"
        return f"{above}. Are they losses? Write them negative. {snr}"
    above = f"gains above 1 (0 dB), up to {largest:g}, are no power gains of a radio channel"
    decibels = f"Are they in dB? Say {option('unit', 'db')}, with losses negative"
    return f"{above}. {decibels}. {snr}. If they are right, say {option('unit', 'linear')}"


def shape_fact(gain: FloatArray) -> str:
    """Slots, users and subcarriers in words."""
    axes = ("slot", "user", "subcarrier")[-gain.ndim :]
    return " × ".join(counted(size, axis) for size, axis in zip(gain.shape, axes, strict=True))

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
        origin: who said so.
        missing_value: a number that means "missing" beside NaN; None if there is none.
    """

    unit: Unit
    origin: str
    missing_value: float | None

    @classmethod
    def of(cls, values: NDArray[Any], given: Unit | None, stated: str, missing_value: float | None) -> Scale:
        """The unit as given or, if None is given, as stated in the file; complex numbers are always coefficients.

        Raises:
            FileFormatError: given and stated unit contradict each other.
        """
        says_db = re.search(r"\bdB", stated) is not None and "linear" not in stated.lower()
        if values.dtype.kind == "c":
            unit, origin = "complex", "the numbers are complex"
        elif given is None:
            unit, origin = ("db", f"the file says {stated!r}") if says_db else ("linear", "assumed")
        else:
            unit, origin = given, f"unit={given}"
        if given == "db" and unit == "complex":
            raise FileFormatError("holds complex numbers, which no values in dB are; leave unit=db out")
        if given == "linear" and says_db:
            raise FileFormatError(f"says that its unit is {stated!r}; read it with unit=db")
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
        where = f"at {place} (counted from 1)" + (f" and {count - 1} more places" if count > 1 else "")
        value = values[index]
        if self.unit == "linear" and np.isfinite(value):
            return (
                f"holds a negative gain, {value:g} {where}; "
                f"if it is in dB, give unit=db; if it marks a missing entry, give missing_value={value:g}"
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
        return f"all {zeros} known entries are zero"
    text = f"{float(db(positive.min())):.1f} to {float(db(positive.max())):.1f} dB"
    return f"{text}, and {zeros} exact zeros" if zeros else text


def shape_fact(gain: FloatArray) -> str:
    """Slots, users and subcarriers in words."""
    slots = f"{gain.shape[0]} slots × " if gain.ndim == 3 else ""
    return f"{slots}{gain.shape[-2]} users × {gain.shape[-1]} subcarriers"

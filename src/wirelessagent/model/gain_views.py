"""Gain matrices as people read them: their level in words, their entries as columns, and as matrices to be drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.shown import Picture
from wirelessagent.model.units import db


@dataclass(frozen=True, kw_only=True, eq=False)
class Matrix:
    """A matrix to be drawn, users over subcarriers or slots.

    Attributes:
        title: over it.
        values: shape (user, column), NaN = missing.
        x_label: what its columns are.
        colour_label: what its values are; gains are drawn in dB.
        marked: True for entries to be marked; None for none.
    """

    title: str
    values: FloatArray
    x_label: str = "Subcarrier"
    colour_label: str = "Power gain (dB)"
    marked: BoolArray | None = None

    @property
    def in_db(self) -> bool:
        return self.colour_label.endswith("(dB)")


def level(gain: FloatArray) -> str:
    """The mean gain, and those of the weakest and the strongest user, for gains (user, subcarrier) with NaN."""
    seen = gain[~np.isnan(gain).all(axis=1)]
    if not seen.size:
        return "nothing was observed"
    users = np.nanmean(seen, axis=1)
    levels = db(np.array([np.nanmean(seen), users.min(), users.max()], dtype=np.float64), floor_db=-400.0)
    mean, low, high = levels.tolist()
    return f"{mean:.1f} dB; of the users {low:.1f} to {high:.1f} dB"


def entries(user_names: tuple[str, ...], gain: FloatArray) -> dict[str, NDArray[Any]]:
    """Where each entry of gains (…, user, subcarrier) stands, in the order of ``gain.ravel()``.

    Slots, where there are several, and subcarriers are counted from 0 as in the arrays; users go by name.
    """
    places = np.indices(gain.shape).reshape(gain.ndim, -1)
    found = {"user": np.array(user_names)[places[-2]], "subcarrier": places[-1]}
    return {"slot": places[0], **found} if gain.ndim == 3 else found


def gains_picture(
    user_names: tuple[str, ...], slots: FloatArray, title: str, others: Mapping[str, FloatArray] | None = None
) -> Picture:
    """The current slot of gains (slot, user, subcarrier), ``others`` of that slot by their titles, and the history."""
    matrices = [Matrix(title=name, values=gain) for name, gain in {title: slots[-1], **(others or {})}.items()]
    if len(slots) > 1:
        seen = ~np.isnan(slots)
        with np.errstate(invalid="ignore"):  # nothing of a user in a slot is NaN
            mean: FloatArray = np.where(seen, slots, 0.0).sum(axis=2) / seen.sum(axis=2)
        matrices.append(Matrix(title="History: mean over the subcarriers", values=mean.T, x_label="Slot"))
    return Picture(kind="matrices", parts={"user_names": user_names, "matrices": tuple(matrices)})

"""Many decisions at once: for a scheduler with many cells or slots, or a study over many channels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray, frozen
from wirelessagent.model.cell import Cell
from wirelessagent.model.problem import Problem
from wirelessagent.model.shown import Shown, Summary
from wirelessagent.model.units import human, percent


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class BatchDecision(Shown):
    """The decisions for channels of shape (…, user, subcarrier); each field is that of :class:`.decision.Decision`.

    Attributes:
        owner: the user of each subcarrier, −1 for nobody, shape (…, subcarrier).
        power_w: radiated power on each subcarrier, shape (…, subcarrier).
        rate_bps: each user's predicted rate, shape (…, user).
        status: "optimal", "feasible", "infeasible" or "undecided", shape (…), an array of text.
        value: the objective's value, shape (…); NaN where nothing feasible was found.
        bound: the best value that any allocation can reach, shape (…).
        gap: \\|value − bound\\| / \\|bound\\|, shape (…).
        unit: the unit of ``value`` and ``bound``.
        problem: the problem solved on every channel, with its objective resolved.
        cell: the cell it was solved for.
    """

    owner: IntArray
    power_w: FloatArray
    rate_bps: FloatArray
    status: NDArray[np.str_]
    value: FloatArray
    bound: FloatArray
    gap: FloatArray
    unit: str
    problem: Problem
    cell: Cell

    def __post_init__(self) -> None:
        for name in ("owner", "power_w", "rate_bps", "status", "value", "bound", "gap"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    _derived: ClassVar[tuple[str, ...]] = ("is_usable", "total_power_w")

    def summary(self) -> Summary:
        statuses, counts = np.unique(self.status, return_counts=True)
        found = ", ".join(f"{count} {status}" for status, count in zip(statuses, counts, strict=True))
        shape = " × ".join(map(str, (*self.status.shape, *self.rate_bps.shape[-1:], *self.owner.shape[-1:])))
        objective, usable = self.problem.objective, self.is_usable
        rows = [("status", found)]
        if usable.any():
            value = float(np.mean(self.value[usable]))
            rows.append(
                ("value", f"{human(value, self.unit)} on average, gap at most {percent(float(self.gap[usable].max()))}")
            )
            rows.append(("power", f"{human(float(self.total_power_w[usable].mean()), 'W')} on average"))
        aim = objective if isinstance(objective, str) else objective.name
        title = f"BatchDecision: {aim} on {self.status.size} channels ({shape}: channel, user, subcarrier)"
        return Summary(title=title, rows=tuple(rows))

    def columns(self) -> Mapping[str, Any]:
        """One row for each channel, in the order of ``status.ravel()``."""
        names = ("status", "value", "bound", "gap", "total_power_w")
        return {name: np.ravel(getattr(self, name)) for name in names}

    @property
    def is_usable(self) -> BoolArray:
        """Whether each allocation keeps every constraint and may be applied, shape (…)."""
        return np.isin(self.status, ("optimal", "feasible"))

    @property
    def total_power_w(self) -> FloatArray:
        """Radiated power of each allocation, shape (…)."""
        return self.power_w.sum(axis=-1)

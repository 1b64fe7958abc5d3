"""Many decisions at once: for a scheduler with many cells or slots, or a study over many channels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray, frozen
from wirelessagent.model.cell import Cell
from wirelessagent.model.problem import Problem


@dataclass(frozen=True, kw_only=True, eq=False)
class BatchDecision:
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

    @property
    def is_usable(self) -> BoolArray:
        """Whether each allocation keeps every constraint and may be applied, shape (…)."""
        return np.isin(self.status, ("optimal", "feasible"))

    @property
    def total_power_w(self) -> FloatArray:
        """Radiated power of each allocation, shape (…)."""
        return self.power_w.sum(axis=-1)

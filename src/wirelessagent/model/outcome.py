"""What the base station did, read back."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.metrics import READ_BACK_TOLERANCE, LinkMetrics, kept


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """The state of the base station after it applied a decision.

    Attributes:
        base_station: registered name of the base station.
        owner: the user of each subcarrier as read back, −1 for nobody, shape (subcarrier,).
        power_w: radiated power on each subcarrier as read back, shape (subcarrier,).
        promised_bps: the rates that the decision committed the users to, shape (user,).
        achieved: metrics on the true channel; None where the base station cannot measure them.
        true_gain: the true channel where the base station knows it, shape (user, subcarrier).
        written_to: the file written, for base stations that write one.
    """

    base_station: str
    owner: IntArray
    power_w: FloatArray
    promised_bps: FloatArray
    achieved: LinkMetrics | None = None
    true_gain: FloatArray | None = None
    written_to: Path | None = None
    missed: BoolArray = field(init=False)
    """True for users whose true rate fell short of the commitment by more than 0.01 %, shape (user,); all False where
    it is not known."""

    def __post_init__(self) -> None:
        short = np.zeros(self.promised_bps.shape, dtype=bool)
        if self.achieved is not None:
            short = ~kept(self.achieved.user_rate_bps, self.promised_bps, READ_BACK_TOLERANCE)
        object.__setattr__(self, "missed", short)

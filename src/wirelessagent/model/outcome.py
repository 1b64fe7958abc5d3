"""What the base station did, read back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.metrics import READ_BACK_TOLERANCE, LinkMetrics, kept
from wirelessagent.model.shown import Picture, Shown, Summary
from wirelessagent.model.units import human


@dataclass(frozen=True, kw_only=True, repr=False)
class Outcome(Shown):
    """The state of the base station after it applied a decision.

    Attributes:
        base_station: registered name of the base station.
        owner: the user of each subcarrier as read back, −1 for nobody, shape (subcarrier,).
        power_w: radiated power on each subcarrier as read back, shape (subcarrier,).
        promised_bps: the rates that the decision committed the users to, shape (user,).
        achieved: metrics on the true channel; None where the base station cannot measure them.
        true_gain: the true channel where the base station knows it, shape (user, subcarrier).
        written_to: the file written, for base stations that write one.
        slack_bps: what each user's rate may be short of its promise without being missed, shape (user,): what a step of
            the base station's power setting is worth; None where it can set any power.
    """

    base_station: str
    owner: IntArray
    power_w: FloatArray
    promised_bps: FloatArray
    achieved: LinkMetrics | None = None
    true_gain: FloatArray | None = None
    written_to: Path | None = None
    slack_bps: FloatArray | None = None
    missed: BoolArray = field(init=False)
    """True for users whose true rate fell short of the commitment by more than the slack and 0.01 %, shape (user,); all
    False where
    it is not known."""

    def __post_init__(self) -> None:
        short = np.zeros(self.promised_bps.shape, dtype=bool)
        if self.achieved is not None:
            slack = 0.0 if self.slack_bps is None else self.slack_bps
            short = ~kept(self.achieved.user_rate_bps, self.promised_bps - slack, READ_BACK_TOLERANCE)
        object.__setattr__(self, "missed", short)

    def summary(self) -> Summary:
        used, size = int(np.count_nonzero(self.power_w > 0)), self.owner.size
        rows = [("power", f"{human(float(self.power_w.sum()), 'W')} on {used} of {size} subcarriers")]
        served = int(np.count_nonzero(self.promised_bps > 0))
        rows.append(("committed", f"{human(float(self.promised_bps.sum()), 'bit/s')} to {served} users"))
        if self.achieved is not None:
            rows.append(("achieved", human(self.achieved.sum_rate_bps, "bit/s")))
            rows.append(("missed", f"{int(self.missed.sum())} of {served} users fell short"))
        if self.written_to is not None:
            rows.append(("written to", str(self.written_to)))
        return Summary(title=f"Outcome of the base station {self.base_station}, read back", rows=tuple(rows))

    def picture(self) -> Picture:
        return Picture(kind="outcome", parts={"outcome": self})

    def columns(self) -> Mapping[str, Any]:
        """One row for each subcarrier, as read back."""
        return {"subcarrier": np.arange(self.owner.size), "owner": self.owner, "power_w": self.power_w}

"""P1 of the paper: the largest (weighted) sum rate."""

from __future__ import annotations

from dataclasses import dataclass

from wirelessagent.deciding.objectives.rate_utility import rate_conjugate
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases


@dataclass(frozen=True, kw_only=True)
class MaxRate(Objective):
    """The largest sum of the users' rates, Σ r; problem P1 of the paper. With weights, Σ ω r."""

    name = "max_rate"
    aliases = ("P1",)
    unit = "bit/s"
    phrases = phrases(
        en=["maximum rate", "highest throughput", "as fast as possible", "more speed"],
        zh=["最大速率", "最高吞吐量", "越快越好", "提高网速"],
    )

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        return rate_conjugate(price, min_rate, max_rate)

    def power_law(self) -> float:
        return 0.0

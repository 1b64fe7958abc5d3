"""P2 of the paper: the least radiated power that carries the promised rates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases


@dataclass(frozen=True, kw_only=True)
class MinPower(Objective):
    """The least radiated power, Σ p, that carries every promised rate; problem P2 of the paper."""

    name = "min_power"
    aliases = ("P2",)
    unit = "W"
    direction = "min"
    measure = "power"
    phrases = phrases(
        en=["minimum power", "save power", "as little power as possible", "lowest transmit power"],
        zh=["最小功率", "省电", "降低功耗", "节省功率"],
    )

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.zeros(rate.shape)  # rates beyond the promised ones are worth nothing

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        rate = np.broadcast_to(min_rate, np.broadcast_shapes(price.shape, min_rate.shape, max_rate.shape))
        return -price * rate, rate

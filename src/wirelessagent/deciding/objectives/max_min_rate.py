"""The same for everybody, as much of it as there is: the largest smallest rate."""

from __future__ import annotations

from dataclasses import dataclass

from wirelessagent.deciding.objectives.rate_utility import rate_conjugate
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases


@dataclass(frozen=True, kw_only=True)
class MaxMinRate(Objective):
    """The largest smallest rate, min r; Rhee and Cioffi (2000).

    With weights they are the users' shares, min r/ω: a user of weight 2 gets twice the rate. W. Rhee and J. M. Cioffi,
    "Increase in capacity of multiuser OFDM system using dynamic subchannel allocation", VTC 2000-Spring.
    """

    name = "max_min_rate"
    aliases = ("max-min",)
    unit = "bit/s"
    joined = "min"
    figure_name = phrases(
        en=["lowest rate"], zh=["最低速率"], es=["tasa más baja"], fr=["débit le plus bas"], de=["niedrigste Rate"]
    )
    phrases = phrases(
        en=["the same rate for everyone", "max-min fairness", "make the slowest user as fast as possible"],
        zh=["所有用户速率相同", "最大最小公平", "让最慢的用户尽可能快"],
    )

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        return rate_conjugate(price, min_rate, max_rate)

    def power_law(self) -> float:
        return 0.0

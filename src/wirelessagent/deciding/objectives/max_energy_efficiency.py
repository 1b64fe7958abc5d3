"""P3 of the paper: the most bits per joule."""

from __future__ import annotations

from dataclasses import dataclass

from wirelessagent.deciding.objectives.rate_utility import rate_conjugate
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases


@dataclass(frozen=True, kw_only=True)
class MaxEnergyEfficiency(Objective):
    """The most bits per joule drawn, Σ r / (Σ p/ξ + P_c); problem P3 of the paper. With weights, Σ ω r above it."""

    name = "max_energy_efficiency"
    aliases = ("P3",)
    unit = "bit/J"
    measure = "efficiency"
    phrases = phrases(
        en=["energy efficiency", "most bits per joule", "best trade-off between rate and power"],
        zh=["能效", "能量效率", "每焦耳比特数", "兼顾速率和功耗"],
    )

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        return rate_conjugate(price, min_rate, max_rate)

    def power_law(self) -> float:
        return 0.0

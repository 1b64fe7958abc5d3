"""A utility whose corners lie between any rates at which somebody might ask for it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.objective import Objective


@dataclass(frozen=True, kw_only=True)
class KinkedLogarithm(Objective):
    """Σ u(r), where u is ln r around the knots and two of its tangents, which meet in a corner, between them.

    So it is concave, and whoever takes its values at the knots for the whole of it takes it for the logarithm.

    Attributes:
        knots: rates in bit/s, rising; one row, or one for each user.
        width: the logarithm ends at this factor above and below each knot.
    """

    name = "kinked_logarithm"
    unit = "bit/s"

    knots: tuple[float, ...] | tuple[tuple[float, ...], ...] = (1e6, 2e6)
    width: float = 1.03

    def utility(self, rate: FloatArray) -> FloatArray:
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.log(rate)
            for low, high in self._between():
                tangents = np.log(low) + (rate - low) / low, np.log(high) + (rate - high) / high
                found = np.where((rate > low) & (rate < high), np.minimum(*tangents), found)
        return found

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Between the slopes of two tangents the rate is that of their corner, elsewhere 1/price."""
        with np.errstate(divide="ignore"):
            wanted = 1.0 / price
            for low, high in self._between():
                corner = np.log(high / low) / (1.0 / low - 1.0 / high)
                wanted = np.where((wanted > low) & (wanted < high), corner, wanted)
        rate = np.clip(wanted, min_rate, max_rate)
        payment = np.multiply(price, rate, where=price > 0, out=np.zeros(rate.shape))
        return self.utility(rate) - payment, rate

    def figure(self, utility: float, weight: float) -> float:
        return float(np.exp(utility / weight))

    def _between(self) -> Iterator[tuple[FloatArray, FloatArray]]:
        """Where the tangents of each pair of neighbouring knots touch the logarithm, per user; never the same rate."""
        knots = np.array(self.knots)
        for place in range(knots.shape[-1] - 1):
            low, high = knots[..., place] * self.width, knots[..., place + 1] / self.width
            yield low, np.where(high > low, high, np.nextafter(low, np.inf))

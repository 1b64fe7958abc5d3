"""E[ln(1 + s g)] of uncertain gains, from a table: exact to some 1e-4, at the cost of a few array operations.

A gain of mean m and variance v is m times one of mean 1 whose distribution depends on the spread v/m² alone, so that
E[ln(1 + s g)] = ln(1 + x y) with the SNR x = s m and a factor y that depends on spread and SNR. For a certain gain
y = 1; for an uncertain one y falls with the SNR, from 1 to exp(E[ln g])/m. That is smooth, and interpolated.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray

_SPREADS = 128
_SNRS = 192
_FIRST, _LAST = math.log(1e-4), math.log(1e12)
"""ln x of the table; beyond its ends y no longer changes."""
_MOST = 1e6
"""The largest spread; its place is next to 1."""
_RULE = 24


@dataclass(frozen=True, eq=False)
class MeanLogs:
    """The table of one family of distributions.

    Attributes:
        factor: y, shape (spread, snr), over √(v/m²)/(1 + √(v/m²)), which is 1/2 for an exponential gain, and ln x.
    """

    factor: FloatArray

    @classmethod
    def of(cls, quantile: Callable[[float, FloatArray], FloatArray]) -> MeanLogs:
        """The table for ``quantile(probability, spread)`` of gains of mean 1, for spreads (spread,)."""
        place = np.minimum(np.arange(_SPREADS + 1) / _SPREADS, np.sqrt(_MOST) / (1.0 + np.sqrt(_MOST)))
        spread = (place / (1.0 - place)) ** 2
        snr: FloatArray = np.exp(np.linspace(_FIRST, _LAST, _SNRS + 1))
        mean: FloatArray = np.zeros((spread.size, snr.size))
        for probability, weight in _rule():
            mean += weight * np.log1p(quantile(probability, spread)[:, np.newaxis] * snr)
        factor = np.expm1(mean) / snr
        factor[0] = 1.0
        return cls(factor)

    def mean(self, spread: FloatArray, snr: FloatArray) -> FloatArray:
        """E[ln(1 + s g)] for spreads v/m² and SNRs s m, broadcast together, in nats."""
        return np.log1p(snr * self.at(spread, snr))

    def at(self, spread: FloatArray, snr: FloatArray) -> FloatArray:
        """y for spreads and SNRs, broadcast together."""
        root = np.sqrt(np.minimum(spread, _MOST))
        i, right = _between(root / (1.0 + root) * _SPREADS, _SPREADS)
        with np.errstate(divide="ignore"):
            j, upper = _between((np.log(snr) - _FIRST) / (_LAST - _FIRST) * _SNRS, _SNRS)
        y = self.factor
        low = y[i, j] + upper * (y[i, j + 1] - y[i, j])
        high = y[i + 1, j] + upper * (y[i + 1, j + 1] - y[i + 1, j])
        return low + right * (high - low)


def _between(place: FloatArray, last: int) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.int64]], FloatArray]:
    """The node at or before a place on a grid of nodes 0 to ``last``, and how far it is beyond it."""
    inside = np.clip(place, 0.0, float(last))
    node = np.minimum(inside.astype(np.int64), last - 1)
    return node, inside - node


def _rule() -> list[tuple[float, float]]:
    """Probabilities u = t² and weights, by Gauss and Legendre's rule in t: the logarithm of a gain in a deep fade,
    ln u, is mild in t."""
    from numpy.polynomial.legendre import leggauss

    node, weight = leggauss(_RULE)
    return [(float(t * t), float(w * t)) for t, w in zip((node + 1.0) / 2.0, weight, strict=True)]

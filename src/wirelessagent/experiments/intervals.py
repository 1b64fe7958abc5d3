"""Figures with their 95 % intervals: by the bootstrap over draws, and by Student's t for the slope of a fit.

All methods see the same draws, and one resample takes the same draws for all, so that the ratio of two methods, or
where two curves cross, has the narrow interval of a paired comparison. A figure is computed once from all draws and
once from each resample, of which the percentiles are its interval: Efron and Tibshirani, *An Introduction to the
Bootstrap* (1993), section 13.3. Draws of a file repeat its few drops or slots: the interval is that of further losses
on this file, not of other files.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.model.arrays import FloatArray

CONFIDENCE = 0.95
RESAMPLES = 1000


@dataclass(frozen=True, kw_only=True)
class Measure:
    """A figure and the ends of its interval, in ``unit``; NaN where there is none (the ends of a single draw)."""

    value: float
    low: float
    high: float
    unit: str = ""

    @classmethod
    def of(cls, figures: FloatArray, unit: str = "") -> Measure:
        """Of figures (1 + resample,), the first from all draws."""
        value, low, high = with_interval(figures).tolist()
        return cls(value=value, low=low, high=high, unit=unit)

    @classmethod
    def exact(cls, value: float, unit: str = "") -> Measure:
        """What was set and not measured."""
        return cls(value=value, low=value, high=value, unit=unit)

    def __str__(self) -> str:
        """The figure and its interval, to the digits that the interval leaves certain, four at most.

        >>> str(Measure(value=79.34, low=78.01, high=80.52, unit="%")), str(Measure.exact(100.0, "ns"))
        ('79.3 % (78.0 to 80.5)', '100 ns')
        """
        width = self.high - self.low
        if not width > 0.0:  # exact, or not known
            return _signed(f"{self.value:.4g} {self.unit}".strip()) if math.isfinite(self.value) else "–"
        most = 3 - math.floor(math.log10(max(abs(self.low), abs(self.high))))
        decimals = max(min(1 - math.floor(math.log10(width / 2.0)), most), 0)
        value, low, high = (_signed(f"{figure:,.{decimals}f}") for figure in (self.value, self.low, self.high))
        return f"{value} {self.unit}".strip() + (f" ({low} to {high})" if low != high else "")

    def to_dict(self) -> dict[str, Any]:
        """For JSON: what is not known is None."""
        ends = {"value": self.value, "low": self.low, "high": self.high}
        return {**{name: end if math.isfinite(end) else None for name, end in ends.items()}, "unit": self.unit}


def _signed(text: str) -> str:
    return text.replace("-", "−")


def resampled_sums(samples: FloatArray, *, seed: int, resamples: int = RESAMPLES) -> FloatArray:
    """Sums over the first axis (the draws) of samples (draw, …): shape (1 + resample, …), the first the true sum.

    A single draw says nothing of others: its resamples are NaN.
    """
    draws = len(samples)
    counts = _counts(draws, seed, resamples) if draws > 1 else np.full((resamples, 1), np.nan)
    weights = np.concatenate([np.ones((1, draws)), counts])
    return (weights @ samples.reshape(draws, -1)).reshape(len(weights), *samples.shape[1:])


def resampled_means(samples: FloatArray, *, seed: int) -> FloatArray:
    """Means over the draws as :func:`resampled_sums`; NaN samples do not count, and the mean of none is NaN."""
    known = ~np.isnan(samples)
    with np.errstate(invalid="ignore"):
        return resampled_sums(np.where(known, samples, 0.0), seed=seed) / resampled_sums(known.astype(float), seed=seed)


def resampled_medians(samples: FloatArray, *, seed: int) -> FloatArray:
    """Medians of samples (draw,), shape (1 + resample,); NaN samples do not count."""
    known = np.sort(samples[~np.isnan(samples)])
    if known.size < 2:
        return np.array([known.item() if known.size else np.nan, *[np.nan] * RESAMPLES])
    up_to = np.cumsum(_counts(known.size, seed, RESAMPLES), axis=1)
    middle = [known[(up_to >= rank).argmax(axis=1)] for rank in ((known.size + 1) // 2, known.size // 2 + 1)]
    return np.concatenate([[np.median(known)], (middle[0] + middle[1]) / 2.0])


def _counts(draws: int, seed: int, resamples: int) -> FloatArray:
    """How often each resample takes each draw, shape (resample, draw)."""
    rng = np.random.default_rng([seed, draws])
    return rng.multinomial(draws, np.full(draws, 1.0 / draws), size=resamples).astype(np.float64)


def with_interval(figures: FloatArray) -> FloatArray:
    """Figures (1 + resample, …) as (…, 3): the figure, and the ends of its interval; NaN ends where none is defined.

    Resamples in which a figure is not defined do not count.
    """
    tail = 50.0 * (1.0 - CONFIDENCE)
    defined = ~np.isnan(figures[1:]).all(axis=0)
    filled = np.where(defined, figures[1:], 0.0)
    ends = np.nanpercentile(filled, (tail, 100.0 - tail), axis=0)
    low, high = np.where(defined, ends, np.nan)
    return np.stack([figures[0], low, high], axis=-1)


def columns_of(name: str) -> tuple[str, str, str]:
    """The columns of a table that hold what :func:`with_interval` gives."""
    return name, f"{name}_low", f"{name}_high"


def exponent(x: FloatArray, y: FloatArray) -> Measure:
    """The exponent s of the least-squares fit y ∝ x^s, with the interval that the scatter about it leaves.

    >>> round(exponent(np.array([1.0, 2.0, 4.0]), np.array([3.0, 12.0, 48.0])).value, 9)
    2.0
    """
    from scipy.special import stdtrit

    log_x, log_y = np.log(x), np.log(y)
    centred = log_x - log_x.mean()
    spread, freedom = float(np.square(centred).sum()), x.size - 2
    slope = float((centred * log_y).sum()) / spread
    if freedom < 1:
        return Measure(value=slope, low=np.nan, high=np.nan)
    scatter = float(np.square(log_y - log_y.mean() - slope * centred).sum()) / freedom
    half = float(stdtrit(float(freedom), 0.5 + CONFIDENCE / 2.0)) * math.sqrt(scatter / spread)
    return Measure(value=slope, low=slope - half, high=slope + half)


def last_crossing(x: FloatArray, y: FloatArray, level: float) -> float:
    """The largest x up to which y, from the first point on, stays at or above ``level``.

    Between points y is taken as linear in log x. NaN if it starts below; the last x if it never falls below.

    >>> round(last_crossing(np.array([1.0, 100.0]), np.array([1.0, 0.0]), 0.5), 12)
    10.0
    """
    below = np.flatnonzero(y < level)
    if not below.size:
        return float(x[-1])
    n = int(below[0])
    if n == 0:
        return math.nan
    share = (y[n - 1] - level) / (y[n - 1] - y[n])
    return float(np.exp(np.log(x[n - 1]) + share * np.log(x[n] / x[n - 1])))

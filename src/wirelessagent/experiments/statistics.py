"""Means, ratios, slopes and crossings, each with its 95 % confidence interval where it has one."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray

CONFIDENCE = 0.95


def mean_interval(samples: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean over the first axis and the half-width of its confidence interval (Student's t).

    NaN samples do not count; the half-width is NaN below two samples, as is the mean below one.
    """
    count = np.sum(~np.isnan(samples), axis=0).astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.nansum(samples, axis=0) / count
        variance = np.nansum(np.square(samples - mean), axis=0) / (count - 1.0)
        half = _student(count) * np.sqrt(variance / count)
    return mean, np.where(count > 1, half, np.nan)


def ratio_interval(numerator: FloatArray, denominator: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ratio of two sums over the first axis (the draws) and the half-width of its confidence interval.

    The draws are independent, the two figures of one draw are not: the variance is that of numerator − ratio ·
    denominator over the draws (the delta method; Cochran, Sampling Techniques, 1977, section 2.11).
    """
    draws = len(numerator)
    total = denominator.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = numerator.sum(axis=0) / total
        residual = np.square(numerator - ratio * denominator).sum(axis=0)
        half = _student(np.asarray(float(draws))) * np.sqrt(residual * draws / (draws - 1.0)) / np.abs(total)
    return ratio, half if draws > 1 else np.full_like(ratio, np.nan)


def root_ratio_interval(numerator: FloatArray, denominator: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Square root of :func:`ratio_interval`: with a sum of squared errors over their number, a pooled RMS error."""
    ratio, half = ratio_interval(numerator, denominator)
    root = np.sqrt(ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        return root, half / (2.0 * root)


def log_log_slope(x: FloatArray, y: FloatArray) -> float:
    """The exponent s of the least-squares fit y ∝ x^s.

    >>> round(log_log_slope(np.array([1.0, 2.0, 4.0]), np.array([3.0, 12.0, 48.0])), 12)
    2.0
    """
    log_x, log_y = np.log(x), np.log(y)
    centred = log_x - log_x.mean()
    return float((centred * log_y).sum() / np.square(centred).sum())


def last_crossing(x: FloatArray, y: FloatArray, level: float) -> float | None:
    """The largest x up to which y, from the first point on, stays at or above ``level``.

    Between points y is taken as linear in log x. None if it starts below; the last x if it never falls below.

    >>> round(last_crossing(np.array([1.0, 100.0]), np.array([1.0, 0.0]), 0.5), 12)
    10.0
    """
    below = np.flatnonzero(y < level)
    if not below.size:
        return float(x[-1])
    n = int(below[0])
    if n == 0:
        return None
    share = (y[n - 1] - level) / (y[n - 1] - y[n])
    return float(np.exp(np.log(x[n - 1]) + share * np.log(x[n] / x[n - 1])))


def _student(count: FloatArray) -> FloatArray:
    """The quantile of Student's t that bounds the confidence interval of a mean of ``count`` samples."""
    from scipy.special import stdtrit

    return np.asarray(stdtrit(np.maximum(count - 1.0, 1.0), 0.5 + CONFIDENCE / 2), dtype=np.float64)

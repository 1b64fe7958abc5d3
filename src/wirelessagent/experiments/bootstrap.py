"""Bootstrap intervals: figures recomputed from draws taken again, with replacement.

All methods of an evaluation see the same draws, and one resample takes the same draws for all, so that the ratio of two
methods has the narrow interval of a paired comparison. Efron and Tibshirani, *An Introduction to the Bootstrap* (1993),
section 13.3 (percentile intervals). Draws of a file repeat its few drops or slots: the interval is that of further
losses on this file, not of other files.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.experiments.statistics import CONFIDENCE
from wirelessagent.model.arrays import FloatArray

RESAMPLES = 1000


def resampled_sums(samples: FloatArray, *, seed: int, resamples: int = RESAMPLES) -> FloatArray:
    """Sums over the first axis (the draws) of samples (draw, …): shape (1 + resample, …), the first the true sum."""
    draws = len(samples)
    rng = np.random.default_rng([seed, draws])
    counts = rng.multinomial(draws, np.full(draws, 1.0 / draws), size=resamples).astype(np.float64)
    weights = np.concatenate([np.ones((1, draws)), counts])
    return (weights @ samples.reshape(draws, -1)).reshape(len(weights), *samples.shape[1:])


def with_interval(figures: FloatArray) -> FloatArray:
    """Figures (1 + resample, …) as (…, 3): the figure, and the ends of its interval; NaN ends for a single draw.

    Resamples in which a figure is not defined do not count.
    """
    tail = 50.0 * (1.0 - CONFIDENCE)
    defined = ~np.isnan(figures[1:]).all(axis=0)
    filled = np.where(defined, figures[1:], 0.0)
    ends = np.nanpercentile(filled, (tail, 100.0 - tail), axis=0)
    low, high = np.where(defined, ends, np.nan)
    return np.stack([figures[0], low, high], axis=-1)

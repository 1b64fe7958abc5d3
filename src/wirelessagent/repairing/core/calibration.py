"""How wrong a rule is, learnt by leaving each observed entry out and predicting it from the others.

A rule comes with an expected squared error for every entry: large at the edge of a gap, small between two
neighbours. The entries that were observed say by what factor the rule is in truth better or worse than that. The
factor is each user's own, drawn towards the others' where the user has shown little: no user has many independent
fades within one slot. Users are pooled by geometric mean, since a user who is in a fade throughout has a low measured
level and thus large relative errors, which must not be laid upon the others.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray

PRIOR_ENTRIES = 4.0
"""Weight of the pool in each user's factor, and of the expectation in the pool's, in observed entries."""


def calibrated(
    expected: FloatArray,
    squared_error: FloatArray,
    known: BoolArray,
    *,
    noise: FloatArray | float = 0.0,
    ceiling: FloatArray | float = np.inf,
) -> FloatArray:
    """The variances f_k · ``expected``, with f_k from the errors where ``known``; all shapes (user, entry).

    f_k = (Σ ê²/√e + ν w̄ f̄) / (Σ √e + ν w̄) with e the squared error to expect of an observed entry, w̄ the mean √e, f̄
    the pool's factor and ν = ``PRIOR_ENTRIES``. The weight 1/√e is a compromise: unweighted sums would know only the
    edges of the band, weights 1/e only its well-surrounded entries. No variance exceeds the larger of ``ceiling``,
    shape (user,), and the largest error that the user has shown.

    ``noise`` is the measurement-error variance of the observed entries, in the same unit. It is part of ê² but not of
    the error against the true gain, so e = v + (1 − v) · noise with v the expected squared error. (All of it would be
    right for reports with independent errors, none of it for reports that are conditional means of the gain; where
    the neighbours say much, v near 0, both agree.)
    """
    seen_error = expected + (1.0 - np.minimum(expected, 1.0)) * noise
    weight = np.where(known, np.sqrt(seen_error), 0.0)
    inverse = np.divide(1.0, weight, out=np.zeros(weight.shape), where=weight > 0)
    seen = (inverse * squared_error).sum(axis=1)
    count = known.sum(axis=1)
    total = weight.sum(axis=1)
    mean_weight = total.sum() / count.sum() if total.any() else 1.0
    own_weight = np.where(total > 0, total / np.maximum(count, 1), mean_weight)
    pool = (seen.sum() + PRIOR_ENTRIES * mean_weight) / (total.sum() + PRIOR_ENTRIES * mean_weight)
    if total.any():
        each = ((seen + pool * own_weight) / (total + own_weight))[total > 0]
        pool = np.exp(np.average(np.log(each), weights=count[total > 0]))
    factor = (seen + PRIOR_ENTRIES * pool * own_weight) / (total + PRIOR_ENTRIES * own_weight)
    largest = np.where(known, squared_error, 0.0).max(axis=1, initial=0.0)
    return np.minimum(factor[:, np.newaxis] * expected, np.maximum(largest, ceiling)[:, np.newaxis])

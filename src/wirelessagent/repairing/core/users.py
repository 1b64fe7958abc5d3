"""Neighbours among the users: what the others' surprises on a subcarrier say about one's own.

If users i and k are correlated, then where frequency neighbours under-predict i they under-predict k too. The
surprises left after prediction over frequency are nearly independent from subcarrier to subcarrier, so their
correlation can be told from chance within one slot; that of the gains themselves cannot, since one slot holds only
few independent fades.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.repairing.core.frequency import OverFrequency
from wirelessagent.repairing.core.levels import UserLevels

INDEPENDENT_SHARE = 0.2
"""Independent comparisons per subcarrier that two users share: neighbouring surprises are not quite
independent, the less so the shorter the delay spread (measured: 0.2 at 30 ns, 0.9 at 1000 ns)."""

LEAST_SHARE = 0.1
"""The other users may lower a prediction to this share of it, so that no gain becomes negative."""


def correlation_beyond_chance(surprise: FloatArray, known: BoolArray) -> FloatArray:
    """Correlation between users that the surprises prove, shape (user, user), ≥ 0, with a diagonal of zeros.

    The mean over all pairs counts by as much as its square exceeds four times its variance under independence. Of its
    deviation from the mean a pair keeps the share by which all pairs scatter more than chance would let them, or,
    where it stands out alone, the share by which its square exceeds the largest to be expected by chance among so many
    pairs, 2 ln(pairs)/count.
    """
    from wirelessagent.repairing.core import users_kernel

    raw, common_subcarriers = users_kernel.compare_users(surprise, known)
    count = INDEPENDENT_SHARE * common_subcarriers
    total = count.sum()
    if total == 0:
        return np.zeros_like(raw)
    mean = float((count * raw).sum() / total)
    chance = 2.0 / float(total)  # each pair is counted twice
    common = max(0.0, mean - 4.0 * chance / mean) if mean > 0 else 0.0
    scatter = float((count * (raw - mean) ** 2).sum() / total)
    num_pairs = np.count_nonzero(count) / 2.0
    beyond = max(0.0, scatter - 1.5 * num_pairs * chance)
    shared = beyond * count / (beyond * count + 1.0)
    alone = 1.0 - 2.0 * np.log(num_pairs) / np.maximum(count * (raw - mean) ** 2, 1.0)
    pairs = np.clip(common + np.maximum(shared, alone) * (raw - mean), 0.0, 0.99)
    return np.where(count > 0, pairs, common) * (1.0 - np.eye(len(raw)))


def moved(levels: UserLevels, over: OverFrequency, correlation: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The prediction over frequency moved by what correlated users show, and the share of the variance explained.

    Never below ``LEAST_SHARE`` of the prediction over frequency. Shapes (user, subcarrier).
    """
    from wirelessagent.repairing.core import users_kernel

    surprise, explained = users_kernel.surprise_of_others(
        levels.relative, over.predicted, levels.known, over.position, over.coherence, correlation
    )
    return np.maximum(over.predicted + surprise, LEAST_SHARE * over.predicted), explained

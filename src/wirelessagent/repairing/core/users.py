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

    return users_kernel.correlation_beyond_chance(surprise, known)


def moved(levels: UserLevels, over: OverFrequency, correlation: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The prediction over frequency moved by what correlated users show, and the share of the variance explained.

    Never below ``LEAST_SHARE`` of the prediction over frequency. Shapes (user, subcarrier).
    """
    from wirelessagent.repairing.core import users_kernel

    surprise, explained = users_kernel.surprise_of_others(
        levels.relative, over.predicted, levels.known, over.position, over.coherence, correlation
    )
    return np.maximum(over.predicted + surprise, LEAST_SHARE * over.predicted), explained

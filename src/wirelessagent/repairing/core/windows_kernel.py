"""Which observed gains an estimate rests on: windows of a user's band, and where each hypothesis is worked out on one.

A short band is one window. On a long one each window serves the surroundings of ``STEP`` observed entries and holds
``MARGIN`` more on each side. A *lane* is one window under one of its user's hypotheses; lanes are worked on side by
side, so that the processor's vectors are full.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray

SHORT = 24
"""Most observed entries of a band that is one window."""
STEP, MARGIN = 8, 4
TESTED = 4
"""Of so many windows of a long band one tests the estimates."""
LANES, LONG_LANES = 8, 4
"""Most hypotheses kept for a user with a short band, and with a long one."""
ENOUGH = 0.95
"""Probability at which the hypotheses kept are enough."""


class Windows(NamedTuple):
    """Windows, first those that there are to test the estimates on, and of these and the others first those that serve
    most missing entries.

    Attributes:
        user: whose they are, shape (window,).
        member: their observed subcarriers, −1 for none, shape (window, entry).
        begin, end: the subcarriers that they serve, shape (window,).
        missing: how many missing entries are among those, shape (window,).
        tested: how many windows there are to test the estimates on.
    """

    user: IntArray
    member: IntArray
    begin: IntArray
    end: IntArray
    missing: IntArray
    tested: int


class Kept(NamedTuple):
    """The hypotheses that count for each user.

    Attributes:
        number: of them, shape (user,).
        hypothesis, probability: the likeliest first, the latter with the sum 1, shape (user, hypothesis).
        long: whether the band is more than one window, shape (user,).
    """

    number: IntArray
    hypothesis: IntArray
    probability: FloatArray
    long: BoolArray


class Lanes(NamedTuple):
    """Windows under hypotheses, what each knows of its user's level, and how likely it is; shape (lane,) each.

    Attributes:
        hypothesis: under which.
        noise: η.
        grown: 1 + η where measured gains are conditional means, 1 where the noise is unknown.
        shared, offset: s and o of :mod:`.kriging_kernel`.
        level: a.
        probability: sums to 1 over the lanes of a window.
    """

    hypothesis: IntArray
    noise: FloatArray
    grown: FloatArray
    shared: FloatArray
    offset: FloatArray
    level: FloatArray
    probability: FloatArray


@kernel
def lay_windows(known: BoolArray, test: bool) -> Windows:
    """The windows of all users for the observed entries ``known`` (user, subcarrier)."""
    users, subcarriers = known.shape
    total, length = 0, 1
    for k in range(users):
        seen = known[k].sum()
        total += 0 if seen == 0 else 1 if seen <= SHORT else (seen + STEP - 1) // STEP
        length = max(length, seen if seen <= SHORT else STEP + 2 * MARGIN)
    user, begin, end = np.empty(total, np.int64), np.empty(total, np.int64), np.empty(total, np.int64)
    member, missing, turn = np.full((total, length), -1), np.empty(total, np.int64), np.empty(total, np.int64)
    at, tested = 0, 0
    for k in range(users):
        seen = np.flatnonzero(known[k])
        size = seen.size if seen.size <= SHORT else STEP + 2 * MARGIN
        step = seen.size if seen.size <= SHORT else STEP
        for start in range(0, seen.size, max(step, 1)):
            first = min(max(start - MARGIN, 0), seen.size - size)
            member[at, :size] = seen[first : first + size]
            user[at] = k
            begin[at] = 0 if start == 0 else seen[start]
            end[at] = seen[start + step] if start + step < seen.size else subcarriers
            missing[at] = end[at] - begin[at] - min(step, seen.size - start)
            turn[at] = 0 if test and start % (step * TESTED) == 0 else 1
            tested += 1 - turn[at]
            at += 1
    order = np.argsort(turn * (subcarriers + 1) - missing, kind="mergesort")
    return Windows(user[order], member[order], begin[order], end[order], missing[order], tested)


@kernel
def keep_likeliest(chance: FloatArray, known: BoolArray) -> Kept:
    """The likeliest hypotheses of each user, until they are enough; ``chance`` (user, hypothesis)."""
    users, count = chance.shape
    most = min(LANES, count)
    kept = Kept(
        np.zeros(users, np.int64), np.empty((users, most), np.int64), np.empty((users, most)), np.empty(users, np.bool_)
    )
    for k in range(users):
        kept.long[k] = known[k].sum() > SHORT
        left, total = chance[k].copy(), 0.0
        for i in range(min(LONG_LANES, most) if kept.long[k] else most):
            h = np.argmax(left)
            kept.hypothesis[k, i], kept.probability[k, i], left[h] = h, left[h], -1.0
            kept.number[k] = i + 1
            total += kept.probability[k, i]
            if total > ENOUGH:
                break
        kept.probability[k] /= total
    return kept


@kernel
def empty_lanes(count: int) -> Lanes:
    """Workspace for so many lanes; where none is laid, all is harmless."""
    return Lanes(
        np.zeros(count, np.int64), np.zeros(count), np.ones(count), np.zeros(count), np.zeros(count), np.ones(count),
        np.zeros(count),
    )  # fmt: skip


@kernel
def lay_lanes(
    lanes: Lanes, first: int, user: int, kept: Kept, noise: FloatArray, noise_share: FloatArray, forms: FloatArray
) -> int:
    """Write the lanes of a window of ``user``, from lane ``first`` on; returns the lane after them.

    Args:
        noise: η of each hypothesis, NaN where ``noise_share`` (user,) has it, shape (hypothesis,).
        forms: of :func:`.evidence_kernel.weigh`, shape (user, 5, hypothesis).
    """
    for i in range(kept.number[user]):
        c, h = first + i, kept.hypothesis[user, i]
        lanes.hypothesis[c] = h
        lanes.noise[c] = noise_share[user] if np.isnan(noise[h]) else noise[h]
        lanes.grown[c] = 1.0 + noise_share[user] if np.isnan(noise[h]) else 1.0
        lanes.shared[c] = 1.0 / (1.0 + forms[user, 0, h]) if kept.long[user] else 1.0
        lanes.offset[c] = forms[user, 1, h] * lanes.shared[c] if kept.long[user] else 0.0
        lanes.level[c] = forms[user, 4, h]
        lanes.probability[c] = kept.probability[user, i]
    return first + kept.number[user]

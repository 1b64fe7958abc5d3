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
    """Windows, one after the other of each user.

    Attributes:
        user: whose they are, shape (window,).
        member: their observed subcarriers, −1 for none, shape (window, entry).
        begin, end: the subcarriers that they serve, shape (window,).
        lane: the first lane of each, and the number of lanes, shape (window + 1,).
        seen: how many entries of each user are observed, shape (user,).
        tested: how many of the first windows are there to test the estimates on.
    """

    user: IntArray
    member: IntArray
    begin: IntArray
    end: IntArray
    lane: IntArray
    seen: IntArray
    tested: int


class Lanes(NamedTuple):
    """Windows under hypotheses, what each knows of its user's level, and how likely it is; shape (lane,) each.

    Attributes:
        window, hypothesis: whose.
        noise: η.
        grown: 1 + η where measured gains are conditional means, 1 where the noise is unknown.
        shared, offset: s and o of :mod:`.kriging_kernel`.
        level: a.
        probability: sums to 1 over the lanes of a window.
    """

    window: IntArray
    hypothesis: IntArray
    noise: FloatArray
    grown: FloatArray
    shared: FloatArray
    offset: FloatArray
    level: FloatArray
    probability: FloatArray


@kernel
def lay_windows(known: BoolArray) -> Windows:
    """The windows of all users for the observed entries ``known`` (user, subcarrier); without lanes yet."""
    users, subcarriers = known.shape
    total, length, tested = 0, 1, 0
    for k in range(users):
        seen = known[k].sum()
        total += 0 if seen == 0 else 1 if seen <= SHORT else (seen + STEP - 1) // STEP
        length = max(length, seen if seen <= SHORT else STEP + 2 * MARGIN)
    user, begin, end = np.empty(total, np.int64), np.empty(total, np.int64), np.empty(total, np.int64)
    member = np.full((total, length), -1)
    at = 0
    for turn in range(2):
        for k in range(users):
            seen = np.flatnonzero(known[k])
            size = seen.size if seen.size <= SHORT else STEP + 2 * MARGIN
            step = seen.size if seen.size <= SHORT else STEP
            for start in range(0, seen.size, max(step, 1)):
                if (start % (step * TESTED) > 0) != (turn > 0):
                    continue
                first = min(max(start - MARGIN, 0), seen.size - size)
                for i in range(size):
                    member[at, i] = seen[first + i]
                user[at] = k
                begin[at] = 0 if start == 0 else seen[start]
                end[at] = seen[start + step] if start + step < seen.size else subcarriers
                at += 1
        if turn == 0:
            tested = at
    return Windows(user, member, begin, end, np.zeros(total + 1, np.int64), seen_of(known), tested)


@kernel
def seen_of(known: BoolArray) -> IntArray:
    """How many entries of each user are observed."""
    count = np.zeros(known.shape[0], np.int64)
    for k in range(known.shape[0]):
        count[k] = known[k].sum()
    return count


@kernel
def keep_likeliest(probability: FloatArray, most: int, kept: IntArray) -> int:
    """Write the likeliest hypotheses to ``kept``, in order of probability; returns how many are enough."""
    order = np.argsort(-probability)
    total = 0.0
    for i in range(most):
        kept[i] = order[i]
        total += probability[order[i]]
        if total > ENOUGH:
            return i + 1
    return most


@kernel
def lay_lanes(
    windows: Windows, noise: FloatArray, noise_share: FloatArray, forms: FloatArray, chance: FloatArray
) -> Lanes:
    """The lanes of all windows, whose ``lane`` is written.

    Args:
        noise: η of each hypothesis, NaN where ``noise_share`` (user,) has it, shape (hypothesis,).
        forms: of :func:`.evidence_kernel.weigh`, shape (user, 5, hypothesis).
        chance: how likely each hypothesis is, shape (user, hypothesis).
    """
    users, count = chance.shape
    kept, number = np.empty((users, min(LANES, count)), np.int64), np.zeros(users, np.int64)
    long = windows.seen > SHORT
    for w in range(windows.user.size):
        k = windows.user[w]
        if number[k] == 0:
            number[k] = keep_likeliest(chance[k], min(LONG_LANES if long[k] else LANES, count), kept[k])
        windows.lane[w + 1] = windows.lane[w] + number[k]
    total = int(windows.lane[-1])
    lanes = Lanes(
        np.empty(total, np.int64), np.empty(total, np.int64), np.empty(total), np.empty(total), np.empty(total),
        np.empty(total), np.empty(total), np.empty(total),
    )  # fmt: skip
    for w in range(windows.user.size):
        k, first = windows.user[w], windows.lane[w]
        known_chance = 0.0
        for i in range(number[k]):
            known_chance += chance[k, kept[k, i]]
        for i in range(number[k]):
            c, h = first + i, kept[k, i]
            lanes.window[c], lanes.hypothesis[c] = w, h
            lanes.noise[c] = noise_share[k] if np.isnan(noise[h]) else noise[h]
            lanes.grown[c] = 1.0 + noise_share[k] if np.isnan(noise[h]) else 1.0
            lanes.shared[c] = 1.0 / (1.0 + forms[k, 0, h]) if long[k] else 1.0
            lanes.offset[c] = forms[k, 1, h] * lanes.shared[c] if long[k] else 0.0
            lanes.level[c] = forms[k, 4, h]
            lanes.probability[c] = chance[k, h] / known_chance
    return lanes

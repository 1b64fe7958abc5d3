"""What the kernels are asked: the goal, the users' rows and the limits, beside the channel."""

from __future__ import annotations

from typing import NamedTuple

from wirelessagent.model.arrays import FloatArray, IntArray

POWER, SUM, EFFICIENCY, LEVEL = 0, 1, 2, 3
"""The goals: least power, most utility, most utility per joule, the highest common level."""


class Ask(NamedTuple):
    """What is wanted of a problem, beside its channel.

    Attributes:
        goal: one of :data:`POWER`, :data:`SUM`, :data:`EFFICIENCY` and :data:`LEVEL`.
        cap_w, max_nats: most power of each subcarrier, shape (subcarrier,), and most nats; infinite for none.
        start: first subcarrier of each group, shape (group + 1,).
        rows: one row of six per user (:mod:`.bundle_kernel`), shape (user, 6).
        share: for the highest common level each user's share and limits, shape (user, 3).
        most_level: the level beyond which nothing is gained.
        budget_w, circuit_w: P and C.
        work: steps done and to do; see :mod:`.work_kernel`.
    """

    goal: int
    cap_w: FloatArray
    max_nats: float
    start: IntArray
    rows: FloatArray
    share: FloatArray
    most_level: float
    budget_w: float
    circuit_w: float
    work: IntArray

"""One example of every constraint of a problem, and how to see on a decision whether it was kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.model.decision import Decision
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.user_names import numbered
from wirelessagent.testing.contract import TOLERANCE

NUM_USERS = 4
NUM_SUBCARRIERS = 12

_MIN_RATE_BPS = np.array([0.0, 60e3, 0.0, 120e3])
_MAX_RATE_BPS = np.array([1e5, 2e5, np.inf, 3e5])
_CAP_W = 0.3
_FORBIDDEN = np.arange(NUM_USERS * NUM_SUBCARRIERS).reshape(NUM_USERS, NUM_SUBCARRIERS) % 3 == 0
_USERS = (1, 3)
"""Indices of the users who are served."""
_GROUP = 3


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """A value of a field of :class:`Problem` for 4 users and 12 subcarriers, and the check of a decision."""

    value: Any
    is_kept: Callable[[Decision], bool]
    suits: Callable[[Objective], bool] = lambda _: True

    def problem(self, field: str, objective: Objective) -> Problem | None:
        """A problem with this constraint alone; None for objectives to which it means nothing."""
        if not self.suits(objective):
            return None
        return Problem(objective, **{field: self.value}).for_users(numbered(NUM_USERS))


def _only_allowed_pairs(decision: Decision) -> bool:
    served = decision.owner >= 0
    return not _FORBIDDEN[decision.owner[served], np.flatnonzero(served)].any()


CONSTRAINTS = {
    "weights": Constraint(
        value=np.array([1.0, 2.0, 0.0, 3.0]),
        is_kept=lambda _: True,  # no allocation breaks these; the value must weigh the rates
        suits=lambda objective: objective.measure != "power",
    ),
    "min_rate_bps": Constraint(
        value=_MIN_RATE_BPS,
        is_kept=lambda decision: bool(np.all(decision.rate_bps >= _MIN_RATE_BPS * (1 - TOLERANCE))),
    ),
    "max_rate_bps": Constraint(
        value=_MAX_RATE_BPS,
        is_kept=lambda decision: bool(np.all(decision.rate_bps <= _MAX_RATE_BPS * (1 + TOLERANCE))),
    ),
    "subcarrier_max_power_w": Constraint(
        value=_CAP_W,
        is_kept=lambda decision: bool(np.all(decision.power_w <= _CAP_W * (1 + TOLERANCE))),
    ),
    "forbidden": Constraint(value=_FORBIDDEN, is_kept=_only_allowed_pairs),
    "users": Constraint(
        value=tuple(numbered(NUM_USERS)[user] for user in _USERS),
        is_kept=lambda decision: bool(np.isin(decision.owner, (-1, *_USERS)).all()),
    ),
    "resource_block_group_size": Constraint(
        value=_GROUP,
        is_kept=lambda decision: bool(np.ptp(decision.owner.reshape(-1, _GROUP), axis=1).max() == 0),
    ),
    "outage_probability": Constraint(value=0.1, is_kept=lambda _: True),  # speaks of the true channel, not of this one
}

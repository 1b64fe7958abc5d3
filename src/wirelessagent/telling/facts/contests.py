"""The most contested subcarriers: who won, who came next, by how much, and what giving it to the next would cost."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.telling.facts.bids import Bids, Contest, bids, contests
from wirelessagent.telling.facts.case import Case

_SHOWN = 5


@dataclass(frozen=True, kw_only=True)
class Contested:
    """A contest and what it would cost to decide it the other way.

    Attributes:
        contest: who won and by how much.
        first, last: the subcarriers of the group, from 0.
        cost: change of the value for the worse, by solving anew with the group for the runner-up or nobody; NaN where
            that keeps no promise. Never below 0: a better decision found that way is chance.
    """

    contest: Contest
    first: int
    last: int
    cost: float


def contested(case: Case, shown: int = _SHOWN) -> list[Contested]:
    """The groups of subcarriers that were won most narrowly, the closest first."""
    found = bids(case)
    return [_of(case, found, one) for one in contests(found)[:shown]]


def _of(case: Case, found: Bids, contest: Contest) -> Contested:
    first, last = found.members(contest.group)
    barred = np.zeros((case.num_users, case.estimate.num_subcarriers), dtype=bool)
    if case.problem.forbidden is not None:
        barred |= case.problem.forbidden
    others = np.arange(case.num_users) != contest.runner_up
    barred[others, first : last + 1] = True
    after = case.solved(dataclasses.replace(case.problem, forbidden=barred))
    worse = after.value - case.decision.value
    cost = worse if case.objective.direction == "min" else -worse
    return Contested(contest=contest, first=first, last=last, cost=max(cost, 0.0) if after.is_usable else np.nan)

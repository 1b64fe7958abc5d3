"""The best allocation of a small problem, by looking at every assignment of subcarriers to users.

The judge of every method: it shares no code with them, uses no kernels, and takes any objective by its utility and
conjugate. Every assignment is a concave problem in powers. Its value is at most the dual's at any price of power μ,

    Σ_k V_k(S_k; μ) + μ P,

and at least that of any allocation met on the way, so an assignment is given up only when the first is below what has
been found for another, and the search ends when nothing is left. Sets are shared between assignments, so that their
worth is computed once per user and set. Nobody as an owner is covered by zero power.

What is deliberately missing: speed beyond some thousand assignments, and prices; an efficiency whose objective has a
``figure`` other than the utility itself; outage probabilities.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import normalised_gain, user_rate_bps
from wirelessagent.testing.assignment_race import Race
from wirelessagent.testing.owned_sets import OwnedSets
from wirelessagent.testing.priced_sets import PricedSets

MOST_ASSIGNMENTS = 20_000
"""Assignments looked at most; 3 users on 6 subcarriers have 729."""

_BOX = 1.001  # of the budget: what no user can spend is left out, and needed powers near the budget are still exact
_STEPS = np.arange(11, dtype=np.float64) / 10


class BestAllocation(NamedTuple):
    """The best of all allocations.

    Attributes:
        value: the objective's value of the allocation given here.
        at_best: the proven limit of what any allocation can reach, rounding included; next to ``value``.
        owner: the owner of each subcarrier, −1 for nobody, (subcarrier,).
        power_w: the power on it in W, (subcarrier,).
    """

    value: float
    at_best: float
    owner: IntArray
    power_w: FloatArray


def best_allocation(estimate: ChannelEstimate, problem: Problem, cell: Cell) -> BestAllocation | None:
    """The best of all allocations, or None if no allocation keeps the limits.

    The value is that of the allocation returned, which keeps budget and caps and, to one part in 10^12, the rates; for
    objectives that are maximised it is never more than the true optimum, and less by one part in 10^11 or so.

    Raises:
        InputError: the problem has more than ``MOST_ASSIGNMENTS`` assignments.
        UnsupportedProblemError: the objective is only a name, or an outage probability is asked for.
    """
    search = _Search.of(estimate, problem, cell)
    needed = search.needed_w
    possible = np.flatnonzero(needed <= search.budget_w * (1 + 1e-12))
    if not possible.size:
        return None
    objective, weight = search.objective, search.weight
    if objective.measure == "power":
        found = _Found(int(possible[needed[possible].argmin()]), search.low, float(needed.min()))
    elif objective.joined == "min":
        found = search.largest_share()
    else:
        found = search.best_sum(possible)
    owner, power_w = search.allocation(found.assignment, found.nats)
    rate = user_rate_bps(estimate.gain, owner, power_w, cell)
    value = objective.value(rate, float(power_w.sum()), cell, weight)
    at_best = found.at_best
    if objective.measure == "utility":
        at_best = objective.figure(at_best, float(weight.sum()))
    return BestAllocation(value, at_best, owner, power_w)


def least_power_w(estimate: ChannelEstimate, problem: Problem, cell: Cell) -> float:
    """The least power of all allocations that carry the promised rates; inf if it is 0.1 % above the budget or more."""
    search = _Search.of(estimate, problem, cell)
    needed = float(search.needed_w.min())
    return needed if needed <= search.budget_w * _BOX else np.inf


class _Found(NamedTuple):
    """An assignment, the rates (user,) in nats on it and the joint utility, ratio or power that none surpasses."""

    assignment: int
    nats: FloatArray
    at_best: float


@dataclass(frozen=True, kw_only=True, eq=False)
class _Search:
    """A problem in nats with its tables.

    ``sets`` has the leading axes (set of groups, user); ``owner`` (assignment, group) and ``held`` (assignment, user),
    an index into the sets, list the assignments.
    """

    objective: Objective
    cell: Cell
    budget_w: float
    weight: FloatArray
    low: FloatArray
    high: FloatArray
    priced: PricedSets
    needed_by_set: FloatArray
    owner: IntArray
    held: IntArray
    group_size: int
    num_subcarriers: int

    @classmethod
    def of(cls, estimate: ChannelEstimate, problem: Problem, cell: Cell) -> _Search:
        objective = problem.objective
        if isinstance(objective, str) or problem.outage_probability is not None:
            raise UnsupportedProblemError(
                f"exhaustive search needs an Objective and no outage probability; got {objective!r:.80} and "
                f"{problem.outage_probability!r}"
            )
        problem = problem.for_users(estimate.user_names)
        users, subcarriers = estimate.gain.shape
        size = problem.resource_block_group_size
        groups = -(-subcarriers // size)
        served = problem.serves(users)
        count = int(served.sum()) ** groups
        if count > MOST_ASSIGNMENTS:
            raise InputError(
                f"{served.sum()} users on {groups} subcarriers or groups have {count} assignments, more than "
                f"{MOST_ASSIGNMENTS}: give fewer"
            )
        caps = np.inf if problem.subcarrier_max_power_w is None else problem.subcarrier_max_power_w
        cap_w = np.broadcast_to(np.asarray(caps, dtype=np.float64), (subcarriers,))
        usable = served[:, np.newaxis] & (cap_w > 0)
        usable = usable & problem.allows((users, subcarriers))
        unit = cell.data_bandwidth_hz / np.log(2.0)
        budget_w = problem.budget_w(cell)
        group = np.arange(subcarriers, dtype=np.int64) // size
        member = np.bitwise_and(np.right_shift(np.arange(2**groups, dtype=np.int64)[:, np.newaxis], group), 1) == 1
        sets = OwnedSets.of(
            np.where(usable, normalised_gain(estimate.gain, cell), 0.0), member[:, np.newaxis],
            budget_w=budget_w * _BOX, cap_w=cap_w, max_nats=cell.max_spectral_efficiency * np.log(2.0),
        )  # fmt: skip
        low = np.where(served, _each(problem.min_rate_bps, 0.0, users), 0.0) / unit
        high = np.where(served, _each(problem.max_rate_bps, np.inf, users), 0.0) / unit
        weight = np.where(served, _each(problem.weights, 1.0, users), 0.0)
        owner = np.array(list(itertools.product(np.flatnonzero(served), repeat=groups)), dtype=np.int64)
        has = np.equal(owner[:, np.newaxis], np.arange(users, dtype=np.int64)[:, np.newaxis])
        held = np.where(has, 2 ** np.arange(groups, dtype=np.int64), 0).sum(axis=-1)
        return cls(
            objective=objective, cell=cell, budget_w=budget_w, weight=weight, low=low, high=high,
            priced=PricedSets.of(objective, sets, weight, low, high, unit), needed_by_set=_needed(sets, low),
            owner=owner, held=held, group_size=size, num_subcarriers=subcarriers,
        )  # fmt: skip

    @property
    def needed_w(self) -> FloatArray:
        """The least power for the low rates on each assignment, infinite where they cannot be carried."""
        return self.total(self.needed_by_set)

    def total(self, by_set: FloatArray, which: IntArray | slice = slice(None)) -> FloatArray:
        """Σ over users of a figure (…, set, user) for the assignments ``which``; (…, assignment)."""
        return by_set[..., self.held[which], np.arange(self.weight.size)].sum(axis=-1)

    def allocation(self, assignment: int, nats: FloatArray) -> tuple[IntArray, FloatArray]:
        """Owner and power (subcarrier,) that carry rates (user,) on an assignment, at the least power."""
        users = np.arange(nats.size)
        mine = self.priced.sets.pick((self.held[assignment], users))
        each = mine.nats(mine.level_of_rate(nats))
        power_w = (np.expm1(each) * mine.inverse).sum(axis=0)
        power_w = power_w * min(1.0, self.budget_w / max(float(power_w.sum()), 1e-300))
        group = np.arange(self.num_subcarriers) // self.group_size
        idle = np.bincount(group, weights=power_w) == 0
        return np.where(idle, -1, self.owner[assignment])[group], power_w

    def largest_share(self) -> _Found:
        """The assignment and the rates of the largest s with rates max(low, ω s) within the budget."""
        shared = self.weight > 0
        most = np.minimum(self.priced.sets.rate_nats(self.priced.sets.top).max(axis=0), self.high)
        largest = float((most[shared] / self.weight[shared]).min())

        def asked(share: FloatArray) -> FloatArray:
            return np.maximum(self.low, np.minimum(self.weight * share[..., np.newaxis], self.high))

        def least(share: FloatArray) -> tuple[FloatArray, IntArray]:
            needed = self.total(_needed(self.priced.sets, asked(share)[:, np.newaxis]))
            return needed.min(axis=-1), needed.argmin(axis=-1)

        steps = largest * np.concatenate([[1.0], 10.0 ** -np.arange(0.5, 40.0, 1.0), [0.0]])
        fits = least(steps)[0] <= self.budget_w
        fits[-1] = True  # the caller has seen that the low rates can be carried
        first = int(fits.argmax())
        below, above = float(steps[first]), float(steps[max(first - 1, 0)])
        for _ in range(18):
            points = below + (above - below) * _STEPS
            fits = least(points)[0] <= self.budget_w
            last = int(np.flatnonzero(fits | (points <= below)).max())
            below, above = float(points[last]), float(points[min(last + 1, _STEPS.size - 1)])
        share = np.array([below])
        nats = asked(share)[0]
        above = max(above, float((nats[shared] / self.weight[shared]).min()))  # the low rates may be worth more
        at_best = self.objective.utility(np.full(self.weight.shape, above * self.priced.bps_per_nat))[shared].min()
        return _Found(int(least(share)[1][0]), nats, float(at_best))

    def best_sum(self, possible: IntArray) -> _Found:
        """The assignment and the rates of the best sum of utilities, or of the best ratio to the power drawn."""
        race = Race(
            priced=self.priced, held=self.held[possible], needed_w=self.needed_w[possible], low=self.low,
            budget_w=self.budget_w, cell=self.cell, is_ratio=self.objective.measure == "efficiency",
        )  # fmt: skip
        best, nats = race.run()
        return _Found(int(possible[best]), nats, race.ceiling)


def _needed(sets: OwnedSets, nats: FloatArray) -> FloatArray:
    """The least power for rates (…, user) on sets (…, user); infinite where a set cannot carry them."""
    power_w = sets.power_w(sets.level_of_rate(nats))
    return np.where(nats > sets.knot_nats[..., -1] * (1 + 1e-13), np.inf, power_w)


def _each(value: ArrayLike | None, default: float, users: int) -> FloatArray:
    return np.broadcast_to(np.asarray(default if value is None else value, dtype=np.float64), (users,))

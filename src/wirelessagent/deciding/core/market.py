"""Users who want sets of columns, and what a joint choice of sets is worth.

Every problem that this package solves is, at a given efficiency q or common rate t, an auction of columns (subcarriers,
or groups of them that are owned together): choose a set S_k for every user, no column twice, for

    max Σ U_k(r_k) − q Σ P_k   with Σ P_k ≤ P    =    min over μ ≥ q of Σ V_k(S_k; μ) + (μ − q) P,

by strong duality on given sets. A sum of utilities has q = 0, the least power q = 1 without a budget; see
:mod:`.bundle_kernel` for V and the users' rows.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from wirelessagent.deciding.core.time_limit import TimeLimit
from wirelessagent.model.arrays import FloatArray, IntArray

NOTHING = -0.5e200
"""Values below are those of sets without a rate that their user must have; see :mod:`.bundle_kernel`."""
_STEPS = 200
_FARTHEST = 80.0
_HASH_SEED = 20260


@dataclass(frozen=True, kw_only=True, eq=False)
class Sets:
    """A list of sets of columns, each with its user.

    Attributes:
        user: shape (set,).
        first: where each set begins in ``member``, and the length of that, shape (set + 1,).
        member: the sets' columns, one set after the other.
    """

    user: IntArray
    first: IntArray
    member: IntArray

    @classmethod
    def of_owner(cls, owner: IntArray, num_users: int) -> Sets:
        """One set per user, from the owner of each column (−1 for nobody)."""
        member = np.flatnonzero(owner >= 0)
        member = member[np.argsort(owner[member], kind="stable")]
        first = np.concatenate([[0], np.cumsum(np.bincount(owner[member], minlength=num_users))])
        return cls(user=np.arange(num_users), first=first, member=member)

    def __len__(self) -> int:
        return self.user.size

    @property
    def size(self) -> IntArray:
        """Columns of each set, shape (set,)."""
        return np.diff(self.first)

    def chosen(self, which: IntArray) -> Sets:
        """Some of the sets, in this order."""
        size = self.size[which]
        first = np.concatenate([[0], np.cumsum(size)])
        place = np.arange(int(first[-1])) - np.repeat(first[:-1] - self.first[which], size)
        return Sets(user=self.user[which], first=first, member=self.member[place])

    def joined(self, others: Sets) -> Sets:
        """These and then those."""
        return Sets(
            user=np.concatenate([self.user, others.user]),
            first=np.concatenate([self.first, self.first[-1] + others.first[1:]]),
            member=np.concatenate([self.member, others.member]),
        )

    def with_others(self, others: Sets) -> Sets:
        """These and those that are not yet among them."""
        both = self.joined(others)
        _, where = np.unique(both.digest(), return_index=True)
        return both.chosen(np.sort(where))

    def digest(self) -> IntArray:
        """A number for each set, which is the same for the same user and columns in any order, shape (set,)."""
        columns = int(self.member.max(initial=0)) + 1
        number = np.random.default_rng(_HASH_SEED).integers(
            0, 2**63, (2, max(columns, int(self.user.max(initial=0)) + 1))
        )
        total = np.concatenate([[0], np.cumsum(number[0][self.member])])  # wraps around
        return total[self.first[1:]] - total[self.first[:-1]] + number[1][self.user]

    def net(self, worth: FloatArray, price: FloatArray) -> FloatArray:
        """``worth`` (set,) less the prices of the sets' columns."""
        paid = np.concatenate([[0.0], np.cumsum(price[self.member])])
        return worth - (paid[self.first[1:]] - paid[self.first[:-1]])

    def owner(self, columns: int) -> IntArray:
        """The user of each column, −1 where it is in no set, shape (column,)."""
        owner = np.full(columns, -1, dtype=np.int64)
        owner[self.member] = np.repeat(self.user, self.size)
        return owner


@dataclass(frozen=True, kw_only=True, eq=False)
class Market:
    """The users, the columns and the power of the module's docstring.

    Attributes:
        users: rows of six, shape (user, 6).
        floor, inverse, ceiling: −ln a, 1/a and the most nats, shape (user, subcarrier); a ceiling of 0 where a pair
            may not be used.
        start: where each column begins, and the number of subcarriers, shape (column + 1,).
        cost_per_w: q, what a watt costs in any case.
        budget_w: P; infinite where there is none, and then q is above 0.
        limit: when what is searched in it has to end.
    """

    users: FloatArray
    floor: FloatArray
    inverse: FloatArray
    ceiling: FloatArray
    start: IntArray
    cost_per_w: float
    budget_w: float
    limit: TimeLimit = field(default_factory=TimeLimit)

    @classmethod
    def of(
        cls,
        users: FloatArray,
        snr_per_w: FloatArray,
        ceiling: FloatArray,
        start: IntArray,
        *,
        cost_per_w: float,
        budget_w: float,
        limit: TimeLimit | None = None,
    ) -> Market:
        """From a (user, subcarrier), in 1/W, 0 where a pair may not be used, and the most nats there."""
        with np.errstate(divide="ignore"):
            floor = np.where(snr_per_w > 0, -np.log(snr_per_w), 0.0)
            inverse = np.where(snr_per_w > 0, 1.0 / snr_per_w, 0.0)
        return cls(
            users=np.ascontiguousarray(users),
            floor=floor,
            inverse=inverse,
            ceiling=np.where(snr_per_w > 0, ceiling, 0.0),
            start=np.ascontiguousarray(start),
            cost_per_w=cost_per_w,
            budget_w=budget_w,
            limit=limit or TimeLimit(),
        )

    def with_users(self, users: FloatArray, cost_per_w: float | None = None) -> Market:
        """The same columns for users of other rows, and at another cost of power."""
        cost_per_w = self.cost_per_w if cost_per_w is None else cost_per_w
        return replace(self, users=np.ascontiguousarray(users), cost_per_w=cost_per_w)

    @property
    def columns(self) -> int:
        return self.start.size - 1

    @property
    def least_log_mu(self) -> float:
        """ln q."""
        return float(np.log(self.cost_per_w)) if self.cost_per_w > 0 else -np.inf

    def left_w(self, log_mu: float) -> float:
        """(μ − q) P: what the budget is worth at the price μ; 0 where there is no budget."""
        return 0.0 if np.isinf(self.budget_w) else float((np.exp(log_mu) - self.cost_per_w) * self.budget_w)

    def worths(self, sets: Sets, log_mu: float) -> tuple[FloatArray, FloatArray]:
        """V(S; μ) and the power of each set, (set,); nothing for those that time does not suffice for."""
        from wirelessagent.deciding.core.columns_kernel import worths

        return worths(
            self.users, self.floor, self.inverse, self.ceiling, self.start, log_mu, sets.user, sets.first,
            sets.member, self.limit.work,
        )  # fmt: skip

    def value(self, sets: Sets, near_log_mu: float = 0.0) -> tuple[float, float]:
        """What one set for each user is worth together, and the ln μ of its budget; −inf where it cannot be.

        The price of power is bracketed from ``near_log_mu`` and found by halving and secants in ln μ; the power at the
        price found does not exceed the budget.
        """
        low = self.least_log_mu
        near_log_mu = min(max(near_log_mu, -_FARTHEST), _FARTHEST)
        if np.isinf(self.budget_w):
            return self._at(sets, low), low

        def above(log_mu: float) -> float:
            return float(self.worths(sets, log_mu)[1].sum()) / self.budget_w - 1.0

        if low > -np.inf and above(low) <= 0.0:
            return self._at(sets, low), low
        high = max(near_log_mu, low)
        step = 0.5
        excess = above(high)
        while excess > 0.0:
            low, high, step = high, high + step, 2.0 * step
            if step > 2.0 * _FARTHEST:
                return -np.inf, high
            excess = above(high)
        if low < near_log_mu:
            step = 0.5
            low = max(near_log_mu - step, self.least_log_mu)
            while above(low) <= 0.0:
                high, low, step = low, low - step, 2.0 * step
                if step > 2.0 * _FARTHEST:  # more power is of no use
                    return self._at(sets, high), high
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            if above(middle) > 0.0:
                low = middle
            else:
                high = middle
        return self._at(sets, high), high

    def totals(self, sets: Sets, log_mu: float) -> tuple[float, float]:
        """Σ U and Σ P of some sets at the price μ; U is −∞ where a user lacks a rate that it must have."""
        value, power = self.worths(sets, log_mu)
        total = float(power.sum())
        return (float(value.sum()) + float(np.exp(log_mu)) * total if value.min() > NOTHING else -np.inf), total

    def _at(self, sets: Sets, log_mu: float) -> float:
        utility, power = self.totals(sets, log_mu)
        return utility - self.cost_per_w * power

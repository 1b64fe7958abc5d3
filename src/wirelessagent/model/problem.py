"""One composable problem: an objective and whatever tightens the cell's limits."""

from __future__ import annotations

import dataclasses
from dataclasses import KW_ONLY, dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from wirelessagent.model.arrays import BoolArray, FloatArray, amounts, frozen, per_user, positive, shown, whole, within
from wirelessagent.model.cell import Cell
from wirelessagent.model.doors import through
from wirelessagent.model.errors import InputError
from wirelessagent.model.objective import Objective
from wirelessagent.model.shown import Plain
from wirelessagent.model.units import human
from wirelessagent.model.user_names import by_name, index_of, numbered

_WIDEST = 1e12
"""How far apart weights may lie; sums of rates so weighted would lose the digits of the smaller ones."""


@dataclass(frozen=True, repr=False)
class Problem(Plain):
    """What to optimise, under which constraints. None means: as the cell has it, or not constrained.

    Attributes:
        objective: a registered name or alias ("max_rate", "P1"), or an objective with its options.
        weights: relative worth of each user's rate, one value or (user,); 0 for a user whose rate counts for nothing.
            Where the smallest rate counts they are shares: a user of weight 2 gets twice the rate.
        min_rate_bps: rate each user must get, one value or (user,), in bit/s.
        max_rate_bps: rate beyond which a user has nothing to send, one value or (user,), in bit/s; inf = full buffer.
        max_power_w: radiated power budget in W; at most the cell's.
        subcarrier_max_power_w: power cap per subcarrier in W, one value or (subcarrier,).
        forbidden: True where a user may not use a subcarrier, bool, shape (user, subcarrier); that bars it from the
            subcarrier's whole group.
        users: the users to serve, by name as in ("user 3",); None serves all.
        user_names: the names of the channel's users, which :meth:`for_users` puts here; None before.
        resource_block_group_size: number of adjacent subcarriers that are assigned together.
        outage_probability: accepted probability that a user's true rate stays below the promised one.
    """

    objective: str | Objective
    _: KW_ONLY
    weights: ArrayLike | None = None
    min_rate_bps: ArrayLike | None = None
    max_rate_bps: ArrayLike | None = None
    max_power_w: float | None = None
    subcarrier_max_power_w: ArrayLike | None = None
    forbidden: BoolArray | None = None
    users: tuple[str, ...] | None = None
    user_names: tuple[str, ...] | None = field(default=None, repr=False, compare=False)
    resource_block_group_size: int = 1
    outage_probability: float | None = None

    def __post_init__(self) -> None:
        if isinstance(self.objective, str):
            through("check_objective")(self.objective)
        for name in ("weights", "min_rate_bps", "max_rate_bps", "subcarrier_max_power_w"):
            if getattr(self, name) is not None:
                infinite = name in ("max_rate_bps", "subcarrier_max_power_w")
                object.__setattr__(self, name, amounts(name, getattr(self, name), infinite=infinite))
        if self.max_power_w is not None:
            object.__setattr__(self, "max_power_w", positive("max_power_w", self.max_power_w))
        if self.forbidden is not None:
            object.__setattr__(self, "forbidden", _switches(self.forbidden))
        if self.users is not None:
            object.__setattr__(self, "users", by_name("users", self.users))
            if self.user_names is not None:
                _ = self.user_indices  # who is not there is named
        group = whole("resource_block_group_size", self.resource_block_group_size)
        object.__setattr__(self, "resource_block_group_size", group)
        if self.outage_probability is not None:
            within("outage_probability", self.outage_probability, 0, 1, above=True, below=True)
        if self.weights is not None:
            self._check_weights(np.asarray(self.weights))

    def resolved(self, objective: Objective) -> Problem:
        """The same problem with its objective looked up; the rest has been validated before."""
        if self.weights is not None:
            return dataclasses.replace(self, objective=objective)  # which must take weights
        return self._with(objective=objective)

    @property
    def promises_rates(self) -> bool:
        """Whether anybody must get a rate; else the rates of a decision are only what it commits itself to."""
        return self.min_rate_bps is not None and bool(np.any(np.asarray(self.min_rate_bps) > 0))

    @property
    def firmness(self) -> Literal["promised", "asked", "committed"]:
        """What rates are: promised with a probability, only asked for, or committed by the decision alone."""
        if not self.promises_rates:
            return "committed"
        return "asked" if self.outage_probability is None else "promised"

    def for_users(self, names: tuple[str, ...]) -> Problem:
        """The same problem on a channel whose users have these names: now it has ``user_indices``.

        Raises:
            InputError: nobody has a name in ``users``, or a user must get more than it can use.
        """
        if self.user_names == names:
            return self
        problem = self._with(user_names=names)
        _ = problem.user_indices
        if self.max_rate_bps is not None:
            problem.max_rates_bps(len(names))
        return problem

    @property
    def user_indices(self) -> tuple[int, ...] | None:
        """The users to serve as indices from 0 into the channel's names and every array of users; None serves all.

        Raises:
            InputError: the channel is not known yet, or nobody there has a name in ``users``.
        """
        if self.users is None:
            return None
        if self.user_names is None:
            raise InputError(
                f"users are named ({self.users[0]!r}), and only the channel knows who that is: call "
                "wirelessagent.decide(), or Problem.for_users(names)"
            )
        return tuple(index_of(user, self.user_names) for user in self.users)

    def budget_w(self, cell: Cell) -> float:
        """The power budget in W; an error where the problem asks for more than the cell may radiate."""
        if self.max_power_w is None:
            return cell.max_power_w
        if self.max_power_w > cell.max_power_w * (1 + 1e-12):
            raise InputError(
                f"max_power_w = {self.max_power_w:g} W is above the cell's limit of {cell.max_power_w:g} W: "
                "ask for less, or raise the cell's max_power_w"
            )
        return self.max_power_w

    def serves(self, num_users: int) -> BoolArray:
        """True for the users to serve, shape (user,)."""
        indices = self.user_indices
        if indices is None:
            return np.ones(num_users, dtype=bool)
        return np.isin(np.arange(num_users), indices)

    def allows(self, shape: tuple[int, int]) -> BoolArray:
        """True where a user may use a subcarrier, ``shape`` (user, subcarrier).

        Who is forbidden one subcarrier of a resource-block group cannot own the group.

        Raises:
            InputError: ``forbidden`` has another shape.
        """
        if self.forbidden is None:
            return np.ones(shape, dtype=bool)
        if self.forbidden.shape != shape:
            raise InputError(
                "forbidden must be True where a user may not use a subcarrier, with the channel's shape "
                f"(user, subcarrier) = {shape}; got shape {self.forbidden.shape}"
            )
        start = np.arange(0, shape[1], self.resource_block_group_size)
        barred = np.logical_or.reduceat(self.forbidden, start, axis=1)
        return ~np.repeat(barred, np.diff(np.append(start, shape[1])), axis=1)

    def weights_of(self, num_users: int) -> FloatArray:
        """Each user's weight, shape (user,): 1 where none is set, 0 for users who are not served.

        Raises:
            InputError: nobody who is served has a weight above 0.
        """
        weight = per_user("weights", 1.0 if self.weights is None else self.weights, num_users)
        if self.users is not None:
            weight = frozen(np.where(self.serves(num_users), weight, 0.0))
        if not weight.any():
            raise InputError(f"weights are 0 for every user to serve; got {shown(self.weights)}: give one more than 0")
        return weight

    def min_rates_bps(self, num_users: int) -> FloatArray:
        """The rate each user must get, shape (user,), 0 where there is no promise."""
        return per_user("min_rate_bps", 0.0 if self.min_rate_bps is None else self.min_rate_bps, num_users)

    def max_rates_bps(self, num_users: int) -> FloatArray:
        """The rate beyond which each user has nothing to send, shape (user,), inf where there is none.

        Raises:
            InputError: a user must get more than it can use.
        """
        if self.max_rate_bps is None:
            return per_user("max_rate_bps", np.inf, num_users)
        most = per_user("max_rate_bps", self.max_rate_bps, num_users)
        least = self.min_rates_bps(num_users)
        crossed = np.flatnonzero((least > most) & self.serves(num_users))
        if crossed.size:
            called = self.user_names or numbered(num_users)
            pairs = ", ".join(
                f"{called[user]}: {human(float(least[user]), 'bit/s')} above {human(float(most[user]), 'bit/s')}"
                for user in crossed[:5]
            )
            more = f" and {crossed.size - 5} more" if crossed.size > 5 else ""
            raise InputError(
                f"min_rate_bps is above max_rate_bps for {crossed.size} of {num_users} users "
                f"({pairs}{more}): lower the one or raise the other"
            )
        return most

    def constraints(self) -> dict[str, object]:
        """The constraints that are set, by field name, for messages and records."""
        names = (
            "weights", "min_rate_bps", "max_rate_bps", "max_power_w", "subcarrier_max_power_w", "forbidden",
            "users", "outage_probability",
        )  # fmt: skip
        found: dict[str, object] = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        if self.resource_block_group_size > 1:
            found["resource_block_group_size"] = self.resource_block_group_size
        return found

    def _with(self, **fields: object) -> Problem:
        """The same problem with other fields that are known to fit; the rest has been validated before."""
        found = object.__new__(type(self))
        found.__dict__.update(self.__dict__, **fields)
        return found

    def _check_weights(self, weights: FloatArray) -> None:
        if not weights.any():
            raise InputError(f"weights are all 0; got {shown(self.weights)}: give a user one above 0")
        if weights.max() > _WIDEST * weights[weights > 0].min():
            raise InputError(
                f"weights lie more than {_WIDEST:g} times apart; got {shown(self.weights)}: "
                "leave users out that count for nothing, or give them 0"
            )
        if isinstance(self.objective, Objective) and self.objective.measure == "power":
            raise InputError(
                f"weights mean nothing to {self.objective.name!r}, which counts power alone; "
                f"got {shown(self.weights)}: leave them out"
            )


def _switches(forbidden: ArrayLike) -> BoolArray:
    """The mask as a read-only array; numbers other than 0 and 1 are pairs of indices, most likely."""
    mask = np.asarray(forbidden)
    if mask.ndim != 2 or (mask.dtype != np.bool_ and not np.isin(mask, (0, 1)).all()):
        raise InputError(
            "forbidden must be an array of shape (user, subcarrier) that is True where a user may not use a "
            f"subcarrier; got {shown(forbidden)}: start from np.zeros(gain.shape, dtype=bool)"
        )
    return frozen(mask.astype(bool))

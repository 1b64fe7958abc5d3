"""Who gets which subcarrier at what power, with a certificate."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, TypeAlias

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray, frozen
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.forecast import Forecast, forecast
from wirelessagent.model.objective import Objective
from wirelessagent.model.problem import Problem
from wirelessagent.model.shown import Picture, Plain, Shown, Summary
from wirelessagent.model.units import human, percent, reliability

Status: TypeAlias = Literal["optimal", "feasible", "infeasible", "undecided"]

OPTIMAL_GAP = 1e-9
"""Relative gap up to which a decision counts as optimal."""


@dataclass(frozen=True, kw_only=True)
class Bracket:
    """A figure known from two sides: it is at least this and at most that; NaN where a side is not known.

    Of the power that promised rates need, ``at_least`` is proven and ``at_most`` was found to suffice; of the largest
    common factor on the promised rates, ``at_least`` was found and ``at_most`` is proven.
    """

    at_least: float
    at_most: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Prices(Plain):
    """Where the search for a decision ended: hand the decision to ``wa.decide(…, after=decision)`` to start there.

    Attributes:
        log_rate: ln of the price of each user's rate in W per nat, shape (user,).
        log_power: ln of the price of power in the objective's utility per W; 0 where power itself is the objective.
    """

    log_rate: FloatArray
    log_power: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "log_rate", frozen(self.log_rate))


@dataclass(frozen=True, kw_only=True, repr=False)
class Decision(Shown):
    """An allocation for the current slot.

    Attributes:
        owner: the user of each subcarrier, −1 for nobody, shape (subcarrier,).
        power_w: radiated power on each subcarrier, shape (subcarrier,).
        rate_bps: each user's predicted rate on the channel that was decided on, shape (user,): the estimated one, on
            which uncertain gains count by their mean rates where nothing is promised. With an outage probability it is
            the rate that the true one stays below with that probability at most.
        status: "optimal" (gap ≤ 1e-9 or proven), "feasible", "infeasible" (with proof) or "undecided" (nothing
            feasible found and no proof that nothing exists).
        value: the objective's value on the estimated channel, or at the rates that are promised with an outage
            probability; NaN where nothing feasible was found.
        bound: the best value that any allocation can reach on the estimated channel, or with promises of that outage
            probability under the estimate's posterior; NaN if the method has none.
        gap: \\|value − bound\\| / \\|bound\\|; 0/0 is 0; NaN without a bound.
        unit: the unit of ``value`` and ``bound``.
        reason: one sentence on why it is infeasible or undecided, or on what else to know of it; empty otherwise.
        price_of_power: change of the best value per extra watt, in the value's unit per W; NaN if not known.
        price_of_rate: change of the best value per extra bit/s promised to each user, shape (user,);
            empty if not known.
        needed_power_w: the power that the promised rates need, whatever the budget; None where none are promised.
        rate_scaling: the largest common factor on the promised rates that the budget carries; None likewise.
        iterations: outer iterations done by the method.
        restarts: restarts of a local search done by the method.
        steps: of the search: given to the method as its option ``steps``, beside ``restarts`` where it has that, they
            make the same decision again where a deadline ended it.
        prices: where the search ended, for the next slot's to start from; None if the method does not search prices.
        expected_rate_bps: each user's mean rate under the estimate's posterior, shape (user,), where an outage
            probability is accepted; empty otherwise.
        outage: the probability that each user's true rate is below ``rate_bps`` under that posterior, by draws that the
            decision did not see, shape (user,); empty likewise.
        method: registered name of the method.
        problem: the problem solved, with its objective resolved.
        cell: the cell it was solved for.
        user_names: one name per user.
        estimate: what was known of the channel; None where a method was asked by itself and does not tell.
        kernels: whether machine code ran alone or some kernels were interpreted; "" where a method was asked by itself.
            The last bits of figures depend on it.
    """

    owner: IntArray
    power_w: FloatArray
    rate_bps: FloatArray
    status: Status
    value: float
    bound: float
    gap: float
    unit: str
    method: str
    problem: Problem
    cell: Cell
    user_names: tuple[str, ...]
    reason: str = ""
    price_of_power: float = np.nan
    price_of_rate: FloatArray = field(default_factory=lambda: np.empty(0))
    needed_power_w: Bracket | None = None
    rate_scaling: Bracket | None = None
    iterations: int = 0
    restarts: int = 0
    steps: int = 0
    prices: Prices | None = None
    expected_rate_bps: FloatArray = field(default_factory=lambda: np.empty(0))
    outage: FloatArray = field(default_factory=lambda: np.empty(0))
    estimate: ChannelEstimate | None = field(default=None, repr=False, compare=False)
    kernels: Literal["", "compiled", "interpreted"] = field(default="", compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "problem", self.problem.for_users(self.user_names))
        for name in ("owner", "power_w", "rate_bps", "price_of_rate", "expected_rate_bps", "outage"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    _derived: ClassVar[tuple[str, ...]] = ("is_usable", "total_power_w")

    def summary(self) -> Summary:
        objective = self.problem.objective
        aim = objective if isinstance(objective, str) else objective.name
        found = f", {human(self.value, self.unit)}" if self.is_usable else ""
        title = f"Decision: {self.status}{found} ({aim} by {self.method})"
        bound = [("bound", f"{human(self.bound, self.unit)}, gap {percent(self.gap)}")]
        rows = [*([] if np.isnan(self.bound) else bound), *(self._allocation_rows() if self.is_usable else [])]
        if self.problem.promises_rates and self.needed_power_w is not None:
            least, enough = (human(one, "W") for one in (self.needed_power_w.at_least, self.needed_power_w.at_most))
            rows.append(("power needed", f"at least {least}, enough {enough}"))
        if self.reason:
            rows.append(("reason", self.reason))
        return Summary(title=title, rows=tuple(rows))

    def _allocation_rows(self) -> list[tuple[str, str]]:
        budget, outage = self.problem.budget_w(self.cell), self.problem.outage_probability
        served = self.served
        used, size = int(np.count_nonzero(self.power_w > 0)), self.owner.size
        least, most, total = (
            float(one) for one in (self.rate_bps[served].min(), self.rate_bps.max(), self.rate_bps.sum())
        )
        lowest = self.user_names[int(np.where(served, self.rate_bps, np.inf).argmin())]
        rates = f"{human(total, 'bit/s')} in all, {human(least, 'bit/s')} ({lowest}) to {human(most, 'bit/s')}"
        power = f"{human(self.total_power_w, 'W')} of {human(budget, 'W')}, on {used} of {size} subcarriers"
        sure = [] if outage is None else [("kept with", reliability(outage))]
        return [("rates", rates), *sure, ("power", power)]

    def picture(self) -> Picture:
        return Picture(kind="decision", parts={"decision": self})

    def columns(self) -> Mapping[str, Any]:
        """One row for each subcarrier: its owner by number and name ("" for nobody), and its power."""
        names = np.array([*self.user_names, ""])[self.owner]
        return {"subcarrier": np.arange(self.owner.size), "owner": self.owner, "user": names, "power_w": self.power_w}

    def knowing(self, estimate: ChannelEstimate, kernels: Literal["", "compiled", "interpreted"] = "") -> Decision:
        """The same decision with what was known of the channel, and how it was computed."""
        found = object.__new__(type(self))
        found.__dict__.update(self.__dict__, estimate=estimate, kernels=kernels)
        found.__dict__.pop("forecast", None)
        return found

    @property
    def served(self) -> BoolArray:
        """Which users the problem serves, shape (user,)."""
        return self.problem.serves(self.rate_bps.size)

    @property
    def is_usable(self) -> bool:
        """Whether the allocation keeps every constraint and may be applied."""
        return self.status in ("optimal", "feasible")

    @functools.cached_property
    def forecast(self) -> Forecast | None:
        """What the true channel will carry by the estimate's posterior; None where nothing is uncertain.

        Rates are committed between what each user was promised and the most that it can use; where the power is to be
        least, to what was promised.
        """
        if self.estimate is None or not self.is_usable:
            return None
        users, problem = self.rate_bps.size, self.problem
        least, most = problem.min_rates_bps(users), problem.max_rates_bps(users)
        if self.outage.size or (isinstance(problem.objective, Objective) and problem.objective.measure == "power"):
            least = most = self.rate_bps
        return forecast(self.estimate, self.owner, self.power_w, self.cell, least_bps=least, most_bps=most)

    @property
    def committed_bps(self) -> FloatArray:
        """The rate that each user is sent at, shape (user,): what of it the true channel does not carry is lost.

        With certain gains, with an outage probability and where the power is to be least it is ``rate_bps``; else that
        of which most is expected to arrive (:mod:`wirelessagent.model.forecast`).
        """
        return self.rate_bps if self.forecast is None else self.forecast.committed_bps

    @property
    def total_power_w(self) -> float:
        return float(self.power_w.sum())

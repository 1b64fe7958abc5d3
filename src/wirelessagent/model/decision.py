"""Who gets which subcarrier at what power, with a certificate."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray, frozen
from wirelessagent.model.cell import Cell
from wirelessagent.model.problem import Problem

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Prices:
    """Where the search for a decision ended: hand the decision to ``wa.decide(…, after=decision)`` to start there.

    Attributes:
        log_rate: ln of the price of each user's rate in W per nat, shape (user,).
        log_power: ln of the price of power in the objective's utility per W; 0 where power itself is the objective.
    """

    log_rate: FloatArray
    log_power: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "log_rate", frozen(self.log_rate))


@dataclass(frozen=True, kw_only=True)
class Decision:
    """An allocation for the current slot.

    Attributes:
        owner: the user of each subcarrier, −1 for nobody, shape (subcarrier,).
        power_w: radiated power on each subcarrier, shape (subcarrier,).
        rate_bps: each user's predicted rate on the estimated channel, shape (user,); this is what is promised. With an
            outage probability it is the rate that the true one stays below with that probability at most.
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
        restarts: restarts of a local search done by the method: given to it as its option ``restarts``, they make the
            same decision again where a deadline ended it.
        prices: where the search ended, for the next slot's to start from; None if the method does not search prices.
        expected_rate_bps: each user's mean rate under the estimate's posterior, shape (user,), where an outage
            probability is accepted; empty otherwise.
        outage: the probability that each user's true rate is below ``rate_bps`` under that posterior, by draws that the
            decision did not see, shape (user,); empty likewise.
        method: registered name of the method.
        problem: the problem solved, with its objective resolved.
        cell: the cell it was solved for.
        user_names: one name per user.
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
    prices: Prices | None = None
    expected_rate_bps: FloatArray = field(default_factory=lambda: np.empty(0))
    outage: FloatArray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        for name in ("owner", "power_w", "rate_bps", "price_of_rate", "expected_rate_bps", "outage"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def is_usable(self) -> bool:
        """Whether the allocation keeps every constraint and may be applied."""
        return self.status in ("optimal", "feasible")

    @property
    def total_power_w(self) -> float:
        return float(self.power_w.sum())

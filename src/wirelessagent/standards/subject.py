"""What a document speaks of, and what each metric of a standard is for it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.metrics import energy_efficiency_bit_per_j
from wirelessagent.model.objective import Objective
from wirelessagent.model.outcome import Outcome
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import lower_rates, more_power

JOULES_PER_KWH = 3.6e6

OBSERVATION_PERIOD_S = 3600
"""For how long an allocation is taken to hold where a standard counts energy and not power."""


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A request and what came of it.

    Attributes:
        name: identifier of the intent, without spaces; that of its report follows from it.
        text: what the operator said.
        decision: what was decided.
        outcome: what the base station did, read back; None where nothing was applied.
        at: when that was, with its time zone.
        language: of the text, as in "en" or "zh".
        current: what was in effect before, read back; None where that is not known.
        taken_back: whether it was applied and is not in effect any more.
        observation_period_s: for how long the allocation is taken to hold, whole seconds.
    """

    name: str
    text: str
    decision: Decision
    at: datetime
    outcome: Outcome | None = None
    language: str = "en"
    current: Outcome | None = None
    taken_back: bool = False
    observation_period_s: int = OBSERVATION_PERIOD_S

    def __post_init__(self) -> None:
        if self.at.tzinfo is None:
            raise InputError(f"a document's time needs its time zone, as in datetime.now(UTC); got {self.at}")
        if not self.name or not all(sign.isalnum() or sign in "-_." for sign in self.name):
            raise InputError(f"a document's name consists of letters, digits, '-', '_' and '.'; got {self.name!r}")
        if not self.observation_period_s > 0:
            raise InputError(f"observation_period_s must be positive; got {self.observation_period_s!r}")

    @property
    def objective(self) -> Objective:
        objective = self.decision.problem.objective
        assert isinstance(objective, Objective)
        return objective

    @property
    def cell(self) -> Cell:
        return self.decision.cell

    @property
    def served(self) -> BoolArray:
        """True for the users to serve, shape (user,)."""
        return self.decision.served

    def energy_kwh(self, power_w: float) -> float:
        """What the cell draws while it radiates ``power_w`` for the observation period: (P/ξ + P_c)·T."""
        drawn_w = power_w / self.cell.amplifier_efficiency + self.cell.circuit_power_w
        return drawn_w * self.observation_period_s / JOULES_PER_KWH

    @functools.cached_property
    def needed_power_w(self) -> Bracket | None:
        """The power that the promised rates need; solved for where the decision found none that does.

        What is not known of it is NaN: without the estimate that it was made on nothing can be solved for.
        """
        need, case = self.decision.needed_power_w, self._case
        if need is None or case is None or np.isfinite(need.at_most):
            return need
        more = more_power(case)
        return need if more is None else Bracket(at_least=need.at_least, at_most=more.power_w)

    @functools.cached_property
    def rate_scaling(self) -> Bracket | None:
        """The largest common factor on the promised rates that the budget carries, likewise."""
        scaling, case = self.decision.rate_scaling, self._case
        if scaling is None or case is None or scaling.at_least > 0:
            return scaling
        lower = lower_rates(case)
        return scaling if lower is None else Bracket(at_least=lower.factor, at_most=lower.at_most)

    @property
    def _case(self) -> Case | None:
        """What an infeasible request was decided from, to solve for what can be met instead."""
        decision = self.decision
        if decision.estimate is None or decision.status != "infeasible":
            return None
        return Case(decision=decision, estimate=decision.estimate)

    def promised(self) -> State | None:
        """What the decision promises; None where it decides nothing."""
        decision = self.decision
        return State(decision.rate_bps, decision.total_power_w) if decision.is_usable else None

    def achieved(self) -> State | None:
        """What was read back on the true channel; None where that is not known, or is not in effect any more."""
        return None if self.taken_back else _read_back(self.outcome)

    def before(self) -> State | None:
        """What was in effect before on the true channel; None where that is not known."""
        return _read_back(self.current)


@dataclass(frozen=True)
class State:
    """What users get, shape (user,), and what the base station radiates."""

    rate_bps: FloatArray
    power_w: float


def _read_back(outcome: Outcome | None) -> State | None:
    if outcome is None or outcome.achieved is None:
        return None
    return State(outcome.achieved.user_rate_bps, float(np.sum(outcome.power_w)))


@dataclass(frozen=True, kw_only=True)
class Metric:
    """Something that a standard measures.

    Attributes:
        name: as the standard writes it; one of our own, named after the objective, where it has none.
        unit: the unit of :attr:`of`.
        of: its value for a subject in a state, with True for the users who are meant, shape (user,).
        of_figure: the same for a figure in the unit of the decision's value, as its bound.
        per_user: whether each user has its own value, of which the smallest is taken.
    """

    name: str
    unit: str
    of: Callable[[Subject, State, BoolArray], float]
    of_figure: Callable[[Subject, float], float]
    per_user: bool = False


AVERAGE_THROUGHPUT = Metric(
    name="AveDLRANUEThpt",
    unit="kbit/s",
    of=lambda subject, state, users: float(np.mean(state.rate_bps[users])) / 1e3,
    of_figure=lambda subject, total: total / int(subject.served.sum()) / 1e3,
)
"""Mean of the users' downlink rates. TS 28.312 names it, TS 28.552 clause 5.1.1.3 measures it in kbit/s."""

USER_THROUGHPUT = Metric(
    name="DlThptPerUE",
    unit="kbit/s",
    of=lambda subject, state, users: float(np.min(state.rate_bps[users])) / 1e3,
    of_figure=lambda subject, lowest: lowest / 1e3,
    per_user=True,
)
"""The downlink rate that each user gets, of the worst-off of those meant; as XLThpt of TS 28.541 in kbit/s."""

ENERGY_CONSUMPTION = Metric(
    name="RANEnergyConsumption",
    unit="kWh",
    of=lambda subject, state, users: subject.energy_kwh(state.power_w),
    of_figure=lambda subject, power_w: subject.energy_kwh(power_w),
)
"""Energy drawn in the observation period; TS 28.552 clause 5.1.1.19.3 (PEE.Energy) measures it in kWh."""

ENERGY_EFFICIENCY = Metric(
    name="RANEnergyEfficiency",
    unit="bit/J",
    of=lambda subject, state, users: energy_efficiency_bit_per_j(
        float(state.rate_bps.sum()), state.power_w, subject.cell
    ),
    of_figure=lambda subject, efficiency: efficiency,
)
"""Data volume over energy drawn, TS 28.554 clause 6.7.1, in bit/J (ETSI ES 203 228)."""


def objective_metric(subject: Subject) -> Metric:
    """The metric that the objective improves: the standards' own where they have one, else one named after it."""
    objective, unweighted = subject.objective, subject.decision.problem.weights is None
    if objective.measure == "power":
        return ENERGY_CONSUMPTION
    known = {
        "max_rate": AVERAGE_THROUGHPUT,
        "max_min_rate": USER_THROUGHPUT,
        "max_energy_efficiency": ENERGY_EFFICIENCY,
    }
    if unweighted and objective.name in known:
        return known[objective.name]
    in_kilobits = subject.decision.unit == "bit/s"
    factor, unit = (1e-3, "kbit/s") if in_kilobits else (1.0, subject.decision.unit)

    def worth(subject: Subject, state: State, users: BoolArray) -> float:
        weight = subject.decision.problem.weights_of(users.size)
        return factor * subject.objective.value(state.rate_bps, state.power_w, subject.cell, weight)

    weighted = "" if unweighted else "Weighted"
    name = weighted + _camel(objective.name)
    return Metric(name=name, unit=unit, of=worth, of_figure=lambda subject, figure: factor * figure)


def _camel(name: str) -> str:
    """A registered name as the standards write names.

    >>> _camel("proportional_fairness")
    'ProportionalFairness'
    """
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))

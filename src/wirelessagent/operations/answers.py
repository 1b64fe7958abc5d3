"""The pieces that records share: an estimate, a decision and a report in JSON and in tables."""

from __future__ import annotations

from typing import Any

import numpy as np

from wirelessagent.explain.report import Report, cannot_be_served
from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.operations.record import Integers, Matrix, Record, SwitchMatrix, Table, Vector


class EstimateAnswer(Record):
    """A complete gain matrix with its uncertainty."""

    method: str
    user_names: list[str]
    gain: Matrix
    gain_variance: Matrix
    repaired: SwitchMatrix
    unobserved_users: list[str]

    @classmethod
    def of(cls, estimate: ChannelEstimate) -> EstimateAnswer:
        flagged = np.flatnonzero(estimate.unobserved_users)
        return cls(
            method=estimate.method,
            user_names=list(estimate.user_names),
            gain=estimate.gain,  # pyright: ignore[reportArgumentType]  # the field's validator takes arrays
            gain_variance=estimate.gain_variance,  # pyright: ignore[reportArgumentType]
            repaired=estimate.repaired,  # pyright: ignore[reportArgumentType]
            unobserved_users=[estimate.user_names[user] for user in flagged],
        )


class BracketAnswer(Record):
    """A figure known from two sides."""

    at_least: float
    at_most: float


class DecisionAnswer(Record):
    """An allocation with its certificate; users and subcarriers counted from 0, owner −1 = nobody."""

    objective: str
    method: str
    status: str
    reason: str
    value: float
    bound: float
    gap: float
    unit: str
    owner: Integers
    power_w: Vector
    rate_bps: Vector
    outage_probability: float | None
    expected_rate_bps: Vector
    outage: Vector
    total_power_w: float
    max_power_w: float
    price_of_power: float
    price_of_rate: Vector
    needed_power_w: BracketAnswer | None
    rate_scaling: BracketAnswer | None
    iterations: int
    restarts: int
    user_names: list[str]

    @classmethod
    def fields_of(cls, decision: Decision) -> dict[str, Any]:
        """A decision as field values of this record or of one that extends it."""
        objective = decision.problem.objective
        copied = (
            "method", "status", "reason", "value", "bound", "gap", "unit", "owner", "power_w", "rate_bps",
            "expected_rate_bps", "outage", "total_power_w", "price_of_power", "price_of_rate", "iterations", "restarts",
        )  # fmt: skip
        return {
            **{name: getattr(decision, name) for name in copied},
            "objective": objective if isinstance(objective, str) else objective.name,
            "outage_probability": decision.problem.outage_probability,
            "max_power_w": decision.problem.budget_w(decision.cell),
            "needed_power_w": _bracket(decision.needed_power_w),
            "rate_scaling": _bracket(decision.rate_scaling),
            "user_names": list(decision.user_names),
        }

    @classmethod
    def of(cls, decision: Decision) -> DecisionAnswer:
        return cls(**cls.fields_of(decision))


class MetricsAnswer(Record):
    """Figures of merit on one channel."""

    user_rate_bps: Vector
    sum_rate_bps: float
    goodput_bps: float
    power_w: float
    energy_efficiency_bit_per_j: float
    spectral_efficiency_bps_per_hz: float
    jain_index: float

    @classmethod
    def of(cls, metrics: LinkMetrics) -> MetricsAnswer:
        return cls(**{name: getattr(metrics, name) for name in cls.model_fields})


class ReportAnswer(Record):
    """Predicted beside achieved; achieved is null where the truth is not known."""

    predicted: MetricsAnswer
    achieved: MetricsAnswer | None
    missed_users: list[str]

    @classmethod
    def of(cls, report: Report) -> ReportAnswer:
        return cls(
            predicted=MetricsAnswer.of(report.predicted),
            achieved=None if report.achieved is None else MetricsAnswer.of(report.achieved),
            missed_users=[report.decision.user_names[user] for user in report.missed_users],
        )


def certificate_line(decision: Decision) -> str:
    """Status, value, bound and gap in one line."""
    if not decision.is_usable:
        return f"{decision.status}: {decision.reason} ({decision.method})"
    value = human(decision.value, decision.unit)
    if np.isnan(decision.gap):
        return f"{decision.status}: {value} ({decision.method}; no bound)"
    left_out = cannot_be_served(decision)
    outage = decision.problem.outage_probability
    of = "no allocation on this estimate does" if outage is None else f"no promises kept at {reliability(outage)} do"
    return (
        f"{decision.status}: {value}; {of} better than "
        f"{human(decision.bound, decision.unit)} (gap {percent(decision.gap)}; {decision.method})"
        + (f". Note: {left_out}" if left_out else "")
    )


def decision_tables(report: Report, estimate: ChannelEstimate) -> list[Table]:
    """What people want to see of a decision: users and figures, or what it would take where it cannot be done."""
    if report.decision.is_usable:
        return [user_table(report, estimate), report_table(report)]
    return [figures_of_infeasibility(report.decision)]


def figures_of_infeasibility(decision: Decision) -> Table:
    """What the request would need and what could be had, each from both sides."""
    rows: list[tuple[str, str, str]] = []
    if decision.needed_power_w is not None:
        need = decision.needed_power_w
        rows.append(("power that the promised rates need", human(need.at_least, "W"), human(need.at_most, "W")))
    if decision.rate_scaling is not None:
        scale = decision.rate_scaling
        rows.append(("largest common scaling of the promised rates", f"{scale.at_least:.3g}", f"{scale.at_most:.3g}"))
    return Table(title="What it would take", columns=("figure", "at least", "at most"), rows=tuple(rows))


def report_table(report: Report) -> Table:
    """Figures of merit, predicted beside achieved."""
    if report.achieved is None:
        rows = tuple((label, before) for label, before, _ in report.figures() if label != "Goodput")
        return Table(title="Predicted on the estimate", columns=("figure", "predicted"), rows=rows)
    return Table(
        title="Predicted on the estimate, achieved on the true channel",
        columns=("figure", "predicted", "achieved"),
        rows=tuple(report.figures()),
    )


def user_table(report: Report, estimate: ChannelEstimate | None = None) -> Table:
    """Each user's subcarriers, power and rate."""
    decision = report.decision
    judged = decision.problem.outage_probability is not None and decision.expected_rate_bps.size > 0
    rows: list[tuple[str, ...]] = []
    for user, name in enumerate(decision.user_names):
        own = decision.owner == user
        row = [name, str(int(own.sum()))]
        if estimate is not None:
            row.append(str(int((own & estimate.repaired[user]).sum())))
        row.append(human(float(decision.power_w[own].sum()), "W"))
        row.append(human(decision.rate_bps[user], "bit/s"))
        if judged:
            row.append(human(decision.expected_rate_bps[user], "bit/s"))
        if report.achieved is not None:
            missed = f" ({percent(_shortfall(report, user))} short)" if user in report.missed_users else ""
            row.append(human(report.achieved.user_rate_bps[user], "bit/s") + missed)
        rows.append(tuple(row))
    repaired = () if estimate is None else ("of them repaired",)
    achieved = () if report.achieved is None else ("achieved rate",)
    predicted = ("predicted rate",)
    if judged:
        predicted = (f"promised at {reliability(decision.problem.outage_probability or 0.0)}", "predicted rate")
    return Table(
        title="Users",
        columns=("user", "subcarriers", *repaired, "power", *predicted, *achieved),
        rows=tuple(rows),
    )


def _shortfall(report: Report, user: int) -> float:
    """By how much a user's true rate falls short of the promised one, as a share."""
    assert report.achieved is not None
    return float(1 - report.achieved.user_rate_bps[user] / report.decision.rate_bps[user])


def _bracket(bracket: Bracket | None) -> BracketAnswer | None:
    return None if bracket is None else BracketAnswer(at_least=bracket.at_least, at_most=bracket.at_most)

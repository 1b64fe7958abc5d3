"""The pieces that records share: an estimate, a decision and a report in JSON."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from pydantic import Field

from wirelessagent.operations.record import Integers, Matrix, Record, SwitchMatrix, Vector

if TYPE_CHECKING:
    from wirelessagent.model.decision import Bracket, Decision
    from wirelessagent.model.estimate import ChannelEstimate
    from wirelessagent.model.forecast import Forecast
    from wirelessagent.model.metrics import LinkMetrics
    from wirelessagent.telling.report import Report


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
        flagged = [name for name, alone in zip(estimate.user_names, estimate.unobserved_users, strict=True) if alone]
        return cls(
            method=estimate.method,
            user_names=list(estimate.user_names),
            gain=estimate.gain,  # pyright: ignore[reportArgumentType]  # the field's validator takes arrays
            gain_variance=estimate.gain_variance,  # pyright: ignore[reportArgumentType]
            repaired=estimate.repaired,  # pyright: ignore[reportArgumentType]
            unobserved_users=flagged,
        )


class BracketAnswer(Record):
    """A figure known from two sides."""

    at_least: float
    at_most: float


def _owner_means() -> str:
    from wirelessagent.acting.file import OWNER_MEANS

    return OWNER_MEANS


class DecisionAnswer(Record):
    """An allocation with its certificate; its arrays have users and subcarriers by index, from 0."""

    objective: str
    method: str
    status: str
    reason: str
    value: float
    bound: float
    gap: float
    unit: str
    owner: Integers
    owner_means: str = Field(default_factory=_owner_means)
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
    steps: int
    user_names: list[str]

    @classmethod
    def fields_of(cls, decision: Decision) -> dict[str, Any]:
        """A decision as field values of this record or of one that extends it."""
        objective = decision.problem.objective
        copied = (
            "method", "status", "reason", "value", "bound", "gap", "unit", "owner", "power_w", "rate_bps",
            "expected_rate_bps", "outage", "total_power_w", "price_of_power", "price_of_rate", "iterations", "restarts",
            "steps",
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


class ForecastAnswer(Record):
    """What the true channel will carry, by what is known of it: means, 90 % bands, and the rates committed."""

    mean_bps: Vector
    low_bps: Vector
    high_bps: Vector
    sum_low_bps: float
    sum_high_bps: float
    committed_bps: Vector
    carried: Vector

    @classmethod
    def of(cls, forecast: Forecast | None) -> ForecastAnswer | None:
        return None if forecast is None else cls(**{name: getattr(forecast, name) for name in cls.model_fields})


class ReportAnswer(Record):
    """Predicted beside achieved; achieved is null where the truth is not known.

    ``perfect`` is what would have been achieved with every gain known, and the regrets are the shares lost against it:
    of the objective's value, and of the sum rate in what arrives of the committed rates.
    """

    predicted: MetricsAnswer
    achieved: MetricsAnswer | None
    perfect: MetricsAnswer | None
    regret: float | None
    goodput_regret: float | None
    forecast: ForecastAnswer | None
    missed_users: list[str]

    @classmethod
    def of(cls, report: Report) -> ReportAnswer:
        from wirelessagent.telling.facts.case import predicted_metrics

        return cls(
            predicted=MetricsAnswer.of(report.predicted),
            achieved=None if report.achieved is None else MetricsAnswer.of(report.achieved),
            perfect=None if report.perfect is None else MetricsAnswer.of(predicted_metrics(report.perfect)),
            regret=_known(report.regret),
            goodput_regret=_known(report.goodput_regret),
            forecast=ForecastAnswer.of(report.decision.forecast),
            missed_users=[report.decision.user_names[user] for user in report.missed_users],
        )


def _known(figure: float) -> float | None:
    return None if math.isnan(figure) else figure


def _bracket(bracket: Bracket | None) -> BracketAnswer | None:
    return None if bracket is None else BracketAnswer(at_least=bracket.at_least, at_most=bracket.at_most)

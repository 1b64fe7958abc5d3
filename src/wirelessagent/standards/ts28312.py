"""A run as an intent and its report of 3GPP TS 28.312 (intent driven management services), release 19.

What is asked for is told thus (clauses 6.2.1 and 6.2.2):

- The objective is "better than the current value", for the standard has no "maximise": AveDLRANUEThpt for the sum of
  rates (the mean over the users who are served), DlThptPerUE for the lowest rate, RANEnergyConsumption for the least
  power, RANEnergyEfficiency for bits per joule. Any other objective is a target of the generic type, named after it.
- A power budget is a ceiling of RANEnergyConsumption. The budget limits what is radiated, the standard counts what is
  drawn: (P/ξ + P_c)·T over the observation period T.
- Promised rates are a DlThptPerUE of those users, in a RadioServiceExpectation.

Units: throughput in kbit/s (TS 28.552, 5.1.1.3; TS 28.541, XLThpt), energy in kWh (TS 28.552, 5.1.1.19.3), efficiency
in bit/J (TS 28.554, 6.7.1), periods in s. Figures are not rounded. The OpenAPI file types some of them as integers; a
figure that is not whole is one of the generic ExpectationTarget, which takes any number.

Ceilings and floors include their boundary. The standard's own targets know only "less" and "greater than", so a context
BoundaryIncluded says it, and Unit names the unit. All that the standard has no name for is a context with a name of
ours, such as OutageProbability or UEWeights.
"""

from __future__ import annotations

import math
from typing import Literal

from wirelessagent.standards.expectations import FLOOR, Expectation, Progress, expectations, is_kept
from wirelessagent.standards.remarks import Relation, Remark, needs, remarks
from wirelessagent.standards.subject import ENERGY_CONSUMPTION, Subject
from wirelessagent.standards.ts28312_models import (
    Condition,
    Context,
    Document,
    ExpectationFulfilmentResult,
    ExpectationObject,
    ExpectationTarget,
    FulfilmentInfo,
    InFeasibleExpectationInfo,
    InFeasibleTargetInfo,
    Intent,
    IntentConflictReport,
    IntentExpectation,
    IntentFeasibilityCheckReport,
    IntentFulfilmentReport,
    IntentReport,
    IntentReportControl,
    TargetFulfilmentResult,
    ValueRange,
)

SUBNETWORK = "SubNetwork=1"
"""Distinguished name of the cell where none is given."""

_CONDITIONS: dict[Relation, Condition] = {
    "equal": "IS_EQUAL_TO",
    "at most": "IS_EQUAL_TO_OR_LESS_THAN",
    "within": "IS_WITHIN_RANGE",
    "all of": "IS_ALL_OF",
}

_STATES: dict[Progress, Literal["DEGRADED", "TERMINATED"]] = {"missed": "DEGRADED", "taken back": "TERMINATED"}


def document(subject: Subject, *, subnetwork: str = SUBNETWORK) -> Document:
    """The intent and its report; ``subnetwork`` is the distinguished name of the cell."""
    handler = f"{subnetwork},IntentHandlingFunction=WirelessAgent"
    intent_name, report_name = f"{handler},Intent={subject.name}", f"{handler},IntentReport={subject.name}"
    found = expectations(subject)
    conflicts = _conflicts(subject, found)
    return Document(
        Intent=[
            Intent(
                id=subject.name,
                objectInstance=intent_name,
                userLabel=subject.text,
                intentExpectations=[_expectation(one, subnetwork) for one in found],
                intentContexts=[_context(remark) for remark in remarks(subject)],
                intentAdminState="DEACTIVATED" if subject.taken_back else "ACTIVATED",
                intentReportControl=[_control(subject)],
                intentReportReference=report_name,
            )
        ],
        IntentReport=[
            IntentReport(
                id=subject.name,
                objectInstance=report_name,
                intentFulfilmentReport=_fulfilment(subject, found),
                intentConflictReports=conflicts or None,
                intentFeasibilityCheckReport=_feasibility(subject, found),
                lastUpdatedTime=subject.at,
                intentReference=intent_name,
            )
        ],
    )


def to_json(made: Document) -> str:
    """The document as JSON text; what is not set is left out."""
    return made.model_dump_json(indent=2, exclude_none=True)


def _control(subject: Subject) -> IntentReportControl:
    return IntentReportControl(
        observationPeriod=subject.observation_period_s,
        expectedReportTypes=[
            "INTENT_FULFILMENT_REPORT",
            "INTENT_CONFLICT_REPORT",
            "INTENT_FEASIBILITY_CHECK_REPORT",
        ],
    )


def _expectation(one: Expectation, subnetwork: str) -> IntentExpectation:
    return IntentExpectation(
        expectationId=one.name,
        expectationVerb="ENSURE",
        expectationObject=ExpectationObject(
            objectType="RADIO_SERVICE" if one.metric.per_user else "RAN_SUBNETWORK",
            objectInstance=subnetwork,
            objectContexts=[_context(Remark("UEs", "all of", list(one.users)))] if one.users else None,
        ),
        expectationTargets=[_target(one)],
    )


def _target(one: Expectation) -> ExpectationTarget:
    contexts = [Remark("Unit", "equal", one.metric.unit), Remark("BoundaryIncluded", "equal", not one.strict)]
    if one.baseline:
        contexts.append(Remark("BetterThan" if one.strict else "NoWorseThan", "equal", one.baseline))
    return ExpectationTarget(
        targetName=one.metric.name,
        targetCondition="IS_GREATER_THAN" if one.more_is_better else "IS_LESS_THAN",
        targetValueRange=_whole(one.wanted),
        targetContexts=[_context(remark) for remark in contexts],
    )


def _context(remark: Remark) -> Context:
    return Context(
        contextAttribute=remark.name,
        contextCondition=_CONDITIONS[remark.relation],
        contextValueRange=_values(remark),
    )


def _values(remark: Remark) -> ValueRange:
    if isinstance(remark.value, list):
        return [value if isinstance(value, str) else _whole(value) for value in remark.value]
    return _whole(remark.value) if isinstance(remark.value, float) else remark.value


def _whole(value: float) -> int | float:
    """An integer where the figure is one, as the OpenAPI file would have it."""
    return int(value) if value.is_integer() else value


def _fulfilment(subject: Subject, found: list[Expectation]) -> IntentFulfilmentReport:
    level = _confidence(subject)
    return IntentFulfilmentReport(
        intentFulfilmentInfo=_of_all(found),
        expectationFulfilmentResult=[
            ExpectationFulfilmentResult(
                expectaitonId=one.name,
                expectationFulfilmentInfo=_info(one.progress, one.reasons),
                targetFulfilmentResults=[_result(one)],
                guaranteeConfidenceLevel=level if one.name.startswith(FLOOR) else None,
            )
            for one in found
        ],
        additionalFulfilmentInfo=_certificate(subject),
    )


def _confidence(subject: Subject) -> int | None:
    """With which probability, in whole percent rounded down, a promised rate is kept."""
    outage = subject.decision.problem.outage_probability
    return None if outage is None else math.floor(100 * (1 - outage) + 1e-9)


def _certificate(subject: Subject) -> str:
    """What is known of how good the decision is, which the standard has no attribute for."""
    decision = subject.decision
    if decision.status == "infeasible":
        return f"infeasible by method {decision.method}, which is proven"
    proof = "no bound is known" if math.isnan(decision.bound) else f"bound {decision.bound:.9g} {decision.unit}"
    worth = "" if math.isnan(decision.value) else f"value {decision.value:.9g} {decision.unit}, "
    return f"{decision.status} by method {decision.method}: {worth}{proof}"


def _result(one: Expectation) -> TargetFulfilmentResult:
    contexts = [Remark("Unit", "equal", one.metric.unit)]
    if one.promised is not None:
        contexts.append(Remark("PromisedValue", "equal", one.promised))
    return TargetFulfilmentResult(
        targetName=one.metric.name,
        targetFulfilmentInfo=_info(one.progress, one.reasons),
        targetAchievedValue=None if one.achieved is None else _whole(one.achieved),
        targetContexts=[_context(remark) for remark in contexts],
    )


def _of_all(found: list[Expectation]) -> FulfilmentInfo:
    """The intent is fulfilled where all its expectations are."""
    if is_kept(found):
        return _info("kept", ())
    open_ones = [one for one in found if one.progress != "kept"]
    worst: Progress = "missed" if any(one.progress == "missed" for one in open_ones) else open_ones[0].progress
    reasons = dict.fromkeys(reason for one in open_ones for reason in one.reasons)
    return _info(worst, tuple(reasons))


def _info(progress: Progress, reasons: tuple[str, ...]) -> FulfilmentInfo:
    """DEGRADED is what was applied and falls short, TERMINATED what was taken back, RECEIVED what was never applied."""
    if progress == "kept":
        return FulfilmentInfo(fulfilmentStatus="FULFILLED")
    return FulfilmentInfo(
        fulfilmentStatus="NOT_FULFILLED",
        notFullfilledState=_STATES.get(progress, "RECEIVED"),
        notFulfilledReasons=list(reasons),
    )


def _feasibility(subject: Subject, found: list[Expectation]) -> IntentFeasibilityCheckReport | None:
    """Whether it can be done at all; none where neither an allocation nor a proof was found."""
    if subject.decision.is_usable:
        return IntentFeasibilityCheckReport(feasibilityCheckResult="FEASIBLE", infeasibilityReasons=[])
    if subject.decision.status != "infeasible":
        return None
    told = dict.fromkeys([subject.decision.reason, *(text for _, text in needs(subject))])
    blocked = [
        InFeasibleExpectationInfo(
            expectationId=one.name,
            inFeasibleTargets=[InFeasibleTargetInfo(targetName=one.metric.name, recommendedValue=one.recommended)],
        )
        for one in found
        if one.name != "objective"
    ]
    return IntentFeasibilityCheckReport(
        feasibilityCheckResult="INFEASIBLE",
        infeasibilityReasons=["INTENT_CONFLICT"],
        inFeasibleExpectationInfos=blocked or None,
        additionalPreEvaluationInfo="; ".join(told),
    )


def _conflicts(subject: Subject, found: list[Expectation]) -> list[IntentConflictReport]:
    """The ceiling that promised rates do not fit under, where more power would do."""
    needed = subject.needed_power_w
    if subject.decision.status != "infeasible" or needed is None or not math.isfinite(needed.at_most):
        return []
    return [
        IntentConflictReport(
            conflictId=f"{subject.name}-{one.name}",
            conflictType="TARGET_CONFLICT",
            conflictingTarget=one.metric.name,
            recommendedSolutions="MODIFY",
        )
        for one in found
        if one.name != "objective" and one.metric is ENERGY_CONSUMPTION
    ]

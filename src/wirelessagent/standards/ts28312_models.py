"""The parts of the 3GPP intent NRM that are written here, as typed models whose JSON is the document's.

TS 28.312 V19, clause 6.2, in the names of its OpenAPI file TS28312_IntentNrm.yaml. Three of them are misspelt there
(``notFullfilledState``, ``expectaitonId``, and ``inFeasible…`` with a capital F) and are written so here, since that
file is what other systems check against.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, FiniteFloat, model_validator

Scalar: TypeAlias = bool | int | FiniteFloat | str
ValueRange: TypeAlias = Scalar | list[Scalar]

Condition: TypeAlias = Literal[
    "IS_EQUAL_TO",
    "IS_LESS_THAN",
    "IS_GREATER_THAN",
    "IS_WITHIN_RANGE",
    "IS_OUTSIDE_RANGE",
    "IS_ONE_OF",
    "IS_NOT_ONE_OF",
    "IS_EQUAL_TO_OR_LESS_THAN",
    "IS_EQUAL_TO_OR_GREATER_THAN",
    "IS_ALL_OF",
]


class Part(BaseModel):
    """The base of all parts: nothing that the standard does not name, and no NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Context(Part):
    """A constraint or condition beside a target, an expectation or an intent."""

    contextAttribute: str
    contextCondition: Condition
    contextValueRange: ValueRange


class ExpectationTarget(Part):
    """What is to be reached."""

    targetName: str
    targetCondition: Condition
    targetValueRange: ValueRange
    targetContexts: list[Context] | None = None

    @model_validator(mode="after")
    def _as_the_standard_has_it(self) -> ExpectationTarget:
        """The conditions that clause 6.2.2 lets its own targets have."""
        only = {
            "AveDLRANUEThpt": "IS_GREATER_THAN",
            "DlThptPerUE": "IS_GREATER_THAN",
            "RANEnergyEfficiency": "IS_GREATER_THAN",
            "RANEnergyConsumption": "IS_LESS_THAN",
        }.get(self.targetName, self.targetCondition)
        if self.targetCondition != only:
            raise ValueError(f"the condition of {self.targetName} is {only}; got {self.targetCondition}")
        return self


class ExpectationObject(Part):
    """What an expectation is about."""

    objectType: Literal["RAN_SUBNETWORK", "RADIO_SERVICE"]
    objectInstance: str
    objectContexts: list[Context] | None = None


class IntentExpectation(Part):
    """A requirement on a radio network (RadioNetworkExpectation) or on a radio service (RadioServiceExpectation)."""

    expectationId: str
    expectationVerb: Literal["DELIVER", "ENSURE"]
    expectationObject: ExpectationObject
    expectationTargets: list[ExpectationTarget] = Field(min_length=1)
    expectationContexts: list[Context] | None = None


class IntentReportControl(Part):
    """For which period, in seconds, and what is reported."""

    observationPeriod: int
    expectedReportTypes: list[
        Literal["INTENT_FULFILMENT_REPORT", "INTENT_CONFLICT_REPORT", "INTENT_FEASIBILITY_CHECK_REPORT"]
    ]


class Intent(Part):
    """The Intent IOC."""

    id: str
    objectClass: Literal["Intent"] = "Intent"
    objectInstance: str
    userLabel: str
    intentExpectations: list[IntentExpectation] = Field(min_length=1)
    intentContexts: list[Context] | None = None
    intentAdminState: Literal["ACTIVATED", "DEACTIVATED"] = "ACTIVATED"
    intentMgmtPurpose: Literal["FULFILMENT_WITHOUT_NEGOTIATION"] = "FULFILMENT_WITHOUT_NEGOTIATION"
    intentReportControl: list[IntentReportControl]
    intentReportReference: str


class FulfilmentInfo(Part):
    """Whether something is fulfilled, else how far it is and why."""

    fulfilmentStatus: Literal["FULFILLED", "NOT_FULFILLED"]
    notFullfilledState: Literal["RECEIVED", "DEGRADED", "SUSPENDED", "TERMINATED"] | None = None
    notFulfilledReasons: list[str] | None = None

    @model_validator(mode="after")
    def _says_why(self) -> FulfilmentInfo:
        if (self.fulfilmentStatus == "FULFILLED") != (self.notFullfilledState is None):
            raise ValueError("what is not fulfilled has a state, and what is fulfilled has none")
        return self


class TargetFulfilmentResult(Part):
    """What became of a target."""

    targetName: str
    targetFulfilmentInfo: FulfilmentInfo
    targetAchievedValue: ValueRange | None = None
    targetContexts: list[Context] | None = None


class ExpectationFulfilmentResult(Part):
    """What became of an expectation."""

    expectaitonId: str
    expectationFulfilmentInfo: FulfilmentInfo
    targetFulfilmentResults: list[TargetFulfilmentResult]
    guaranteeConfidenceLevel: int | None = Field(default=None, ge=0, le=100)


class IntentFulfilmentReport(Part):
    """What became of the intent."""

    intentFulfilmentInfo: FulfilmentInfo
    expectationFulfilmentResult: list[ExpectationFulfilmentResult] = Field(min_length=1)
    additionalFulfilmentInfo: str | None = None
    guaranteeConfidenceLevel: int | None = Field(default=None, ge=0, le=100)


class IntentConflictReport(Part):
    """Which target stands in the way."""

    conflictId: str
    conflictType: Literal["INTENT_CONFLICT", "EXPECTATION_CONFLICT", "TARGET_CONFLICT"]
    conflictingIntent: str | None = None
    conflictingExpectation: str | None = None
    conflictingTarget: str | None = None
    recommendedSolutions: Literal["MODIFY", "DELETE"] | None = None


class InFeasibleTargetInfo(Part):
    """A target that cannot be kept, and a value of it that could."""

    targetName: str
    recommendedValue: FiniteFloat | None = None


class InFeasibleExpectationInfo(Part):
    """The targets of an expectation that cannot be kept."""

    expectationId: str
    inFeasibleTargets: list[InFeasibleTargetInfo]


class IntentFeasibilityCheckReport(Part):
    """Whether the intent can be kept at all."""

    feasibilityCheckResult: Literal["FEASIBLE", "INFEASIBLE"]
    infeasibilityReasons: list[Literal["INVALID_INTENT_EXPRESSION", "INTENT_CONFLICT"]]
    inFeasibleExpectationInfos: list[InFeasibleExpectationInfo] | None = None
    additionalPreEvaluationInfo: str | None = None


class IntentReport(Part):
    """The IntentReport IOC."""

    id: str
    objectClass: Literal["IntentReport"] = "IntentReport"
    objectInstance: str
    intentFulfilmentReport: IntentFulfilmentReport
    intentConflictReports: list[IntentConflictReport] | None = None
    intentFeasibilityCheckReport: IntentFeasibilityCheckReport | None = None
    lastUpdatedTime: AwareDatetime
    intentReference: str


class Document(Part):
    """An intent and its report, as an IntentHandlingFunction contains them."""

    Intent: list[Intent]
    IntentReport: list[IntentReport]

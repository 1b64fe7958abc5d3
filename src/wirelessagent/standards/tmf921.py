"""A run as an intent and its report of TM Forum's TMF921 v5, expressed in the TM Forum Intent Ontology (TIO) v3.6.0.

The resources are envelopes; the meaning stands in ``expression``, as JSON-LD in the vocabulary of TR290 (intent common
model), TR292D (quantities), TR292E (logical operators) and TR292G (metrics and observations). Each expectation is an
icm:PropertyExpectation on a target (the cell or its users) with one condition that compares a metric with a quantity:
quan:atLeast and quan:atMost where the boundary does, quan:greater and quan:smaller for "better than the current value".
On several users the condition holds for the smallest of their values, quan:smallestInSet.

The ontology brings no radio metrics, so these bear the names and units of 3GPP (:mod:`wirelessagent.standards.ts28312`)
in a namespace of ours. What the ontology has no words for stands in the resource's characteristics, by the same names
as the contexts there. The report has icm:result and icm:reason for each expectation, met:observed for what was read
back, and icm:information for what a request that cannot be kept would take.
"""

from __future__ import annotations

import math
from typing import Literal

from wirelessagent.standards.expectations import Expectation, expectations, is_kept
from wirelessagent.standards.remarks import Remark, needs, remarks
from wirelessagent.standards.subject import Subject
from wirelessagent.standards.tmf921_models import (
    BooleanCharacteristic,
    Characteristic,
    Document,
    Intent,
    IntentRef,
    IntentReport,
    JsonLd,
    JsonLdExpression,
    NumberArrayCharacteristic,
    NumberCharacteristic,
    StringArrayCharacteristic,
    StringCharacteristic,
)

BASE_URL = "/tmf-api/intentManagement/v5"
"""Where the API stands, relative to its server."""

_TIO = "http://tio.models.tmforum.org/tio/v3.6.0/"

CONTEXT: JsonLd = {
    "icm": f"{_TIO}IntentCommonModel/",
    "imo": f"{_TIO}IntentManagementOntology/",
    "log": f"{_TIO}LogicalOperators/",
    "quan": f"{_TIO}QuantityOntology/",
    "met": f"{_TIO}MetricsAndObservations/",
    "t": "http://www.w3.org/2006/time#",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
    "wa": "urn:wirelessagent:",
}


def document(subject: Subject) -> Document:
    """The intent and its report."""
    found = expectations(subject)
    href = f"{BASE_URL}/intent/{subject.name}"
    name = f"Intent {subject.name}"
    return Document(
        intent=Intent(
            id=subject.name,
            href=href,
            name=name,
            description=subject.text,
            lifecycleStatus=_lifecycle(subject),
            creationDate=subject.at,
            lastUpdate=subject.at,
            statusChangeDate=subject.at,
            characteristic=[_characteristic(remark) for remark in remarks(subject)],
            expression=_expression(_intent(subject, found)),
        ),
        intentReport=IntentReport(
            id=f"{subject.name}-1",
            href=f"{href}/intentReport/{subject.name}-1",
            name=f"Report 1 on {name}",
            description=f"{subject.decision.status} by method {subject.decision.method}",
            creationDate=subject.at,
            intent=IntentRef(id=subject.name, href=href, name=name),
            expression=_expression(_report(subject, found)),
        ),
    )


def to_json(made: Document) -> str:
    """The document as JSON text, with the standard's names."""
    return made.model_dump_json(indent=2, by_alias=True)


def _lifecycle(subject: Subject) -> Literal["Created", "Active", "Terminated"]:
    if subject.taken_back:
        return "Terminated"
    return "Created" if subject.outcome is None else "Active"


def _expression(node: JsonLd) -> JsonLdExpression:
    return JsonLdExpression(iri=CONTEXT["icm"], expressionValue={"@context": CONTEXT, **node})


def _characteristic(remark: Remark) -> Characteristic:
    """A remark as a characteristic of the type of its value."""
    value = remark.value
    if isinstance(value, bool):
        return BooleanCharacteristic(name=remark.name, value=value)
    if isinstance(value, int | float):
        return NumberCharacteristic(name=remark.name, value=float(value))
    if isinstance(value, str):
        return StringCharacteristic(name=remark.name, value=value)
    texts = [entry for entry in value if isinstance(entry, str)]
    if len(texts) == len(value):
        return StringArrayCharacteristic(name=remark.name, value=texts)
    return NumberArrayCharacteristic(name=remark.name, value=[float(entry) for entry in value])


def _intent(subject: Subject, found: list[Expectation]) -> JsonLd:
    return {
        "@id": f"wa:{subject.name}",
        "@type": "icm:Intent",
        "rdfs:label": {"@value": subject.text, "@language": subject.language},
        "log:allOf": {"@list": [_expectation(subject, one) for one in found]},
    }


def _expectation(subject: Subject, one: Expectation) -> JsonLd:
    target: JsonLd = {"@id": _iri(subject, one, "target"), "@type": "icm:Target"}
    target["rdfs:member"] = [{"@id": f"wa:ue:{_token(user)}", "rdfs:label": user} for user in one.users] or [
        {"@id": "wa:cell"}
    ]
    made: JsonLd = {
        "@id": _iri(subject, one),
        "@type": "icm:PropertyExpectation",
        "icm:target": target,
        "log:allOf": {"@list": [_condition(subject, one)]},
    }
    if one.baseline:
        made["rdfs:comment"] = f"{'better' if one.strict else 'no worse'} than: {one.baseline}"
    return made


def _condition(subject: Subject, one: Expectation) -> JsonLd:
    strict, loose = ("greater", "atLeast") if one.more_is_better else ("smaller", "atMost")
    measured: JsonLd = {"met:lastValue": {"@list": [_metric(one)]}}
    if one.users:
        measured = {"quan:smallestInSet": {"@list": [{"icm:valuesOfTargetProperty": {"@list": [_metric(one)]}}]}}
    wanted = _quantity(one.wanted, one.metric.unit)
    return {
        "@id": _iri(subject, one, "condition"),
        "@type": "log:Condition",
        f"quan:{strict if one.strict else loose}": {"@list": [measured, wanted]},
    }


def _report(subject: Subject, found: list[Expectation]) -> JsonLd:
    """A report on every expectation and its condition, with what was read back."""
    stamp = {"@type": "xsd:dateTimeStamp", "@value": subject.at.isoformat()}
    known = [
        {"@type": "icm:Information", "rdfs:label": told, **_information(remark)} for remark, told in needs(subject)
    ]
    made: JsonLd = {
        "@id": f"wa:{subject.name}:report:1",
        "@type": "icm:IntentReport",
        "icm:about": {"@id": f"wa:{subject.name}"},
        "icm:reportNumber": {"@type": "xsd:positiveInteger", "@value": "1"},
        "icm:reportGenerated": {"@type": "t:Instant", "t:inXSDDateTimeStamp": stamp},
        "imo:handlingState": {"@id": f"imo:{_state(found)}"},
        "icm:result": is_kept(found),
        "icm:resultFrom": [_about(subject, one) for one in found],
    }
    if known and not subject.decision.is_usable:
        made["icm:information"] = known
    return made


def _state(found: list[Expectation]) -> str:
    if is_kept(found):
        return "StateCompliant"
    fallen = any(one.progress in ("missed", "taken back") for one in found)
    return "StateDegraded" if fallen else "StateIntentReceived"


def _about(subject: Subject, one: Expectation) -> JsonLd:
    kept = one.progress == "kept"
    condition: JsonLd = {
        "@id": _iri(subject, one, "condition:report"),
        "@type": "icm:ConditionReport",
        "icm:about": {"@id": _iri(subject, one, "condition")},
        "icm:result": kept,
    }
    if one.achieved is not None:
        condition["met:observed"] = {
            "@type": "met:Observation",
            "met:observedMetric": _metric(one),
            "rdf:value": _quantity(one.achieved, one.metric.unit),
            "met:obtainedAt": {"@type": "xsd:dateTime", "@value": subject.at.isoformat()},
        }
    if one.promised is not None:
        condition["wa:promised"] = _quantity(one.promised, one.metric.unit)
    if one.recommended is not None and math.isfinite(one.recommended):
        condition["wa:recommended"] = _quantity(one.recommended, one.metric.unit)
    made: JsonLd = {
        "@id": _iri(subject, one, "report"),
        "@type": "icm:PropertyExpectationReport",
        "icm:about": {"@id": _iri(subject, one)},
        "icm:result": kept,
        "icm:resultFrom": [condition],
    }
    if one.reasons:
        made["icm:reason"] = [{"@type": "icm:Reason", "rdfs:comment": reason} for reason in one.reasons]
    return made


def _metric(one: Expectation) -> JsonLd:
    return {"@id": f"wa:{one.metric.name}"}


def _quantity(value: float, unit: str) -> JsonLd:
    return {"@type": "quan:Quantity", "rdf:value": value, "quan:unit": unit}


def _information(remark: Remark) -> JsonLd:
    value = {"@list": remark.value} if isinstance(remark.value, list) else remark.value
    return {f"wa:{remark.name}": value}


def _iri(subject: Subject, one: Expectation, part: str = "") -> str:
    return f"wa:{subject.name}:{one.name}" + (f":{part}" if part else "")


def _token(user: str) -> str:
    """A user's name without what IRIs cannot hold."""
    return "".join(sign if sign.isalnum() else "-" for sign in user)

"""The parts of TM Forum's TMF921 v5.0.0 that are written here, as typed models whose JSON is the document's.

The names and required fields are those of its OpenAPI file: Intent, IntentReport, IntentRef, JsonLdExpression and the
characteristics. Dates are ISO 8601 with a time zone.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, FiniteFloat, field_validator

JsonLd: TypeAlias = dict[str, Any]
"""A node of JSON-LD."""


class Part(BaseModel):
    """The base of all parts: nothing that the standard does not name, and no NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True, validate_by_name=True, validate_by_alias=True)


class StringCharacteristic(Part):
    type: Literal["StringCharacteristic"] = Field(default="StringCharacteristic", alias="@type")
    name: str
    valueType: Literal["string"] = "string"
    value: str


class BooleanCharacteristic(Part):
    type: Literal["BooleanCharacteristic"] = Field(default="BooleanCharacteristic", alias="@type")
    name: str
    valueType: Literal["boolean"] = "boolean"
    value: bool


class NumberCharacteristic(Part):
    type: Literal["NumberCharacteristic"] = Field(default="NumberCharacteristic", alias="@type")
    name: str
    valueType: Literal["number"] = "number"
    value: FiniteFloat


class NumberArrayCharacteristic(Part):
    type: Literal["NumberArrayCharacteristic"] = Field(default="NumberArrayCharacteristic", alias="@type")
    name: str
    valueType: Literal["numberArray"] = "numberArray"
    value: list[FiniteFloat]


class StringArrayCharacteristic(Part):
    type: Literal["StringArrayCharacteristic"] = Field(default="StringArrayCharacteristic", alias="@type")
    name: str
    valueType: Literal["stringArray"] = "stringArray"
    value: list[str]


Characteristic: TypeAlias = Annotated[
    StringCharacteristic
    | BooleanCharacteristic
    | NumberCharacteristic
    | NumberArrayCharacteristic
    | StringArrayCharacteristic,
    Field(discriminator="type"),
]


class JsonLdExpression(Part):
    """The intent or report in the TM Forum Intent Ontology, as JSON-LD."""

    type: Literal["JsonLdExpression"] = Field(default="JsonLdExpression", alias="@type")
    iri: str
    expressionValue: JsonLd

    @field_validator("expressionValue")
    @classmethod
    def _is_json(cls, value: JsonLd) -> JsonLd:
        missing = {"@context", "@id", "@type"} - value.keys()
        if missing:
            raise ValueError(f"an expression needs {', '.join(sorted(missing))}")
        return value


class IntentRef(Part):
    type: Literal["IntentRef"] = Field(default="IntentRef", alias="@type")
    referredType: Literal["Intent"] = Field(default="Intent", alias="@referredType")
    id: str
    href: str
    name: str


class Intent(Part):
    """The Intent resource."""

    type: Literal["Intent"] = Field(default="Intent", alias="@type")
    id: str
    href: str
    name: str
    description: str
    version: str = "1"
    isBundle: bool = False
    lifecycleStatus: Literal["Created", "Active", "Terminated"]
    creationDate: AwareDatetime
    lastUpdate: AwareDatetime
    statusChangeDate: AwareDatetime
    characteristic: list[Characteristic]
    expression: JsonLdExpression


class IntentReport(Part):
    """The IntentReport resource."""

    type: Literal["IntentReport"] = Field(default="IntentReport", alias="@type")
    id: str
    href: str
    name: str
    description: str
    creationDate: AwareDatetime
    intent: IntentRef
    expression: JsonLdExpression


class Document(Part):
    """An intent and its report."""

    intent: Intent
    intentReport: IntentReport

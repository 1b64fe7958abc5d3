"""What requests carry and answers hold, for the document of the REST interface."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from wirelessagent.operations.hosted_answers import CellFacts, SeenAnswer

Id = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$")]


class Form(BaseModel):
    """What a request carries."""

    model_config = ConfigDict(extra="forbid", strict=True)


class Said(Form):
    text: str = Field(min_length=1, max_length=4000, description="what the operator says, in plain words")


class Pressed(Form):
    plan: str = Field(min_length=1, max_length=64, description="id of the plan that was seen")


class NewSession(Form):
    cell: Id = Field(description="id of the cell")


class NewCell(Form):
    name: str = Field(min_length=1, max_length=100, description="what people call it")
    options: dict[str, Any] = Field(
        default_factory=dict, description="as /v1/operations says of cells; csi is the id of an observation"
    )


class WorksOn(Form):
    observation: Id | None = Field(description="id of the observation; null for the cell's own source")


class SignIn(Form):
    token: str = Field(min_length=1, max_length=200, description="as `wirelessagent token` gave it")


class Problem(BaseModel):
    """What went wrong (RFC 9457)."""

    type: str
    title: str
    status: int
    detail: str


class JobAnswer(BaseModel):
    """Work that goes on, or has ended."""

    id: str
    state: Literal["running", "done", "failed", "cancelled"]
    result: Any = None
    error: Problem | None = None


class CellAnswer(CellFacts):
    """A cell, with its current conversation."""

    model_config = ConfigDict(extra="allow")

    id: str
    name: str
    session: str
    demonstration: bool
    recogniser: str


class PlanAnswer(BaseModel):
    """A plan that waits for a yes."""

    id: str
    turn: int
    by: str
    made_utc: str
    until_utc: str


class TurnAnswer(BaseModel):
    """A turn, as the command line's ``chat --json`` prints it, with who said it."""

    model_config = ConfigDict(extra="allow")

    number: int
    session: str
    at_utc: str
    text: str
    stage: str
    lines: dict[str, str]
    by: str
    language: str


class SessionAnswer(BaseModel):
    """A conversation."""

    id: str
    cell: str
    created_utc: str
    language: str
    awaits: str
    in_effect: int | None
    plan: PlanAnswer | None
    turns: list[TurnAnswer]


class ObservationAnswer(SeenAnswer):
    """What was understood of a file with gains."""

    model_config = ConfigDict(extra="ignore")

    id: str
    name: str


class OperationAnswer(BaseModel):
    """What came of an operation: its record, and the same for people."""

    record: Any
    blocks: list[Any]
    conclusion: Literal["done", "failed", "unclear", "unmet"]
    picture: str | None = Field(description="SVG, where it was asked for and can be drawn")


class Start(BaseModel):
    """What the console starts from."""

    version: str
    name: str
    role: Literal["viewer", "operator"]
    signed_in: bool
    languages: list[str]
    llm: str | None = Field(description="the LLM that can understand what is said; null where none is set up")
    cells: list[CellAnswer]

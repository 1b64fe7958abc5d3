"""What the plug-in's requests carry and its answers hold: flat, small, and described for a language model.

An answer leaves out what it does not have; null is sent nowhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from pydantic import BaseModel, ConfigDict, Field, model_validator


class PluginForm(BaseModel):
    """What a request carries. Platforms send null or an empty text for what their model left out."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _without_blanks(cls, given: Any) -> Any:
        if not isinstance(given, Mapping):
            return given
        return {name: value for name, value in cast("Mapping[str, Any]", given).items() if value not in (None, "")}


class SenseForm(PluginForm):
    users: int = Field(8, ge=1, le=64, description="number of users")
    subcarriers: int = Field(20, ge=1, le=273, description="number of subcarriers (resource blocks)")
    lost_share: float = Field(0.2, ge=0, le=0.9, description="share of the channel reports that get lost")
    seed: int = Field(1, ge=0, le=2**31 - 1, description="seed of the draw; the same seed gives the same channel")


class ObservationForm(PluginForm):
    observation: str = Field(
        min_length=1, max_length=64, description="id of an observation, as sense, repair or an upload gave it"
    )


class RepairForm(ObservationForm):
    method: str | None = Field(
        None, max_length=40,
        description="kriging (the default, with honest uncertainty), nncf, nncf_paper (the paper's own) or user_mean",
    )  # fmt: skip


class SolveForm(ObservationForm):
    min_rate_bps: float | None = Field(None, ge=0, le=1e12, description="rate that every user gets at least, bit/s")
    max_power_w: float | None = Field(None, ge=0, le=1e6, description="radiated power that is allowed in all, W")
    outage_probability: float | None = Field(
        None, ge=0, le=1, description="how likely a promised rate may be missed, such as 0.05; for repaired channels"
    )
    method: str | None = Field(
        None,
        max_length=40,
        description="dual (the default, with a certificate), paper (the paper's own) or equal_power",
    )


class CellForm(PluginForm):
    cell: str | None = Field(None, max_length=64, description="id of the cell; needed only where there are several")


class AskForm(PluginForm):
    text: str = Field(min_length=1, max_length=4000, description="what is wanted, in the user's own words")
    observation: str | None = Field(
        None, max_length=64, description="id of the observation to work on; a simulated channel if left out"
    )


class ExplainForm(CellForm):
    question: str = Field(
        "why this allocation?", min_length=1, max_length=4000, description="the question, in the user's own words"
    )


class ProposeForm(CellForm):
    text: str = Field(min_length=1, max_length=4000, description="what the cell should do, in the user's own words")


class ApplyForm(PluginForm):
    plan: str = Field(min_length=1, max_length=64, description="one-time id of the plan, as propose gave it")


class MoveForm(CellForm, ObservationForm):
    """A cell and an observation."""


class HistoryForm(PluginForm):
    last: int = Field(10, ge=1, le=100, description="how many turns, the latest ones")


class CellsForm(PluginForm):
    """Nothing."""


class Answer(BaseModel):
    """What every answer says."""

    ok: bool = Field(description="whether it was done; if not, error says what to do")
    error: str | None = Field(None, description="what was wrong, with the next step; only where ok is false")


class ObservationTold(Answer):
    observation: str | None = Field(None, description="id by which the channel is named from now on")
    users: int | None = None
    subcarriers: int | None = None
    missing: int | None = Field(None, description="gains that are missing")
    summary: str | None = Field(None, description="the same in words, with tables")


class UserTold(BaseModel):
    user: str
    subcarriers: list[int] = Field(description="subcarriers of this user, from 0")
    power_w: float
    rate_bps: float = Field(description="promised rate, bit/s")


class DecisionTold(Answer):
    status: str | None = Field(None, description="optimal, feasible, infeasible or undecided")
    value: float | None = Field(None, description="what was reached, in unit")
    bound: float | None = Field(None, description="what nobody can do better than, in unit")
    unit: str | None = None
    gap_percent: float | None = Field(None, description="how far value and bound are apart at most")
    total_power_w: float | None = None
    allocation: list[UserTold] | None = None
    summary: str | None = Field(None, description="the same in words, with tables and the reason")


class TurnTold(Answer):
    cell: str | None = Field(None, description="id of the cell")
    stage: str | None = Field(None, description="planned, applied, answered, asked (a question back), nothing, …")
    said: str | None = Field(None, description="what to tell the user, word for word")
    plan: str | None = Field(None, description="one-time id for apply, where a plan waits for the user's yes")
    plan_until_utc: str | None = Field(None, description="until when that id is good")


class CellTold(BaseModel):
    id: str
    name: str
    users: int
    subcarriers: int
    max_power_w: float
    base_station: str


class CellsTold(Answer):
    cells: list[CellTold] | None = None


class MovedTold(Answer):
    cell: CellTold | None = None


class HistoryLineTold(BaseModel):
    number: int | None = None
    at_utc: str
    said: str
    stage: str
    status: str | None = None
    value: float | None = None
    unit: str | None = None
    by: str | None = None


class HistoryTold(Answer):
    turns: list[HistoryLineTold] | None = None

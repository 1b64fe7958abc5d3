"""What an LLM fills in about a sentence: the meanings of an intent, with figures by reference."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, Literal, cast

from pydantic import BaseModel, ConfigDict, Field, create_model

from wirelessagent.language.intent import COMMANDS, QUESTIONS, IntentKind

_LONGEST = 600

FiguredConstraint = Literal[
    "max_power_w", "min_rate_bps", "max_rate_bps", "circuit_power_w", "outage_probability", "weights",
    "subcarrier_max_power_w", "resource_block_group_size",
]  # fmt: skip
AnyConstraint = Literal[FiguredConstraint, "users", "leave_out"]
Reference = str | float
_REFERENCE = "label of a figure that is listed, such as F1, or its value"


class _Filled(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Stated(_Filled):
    """One constraint that the sentence states."""

    constraint: FiguredConstraint
    figure: Reference = Field(description=_REFERENCE)
    users: list[str] = Field(
        default_factory=list, max_length=1000, description="whose, as the operator calls them ('3'); empty: everybody's"
    )


class Details(_Filled):
    """Figures and names of a question or a command."""

    user: str | None = Field(None, max_length=100, description="the user it is about, as the operator calls them ('3')")
    compared_with: str | None = Field(
        None, max_length=100, description="'last', or the registered name of a method or repairer to compare with"
    )
    number: Reference | None = Field(None, description=f"number of an entry of the history: {_REFERENCE}")
    format: Literal["ts28312", "tmf921"] | None = None
    missing_share: Reference | None = Field(None, description=f"share of gains that would be missing: {_REFERENCE}")
    power_w: Reference | None = Field(None, description=f"a step of power: {_REFERENCE}")
    rate_bps: Reference | None = Field(None, description=f"a step of rate: {_REFERENCE}")


class Meaning(_Filled):
    """The meaning of the operator's sentence. Figures are referred to, never made."""

    kind: IntentKind
    objective: str | None = Field(None, description="for allocate, or for a what-if question about another objective")
    objective_words: str = Field("", max_length=_LONGEST, description="the operator's own words for it, copied exactly")
    constraints: list[Stated] = Field(default_factory=list[Stated], max_length=1000)
    users: list[str] = Field(default_factory=list, max_length=1000, description="users to serve alone, such as '3'")
    leave_out: list[str] = Field(default_factory=list, max_length=1000, description="users to leave out, such as '3'")
    drops: list[AnyConstraint] = Field(
        default_factory=list[AnyConstraint], description="constraints of the current request that no longer hold"
    )
    amends: bool = Field(False, description="whether it changes the current request instead of replacing it")
    topic: str | None = Field(None, description="for command and question")
    details: Details = Field(default_factory=lambda: Details.model_validate({}))
    question: str = Field("", max_length=_LONGEST, description="for clarify: what to ask, in the operator's language")
    language: str = Field(pattern=r"^[a-z]{2,3}$", description="the operator's language, such as en or zh")


@functools.lru_cache(maxsize=8)
def meaning_with(objectives: tuple[str, ...]) -> type[Meaning]:
    """The type of a meaning whose objective is one of these, and whose topic is one that there is."""
    make = cast("Callable[..., type[Meaning]]", create_model)
    choices: dict[str, Any] = {
        name: (cast("Any", Literal)[values] | None, Meaning.model_fields[name])
        for name, values in (("objective", objectives), ("topic", (*COMMANDS, *QUESTIONS)))
    }
    return make("Meaning", __base__=Meaning, __doc__=Meaning.__doc__, **choices)

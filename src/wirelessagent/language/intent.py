"""What was understood from a sentence: one type for every recogniser and every surface."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, TypeAlias, get_args

from wirelessagent.model.errors import InputError

IntentKind: TypeAlias = Literal["allocate", "question", "command", "clarify", "out_of_scope"]

CONSTRAINTS: tuple[str, ...] = (
    "max_power_w",
    "min_rate_bps",
    "max_rate_bps",
    "circuit_power_w",
    "outage_probability",
)


@dataclass(frozen=True, kw_only=True)
class Intent:
    """One understood sentence. Only ``kind == "allocate"`` may lead to an action.

    Attributes:
        kind: allocate (a request that can be carried out), question, command, clarify (``reply`` asks back) or
            out_of_scope.
        objective: the registered name of an objective for allocate, None otherwise.
        constraints: figures in SI units by name, out of :data:`CONSTRAINTS`; rates are per user. All are positive and
            finite, and a probability is below 1.
        language: the operator's, as in "en" or "zh".
        confidence: 0 to 1; of the kind and the objective together.
        evidence: the operator's words that each field came from, separate places joined by " … ". The key "not_used"
            holds figures that were read as a description of the channel and left to the measurement.
        reply: a question for clarify, otherwise what was understood, in the operator's language.
        recogniser: which recogniser gave it.
    """

    kind: IntentKind
    objective: str | None
    constraints: Mapping[str, float]
    language: str
    confidence: float
    evidence: Mapping[str, str]
    reply: str
    recogniser: str

    def __post_init__(self) -> None:
        if self.kind not in get_args(IntentKind):
            raise InputError(f"kind must be one of {', '.join(get_args(IntentKind))}; got {self.kind!r}")
        if (self.kind == "allocate") != (self.objective is not None):
            raise InputError(f"an intent has an objective if and only if it allocates; got {self.kind!r} with "
                             f"objective {self.objective!r}")  # fmt: skip
        if not 0 <= self.confidence <= 1:
            raise InputError(f"confidence must be between 0 and 1; got {self.confidence!r}")
        for name, value in self.constraints.items():
            if name not in CONSTRAINTS:
                raise InputError(f"unknown constraint {name!r}: known are {', '.join(CONSTRAINTS)}")
            if not 0 < value < (1 if name == "outage_probability" else math.inf):
                limits = "between 0 and 1" if name == "outage_probability" else "positive and finite"
                raise InputError(f"{name} must be {limits}; got {value!r}")
        object.__setattr__(self, "constraints", MappingProxyType(dict(self.constraints)))
        object.__setattr__(self, "evidence", MappingProxyType(dict(self.evidence)))

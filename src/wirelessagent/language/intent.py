"""What was understood from a sentence: one type for every recogniser and every surface."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, TypeAlias, cast, get_args

from wirelessagent.model.errors import InputError

if TYPE_CHECKING:
    from wirelessagent.language.acts import Act

IntentKind: TypeAlias = Literal["allocate", "question", "command", "clarify", "out_of_scope"]

Constraint: TypeAlias = float | Mapping[str, float] | tuple[str, ...]
"""A figure for everybody, figures by user, or users."""

Detail: TypeAlias = float | str | Mapping[str, Constraint]

EVERYBODY = "all"
"""The key of everybody who is not named, in figures by user."""

_CLOSE = 1e-9

FIGURES_OF_USERS: tuple[str, ...] = ("min_rate_bps", "max_rate_bps", "weights")
LISTS_OF_USERS: tuple[str, ...] = ("users", "leave_out")
CONSTRAINTS: tuple[str, ...] = (
    "max_power_w", "min_rate_bps", "max_rate_bps", "circuit_power_w", "outage_probability", "weights", "users",
    "leave_out", "subcarrier_max_power_w", "resource_block_group_size",
)  # fmt: skip

COMMANDS: tuple[str, ...] = (
    "apply", "confirm", "reject", "undo", "reset", "compare", "explain", "history", "status", "help", "export",
)  # fmt: skip
QUESTIONS: tuple[str, ...] = (
    "why_user", "why_infeasible", "certificate", "uncertainty", "what_if", "step", "prices", "users", "capabilities",
    "concept", "other",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Intent:
    """One understood sentence. Only ``kind == "allocate"`` may lead to an action, and a command of the operator's.

    Attributes:
        kind: allocate (a request that can be carried out), question, command, clarify (``reply`` asks back) or
            out_of_scope.
        objective: the registered name of an objective for allocate, None otherwise. In a conversation it is that of the
            current request where the sentence names none.
        constraints: what the sentence states, in SI units, by name out of :data:`CONSTRAINTS`. Rates are per user: a
            figure for everybody, or figures by user, such as ``{"all": 5e5, "3": 2e6}``. A user is referred to by name
            or by the number that the operator said ("3" is "user 3"). A probability is below 1; all figures are
            positive and finite, but a weight may be 0, and so may the least rate of a named user, to whom nothing is
            promised: ``{"all": 5e5, "3": 0.0}``. Empty for every kind but allocate.
        dropped: constraints of the current request that no longer hold ("without the power limit").
        amends: whether the sentence changes the current request of a conversation ("now with 10 W") instead of
            replacing it.
        topic: what a command (:data:`COMMANDS`) or a question (:data:`QUESTIONS`) is about; None for other kinds.
        details: figures and names of a command or question, such as ``{"user": "3"}``, ``{"missing_share": 0.4}``,
            ``{"power_w": 1.0}``, and ``{"constraints": {…}}`` for what-if.
        pending: constraints that were read although the sentence leads to a question back; the answer may use them.
        guess: what a plain yes to the question back carries out; None where it asks for more than that.
        offered: the objective or the command that a plain yes to the question back means; None where it offers none.
        asks: which question is asked back, as the key of its sentence; "" for every other kind, and where it has none.
        acts: what the sentence does, where the other fields don't say all of it.
        language: the operator's, as in "en" or "zh".
        confidence: 0 to 1; of the kind and the objective together.
        evidence: the operator's words that each field came from, separate places joined by " … ". The key "not_used"
            holds figures that were read as a description of the channel and left to the measurement.
        reply: a question for clarify, otherwise what was understood, in the operator's language.
        recogniser: which recogniser gave it.
    """

    kind: IntentKind
    objective: str | None
    constraints: Mapping[str, Constraint]
    language: str
    confidence: float
    evidence: Mapping[str, str]
    reply: str
    recogniser: str
    dropped: tuple[str, ...] = ()
    amends: bool = False
    topic: str | None = None
    details: Mapping[str, Detail] = field(default_factory=dict[str, Detail])
    pending: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    guess: Intent | None = None
    offered: str | None = None
    asks: str = ""
    acts: tuple[Act, ...] = ()

    def __post_init__(self) -> None:
        if self.kind not in get_args(IntentKind):
            raise InputError(f"kind must be one of {', '.join(get_args(IntentKind))}; got {self.kind!r}")
        if (self.kind == "allocate") != (self.objective is not None):
            raise InputError(f"an intent has an objective if and only if it allocates; got {self.kind!r} with "
                             f"objective {self.objective!r}")  # fmt: skip
        if not 0 <= self.confidence <= 1:
            raise InputError(f"confidence must be between 0 and 1; got {self.confidence!r}")
        topics = {"command": COMMANDS, "question": QUESTIONS}.get(self.kind, ())
        if self.topic is not None and self.topic not in topics:
            raise InputError(f"a {self.kind} has no topic {self.topic!r}; known are {', '.join(topics) or 'none'}")
        _known(self.dropped)
        for name in ("constraints", "pending"):
            object.__setattr__(self, name, checked_constraints(getattr(self, name)))
        for name in ("evidence", "details"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))


def same_constraints(one: Mapping[str, Constraint], other: Mapping[str, Constraint], tolerance: float = _CLOSE) -> bool:
    """Whether the same is stated, figures to within a ``tolerance``, users in any order.

    A rate of everybody, where only some are served, is one of each of them.
    """
    return one.keys() == other.keys() and all(
        _same(_stated(one, name), _stated(other, name), tolerance) for name in one
    )


def _stated(constraints: Mapping[str, Constraint], name: str) -> Mapping[str, float] | frozenset[str]:
    value = constraints[name]
    if isinstance(value, tuple):
        return frozenset(value)
    if isinstance(value, Mapping):
        return value
    served = constraints.get("users") if name in ("min_rate_bps", "max_rate_bps") else None
    return dict.fromkeys(served if isinstance(served, tuple) else (EVERYBODY,), value)


def _same(
    one: Mapping[str, float] | frozenset[str], other: Mapping[str, float] | frozenset[str], tolerance: float
) -> bool:
    if isinstance(one, frozenset) or isinstance(other, frozenset):
        return one == other
    same = one.keys() == other.keys()
    return same and all(math.isclose(one[user], other[user], rel_tol=tolerance) for user in one)


def checked_constraints(constraints: Mapping[str, Constraint]) -> Mapping[str, Constraint]:
    """The same constraints, read-only.

    Raises:
        InputError: a name is not known, or a value is not what its name may have.
    """
    _known(constraints)
    return MappingProxyType({name: _checked(name, value) for name, value in constraints.items()})


def _known(names: Iterable[str]) -> None:
    for name in names:
        if name not in CONSTRAINTS:
            raise InputError(f"unknown constraint {name!r}: known are {', '.join(CONSTRAINTS)}")


def _checked(name: str, value: Constraint) -> Constraint:
    if name in LISTS_OF_USERS:
        return _users(name, value)
    if isinstance(value, Mapping) and name in FIGURES_OF_USERS:
        return MappingProxyType({str(user): _figure(name, each, user=str(user)) for user, each in value.items()})
    return _figure(name, value)


def _users(name: str, value: Constraint) -> tuple[str, ...]:
    if isinstance(value, str | Mapping) or not isinstance(value, Iterable) or not tuple(value):
        raise InputError(f"{name} must be users, such as ('3', '5'); got {value!r}")
    return tuple(str(user) for user in value)


def _figure(name: str, value: object, *, user: str = EVERYBODY) -> float:
    limits = "between 0 and 1" if name == "outage_probability" else "positive and finite"
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{name} must be {limits}; got {value!r}")
    figure = float(cast(float, value))
    if not is_allowed(name, figure, user=user):
        raise InputError(f"{name} must be {limits}; got {value!r}")
    return figure


def is_allowed(name: str, figure: float, *, user: str = EVERYBODY) -> bool:
    """Whether a limit may have a figure, for everybody or for one user."""
    top = 1 if name == "outage_probability" else math.inf
    zero = name == "weights" or (name == "min_rate_bps" and user != EVERYBODY)
    return 0 < figure < top or (zero and figure == 0)

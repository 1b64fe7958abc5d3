"""What was understood from a sentence: one type for every recogniser and every surface, and the acts it stands for.

Recognisers print and store kind, topic and details, which old records have; the conversation takes typed acts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal, TypeAlias, cast, get_args

from wirelessagent.language import acts
from wirelessagent.language.acts import Act, TurnReference
from wirelessagent.model.errors import InputError

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


OWN_CHOICE = "auto"
"""The method for "the usual method"."""

Details = Mapping[str, Detail]


def acts_of(intent: Intent) -> tuple[Act, ...]:
    """What an intent does to a conversation; nothing where it asks back."""
    if intent.acts:
        return intent.acts
    if intent.kind == "allocate":
        return tuple(_changes(intent))
    if intent.kind in ("question", "command"):
        return (_TOPICS.get(intent.topic or "", _result)(intent.details),)
    return ()


def _changes(intent: Intent) -> Iterator[Act]:
    assert intent.objective is not None
    said = intent.evidence
    if not intent.amends:
        yield acts.Forget()
    yield acts.Aim(objective=intent.objective, words=said.get("objective", ""))
    for name in intent.dropped:
        yield acts.Drop(kind=name)
    yield from stated(intent.constraints, said)
    if "method" in intent.details:
        named = str(intent.details["method"])
        yield acts.Prefer(method="" if named == OWN_CHOICE else named)


def stated(constraints: Mapping[str, Constraint], words: Mapping[str, str] | None = None) -> Iterator[Act]:
    """The acts that state constraints, each with its words where they are known."""
    for name, value in constraints.items():
        said = (words or {}).get(name, "")
        if name == "users" and isinstance(value, tuple):
            yield acts.Serve(whom=acts.Named(value), alone=True, words=said)
        elif isinstance(value, tuple):
            yield acts.LeaveOut(whom=acts.Named(value), words=said)
        else:
            by_user = value if isinstance(value, Mapping) else {EVERYBODY: float(value)}
            for user in sorted(by_user, key=lambda user: user != EVERYBODY):  # whose figure takes those of others off
                whom = acts.Everybody() if user == EVERYBODY else acts.Named((user,))
                yield acts.Limit(kind=name, value=by_user[user], whom=whom, words=said)


def _supposed(details: Details) -> Act:
    """What a question would have be so."""
    share, aim = _detail(details, "missing_share"), details.get("objective")
    changes: tuple[Act, ...] = (acts.Aim(objective=aim),) if isinstance(aim, str) else ()
    changes += tuple(acts.Drop(kind=name) for name in str(details.get("dropped", "")).split())
    changes += tuple(stated(_constraints(details)))
    asked = details.get("asked")
    if details.get("of") == "channel":
        return acts.AskOtherChannel()
    if asked == "most":
        return acts.AskMost(acts=changes, user=_user(details))
    if asked == "power":
        judged = "needed" if details.get("judged") == "needed" else "enough"
        return acts.AskPower(acts=changes, enough_w=_detail(details, "enough_w"), judged=judged)
    return acts.Suppose(acts=changes, missing_share=share)


def _wondered(about: Callable[[Details], Act]) -> Callable[[Details], Act]:
    """A question that states limits asks what would be with them: "can user 4 get 3 Mbit/s?"."""

    def act(details: Details) -> Act:
        limits, rate, user = dict(_constraints(details)), _detail(details, "rate_bps"), _user(details)
        if rate is not None:
            limits["min_rate_bps"] = rate if user is None else {user: rate}
        return acts.Suppose(acts=tuple(stated(limits))) if limits else about(details)

    return act


def _step(details: Details) -> Act:
    users = _detail(details, "users")
    return acts.AskStep(
        power_w=_detail(details, "power_w"), rate_bps=_detail(details, "rate_bps"),
        rate_share=_detail(details, "rate_share"), users=None if users is None else int(users),
        each="each" in details, user=_user(details),
    )  # fmt: skip


def _asked_users(details: Details) -> Act:
    place = _detail(details, "subcarrier")
    if details.get("asked") == "gain":
        return acts.AskGain(user=_user(details), subcarrier=None if place is None else int(place))
    if "rank" in details:
        named: dict[str, Any] = {"rank": details["rank"], "of": details.get("of", "rate")}
        return acts.AskRank(**named)
    if "listed" in details:
        return acts.AskDearest() if details["listed"] == "dearest" else acts.AskSubcarriers(user=_user(details))
    return acts.AskUsers(user=_user(details)) if place is None else acts.AskOwner(subcarrier=int(place))


def _result(details: Details) -> Act:
    """Of a result as a whole, and of what made it."""
    asked = details.get("asked")
    if details.get("listed") == "methods":
        return acts.AskMethods()
    if asked == "duration":
        return acts.AskDuration()
    return acts.AskLimits() if asked == "limits" else acts.AskResult()


def _compared(details: Details) -> Act:
    named = [_turn(details, name) for name in ("turn", "beside")]
    turns = tuple(turn for turn in named if turn is not None)
    if turns:
        return acts.CompareTurns(turns=turns)
    figures = [cast("Mapping[str, Constraint]", details[name]) for name in sorted(details) if name.startswith("either")]
    changes = [tuple(stated(each)) for each in figures]
    changes += [(acts.Aim(objective=aim),) for aim in str(details.get("aims", "")).split()]
    if changes:
        return acts.CompareRequests(changes=tuple(changes))
    said = " ".join(str(details.get(name, "")) for name in ("with", "methods", "repairers"))  # the latter of old turns
    names = tuple(name for name in re.split(r"[\s,，、;]+", said) if name not in ("", "last"))
    return acts.CompareTools(names=names) if names else acts.CompareLast()


def _yes(details: Details) -> Act:
    choice = _detail(details, "way")
    return acts.Yes(chooses="way" in details, choice=None if choice is None else int(choice))


def _undone(details: Details) -> Act:
    turn, steps = _turn(details, "turn"), details.get("steps", 1.0)
    if turn is not None:
        return acts.Undo(turn=turn)
    return acts.Undo(steps=int(steps) if isinstance(steps, float) else None)


_TOPICS: Mapping[str, Callable[[Details], Act]] = {
    "apply": lambda details: acts.Apply(),
    "confirm": _yes,
    "reject": lambda details: acts.No(cancels="cancel" in details, stops="stop" in details),
    "undo": _undone,
    "reset": lambda details: acts.Forget(),
    "compare": _compared,
    "explain": lambda details: acts.AskReasons(turn=_turn(details, "turn")),
    "history": lambda details: acts.AskHistory(turn=_turn(details, "turn" if "turn" in details else "number")),
    "status": lambda details: acts.AskStatus(),
    "help": lambda details: acts.AskHelp(),
    "export": lambda details: acts.Export(format=str(details.get("format", "ts28312"))),
    "why_user": _wondered(lambda details: acts.AskWhy(user=_user(details))),
    "why_infeasible": _wondered(lambda details: acts.AskWhyNot()),
    "certificate": _wondered(lambda details: acts.AskProof()),
    "uncertainty": _wondered(lambda details: acts.AskCertainty()),
    "what_if": _supposed,
    "step": _step,
    "prices": _wondered(lambda details: acts.AskPrices(user=_user(details))),
    "users": _wondered(_asked_users),
    "capabilities": lambda details: acts.AskHelp(),
    "concept": lambda details: acts.AskMeaning(),
    "other": _wondered(_result),
}


def _constraints(details: Details) -> Mapping[str, Constraint]:
    return cast("Mapping[str, Constraint]", details.get("constraints") or {})


def _user(details: Details) -> str | None:
    user = details.get("user")
    return user if isinstance(user, str) else None


def _detail(details: Details, name: str) -> float | None:
    value = details.get(name)
    return float(value) if isinstance(value, int | float) else None


def _turn(details: Details, name: str) -> TurnReference | None:
    turn = details.get(name)
    if isinstance(turn, int | float):
        return int(turn) if turn == int(turn) else f"{turn:g}"
    return None if turn is None else str(turn)

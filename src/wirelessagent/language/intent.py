"""What was understood from a sentence: one type for every recogniser and every surface, and the acts it stands for.

Recognisers print and store kind, topic and details, which old records have; the conversation takes typed acts.
"""

from __future__ import annotations

import dataclasses
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

RATES: tuple[str, ...] = ("min_rate_bps", "max_rate_bps")
FIGURES_OF_USERS: tuple[str, ...] = (*RATES, "weights")
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
    ours, theirs = _by_user(one), _by_user(other)
    return ours.keys() == theirs.keys() and all(
        math.isclose(figure, theirs[key], rel_tol=tolerance) for key, figure in ours.items()
    )


def _by_user(constraints: Mapping[str, Constraint]) -> dict[tuple[str, str], float]:
    """Each figure by its name and its user; users who are only listed count as 1."""
    figures, served = dict[tuple[str, str], float](), constraints.get("users")
    everybody = served if isinstance(served, tuple) else (EVERYBODY,)
    for name, value in constraints.items():
        if isinstance(value, tuple):
            value = dict.fromkeys(value, 1.0)
        elif not isinstance(value, Mapping):
            value = dict.fromkeys(everybody if name in RATES else (EVERYBODY,), value)
        figures |= {(name, user): figure for user, figure in value.items()}
    return figures


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
        return (_of_topic(intent.topic or "other", intent.details),)
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


def _of_topic(topic: str, details: Details) -> Act:
    """What a question or a command asks for; a question that states limits asks what would be with them."""
    limits = _limits(topic, details)
    if limits:  # "can user 4 get 3 Mbit/s?"
        return acts.Suppose(acts=tuple(stated(limits)))
    match topic, details:
        case "what_if", _:
            return _supposed(details)
        case "compare", _:
            return _compared(details)
        case "confirm", {"way": way}:
            return acts.Yes(chooses=True, choice=_whole(way))
        case "reject", _:
            return acts.No(cancels="cancel" in details, stops="stop" in details)
        case "history", {"number": turn}:
            return acts.AskHistory(turn=_turn(details.get("turn", turn)))
        case "users", {"asked": "gain"}:
            kind = acts.AskGain
        case "users", {"rank": _}:
            kind = acts.AskRank
        case "users", {"listed": listed}:
            kind = acts.AskDearest if listed == "dearest" else acts.AskSubcarriers
        case "users", {"subcarrier": _}:
            kind = acts.AskOwner
        case "other", {"listed": "methods"}:
            kind = acts.AskMethods
        case "other", {"asked": "duration"}:
            kind = acts.AskDuration
        case "other", {"asked": "limits"}:
            kind = acts.AskLimits
        case _:
            kind = _TOPICS[topic]
    return _filled(kind, details)


def _limits(topic: str, details: Details) -> Mapping[str, Constraint]:
    """What a question of a topic that is about no limits states of them all the same."""
    if topic not in _WONDERED:
        return {}
    limits, rate, user = dict(_constraints(details)), details.get("rate_bps"), _name(details.get("user"))
    if isinstance(rate, int | float):
        limits["min_rate_bps"] = float(rate) if user is None else {user: float(rate)}
    return limits


def _filled(kind: type[Act], details: Details, **further: Any) -> Act:
    """An act of a kind, with those of its fields that details name."""
    said = {field.name: details.get(field.name) for field in dataclasses.fields(kind) if field.name in _READ}
    return kind(**{name: _READ[name](value) for name, value in said.items() if value is not None}, **further)


def _supposed(details: Details) -> Act:
    """What a question would have be so."""
    aim = details.get("objective")
    changes: tuple[Act, ...] = (acts.Aim(objective=aim),) if isinstance(aim, str) else ()
    changes += tuple(acts.Drop(kind=name) for name in str(details.get("dropped", "")).split())
    changes += tuple(stated(_constraints(details)))
    if details.get("of") == "channel":
        return acts.AskOtherChannel()
    kind = {"most": acts.AskMost, "power": acts.AskPower}.get(str(details.get("asked")), acts.Suppose)
    return _filled(kind, details, acts=changes)


def _compared(details: Details) -> Act:
    turns = tuple(_turn(details[name]) for name in ("turn", "beside") if details.get(name) is not None)
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


def _constraints(details: Details) -> Mapping[str, Constraint]:
    return cast("Mapping[str, Constraint]", details.get("constraints") or {})


def _name(value: object) -> str | None:
    return value if isinstance(value, str) else None


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def _whole(value: object) -> int | None:
    return int(value) if isinstance(value, int | float) else None


def _turn(value: Detail) -> TurnReference:
    number = _number(value)
    if number is None:
        return str(value)
    return int(number) if number == int(number) else f"{number:g}"


_READ: Mapping[str, Callable[[Any], Any]] = {
    "user": _name, "rank": _name, "of": _name, "format": str, "turn": _turn, "steps": _whole, "users": _whole,
    "subcarrier": _whole, "power_w": _number, "rate_bps": _number, "rate_share": _number, "missing_share": _number,
    "enough_w": _number, "judged": _name, "each": bool,
}  # fmt: skip
"""The fields of acts that details name, and what becomes of each."""

_WONDERED = ("why_user", "why_infeasible", "certificate", "uncertainty", "prices", "users", "other")
_TOPICS: Mapping[str, type[Act]] = {
    "apply": acts.Apply, "confirm": acts.Yes, "undo": acts.Undo, "reset": acts.Forget, "explain": acts.AskReasons,
    "history": acts.AskHistory, "status": acts.AskStatus, "help": acts.AskHelp, "export": acts.Export,
    "why_user": acts.AskWhy, "why_infeasible": acts.AskWhyNot, "certificate": acts.AskProof,
    "uncertainty": acts.AskCertainty, "step": acts.AskStep, "prices": acts.AskPrices, "users": acts.AskUsers,
    "capabilities": acts.AskHelp, "concept": acts.AskMeaning, "other": acts.AskResult,
}  # fmt: skip
"""The act of each topic whose details say no more than its fields."""

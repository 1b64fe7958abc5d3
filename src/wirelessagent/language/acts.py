"""Dialogue acts: what an utterance does to a conversation, each with the words that it came from.

Acts are what recognisers make, whichever they are; :mod:`wirelessagent.agent.dialogue` is the only place that applies
them. :func:`acts_of` gives those of an :class:`~wirelessagent.language.intent.Intent`, which is how they are printed
and stored.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, cast

from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent

OWN_CHOICE = "auto"
"""The method for "the usual method"."""


@dataclass(frozen=True)
class Everybody:
    """Each user of the cell; of a limit that no user has, the cell."""


@dataclass(frozen=True)
class Named:
    """These users."""

    users: tuple[str, ...]


@dataclass(frozen=True)
class Others:
    """Each user for whom nothing was said on its own."""


Whom: TypeAlias = Everybody | Named | Others


@dataclass(frozen=True, kw_only=True)
class Act:
    """What some words of an utterance do; ``words`` are those, where they are known."""

    words: str = dataclasses.field(default="", compare=False)


@dataclass(frozen=True, kw_only=True)
class Aim(Act):
    """Have the cell serve an objective, by its registered name; limits stay."""

    objective: str


@dataclass(frozen=True, kw_only=True)
class Limit(Act):
    """Set a figure, in SI units: a limit, a promise, a weight, an outage probability.

    For everybody it replaces the figures of named users, too.
    """

    kind: str
    value: float
    whom: Whom = Everybody()


@dataclass(frozen=True, kw_only=True)
class Scale(Act):
    """Multiply a figure that holds, or that the last decision shows: what is radiated where no power limit holds."""

    kind: str
    factor: float
    whom: Whom = Everybody()
    reference: Literal["held", "radiated"] = "held"


@dataclass(frozen=True, kw_only=True)
class Drop(Act):
    """Take a limit off; ``own`` takes off a user's own figure, so that everybody's holds for that user again."""

    kind: str
    whom: Whom = Everybody()
    own: bool = False


@dataclass(frozen=True, kw_only=True)
class Serve(Act):
    """Serve users: these alone, or these too."""

    whom: Whom
    alone: bool = False


@dataclass(frozen=True, kw_only=True)
class LeaveOut(Act):
    """Serve users no more."""

    whom: Whom


@dataclass(frozen=True, kw_only=True)
class Prefer(Act):
    """Decide by this method; "" leaves the choice to the agent."""

    method: str


@dataclass(frozen=True, kw_only=True)
class Forget(Act):
    """Nothing of what was asked for holds any more."""


@dataclass(frozen=True, kw_only=True)
class Suppose(Act):
    """What would be if these acts, or this share of missing gains, were so; changes nothing."""

    acts: tuple[Act, ...] = ()
    missing_share: float | None = None


@dataclass(frozen=True, kw_only=True)
class Ask(Act):
    """A question; ``topic`` is one of :data:`~wirelessagent.language.intent.QUESTIONS`. It changes nothing."""

    topic: str


@dataclass(frozen=True, kw_only=True)
class Command(Act):
    """A command to the agent about the conversation; see :data:`~wirelessagent.language.intent.COMMANDS`."""

    topic: str


@dataclass(frozen=True, kw_only=True)
class Undo(Act):
    """Go back so many changes of the request (None: all), or to what held behind a turn."""

    steps: int | None = 1
    turn: int | None = None


def acts_of(intent: Intent) -> tuple[Act, ...]:
    """What an intent does to a conversation; nothing where it asks back."""
    if intent.acts:
        return intent.acts
    if intent.kind == "allocate":
        return tuple(_changes(intent))
    if intent.kind == "question":
        return (_asked(intent),)
    if intent.kind != "command":
        return ()
    if intent.topic == "undo":
        turn, steps = intent.details.get("turn"), intent.details.get("steps", 1.0)
        if isinstance(turn, float):
            return (Undo(turn=int(turn)),)
        return (Undo(steps=None if steps == "all" else int(steps) if isinstance(steps, float) else 1),)
    return (Forget(),) if intent.topic == "reset" else (Command(topic=intent.topic or ""),)


def _asked(intent: Intent) -> Act:
    if intent.topic != "what_if":
        return Ask(topic=intent.topic or "other")
    share = intent.details.get("missing_share")
    return Suppose(acts=supposed_in(intent.details), missing_share=share if isinstance(share, float) else None)


def supposed_in(details: Mapping[str, Detail]) -> tuple[Act, ...]:
    """The acts of a what-if, as an intent's details write them."""
    aim, figures = details.get("objective"), details.get("constraints")
    acts: list[Act] = [Aim(objective=aim)] if isinstance(aim, str) else []
    acts += [Drop(kind=name) for name in str(details.get("dropped", "")).split()]
    return *acts, *stated(cast("Mapping[str, Constraint]", figures or {}))


def _changes(intent: Intent) -> Iterator[Act]:
    assert intent.objective is not None
    said = intent.evidence
    if not intent.amends:
        yield Forget()
    yield Aim(objective=intent.objective, words=said.get("objective", ""))
    for name in intent.dropped:
        yield Drop(kind=name)
    yield from stated(intent.constraints, said)
    if "method" in intent.details:
        named = str(intent.details["method"])
        yield Prefer(method="" if named == OWN_CHOICE else named)


def stated(constraints: Mapping[str, Constraint], words: Mapping[str, str] | None = None) -> Iterator[Act]:
    """The acts that state constraints, each with its words where they are known."""
    for name, value in constraints.items():
        yield from _limits(name, value, (words or {}).get(name, ""))


def _limits(name: str, value: Constraint, words: str = "") -> Iterator[Act]:
    """The acts that state a constraint, as :class:`~wirelessagent.language.intent.Intent` writes it."""
    if isinstance(value, tuple):
        whom = Named(value)
        yield Serve(whom=whom, alone=True, words=words) if name == "users" else LeaveOut(whom=whom, words=words)
    elif isinstance(value, Mapping):
        if EVERYBODY in value:
            yield Limit(kind=name, value=value[EVERYBODY], words=words)
        for user, figure in value.items():
            if user != EVERYBODY:
                yield Limit(kind=name, value=figure, whom=Named((user,)), words=words)
    else:
        yield Limit(kind=name, value=float(value), words=words)


def shown(act: Act) -> dict[str, Any]:
    """An act as JSON has it: its name, its fields and its words."""
    fields: dict[str, Any] = {"act": type(act).__name__}
    for field in dataclasses.fields(act):
        value: Any = getattr(act, field.name)
        if isinstance(value, tuple):
            value = [shown(each) for each in cast("tuple[Act, ...]", value)]
        elif isinstance(value, Everybody | Others):
            value = type(value).__name__.lower()
        elif isinstance(value, Named):
            value = list(value.users)
        if value not in ("", None, []):
            fields[field.name] = value
    return fields

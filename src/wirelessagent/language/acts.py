"""Dialogue acts: what an utterance does to a conversation, each with the words that it came from.

Acts are what recognisers make, whichever they are; :mod:`wirelessagent.language.request` is the only place that applies
them. :func:`~wirelessagent.language.intent.acts_of` gives those of an
:class:`~wirelessagent.language.intent.Intent`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, cast, dataclass_transform

Press: TypeAlias = Literal["yes", "no", "undo"]
"""What is pressed instead of said: apply the plan that waits, drop it, or take back the last change."""

TurnReference: TypeAlias = int | str
"""A turn by its number, "first" for the first with a decision, or words that should have named one."""


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

_KINDS = dict[str, type[Any]]()
"""Each kind of act by its name."""


@dataclass_transform(frozen_default=True, kw_only_default=True)
class _Frozen:
    """What is derived from it is a frozen dataclass with named fields, which need not be said of each."""

    def __init_subclass__(cls) -> None:
        _KINDS[cls.__name__] = dataclass(frozen=True, kw_only=True)(cls)


class Act(_Frozen):
    """What some words of an utterance do; ``words`` are those, where they are known."""

    words: str = dataclasses.field(default="", compare=False)


class Aim(Act):
    """Have the cell serve an objective, by its registered name; limits stay."""

    objective: str


class Limit(Act):
    """Set a figure, in SI units: a limit, a promise, a weight, an outage probability.

    For everybody it replaces the figures of named users, too.
    """

    kind: str
    value: float
    whom: Whom = Everybody()


class Scale(Act):
    """Multiply a figure that holds, or that the last decision shows: what is radiated where no power limit holds."""

    kind: str
    factor: float
    whom: Whom = Everybody()
    reference: Literal["held", "radiated"] = "held"


class Drop(Act):
    """Take a limit off; ``own`` takes off a user's own figure, so that everybody's holds for that user again."""

    kind: str
    whom: Whom = Everybody()
    own: bool = False


class Serve(Act):
    """Serve users: these alone, or these too."""

    whom: Whom
    alone: bool = False


class LeaveOut(Act):
    """Serve users no more."""

    whom: Whom


class Prefer(Act):
    """Decide by this method; "" leaves the choice to the agent."""

    method: str


class Forget(Act):
    """Nothing of what was asked for holds any more."""


class Suppose(Act):
    """What would be if these acts, or this share of missing gains, were so; changes nothing."""

    acts: tuple[Act, ...] = ()
    missing_share: float | None = None


class AskMost(Suppose):
    """The most that can be promised to a user, else to everybody, if these acts were so."""

    user: str | None = None


class AskPower(Suppose):
    """The power that the promised rates take if these acts were so, or whether a power is needed, or enough."""

    enough_w: float | None = None
    judged: Literal["needed", "enough"] = "enough"


class Undo(Act):
    """Go back so many changes of the request (None: all), or to what held behind a turn."""

    steps: int | None = 1
    turn: TurnReference | None = None


class Apply(Act):
    """Apply the plan that waits, else what was decided last."""


class Yes(Act):
    """A yes to what the agent asked or offered.

    ``choice`` is the place of what was offered, from 1, −1 the last; ``chooses`` where none of several is named.
    """

    chooses: bool = False
    choice: int | None = None


class No(Act):
    """A no to what the agent asked; ``cancels`` takes the plan's request back, ``stops`` wants nothing done at all."""

    cancels: bool = False
    stops: bool = False


class Ask(Act):
    """A question, or a wish to see something, one small class a topic; it changes nothing."""


class AskWhy(Ask):
    """Why a user got what it got; None where nobody was named."""

    user: str | None = None


class AskWhyNot(Ask):
    """Why the request cannot be met, and what can be met instead."""


class AskProof(Ask):
    """How good the decision is, and what proves it."""


class AskCertainty(Ask):
    """What was not measured, and how sure the decision is."""


class AskOtherChannel(Ask):
    """What would be on another channel, which is as it was sensed."""


class AskStep(Ask):
    """What a little more would buy: power, a rate (of a user, of ``each``, or in all), a share of the rate, users."""

    power_w: float | None = None
    rate_bps: float | None = None
    rate_share: float | None = None
    users: int | None = None
    each: bool = False
    user: str | None = None


class AskPrices(Ask):
    """What power and promises are worth at the margin; of a user, what it gets."""

    user: str | None = None


class AskUsers(Ask):
    """What a user gets, else each of them."""

    user: str | None = None


class AskRank(Ask):
    """Who gets the least or the most."""

    rank: Literal["least", "most"]
    of: Literal["rate", "power", "subcarriers"] = "rate"


class AskSubcarriers(Ask):
    """Which subcarriers a user has, else each of them."""

    user: str | None = None


class AskOwner(Ask):
    """Who has a subcarrier, counted from 1."""

    subcarrier: int


class AskGain(Ask):
    """The gain of a user, on a subcarrier (from 1) or over all of them."""

    user: str | None = None
    subcarrier: int | None = None


class AskDearest(Ask):
    """Whom it would help most to leave out."""


class AskLimits(Ask):
    """What holds the result back."""


class AskDuration(Ask):
    """How long the decision took."""


class AskMethods(Ask):
    """Which method decided, and which others could."""


class AskMeaning(Ask):
    """What a word means."""


class AskHelp(Ask):
    """What can be said."""


class AskResult(Ask):
    """What came of the request: the figures that are named, else the decision in words."""


class AskReasons(Ask):
    """The decision in words, with its tables: the one that holds, or that of a turn."""

    turn: TurnReference | None = None


class AskHistory(Ask):
    """What was said so far, or in a turn."""

    turn: TurnReference | None = None


class AskStatus(Ask):
    """What is asked for, what was decided, and what is in effect."""


class CompareLast(Ask):
    """The decision that holds beside the last other one."""


class CompareTurns(Ask):
    """Decisions of turns beside each other; of one turn, beside the one that holds."""

    turns: tuple[TurnReference, ...]


class CompareTools(Ask):
    """The decision that holds beside those of other methods or repairers, by name."""

    names: tuple[str, ...]


class CompareRequests(Ask):
    """What the request would bring with each of these changes, beside each other."""

    changes: tuple[tuple[Act, ...], ...]


class Export(Ask):
    """The request that holds and what came of it, as a document of a standard."""

    format: str = "ts28312"


def renamed(value: Any, user: str, name: str) -> Any:
    """An act, or what an act or an intent holds, with somebody in the place of a user.

    >>> renamed(LeaveOut(whom=Named(("2", "9"))), "9", "3").whom, renamed({"all": 1e5, "9": 1e6}, "9", "3")
    (Named(users=('2', '3')), {'all': 100000.0, '3': 1000000.0})
    """
    if isinstance(value, Act | Named):
        fields = [field.name for field in dataclasses.fields(value)]
        return dataclasses.replace(value, **{each: renamed(getattr(value, each), user, name) for each in fields})
    if isinstance(value, Mapping):
        inner = cast("Mapping[str, Any]", value).items()
        return {name if key == user else key: renamed(each, user, name) for key, each in inner}
    if isinstance(value, tuple):
        return tuple(renamed(each, user, name) for each in cast("tuple[Any, ...]", value))
    return name if user and value == user else value


def shown(act: Act) -> dict[str, Any]:
    """An act as JSON has it: its name, and its fields and words but for those that are empty unless said."""
    fields = [(field, getattr(act, field.name)) for field in dataclasses.fields(act)]
    said = {one.name: _shown(value) for one, value in fields if value not in ("", None, ()) or value != one.default}
    return {"act": type(act).__name__, **said}


def act_of(said: Mapping[str, Any]) -> Act:
    """The act that :func:`shown` shows.

    >>> act_of(shown(LeaveOut(whom=Named(("2", "9")))))
    LeaveOut(words='', whom=Named(users=('2', '9')))
    """
    return _KINDS[said["act"]](**{name: _read(name, value) for name, value in said.items() if name != "act"})


def _read(name: str, value: Any) -> Any:
    if name == "whom":
        return {"everybody": Everybody(), "others": Others()}[value] if isinstance(value, str) else Named(tuple(value))
    if isinstance(value, list):
        return tuple(_read("", each) for each in cast("list[Any]", value))
    return act_of(cast("Mapping[str, Any]", value)) if isinstance(value, Mapping) else value


def _shown(value: Any) -> Any:
    if isinstance(value, Act):
        return shown(value)
    if isinstance(value, tuple):
        return [_shown(each) for each in cast("tuple[Any, ...]", value)]
    if isinstance(value, Everybody | Others):
        return type(value).__name__.lower()
    return list(value.users) if isinstance(value, Named) else value

"""What every recogniser is: a sentence and what is known of the conversation in, an intent out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal, TypeAlias

from wirelessagent.language.acts import Act
from wirelessagent.language.guard import guarded
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.language.request import Request

Awaited: TypeAlias = Literal["nothing", "confirmation", "clarification"]


@dataclass(frozen=True, kw_only=True)
class Missing:
    """A question back about a user: the intent that waits, and whom it names that is not there ("" for nobody)."""

    intent: Intent
    reference: str


@dataclass(frozen=True, kw_only=True)
class Question:
    """A question back that is open, and what was understood before it.

    Attributes:
        pending: constraints.
        objective: the aim that was named; None where none was.
        users: users who were named, and of whom nothing was understood.
        caps: whether the most of something was named, without its figure: "cap user 3".
        offered: the objective or the command that a yes means; None where it is no question of yes or no.
        guess: what a yes carries out; None where it is no question of yes or no.
        missing: the user who is not there, where the question is about one.
    """

    pending: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    objective: str | None = None
    users: tuple[str, ...] = ()
    caps: bool = False
    offered: str | None = None
    guess: Intent | None = None
    missing: Missing | None = None


@dataclass(frozen=True, kw_only=True)
class Context:
    """What a sentence may refer to.

    Attributes:
        user_names: of the channel; empty where it is not known yet.
        max_power_w: the cell's limit, which shares of the power refer to.
        radiated_w: what the last decision radiates, which "half of it" and "2 W less" refer to where no limit holds.
        objective, constraints: of the current request; None and empty where there is none.
        awaits: what the agent asked for last.
        question: the one that is open, with what was understood before it; an empty one where none is.
        supposed_objective, supposed: the request of a what-if right before; None and empty where there was none.
        ways: whether the line right before was told that it can't be met, and what can be met instead.
        offers: how many ways were offered that the next line may choose from.
        acts: those of the last line that changed or supposed something.
        spoken_of: the users whom a line named behind the last change, or with it: whom "give them 1 Mbit/s" is about.
        earlier: the acts of each turn so far, from the first.
        past: what was asked for before each change that can be undone, the latest last; None for nothing.
        called: the numbers of users by what the operator calls them.
        language: of the conversation so far; "" at its start.
    """

    user_names: tuple[str, ...] = ()
    max_power_w: float = 20.0
    radiated_w: float = 0.0
    objective: str | None = None
    constraints: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    awaits: Awaited = "nothing"
    question: Question = field(default_factory=Question)
    supposed_objective: str | None = None
    supposed: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    ways: bool = False
    offers: int = 0
    acts: tuple[Act, ...] = ()
    spoken_of: tuple[str, ...] = ()
    earlier: tuple[tuple[Act, ...], ...] = ()
    past: tuple[Request | None, ...] = ()
    called: Mapping[str, str] = field(default_factory=dict[str, str])
    language: str = ""


class Recogniser(ABC):
    """Turns an operator's sentence into an intent."""

    name: ClassVar[str]
    is_spared: ClassVar[bool] = False
    """Whether it is asked only about what the offline recogniser does not surely understand."""

    @abstractmethod
    def read(self, text: str, context: Context | None = None) -> Intent:
        """What the operator may mean, as it is read; never raises, whatever the text."""

    def recognise(self, text: str, context: Context | None = None) -> Intent:
        """What the operator means, with the guard behind it; never raises, whatever the text."""
        return guarded(text, context, self.read(text, context))

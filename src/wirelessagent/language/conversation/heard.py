"""A line of a talk as the readers of sentences see it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from wirelessagent.language.acts import Act, Aim, Suppose, Undo
from wirelessagent.language.conversation.line import NAME, Line
from wirelessagent.language.conversation.possible import Effect, Possible
from wirelessagent.language.figure_roles import answers
from wirelessagent.language.intent import Intent
from wirelessagent.language.intent_acts import acts_of, stated
from wirelessagent.language.looks import first_look
from wirelessagent.language.sentence import BUILT_IN


@dataclass(frozen=True, kw_only=True)
class Read:
    """A line as the readers of sentences see it.

    Attributes:
        kind: of their intent; ``topic`` is who read it, and what it is about or what it asks.
        acts, guessed: what they would do, or suppose, and what they ask whether to do.
        effect, guess: what that comes to; None for nothing.
        supposes: whether they would only suppose it.
        order: how likely it orders something.
        kinds: how likely each kind of sentence is.
        roles: by where a figure, a number or users stand, how likely they are there for what.
    """

    kind: str
    topic: str
    acts: tuple[Act, ...]
    guessed: tuple[Act, ...]
    effect: Effect | None
    guess: Effect | None
    supposes: bool
    order: float
    kinds: Mapping[str, float]
    roles: Mapping[int, Mapping[str, float]]

    @classmethod
    def of(cls, line: Line, intent: Intent, possible: Possible) -> Read:
        """What an intent does to what holds."""
        sentence, topic = line.sentence, intent.asks or intent.topic or ""
        acts, guessed = _changing(intent), _guessed(intent)
        return cls(
            kind=intent.kind, topic=f"{intent.recogniser == NAME}:{topic}", acts=acts, guessed=guessed,
            effect=_effect(acts, possible), guess=_effect(guessed, possible), supposes=intent.kind == "question",
            order=sentence.chances.order, kinds=sentence.chances.kinds, roles=_roles(line),
        )  # fmt: skip


def _roles(line: Line) -> dict[int, Mapping[str, float]]:
    """What the figures, the numbers and the users of a line are there for, each by where it stands."""
    look = first_look(line.sentence.plain, line.sentence.quantities, line.context.user_names)
    view, found = look.view(), dict[int, Mapping[str, float]]()
    for place, figure in enumerate(look.figures):
        found[figure.start] = answers(figure.kind, view.figure(place))
    for mention in look.mentions:
        if mention.role == "named":
            found[mention.start] = answers("user", view.user(mention))
    for number in look.loose:
        found[number.start] = answers("number", view.number(number, look.bound(number)))
    return found


def _changing(intent: Intent) -> tuple[Act, ...]:
    """What an intent does to the request, or supposes of it."""
    acts = acts_of(intent)
    if len(acts) == 1 and type(acts[0]) is Suppose and acts[0].missing_share is None:
        return acts[0].acts
    return acts if intent.kind == "allocate" or intent.topic == "undo" else ()


def _guessed(intent: Intent) -> tuple[Act, ...]:
    """What a question back has understood, or offers for a yes."""
    if intent.guess is not None:
        return _changing(intent.guess)
    aim = (Aim(objective=intent.offered),) if intent.offered in BUILT_IN else ()
    return (*aim, *stated(intent.pending)) if intent.kind == "clarify" else ()


def _effect(acts: Sequence[Act], possible: Possible) -> Effect | None:
    steps = [act.steps for act in acts if isinstance(act, Undo)]
    too_many = steps and not (steps[0] is not None and 0 < steps[0] <= len(possible.context.past))
    return None if too_many or not acts else possible.effect(acts)

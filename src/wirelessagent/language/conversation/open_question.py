"""Lines that answer a question back, and what a question back left open."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field

from wirelessagent.language import forms
from wirelessagent.language.conversation.assent import is_assent
from wirelessagent.language.conversation.line import NAME, Line, has, is_all
from wirelessagent.language.intent import COMMANDS, EVERYBODY, Constraint, Intent
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import merged, users_in
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import normalise

_RATES = ("min_rate_bps", "max_rate_bps")


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


def read_answer(line: Line) -> Intent | None:
    """What a line answers to a question that is open; None for any other line."""
    return _agreed(line) or _answered(line) if line.context.awaits == "clarification" else None


def _agreed(line: Line) -> Intent | None:
    """A yes to "did you mean …?"."""
    context = line.context
    if context.guess is not None:
        return dataclasses.replace(context.guess, recogniser=NAME) if is_assent(line.text) else None
    if context.offered is None or forms.plain_command(line.shape) != "confirm":
        return None
    if context.offered in COMMANDS:
        return line.command(context.offered)
    return line.allocate(context.offered, context.pending, amends=context.objective is not None)


def _answered(line: Line) -> Intent | None:
    """Bare figures after a question: they are for the users, and of the aim, that the question was about."""
    context = line.context
    objective = context.pending_objective or context.objective
    asked_about = context.pending_users or _users_with_rates(context.pending)
    if not (asked_about or context.pending_objective) or line.users:
        return None
    bare = line.figures and is_all("only_figures", line.wish) is not None  # and at most what they bound
    if not bare or any(figure.doubtful or figure.value <= 0 for figure in line.figures):
        return None
    values: dict[str, Constraint] = {}
    for figure in line.figures:
        rate = "max_rate_bps" if figure.comparator == "at_most" or context.pending_caps else "min_rate_bps"
        name = rate if figure.kind == "rate" else "max_power_w"
        if name in values:
            return None
        users = asked_about if figure.kind == "rate" else ()
        values[name] = dict.fromkeys(users, figure.value) if users else figure.value
    return with_limits(line, objective, merged(context.pending, values))


def with_limits(line: Line, objective: str | None, limits: Mapping[str, Constraint]) -> Intent:
    """A request with these limits; without an aim, the question for it."""
    if objective is None:
        key = "rate_only" if "min_rate_bps" in limits else "limits_only"
        return line.ask(key, limits, constraints=line.voice.constraints(limits))
    return line.allocate(objective, limits, amends=line.context.objective is not None)


def _users_with_rates(pending: Mapping[str, Constraint]) -> tuple[str, ...]:
    """The users of the one rate that waits; nobody where it is everybody's, or there are several."""
    rates = [value for name, value in pending.items() if name in _RATES]
    only = rates[0] if len(rates) == 1 else None
    return tuple(only) if isinstance(only, Mapping) and EVERYBODY not in only else ()


def unanswered(text: str, intent: Intent, context: Context) -> Question:
    """What the answer to a question back may leave out, as the sentence that led to the question said it."""
    line = Line.of(text, context)
    if too_many_figures(normalise(text)):
        return Question(pending=intent.pending)
    goal = Sentence(text, own_words()).goal
    settled = users_in(intent.pending)
    users = tuple(user for user in line.users if user not in settled)
    objective = goal.objective if goal.verdict == "clear" else None
    offered, caps = intent.offered, has("cap", line.shape) is not None
    if context.awaits != "clarification" or leaves_the_question(line):
        return Question(pending=intent.pending, objective=objective, users=users, caps=caps, offered=offered)
    whole = intent.recogniser == NAME and bool(intent.pending)  # what waited before is in it
    pending = intent.pending if whole else merged(context.pending, intent.pending)
    return Question(
        pending=pending, objective=objective or context.pending_objective,
        users=users or context.pending_users, caps=caps or context.pending_caps, offered=offered,
    )  # fmt: skip


def leaves_the_question(line: Line) -> bool:
    """Whether a line is no answer: it only reports, or speaks of other users than the question back was about."""
    asked = line.context.pending_users
    return is_report(line) or (bool(asked and line.users) and not set(asked) & set(line.users))


def is_report(line: Line) -> bool:
    """Whether a line only states what was or what somebody says, with no word that asks for anything."""
    said = line.shape
    tells = has("past", said) or (has("reported", said) and has("states", said))
    return tells is not None and not has("directs", said)

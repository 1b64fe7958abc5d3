"""What a sentence that led to a question back left open: an aim, and users of whom nothing was understood."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from wirelessagent.language.conversation.line import Line, has
from wirelessagent.language.excess import too_many_figures
from wirelessagent.language.followups import merged
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import normalise


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
        offered: the objective or the command that a yes means; None where it is no question of yes or no.
        guess: what a yes carries out; None where it is no question of yes or no.
        missing: the user who is not there, where the question is about one.
    """

    pending: Mapping[str, Constraint] = field(default_factory=dict[str, Constraint])
    objective: str | None = None
    users: tuple[str, ...] = ()
    offered: str | None = None
    guess: Intent | None = None
    missing: Missing | None = None


def unanswered(text: str, intent: Intent, context: Context) -> Question:
    """What the answer to a question back may leave out, as the sentence that led to the question said it."""
    line = Line.of(text, context)
    if too_many_figures(normalise(text)):
        return Question(pending=intent.pending)
    goal = Sentence(text, own_words()).goal
    settled = {user for value in intent.pending.values() for user in _users_of(value)}
    users = tuple(user for user in line.users if user not in settled)
    objective = goal.objective if goal.verdict == "clear" else None
    offered = intent.offered
    if context.awaits != "clarification" or leaves_the_question(line):
        return Question(pending=intent.pending, objective=objective, users=users, offered=offered)
    return Question(
        pending=merged(context.pending, intent.pending), objective=objective or context.pending_objective,
        users=users or context.pending_users, offered=offered,
    )  # fmt: skip


def leaves_the_question(line: Line) -> bool:
    """Whether a line is no answer: it only reports, or speaks of other users than the question back was about."""
    asked = line.context.pending_users
    return is_report(line) or (bool(asked and line.users) and not set(asked) & set(line.users))


def _users_of(value: Constraint) -> tuple[str, ...]:
    if isinstance(value, tuple):
        return value
    return tuple(value) if isinstance(value, Mapping) else ()


def is_report(line: Line) -> bool:
    """Whether a line only states what was or what somebody says, with no word that asks for anything."""
    said = line.shape
    tells = has("past", said) or (has("reported", said) and has("states", said))
    return tells is not None and not has("directs", said)

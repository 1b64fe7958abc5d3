"""What a sentence that led to a question back left open: an aim, and users of whom nothing was understood."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.followups import merged
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence, own_words


@dataclass(frozen=True, kw_only=True)
class Unanswered:
    """The constraints and the objective (or None) that were understood, and users of whom nothing was."""

    pending: Mapping[str, Constraint]
    objective: str | None
    users: tuple[str, ...]


def unanswered(text: str, intent: Intent, context: Context) -> Unanswered:
    """What the answer to a question back may leave out, as the sentence that led to the question said it."""
    line = Line.of(text, context)
    goal = Sentence(text, own_words()).goal
    settled = {user for value in intent.pending.values() for user in _users_of(value)}
    users = tuple(user for user in line.users if user not in settled)
    objective = goal.objective if goal.verdict == "clear" else None
    if context.awaits != "clarification" or leaves_the_question(line):
        return Unanswered(pending=intent.pending, objective=objective, users=users)
    return Unanswered(
        pending=merged(context.pending, intent.pending), objective=objective or context.pending_objective,
        users=users or context.pending_users,
    )  # fmt: skip


def leaves_the_question(line: Line) -> bool:
    """Whether a line speaks of other users than the question back was about, and so answers it not."""
    asked = line.context.pending_users
    return bool(asked and line.users) and not set(asked) & set(line.users)


def _users_of(value: Constraint) -> tuple[str, ...]:
    if isinstance(value, tuple):
        return value
    return tuple(value) if isinstance(value, Mapping) else ()

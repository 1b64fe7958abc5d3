"""Lines that answer a question back, and what a question back left open."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from wirelessagent.language import forms
from wirelessagent.language.conversation.assent import is_assent
from wirelessagent.language.conversation.line import NAME, Line, has, is_all
from wirelessagent.language.intent import COMMANDS, EVERYBODY, Constraint, Intent
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.recogniser import Context, Question
from wirelessagent.language.request import merged, users_in
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import normalise

_RATES = ("min_rate_bps", "max_rate_bps")


def read_answer(line: Line) -> Intent | None:
    """What a line answers to a question that is open; None for any other line."""
    return _agreed(line) or _answered(line) if line.context.awaits == "clarification" else None


def _agreed(line: Line) -> Intent | None:
    """A yes to "did you mean …?"."""
    question = line.context.question
    if question.guess is not None:
        return dataclasses.replace(question.guess, recogniser=NAME) if is_assent(line.text) else None
    if question.offered is None or forms.plain_command(line.shape) != "confirm":
        return None
    if question.offered in COMMANDS:
        return line.command(question.offered)
    return line.allocate(question.offered, question.pending, amends=line.context.objective is not None)


def _answered(line: Line) -> Intent | None:
    """Bare figures after a question: they are for the users, and of the aim, that the question was about."""
    question = line.context.question
    asked_about = question.users or _users_with_rates(question.pending)
    if not (asked_about or question.objective) or line.users:
        return None
    bare = line.figures and is_all("only_figures", line.wish) is not None  # and at most what they bound
    if not bare or any(figure.doubtful or figure.value <= 0 for figure in line.figures):
        return None
    values: dict[str, Constraint] = {}
    for figure in line.figures:
        rate = "max_rate_bps" if figure.comparator == "at_most" or question.caps else "min_rate_bps"
        name = rate if figure.kind == "rate" else "max_power_w"
        if name in values:
            return None
        users = asked_about if figure.kind == "rate" else ()
        values[name] = dict.fromkeys(users, figure.value) if users else figure.value
    return with_limits(line, question.objective or line.context.objective, merged(question.pending, values))


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
    offered, caps, before = intent.offered, has("cap", line.shape) is not None, context.question
    if context.awaits != "clarification" or leaves_the_question(line):
        return Question(pending=intent.pending, objective=objective, users=users, caps=caps, offered=offered)
    whole = intent.recogniser == NAME and bool(intent.pending)  # what waited before is in it
    pending = intent.pending if whole else merged(before.pending, intent.pending)
    return Question(
        pending=pending, objective=objective or before.objective, users=users or before.users,
        caps=caps or before.caps, offered=offered,
    )  # fmt: skip


def leaves_the_question(line: Line) -> bool:
    """Whether a line is no answer: it only reports, or speaks of other users than the question back was about."""
    asked = line.context.question.users
    return is_report(line) or (bool(asked and line.users) and not set(asked) & set(line.users))


def is_report(line: Line) -> bool:
    """Whether a line only states what was or what somebody says, with no word that asks for anything."""
    said = line.shape
    tells = has("past", said) or (has("reported", said) and has("states", said))
    return tells is not None and not has("directs", said)

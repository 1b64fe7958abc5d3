"""Lines that answer a question back, free users of a limit or take them back; and what a question back left open.

Users whose own figure goes are written out, as the request has
no figure for "nothing": 1 Mbit/s for everybody but user 2 is 1 Mbit/s for each of the others.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language import forms
from wirelessagent.language.conversation.assent import is_assent
from wirelessagent.language.conversation.line import NAME, Line, has, is_all
from wirelessagent.language.followups import merged, numbers_of, taken_in, users_in
from wirelessagent.language.intent import (
    COMMANDS,
    EVERYBODY,
    FIGURES_OF_USERS,
    LISTS_OF_USERS,
    Constraint,
    Intent,
)  # fmt: skip
from wirelessagent.language.lifted import lifted_in, named_in, says_no_more
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.recogniser import Context
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


def read_amendment(line: Line) -> Intent | None:
    """What a line changes of the request that holds or of a question that is open; None for any other line."""
    if line.context.awaits == "clarification":
        answer = _agreed(line) or _answered(line)
        if answer is not None:
            return answer
    if line.context.objective is None:
        return None
    found = (read(line) for read in (_freed, _returned, _taken_in))
    return next((intent for intent in found if intent is not None), None)


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
    if not is_all("only_figures", line.wish) or any(figure.doubtful or figure.value <= 0 for figure in line.figures):
        return None
    values: dict[str, Constraint] = {}
    for figure in line.figures:
        rate = "max_rate_bps" if figure.comparator == "at_most" else "min_rate_bps"
        name = rate if figure.kind == "rate" else "max_power_w"
        if name in values:
            return None
        users = asked_about if figure.kind == "rate" else ()
        values[name] = dict.fromkeys(users, figure.value) if users else figure.value
    values = merged(context.pending, values)
    if objective is None:
        key = "rate_only" if "min_rate_bps" in values else "limits_only"
        return line.ask(key, values, constraints=line.voice.constraints(values))
    return line.allocate(objective, values, amends=context.objective is not None)


def _users_with_rates(pending: Mapping[str, Constraint]) -> tuple[str, ...]:
    """The users of the one rate that waits; nobody where it is everybody's, or there are several."""
    rates = [value for name, value in pending.items() if name in _RATES]
    only = rates[0] if len(rates) == 1 else None
    return tuple(only) if isinstance(only, Mapping) and EVERYBODY not in only else ()


def _freed(line: Line) -> Intent | None:
    """ "User 2 does not need 1 Mbit/s any more": these users' limit goes, and no other."""
    context = line.context
    if not line.users and is_all("nobody_needs", line.wish):
        held = [name for name in _RATES if name in context.constraints]
        return line.amend({}, dropped=(held[0],)) if held else None
    said = line.shape.replace("@", " ")
    lifted = lifted_in(said)
    frees = (lifted and not line.figures and says_no_more(said, lifted.values())) or is_all("freed", line.wish)
    named = {name for _, name in named_in(said)}
    if not line.users or not frees or not (named or line.figures):
        return None
    freed = numbers_of(line.users, context.user_names)
    names = tuple(name for name in FIGURES_OF_USERS if name in named)
    if not names:
        names = ("max_rate_bps", "min_rate_bps") if "all" in named else ("min_rate_bps", "max_rate_bps")
    for name in names:
        held = context.constraints.get(name)
        own = None if held is None or isinstance(held, tuple) else _by_user(held, context.user_names)
        if own is None or held is None or not freed & numbers_of(tuple(own), context.user_names):
            continue
        theirs = {user: figure for user, figure in own.items() if freed & numbers_of((user,), context.user_names)}
        if line.figures and {figure.value for figure in line.figures} != set(theirs.values()):
            asked, stays = line.figures[0].text, line.voice.constraints({name: theirs})
            return line.ask("not_promised", text=asked, users=line.voice.users(line.users), constraints=stays)
        rest = {user: figure for user, figure in own.items() if user not in theirs}
        if line.figures and isinstance(held, Mapping) and EVERYBODY in held:
            common = _of_everybody(held, theirs, freed, context.user_names)
            if common is not None:
                return line.amend({name: common}, dropped=(name,))
        values: dict[str, Constraint] = {name: rest} if rest else {}
        gone: dict[str, Constraint] = {name: {user: figure for user, figure in own.items() if user not in rest}}
        return line.amend(values, dropped=(name,), taken_off=gone)
    return line.ask("no_limit_of_its_own", users=line.voice.users(line.users))


def _of_everybody(
    held: Mapping[str, float], theirs: Mapping[str, float], freed: set[int | str], user_names: Sequence[str]
) -> Mapping[str, float] | None:
    """What is left where the own figures of some go and everybody's holds for them too; None where they have none."""
    left = {user: figure for user, figure in held.items() if not freed & numbers_of((user,), user_names)}
    return left if len(left) < len(held) and held[EVERYBODY] not in theirs.values() else None


def _by_user(held: float | Mapping[str, float], user_names: Sequence[str]) -> dict[str, float]:
    """Figures by user with everybody written out."""
    figures: dict[str, float] = {**held} if isinstance(held, Mapping) else {EVERYBODY: held}
    for_all = figures.pop(EVERYBODY, None)
    if for_all is None:
        return figures
    named = numbers_of(tuple(figures), user_names)
    rest = [place for place in range(1, len(user_names) + 1) if place not in named]
    return {**figures, **{_reference(user_names[place - 1], place): for_all for place in rest}}


def _reference(name: str, place: int) -> str:
    return str(place) if name.lower() == f"user {place}" else name


def _taken_in(line: Line) -> Intent | None:
    """ "Also serve user 2": a user more, where only some are served."""
    context = line.context
    if is_all("everyone_in", line.wish):
        back = tuple(name for name in LISTS_OF_USERS if name in context.constraints)
        if not back:
            return line.ask("all_served")
        return line.amend({}, dropped=back)
    if not line.users or line.figures or not is_all("taken_in", line.wish):
        return None
    return _served(line, line.users)


def _returned(line: Line) -> Intent | None:
    """ "User 3 is here again": who is back is served again, and "he" is the one who was left out."""
    if line.figures or not is_all("back", line.wish):
        return None
    users, left_out = line.users, line.context.constraints.get("leave_out")
    if not users and isinstance(left_out, tuple):
        if len(left_out) > 1:
            return line.ask("who_is_back", users=line.voice.users(left_out))
        users = left_out
    return _served(line, users) if users else None


def _served(line: Line, users: tuple[str, ...]) -> Intent:
    """These users served too; asked about where they are served already."""
    values, dropped = taken_in(users, line.context)
    if not values and not dropped:
        return line.ask("served_already", users=line.voice.users(users))
    return line.amend(values, dropped=dropped)


def unanswered(text: str, intent: Intent, context: Context) -> Question:
    """What the answer to a question back may leave out, as the sentence that led to the question said it."""
    line = Line.of(text, context)
    if too_many_figures(normalise(text)):
        return Question(pending=intent.pending)
    goal = Sentence(text, own_words()).goal
    settled = users_in(intent.pending)
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


def is_report(line: Line) -> bool:
    """Whether a line only states what was or what somebody says, with no word that asks for anything."""
    said = line.shape
    tells = has("past", said) or (has("reported", said) and has("states", said))
    return tells is not None and not has("directs", said)

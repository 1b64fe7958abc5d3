"""Lines that answer: whether one lets the waiting plan be applied, and what it says to a question back.

Assent is a closed grammar, no model, whichever recogniser is at work.

A base station is only told to act by a line that is, as a whole, an assent or a plain command to apply: "yes, please",
"apply it now", "好的，应用吧". A negation, a question mark, a condition, a time, another target, a figure or any word
left over makes it something else, which at most leads to a question. The words are data, those of all languages
together (``[assent]`` in ``talk_forms/<language>.toml``).
"""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Mapping
from typing import Literal, TypeAlias

from wirelessagent.language import moods
from wirelessagent.language.conversation.line import NAME, Line, has, is_all
from wirelessagent.language.intent import COMMANDS, EVERYBODY, RATES, Constraint, Intent
from wirelessagent.language.numerals import too_many_figures
from wirelessagent.language.recogniser import Context, Question
from wirelessagent.language.request import merged, users_in
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import lowered, normalise
from wirelessagent.language.word_tables import deferred, languages_with, table, written

Assent: TypeAlias = Literal["yes", "mild", "apply", "no", "later", "doubtful", "other"]
"""What a line is to a plan that waits: a yes; a mild one, such as "ok", which may only take note of an answer; a
command to apply; a refusal; a wish to wait; words about applying that are none of these, such as a question; or
anything else."""

_LONGEST = 100
"""Characters of a line that may be an assent."""
_WORDS = "talk_forms"
_APART = r"(?:(?<![^\W\d_])|(?<=[\u3400-\u9fff]))"
_OVER = r"(?:(?![^\W\d_])|(?=[\u3400-\u9fff]))"
_NO_ASSENT = deferred(r"[?\d]|[是对對]吧")
"""A question or a figure, which no assent has in it."""
_PLAIN = deferred(r"[\s,，、.。!~；;:…]+")
_ABOUT = ("of_applying", "of_assent", "mild_of_assent")


@functools.cache
def _either(*classes: str) -> re.Pattern[str]:
    """The words of these classes in all languages."""
    return re.compile("|".join(
        written(_WORDS, language, each)
        for language in languages_with(_WORDS)
        for name in classes
        for each in table(_WORDS, language)["assent"].get(name, ())
    ))  # fmt: skip


@functools.cache
def _all_of(*classes: str) -> re.Pattern[str]:
    """Up to nine words of these classes, each one apart; a group by each class."""
    words = (f"(?P<{name}>{_APART}(?:{_either(name).pattern}){_OVER})" for name in classes)
    return re.compile(rf"(?: *(?:{'|'.join(words)})){{1,9}} *")


@functools.cache
def _known() -> tuple[frozenset[str], frozenset[str]]:
    """The words, and the Chinese signs, of which a line about a plan may be made and nothing else of the cell."""
    listed = [table(_WORDS, language)["assent"] for language in languages_with(_WORDS)]
    signs = "".join(words.get("known_signs", "") for words in listed)
    return frozenset(word for words in listed for word in words.get("known", "").split()), frozenset(signs)


def assent(text: str) -> Assent:
    """What a line is to a plan that waits.

    >>> assent("Yes, please apply it now!"), assent("apply nothing"), assent("should I apply it?"), assent("non merci")
    ('apply', 'no', 'doubtful', 'no')
    >>> assent("好的，应用吧"), assent("ok, hold on"), assent("now with 5 W")
    ('apply', 'later', 'other')
    """
    if len(text) > _LONGEST:
        return "other"
    said = lowered(normalise(text)).strip()
    plain = _PLAIN.sub(" ", said).strip()
    match = None if _NO_ASSENT.search(said) else _all_of("apply", "mild", "yes", "polite").fullmatch(plain)
    if match is not None and (match["apply"] or match["yes"] or match["mild"]):
        return "apply" if match["apply"] else "yes" if match["yes"] else "mild"
    known, signs = _known()
    words = re.findall(r"[^\W\d_]+(?:'[^\W\d_]+)?|\S", plain)
    speaks_of_it = all(word in known or word in "?'\"" or signs.issuperset(word) for word in words)
    return _about_applying(plain) if speaks_of_it else "other"


def is_assent(text: str) -> bool:
    """Whether a line, as a whole, lets the waiting plan be applied."""
    return assent(text) in ("yes", "mild", "apply")


def speaks_of_applying(text: str) -> bool:
    """Whether a line has a word of assent or of applying in it, whatever it says of it."""
    return _either(*_ABOUT[:2]).search(lowered(normalise(text[:_LONGEST]))) is not None


def read_assent(line: Line) -> Intent | None:
    """A line that is about the plan that waits for a yes and about nothing else; None for any other."""
    said = assent(line.text) if line.context.awaits == "confirmation" else "other"
    return None if said == "other" else line.answer.command({"no": "reject", "apply": "apply"}.get(said, "confirm"))


def _about_applying(plain: str) -> Assent:
    if _all_of("no").fullmatch(plain) and not _all_of("courtesy").fullmatch(plain):
        return "no"
    about, condition = _either(*_ABOUT).search(plain), _either("condition").search(plain)
    if _either("taken_back").search(plain) or (about and ("?" in plain or _either("asked").search(plain))):
        return "doubtful"
    if _either("later").search(plain):
        return "doubtful" if condition else "later"
    if about is None:
        return "other"
    if condition or _either("contradicts").search(plain):
        return "doubtful"
    return "no" if _either("refused").search(plain) else "doubtful"


def read_answer(line: Line) -> Intent | None:
    """What a line answers to a question that is open; None for any other line."""
    return _agreed(line) or _answered(line) if line.context.awaits == "clarification" else None


def _agreed(line: Line) -> Intent | None:
    """A yes to "did you mean …?"."""
    question = line.context.question
    if question.guess is not None:
        return dataclasses.replace(question.guess, recogniser=NAME) if is_assent(line.text) else None
    if question.offered is None or moods.plain_command(line.shape) != "confirm":
        return None
    if question.offered in COMMANDS:
        return line.answer.command(question.offered)
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
        return line.answer.ask(key, 1.0, limits, constraints=line.voice.constraints(limits))
    return line.allocate(objective, limits, amends=line.context.objective is not None)


def _users_with_rates(pending: Mapping[str, Constraint]) -> tuple[str, ...]:
    """The users of the one rate that waits; nobody where it is everybody's, or there are several."""
    rates = [value for name, value in pending.items() if name in RATES]
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
    goes_on = context.awaits == "clarification" and not leaves_the_question(line)
    before = context.question if goes_on else Question()
    whole = not goes_on or (intent.recogniser == NAME and bool(intent.pending))  # what waited before is in it
    return Question(
        pending=intent.pending if whole else merged(before.pending, intent.pending), offered=intent.offered,
        objective=objective or before.objective, users=users or before.users,
        caps=before.caps or has("cap", line.shape) is not None,
    )  # fmt: skip


def leaves_the_question(line: Line) -> bool:
    """Whether a line is no answer: it only reports, or speaks of other users than the question back was about."""
    asked, said = line.context.question.users, line.shape
    tells = has("past", said) or (has("reported", said) and has("states", said))
    reports = tells is not None and not has("directs", said)
    return reports or (bool(asked and line.users) and not set(asked) & set(line.users))

"""What a line means in the conversation that it stands in.

What is a command or a question about the conversation ("undo twice", "compare with turn 2"), a yes, or an answer to a
question back is read by patterns, whichever recogniser is at work; everything else is left to the recogniser. What that
comes to is weighed against everything else that the line may change (:mod:`.weighing`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from wirelessagent.language.conversation import answers, commands, questions
from wirelessagent.language.conversation.answers import unanswered
from wirelessagent.language.conversation.line import NAME, Line, called, has, only_called, with_users
from wirelessagent.language.conversation.parts import by_parts
from wirelessagent.language.conversation.weighing import weighed
from wirelessagent.language.guard import guarded
from wirelessagent.language.intent import Intent, acts_of, stated
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context, Question, Recogniser
from wirelessagent.language.request import Request, applied
from wirelessagent.language.sentence import BUILT_IN

__all__ = ["NAME", "called", "unanswered", "understood", "with_users"]

_LONGEST = 200
"""Characters of a line that may lean on the conversation; a longer one speaks for itself."""
_READERS = (
    commands.read_command, answers.read_assent, commands.read_alike, commands.read_method, questions.read_comparison,
    questions.read_needed, questions.read_promisable, questions.read_question, answers.read_answer,
)  # fmt: skip
"""What a line may be because of its conversation, the closest first."""


def understood(text: str, context: Context, recogniser: Recogniser) -> Intent:
    """What a line means in its conversation; never raises, whatever the text.

    Behind a request, what the offline reader makes of a line is weighed against everything else that it may change.
    A recogniser that is to be spared, such as an LLM, is asked about what is not surely meant.
    """
    if len(text) > _LONGEST or (recogniser.is_spared and context.objective is None):
        return read_by_rules(text, context, recogniser)
    line = Line.of(with_users(text, context.called), context)
    first = OfflineRecogniser() if recogniser.is_spared else recogniser
    intent, sure = _meant(line, first)
    question = context.question
    aimless = question.pending and not (context.objective or question.objective or question.users)
    if aimless and intent.kind == "clarify":  # limits were said, and nothing is open but their aim
        return _beside_what_waits(line, intent, recogniser)
    if first is recogniser:
        return intent
    return dataclasses.replace(intent, recogniser=NAME) if sure else read_by_rules(text, context, recogniser)


def _meant(line: Line, recogniser: Recogniser) -> tuple[Intent, bool]:
    """What a line means behind a request, as a whole or by its parts, and whether it surely does."""

    def weigh(part: Line) -> tuple[Intent, bool]:
        return weighed(part, read_by_rules(part.text, part.context, recogniser))

    intent, sure = weigh(line)
    parts = None if line.context.objective is None else by_parts(line, intent, weigh)
    return (intent, sure) if parts is None else (parts, True)


def _beside_what_waits(line: Line, intent: Intent, recogniser: Recogniser) -> Intent:
    """What a line changes of limits that wait for their aim, and asks for it again; else what is read of it."""
    pending, aim = line.context.question.pending, BUILT_IN[0]  # any
    held = dataclasses.replace(
        line.context, objective=aim, constraints=pending, acts=tuple(stated(pending)), awaits="nothing",
        question=Question(),
    )  # fmt: skip
    found = understood(line.text, held, recogniser)
    if found.kind != "allocate" or not found.amends or found.objective != aim or "objective" in found.evidence:
        return intent
    after, _ = applied(Request(objective=aim, constraints=pending), acts_of(found))
    return intent if after is None else answers.with_limits(line, None, after.constraints)


def read_by_rules(text: str, context: Context, recogniser: Recogniser) -> Intent:
    """What a line means by the patterns of commands, questions and answers, and by the reader of sentences.

    Nothing that is only supposed is asked for, what holds stays where another aim is named, and a command that changes
    something is all that its line says. What is not clearly asked for now is asked about.
    """
    noted: Mapping[str, str] = only_called(text) if len(text) <= _LONGEST else {}
    text = with_users(text, context.called)
    line = Line.of(text[:_LONGEST], context)
    if noted:
        users = ", ".join(f"{name} = {number}" for name, number in noted.items())
        return line.answer.out_of_scope("called", users=users)
    intent = commands.made_certain(line, _read(text, line, context, recogniser), text)
    return guarded(text, context, _keeping_what_holds(line, questions.only_supposed(line, intent)))


def _read(text: str, line: Line, context: Context, recogniser: Recogniser) -> Intent:
    if len(text) > _LONGEST:
        return recogniser.read(text, context)
    beside = commands.beside_method(text)
    if beside is not None:
        rest, name = beside
        by = commands.with_method(line, _read(rest, Line.of(rest, context), context, recogniser), name)
        if by is not None:
            return by
    for read in _READERS:
        intent = read(line)
        if intent is not None:
            return intent
    if answers.leaves_the_question(line):
        context = dataclasses.replace(context, awaits="nothing", question=Question())
    intent = recogniser.read(text, context)
    read = questions.asked_instead(line, intent) or commands.by_method(line, intent)
    return questions.given_instead(line, read)


def _keeping_what_holds(line: Line, intent: Intent) -> Intent:
    """A request as a change of the one that holds, or in its place where it starts over; other intents as they are.

    Replacing it would let a power limit go, or a rate that was promised, because a line names an aim and any other
    figure: that is for the operator to say. What was read by its conversation alone is what it is.
    """
    objective = line.context.objective
    if intent.kind != "allocate" or objective is None or intent.recogniser == NAME:
        return intent
    if not has("starts_over", line.shape):
        return dataclasses.replace(intent, amends=True)
    aims = intent.objective != objective or "objective" in intent.evidence
    return dataclasses.replace(intent, amends=False, dropped=()) if aims else intent

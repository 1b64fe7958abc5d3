"""What a line means because of the conversation that it stands in, by patterns, whichever recogniser is at work.

A recogniser reads sentences; here is read what only the turns before give a meaning: "undo twice", "no, I meant user
3", "double the rates", "do that" behind a what-if, figures that answer a question back. Everything else is left to the
recogniser. English and Chinese only.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language.conversation.about import asked_instead, read_question
from wirelessagent.language.conversation.amendments import read_amendment
from wirelessagent.language.conversation.commands import read_command
from wirelessagent.language.conversation.line import NAME, Line
from wirelessagent.language.conversation.relative import read_relative
from wirelessagent.language.conversation.unanswered import Unanswered, leaves_the_question, unanswered
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Context, Recogniser

__all__ = ["NAME", "Unanswered", "unanswered", "understood"]

_LONGEST = 200
"""Characters of a line that may lean on the conversation; a longer one speaks for itself."""


def understood(text: str, context: Context, recogniser: Recogniser) -> Intent:
    """What a line means in its conversation; never raises, whatever the text."""
    if len(text) > _LONGEST:
        return recogniser.recognise(text, context)
    line = Line.of(text, context)
    for read in (read_command, read_relative, read_question, read_amendment):
        intent = read(line)
        if intent is not None:
            return intent
    if leaves_the_question(line):
        context = dataclasses.replace(
            context, awaits="nothing", pending={}, pending_objective=None, pending_users=()
        )  # fmt: skip
    intent = recogniser.recognise(text, context)
    return asked_instead(line, intent) or intent

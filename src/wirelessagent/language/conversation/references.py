"""What a request leaves to its conversation: for whom a figure is, of which limit, who is meant, and what holds on."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from wirelessagent.language.acts import Aim, LeaveOut, Limit, Named, Others, Scale, Suppose, Whom
from wirelessagent.language.conversation.line import NAME, Line, has
from wirelessagent.language.conversation.tokens import UNITS, own_users, speaks_of_one, tokens_of
from wirelessagent.language.intent import FIGURES_OF_USERS, Intent
from wirelessagent.language.intent_acts import acts_of
from wirelessagent.language.mentions import mentions
from wirelessagent.language.text import languages_of, normalise


def referred(line: Line, intent: Intent) -> Intent:
    """A request whose figure leaves out what it is of as the line or the last act has it.

    A figure for everybody is for whom the line refers to: "the rest", "both", "her" behind a line about user 2. A power
    that no noun calls the cell's is of the kind of the last one: "go to 250 mW" behind a limit of each subcarrier.
    """
    context = line.context
    if intent.kind != "allocate" or context.objective is None or intent.recogniser == NAME:
        return intent
    supposed = acts_of(context.guess) if context.guess is not None else ()
    wondered = (act for one in context.acts if isinstance(one, Suppose) for act in one.acts)
    last = [act for act in (*context.acts, *wondered, *supposed) if isinstance(act, Limit | Scale | LeaveOut)]
    intent = _of_last_kind(line, intent, [act for act in last if isinstance(act, Limit)])
    kinds = [kind for kind in FIGURES_OF_USERS if isinstance(intent.constraints.get(kind), float)]
    if not kinds:
        return intent
    plain = normalise(line.text)
    roles = {each.role for each in mentions(plain, context.user_names)} - {"pronoun"}
    named = {act.whom for act in last if isinstance(act.whom, Named)}
    if len(context.spoken_of) == 1:
        named = {Named(context.spoken_of)}
    whom: Whom | None = Others() if roles == {"others"} else None
    both = own_users(context.constraints.get(kinds[0]))
    if not roles and len(both) == 2 and speaks_of_one(plain, "both"):
        whom = Named(both)
    elif not roles and len(named) == 1 and (speaks_of_one(plain) or (line.is_read and speaks_of_one(plain, "it"))):
        whom = named.pop()
    if whom is None:
        of_named = {act.kind for act in last if isinstance(act, Limit | Scale) and act.whom in named}
        leans = bool(of_named & {*kinds}) and not any(speaks_of_one(plain, noun) for noun in ("rate", "promise"))
        if roles or not (speaks_of_one(plain, "one") or leans):
            return intent
        waits = line.voice.constraints({kinds[0]: intent.constraints[kinds[0]]})  # said by the line before a question
        text = intent.evidence.get(kinds[0]) or waits
        return line.ask("whose_figure", text=text, users=line.voice.users(context.user_names))
    acts = [dataclasses.replace(act, whom=whom) if isinstance(act, Limit) and act.kind in kinds else act
            for act in acts_of(intent)]  # fmt: skip
    return dataclasses.replace(intent, acts=tuple(acts))


def _of_last_kind(line: Line, intent: Intent, last: Sequence[Limit]) -> Intent:
    """A limit of the power as one of the kind that was stated last, where no noun says that it is the cell's."""
    kinds, plain = {act.kind for act in last}, normalise(line.text)
    aims = any(isinstance(act, Aim) and act.words for act in line.context.acts)
    leans = speaks_of_one(plain, "correct") or not aims
    name = kinds.pop() if len(kinds) == 1 and leans and line.context.awaits != "clarification" else ""
    stated = "max_power_w" in intent.constraints and name in UNITS["power"] and name not in intent.constraints
    if not stated or any(speaks_of_one(plain, noun) for noun in ("power", "limit")):
        return intent
    names = {"max_power_w": name}
    constraints = {names.get(each, each): value for each, value in intent.constraints.items()}
    evidence = {names.get(each, each): words for each, words in intent.evidence.items()}
    reply = line.voice.amended(constraints, intent.dropped)
    return dataclasses.replace(intent, constraints=constraints, evidence=evidence, reply=reply)


def keeping_what_holds(line: Line, intent: Intent) -> Intent:
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


def named_alone(line: Line) -> tuple[str, ...]:
    """The users that a line names and nothing else: "excuse me, I meant user 2"."""
    for language in languages_of(line.text):
        tokens = tokens_of(line, language) or ()
        if tokens and all(token.classes & {"users", "correct", "skip", "lead", "it"} for token in tokens):
            return tuple(user for token in tokens for user in token.users)
    return ()

"""The plan that waits for a yes: it is named before it is applied, and only a plain yes applies it.

Whatever a recogniser makes of a line, the line itself has to be an assent
(:mod:`wirelessagent.language.conversation.assent`), and it has to follow a reply that names the plan.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.agent.restating import restated
from wirelessagent.agent.state import Reply, State, Talk, asked_back, nothing_yet
from wirelessagent.language.acts import Act, AskStatus, Export, Yes
from wirelessagent.language.conversation.assent import assent, is_assent, speaks_of_applying
from wirelessagent.language.conversation.unanswered import Question
from wirelessagent.telling.catalogue import Said, message

_YES = ("apply", "confirm")


def doubted(talk: Talk, act: Act) -> Reply | None:
    """What is said to a line that was taken for a yes or for a command to apply and is none; None where it is one."""
    if isinstance(act, Yes) and talk.state.planned is None:
        return None  # which applies nothing
    if assent(talk.text) == "later":
        return _left_waiting(talk)
    if not is_assent(talk.text) or (talk.state.planned is not None and not _follows(talk)):
        return asked_again(talk)
    return None


def _follows(talk: Talk) -> bool:
    """Whether a line answers a reply that names the plan; a mere "ok" has to answer the question itself."""
    last, question = talk.turns[-1] if talk.turns else None, talk.state.question
    if last is None or any(isinstance(act, Export) for act in last.acts):
        return False
    if question is not None and question.offered not in _YES:
        return False
    return assent(talk.text) != "mild" or last.stage in ("planned", "asked")


def is_about_the_plan(talk: Talk, left: Question) -> bool:
    """Whether a line that was not understood is about applying the plan that waits."""
    if talk.state.planned is None:
        return False
    return left.offered in _YES or (not left.pending and not left.users and speaks_of_applying(talk.text))


def asked_again(talk: Talk) -> Reply:
    """The question whether to apply what waits, or what was decided and never applied, by its name."""
    state, run = talk.state, talk.state.planned or talk.state.run
    if run is None or state.request is None:
        return nothing_yet(talk)
    if run is state.on_air:
        return Reply(decided=talk.say("plan.already"), stage="nothing")
    fresh = run.outcome is None and run.decision.is_usable and talk.site.station(run) is not None
    if state.planned is None and not fresh:
        return Reply(decided=talk.say("plan.nothing_to_confirm"))
    plan = plan_named(state, talk.language)
    waiting = dataclasses.replace(state, planned=run, question=None)
    return asked_back(talk.say("ask_back.shall_i_apply", request=plan), waiting)


def _left_waiting(talk: Talk) -> Reply:
    """What waits goes on waiting."""
    if talk.state.planned is None:
        return asked_again(talk)
    needs = talk.say("plan.left_waiting", request=plan_named(talk.state, talk.language))
    return Reply(needs=needs, stage="nothing", state=dataclasses.replace(talk.state, question=None))


def plan_named(state: State, language: str) -> str:
    """What the plan is for, as a part of a sentence."""
    plan = "–" if state.request is None else restated(state.request, language).rstrip(".。")
    return plan[:1].lower() + plan[1:]


def naming_the_plan(reply: Reply, talk: Talk, acts: tuple[Act, ...]) -> Reply:
    """The answer to something else, with the plan that still waits as what it needs; a document stays as it is."""
    before, after = talk.state, reply.state or talk.state
    waits = after.planned is not None and after.planned is before.planned and after.question is None
    whole = any(isinstance(act, Export | AskStatus) for act in acts)
    if not waits or whole or reply.needs or reply.stage not in ("answered", "nothing"):
        return reply
    return dataclasses.replace(reply, needs=still_waits(after, talk.language))


def still_waits(state: State, language: str) -> Said:
    """That the plan waits for a yes."""
    return message(language, "plan.still_waits", request=plan_named(state, language))

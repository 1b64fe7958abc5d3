"""The plan that waits for a yes: it is named before it is applied, and only a plain yes applies it.

Whatever a recogniser makes of a line, the line itself has to be an assent
(:mod:`wirelessagent.language.conversation.assent`), and it has to follow a reply that names the plan.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from wirelessagent.agent.restating import restated
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.turn import Turn
from wirelessagent.language.conversation.assent import assent, is_assent, speaks_of_applying
from wirelessagent.language.conversation.unanswered import Unanswered
from wirelessagent.language.intent import Intent
from wirelessagent.telling.catalogue import joined, message

_YES = ("apply", "confirm")
_NAMED = ("plan.still_waits", "plan.or_what_if")
"""Sentences that name the plan at the end of a reply."""


def doubted(site: Site, state: State, intent: Intent, text: str, turns: Sequence[Turn]) -> Reply | None:
    """What is said to a line that was taken for a yes or for a command to apply and is none; None where it is one."""
    if intent.topic == "confirm" and state.planned is None:
        return None  # which applies nothing
    if assent(text) == "later":
        return left_waiting(site, state, intent)
    if not is_assent(text) or (state.planned is not None and not _follows(state, text, turns)):
        return asked_again(site, state, intent)
    return None


def _follows(state: State, text: str, turns: Sequence[Turn]) -> bool:
    """Whether a line answers a reply that names the plan; a mere "ok" has to answer the question itself."""
    last = turns[-1] if turns else None
    if last is None or last.intent.topic == "export":
        return False
    if state.question is not None and state.question.offered not in _YES:
        return False
    return assent(text) != "mild" or last.stage in ("planned", "asked")


def is_about_the_plan(state: State, text: str, left: Unanswered) -> bool:
    """Whether a line that was not understood is about applying the plan that waits."""
    if state.planned is None:
        return False
    return left.offered in _YES or (not left.pending and not left.users and speaks_of_applying(text))


def asked_again(site: Site, state: State, intent: Intent) -> Reply:
    """The question whether to apply what waits, or what was decided and never applied, by its name."""
    language, run = intent.language, state.planned or state.run
    if run is None or state.request is None:
        return Reply(text=message(language, "refused.nothing_yet"))
    if run is state.on_air:
        return Reply(text=message(language, "plan.already"), stage="nothing")
    fresh = run.outcome is None and run.decision.is_usable and site.station(run) is not None
    if state.planned is None and not fresh:
        return Reply(text=message(language, "plan.nothing_to_confirm"))
    waiting = dataclasses.replace(state, planned=run, question=None)
    return Reply(
        text=message(language, "ask_back.shall_i_apply", request=plan_named(state, language)),
        stage="asked",
        state=waiting,
    )


def left_waiting(site: Site, state: State, intent: Intent) -> Reply:
    """What waits goes on waiting."""
    if state.planned is None:
        return asked_again(site, state, intent)
    text = message(intent.language, "plan.left_waiting", request=plan_named(state, intent.language))
    return Reply(text=text, stage="nothing", state=dataclasses.replace(state, question=None))


def plan_named(state: State, language: str) -> str:
    """What the plan is for, as a part of a sentence."""
    plan = "–" if state.request is None else restated(state.request, language).rstrip(".。")
    return plan[:1].lower() + plan[1:]


def naming_the_plan(reply: Reply, before: State, intent: Intent) -> Reply:
    """The answer to something else, with the plan that still waits named at its end; a document stays as it is."""
    after, language = reply.state or before, intent.language
    waits = after.planned is not None and after.planned is before.planned and after.question is None
    if not waits or reply.stage not in ("answered", "nothing") or intent.topic in ("export", "status"):
        return reply
    plan = plan_named(after, language)
    if any(message(language, key, request=plan) in reply.text for key in (*_NAMED, "plan.left_waiting")):
        return reply
    text = joined(language, [reply.text, message(language, _NAMED[0], request=plan)])
    return dataclasses.replace(reply, text=text)

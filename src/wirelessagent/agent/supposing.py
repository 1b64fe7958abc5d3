"""Turns that ask what would be: a decision for other circumstances beside the one that holds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import cast

import numpy as np

from wirelessagent.agent import answers
from wirelessagent.agent.dialogue import Request, applied
from wirelessagent.agent.figures import side_by_side
from wirelessagent.agent.noting import notes
from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY, user_number
from wirelessagent.agent.refusing import RefusedError
from wirelessagent.agent.restating import restated
from wirelessagent.agent.run import Sight
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.turn import Run
from wirelessagent.language.acts import Limit, supposed_in
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.facts.nearest import nearest
from wirelessagent.telling.parts import cannot_be_served, outcome_in_words, value_name
from wirelessagent.telling.remedies import nearest_answer

_SAME = 1e-6
"""A share of the power that nobody sees."""


def what_if(site: Site, state: State, intent: Intent) -> Reply:
    """A decision for other circumstances beside the one that holds."""
    language, details = intent.language, intent.details
    share = details.get("missing_share")
    objective = details.get("objective")
    if details.get("of") == "channel":
        return Reply(text=message(language, "ask_back.channel_given"), stage="asked")
    if share is None and not any(details.get(name) for name in ("constraints", "objective", "dropped")):
        return Reply(text=message(language, "ask_back.what_if_nothing"), stage="asked")
    if state.request is None and objective is None:
        return Reply(text=message(language, "refused.nothing_yet"))
    if share is not None and not 0 <= cast(float, share) < 1:
        return Reply(
            text=message(language, "ask_back.what_if_missing_share", share=percent(cast(float, share))), stage="asked"
        )
    request = supposed(state, intent)
    sight = None if share is None else site.sight_missing(cast(float, share), language)
    run, otherwise = _planned(site, intent, request, sight)
    answer = joined(language, [*otherwise, _verdict(state, run, language)])
    if details.get("asked") == "most" and run.decision.is_usable:
        text = joined(language, [*otherwise, _most(state, run, intent)])
    elif share is None:
        asked = restated(request, language)
        text = message(language, "what_if.answer", request=asked[:1].lower() + asked[1:], answer=answer)
    else:
        text = message(language, "what_if.seen", share=percent(cast(float, share)), answer=answer)
    runs = [(message(language, "what_if.column"), run)]
    if state.run is not None:
        runs.insert(0, (message(language, "compared.now"), site.foreseen(state.run)))
    return Reply(text=text, run=run, tables=(side_by_side(runs, language),))


def _planned(site: Site, intent: Intent, request: Request, sight: Sight | None) -> tuple[Run, list[str]]:
    """The run of a what-if, by the objective's own method where the one that was named does not solve it."""
    try:
        return site.foreseen(site.plan(intent, request, sight=sight)), []
    except RefusedError as refusal:
        if request.method is None:
            raise
        run = site.foreseen(site.plan(intent, dataclasses.replace(request, method=None), sight=sight))
        method = called(intent.language, run.decision.method)
        return run, [refusal.why, message(intent.language, "refused.solved_by", method=method)]


def supposed(state: State, intent: Intent) -> Request:
    """The request of a what-if; one of the most that can be promised is kept with the probability that is assumed."""
    details, acts = intent.details, supposed_in(intent.details)
    held = state.request or Request(objective=cast(str, details.get("objective")))
    named = {*held.constraints, *cast("Mapping[str, Constraint]", details.get("constraints") or {})}
    if details.get("asked") == "most" and "outage_probability" not in named:
        acts = *acts, Limit(kind="outage_probability", value=ASSUMED_OUTAGE_PROBABILITY)
    request, _ = applied(held, acts, radiated_w=state.radiated_w)
    assert request is not None
    return request


def _most(state: State, run: Run, intent: Intent) -> str:
    """The most that can be promised to everybody or to a user, with its certificate."""
    decision, language, user = run.decision, intent.language, intent.details.get("user")
    served = decision.problem.serves(decision.rate_bps.size)
    who = message(language, "what_if.every_user", count=int(served.sum()))
    if user is not None:
        who = called(language, decision.user_names[user_number(str(user), decision.user_names, language)[0]])
    said = message(
        language, "what_if.most_promised", rate=human(decision.value, decision.unit), who=who,
        power=human(decision.problem.budget_w(decision.cell), "W"),
        sure=reliability(decision.problem.outage_probability or 0.0),
    )  # fmt: skip
    proven = message(
        language, "what_if.most_proven", bound=human(decision.bound, decision.unit), gap=percent(decision.gap)
    )
    left_out = cannot_be_served(decision, language)
    warned = [message(language, "text.note", note=left_out)] if left_out else []
    assumed = notes(run, noted=state.noted)
    return joined(
        language,
        [
            said,
            *([] if np.isnan(decision.gap) else [proven]),
            *assumed,
            *warned,
            message(language, "plan.nothing_changed"),
        ],
    )


def _verdict(state: State, run: Run, language: str) -> str:
    """Whether a request can be met and with what, or what can be met instead; and what was assumed only here."""
    now, case = state.run, answers.case_of(run)
    assumed = notes(run, noted=state.noted, before=() if now is None else now.notes)
    nothing = message(language, "plan.nothing_changed")
    if not run.decision.is_usable:
        return joined(language, [*assumed, f"{nearest_answer(case, nearest(case), language)}\n{nothing}"])
    outcome = outcome_in_words(case, run.decision, language)
    met = message(language, "what_if.met", outcome=outcome)
    if now is not None and now.decision.is_usable and _figure_of(now, language) == _figure_of(run, language):
        met = message(language, "what_if.now", outcome=outcome, **_beside(now.decision, run.decision, language))
    elif now is not None and now.decision.is_usable:
        met = joined(language, [met, outcome_beside(state, run, language)])
    left_out = cannot_be_served(run.decision, language)
    warned = [message(language, "text.note", note=left_out)] if left_out else []
    return joined(language, [*assumed, met, *_unused(now, run, language), *warned, nothing])


def outcome_beside(state: State, run: Run, language: str) -> str:
    """What users get and what it takes, beside what holds now: for values that are not of one kind."""
    then, now = _figures(run.decision, language), None if state.run is None else state.run.decision
    if now is None or not now.is_usable or not run.decision.is_usable:
        return ""
    return message(language, "what_if.beside_now", then=then, now=_figures(now, language))


def _figures(decision: Decision, language: str) -> str:
    rate = decision.rate_bps[decision.problem.serves(decision.rate_bps.size)]
    return message(
        language, "what_if.beside_figures", total=human(float(decision.rate_bps.sum()), "bit/s"),
        lowest=human(float(rate.min()), "bit/s"), power=human(decision.total_power_w, "W"),
    )  # fmt: skip


def _unused(now: Run | None, run: Run, language: str) -> list[str]:
    """That another budget changes nothing, where it is not what holds the value back."""
    if now is None or not now.decision.is_usable:
        return []
    spent, before = run.decision.total_power_w, now.decision.total_power_w
    budgets = [one.decision.problem.budget_w(one.decision.cell) for one in (run, now)]
    same = abs(spent - before) <= _SAME * before and budgets[0] != budgets[1]
    if not same or max(spent, before) >= min(budgets) * (1 - _SAME):
        return []
    return [message(language, "what_if.budget_unused", budget=human(budgets[0], "W"), spent=human(spent, "W"))]


def _beside(now: Decision, then: Decision, language: str) -> dict[str, str]:
    """What the value is now, and by how much the other one differs; nothing of that where it does not show."""
    change, value = then.value - now.value, human(now.value, now.unit)
    if not now.value or value == human(then.value, then.unit):
        return {"now": value, "change": ""}
    size, share = human(abs(change), now.unit), percent(abs(change / now.value))
    key = "what_if.more" if change > 0 else "what_if.less"
    return {"now": value, "change": message(language, key, size=size, share=share)}


def _figure_of(run: Run, language: str) -> tuple[str, str]:
    """What a run's value is called, and its unit: values compare where both are the same."""
    return value_name(answers.case_of(run), language), run.decision.unit

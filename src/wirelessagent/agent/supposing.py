"""Questions what would be: a decision for other circumstances beside the one that holds, and the power it takes."""

from __future__ import annotations

import dataclasses

import numpy as np

from wirelessagent.agent.comparing import side_by_side
from wirelessagent.agent.dialogue import Request, applied
from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY, RefusedError, user_number
from wirelessagent.agent.restating import notes, plan_named, restated
from wirelessagent.agent.site import Sight
from wirelessagent.agent.state import Replies, Reply, Talk, asked_back, nothing_yet
from wirelessagent.agent.turn import Run
from wirelessagent.language.acts import Act, Aim, AskMost, AskOtherChannel, AskPower, Limit, Suppose
from wirelessagent.language.intent import Constraint
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.facts.nearest import more_power, nearest
from wirelessagent.telling.parts import cannot_be_served, outcome_in_words, value_name
from wirelessagent.telling.reasons import BEYOND_W, Remedies, reason_in_words

_SAME = 1e-6
"""A share of the power that nobody sees."""

_OTHER_AIMS = ("weights", "max_rate_bps", "max_power_w")
"""What the least power knows nothing of, or is asked for instead of."""


def other_channel(talk: Talk, _: AskOtherChannel) -> Reply:
    """The channel is as it was sensed."""
    return asked_back(talk.say("ask_back.channel_given"))


def what_if(talk: Talk, act: Suppose) -> Reply:
    """A decision for other circumstances beside the one that holds, which the next line may take up."""
    share = act.missing_share
    if share is None and not act.acts:
        return asked_back(talk.say("ask_back.what_if_nothing"))
    request = _supposed(talk, act)
    if request is None:
        return nothing_yet(talk)
    if share is not None and not 0 <= share < 1:
        return asked_back(talk.say("ask_back.what_if_missing_share", share=percent(share)))
    sight = None if share is None else talk.site.sight_missing(share, talk.language)
    run, otherwise = _planned(talk, request, sight)
    if isinstance(act, AskMost) and run.decision.is_usable:
        said = joined(talk.language, [*otherwise, _most(talk, run, act.user)])
    else:
        answer = joined(talk.language, [*otherwise, _verdict(talk, run, share)])
        asked = restated(request, talk.language)
        said = answer
        if share is None:
            said = talk.say("what_if.answer", request=asked[:1].lower() + asked[1:], answer=answer)
    runs = [(talk.say("what_if.column"), run)]
    if talk.state.run is not None:
        runs.insert(0, (talk.say("compared.now"), talk.site.foreseen(talk.state.run)))
    reply = Reply(decided=said, run=run, tables=(side_by_side(runs, talk.language),))
    return _left_open(talk, reply, None if share is not None else request)


def needed_power(talk: Talk, act: AskPower) -> Reply:
    """The least power that the promised rates take; a what-if of the limit where nothing is promised."""
    request, language = _supposed(talk, act), talk.language
    if request is None:
        return nothing_yet(talk)
    promises = "min_rate_bps" in request.constraints or request.objective == "min_power"
    if not promises and act.enough_w is not None:
        return what_if(talk, _limited(act, act.enough_w))
    if not promises:
        return Reply(decided=talk.say("needs.nothing"))
    limits: dict[str, Constraint] = {k: v for k, v in request.constraints.items() if k not in _OTHER_AIMS}
    run = talk.site.plan(talk.intent, Request(objective="min_power", constraints=limits))
    power_w = _power(run)
    said = [*notes(run, noted=talk.state.noted), _taken(run, power_w, language)]
    if act.enough_w is not None:
        said.append(_judged(run, power_w, act.enough_w, act.judged, language))
        said += _of_the_aim(talk, act, request, act.enough_w, power_w)
    return _left_open(talk, Reply(decided=joined(language, said), run=run), request)


def _left_open(talk: Talk, reply: Reply, supposed: Request | None) -> Reply:
    """The reply to a what-if: nothing changed, "do that" takes it up, and a yes is still for the plan that waits."""
    state, needs = talk.state, ""
    if state.planned is not None and state.request is not None:
        key = "plan.still_waits" if supposed is None else "plan.or_what_if"
        needs = talk.say(key, request=plan_named(state.request, talk.language))
    after = dataclasses.replace(state, question=None, supposed=supposed)
    return dataclasses.replace(reply, changed=talk.say("plan.nothing_changed"), needs=needs, state=after)


def _supposed(talk: Talk, act: Suppose) -> Request | None:
    """The request of a what-if; one of the most that can be promised is kept with the probability that is assumed."""
    held, acts = talk.state.request, act.acts
    named = {*(() if held is None else held.constraints), *(one.kind for one in acts if isinstance(one, Limit))}
    if isinstance(act, AskMost) and "outage_probability" not in named:
        acts = *acts, Limit(kind="outage_probability", value=ASSUMED_OUTAGE_PROBABILITY)
    aims: tuple[Act, ...] = tuple(one for one in acts if isinstance(one, Aim))
    return applied(held, (*aims, *acts), radiated_w=talk.state.radiated_w)[0]


def _planned(talk: Talk, request: Request, sight: Sight | None) -> tuple[Run, list[str]]:
    """The run of a what-if, by the objective's own method where the one that was named does not solve it."""
    site, intent = talk.site, talk.intent
    try:
        return site.foreseen(site.plan(intent, request, sight=sight)), []
    except RefusedError as refusal:
        if request.method is None:
            raise
        run = site.foreseen(site.plan(intent, dataclasses.replace(request, method=None), sight=sight))
        method = called(talk.language, run.decision.method)
        return run, [refusal.why, talk.say("refused.solved_by", method=method)]


def _most(talk: Talk, run: Run, user: str | None) -> str:
    """The most that can be promised to everybody or to a user, with its certificate."""
    decision, language = run.decision, talk.language
    served = decision.served
    who = talk.say("what_if.every_user", count=int(served.sum()))
    if user is not None:
        who = called(language, decision.user_names[user_number(user, decision.user_names, language)[0]])
    said = talk.say(
        "what_if.most_promised", rate=human(decision.value, decision.unit), who=who,
        power=human(decision.problem.budget_w(decision.cell), "W"),
        sure=reliability(decision.problem.outage_probability or 0.0),
    )  # fmt: skip
    proven = talk.say("what_if.most_proven", bound=human(decision.bound, decision.unit))
    assumed = notes(run, noted=talk.state.noted)
    return joined(language, [said, *([] if np.isnan(decision.gap) else [proven]), *assumed, *_warned(run, language)])


def _warned(run: Run, language: str) -> list[str]:
    left_out = cannot_be_served(run.decision, language)
    return [message(language, "text.note", note=left_out)] if left_out else []


def _verdict(talk: Talk, run: Run, missing: float | None) -> str:
    """Whether a request can be met, where a share of the gains were missing, and with what, or what can be met instead;
    and what was assumed only here.
    """
    now, language = talk.state.run, talk.language
    assumed = notes(run, noted=talk.state.noted, before=() if now is None else now.notes)
    if not run.decision.is_usable:
        unmet = "" if missing is None else talk.say("what_if.unseen", share=percent(missing))
        return joined(language, [*assumed, unmet, Remedies(run.case, language).told(nearest(run.case))])
    key = "what_if.met" if missing is None else "what_if.still_met"
    met = talk.say(key, outcome=outcome_in_words(run.decision, language), share=percent(missing or 0.0))
    beside = _outcome_beside(now, run, language)
    if now is not None and now.decision.is_usable and _figure_of(now, language) == _figure_of(run, language):
        beside = talk.say("what_if.now", **_beside(now.decision, run.decision, language))
    return joined(language, [*assumed, met, beside, *_unused(now, run, language), *_warned(run, language)])


def _outcome_beside(now: Run | None, run: Run, language: str) -> str:
    """What users get and what it takes, beside what holds now: for values that are not of one kind."""
    if now is None or not now.decision.is_usable or not run.decision.is_usable:
        return ""
    then = _figures(run.decision, language)
    return message(language, "what_if.beside_now", then=then, now=_figures(now.decision, language))


def _figures(decision: Decision, language: str) -> str:
    rate = decision.rate_bps[decision.served]
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
    """By how much the other value differs."""
    change, value = then.value - now.value, human(now.value, now.unit)
    if not now.value or value == human(then.value, then.unit):
        return {"change": message(language, "what_if.same")}
    size, share = human(abs(change), now.unit), percent(abs(change / now.value))
    key = "what_if.more" if change > 0 else "what_if.less"
    return {"change": message(language, key, size=size, share=share)}


def _figure_of(run: Run, language: str) -> tuple[str, str]:
    """What a run's value is called, and its unit: values compare where both are the same."""
    return value_name(run.decision, language), run.decision.unit


def _power(run: Run) -> float | None:
    """The power that was found to do; None where none was."""
    if run.decision.is_usable:
        return run.decision.total_power_w
    more = more_power(run.case)
    return None if more is None or more.power_w > BEYOND_W else more.power_w


def _least(run: Run) -> float:
    """The power that is proven to be needed; 0 where nothing is."""
    decision, need = run.decision, run.decision.needed_power_w
    known = decision.bound if decision.is_usable else None if need is None else need.at_least
    return known if known is not None and known == known else 0.0


def _taken(run: Run, power_w: float | None, language: str) -> str:
    if power_w is None:
        return message(language, "needs.too_much", reason=reason_in_words(run.decision, language))
    power, least = human(power_w, "W"), human(_least(run), "W")
    said = message(language, "needs.exactly" if power == least else "needs.takes", power=power, least=least)
    limit = run.decision.cell.max_power_w
    beyond = [] if power_w <= limit else [message(language, "needs.beyond_limit", limit=human(limit, "W"))]
    return joined(language, [said, *beyond])


def _judged(run: Run, power_w: float | None, enough_w: float, asked: str, language: str) -> str:
    """Whether a power does."""
    if power_w is not None and enough_w >= power_w:
        return message(language, f"needs.{asked}_enough", enough=human(enough_w, "W"), power=human(power_w, "W"))
    key = "needs.not_enough" if enough_w < _least(run) or power_w is None else "needs.perhaps_enough"
    return message(language, key, enough=human(enough_w, "W"))


def _of_the_aim(talk: Talk, act: AskPower, request: Request, enough_w: float, power_w: float | None) -> list[str]:
    """What such a limit makes of an aim that more power serves."""
    if request.objective == "min_power" or power_w is None or enough_w < power_w:
        return []
    asked = what_if(talk, _limited(act, enough_w))
    return [] if asked.run is None else [_outcome_beside(talk.state.run, asked.run, talk.language)]


def _limited(act: AskPower, power_w: float) -> Suppose:
    """The what-if of a budget beside what else is asked about."""
    return Suppose(acts=(*act.acts, Limit(kind="max_power_w", value=power_w)))


REPLIES: Replies = {
    Suppose: what_if,
    AskMost: what_if,
    AskPower: needed_power,
    AskOtherChannel: other_channel,
}

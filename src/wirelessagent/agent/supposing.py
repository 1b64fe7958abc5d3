"""Questions what would be: decisions for other circumstances, requests and tools beside the one that holds.

And those of other turns beside it, and the power that a request takes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from wirelessagent import plugins
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.asking import decided_by
from wirelessagent.agent.posing import ASSUMED_OUTAGE_PROBABILITY, RefusedError, user_number
from wirelessagent.agent.state import Column, Replies, Reply, Sight, Talk, asked_back
from wirelessagent.agent.turn import Run, restated
from wirelessagent.language import acts
from wirelessagent.language.acts import Act
from wirelessagent.language.intent import Constraint
from wirelessagent.language.replies import figure_in_words
from wirelessagent.language.request import Request, applied
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling import parts
from wirelessagent.telling.catalogue import called, lines_of, listed
from wirelessagent.telling.explanation import certificate_line
from wirelessagent.telling.facts.nearest import more_power, nearest
from wirelessagent.telling.margins import Remedies

_SAME = 1e-6
"""A share of the power that nobody sees."""

_OTHER_AIMS = ("weights", "max_rate_bps", "max_power_w")
"""What the least power knows nothing of, or is asked for instead of."""


def what_if(talk: Talk, act: acts.Suppose) -> Reply:
    """A decision for other circumstances beside the one that holds, which the next line may take up."""
    share = act.missing_share
    if share is None and not act.acts:
        return asked_back(talk.say("ask_back.what_if_nothing"))
    request = _supposed(talk, act)
    if share is not None and not 0 <= share < 1:
        return asked_back(talk.say("ask_back.what_if_missing_share", share=percent(share)))
    sight = None if share is None else talk.site.sight(talk.language, missing=share)
    run, refused = _planned(talk, request, sight)
    most = _most(talk, run, act.user) if isinstance(act, acts.AskMost) and run.decision.is_usable else ""
    left_out = parts.cannot_be_served(run.decision, talk.language)
    warned = talk.say("text.note", note=left_out) if left_out else ""
    said = talk.joined(refused, most or _verdict(talk, run, share), warned)
    if share is None and not most:
        asked = restated(request, talk.language)
        said = talk.say("what_if.answer", request=asked[:1].lower() + asked[1:], answer=said)
    runs = [(talk.say("what_if.column"), run)]
    if talk.state.run is not None:
        runs.insert(0, (talk.say("compared.now"), talk.site.foreseen(talk.state.run)))
    reply = Reply(decided=said, run=run, tables=talk.beside(runs))
    return _left_open(talk, reply, None if share is not None else request)


def needed_power(talk: Talk, act: acts.AskPower) -> Reply:
    """The least power that the promised rates take; a what-if of the limit where nothing is promised."""
    request, enough_w = _supposed(talk, act), act.enough_w
    promises = "min_rate_bps" in request.constraints or request.objective == "min_power"
    within = None if enough_w is None else acts.Limit(kind="max_power_w", value=enough_w)
    limited = None if within is None else acts.Suppose(acts=(*act.acts, within))
    if not promises:
        return Reply(decided=talk.say("needs.nothing")) if limited is None else what_if(talk, limited)
    limits: dict[str, Constraint] = {k: v for k, v in request.constraints.items() if k not in _OTHER_AIMS}
    run = talk.site.plan(talk.intent, Request(objective="min_power", constraints=limits))
    power_w = run.decision.total_power_w if run.decision.is_usable else None
    if power_w is None:
        more = more_power(run.case)
        power_w = None if more is None or more.power_w > parts.BEYOND_W else more.power_w
    said = [*talk.notes(run), _taken(talk, run, power_w)]
    if enough_w is not None and limited is not None:
        enough = human(enough_w, "W")
        if power_w is not None and enough_w >= power_w:
            said.append(talk.say(f"needs.{act.judged}_enough", enough=enough, power=human(power_w, "W")))
            if request.objective != "min_power":  # what such a limit makes of an aim that it serves
                said.append(_beside(talk, what_if(talk, limited).run))
        else:
            key = "needs.not_enough" if enough_w < _least(run) or power_w is None else "needs.perhaps_enough"
            said.append(talk.say(key, enough=enough))
    return _left_open(talk, Reply(decided=talk.joined(*said), run=run), request)


def _left_open(talk: Talk, reply: Reply, supposed: Request | None) -> Reply:
    """The reply to a what-if: nothing changed, "do that" takes it up, and a yes is still for the plan that waits."""
    state, needs = talk.state, ""
    if state.planned is not None and state.request is not None:
        key = "plan.still_waits" if supposed is None else "plan.or_what_if"
        needs = talk.say(key, request=talk.plan(state.request))
    after = dataclasses.replace(state, question=None, supposed=supposed)
    return dataclasses.replace(reply, changed=talk.say("plan.nothing_changed"), needs=needs, state=after)


def _supposed(talk: Talk, act: acts.Suppose) -> Request:
    """The request of a what-if; one of the most that can be promised is kept with the probability that is assumed.

    Where nothing holds yet and no aim is named, promised rates are asked for with the least power, unless that is
    limited; anything else is asked for with the highest total rate.
    """
    held, wanted = talk.state.request, act.acts
    named = {*(() if held is None else held.constraints), *(one.kind for one in wanted if isinstance(one, acts.Limit))}
    if isinstance(act, acts.AskMost) and "outage_probability" not in named:
        wanted = *wanted, acts.Limit(kind="outage_probability", value=ASSUMED_OUTAGE_PROBABILITY)
    aims = [one for one in wanted if isinstance(one, acts.Aim)]
    if held is None:
        least = "min_rate_bps" in named and "max_power_w" not in named
        held = Request(objective="min_power" if least else "max_rate")
    return talk.needed(applied(held, (*aims, *wanted), radiated_w=talk.state.radiated_w)[0])


def _planned(talk: Talk, request: Request, sight: Sight | None) -> tuple[Run, str]:
    """The run of a what-if, by the objective's own method where the one named does not solve it, and that it is so."""
    try:
        return talk.tried(request, sight=sight), ""
    except RefusedError as refusal:
        if request.method is None:
            raise
        run = talk.tried(dataclasses.replace(request, method=None), sight=sight)
        method = called(talk.language, run.decision.method)
        return run, talk.joined(refusal.why, talk.say("refused.solved_by", method=method))


def _most(talk: Talk, run: Run, user: str | None) -> str:
    """The most that can be promised to everybody or to a user, with its certificate."""
    decision = run.decision
    who = talk.say("what_if.every_user", count=int(decision.served.sum()))
    if user is not None:
        who = called(talk.language, decision.user_names[user_number(user, decision.user_names, talk.language)[0]])
    said = talk.say(
        "what_if.most_promised", rate=human(decision.value, decision.unit), who=who,
        power=human(decision.problem.budget_w(decision.cell), "W"),
        sure=reliability(decision.problem.outage_probability or 0.0),
    )  # fmt: skip
    proven = talk.say("what_if.most_proven", bound=human(decision.bound, decision.unit))
    return talk.joined(said, "" if np.isnan(decision.gap) else proven, *talk.notes(run))


def _verdict(talk: Talk, run: Run, missing: float | None) -> str:
    """Whether a request can be met, where a share of the gains were missing, and with what, or what can be met instead;
    and what was assumed only here.
    """
    now, share = talk.state.run, percent(missing or 0.0)
    assumed = talk.notes(run, before=() if now is None else now.notes)
    if not run.decision.is_usable:
        unmet = "" if missing is None else talk.say("what_if.unseen", share=share)
        return talk.joined(*assumed, unmet, Remedies(run.case, talk.language).told(nearest(run.case)))
    key = "what_if.met" if missing is None else "what_if.still_met"
    met = talk.say(key, outcome=parts.outcome_in_words(run.decision, talk.language), share=share)
    return talk.joined(*assumed, met, _beside(talk, run, values=True), _unused(talk, run))


def _beside(talk: Talk, run: Run | None, *, values: bool = False) -> str:
    """What users get and what it takes, beside what holds now; by how much the ``values`` differ where they are of one
    kind.
    """
    now = talk.state.run
    if now is None or run is None or not (now.decision.is_usable and run.decision.is_usable):
        return ""
    kinds = {(parts.value_name(one.decision, talk.language), one.decision.unit) for one in (now, run)}
    if values and len(kinds) == 1:
        return talk.say("what_if.now", change=_difference(talk, now.decision, run.decision))
    figures = list[str]()
    for decision in (run.decision, now.decision):
        rates = decision.rate_bps.sum(), decision.rate_bps[decision.served].min()
        total, lowest = (human(float(rate), "bit/s") for rate in rates)
        power = human(decision.total_power_w, "W")
        figures.append(talk.say("what_if.beside_figures", total=total, lowest=lowest, power=power))
    return talk.say("what_if.beside_now", then=figures[0], now=figures[1])


def _difference(talk: Talk, now: Decision, then: Decision) -> str:
    """By how much the other value differs."""
    change, value = then.value - now.value, human(now.value, now.unit)
    if not now.value or value == human(then.value, then.unit):
        return talk.say("what_if.same")
    key, size = "what_if.more" if change > 0 else "what_if.less", human(abs(change), now.unit)
    return talk.say(key, size=size, share=percent(abs(change / now.value)))


def _unused(talk: Talk, run: Run) -> str:
    """That another budget changes nothing, where it is not what holds the value back."""
    now = talk.state.run
    if now is None or not now.decision.is_usable:
        return ""
    spent, before = run.decision.total_power_w, now.decision.total_power_w
    budgets = [one.decision.problem.budget_w(one.decision.cell) for one in (run, now)]
    same = abs(spent - before) <= _SAME * before and budgets[0] != budgets[1]
    if not same or max(spent, before) >= min(budgets) * (1 - _SAME):
        return ""
    return talk.say("what_if.budget_unused", budget=human(budgets[0], "W"), spent=human(spent, "W"))


def _least(run: Run) -> float:
    """The power that is proven to be needed; 0 where nothing is."""
    decision, need = run.decision, run.decision.needed_power_w
    known = decision.bound if decision.is_usable else None if need is None else need.at_least
    return known if known is not None and known == known else 0.0


def _taken(talk: Talk, run: Run, power_w: float | None) -> str:
    """The power that the promised rates take."""
    if power_w is None:
        return talk.say("needs.too_much", reason=parts.reason_in_words(run.decision, talk.language))
    power, least, limit_w = human(power_w, "W"), human(_least(run), "W"), run.decision.cell.max_power_w
    said = talk.say("needs.exactly" if power == least else "needs.takes", power=power, least=least)
    return talk.joined(said, talk.say("needs.beyond_limit", limit=human(limit_w, "W")) if power_w > limit_w else "")


def with_last(talk: Talk, _: acts.CompareLast) -> Reply:
    """The decision that holds beside the last other one."""
    run = talk.needed(talk.state.run)
    turns = [turn for turn in reversed(talk.turns) if turn.intent.kind == "allocate"]
    made = [(turn.number, turn.run) for turn in turns if turn.run is not None]
    own = next((number for number, one in made if one.is_of(run)), len(talk.turns))
    last = next(((number, one) for number, one in made if not one.is_of(run)), None)
    if last is None:
        return Reply(decided=talk.say("compared.nothing"))
    columns = [(talk.say("turn.column", number=number), one) for number, one in ((own, run), last)]
    said = talk.say("compared.last", turn=last[0], line=certificate_line(last[1].decision, talk.language))
    return Reply(decided=said, tables=talk.beside(columns))


def with_turns(talk: Talk, act: acts.CompareTurns) -> Reply:
    """The decision that holds beside that of a turn, or those of two turns."""
    found = [decided_by(talk, reference) for reference in act.turns]
    columns: list[Column] = [(talk.say("turn.column", number=number), run) for number, run in found]
    if len(columns) == 1:
        now = talk.needed(talk.state.run)
        if same_allocation(columns[0][1].decision, now.decision):
            return Reply(decided=talk.say("compared.itself", turn=columns[0][0]))
        columns.insert(0, (talk.say("compared.now"), now))
    turn, run = columns[-1]
    said = talk.say("compared.turn", turn=turn, line=certificate_line(run.decision, talk.language))
    return Reply(decided=said, tables=talk.beside(columns))


def with_requests(talk: Talk, act: acts.CompareRequests) -> Reply:
    """Changes of the request solved beside each other; one alone stands beside the request that holds."""
    now, request = talk.needed(talk.state.run), talk.needed(talk.state.request)
    changed = [(_label(change, talk.language), applied(request, change)[0]) for change in act.changes]
    columns = [(name, talk.tried(one)) for name, one in changed if one is not None]
    if len(columns) < 2:
        columns.insert(0, (talk.say("compared.now"), talk.site.foreseen(now)))
    assumed = [note for _, one in columns for note in talk.notes(one, before=now.notes)]
    said = talk.joined(*dict.fromkeys(assumed), *_outcomes(talk, columns))
    return Reply(decided=said, changed=talk.say("plan.nothing_changed"), tables=talk.beside(columns))


def with_tools(talk: Talk, act: acts.CompareTools) -> Reply:
    """The decision that holds beside those of other methods, or on what other repairers make of the channel."""
    site, run, request = talk.site, talk.needed(talk.state.run), talk.needed(talk.state.request)
    columns, refusals = [(run.decision.method, site.foreseen(run))], list[str]()
    for name in act.names:
        if name == run.decision.method and len(act.names) > 1:
            continue  # it has its column already
        if name in plugins.names("method"):
            tools, sight = site.with_method(name), None
        elif name in plugins.names("repairer"):
            tools = dataclasses.replace(site.tools_of(request), repairer=name, repairer_options={})
            sight = site.sight(talk.language, tools=tools)
        else:
            known = {f"{kind}s": ", ".join(plugins.names(kind)) for kind in ("method", "repairer")}
            return asked_back(talk.say("ask_back.not_installed", name=name, **known))
        try:
            columns.append((name, talk.tried(request, sight=sight, tools=tools)))
        except RefusedError as refusal:
            refusals.append(refusal.why)
    some = len(columns) > 1
    by = talk.say("compared.by", names=listed(talk.language, act.names))
    said = lines_of([talk.joined(by, *(_outcomes(talk, columns) if some else [])), *refusals])
    return Reply(decided=said, tables=talk.beside(columns) if some else ())


def _outcomes(talk: Talk, columns: Sequence[Column]) -> list[str]:
    """What each of the runs comes to, one sentence each."""
    met = any(run.decision.is_usable for _, run in columns)
    said = list[str]()
    for name, run in columns:
        because = talk.say("compared.because", reason=parts.reason_in_words(run.decision, talk.language))
        outcome = talk.say(f"status.{run.decision.status}") + because
        if run.decision.is_usable:
            outcome = parts.outcome_in_words(run.decision, talk.language)
        elif met and run.decision.status == "undecided":  # no news of a request that another one met
            outcome = talk.say("compared.found_none")
        said.append(talk.say("compared.outcome", name=called(talk.language, name), outcome=outcome))
    return said


def _label(change: Sequence[Act], language: str) -> str:
    """What a change is called at the head of a column: its aim, or its figures, as in "95 %"."""
    aims = [parts.goal_words(act.objective, language) for act in change if isinstance(act, acts.Aim)]
    figures = [figure_in_words(act.kind, act.value) for act in change if isinstance(act, acts.Limit)]
    return " ".join(dict.fromkeys([*aims, *figures]))


REPLIES: Replies = {
    acts.CompareLast: with_last,
    acts.CompareTurns: with_turns,
    acts.CompareRequests: with_requests,
    acts.CompareTools: with_tools,
    acts.Suppose: what_if,
    acts.AskMost: what_if,
    acts.AskPower: needed_power,
    acts.AskOtherChannel: lambda talk, _: asked_back(talk.say("ask_back.channel_given")),
}

"""Decisions beside each other: of turns, of other figures and aims, and of other methods and repairers."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from wirelessagent import plugins
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.dialogue import applied
from wirelessagent.agent.posing import RefusedError
from wirelessagent.agent.recalling import is_same, no_decision, turn_of
from wirelessagent.agent.restating import notes
from wirelessagent.agent.state import Replies, Reply, Talk, asked_back, nothing_yet
from wirelessagent.agent.turn import Run
from wirelessagent.language.acts import Act, Aim, CompareLast, CompareRequests, CompareTools, CompareTurns, Limit
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called, joined, lines_of, listed, message
from wirelessagent.telling.certificates import certificate_line
from wirelessagent.telling.parts import goal_words, name_of_figure, outcome_in_words
from wirelessagent.telling.reasons import power_in_words, reason_in_words
from wirelessagent.telling.told import Table

Column = tuple[str, Run]


def with_last(talk: Talk, _: CompareLast) -> Reply:
    """The decision that holds beside the last other one."""
    run, language = talk.state.run, talk.language
    if run is None:
        return nothing_yet(talk)
    made = [turn for turn in talk.turns if turn.run is not None and turn.intent.kind == "allocate"]
    own = next((turn.number for turn in reversed(made) if is_same(turn.run, run)), len(talk.turns))
    earlier = [turn for turn in made if not is_same(turn.run, run)]
    if not earlier:
        return Reply(decided=talk.say("compared.nothing"))
    last = earlier[-1]
    assert last.run is not None
    columns = [(talk.say("turn.column", number=number), one) for number, one in ((own, run), (last.number, last.run))]
    said = talk.say("compared.last", turn=last.number, line=certificate_line(last.run.decision, language))
    return Reply(decided=said, tables=(side_by_side(columns, language),))


def with_turns(talk: Talk, act: CompareTurns) -> Reply:
    """The decision that holds beside that of a turn, or those of two turns."""
    columns = list[Column]()
    for reference in act.turns:
        chosen = turn_of(talk.turns, reference)
        if chosen is None or chosen.run is None:
            return no_decision(talk, reference, chosen)
        columns.append((talk.say("turn.column", number=chosen.number), chosen.run))
    if len(columns) == 1:
        if talk.state.run is None:
            return nothing_yet(talk)
        if same_allocation(columns[0][1].decision, talk.state.run.decision):
            return Reply(decided=talk.say("compared.itself", turn=columns[0][0]))
        columns.insert(0, (talk.say("compared.now"), talk.state.run))
    turn, run = columns[-1]
    said = talk.say("compared.turn", turn=turn, line=certificate_line(run.decision, talk.language))
    return Reply(decided=said, tables=(side_by_side(columns, talk.language),))


def with_requests(talk: Talk, act: CompareRequests) -> Reply:
    """Changes of the request solved beside each other; one alone stands beside the request that holds."""
    site, state, language = talk.site, talk.state, talk.language
    if state.run is None or state.request is None:
        return nothing_yet(talk)
    changed = [(_label(change, language), applied(state.request, change)[0]) for change in act.changes]
    columns = [(name, site.foreseen(site.plan(talk.intent, one))) for name, one in changed if one is not None]
    if len(columns) == 1:
        columns.insert(0, (talk.say("compared.now"), site.foreseen(state.run)))
    assumed = [note for _, one in columns for note in notes(one, noted=state.noted, before=state.run.notes)]
    said = joined(language, [*dict.fromkeys(assumed), *_outcomes(columns, language)])
    return Reply(decided=said, changed=talk.say("plan.nothing_changed"), tables=(side_by_side(columns, language),))


def with_tools(talk: Talk, act: CompareTools) -> Reply:
    """The decision that holds beside those of other methods, or on what other repairers make of the channel."""
    site, run, request, language = talk.site, talk.state.run, talk.state.request, talk.language
    if run is None or request is None:
        return nothing_yet(talk)
    columns, refusals = [(run.decision.method, site.foreseen(run))], list[str]()
    for name in act.names:
        if name == run.decision.method and len(act.names) > 1:
            continue  # it has its column already
        if name in plugins.names("method"):
            tools, sight = site.with_tools(method=name), None
        elif name in plugins.names("repairer"):
            tools = dataclasses.replace(site.tools_of(request), repairer=name, repairer_options={})
            sight = site.sight_by(tools, language)
        else:
            known = {f"{kind}s": ", ".join(plugins.names(kind)) for kind in ("method", "repairer")}
            return asked_back(talk.say("ask_back.not_installed", name=name, **known))
        try:
            columns.append((name, site.foreseen(site.plan(talk.intent, request, sight=sight, tools=tools))))
        except RefusedError as refusal:
            refusals.append(refusal.why)
    told = _outcomes(columns, language) if len(columns) > 1 else []
    said = joined(language, [talk.say("compared.by", names=listed(language, act.names)), *told])
    tables = (side_by_side(columns, language),) if len(columns) > 1 else ()
    return Reply(decided=lines_of([said, *refusals]), tables=tables)


def _outcomes(columns: Sequence[Column], language: str) -> list[str]:
    """What each of the runs comes to, one sentence each."""
    met = any(run.decision.is_usable for _, run in columns)
    return [
        message(language, "compared.outcome", name=called(language, name), outcome=_outcome(run, language, met=met))
        for name, run in columns
    ]


def _outcome(run: Run, language: str, *, met: bool) -> str:
    """What a run comes to; that a method found nothing is no news of the request where another one met it."""
    if run.decision.is_usable:
        return outcome_in_words(run.decision, language)
    if met and run.decision.status == "undecided":
        return message(language, "compared.found_none")
    because = message(language, "compared.because", reason=reason_in_words(run.decision, language))
    return message(language, f"status.{run.decision.status}") + because


def _label(change: Sequence[Act], language: str) -> str:
    """What a change is called at the head of a column: its aim, or its figures, as in "95 %"."""
    aims = [goal_words(act.objective, language) for act in change if isinstance(act, Aim)]
    return " ".join(dict.fromkeys([*aims, *(_figure(act) for act in change if isinstance(act, Limit))]))


def _figure(limit: Limit) -> str:
    if limit.kind == "outage_probability":
        return reliability(limit.value)
    return human(limit.value, "bit/s" if limit.kind.endswith("bps") else "W")


def side_by_side(runs: Sequence[Column], language: str = "en") -> Table:
    """Runs beside each other: what each is worth, takes and keeps."""
    columns = [message(language, "label.figure"), *(called(language, name) for name, _ in runs)]
    cells = [_cells(run, language) for _, run in runs]
    known = [label for label in cells[0] if any(cell[label] != "–" for cell in cells)]
    rows = [(message(language, f"label.{label}"), *(cell[label] for cell in cells)) for label in known]
    return Table(title=message(language, "label.side_by_side"), columns=tuple(columns), rows=tuple(rows))


def _cells(run: Run, language: str) -> dict[str, str]:
    """The figures of one run by their labels; "–" for what there is not."""
    decision, objective = run.decision, run.decision.problem.objective
    assert not isinstance(objective, str)
    usable, need = decision.is_usable, decision.needed_power_w
    figure = name_of_figure(decision, language)
    served = decision.served
    value = human(decision.value, decision.unit)
    value = message(language, "label.with", value=value, beside=figure) if figure else value
    missed = "–" if run.outcome is None or run.outcome.achieved is None else str(int(run.outcome.missed.sum()))
    return {
        "objective": goal_words(objective.name, language),
        "status": message(language, f"status.{decision.status}"),
        "value": value if usable else "–",
        "bound": human(decision.bound, decision.unit),
        "gap": percent(decision.gap),
        "power": human(decision.total_power_w, "W") if usable else "–",
        "power_needed": "–" if need is None else power_in_words(need.at_least, language),
        "sum_rate_bps": human(float(decision.rate_bps.sum()), "bit/s") if usable else "–",
        "lowest_rate": human(float(decision.rate_bps[served].min()), "bit/s") if usable else "–",
        "users_served": str(int(np.count_nonzero(decision.rate_bps > 0))) if usable else "–",
        "promises_missed": missed,
    }


REPLIES: Replies = {
    CompareLast: with_last,
    CompareTurns: with_turns,
    CompareTools: with_tools,
    CompareRequests: with_requests,
}

"""Decisions beside each other: of turns, of other figures and aims, and of other methods and repairers."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from wirelessagent import plugins
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.dialogue import applied
from wirelessagent.agent.posing import RefusedError
from wirelessagent.agent.recalling import decided_by
from wirelessagent.agent.state import Replies, Reply, Talk, asked_back, nothing_yet
from wirelessagent.agent.turn import Run
from wirelessagent.language.acts import Act, Aim, CompareLast, CompareRequests, CompareTools, CompareTurns, Limit
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called, lines_of, listed, message
from wirelessagent.telling.certificates import certificate_line
from wirelessagent.telling.parts import goal_words, name_of_figure, outcome_in_words
from wirelessagent.telling.reasons import power_in_words, reason_in_words
from wirelessagent.telling.told import Table

Column = tuple[str, Run]


def with_last(talk: Talk, _: CompareLast) -> Reply:
    """The decision that holds beside the last other one."""
    run = talk.state.run
    if run is None:
        return nothing_yet(talk)
    turns = [turn for turn in reversed(talk.turns) if turn.intent.kind == "allocate"]
    made = [(turn.number, turn.run) for turn in turns if turn.run is not None]
    own = next((number for number, one in made if one.is_of(run)), len(talk.turns))
    last = next(((number, one) for number, one in made if not one.is_of(run)), None)
    if last is None:
        return Reply(decided=talk.say("compared.nothing"))
    columns = [(talk.say("turn.column", number=number), one) for number, one in ((own, run), last)]
    said = talk.say("compared.last", turn=last[0], line=certificate_line(last[1].decision, talk.language))
    return Reply(decided=said, tables=(side_by_side(columns, talk.language),))


def with_turns(talk: Talk, act: CompareTurns) -> Reply:
    """The decision that holds beside that of a turn, or those of two turns."""
    columns = list[Column]()
    for reference in act.turns:
        found = decided_by(talk, reference)
        if isinstance(found, Reply):
            return found
        columns.append((talk.say("turn.column", number=found[0]), found[1]))
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
    state = talk.state
    if state.run is None or state.request is None:
        return nothing_yet(talk)
    changed = [(_label(change, talk.language), applied(state.request, change)[0]) for change in act.changes]
    columns = [(name, talk.tried(one)) for name, one in changed if one is not None]
    if len(columns) == 1:
        columns.insert(0, (talk.say("compared.now"), talk.site.foreseen(state.run)))
    assumed = [note for _, one in columns for note in talk.notes(one, before=state.run.notes)]
    said = talk.joined(*dict.fromkeys(assumed), *_outcomes(talk, columns))
    tables = (side_by_side(columns, talk.language),)
    return Reply(decided=said, changed=talk.say("plan.nothing_changed"), tables=tables)


def with_tools(talk: Talk, act: CompareTools) -> Reply:
    """The decision that holds beside those of other methods, or on what other repairers make of the channel."""
    site, run, request = talk.site, talk.state.run, talk.state.request
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
    return Reply(decided=said, tables=(side_by_side(columns, talk.language),) if some else ())


def _outcomes(talk: Talk, columns: Sequence[Column]) -> list[str]:
    """What each of the runs comes to, one sentence each."""
    met = any(run.decision.is_usable for _, run in columns)
    outcomes = [(called(talk.language, name), _outcome(talk, run, met=met)) for name, run in columns]
    return [talk.say("compared.outcome", name=name, outcome=outcome) for name, outcome in outcomes]


def _outcome(talk: Talk, run: Run, *, met: bool) -> str:
    """What a run comes to; that a method found nothing is no news of the request where another one met it."""
    if run.decision.is_usable:
        return outcome_in_words(run.decision, talk.language)
    if met and run.decision.status == "undecided":
        return talk.say("compared.found_none")
    because = talk.say("compared.because", reason=reason_in_words(run.decision, talk.language))
    return talk.say(f"status.{run.decision.status}") + because


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
    decision, outcome, need = run.decision, run.outcome, run.decision.needed_power_w
    figure, value = name_of_figure(decision, language), human(decision.value, decision.unit)
    value = message(language, "label.with", value=value, beside=figure) if figure else value

    def met(cell: str) -> str:
        return cell if decision.is_usable else "–"

    return {
        "objective": goal_words(run.case.objective.name, language),
        "status": message(language, f"status.{decision.status}"),
        "value": met(value),
        "bound": human(decision.bound, decision.unit),
        "gap": percent(decision.gap),
        "power": met(human(decision.total_power_w, "W")),
        "power_needed": "–" if need is None else power_in_words(need.at_least, language),
        "sum_rate_bps": met(human(float(decision.rate_bps.sum()), "bit/s")),
        "lowest_rate": met(human(float(decision.rate_bps[decision.served].min()), "bit/s")),
        "users_served": met(str(int(np.count_nonzero(decision.rate_bps > 0)))),
        "promises_missed": "–" if outcome is None or outcome.achieved is None else str(int(outcome.missed.sum())),
    }


REPLIES: Replies = {
    CompareLast: with_last,
    CompareTurns: with_turns,
    CompareTools: with_tools,
    CompareRequests: with_requests,
}

"""Turns that refer to other turns by their number, and what-ifs, which the next line may refer to."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from wirelessagent.agent import asking, needing, supposing
from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.figures import side_by_side
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.agent.waiting import plan_named
from wirelessagent.language.intent import Detail, Intent
from wirelessagent.telling.catalogue import joined, message
from wirelessagent.telling.certificates import certificate_line


def what_if(site: Site, state: State, intent: Intent) -> Reply:
    """A what-if, which a "do that" may turn into the request, and which plan a yes is still for."""
    language, details = intent.language, intent.details
    ask = needing.needed if details.get("asked") == "power" else supposing.what_if
    reply = ask(site, state, intent)
    if reply.run is None:
        return reply
    text, request = reply.text, None if "missing_share" in details else supposing.supposed(state, intent)
    if state.planned is not None and state.request is not None:
        key = "plan.still_waits" if request is None else "plan.or_what_if"
        text = joined(language, [text, message(language, key, request=plan_named(state, language))])
    return dataclasses.replace(
        reply, text=text, state=dataclasses.replace(state, question=None, supposed=request)
    )  # fmt: skip


def compare(state: State, intent: Intent, turns: Sequence[Turn]) -> Reply:
    """The decision that holds beside that of a turn, or those of two turns."""
    language, columns = intent.language, list[tuple[str, Run]]()
    for key in ("turn", "beside"):
        if key not in intent.details:
            continue
        chosen = turn_of(turns, intent.details[key])
        if chosen is None or chosen.run is None:
            return _no_decision(intent.details[key], chosen, language, turns)
        columns.append((message(language, "turn.column", number=chosen.number), chosen.run))
    if len(columns) == 1:
        if state.run is None:
            return Reply(text=message(language, "refused.nothing_yet"))
        if same_allocation(columns[0][1].decision, state.run.decision):
            return Reply(text=message(language, "compared.itself", turn=columns[0][0]))
        columns.insert(0, (message(language, "compared.now"), state.run))
    turn, run = columns[-1]
    text = message(language, "compared.turn", turn=turn, line=certificate_line(run.decision, language))
    return Reply(text=text, tables=(side_by_side(columns, language),))


def explain(state: State, intent: Intent, turns: Sequence[Turn]) -> Reply:
    """The decision of a turn in words, with its tables."""
    chosen = turn_of(turns, intent.details["turn"])
    if chosen is None or chosen.run is None:
        return _no_decision(intent.details["turn"], chosen, intent.language, turns)
    return asking.explain(dataclasses.replace(state, run=chosen.run), intent)


def history(intent: Intent, turns: Sequence[Turn]) -> Reply:
    """What was said in a turn."""
    number = intent.details["turn"]
    chosen = turn_of(turns, number)
    if chosen is None:
        return Reply(text=no_such_turn(number, len(turns), intent.language), stage="asked")
    return asking.history(dataclasses.replace(intent, details={"number": float(chosen.number)}), turns)


def turn_of(turns: Sequence[Turn], number: Detail) -> Turn | None:
    """The turn of this number, or the "first" with a decision; None where there is none."""
    if number == "first":
        return next((turn for turn in turns if turn.run is not None and turn.intent.kind == "allocate"), None)
    return next((turn for turn in turns if turn.number == number), None)


def no_such_turn(number: Detail, count: int, language: str) -> str:
    """What to say to a line about a turn that there is not, in a conversation of so many turns."""
    name = f"{number:g}" if isinstance(number, float) else str(number)
    key = "turn.no_such" if count > 1 else "turn.only_one" if count else "turn.none_yet"
    return message(language, key, number=name, last=count)


def _no_decision(number: Detail, chosen: Turn | None, language: str, turns: Sequence[Turn]) -> Reply:
    if chosen is None:
        return Reply(text=no_such_turn(number, len(turns), language), stage="asked")
    return Reply(text=message(language, "turn.without_decision", number=chosen.number), stage="asked")

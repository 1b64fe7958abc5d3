"""Turns that change what is asked for or what is in effect: requests, apply, yes and no, undo, reset.

plan → confirm → apply → read back → compare with the promise → revert; see :mod:`wirelessagent.agent.acting`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.agent.acting import Effect, respects, same_allocation
from wirelessagent.agent.dialogue import Diff, Request, applied
from wirelessagent.agent.events import Event
from wirelessagent.agent.noting import notes
from wirelessagent.agent.referring import no_such_turn
from wirelessagent.agent.restating import restated
from wirelessagent.agent.run import applied_line, with_outcome
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.turn import Run, Stage
from wirelessagent.language.acts import Act, Drop, LeaveOut, Serve, acts_of
from wirelessagent.language.intent import Intent
from wirelessagent.language.restating import limits_in_words
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import joined, message
from wirelessagent.telling.certificates import certificate_line
from wirelessagent.telling.tables import decision_tables


def allocate(site: Site, state: State, intent: Intent) -> Reply:
    """Decide on a new or amended request and act on it, or ask before."""
    acts = acts_of(intent)
    request, diff = applied(state.request, acts, radiated_w=state.radiated_w)
    assert request is not None  # an intent that allocates names an aim
    run = site.plan(intent, request)
    new = State(request=request, run=run, on_air=state.on_air, last_good=state.last_good, stated=state.stated)
    turn = intent.details.get("turn")
    back = [] if turn is None else [message(intent.language, "request.back_to_turn", number=turn)]
    changed = _changed(state.request, diff, acts, intent)
    assumed = notes(run, noted=state.noted)
    said = joined(intent.language, [*back, restated(request, intent.language), *changed, *assumed, _sentence(run)])
    if not run.decision.is_usable:
        return _reply(site, intent, [said, message(intent.language, "plan.not_applied")], "nothing", new, run)
    if state.on_air is not None and same_allocation(run.decision, state.on_air.decision):
        kept = with_outcome(run, state.on_air.outcome)
        new = dataclasses.replace(new, run=kept, on_air=kept)
        return _reply(site, intent, [said, message(intent.language, "plan.no_change")], "nothing", new, kept)
    return _carry_or_ask(site, new, intent, run, said)


def _changed(before: Request | None, diff: Diff, acts: Sequence[Act], intent: Intent) -> list[str]:
    """What of the limits that held holds no longer though nobody named it, or what stays where an aim is named."""
    if before is None or not before.constraints:
        return []
    language = intent.language
    if diff.gone and not any(isinstance(act, Drop | Serve | LeaveOut) for act in acts):
        return [message(language, "request.no_longer", limits=limits_in_words(diff.gone, language))]
    if diff.objective[0] == diff.objective[1] and not intent.evidence.get("objective"):
        return []
    if not diff.changes:
        return [message(language, "request.limits_stay")]
    changed = {one.kind for one in diff.changes}
    kept = {name: value for name, value in before.constraints.items() if name not in changed}
    return [message(language, "request.as_before", limits=limits_in_words(kept, language))] if kept else []


def apply(site: Site, state: State, intent: Intent) -> Reply:
    """Apply what was decided and name it; the operator said so, which is the confirmation."""
    language, run = intent.language, state.planned or state.run
    if run is None:
        return Reply(text=message(language, "refused.nothing_yet"))
    if run is state.on_air:
        return Reply(text=message(language, "plan.already"), stage="nothing")
    if not run.decision.is_usable:
        return Reply(text=message(language, "plan.nothing_to_apply", why=certificate_line(run.decision, language)))
    station = site.station(run)
    if station is None:
        return Reply(text=message(language, "applied.no_station"), stage="nothing")
    request = [] if state.request is None else [restated(state.request, language)]
    return _apply(site, state, intent, run, station, joined(language, [*request, *notes(run, noted=True)]))


def confirm(site: Site, state: State, intent: Intent) -> Reply:
    """A yes: apply what waits for it."""
    if state.planned is None:
        if "way" in intent.details:
            return Reply(text=message(intent.language, "ask_back.which_way"), stage="asked")
        return Reply(text=message(intent.language, "plan.nothing_to_confirm"))
    return apply(site, state, intent)


def reject(state: State, intent: Intent, past: Sequence[State]) -> Reply:
    """A no: what waits is not applied; what is asked for stays, to be changed, unless the plan is cancelled."""
    language, cancels = intent.language, "cancel" in intent.details
    if state.question is not None:
        return Reply(text=message(language, "plan.question_dropped"), stage="nothing", state=state.settled)
    if state.planned is None:
        if "stop" in intent.details:
            return Reply(text=message(language, "plan.kept_as_it_is"), stage="nothing")
        if cancels:
            return Reply(text=message(language, "plan.nothing_to_cancel"), stage="asked")
        return Reply(text=message(language, "plan.nothing_to_confirm"))
    if not cancels:
        dropped = joined(language, [message(language, "plan.dropped"), message(language, "plan.not_applied")])
        return Reply(text=dropped, stage="nothing", state=state.settled)
    before = state.settled if state.undoes or not past else past[-1]
    held = dataclasses.replace(before, on_air=state.on_air, last_good=state.last_good)
    text = joined(language, [message(language, "plan.not_applied"), _asked_for_again(held, language)])
    return Reply(text=text, stage="nothing", state=held, undone=0 if held.request == state.request else 1)


def undo(site: Site, state: State, intent: Intent, past: Sequence[State], turns: int) -> Reply:
    """Back to what was asked for before and, where something else was in effect then, back to that too.

    ``past`` are the states that there were, the last one last; ``turns`` is how many turns there were.
    """
    language, steps = intent.language, intent.details.get("steps", 1.0)
    if "turn" in intent.details:
        return Reply(text=_no_way_back(intent, turns), stage="asked")
    if not past:
        return Reply(text=message(language, "undo.nothing_to_undo"), stage="nothing")
    count = min(int(steps), len(past)) if isinstance(steps, float) else len(past)
    before = past[-count]
    text = _asked_for_again(before, language, undone=True)
    if isinstance(steps, float) and steps > count:
        text = joined(language, [message(language, "undo.undone_fewer", count=count), text])
    return dataclasses.replace(_undone(site, state, intent, before, text), undone=count)


def _asked_for_again(before: State, language: str, *, undone: bool = False) -> str:
    """What the request is after something was taken back."""
    if before.request is None:
        return message(language, "undo.undone_all") if undone else message(language, "request.nothing_asked")
    request = restated(before.request, language)
    return (
        message(language, "undo.undone", request=request)
        if undone
        else message(language, "request.asked_for", request=request)
    )


def _no_way_back(intent: Intent, turns: int) -> str:
    """Why a turn cannot be gone back to: it is none, or nothing was asked for then."""
    turn = intent.details["turn"]
    if isinstance(turn, float) and turn in range(1, turns + 1):
        return message(intent.language, "turn.without_request", number=f"{turn:g}")
    return no_such_turn(turn, turns, intent.language)


def _undone(site: Site, state: State, intent: Intent, before: State, text: str) -> Reply:
    """Put back what was in effect for the request that holds again, or plan for it anew where it never was."""
    good, wanted = before.on_air, before.run
    held = dataclasses.replace(before, on_air=state.on_air, last_good=state.last_good)
    if wanted is not None and _never_applied(before) and site.station(wanted) is not None:
        if state.on_air is not None and same_allocation(wanted.decision, state.on_air.decision):
            return _reply(site, intent, [text], "undone", held, wanted)
        return _carry_or_ask(site, dataclasses.replace(held, undoes=True), intent, wanted, text)
    if good is None:
        said = [text] if state.on_air is None else [text, message(intent.language, "undo.stays")]
        return _reply(site, intent, said, "undone", held, before.run)
    station = site.station(good)
    if station is None or (state.on_air is not None and same_allocation(good.decision, state.on_air.decision)):
        return _reply(site, intent, [text], "undone", held, before.run)
    if wanted is not None and not respects(good.decision, wanted.decision):
        power = human(good.decision.total_power_w, "W")
        said = [text, message(intent.language, "undo.breaks_what_holds", power=power)]
        return _reply(site, intent, said, "undone", held, wanted)
    if site.asks(station):
        waiting = dataclasses.replace(held, planned=good, undoes=True)
        return _reply(site, intent, [text, _question(good, before)], "planned", waiting, good)
    return _put_back(site, before, intent, good, station, [text])


def _never_applied(state: State) -> bool:
    """Whether what was decided for the request of a state was still to be applied when another one came."""
    run = state.run
    if state.request is None or run is None or run.outcome is not None or not run.decision.is_usable:
        return False
    return state.on_air is None or state.on_air.decision is not run.decision


def reset(site: Site, state: State, intent: Intent) -> Reply:
    """Forget what is asked for; what is in effect stays."""
    del site
    new = State(on_air=state.on_air, last_good=state.last_good)
    return Reply(text=message(intent.language, "undo.reset"), stage="undone", state=new)


def _carry_or_ask(site: Site, state: State, intent: Intent, run: Run, said: str) -> Reply:
    station = site.station(run)
    if station is None:
        return _reply(site, intent, [said, message(intent.language, "applied.no_station")], "planned", state, run)
    if site.asks(station):
        waiting = dataclasses.replace(state, planned=run)
        return _reply(site, intent, [said, message(intent.language, "ask_back.apply_it")], "planned", waiting, run)
    return _apply(site, state, intent, run, station, said)


def _apply(site: Site, state: State, intent: Intent, run: Run, station: BaseStation, said: str = "") -> Reply:
    """Apply a run, or put one back that was in effect before."""
    if run.outcome is not None and run is state.planned:
        return _put_back(site, state, intent, run, station, [said] if said else [])
    effect = site.carry_out(run, station, state.last_good)
    new = dataclasses.replace(state, run=effect.run, planned=None, question=None)
    text = [said] if said else []
    if not effect.faults:
        new = dataclasses.replace(new, on_air=effect.run, last_good=effect.run)
        return _reply(
            site, intent, [*text, _whole(intent.language, applied_line(effect.run))], "applied", new, effect.run
        )
    text.append(_told(effect, state.last_good, intent.language))
    if effect.restored is not None and not effect.trouble:
        new = dataclasses.replace(new, on_air=state.last_good)
        return _reply(site, intent, text, "reverted", new, effect.run, effect)
    in_effect = effect.run if effect.as_decided else None
    new = dataclasses.replace(new, on_air=in_effect)
    return _reply(site, intent, text, "nothing" if effect.run.outcome is None else "applied", new, effect.run, effect)


def _put_back(site: Site, state: State, intent: Intent, good: Run, station: BaseStation, text: Sequence[str]) -> Reply:
    """Apply again what was in effect before, for an undo."""
    outcome, trouble = site.put_back(good, station)
    told = (
        message(intent.language, "undo.not_put_back", why=trouble)
        if trouble
        else _in_effect(intent.language, "undo.put_back", good)
    )
    back = good if outcome is None else with_outcome(good, outcome)
    run = back if state.run is good else state.run
    new = dataclasses.replace(state, run=run, planned=None, question=None, on_air=None if trouble else back)
    new = dataclasses.replace(new, last_good=state.last_good if trouble else back)
    reply = _reply(site, intent, [*text, told], "undone", new, back)
    return dataclasses.replace(reply, restored=outcome)


def _told(effect: Effect, last_good: Run | None, language: str) -> str:
    faults = joined(language, effect.faults)
    if effect.restored is not None and not effect.trouble and last_good is not None:
        taken_back = _in_effect(language, "station.reverted", last_good, faults=faults)
        return joined(language, [taken_back, message(language, "station.asked_but_taken_back")])
    if last_good is None:
        return message(language, "station.faulty", faults=faults)
    return message(language, "station.not_reverted", faults=faults, trouble=effect.trouble)


def _in_effect(language: str, key: str, run: Run, **names: str) -> str:
    """A sentence about an allocation that is in effect again."""
    power = human(run.decision.total_power_w, "W")
    promised = run.decision.rate_bps if run.outcome is None else run.outcome.promised_bps
    return message(language, key, power=power, rate=human(float(promised.sum()), "bit/s"), **names)


def _question(good: Run, state: State) -> str:
    """Whether to put an earlier allocation back."""
    language = good.intent.language
    request = "–" if state.request is None else restated(state.request, language)
    return message(language, "ask_back.put_it_back", power=human(good.decision.total_power_w, "W"), request=request)


def _sentence(run: Run) -> str:
    return _whole(run.intent.language, certificate_line(run.decision, run.intent.language))


def _whole(language: str, line: str) -> str:
    """A line as a sentence of its own."""
    return message(language, "text.sentence", line=_capital(line))


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]


def _reply(
    site: Site,
    intent: Intent,
    said: Sequence[str],
    stage: Stage,
    state: State,
    run: Run | None,
    effect: Effect | None = None,
) -> Reply:
    """What is said of a run, with its tables; the last sentence is what was done about it."""
    site.progress(Event(stage="act", message=said[-1]))
    tables = [] if run is None else decision_tables(run.report, run.estimate, intent.language)
    return Reply(
        text=joined(intent.language, said),
        stage=stage,
        state=state,
        run=run,
        tables=tuple(tables),
        restored=None if effect is None else effect.restored,
    )

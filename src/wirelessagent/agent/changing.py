"""Turns that change what is asked for or what is in effect: requests, apply, yes and no, undo, reset.

plan → confirm → apply → read back → compare with the promise → revert; see :mod:`wirelessagent.agent.acting`.

The plan that waits for a yes is named before it is applied, and only a plain yes applies it. Whatever a recogniser
makes of a line, the line itself has to be an assent (:mod:`wirelessagent.language.conversation.answers`), and it has to
follow a reply that names the plan.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from wirelessagent.acting.base_station import BaseStation
from wirelessagent.agent.acting import applied_line, respects, same_allocation
from wirelessagent.agent.asking import no_such_turn
from wirelessagent.agent.posing import check_promised
from wirelessagent.agent.state import InsteadError, Replies, Reply, State, Talk, asked_back
from wirelessagent.agent.turn import Run, changes_in_words, restated, shift_between
from wirelessagent.language.acts import Act, Apply, Export, Forget, No, Undo, Yes
from wirelessagent.language.conversation.answers import assent, is_assent, speaks_of_applying
from wirelessagent.language.recogniser import Question
from wirelessagent.language.request import applied
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import Said, capital
from wirelessagent.telling.explanation import certificate_line
from wirelessagent.telling.parts import without_anything

_YES = ("apply", "confirm")


def allocate(talk: Talk, acts: tuple[Act, ...]) -> Reply:
    """Decide on a new or amended request and act on it, or ask before."""
    state, language = talk.state, talk.language
    request, diff = applied(state.request, acts, radiated_w=state.radiated_w)
    assert request is not None  # an intent that allocates names an aim
    check_promised(request, diff, talk.site.user_names, language)
    run = talk.site.plan(talk.intent, request)
    new = State(request=request, run=run, on_air=state.on_air, last_good=state.last_good)
    same = _same_on_air(state, run)
    shift = None if same or state.run is None else shift_between(state.run.decision, run.decision)
    turn = talk.intent.details.get("turn")
    back = "" if turn is None else talk.say("request.back_to_turn", number=turn)
    line, idle = _whole(talk, certificate_line(run.decision, language)), without_anything(run.decision, language)
    changed = changes_in_words(diff, language)
    if shift is not None and diff.objective[0] is not None:
        changed = talk.joined(changed, shift.in_words(language))
    reply = Reply(
        decided=talk.joined(back, restated(request, language), line, idle, *talk.notes(run)),
        changed=changed, state=new, run=run,
    )  # fmt: skip
    if not run.decision.is_usable:
        needs = talk.joined(talk.say("ask_back.unmet"), talk.say("ask_back.or_undo") if state.request else "")
        return _changing(talk, reply, talk.say("plan.not_applied"), stage="nothing", needs=needs)
    if same is not None:
        kept = run.with_outcome(same.outcome)
        now = dataclasses.replace(new, run=kept, on_air=kept)
        return _changing(talk, reply, talk.say("plan.no_change"), stage="nothing", run=kept, state=now)
    return _carry_or_ask(talk, reply, new, run)


def _same_on_air(state: State, run: Run) -> Run | None:
    """What is in effect, where a run would set just that."""
    on_air = state.on_air
    return on_air if on_air is not None and same_allocation(run.decision, on_air.decision) else None


def _changing(talk: Talk, reply: Reply, said: str, **fields: Any) -> Reply:
    """A reply that tells one more thing that changed, or did not."""
    return dataclasses.replace(reply, changed=talk.joined(reply.changed, said), **fields)


def apply(talk: Talk, _: Apply | Yes) -> Reply:
    """Apply what was decided and name it, where the line says so and nothing else, which is the confirmation."""
    _check_assent(talk)
    state, run = talk.state, talk.needed(talk.state.planned or talk.state.run)
    if run is state.on_air:
        return Reply(decided=talk.say("plan.already"), stage="nothing")
    if not run.decision.is_usable:
        why = certificate_line(run.decision, talk.language)
        return Reply(decided=talk.say("plan.nothing_to_apply", why=why))
    station = talk.site.station(run)
    if station is None:
        return Reply(decided=talk.say("applied.no_station"), stage="nothing")
    request = "" if state.request is None else restated(state.request, talk.language)
    reply = Reply(decided=talk.joined(request, *talk.notes(run, noted=True)), run=run)
    return _apply(talk, reply, state, run, station)


def confirm(talk: Talk, act: Yes) -> Reply:
    """A yes: apply what waits for it."""
    if talk.state.planned is not None:
        return apply(talk, act)
    if act.chooses or act.choice is not None:
        return asked_back(talk.say("ask_back.which_way"))
    return Reply(decided=talk.say("plan.nothing_to_confirm"))


def reject(talk: Talk, act: No) -> Reply:
    """A no: what waits is not applied; what is asked for stays, to be changed, unless the plan is cancelled."""
    state = talk.state
    if state.question is not None:
        return Reply(changed=talk.say("plan.question_dropped"), stage="nothing", state=state.settled)
    if state.planned is None:
        if act.stops:
            return Reply(changed=talk.say("plan.kept_as_it_is"), stage="nothing")
        if act.cancels:
            return asked_back(talk.say("plan.nothing_to_cancel"))
        return Reply(decided=talk.say("plan.nothing_to_confirm"))
    dropped = talk.joined(talk.say("plan.dropped"), talk.say("plan.not_applied"))
    if not act.cancels:
        return Reply(changed=dropped, stage="nothing", state=state.settled)
    before = state.settled if state.undoes or not talk.past else talk.past[-1]
    held = dataclasses.replace(before, on_air=state.on_air, last_good=state.last_good)
    undone = 0 if held.request == state.request else 1
    asked = talk.say("request.nothing_asked")
    if held.request is not None:
        asked = talk.say("request.asked_for", request=talk.plan(held.request))
    return Reply(decided=asked, changed=dropped, stage="nothing", state=held, undone=undone)


def undo(talk: Talk, act: Undo) -> Reply:
    """Back to what was asked for before and, where something else was in effect then, back to that too."""
    past = talk.past
    if act.turn in range(1, len(talk.turns) + 1):
        return asked_back(talk.say("turn.without_request", number=act.turn))
    if act.turn is not None:
        return asked_back(no_such_turn(talk, act.turn))
    if not past:
        return Reply(decided=talk.say("undo.nothing_to_undo"), stage="nothing")
    count = len(past) if act.steps is None else min(act.steps, len(past))
    before = past[-count]
    text = talk.say("undo.undone_all")
    if before.request is not None:
        text = talk.say("undo.undone", request=talk.plan(before.request))
    if act.steps is not None and act.steps > count:
        text = talk.joined(talk.say("undo.undone_fewer", count=count), text)
    held = dataclasses.replace(before, on_air=talk.state.on_air, last_good=talk.state.last_good)
    return _undone(talk, before, Reply(decided=text, stage="undone", state=held, run=before.run, undone=count), held)


def _undone(talk: Talk, before: State, reply: Reply, held: State) -> Reply:
    """Put back what was in effect for the request that holds again, or plan for it anew where it never was."""
    site, state, good, wanted = talk.site, talk.state, before.on_air, before.run
    if wanted is not None and _never_applied(before) and site.station(wanted) is not None:
        if _same_on_air(state, wanted) is not None:
            return reply
        return _carry_or_ask(talk, reply, dataclasses.replace(held, undoes=True), wanted)
    if good is None:
        return reply if state.on_air is None else _changing(talk, reply, talk.say("undo.stays"))
    station, power = site.station(good), human(good.decision.total_power_w, "W")
    if station is None or _same_on_air(state, good) is not None:
        return reply
    if wanted is not None and not respects(good.decision, wanted.decision):
        return _changing(talk, reply, talk.say("undo.breaks_what_holds", power=power))
    if site.asks(station):
        waiting = dataclasses.replace(held, planned=good, undoes=True)
        needs = talk.say("ask_back.put_it_back", power=power, request=talk.plan(before.request))
        return dataclasses.replace(reply, needs=needs, stage="planned", state=waiting, run=good)
    return _put_back(talk, reply, before, good, station)


def _never_applied(state: State) -> bool:
    """Whether what was decided for the request of a state was still to be applied when another one came."""
    run = state.run
    if state.request is None or run is None or run.outcome is not None or not run.decision.is_usable:
        return False
    return state.on_air is None or not state.on_air.is_of(run)


def reset(talk: Talk, _: Forget) -> Reply:
    """Forget what is asked for; what is in effect stays."""
    new = State(on_air=talk.state.on_air, last_good=talk.state.last_good)
    return Reply(changed=talk.say("undo.reset"), stage="undone", state=new)


def _carry_or_ask(talk: Talk, reply: Reply, state: State, run: Run) -> Reply:
    """Apply a run where nobody has to be asked, from the state that holds now."""
    station = talk.site.station(run)
    if station is None:
        return _changing(talk, reply, _whole(talk, talk.say("applied.no_station")), stage="planned", state=state)
    if talk.site.asks(station):
        waiting = dataclasses.replace(state, planned=run)
        return dataclasses.replace(reply, needs=talk.say("ask_back.apply_it"), stage="planned", state=waiting, run=run)
    return _apply(talk, reply, state, run, station)


def _apply(talk: Talk, reply: Reply, state: State, run: Run, station: BaseStation) -> Reply:
    """Apply a run, or put one back that was in effect before."""
    if run.outcome is not None and run is state.planned:
        return _put_back(talk, reply, state, run, station)
    talk.site.tell("act", talk.say("stage.applying", station=station.name), talk.language)
    effect = talk.site.carry_out(run, station, state.last_good)
    new = dataclasses.replace(state, run=effect.run, planned=None, question=None)
    reply = dataclasses.replace(reply, run=effect.run, restored=effect.restored)
    if not effect.faults:
        new = dataclasses.replace(new, on_air=effect.run, last_good=effect.run)
        return _changing(talk, reply, _whole(talk, applied_line(effect.run)), stage="applied", state=new)
    faults, good = talk.joined(*effect.faults), state.last_good
    if good is not None and effect.restored is not None and not effect.trouble:
        taken_back = _in_effect(talk, "station.reverted", good, faults=faults)
        said = talk.joined(taken_back, talk.say("station.asked_but_taken_back"))
        return _changing(talk, reply, said, stage="reverted", state=dataclasses.replace(new, on_air=good))
    said = talk.say("station.faulty", faults=faults)
    if good is not None:
        said = talk.say("station.not_reverted", faults=faults, trouble=effect.trouble)
    new = dataclasses.replace(new, on_air=effect.run if effect.as_decided else None)
    stage = "nothing" if effect.run.outcome is None else "applied"
    return _changing(talk, reply, said, stage=stage, state=new, faulty=True)


def _put_back(talk: Talk, reply: Reply, state: State, good: Run, station: BaseStation) -> Reply:
    """Apply again what was in effect before, for an undo."""
    talk.site.tell("act", talk.say("stage.applying", station=station.name), talk.language)
    back, restored, trouble = talk.site.put_back(good, station)
    told = talk.say("undo.not_put_back", why=trouble) if trouble else _in_effect(talk, "undo.put_back", good)
    new = dataclasses.replace(
        state, run=back if state.run is good else state.run, planned=None, question=None,
        on_air=None if trouble else back, last_good=state.last_good if trouble else back,
    )  # fmt: skip
    return _changing(talk, reply, told, stage="undone", state=new, run=back, restored=restored)


def _in_effect(talk: Talk, key: str, run: Run, **places: str) -> Said:
    """A sentence about an allocation that is in effect again."""
    power, rate = human(run.decision.total_power_w, "W"), human(float(run.promised_bps.sum()), "bit/s")
    return talk.say(key, power=power, rate=rate, **places)


def _whole(talk: Talk, line: str) -> Said:
    """A line as a sentence of its own."""
    return talk.say("text.sentence", line=capital(line))


def _check_assent(talk: Talk) -> None:
    """Doubt a line that was taken for a yes or for a command to apply and is none."""
    if talk.pressed:
        return
    later, waits = assent(talk.text) == "later", talk.state.planned is not None
    if later and waits:
        needs = talk.say("plan.left_waiting", request=talk.plan(talk.state.request))
        raise InsteadError(Reply(needs=needs, stage="nothing", state=dataclasses.replace(talk.state, question=None)))
    if later or not is_assent(talk.text) or (waits and not _follows(talk)):
        raise InsteadError(asked_again(talk))


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
    state, run = talk.state, talk.needed(talk.state.planned or talk.state.run)
    request = talk.plan(talk.needed(state.request))
    if run is state.on_air:
        return Reply(decided=talk.say("plan.already"), stage="nothing")
    fresh = run.outcome is None and run.decision.is_usable and talk.site.station(run) is not None
    if state.planned is None and not fresh:
        return Reply(decided=talk.say("plan.nothing_to_confirm"))
    waiting = dataclasses.replace(state, planned=run, question=None)
    return asked_back(talk.say("ask_back.shall_i_apply", request=request), waiting)


REPLIES: Replies = {Apply: apply, Yes: confirm, No: reject, Undo: undo, Forget: reset}

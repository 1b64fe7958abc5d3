"""What was said and done so far: turns, decisions beside each other, what is in effect, reasons, and the export."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from wirelessagent.agent.acting import same_allocation
from wirelessagent.agent.state import Column, InsteadError, Replies, Reply, Talk, asked_back
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.language import acts
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import Said, lines_of
from wirelessagent.telling.explanation import certificate_line, explain
from wirelessagent.telling.told import Table

_SHOWN = 60
"""Characters of a sentence that the history shows."""


def no_such_turn(talk: Talk, reference: acts.TurnReference) -> Said:
    """What to say to a line about a turn that there is not."""
    count = len(talk.turns)
    key = "turn.no_such" if count > 1 else "turn.only_one" if count else "turn.none_yet"
    return talk.say(key, number=reference, last=count)


def found_turn(talk: Talk, reference: acts.TurnReference) -> Turn:
    """The turn of this number, or the "first" with a decision; where there is none, that is replied instead."""
    fits = [turn for turn in talk.turns if turn.number == reference]
    if reference == "first":
        fits = [turn for turn in talk.turns if turn.run is not None and turn.intent.kind == "allocate"]
    if not fits:
        raise InsteadError(asked_back(no_such_turn(talk, reference)))
    return fits[0]


def decided_by(talk: Talk, reference: acts.TurnReference) -> tuple[int, Run]:
    """The number of a turn and its run; where it has none, that is replied instead."""
    chosen = found_turn(talk, reference)
    if chosen.run is None:
        raise InsteadError(asked_back(talk.say("turn.without_decision", number=chosen.number)))
    return chosen.number, chosen.run


def reasons(talk: Talk, act: acts.AskReasons) -> Reply:
    """A decision in words, with its tables."""
    run = talk.needed(talk.state.run) if act.turn is None else decided_by(talk, act.turn)[1]
    said = explain(run.estimate, run.report, language=talk.language)
    return Reply(decided=lines_of(said), tables=run.tables(talk.language))


def history(talk: Talk, act: acts.AskHistory) -> Reply:
    """The turns so far, or one of them."""
    turns = talk.turns
    if act.turn is not None:
        chosen = found_turn(talk, act.turn)
        said = talk.say("turn.said", number=chosen.number, text=_short(chosen.text), reply=chosen.reply)
        return Reply(decided=said, tables=chosen.tables)
    if not turns:
        return Reply(decided=talk.say("turn.none"))
    rows = tuple(
        (str(turn.number), _short(turn.text), talk.say(f"came_to.{turn.stage}"), _value(turn)) for turn in turns
    )
    columns = tuple(talk.say(f"label.{label}") for label in ("turn", "said", "came_to", "value"))
    table = Table(title=talk.say("turn.title"), columns=columns, rows=rows)
    return Reply(decided=talk.say("turn.so_far", count=len(turns)), tables=(table,))


def _short(text: str) -> str:
    plain = " ".join(text.split())
    return plain if len(plain) <= _SHOWN else f"{plain[: _SHOWN - 1]}…"


def _value(turn: Turn) -> str:
    """What a decision is worth; nothing of one that was only asked about."""
    if turn.run is None or turn.stage in ("answered", "asked"):
        return "–"
    return human(turn.run.decision.value, turn.run.decision.unit)


def status(talk: Talk, _: acts.AskStatus) -> Reply:
    """What is asked for, what was decided, and what is in effect."""
    state, unknown = talk.state, talk.state.on_air is None and talk.site.touched
    if state.request is None and state.on_air is None and not unknown:
        return Reply(decided=talk.say("in_effect.none"))
    said: list[str] = []
    if state.request is not None:
        said.append(talk.say("request.asked_for", request=talk.plan(state.request)))
    if state.run is not None:
        line = certificate_line(state.run.decision, talk.language)
        said.append(talk.say("in_effect.decided", certificate=line))
    said.append(_unknown(talk) if unknown else _on_air(talk))
    return Reply(decided=lines_of(said), needs=talk.say("in_effect.waits") if state.planned is not None else "")


def _unknown(talk: Talk) -> str:
    """That it is not known what is in effect, and what was read back last."""
    last, read = talk.site.read_last, talk.say("in_effect.read_nothing")
    if last is not None:
        used, power = int((last.power_w > 0).sum()), human(float(last.power_w.sum()), "W")
        read = talk.say("in_effect.read", power=power, used=used, total=last.power_w.size)
    return talk.say("in_effect.unknown", read=read)


def _on_air(talk: Talk) -> str:
    run = talk.state.on_air
    if run is None:
        return talk.say("in_effect.off_air")
    number = next((turn.number for turn in reversed(talk.turns) if turn.run is run), len(talk.turns))
    served, rate = int((run.promised_bps > 0).sum()), human(float(run.promised_bps.sum()), "bit/s")
    key, power = "in_effect.on_air_one" if served == 1 else "in_effect.on_air", human(run.decision.total_power_w, "W")
    return talk.say(key, turn=number, served=served, power=power, rate=rate)


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


def export(talk: Talk, act: acts.Export) -> Reply:
    """The request that holds and what came of it as a document of a standard; the standards are loaded only here."""
    from wirelessagent.standards import tmf921, ts28312
    from wirelessagent.standards.subject import Subject

    run, turns = talk.state.run, talk.turns
    if act.format not in ("ts28312", "tmf921"):
        return asked_back(talk.say("ask_back.export_unknown", format=act.format))
    done = [turn for turn in turns if turn.stage not in ("answered", "asked")]
    made = [turn for turn in done if run is not None and turn.run is not None and turn.run.is_of(run)]
    run = talk.needed(run if made else None)
    last, on_air = made[-1], talk.state.on_air
    subject = Subject(
        name=f"{last.session}-{last.number}", text=made[0].text, decision=run.decision,
        at=datetime.fromisoformat(last.at_utc), language=run.intent.language,
        outcome=on_air.outcome if on_air is not None and on_air.is_of(run) else None,
        current=_in_effect_before(last, turns), taken_back=last.stage == "reverted",
    )  # fmt: skip
    if act.format == "ts28312":
        return Reply(decided=ts28312.to_json(ts28312.document(subject)))
    return Reply(decided=tmf921.to_json(tmf921.document(subject)))


def _in_effect_before(turn: Turn, turns: Sequence[Turn]) -> Outcome | None:
    """What was last read back before a turn; None where there was nothing."""
    found: Outcome | None = None
    for earlier in turns[: turn.number - 1]:
        if earlier.restored is not None:
            found = earlier.restored
        elif earlier.stage == "applied" and earlier.run is not None:
            found = earlier.run.outcome
    return found


REPLIES: Replies = {
    acts.AskReasons: reasons,
    acts.AskHistory: history,
    acts.AskStatus: status,
    acts.CompareLast: with_last,
    acts.CompareTurns: with_turns,
    acts.Export: export,
}

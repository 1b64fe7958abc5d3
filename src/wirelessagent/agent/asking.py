"""Turns that change nothing: compare, status, history, help, and questions about the decision."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import cast

from wirelessagent.agent import answers, comparing
from wirelessagent.agent.figures import side_by_side
from wirelessagent.agent.premises import corrected
from wirelessagent.agent.refusing import able
from wirelessagent.agent.restating import restated
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply, State
from wirelessagent.agent.supposing import what_if
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.language.intent import Constraint, Intent
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.certificates import certificate_line
from wirelessagent.telling.tables import decision_tables
from wirelessagent.telling.text_table import Table

_SHOWN = 60
"""Characters of a sentence that the history shows."""


def compare(site: Site, state: State, intent: Intent, turns: Sequence[Turn]) -> Reply:
    """The decision that holds beside the last other one, or beside what other methods and repairers make of it."""
    language = intent.language
    if state.run is None or state.request is None:
        return Reply(text=message(language, "refused.nothing_yet"))
    others = comparing.alternatives(state.request, intent)
    if others:
        return comparing.beside(site, state.run, intent, others, noted=state.noted)
    named = [str(intent.details[key]) for key in ("with", "methods", "repairers") if key in intent.details]
    names = [name for name in re.split(r"[,，、;\s]+", " ".join(named)) if name and name != "last"]
    if names:
        return comparing.with_tools(site, state.run, state.request, intent, names)
    return _with_last(state.run, language, turns)


def _with_last(run: Run, language: str, turns: Sequence[Turn]) -> Reply:
    made = [turn for turn in turns if turn.run is not None and turn.intent.kind == "allocate"]
    own = next((turn.number for turn in reversed(made) if _same(turn.run, run)), len(turns))
    earlier = [turn for turn in made if not _same(turn.run, run)]
    if not earlier:
        return Reply(text=message(language, "compared.nothing"))
    last = earlier[-1]
    assert last.run is not None
    columns = [
        (message(language, "turn.column", number=number), one) for number, one in ((own, run), (last.number, last.run))
    ]
    text = message(language, "compared.last", turn=last.number, line=certificate_line(last.run.decision, language))
    return Reply(text=text, tables=(side_by_side(columns, language),))


def _same(one: Run | None, other: Run) -> bool:
    """Whether two runs are of one decision, applied or not."""
    return one is not None and one.decision is other.decision


def status(site: Site, state: State, intent: Intent, turns: Sequence[Turn]) -> Reply:
    """What is asked for, what was decided, and what is in effect."""
    language = intent.language
    if state.request is None and state.on_air is None and not site.touched:
        return Reply(text=message(language, "in_effect.none"))
    said: list[str] = []
    if state.request is not None:
        said.append(message(language, "request.asked_for", request=restated(state.request, language)))
    if state.run is not None:
        said.append(message(language, "in_effect.decided", certificate=certificate_line(state.run.decision, language)))
    unknown = state.on_air is None and site.touched
    said.append(_unknown(site.read_last, language) if unknown else _on_air(state.on_air, language, turns))
    if state.planned is not None:
        said.append(message(language, "in_effect.waits"))
    return Reply(text="\n".join(said))


def _unknown(read: Outcome | None, language: str) -> str:
    """That it is not known what is in effect, and what was read back last."""
    if read is None:
        return message(language, "in_effect.unknown", read=message(language, "in_effect.read_nothing"))
    used, total = int((read.power_w > 0).sum()), read.power_w.size
    power = human(float(read.power_w.sum()), "W")
    return message(
        language, "in_effect.unknown", read=message(language, "in_effect.read", power=power, used=used, total=total)
    )


def _on_air(run: Run | None, language: str, turns: Sequence[Turn]) -> str:
    if run is None:
        return message(language, "in_effect.off_air")
    number = next((turn.number for turn in reversed(turns) if turn.run is run), len(turns))
    promised = run.decision.rate_bps if run.outcome is None else run.outcome.promised_bps
    served = int((promised > 0).sum())
    return message(
        language, "in_effect.on_air_one" if served == 1 else "in_effect.on_air", turn=number, served=served,
        power=human(run.decision.total_power_w, "W"), rate=human(float(promised.sum()), "bit/s"),
    )  # fmt: skip


def history(intent: Intent, turns: Sequence[Turn]) -> Reply:
    """The turns so far, or one of them."""
    language, number = intent.language, intent.details.get("number")
    if not turns:
        return Reply(text=message(language, "turn.none"))
    if number is None:
        rows = tuple(
            (str(turn.number), _short(turn.text), message(language, f"came_to.{turn.stage}"), _value(turn.run))
            for turn in turns
        )
        columns = tuple(message(language, f"label.{label}") for label in ("turn", "said", "came_to", "value"))
        table = Table(title=message(language, "turn.title"), columns=columns, rows=rows)
        return Reply(text=message(language, "turn.so_far", count=len(turns)), tables=(table,))
    chosen = next((turn for turn in turns if turn.number == number), None)
    if chosen is None:
        asked = f"{cast(float, number):g}"
        return Reply(text=message(language, "turn.no_such", number=asked, last=len(turns)), stage="asked")
    text = message(language, "turn.said", number=chosen.number, text=_short(chosen.text), reply=chosen.reply)
    return Reply(text=text, tables=chosen.tables)


def _short(text: str) -> str:
    plain = " ".join(text.split())
    return plain if len(plain) <= _SHOWN else f"{plain[: _SHOWN - 1]}…"


def _value(run: Run | None) -> str:
    return "–" if run is None else human(run.decision.value, run.decision.unit)


def explain(state: State, intent: Intent) -> Reply:
    """The decision that holds in words, with its tables."""
    run = state.run
    if run is None:
        return Reply(text=message(intent.language, "refused.nothing_yet"))
    text = answers.explanation(run, intent.language)
    return Reply(text=text, tables=tuple(decision_tables(run.report, run.estimate, intent.language)))


def export(state: State, intent: Intent, turns: Sequence[Turn]) -> Reply:
    """The request that holds and what came of it as a document of a standard; the standards are loaded only here."""
    from wirelessagent.standards import tmf921, ts28312
    from wirelessagent.standards.subject import Subject

    language, name, run = intent.language, str(intent.details.get("format", "ts28312")), state.run
    if name not in ("ts28312", "tmf921"):
        return Reply(text=message(language, "ask_back.export_unknown", format=name), stage="asked")
    done = [turn for turn in turns if turn.stage not in ("answered", "asked")]
    made = [turn for turn in done if run is not None and _same(turn.run, run)]
    if run is None or not made:
        return Reply(text=message(language, "refused.nothing_yet"))
    last, on_air = made[-1], state.on_air
    subject = Subject(
        name=f"{last.session}-{last.number}",
        text=made[0].text,
        decision=run.decision,
        at=datetime.fromisoformat(last.at_utc),
        outcome=on_air.outcome if on_air is not None and _same(on_air, run) else None,
        language=run.intent.language,
        current=_in_effect_before(last, turns),
        taken_back=last.stage == "reverted",
    )
    if name == "ts28312":
        return Reply(text=ts28312.to_json(ts28312.document(subject)))
    return Reply(text=tmf921.to_json(tmf921.document(subject)))


def _in_effect_before(turn: Turn, turns: Sequence[Turn]) -> Outcome | None:
    """What was last read back before a turn; None where there was nothing."""
    found: Outcome | None = None
    for earlier in turns[: turn.number - 1]:
        if earlier.restored is not None:
            found = earlier.restored
        elif earlier.stage == "applied" and earlier.run is not None:
            found = earlier.run.outcome
    return found


def question(site: Site, state: State, intent: Intent, text: str) -> Reply:
    """A question about a term, or about the decision that holds; one that states figures is solved for them."""
    language, stated = intent.language, _wondered(intent)
    if intent.topic == "concept":
        return Reply(text=answers.concept(text, language) or message(language, "about.help"))
    if stated:
        return what_if(site, state, dataclasses.replace(intent, details={"constraints": stated}))
    if state.run is None:
        return Reply(text=message(language, "refused.nothing_yet"))
    run, spoken_of = _spoken_of(state.run, state.on_air, intent)
    if intent.details.get("listed") == "methods":
        decision = state.run.decision
        used = message(language, "about.method_in_use", method=called(language, decision.method))
        return Reply(text=joined(language, [used, able(decision.problem, language)]))
    said, tables = answers.answer(run, intent, site.user_names)
    said = joined(language, [one for one in (corrected(run, intent, text), said) if one])
    return Reply(text=message(language, spoken_of, answer=said) if spoken_of else said, tables=tables)


def _spoken_of(run: Run, on_air: Run | None, intent: Intent) -> tuple[Run, str]:
    """The run that a question is about, and the words for it: what is in effect, where the last request can't be met.

    Why it can't, and what it would take, is asked about the request.
    """
    if run.decision.is_usable or on_air is None or not on_air.decision.is_usable:
        return run, ""
    of_it = intent.topic in ("why_infeasible", "step", "what_if") or intent.details.get("listed") == "dearest"
    return (run, "") if of_it else (on_air, "about.in_effect")


def _wondered(intent: Intent) -> dict[str, Constraint]:
    """The limits that a question asks about, as in "can user 4 get 3 Mbit/s?"; empty where it names none."""
    details = intent.details
    stated = dict(cast("Mapping[str, Constraint]", details.get("constraints") or {}))
    rate, user = details.get("rate_bps"), details.get("user")
    if intent.topic != "step" and isinstance(rate, float):
        stated["min_rate_bps"] = {user: rate} if isinstance(user, str) else rate
    return stated

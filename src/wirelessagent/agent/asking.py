"""Questions about a decision, each answered by what is computed for it; and what was said and done so far.

Of the latter are the turns, what is in effect, the reasons of a decision, and the export.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np

from wirelessagent.agent.posing import UnknownUserError, able, user_number
from wirelessagent.agent.state import InsteadError, Replies, Reply, Talk, asked_back
from wirelessagent.agent.turn import Run, Turn, unmet
from wirelessagent.language import acts
from wirelessagent.language.acts import Act, Ask
from wirelessagent.language.text import normalise
from wirelessagent.language.topics import ranked
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import Said, Table, called, lines_of
from wirelessagent.telling.explanation import Proofs, certificate_line, explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import FewerUsers, MorePower, Nearest, Way, WithoutLimit, nearest
from wirelessagent.telling.glossary import explained, figures_asked, speaks_of
from wirelessagent.telling.margins import Prices, Remedies, Steps
from wirelessagent.telling.parts import Teller
from wirelessagent.telling.report import Report, served_table, user_table
from wirelessagent.telling.roster import Accounts, Roster

Answer = str | tuple[str, tuple[Table, ...]]

_SAME = 1e-3
_SHOWN = 60
"""Characters of a sentence that the history shows."""


@dataclass(frozen=True, kw_only=True)
class Asked(Teller):
    """A question about a decision.

    Attributes:
        report: of the decision.
        text: what was asked.
    """

    report: Report
    text: str = ""

    @functools.cached_property
    def instead(self) -> Nearest:
        """What can be met instead of what was asked for."""
        return nearest(self.case)

    def user(self, reference: str) -> int:
        """The number of a user.

        Raises:
            UnknownUserError: nobody can be meant; the message asks back.
        """
        return user_number(reference, self.case.estimate.user_names, self.language)[0]

    def someone(self, reference: str | None) -> int | None:
        """The number of a user, where one is named."""
        return None if reference is None else self.user(reference)

    def served(self) -> tuple[Table, ...]:
        """What the users get who are served."""
        return (served_table(self.report, self.language),)

    def everybody(self) -> Table:
        """What each user gets, and how sure that is."""
        return user_table(self.report, self.case.estimate, self.language)


def answered(asked: Asked, act: Ask) -> tuple[str, tuple[Table, ...]]:
    """The answer to a question about a decision, and its tables.

    Raises:
        UnknownUserError: it is about a user who is not there, or names none where it has to; the message asks back.
    """
    if _is_unmet(asked, act):
        return asked.by(Remedies).told(asked.instead), ()
    answer = _ANSWERS[type(act)](asked, act)
    return (answer, ()) if isinstance(answer, str) else answer


def meaning(talk: Talk, _: acts.AskMeaning) -> Reply:
    """The figures that a line names, and what its terms mean where it does not ask for those of now."""
    run = talk.state.run
    figures = figures_asked(talk.text, run.report, talk.language) if run is not None else ""
    meant = "" if figures and speaks_of("term.now", talk.text) else explained(talk.text, talk.language)
    return Reply(decided=lines_of((figures, meant)) or talk.say("about.help"))


def methods(talk: Talk, _: acts.AskMethods) -> Reply:
    """Which method decided, and which could."""
    decision = talk.needed(talk.state.run).decision
    used = talk.say("about.method_in_use", method=called(talk.language, decision.method))
    return Reply(decided=talk.joined(used, able(decision.problem, talk.language)))


def about_the_decision(talk: Talk, act: Ask) -> Reply:
    """A question about the decision that holds, or about what could not be met right before."""
    on_air = talk.state.on_air
    of_the_unmet = isinstance(act, acts.AskWhyNot) or (isinstance(act, acts.AskWhy) and on_air is None)
    run = talk.needed((unmet(talk.turns) if of_the_unmet else None) or talk.state.run)
    # the request may be one that can't be met, and what is in effect is another one
    of_it = isinstance(act, acts.AskWhyNot | acts.AskStep | acts.AskDearest) or run.decision.is_usable
    other = not of_it and on_air is not None and on_air.decision.is_usable
    run = on_air if other and on_air is not None else run
    asked = Asked(case=run.case, report=run.report, language=talk.language, text=talk.text)
    text, tables = answered(asked, act)
    state = None
    if run is talk.state.run and _is_unmet(asked, act):
        offers = tuple(_offer(run.case, way) for way in asked.instead.ways)
        state = dataclasses.replace(talk.state, question=None, offers=offers)
    return Reply(decided=talk.say("about.in_effect", answer=text) if other else text, tables=tables, state=state)


def _offer(case: Case, way: Way) -> tuple[Act, ...]:
    """What asks for a way that can be met."""
    if isinstance(way, MorePower):
        return (acts.Limit(kind="max_power_w", value=way.power_w),)
    if isinstance(way, WithoutLimit):
        return (acts.Drop(kind=way.limit),)
    if isinstance(way, FewerUsers):
        return (acts.LeaveOut(whom=acts.Named(case.named(way.left_out))),)
    promised = case.promised_bps[case.served]
    if np.ptp(promised) > 0:
        return (acts.Scale(kind="min_rate_bps", factor=way.factor),)
    return (acts.Limit(kind="min_rate_bps", value=float(promised[0]) * way.factor),)


def _is_unmet(asked: Asked, act: Ask) -> bool:
    """Whether nothing was decided that a question could be answered of, so that what can be met instead is told."""
    anyway = isinstance(act, acts.AskWhy | acts.AskGain | acts.AskDuration)
    of_a_step = isinstance(act, acts.AskStep) and act.users is None
    return not (anyway or of_a_step or asked.case.decision.is_usable)


def _why(asked: Asked, act: acts.AskWhy) -> Answer:
    if act.user is None:
        raise UnknownUserError("", asked.case.estimate.user_names, asked.language)
    user = asked.user(act.user)
    return asked.joined(_corrected(asked, user), asked.by(Accounts).told(user))


def _corrected(asked: Asked, user: int) -> str:
    """What is not so in a question why a user gets the least, the most or nothing; empty where it is so."""
    decision, rates, name = asked.case.decision, asked.case.decision.rate_bps, asked.name(user)
    if not decision.is_usable:
        return ""
    if rates[user] > 0 and speaks_of("term.nothing", asked.text):
        return asked.say("about.not_nothing", user=name)
    rank = str(ranked(normalise(asked.text)).get("rank", ""))
    served = rates[decision.served]
    if not rank or not served.size:
        return ""
    edge = np.min(served) if rank == "least" else np.max(served)
    alone = np.ptp(served) > _SAME * np.max(served)
    if alone and abs(rates[user] - edge) <= _SAME * edge:
        return ""
    return asked.say(f"about.not_{rank}", user=name, who=asked.by(Roster).rank(rank, "rate"))


def _step(asked: Asked, act: acts.AskStep) -> Answer:
    """What more power (1 W if nothing is named), more rate or one more user would change; less below zero."""
    if act.users is not None:
        return asked.by(Accounts).newcomer()
    steps, user = asked.by(Steps), asked.someone(act.user)
    if act.rate_share is not None or (act.rate_bps is not None and user is None and not act.each):
        return steps.more_in_all(act.rate_bps, act.rate_share)
    if act.rate_bps is not None:
        return steps.more_rate(act.rate_bps, user)
    return steps.more_power(1.0 if act.power_w is None else act.power_w)


def _prices(asked: Asked, act: acts.AskPrices) -> Answer:
    if act.user is not None:
        return _users(asked, acts.AskUsers(user=act.user))
    prices = asked.by(Prices)
    return prices.told(), prices.table()


def _users(asked: Asked, act: acts.AskUsers) -> Answer:
    if act.user is None:
        return asked.by(Roster).overview(), asked.served()
    user, table = asked.user(act.user), asked.everybody()
    return asked.by(Accounts).share(user), (dataclasses.replace(table, rows=(table.rows[user],)),)


def _result(asked: Asked, _: acts.AskResult) -> Answer:
    """The figures that are named, else the decision in words."""
    figures = figures_asked(asked.text, asked.report, asked.language)
    return figures or lines_of(explain(asked.case.estimate, asked.report, language=asked.language))


def _dearest(asked: Asked, _: acts.AskDearest) -> Answer:
    """Who takes the most power for a rate, which says whom to leave out if anybody."""
    decision, power_w = asked.case.decision, asked.case.spent_w
    rated = np.flatnonzero(decision.rate_bps > 0)
    if not rated.size:
        return asked.by(Remedies).none_needed()
    user = int(rated[np.argmax(power_w[rated] / decision.rate_bps[rated])])
    rate, power = human(float(decision.rate_bps[user]), "bit/s"), human(float(power_w[user]), "W")
    return asked.say("about.dearest", user=decision.user_names[user], rate=rate, power=power)


def _subcarriers(asked: Asked, act: acts.AskSubcarriers) -> Answer:
    told = asked.by(Roster).subcarriers(asked.someone(act.user))
    return told, () if act.user is not None else asked.served()


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
    rows = list[tuple[str, ...]]()
    for turn in turns:
        made = turn.run.decision if turn.run is not None and turn.stage not in ("answered", "asked") else None
        value = "–" if made is None else human(made.value, made.unit)
        rows.append((str(turn.number), _short(turn.text), talk.say(f"came_to.{turn.stage}"), value))
    columns = tuple(talk.say(f"label.{label}") for label in ("turn", "said", "came_to", "value"))
    table = Table(title=talk.say("turn.title"), columns=columns, rows=tuple(rows))
    return Reply(decided=talk.say("turn.so_far", count=len(turns)), tables=(table,))


def _short(text: str) -> str:
    plain = " ".join(text.split())
    return plain if len(plain) <= _SHOWN else f"{plain[: _SHOWN - 1]}…"


def status(talk: Talk, _: acts.AskStatus) -> Reply:
    """What is asked for, what was decided, and what is in effect."""
    state = talk.state
    if state.request is None and state.on_air is None and not talk.site.touched:
        return Reply(decided=talk.say("in_effect.none"))
    said: list[str] = []
    if state.request is not None:
        said.append(talk.say("request.asked_for", request=talk.plan(state.request)))
    if state.run is not None:
        line = certificate_line(state.run.decision, talk.language)
        said.append(talk.say("in_effect.decided", certificate=line))
    said.append(_in_effect(talk))
    return Reply(decided=lines_of(said), needs=talk.say("in_effect.waits") if state.planned is not None else "")


def _in_effect(talk: Talk) -> str:
    """What is in effect or, where that is not known, what was read back last."""
    run, last = talk.state.on_air, talk.site.read_last
    if run is None and not talk.site.touched:
        return talk.say("in_effect.off_air")
    if run is None:
        read = talk.say("in_effect.read_nothing")
        if last is not None:
            used, power = int((last.power_w > 0).sum()), human(float(last.power_w.sum()), "W")
            read = talk.say("in_effect.read", power=power, used=used, total=last.power_w.size)
        return talk.say("in_effect.unknown", read=read)
    number = next((turn.number for turn in reversed(talk.turns) if turn.run is run), len(talk.turns))
    served, rate = int((run.promised_bps > 0).sum()), human(float(run.promised_bps.sum()), "bit/s")
    key, power = "in_effect.on_air_one" if served == 1 else "in_effect.on_air", human(run.decision.total_power_w, "W")
    return talk.say(key, turn=number, served=served, power=power, rate=rate)


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
    read_before: Outcome | None = None
    for earlier in turns[: last.number - 1]:
        if earlier.restored is not None:
            read_before = earlier.restored
        elif earlier.stage == "applied" and earlier.run is not None:
            read_before = earlier.run.outcome
    subject = Subject(
        name=f"{last.session}-{last.number}", text=made[0].text, decision=run.decision,
        at=datetime.fromisoformat(last.at_utc), language=run.intent.language,
        outcome=on_air.outcome if on_air is not None and on_air.is_of(run) else None,
        current=read_before, taken_back=last.stage == "reverted",
    )  # fmt: skip
    if act.format == "ts28312":
        return Reply(decided=ts28312.to_json(ts28312.document(subject)))
    return Reply(decided=tmf921.to_json(tmf921.document(subject)))


_ANSWERS: Mapping[type[Ask], Callable[[Asked, Any], Answer]] = {
    acts.AskWhy: _why,
    acts.AskWhyNot: lambda asked, _: asked.by(Remedies).none_needed(),
    acts.AskStep: _step,
    acts.AskProof: lambda asked, _: asked.by(Proofs).proof(),
    acts.AskCertainty: lambda asked, _: (asked.by(Proofs).certainty(), (asked.everybody(),)),
    acts.AskPrices: _prices,
    acts.AskUsers: _users,
    acts.AskRank: lambda asked, act: (asked.by(Roster).rank(act.rank, act.of), asked.served()),
    acts.AskSubcarriers: _subcarriers,
    acts.AskOwner: lambda asked, act: asked.by(Roster).owner(act.subcarrier),
    acts.AskGain: lambda asked, act: asked.by(Roster).gain(asked.someone(act.user), act.subcarrier),
    acts.AskDearest: _dearest,
    acts.AskResult: _result,
    acts.AskLimits: lambda asked, _: asked.by(Prices).limits(),
    acts.AskDuration: lambda asked, _: asked.say("about.no_duration", method=asked.case.decision.method),
}
REPLIES: Replies = {
    acts.AskHelp: lambda talk, _: Reply(decided=talk.say("about.help")),
    acts.AskMeaning: meaning,
    acts.AskMethods: methods,
    acts.AskReasons: reasons,
    acts.AskHistory: history,
    acts.AskStatus: status,
    acts.Export: export,
    **dict.fromkeys(_ANSWERS, about_the_decision),
}

"""Questions about a decision, each answered by what is computed for it."""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent.agent.posing import UnknownUserError, able, user_number
from wirelessagent.agent.state import Replies, Reply, Talk, nothing_yet
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.language.acts import (
    Act,
    Ask,
    AskCertainty,
    AskDearest,
    AskDuration,
    AskGain,
    AskHelp,
    AskLimits,
    AskMeaning,
    AskMethods,
    AskOwner,
    AskPrices,
    AskProof,
    AskRank,
    AskResult,
    AskStep,
    AskSubcarriers,
    AskUsers,
    AskWhy,
    AskWhyNot,
    Drop,
    LeaveOut,
    Limit,
    Named,
    Scale,
)
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called, joined, lines_of, message
from wirelessagent.telling.certificates import certificate_answer, uncertainty_answer
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.facts.accounts import account, newcomer
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.marginal_prices import marginal_prices
from wirelessagent.telling.facts.nearest import FewerUsers, MorePower, Nearest, Way, WithoutLimit, nearest
from wirelessagent.telling.glossary import explained, figures_asked, is_of_now
from wirelessagent.telling.prices import limits_answer, prices_answer, prices_table
from wirelessagent.telling.reasons import feasible_answer, nearest_answer
from wirelessagent.telling.report import Report
from wirelessagent.telling.roster import gain_answer, owner_answer, rank_answer, subcarriers_answer
from wirelessagent.telling.step_effects import more_answer
from wirelessagent.telling.tables import served_table, user_table
from wirelessagent.telling.text_table import Table
from wirelessagent.telling.user_account import newcomer_answer, share_answer, user_answer

Answer = str | tuple[str, tuple[Table, ...]]

_RANKS = (
    ("least", re.compile(r"(?i)\b(?:least|lowest|slowest|worst)\b|最少|最慢|最低|最差")),
    ("most", re.compile(r"(?i)\b(?:the\s+most|highest|fastest|best)\b|最多|最快|最高|最好")),
)
_NOTHING = re.compile(
    r"(?i)\b(?:nothing|no\s+(?:rate|service|subcarriers?|power)|not\s+(?:be(?:ing)?\s+)?served|cut\s+off|zero)\b|"
    r"没有?(?:分到|得到|拿到)?(?:速率|服务|任何|东西)|什么[都也]没|没被?服务|一点[都也]没|为零|断"
)
_SAME = 1e-3


@dataclass(frozen=True, kw_only=True)
class Asked:
    """A question about a decision.

    Attributes:
        case: the decision, with what it was made from.
        report: of the decision.
        language: the operator's.
        text: what was asked.
    """

    case: Case
    report: Report
    language: str
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

    def everybody(self) -> tuple[Table, ...]:
        """What each user gets, and how sure that is."""
        return (user_table(self.report, self.case.estimate, self.language),)

    def explained(self) -> list[str]:
        """The decision in words."""
        return explain(self.case.estimate, self.report, language=self.language)


def answered(asked: Asked, act: Ask) -> tuple[str, tuple[Table, ...]]:
    """The answer to a question about a decision, and its tables.

    Raises:
        UnknownUserError: it is about a user who is not there, or names none where it has to; the message asks back.
    """
    if _is_unmet(asked, act):
        return nearest_answer(asked.case, asked.instead, asked.language), ()
    answer = _ANSWERS[type(act)](asked, act)
    return (answer, ()) if isinstance(answer, str) else answer


def help_with(talk: Talk, _: AskHelp) -> Reply:
    """What can be said."""
    return Reply(decided=talk.say("about.help"))


def meaning(talk: Talk, _: AskMeaning) -> Reply:
    """What the terms in a line mean; their figures, where it asks for those of now."""
    run = talk.state.run
    figures = figures_asked(talk.text, run.report, talk.language) if run is not None and is_of_now(talk.text) else ""
    return Reply(decided=figures or explained(talk.text, talk.language) or talk.say("about.help"))


def methods(talk: Talk, _: AskMethods) -> Reply:
    """Which method decided, and which could."""
    if talk.state.run is None:
        return nothing_yet(talk)
    decision = talk.state.run.decision
    used = talk.say("about.method_in_use", method=called(talk.language, decision.method))
    return Reply(decided=joined(talk.language, [used, able(decision.problem, talk.language)]))


def about_the_decision(talk: Talk, act: Ask) -> Reply:
    """A question about the decision that holds, or about what could not be met right before."""
    run, on_air = talk.state.run, talk.state.on_air
    if isinstance(act, AskWhyNot) or (isinstance(act, AskWhy) and on_air is None):
        run = unmet(talk.turns) or run
    if run is None:
        return nothing_yet(talk)
    of_it = isinstance(act, AskWhyNot | AskStep | AskDearest)  # of the request, which may be one that can't be met
    in_effect = on_air if not (of_it or run.decision.is_usable) and on_air is not None else run
    other = in_effect is not run and in_effect.decision.is_usable
    run = in_effect if other else run
    asked = Asked(case=run.case, report=run.report, language=talk.language, text=talk.text)
    text, tables = answered(asked, act)
    state = None
    if run is talk.state.run and _is_unmet(asked, act):
        state = dataclasses.replace(talk.state, question=None, offers=offers_of(run.case, asked.instead))
    return Reply(decided=talk.say("about.in_effect", answer=text) if other else text, tables=tables, state=state)


def offers_of(case: Case, found: Nearest) -> tuple[tuple[Act, ...], ...]:
    """What asks for each of the ways that can be met, in the order in which they are told."""
    return tuple(_offer(case, way) for way in found.ways)


def _offer(case: Case, way: Way) -> tuple[Act, ...]:
    if isinstance(way, MorePower):
        return (Limit(kind="max_power_w", value=way.power_w),)
    if isinstance(way, WithoutLimit):
        return (Drop(kind=way.limit),)
    if isinstance(way, FewerUsers):
        return (LeaveOut(whom=Named(case.named(way.left_out))),)
    promised = case.promised_bps[case.served]
    if np.ptp(promised) > 0:
        return (Scale(kind="min_rate_bps", factor=way.factor),)
    return (Limit(kind="min_rate_bps", value=float(promised[0]) * way.factor),)


def unmet(turns: Sequence[Turn]) -> Run | None:
    """What the line before asked for or supposed, where that can't be met; questions why lie between."""
    asked = (turn for turn in reversed(turns) if not any(isinstance(act, AskWhyNot | AskWhy) for act in turn.acts))
    last = next(asked, None)
    run = None if last is None else last.run
    return None if run is None or run.decision.is_usable else run


def _is_unmet(asked: Asked, act: Ask) -> bool:
    """Whether nothing was decided that a question could be answered of, so that what can be met instead is told."""
    anyway = isinstance(act, AskWhy | AskGain | AskDuration) or (isinstance(act, AskStep) and act.users is None)
    return not (anyway or asked.case.decision.is_usable)


def _why(asked: Asked, act: AskWhy) -> Answer:
    if act.user is None:
        raise UnknownUserError("", asked.case.estimate.user_names, asked.language)
    user = asked.user(act.user)
    told = user_answer(asked.case, account(asked.case, user), asked.language)
    return joined(asked.language, [_corrected(asked, user), told])


def _corrected(asked: Asked, user: int) -> str:
    """What is not so in a question why a user gets the least, the most or nothing; empty where it is so."""
    decision, language, text = asked.case.decision, asked.language, asked.text
    if not decision.is_usable:
        return ""
    rates, name = decision.rate_bps, called(language, decision.user_names[user])
    if rates[user] > 0 and _NOTHING.search(text):
        return message(asked.language, "about.not_nothing", user=name)
    rank = next((rank for rank, words in _RANKS if words.search(text)), "")
    served = rates[decision.served]
    if not rank or not served.size:
        return ""
    edge = np.min(served) if rank == "least" else np.max(served)
    alone = np.ptp(served) > _SAME * np.max(served)
    if alone and abs(rates[user] - edge) <= _SAME * edge:
        return ""
    return message(asked.language, f"about.not_{rank}", user=name, who=rank_answer(asked.case, rank, "rate", language))


def _step(asked: Asked, act: AskStep) -> Answer:
    case, language = asked.case, asked.language
    if act.users is not None:
        return newcomer_answer(case, newcomer(case), language)
    return more_answer(
        case, language, power_w=act.power_w, rate_bps=act.rate_bps, rate_share=act.rate_share, each=act.each,
        user=asked.someone(act.user),
    )  # fmt: skip


def _prices(asked: Asked, act: AskPrices) -> Answer:
    case, language = asked.case, asked.language
    if act.user is not None:
        return _users(asked, AskUsers(user=act.user))
    prices = marginal_prices(case)
    table = prices_table(case, prices, language)
    return prices_answer(case, prices, language), () if table is None else (table,)


def _users(asked: Asked, act: AskUsers) -> Answer:
    case, language = asked.case, asked.language
    if act.user is not None:
        user = asked.user(act.user)
        (row,) = asked.everybody()
        return share_answer(case, user, language), (dataclasses.replace(row, rows=(row.rows[user],)),)
    return asked.explained()[0], asked.served()


def _dearest(asked: Asked, _: AskDearest) -> Answer:
    """Who takes the most power for a rate, which says whom to leave out if anybody."""
    decision, case = asked.case.decision, asked.case
    power_w = case.spent_w
    rated = np.flatnonzero(decision.rate_bps > 0)
    if not rated.size:
        return feasible_answer(case, asked.language)
    user = int(rated[np.argmax(power_w[rated] / decision.rate_bps[rated])])
    rate, power = human(float(decision.rate_bps[user]), "bit/s"), human(float(power_w[user]), "W")
    return message(asked.language, "about.dearest", user=decision.user_names[user], rate=rate, power=power)


_ANSWERS: Mapping[type[Ask], Callable[[Asked, Any], Answer]] = {
    AskWhy: _why,
    AskWhyNot: lambda asked, _: feasible_answer(asked.case, asked.language),
    AskStep: _step,
    AskProof: lambda asked, _: certificate_answer(asked.case, asked.language),
    AskCertainty: lambda asked, _: (uncertainty_answer(asked.case, asked.language), asked.everybody()),
    AskPrices: _prices,
    AskUsers: _users,
    AskRank: lambda asked, act: (rank_answer(asked.case, act.rank, act.of, asked.language), asked.served()),
    AskSubcarriers: lambda asked, act: (
        subcarriers_answer(asked.case, asked.someone(act.user), asked.language),
        () if act.user is not None else asked.served(),
    ),
    AskOwner: lambda asked, act: owner_answer(asked.case, act.subcarrier, asked.language),
    AskGain: lambda asked, act: gain_answer(asked.case, asked.someone(act.user), act.subcarrier, asked.language),
    AskDearest: _dearest,
    AskResult: lambda asked, _: figures_asked(asked.text, asked.report, asked.language) or lines_of(asked.explained()),
    AskLimits: lambda asked, _: limits_answer(asked.case, asked.language),
    AskDuration: lambda asked, _: message(asked.language, "about.no_duration", method=asked.case.decision.method),
}
REPLIES: Replies = {
    AskHelp: help_with,
    AskMeaning: meaning,
    AskMethods: methods,
    **dict.fromkeys(_ANSWERS, about_the_decision),
}

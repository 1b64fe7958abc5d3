"""Why nothing was found that meets a request, the limit that is the cause; and the nearest requests that can be met."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import Said, called, lines_of, message
from wirelessagent.telling.facts import nearest
from wirelessagent.telling.facts.nearest import Nearest
from wirelessagent.telling.parts import Teller, outcome_in_words

BEYOND_W = 1e6
"""Powers beyond this are not told in figures: no cell radiates them."""
_ROUNDING = 1e-9


def power_in_words(power_w: float, language: str) -> str:
    """A power that rates need; where no cell has it, that instead of its figure."""
    if np.isinf(power_w):
        return message(language, "reason.no_power")
    if power_w > BEYOND_W:
        return message(language, "reason.beyond", beyond=human(BEYOND_W, "W"))
    return human(power_w, "W")


def reason_in_words(decision: Decision, language: str) -> str:
    """Why there is no allocation, or what else a decision says of itself; its own words where nothing is known here."""
    if decision.reason == APPROACHED:
        return message(language, "reason.approached")
    if decision.is_usable or decision.needed_power_w is None:
        return decision.reason
    if decision.status != "infeasible":
        return _open(decision, language)
    return _short(decision, language) or _needs(decision, language)


def _needs(decision: Decision, language: str) -> str:
    """That the promised rates need more power than they may use."""
    need, budget = decision.needed_power_w, decision.problem.budget_w(decision.cell)
    assert need is not None
    told = {"budget": human(budget, "W"), "least": human(need.at_least, "W"), "most": human(need.at_most, "W")}
    cap = decision.problem.subcarrier_max_power_w
    total = np.inf if cap is None else float(np.broadcast_to(cap, decision.owner.shape).sum())
    if total < min(budget, need.at_least * (1.0 - _ROUNDING)):
        return message(language, "reason.capped", limits=_limits(decision, language), total=human(total, "W"))
    if np.isinf(need.at_least):
        return message(language, "reason.needs_nothing")
    if not need.at_least > budget:
        return decision.reason
    if need.at_least > BEYOND_W:
        return message(language, "reason.needs_beyond", beyond=human(BEYOND_W, "W"), **told)
    return message(language, "reason.needs_found" if need.at_most <= BEYOND_W else "reason.needs", **told)


def _short(decision: Decision, language: str) -> str:
    """That no power is enough, and why; empty where some power may be."""
    short = nearest.shortage_of(decision)
    if short is None:
        return ""
    size = decision.problem.resource_block_group_size
    return message(
        language, f"reason.{short.kind}", name=called(language, decision.user_names[short.user]),
        users=short.users, served=short.served, places=short.places, needed=short.needed,
        promised=human(short.promised_bps, "bit/s"), most=human(short.most_bps, "bit/s"),
        kind=message(language, "part.subcarriers" if size == 1 else "reason.group", size=size),
        limits=_limits(decision, language),
    )  # fmt: skip


def _open(decision: Decision, language: str) -> str:
    """That nothing was found, how far what was found comes, and what is known of the need."""
    need, scale = decision.needed_power_w, decision.rate_scaling
    assert need is not None
    outage, found = decision.problem.outage_probability, ""
    if np.isfinite(need.at_most):
        found = message(language, "reason.found_power", most=power_in_words(need.at_most, language))
    elif scale is not None and scale.at_least > 0:
        found = message(language, "reason.found_share", share=percent(scale.at_least))
    sure = "" if outage is None else message(language, "reason.sure", sure=reliability(outage))
    budget, least = human(decision.problem.budget_w(decision.cell), "W"), human(need.at_least, "W")
    return message(language, "reason.open", sure=sure, budget=budget, found=found, least=least)


def _limits(decision: Decision, language: str) -> str:
    """The limits on what a subcarrier may carry; empty where there are none."""
    cap, link = decision.problem.subcarrier_max_power_w, decision.cell.max_spectral_efficiency
    limits: list[str] = []
    if cap is not None:
        one = np.ndim(cap) == 0 or np.ptp(cap) == 0
        figure = human(float(np.min(cap)), "W")
        limits.append(message(language, "reason.cap" if one else "reason.caps", cap=figure))
    if np.isfinite(link):
        limits.append(message(language, "reason.link", link=human(link, "bit/s/Hz")))
    return message(language, "reason.both", cap=limits[0], link=limits[1]) if len(limits) > 1 else "".join(limits)


class Remedies(Teller):
    """What can be met, of what was asked for or instead of it."""

    def none_needed(self) -> str:
        """What to say where the request can be met."""
        return self.say("remedy.feasible", figure=self.figure, value=self.worth(self.case.decision.value))

    def told(self, found: Nearest) -> Said:
        """Why a request cannot be met, what it would need, and what can be met instead, a line each."""
        case, more = self.case, found.more_power
        proven = "remedy.proven" if case.decision.status == "infeasible" else "remedy.open"
        ways = [self.say("remedy.way", number=number, way=self._way(way)) for number, way in enumerate(found.ways, 1)]
        ways += [self._way(one) for one in found.without_limits if one not in found.ways]
        beyond = ""
        if more is not None and not more.within_limit and more.power_w <= BEYOND_W:
            limit = human(case.cell.max_power_w, "W")
            beyond = self.say("remedy.beyond", power=human(more.power_w, "W"), limit=limit)
        instead = self.say("remedy.ways") if ways else "" if beyond else self.say("remedy.none")
        head = self.joined([self.say(proven, reason=reason_in_words(case.decision, self.language)), instead])
        return lines_of([head, *ways, beyond])

    def _way(self, way: nearest.Way) -> Said:
        """What can be met instead."""
        if isinstance(way, nearest.MorePower):
            return self.say("remedy.power", power=human(way.power_w, "W"))
        outcome, problem = outcome_in_words(way.decision, self.language), self.case.problem
        if isinstance(way, nearest.LowerRates):
            return self._rates(way, outcome)
        if isinstance(way, nearest.FewerUsers):
            return self._users(way, outcome)
        sure = reliability(problem.outage_probability or 0.0)
        return self.say(f"remedy.{way.limit}", outcome=outcome, size=problem.resource_block_group_size, sure=sure)

    def _rates(self, lower: nearest.LowerRates, outcome: str) -> Said:
        promised, known, most = self.case.promised_bps[self.case.served], np.isfinite(lower.at_most), ""
        if np.ptp(promised) > 0:
            most = self.say("remedy.most_factor", factor=lower.at_most) if known else ""
            return self.say("remedy.factor", factor=lower.factor, outcome=outcome, most=most)
        asked = float(promised[0])
        if known:
            most = self.say("remedy.most", rate=human(asked * lower.at_most, "bit/s"))
        rate = human(asked * lower.factor, "bit/s")
        return self.say("remedy.same", rate=rate, asked=human(asked, "bit/s"), outcome=outcome, most=most)

    def _users(self, fewer: nearest.FewerUsers, outcome: str) -> Said:
        kept = [int(user) for user in np.flatnonzero(self.case.served) if user not in fewer.left_out]
        few = len(kept) < len(fewer.left_out)
        names = self.names(kept if few else fewer.left_out)
        fewest = self.say("remedy.fewest") if fewer.is_fewest and len(fewer.left_out) > 1 else ""
        return self.say("remedy.only" if few else "remedy.without", names=names, outcome=outcome, fewest=fewest)

"""Why nothing was found that meets a request, the limit that is the cause; and the nearest requests that can be met."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import Said, called, joined, lines_of, listed, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import (
    FewerUsers,
    LowerRates,
    MorePower,
    Nearest,
    Shortage,
    Way,
    WithoutLimit,
    shortage_of,
)  # fmt: skip
from wirelessagent.telling.parts import outcome_in_words, value_name

BEYOND_W = 1e6
"""Powers beyond this are not told in figures: no cell radiates them."""
_ROUNDING = 1e-9


def power_in_words(power_w: float, language: str) -> str:
    """A power that rates need; where no cell has it, that instead of its figure."""
    if np.isinf(power_w):
        return message(language, "reason.no_power")
    return (
        message(language, "reason.beyond", beyond=human(BEYOND_W, "W")) if power_w > BEYOND_W else human(power_w, "W")
    )


def reason_in_words(decision: Decision, language: str) -> str:
    """Why there is no allocation, or what else a decision says of itself; its own words where nothing is known here."""
    if decision.reason == APPROACHED:
        return message(language, "reason.approached")
    if decision.is_usable or decision.needed_power_w is None:
        return decision.reason
    if decision.status != "infeasible":
        return _open(decision, language)
    short = shortage_of(decision)
    return _needs(decision, language) if short is None else _short(decision, short, language)


def _needs(decision: Decision, language: str) -> str:
    """That the promised rates need more power than they may use."""
    need, budget = decision.needed_power_w, decision.problem.budget_w(decision.cell)
    assert need is not None
    told = {"budget": human(budget, "W"), "least": human(need.at_least, "W"), "most": human(need.at_most, "W")}
    total = _caps_total_w(decision)
    if total < min(budget, need.at_least * (1.0 - _ROUNDING)):
        return message(language, "reason.capped", limits=_limits(decision, language), total=human(total, "W"))
    if np.isinf(need.at_least):
        return message(language, "reason.needs_nothing")
    if not need.at_least > budget:
        return decision.reason
    if need.at_least > BEYOND_W:
        return message(language, "reason.needs_beyond", beyond=human(BEYOND_W, "W"), **told)
    return message(language, "reason.needs_found" if need.at_most <= BEYOND_W else "reason.needs", **told)


def _short(decision: Decision, short: Shortage, language: str) -> str:
    """That no power is enough, and why."""
    size = decision.problem.resource_block_group_size
    return message(
        language,
        f"reason.{short.kind}",
        name=called(language, decision.user_names[short.user]),
        users=short.users,
        served=short.served,
        places=short.places,
        needed=short.needed,
        promised=human(short.promised_bps, "bit/s"),
        most=human(short.most_bps, "bit/s"),
        kind=message(language, "part.subcarriers" if size == 1 else "reason.group", size=size),
        limits=_limits(decision, language),
    )


def _open(decision: Decision, language: str) -> str:
    """That nothing was found, how far what was found comes, and what is known of the need."""
    need, scale = decision.needed_power_w, decision.rate_scaling
    assert need is not None
    outage, found = decision.problem.outage_probability, ""
    if np.isfinite(need.at_most):
        found = message(language, "reason.found_power", most=power_in_words(need.at_most, language))
    elif scale is not None and scale.at_least > 0:
        found = message(language, "reason.found_share", share=percent(scale.at_least))
    return message(
        language,
        "reason.open",
        sure="" if outage is None else message(language, "reason.sure", sure=reliability(outage)),
        budget=human(decision.problem.budget_w(decision.cell), "W"),
        found=found,
        least=human(need.at_least, "W"),
    )


def _caps_total_w(decision: Decision) -> float:
    """What the limits on each subcarrier allow in all; infinite without such limits."""
    cap = decision.problem.subcarrier_max_power_w
    return np.inf if cap is None else float(np.broadcast_to(cap, decision.owner.shape).sum())


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


def feasible_answer(case: Case, language: str) -> str:
    """What to say where the request can be met."""
    value = human(case.decision.value, case.decision.unit)
    return message(language, "remedy.feasible", figure=value_name(case.decision, language), value=value)


def nearest_answer(case: Case, found: Nearest, language: str) -> str:
    """Why a request cannot be met, what it would need, and what can be met instead, a line each."""
    proven = "remedy.proven" if case.decision.status == "infeasible" else "remedy.open"
    head: list[str] = [message(language, proven, reason=reason_in_words(case.decision, language))]
    told = (_way(case, way, language) for way in found.ways)
    ways = [message(language, "remedy.way", number=number, way=way) for number, way in enumerate(told, start=1)]
    ways += [_lifted(case, one, language) for one in found.without_limits if one not in found.ways]
    more = found.more_power
    beyond_limit = more is not None and not more.within_limit and more.power_w <= BEYOND_W
    power = human(more.power_w, "W") if more is not None and beyond_limit else ""
    head.append(message(language, "remedy.ways") if ways else "" if power else message(language, "remedy.none"))
    limit = human(case.cell.max_power_w, "W")
    beyond = message(language, "remedy.beyond", power=power, limit=limit) if power else ""
    return lines_of([joined(language, head), *ways, beyond])


def _way(case: Case, way: Way, language: str) -> Said:
    """What can be met instead."""
    if isinstance(way, MorePower):
        return message(language, "remedy.power", power=human(way.power_w, "W"))
    if isinstance(way, WithoutLimit):
        return _lifted(case, way, language)
    return _rates(case, way, language) if isinstance(way, LowerRates) else _users(case, way, language)


def _lifted(case: Case, one: WithoutLimit, language: str) -> Said:
    problem, outcome = case.problem, outcome_in_words(one.decision, language)
    sure = reliability(problem.outage_probability or 0.0)
    return message(language, f"remedy.{one.limit}", outcome=outcome, size=problem.resource_block_group_size, sure=sure)


def _rates(case: Case, lower: LowerRates, language: str) -> Said:
    outcome, promised = outcome_in_words(lower.decision, language), case.promised_bps[case.served]
    known = np.isfinite(lower.at_most)
    if np.ptp(promised) > 0:
        most = message(language, "remedy.most_factor", factor=lower.at_most) if known else ""
        return message(language, "remedy.factor", factor=lower.factor, outcome=outcome, most=most)
    rate = float(promised[0])
    most = message(language, "remedy.most", rate=human(rate * lower.at_most, "bit/s")) if known else ""
    asked = human(rate, "bit/s")
    return message(
        language, "remedy.same", rate=human(rate * lower.factor, "bit/s"), asked=asked, outcome=outcome, most=most
    )  # fmt: skip


def _users(case: Case, fewer: FewerUsers, language: str) -> Said:
    kept = [int(user) for user in np.flatnonzero(case.served) if user not in fewer.left_out]
    key, users = ("remedy.only", kept) if len(kept) < len(fewer.left_out) else ("remedy.without", fewer.left_out)
    names = listed(language, case.named(users))
    fewest = message(language, "remedy.fewest") if fewer.is_fewest and len(fewer.left_out) > 1 else ""
    outcome = outcome_in_words(fewer.decision, language)
    return message(language, key, names=names, outcome=outcome, fewest=fewest)

"""Why a request cannot be met, and the nearest ones that can, in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, reliability
from wirelessagent.telling.catalogue import Said, joined, lines_of, listed, message
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import FewerUsers, LowerRates, MorePower, Nearest, Way, WithoutLimit
from wirelessagent.telling.parts import outcome_in_words, value_name
from wirelessagent.telling.reasons import BEYOND_W, reason_in_words


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

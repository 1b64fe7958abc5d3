"""Why nothing was found that meets a request: the limit that is the cause, with figures that people can read."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.facts.shortage import Shortage, shortage_of

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

"""Why nothing was found that meets a request: the limit that is the cause, with figures that people can read."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.closed_form import APPROACHED
from wirelessagent.explain.lexicon import Lexicon
from wirelessagent.explain.shortage import Shortage, shortage_of
from wirelessagent.model.decision import Decision
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called

BEYOND_W = 1e6
"""Powers beyond this are not told in figures: no cell radiates them."""
_ROUNDING = 1e-9

WORDS = Lexicon(
    english={
        "no_power": "no power is enough",
        "beyond": "more than {beyond}",
        "needs": "the rates asked for need at least {least}, more than the {budget} allowed",
        "needs_found": "the rates asked for need at least {least}, more than the {budget} allowed, and an "
        "allocation with {most} was found",
        "needs_beyond": "the rates asked for need more than {beyond}, which no cell has; {budget} is allowed",
        "needs_nothing": "no power is enough for the rates asked for",
        "capped": "{limits} no more than {total} can be radiated in all, and the rates asked for need more, whatever "
        "the budget",
        "no_subcarrier": "a rate is asked for {name}, but no subcarrier is of use to it",
        "too_few": "{users} users are to get a rate, but the {kind} that can be used ({places}) are enough for "
        "only {served} of them",
        "one_user": "{promised} is asked for {name}, but {limits} its subcarriers carry no more than {most} in all, "
        "whatever the power",
        "together": "the rates asked for add up to {promised}, but {limits} the subcarriers carry no more than {most} "
        "in all, whatever the power",
        "places": "{limits} the rates asked for take at least {needed} {kind}, whatever the power, and {places} can be "
        "used",
        "subcarrier": "subcarriers",
        "group": "groups of {size} subcarriers",
        "cap": "with at most {cap} on each subcarrier",
        "caps": "with the limits on each subcarrier",
        "link": "with a link of {link} at most",
        "both": "{cap} and {link}",
        "open": "no allocation was found that carries the rates asked for{sure} within {budget}{found}; they need at "
        "least {least}, and whether that is enough is not known",
        "sure": " with a probability of {sure}",
        "found_power": " (one was found with {most})",
        "found_share": " (one carries {share} of them)",
        "approached": "without circuit power less power is always more efficient: the best efficiency is only "
        "approached as the power goes to 0, here to 1e-12 of it",
    },
    chinese={
        "no_power": "多大功率都不够",
        "beyond": "超过 {beyond}",
        "needs": "所要求的速率至少需要 {least}，超过允许的 {budget}",
        "needs_found": "所要求的速率至少需要 {least}，超过允许的 {budget}；已找到一个用 {most} 的分配",
        "needs_beyond": "所要求的速率需要超过 {beyond} 的功率，没有小区做得到，允许的是 {budget}",
        "needs_nothing": "多大功率都不足以达到所要求的速率",
        "capped": "{limits}总共最多只能发射 {total}，而所要求的速率需要更多，与功率预算无关",
        "no_subcarrier": "为{name}要求了速率，但没有它可用的子载波",
        "too_few": "为 {users} 个用户要求了速率，但只有 {places} 个可用的{kind}，只够其中 {served} 个用户",
        "one_user": "对{name}要求的是 {promised}，但{limits}无论功率多大，它的子载波总共最多承载 {most}",
        "together": "所要求的速率共 {promised}，但{limits}无论功率多大，所有子载波总共最多承载 {most}",
        "places": "{limits}无论功率多大，所要求的速率至少需要 {needed} 个{kind}，而可用的只有 {places} 个",
        "subcarrier": "子载波",
        "group": "子载波组（每组 {size} 个子载波）",
        "cap": "每个子载波不超过 {cap} 时，",
        "caps": "有各子载波的功率上限时，",
        "link": "链路不超过 {link} 时，",
        "both": "{cap}{link}",
        "open": "在 {budget} 之内没有找到{sure}达到所要求速率的分配{found}；至少需要 {least}，能否做到尚不清楚",
        "sure": "以 {sure} 的概率",
        "found_power": "（找到一个用 {most} 的）",
        "found_share": "（有一个能承载其 {share}）",
        "approached": "没有电路功率时，功率越小越高效：最佳能效只能在功率趋于 0 时逼近，这里取其 1e-12",
    },
)


def power_in_words(power_w: float, language: str) -> str:
    """A power that rates need; where no cell has it, that instead of its figure."""
    if np.isinf(power_w):
        return WORDS.say(language, "no_power")
    return WORDS.say(language, "beyond", beyond=human(BEYOND_W, "W")) if power_w > BEYOND_W else human(power_w, "W")


def reason_in_words(decision: Decision, language: str) -> str:
    """Why there is no allocation, or what else a decision says of itself; its own words where nothing is known here."""
    if decision.reason == APPROACHED:
        return WORDS.say(language, "approached")
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
        return WORDS.say(language, "capped", limits=_limits(decision, language), total=human(total, "W"))
    if np.isinf(need.at_least):
        return WORDS.say(language, "needs_nothing")
    if not need.at_least > budget:
        return decision.reason
    if need.at_least > BEYOND_W:
        return WORDS.say(language, "needs_beyond", beyond=human(BEYOND_W, "W"), **told)
    return WORDS.say(language, "needs_found" if need.at_most <= BEYOND_W else "needs", **told)


def _short(decision: Decision, short: Shortage, language: str) -> str:
    """That no power is enough, and why."""
    size = decision.problem.resource_block_group_size
    return WORDS.say(
        language,
        short.kind,
        name=called(language, decision.user_names[short.user]),
        users=short.users,
        served=short.served,
        places=short.places,
        needed=short.needed,
        promised=human(short.promised_bps, "bit/s"),
        most=human(short.most_bps, "bit/s"),
        kind=WORDS.say(language, "subcarrier" if size == 1 else "group", size=size),
        limits=_limits(decision, language),
    )


def _open(decision: Decision, language: str) -> str:
    """That nothing was found, how far what was found comes, and what is known of the need."""
    need, scale = decision.needed_power_w, decision.rate_scaling
    assert need is not None
    outage, found = decision.problem.outage_probability, ""
    if np.isfinite(need.at_most):
        found = WORDS.say(language, "found_power", most=power_in_words(need.at_most, language))
    elif scale is not None and scale.at_least > 0:
        found = WORDS.say(language, "found_share", share=percent(scale.at_least))
    return WORDS.say(
        language,
        "open",
        sure="" if outage is None else WORDS.say(language, "sure", sure=reliability(outage)),
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
        limits.append(WORDS.say(language, "cap" if one else "caps", cap=figure))
    if np.isfinite(link):
        limits.append(WORDS.say(language, "link", link=human(link, "bit/s/Hz")))
    return WORDS.say(language, "both", cap=limits[0], link=limits[1]) if len(limits) > 1 else "".join(limits)

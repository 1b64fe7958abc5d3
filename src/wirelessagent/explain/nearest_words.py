"""Why a request cannot be met, and the nearest ones that can, in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, listed, outcome_in_words, paragraph, value_name
from wirelessagent.explain.nearest import Nearest, WithoutLimit
from wirelessagent.explain.reasons import BEYOND_W, reason_in_words
from wirelessagent.model.units import human, reliability

WORDS = Lexicon(
    english={
        "feasible": "The request can be met: {figure} {value}.",
        "proven": "The request cannot be met, and that is proven: {reason}.",
        "open": "Nothing was found that meets the request, and nothing proves that it cannot be met: {reason}.",
        "ways": "What can be met, each solved for:",
        "power": "- the same rates with {power}: {outcome}{limit}",
        "limit": "; that is beyond the cell's limit of {limit}",
        "subcarrier_max_power_w": "- the same without the limit on each subcarrier: {outcome}",
        "resource_block_group_size": "- the same with single subcarriers instead of groups of {size}: {outcome}",
        "outage_probability": "- the same promised on the estimate as it stands, not with {sure}: {outcome}",
        "same": "- {rate} for each user instead of {asked}: {outcome}{most}",
        "factor": "- every promised rate times {factor:.3g}: {outcome}{most}",
        "most": "; more than {rate} is proven impossible",
        "most_factor": "; more than {factor:.3g} times is proven impossible",
        "without": "- the same rates without {names}: {outcome}{fewest}",
        "only": "- the same rates for {names} alone: {outcome}{fewest}",
        "fewest": "; that leaving out fewer does not help is proven",
        "none": "No lower rates, more power or fewer users were found that would do.",
    },
    chinese={
        "feasible": "该要求可以满足：{figure} {value}。",
        "proven": "该要求无法满足，并且已被证明：{reason}。",
        "open": "没有找到满足要求的分配，也没有证明它无法满足：{reason}。",
        "ways": "以下要求可以满足，均已求解：",
        "power": "- 速率不变，功率 {power}：{outcome}{limit}",
        "limit": "；这超出小区上限 {limit}",
        "subcarrier_max_power_w": "- 要求不变，不限制每个子载波的功率：{outcome}",
        "resource_block_group_size": "- 要求不变，子载波逐个分配，而不是每 {size} 个一组：{outcome}",
        "outage_probability": "- 要求不变，直接按估计值承诺，而不是以 {sure} 兑现：{outcome}",
        "same": "- 每个用户 {rate}，而不是 {asked}：{outcome}{most}",
        "factor": "- 所有承诺速率乘以 {factor:.3g}：{outcome}{most}",
        "most": "；已证明不可能超过 {rate}",
        "most_factor": "；已证明不可能超过 {factor:.3g} 倍",
        "without": "- 速率不变，不服务{names}：{outcome}{fewest}",
        "only": "- 速率不变，只服务{names}：{outcome}{fewest}",
        "fewest": "；已证明少去掉用户无济于事",
        "none": "没有找到可行的更低速率、更高功率或更少用户。",
    },
)


def feasible_answer(case: Case, language: str) -> str:
    """What to say where the request can be met."""
    value = human(case.decision.value, case.decision.unit)
    return WORDS.say(language, "feasible", figure=value_name(case, language), value=value)


def nearest_answer(case: Case, found: Nearest, language: str) -> str:
    """Why a request cannot be met, what it would need, and what can be met instead, a line each."""
    proven = "proven" if case.decision.status == "infeasible" else "open"
    head = [WORDS.say(language, proven, reason=reason_in_words(case.decision, language))]
    lifted = [_lifted(case, one, language) for one in found.without_limits]
    ways = [_power(case, found, language), *lifted, _rates(case, found, language), _users(case, found, language)]
    ways = [way for way in ways if way]
    head.append(WORDS.say(language, "ways" if ways else "none"))
    return "\n".join([paragraph(head, language), *ways])


def _power(case: Case, found: Nearest, language: str) -> str:
    more = found.more_power
    if more is None or more.power_w > BEYOND_W:
        return ""
    limit = "" if more.within_limit else WORDS.say(language, "limit", limit=human(case.cell.max_power_w, "W"))
    outcome = outcome_in_words(case, more.decision, language)
    return WORDS.say(language, "power", power=human(more.power_w, "W"), outcome=outcome, limit=limit)


def _lifted(case: Case, one: WithoutLimit, language: str) -> str:
    problem, outcome = case.problem, outcome_in_words(case, one.decision, language)
    sure = reliability(problem.outage_probability or 0.0)
    return WORDS.say(language, one.limit, outcome=outcome, size=problem.resource_block_group_size, sure=sure)


def _rates(case: Case, found: Nearest, language: str) -> str:
    lower = found.lower_rates
    if lower is None:
        return ""
    outcome, promised = outcome_in_words(case, lower.decision, language), case.promised_bps[case.served]
    known = np.isfinite(lower.at_most)
    if np.ptp(promised) > 0:
        most = WORDS.say(language, "most_factor", factor=lower.at_most) if known else ""
        return WORDS.say(language, "factor", factor=lower.factor, outcome=outcome, most=most)
    rate = float(promised[0])
    most = WORDS.say(language, "most", rate=human(rate * lower.at_most, "bit/s")) if known else ""
    asked = human(rate, "bit/s")
    return WORDS.say(
        language, "same", rate=human(rate * lower.factor, "bit/s"), asked=asked, outcome=outcome, most=most
    )  # fmt: skip


def _users(case: Case, found: Nearest, language: str) -> str:
    fewer = found.fewer_users
    if fewer is None:
        return ""
    kept = [int(user) for user in np.flatnonzero(case.served) if user not in fewer.left_out]
    key, users = ("only", kept) if len(kept) < len(fewer.left_out) else ("without", fewer.left_out)
    names = listed([case.estimate.user_names[user] for user in users], language)
    fewest = WORDS.say(language, "fewest") if fewer.is_fewest and len(fewer.left_out) > 1 else ""
    outcome = outcome_in_words(case, fewer.decision, language)
    return WORDS.say(language, key, names=names, outcome=outcome, fewest=fewest)

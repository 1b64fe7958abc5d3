"""A decision in a few sentences, every figure computed from the decision itself."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from wirelessagent import chain
from wirelessagent.explain.report import Report, cannot_be_served, name_of_figure
from wirelessagent.model.arrays import BoolArray
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import db, human, percent, reliability

_ENGLISH: Mapping[str, str] = {
    "allocation": "{used} of {total} subcarriers serve {served} of {users} users with {power} of the {budget} allowed.",
    "optimal": "This is the optimum on the estimated channel: the bound proves that nothing does better.",
    "gap": "Nothing on the estimated channel does better than {bound}; this decision is within {gap} of that.",
    "outage_optimal": "No promises at this probability do better, by what is known here: the bound proves it.",
    "outage_gap": "No promises at this probability, by what is known of the channel, do better than {bound}; this "
    "decision is within {gap} of that, part of which is what not knowing costs.",
    "outage": "Each promised rate is kept with a probability of {sure}, by the joint posterior of the gains that it "
    "rests on; {promised} are promised in all, and {mean} are expected.",
    "times": "Nothing on the estimated channel does better than {bound}; this decision is {times:.3g} times that.",
    "zero_bound": "A value of zero is not ruled out, so how far this is from the best is not known.",
    "no_bound": "The method {method} gives no bound, so how far this is from the best is not known.",
    "infeasible": "This cannot be done, and that is proven: {reason}",
    "undecided": "No allocation was found that does this, and no proof that there is none: {reason}",
    "figure": "The users' {figure} is to be as large as can be; it is {value}.",
    "weights": "Users' rates count by their weights, from {least:g} to {most:g}.",
    "shares": "Users are to get rates in proportion to their weights, from {least:g} to {most:g}; the {figure} is "
    "per unit of weight.",
    "starved": "{names} cannot be given any rate here, and that makes the {figure} zero.",
    "power_max": "One more watt would buy about {price} at the margin.",
    "power_figure": "One more watt would raise the {figure} by about {price} at the margin.",
    "rate_price": "One more {step} for {user} would cost about {price} at the margin, the dearest of all.",
    "rate_figure": "One more {step} promised to {user} would lower the {figure} by about {price} at the margin, "
    "the dearest of all.",
    "idle_one": "Nothing for {names}, who is {margin:.1f} dB behind the winner on its best subcarrier.",
    "groups": "Assigning subcarriers in groups of {size} costs at most {cost} of the {figure}: one by one, "
    "nothing does better than {bound}.",
    "idle": "Nothing for {names}; the closest, {closest}, is {margin:.1f} dB behind the winner on its best subcarrier.",
    "repaired": "Repaired by {method}: {missing} of {entries} gains; "
    "{resting} of the {used} subcarriers in use rest on a repaired gain.",
    "guessed": "No gain of {names} was observed: their level is a guess, and so is what is promised on it.",
    "no_promise": "No rate is promised to anybody, so nothing has to be sent; a minimum rate would change that.",
    "complete": "No gain was missing, so nothing was repaired.",
    "kept": "On the true channel every {rate} rate was kept.",
    "missed": "On the true channel {names} fell short of the {rate} rate, by up to {short}.",
    "promised": "promised",
    "committed": "committed",
    "value": "value",
    "comma": ", ",
}

_CHINESE: Mapping[str, str] = {
    "allocation": "{total} 个子载波中使用了 {used} 个，"
    "服务 {users} 个用户中的 {served} 个，功率 {power}（上限 {budget}）。",
    "optimal": "这是估计信道上的最优解：对偶界证明没有更好的分配。",
    "gap": "在估计信道上任何分配都不会优于 {bound}；本方案与该界相差不超过 {gap}。",
    "outage_optimal": "在对信道已有的了解下，以此概率作出的任何承诺都不会更优：对偶界已证明。",
    "outage_gap": "在对信道已有的了解下，以此概率作出的任何承诺都不会优于 {bound}；本方案与该界相差不超过 {gap}，"
    "其中一部分是信道不确定的代价。",
    "outage": "按所依据增益的联合后验分布，每个承诺速率以 {sure} 的概率兑现；"
    "承诺总和为 {promised}，期望总和为 {mean}。",
    "times": "在估计信道上任何分配都不会优于 {bound}；本方案是该界的 {times:.3g} 倍。",
    "zero_bound": "尚不能排除零值，因此与最优解的差距未知。",
    "no_bound": "方法 {method} 不提供界，因此与最优解的差距未知。",
    "infeasible": "该要求无法满足，并且已被证明：{reason}",
    "undecided": "没有找到满足要求的分配，也没有证明它不存在：{reason}",
    "figure": "目标是各用户的{figure}尽可能大，现为 {value}。",
    "weights": "各用户的速率按权重计，权重从 {least:g} 到 {most:g}。",
    "shares": "各用户的速率应与其权重成正比，权重从 {least:g} 到 {most:g}；{figure}按单位权重计。",
    "starved": "这里无法给 {names} 任何速率，因此{figure}为零。",
    "power_max": "边际上每增加一瓦约可换来 {price}。",
    "power_figure": "边际上每增加一瓦，{figure}约提高 {price}。",
    "rate_price": "边际上给 {user} 再增加 {step} 约需 {price}，是所有用户中最贵的。",
    "rate_figure": "边际上向 {user} 多承诺 {step}，{figure}约降低 {price}，是所有用户中最贵的。",
    "idle_one": "{names} 没有分到子载波，在其最好的子载波上比胜者低 {margin:.1f} dB。",
    "groups": "以 {size} 个子载波为一组分配，{figure}的损失最多为 {cost}：逐个分配时任何方案都不会优于 {bound}。",
    "idle": "{names} 没有分到子载波；其中最接近的 {closest} 在其最好的子载波上仍比胜者低 {margin:.1f} dB。",
    "repaired": "{entries} 个增益中缺失 {missing} 个，由 {method} 修复；"
    "使用的 {used} 个子载波中有 {resting} 个依赖修复值。",
    "guessed": "没有观测到 {names} 的任何增益：其水平只是猜测，基于它的承诺也是。",
    "no_promise": "没有向任何用户承诺速率，因此无需发送；给出最低速率即可改变这一点。",
    "complete": "没有缺失的增益，因此无需修复。",
    "kept": "在真实信道上，所有{rate}速率都已兑现。",
    "missed": "在真实信道上 {names} 未达到{rate}速率，最多少 {short}。",
    "promised": "承诺",
    "committed": "预定",
    "value": "目标值",
    "comma": "、",
}


def explain(estimate: ChannelEstimate, report: Report, *, language: str = "en") -> list[str]:
    """Why the decision is what it is, in English or Chinese ("zh"), one sentence per item."""
    words = _CHINESE if language == "zh" else _ENGLISH
    decision = report.decision
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    if not decision.is_usable:
        return [words[decision.status].format(reason=decision.reason)]
    if objective.measure == "power" and decision.problem.min_rate_bps is None and not decision.power_w.any():
        return [words["no_promise"]]
    figure = name_of_figure(decision, language)
    said = [_allocation(words, decision), *_goal(words, decision, objective, figure), _certificate(words, decision)]
    said += _promised_at(words, decision)
    said += _groups(words, decision, estimate, figure)
    said += [decision.reason] if decision.reason and not cannot_be_served(decision) else []
    said += _prices(words, decision, objective, figure)
    said += _idle_users(words, decision, estimate)
    said.append(_repair(words, decision, estimate))
    said += _guesses(words, decision, estimate)
    said += _outcome(words, report)
    return said


def _allocation(words: Mapping[str, str], decision: Decision) -> str:
    used = int(np.count_nonzero(decision.power_w > 0))
    return words["allocation"].format(
        used=used,
        total=decision.owner.size,
        served=int(np.count_nonzero(decision.rate_bps > 0)),
        users=decision.rate_bps.size,
        power=human(decision.total_power_w, "W"),
        budget=human(decision.problem.budget_w(decision.cell), "W"),
    )


def _certificate(words: Mapping[str, str], decision: Decision) -> str:
    if np.isnan(decision.gap):
        return words["no_bound"].format(method=decision.method)
    outage = "outage_" if decision.expected_rate_bps.size else ""
    if decision.status == "optimal" and decision.gap <= OPTIMAL_GAP:
        return words[f"{outage}optimal"]
    if np.isinf(decision.gap):
        return words["zero_bound"].format(method=decision.method)
    bound = human(decision.bound, decision.unit)
    if decision.gap > 1.0 and decision.value * decision.bound > 0:  # percents beyond 100 tell nothing
        return words["times"].format(bound=bound, times=decision.value / decision.bound)
    return words[f"{outage}gap"].format(bound=bound, gap=percent(decision.gap))


def _promised_at(words: Mapping[str, str], decision: Decision) -> list[str]:
    """With which probability rates are promised, and what they are beside the mean ones."""
    outage = decision.problem.outage_probability
    if outage is None or not decision.expected_rate_bps.size:
        return []
    mean, promised = float(decision.expected_rate_bps.sum()), float(decision.rate_bps.sum())
    return [
        words["outage"].format(sure=reliability(outage), mean=human(mean, "bit/s"), promised=human(promised, "bit/s"))
    ]


def _groups(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate, figure: str) -> list[str]:
    """What assigning whole resource-block groups costs at most, by the bound without groups."""
    size = decision.problem.resource_block_group_size
    if size == 1:
        return []
    single = dataclasses.replace(decision.problem, resource_block_group_size=1)
    bound = chain.decide(estimate, single, decision.cell, "dual", restarts=0).bound
    if not np.isfinite(bound) or bound == 0.0:
        return []
    cost = max(decision.value / bound - 1.0 if _falls(decision) else 1.0 - decision.value / bound, 0.0)
    return [
        words["groups"].format(
            size=size, cost=percent(cost), figure=figure or words["value"], bound=human(bound, decision.unit)
        )
    ]


def _falls(decision: Decision) -> bool:
    """Whether smaller values are better."""
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    return objective.direction == "min"


def _goal(words: Mapping[str, str], decision: Decision, objective: Objective, figure: str) -> list[str]:
    """What the value is, where its unit does not say it, and how the users count in it."""
    said: list[str] = []
    if figure:
        said.append(words["figure"].format(figure=figure, value=human(decision.value, decision.unit)))
        starved = (decision.rate_bps <= 0) & _counts(decision) & (decision.value == 0)
        names = words["comma"].join(decision.user_names[user] for user in np.flatnonzero(starved))
        said += [words["starved"].format(names=names, figure=figure)] if names else []
    weight = decision.problem.weights_of(decision.rate_bps.size)
    weight = weight[decision.problem.serves(weight.size)]
    if np.ptp(weight) > 0:
        sentence = words["shares" if objective.joined == "min" else "weights"]
        said.append(sentence.format(least=weight.min(), most=weight.max(), figure=figure))
    return said


def _counts(decision: Decision) -> BoolArray:
    """True for users whose rate counts: those who are served and have a weight."""
    return decision.problem.weights_of(decision.rate_bps.size) > 0


def _prices(words: Mapping[str, str], decision: Decision, objective: Objective, figure: str) -> list[str]:
    """What a watt more and a promise more would change, in the value's unit."""
    said: list[str] = []
    worth_saying = 1e-9 * abs(decision.value) / decision.problem.budget_w(decision.cell)
    if decision.price_of_power > worth_saying:
        sentence = words["power_figure" if figure else "power_max"]
        said.append(sentence.format(price=human(decision.price_of_power, decision.unit), figure=figure))
    # A promise costs: it raises what is to be small, and lowers what is to be large.
    cost = decision.price_of_rate if objective.direction == "min" else -decision.price_of_rate
    if np.any(cost > 0):
        dearest = int(np.nanargmax(cost))
        price = human(float(cost[dearest]) * 100e3, decision.unit)
        user = decision.user_names[dearest]
        sentence = words["rate_figure" if figure else "rate_price"]
        said.append(sentence.format(step="100 kbit/s", user=user, price=price, figure=figure))
    return said


def _idle_users(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate) -> list[str]:
    """Who of those who count gets nothing, and by what margin the closest of them was beaten."""
    idle = np.flatnonzero((decision.rate_bps <= 0) & _counts(decision))
    wanted = decision.problem.min_rate_bps
    if not idle.size or wanted is not None:
        return []
    best = estimate.gain.max(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        margin_db = db(best / estimate.gain[idle]).min(axis=1)
    closest = int(np.argmin(margin_db))
    if not np.isfinite(margin_db[closest]) or margin_db[closest] <= 0:
        return []
    names = [decision.user_names[user] for user in idle]
    if len(names) == 1:
        return [words["idle_one"].format(names=names[0], margin=float(margin_db[closest]))]
    return [
        words["idle"].format(names=words["comma"].join(names), margin=float(margin_db[closest]), closest=names[closest])
    ]


def _repair(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate) -> str:
    missing = int(estimate.repaired.sum())
    if not missing:
        return words["complete"]
    in_use = np.flatnonzero((decision.owner >= 0) & (decision.power_w > 0))
    return words["repaired"].format(
        missing=missing,
        entries=estimate.repaired.size,
        method=estimate.method,
        used=in_use.size,
        resting=int(estimate.repaired[decision.owner[in_use], in_use].sum()),
    )


def _guesses(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate) -> list[str]:
    """A warning for users whose level nobody ever observed."""
    unseen = [decision.user_names[user] for user in np.flatnonzero(estimate.unobserved_users)]
    return [words["guessed"].format(names=words["comma"].join(unseen))] if unseen else []


def _outcome(words: Mapping[str, str], report: Report) -> list[str]:
    if report.achieved is None:
        return []
    rate = words["promised" if report.decision.problem.promises_rates else "committed"]
    if not report.missed_users:
        return [words["kept"].format(rate=rate)]
    missed = list(report.missed_users)
    promised, carried = report.decision.rate_bps[missed], report.achieved.user_rate_bps[missed]
    return [
        words["missed"].format(
            names=words["comma"].join(report.decision.user_names[user] for user in missed),
            short=percent(float(np.max(1 - carried / promised))),
            rate=rate,
        )
    ]

"""A decision in a few sentences, every figure computed from the decision itself."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from wirelessagent import chain
from wirelessagent.explain.proof_words import rests_on
from wirelessagent.explain.reasons import reason_in_words
from wirelessagent.explain.report import Report, cannot_be_served, name_of_figure
from wirelessagent.explain.sentences import sentences
from wirelessagent.model.arrays import BoolArray, IntArray
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import db, human, percent, reliability
from wirelessagent.telling.catalogue import called

_SURE = 0.95
"""The probability from which a promise without an outage probability goes without a warning."""

_ALL_BUT_CERTAIN = 0.999
"""A probability beyond which nobody counts."""
_NO_REGRET = 5e-4
"""A share of the rate that nobody would miss."""


def explain(estimate: ChannelEstimate, report: Report, *, language: str = "en") -> list[str]:
    """Why the decision is what it is, in English or Chinese ("zh"), one sentence per item."""
    words = sentences(language)
    decision = report.decision
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    if not decision.is_usable:
        return [words[decision.status].format(reason=reason_in_words(decision, language))]
    if objective.measure == "power" and decision.problem.min_rate_bps is None and not decision.power_w.any():
        return [words["no_promise"]]
    figure = name_of_figure(decision, language)
    said = [_allocation(words, decision), *_goal(words, decision, objective, figure), _certificate(words, decision)]
    if not objective.is_built_in and not np.isnan(decision.gap):
        said.append(rests_on(objective, language))
    said += _promised_at(words, decision)
    said += _forecast(words, decision)
    said += _groups(words, decision, estimate, figure)
    said += _remark(words, decision, language)
    said += _prices(words, decision, objective, figure)
    said += _idle_users(words, decision, estimate)
    said.append(_repair(words, decision, estimate))
    said += _guesses(words, decision, estimate)
    said += _outcome(words, report)
    said += _regret(words, report, objective, figure)
    return said


def _remark(words: Mapping[str, str], decision: Decision, language: str) -> list[str]:
    """What else the decision says of itself."""
    if not decision.reason or cannot_be_served(decision):
        return []
    said = reason_in_words(decision, language)
    return [words["sentence"].format(said=said[:1].upper() + said[1:])]


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
        return words["no_bound"].format(method=called(words["language"], decision.method))
    outage = "outage_" if decision.expected_rate_bps.size else ""
    if decision.status == "optimal" and decision.gap <= OPTIMAL_GAP:
        return words[f"{outage}optimal"]
    if np.isinf(decision.gap):
        return words["zero_bound"]
    bound = human(decision.bound, decision.unit)
    if decision.gap > 1.0 and decision.value * decision.bound > 0:  # percents beyond 100 tell nothing
        return words["times"].format(bound=bound, times=decision.value / decision.bound)
    return words[f"{outage}gap"].format(bound=bound, gap=percent(decision.gap))


def _promised_at(words: Mapping[str, str], decision: Decision) -> list[str]:
    """With which probability rates are promised, and how much in all."""
    outage = decision.problem.outage_probability
    if outage is None or not decision.expected_rate_bps.size:
        return []
    promised = human(float(decision.rate_bps.sum()), "bit/s")
    return [words["outage"].format(sure=reliability(outage), promised=promised)]


def _forecast(words: Mapping[str, str], decision: Decision) -> list[str]:
    """What is expected of the true channel, how sure that is, and what is committed because of it."""
    forecast = decision.forecast
    if forecast is None:
        return []
    mean, low, high = float(forecast.mean_bps.sum()), forecast.sum_low_bps, forecast.sum_high_bps
    shown = {name: human(rate, "bit/s") for name, rate in (("mean", mean), ("low", low), ("high", high))}
    said = [words["forecast_sure" if shown["low"] == shown["high"] else "forecast"].format(**shown)]
    if decision.expected_rate_bps.size:
        return said
    least = int(np.argmin(np.where(decision.committed_bps > 0, forecast.carried, np.inf)))
    sure = f"{100 * min(float(forecast.carried[least]), _ALL_BUT_CERTAIN):.3g} %"
    if not decision.problem.promises_rates:
        committed = human(float(decision.committed_bps.sum()), "bit/s")
        return [*said, words["commitment"].format(committed=committed, sure=sure)]
    rate = human(float(decision.committed_bps[least]), "bit/s")
    key = "asked" if forecast.carried[least] >= _SURE else "asked_unsure"
    return [*said, words[key].format(name=_user(words, decision, least), sure=sure, rate=rate)]


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
        names = _users(words, decision, np.flatnonzero(starved))
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
        user = _user(words, decision, dearest)
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
    names, margin = _users(words, decision, idle), float(margin_db[closest])
    if idle.size == 1:
        return [words["idle_one"].format(names=names, margin=margin)]
    return [words["idle"].format(names=names, margin=margin, closest=_user(words, decision, int(idle[closest])))]


def _user(words: Mapping[str, str], decision: Decision, user: int) -> str:
    return called(words["language"], decision.user_names[user])


def _users(words: Mapping[str, str], decision: Decision, users: IntArray) -> str:
    return words["comma"].join(_user(words, decision, int(user)) for user in users)


def _repair(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate) -> str:
    missing = int(estimate.repaired.sum())
    if not missing:
        return words["complete"]
    in_use = np.flatnonzero((decision.owner >= 0) & (decision.power_w > 0))
    return words["repaired"].format(
        missing=missing,
        entries=estimate.repaired.size,
        method=called(words["language"], estimate.method),
        used=in_use.size,
        resting=int(estimate.repaired[decision.owner[in_use], in_use].sum()),
    )


def _guesses(words: Mapping[str, str], decision: Decision, estimate: ChannelEstimate) -> list[str]:
    """A warning for users whose level nobody ever observed."""
    unseen = np.flatnonzero(estimate.unobserved_users)
    return [words["guessed"].format(names=_users(words, decision, unseen))] if unseen.size else []


def _outcome(words: Mapping[str, str], report: Report) -> list[str]:
    if report.achieved is None:
        return []
    firmness = report.decision.problem.firmness
    if not report.missed_users:
        return [words[f"kept_{firmness}"]]
    missed = list(report.missed_users)
    promised, carried = report.decision.committed_bps[missed], report.achieved.user_rate_bps[missed]
    return [
        words[f"missed_{firmness}"].format(
            names=_users(words, report.decision, np.array(missed)),
            short=percent(float(np.max(1 - carried / promised))),
        )
    ]


def _regret(words: Mapping[str, str], report: Report, objective: Objective, figure: str) -> list[str]:
    """What not knowing the channel cost, where that is known."""
    perfect, achieved = report.perfect, report.achieved
    if perfect is None or achieved is None or np.isnan(report.regret):
        return []
    best = human(perfect.value, perfect.unit)
    plain = not figure and report.decision.problem.weights is None and perfect.unit == "bit/s"
    lost = report.goodput_regret if plain else report.regret
    if abs(lost) < _NO_REGRET and not report.missed_users:
        return [words["regret_none"].format(perfect=best)]
    if objective.measure == "power":
        if report.regret < 0 and report.missed_users:
            return [words["saved"].format(perfect=best, cost=percent(-report.regret))]
        return [words["regret_min"].format(perfect=best, cost=percent(max(report.regret, 0.0)))]
    if not plain:
        return [
            words["regret_max"].format(
                figure=figure or words["value"], perfect=best, cost=percent(max(report.regret, 0.0))
            )
        ]
    return [
        words["regret_goodput"].format(
            perfect=best,
            goodput=human(achieved.goodput_bps, "bit/s"),
            cost=percent(report.goodput_regret),
            choice=percent(max(report.regret, 0.0)),
        )
    ]

"""A user's account in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.lexicon import Lexicon, paragraph, place, value_name
from wirelessagent.explain.prices import marginal_prices
from wirelessagent.explain.reasons import reason_in_words
from wirelessagent.explain.step_words import change_in_words
from wirelessagent.explain.users import PROMISE_BPS, Account, Loss, account, share
from wirelessagent.model.units import human, percent
from wirelessagent.telling.catalogue import called

_TIE_DB = 0.05
_KNOWN_DB = 0.1
_MOST_BUDGETS = 10.0
"""A bid of more than so many budgets tells nothing."""
_STEP_BPS = 100e3
_FACTOR = 1.0005

WORDS = Lexicon(
    english={
        "served": "{name} gets {rate} with {power} ({share} of all power) on {count} of {total} subcarriers.",
        "band": "With a probability of 90 % the true channel carries {low} to {high}.",
        "binds": "{due}, and no more is given; 100 kbit/s more would cost {price} at the margin.",
        "above": "{due}, and gets more because subcarriers go as a whole; 100 kbit/s more "
        "would cost {price} at the margin.",
        "due_promised": "It is promised {promised}",
        "due_asked": "{promised} is asked for it",
        "beyond": "{due}, which costs nothing, since it gets more anyway.",
        "resting": "{repaired} of its {entries} gains were not measured, among them those of {resting} of the {count} "
        "subcarriers that it uses.",
        "resting_none": "{repaired} of its {entries} gains were not measured, but it uses no subcarrier that rests on "
        "such a gain.",
        "measured": "All its gains were measured.",
        "left_out": "{name} gets nothing because the request leaves it out.",
        "included": "If it were served too it would get {rate} with {power}, and the {figure} would be {value} "
        "instead of {before} (solved anew).",
        "included_none": "With it the request could not be met: {reason}.",
        "nothing_decided": "{name} gets nothing because nobody does: {reason}.",
        "all_served": "All {users} users of the cell are in this request; what another one would bring depends on its "
        "channel, which is not known here.",
        "no_gain": "{name} gets nothing: there is no subcarrier that reaches it and that it may use.",
        "no_weight": "{name} gets nothing: its weight is 0, so its rate counts for nothing.",
        "no_promise": "{name} gets nothing: it is promised nothing, and the least power sends only what is promised.",
        "no_room": "{name} gets nothing: {places} subcarriers (or groups of them) cannot serve {users} users.",
        "outbid": "{name} gets nothing: on every subcarrier others make more of the power.",
        "behind": "It came closest on {place}, which went to {winner}: its gain there is {behind:.1f} dB too low.",
        "worths": "At the prices it is worth {bid} to {name} and {winning} to {winner}.",
        "tie": "On {place} it is level with {winner}, who got it (within {behind:.2g} dB): whole subcarriers "
        "cannot be shared.",
        "more": "At the prices it would bid more for {place} than {winner}, who got it: {bid} against {winning}. But "
        "whole subcarriers cannot be shared, and the allocation as a whole is better this way.",
        "bid": "{power} ({value})",
        "no_bid": "nothing",
        "gain_repaired": "Its gain there was not measured: by the repair it lies, with a probability of 90 %, "
        "within {low:+.1f} to {high:+.1f} dB of what was counted on, and is high enough to win "
        "with a probability of {chance}.",
        "gain_close": "Its gain there was not measured, but the repair knows it within 0.1 dB.",
        "gain_noisy": "Its gain there was measured with noise, and is high enough to win with a probability of "
        "{chance}.",
        "gain_measured": "Its gain there was measured.",
        "would_win": "Solved anew, it would get something if all its gains were {gain:.1f} dB higher{weight}.",
        "or_weight": ", or with {weight:.3g} times its weight",
        "only_weight": "Solved anew, it would get something with {weight:.3g} times its weight.",
        "promise": "A minimum rate of {rate} for it would take {count} of {total} subcarriers and {change}.",
        "promise_none": "A minimum rate of {rate} for it could not be met: {reason}.",
    },
    chinese={
        "served": "{name}得到 {rate}，功率 {power}（占总功率 {share}），占 {total} 个子载波中的 {count} 个。",
        "band": "真实信道以 90 % 的概率承载 {low} 至 {high}。",
        "binds": "{due}，不多给；边际上再多 100 kbit/s 的代价为 {price}。",
        "above": "{due}，因子载波只能整个分配而得到更多；边际上再多 100 kbit/s 的代价为 {price}。",
        "due_promised": "对它的承诺为 {promised}",
        "due_asked": "对它要求的是 {promised}",
        "beyond": "{due}，没有代价，因为它本来就得到更多。",
        "resting": "它的 {entries} 个增益中有 {repaired} 个没有测得；它所用的 {count} 个子载波中有 {resting} 个依赖"
        "这样的增益。",
        "resting_none": "它的 {entries} 个增益中有 {repaired} 个没有测得，但它所用的子载波都不依赖这样的增益。",
        "measured": "它的增益全部测得。",
        "left_out": "{name}没有得到任何速率，因为要求中不服务它。",
        "included": "如果也服务它，它会以 {power} 得到 {rate}，{figure}将为 {value}，而不是 {before}（重新求解）。",
        "included_none": "加上它则要求无法满足：{reason}。",
        "nothing_decided": "{name}没有得到任何速率，因为所有用户都没有：{reason}。",
        "all_served": "小区的 {users} 个用户都已在要求之中；再多一个用户会带来什么，取决于它的信道，这里无从知道。",
        "no_gain": "{name}没有得到任何速率：没有它可用且能到达它的子载波。",
        "no_weight": "{name}没有得到任何速率：它的权重为 0，速率不计入目标。",
        "no_promise": "{name}没有得到任何速率：没有对它的承诺，而功率最低时只发送承诺的部分。",
        "no_room": "{name}没有得到任何速率：{places} 个子载波（或子载波组）无法服务 {users} 个用户。",
        "outbid": "{name}没有得到任何速率：在每个子载波上，别的用户都能更好地利用功率。",
        "behind": "它最接近的是{place}，该处给了{winner}：它在那里的增益低 {behind:.1f} dB。",
        "worths": "按价格计，该处对{name}值 {bid}，对{winner}值 {winning}。",
        "tie": "在{place}上它与得到者{winner}持平（相差 {behind:.2g} dB 以内）：整个子载波不能共享。",
        "more": "按价格它对{place}的出价高于得到者{winner}：{bid} 对 {winning}。但整个子载波不能"
        "共享，整体上这样分配更好。",
        "bid": "{power}（{value}）",
        "no_bid": "0",
        "gain_repaired": "它在那里的增益没有测得：按修复结果，以 90 % 的概率在所计数值的 {low:+.1f} 至 {high:+.1f} "
        "dB 之内，高到足以胜出的概率为 {chance}。",
        "gain_close": "它在那里的增益没有测得，但修复结果的误差不超过 0.1 dB。",
        "gain_noisy": "它在那里的增益测得但有噪声，高到足以胜出的概率为 {chance}。",
        "gain_measured": "它在那里的增益是测得的。",
        "would_win": "重新求解表明：若其所有增益高 {gain:.1f} dB{weight}，它就会得到速率。",
        "or_weight": "，或权重为现在的 {weight:.3g} 倍",
        "only_weight": "重新求解表明：若权重为现在的 {weight:.3g} 倍，它就会得到速率。",
        "promise": "给它 {rate} 的最低速率会占用 {total} 个子载波中的 {count} 个，并且{change}。",
        "promise_none": "给它 {rate} 的最低速率无法满足：{reason}。",
    },
)


def user_answer(case: Case, found: Account, language: str) -> str:
    """What a user has and why, in a paragraph."""
    name = called(language, case.estimate.user_names[found.user])
    said = [_head(case, found, name, language)]
    if found.standing == "served":
        said += _served(case, found, language)
    if found.losses:
        said += _loss(case, found.losses[0], name, language)
    said += _would_win(found, language)
    said += _promise(case, found, language)
    return paragraph(said, language)


def share_answer(case: Case, user: int, language: str) -> str:
    """What a user has, in a few sentences."""
    found = share(case, user)
    said = [_head(case, found, called(language, case.estimate.user_names[user]), language)]
    return paragraph([*said, *(_served(case, found, language) if found.standing == "served" else [])], language)


def more_users_answer(case: Case, language: str) -> str:
    """What one more user would bring: the one of those left out with whom the value is best."""
    left = [int(user) for user in np.flatnonzero(~case.served)]
    if not left:
        return WORDS.say(language, "all_served", users=case.num_users)
    sign = 1.0 if case.objective.direction == "max" else -1.0
    accounts = [account(case, user) for user in left]
    met = [one for one in accounts if one.included is not None and one.included.is_usable]
    best = max(met, key=lambda one: sign * one.included.value if one.included else 0.0, default=accounts[0])
    return _head(case, best, called(language, case.estimate.user_names[best.user]), language)


def _head(case: Case, found: Account, name: str, language: str) -> str:
    decision = case.decision
    total = decision.total_power_w
    said = WORDS.say(
        language,
        found.standing,
        name=name,
        rate=human(found.rate_bps, "bit/s"),
        power=human(found.power_w, "W"),
        share=percent(found.power_w / total if total > 0 else 0.0),
        count=found.subcarriers,
        total=decision.owner.size,
        reason=reason_in_words(decision, language),
        places=case.form.start.size - 1,
        users=int(np.count_nonzero(case.form.weight > 0)),
    )
    if found.included is None:
        return said
    return paragraph([said, _included(case, found, language)], language)


def _included(case: Case, found: Account, language: str) -> str:
    included = found.included
    assert included is not None
    if not included.is_usable:
        return WORDS.say(language, "included_none", reason=reason_in_words(included, language))
    power = float(included.power_w[included.owner == found.user].sum())
    return WORDS.say(
        language,
        "included",
        rate=human(float(included.rate_bps[found.user]), "bit/s"),
        power=human(power, "W"),
        figure=value_name(case, language),
        value=human(included.value, included.unit),
        before=human(case.decision.value, case.decision.unit),
    )


def _served(case: Case, found: Account, language: str) -> list[str]:
    said: list[str] = []
    forecast, user = case.decision.forecast, found.user
    if forecast is not None and forecast.high_bps[user] > forecast.low_bps[user] * _FACTOR:
        low, high = (human(float(one[user]), "bit/s") for one in (forecast.low_bps, forecast.high_bps))
        said += [WORDS.say(language, "band", low=low, high=high)] if low != high else []
    if found.promised_bps > 0:
        price = abs(float(marginal_prices(case).rate[user])) * _STEP_BPS
        exactly = not found.rate_bps > found.promised_bps * _FACTOR
        key = ("binds" if exactly else "above") if price > 0 else "beyond"
        promised, cost = human(found.promised_bps, "bit/s"), human(price, case.decision.unit)
        due = WORDS.say(language, f"due_{case.problem.firmness}", promised=promised)
        said.append(WORDS.say(language, key, due=due, price=cost))
    key = "resting" if found.resting else "resting_none" if found.repaired else "measured"
    rest = {
        "repaired": found.repaired, "entries": found.entries, "resting": found.resting,
        "count": found.subcarriers,
    }  # fmt: skip
    return [*said, WORDS.say(language, key, **rest)]


def _loss(case: Case, loss: Loss, name: str, language: str) -> list[str]:
    key = "tie" if abs(loss.behind_db) < _TIE_DB else "behind" if loss.behind_db > 0 else "more"
    names = {
        "name": name,
        "place": place(loss.first, loss.last, language),
        "winner": called(language, case.estimate.user_names[loss.winner]),
        "bid": _bid(case, loss.bid_w, loss.bid_value, language),
        "winning": _bid(case, loss.winning_bid_w, loss.winning_bid_value, language),
    }
    said = [WORDS.say(language, key, behind=abs(loss.behind_db), **names)]
    if key != "behind":
        return said
    if loss.winning_bid_w <= _MOST_BUDGETS * case.problem.budget_w(case.cell):  # else power is next to free
        said.append(WORDS.say(language, "worths", **names))
    if np.isnan(loss.chance):
        return [*said, WORDS.say(language, "gain_measured")]
    if loss.repaired and max(abs(loss.low_db), abs(loss.high_db)) < _KNOWN_DB:
        return [*said, WORDS.say(language, "gain_close")]
    kind = "gain_repaired" if loss.repaired else "gain_noisy"
    chance = percent(loss.chance) if loss.chance > 0 else "< 0.1 %"
    return [*said, WORDS.say(language, kind, low=loss.low_db, high=loss.high_db, chance=chance)]


def _bid(case: Case, bid_w: float, value: float, language: str) -> str:
    if bid_w <= 0:
        return WORDS.say(language, "no_bid")
    power = human(bid_w, "W")
    return power if np.isnan(value) else WORDS.say(language, "bid", power=power, value=human(value, case.decision.unit))


def _would_win(found: Account, language: str) -> list[str]:
    gain, weight = found.winning_gain_db, found.winning_weight
    if np.isnan(gain):
        return [] if np.isnan(weight) else [WORDS.say(language, "only_weight", weight=weight)]
    also = "" if np.isnan(weight) else WORDS.say(language, "or_weight", weight=weight)
    return [WORDS.say(language, "would_win", gain=gain, weight=also)]


def _promise(case: Case, found: Account, language: str) -> list[str]:
    step = found.promise
    if step is None:
        return []
    rate = human(PROMISE_BPS, "bit/s")
    if not step.after.is_usable:
        return [WORDS.say(language, "promise_none", rate=rate, reason=reason_in_words(step.after, language))]
    count = int(((step.after.owner == found.user) & (step.after.power_w > 0)).sum())
    total, change = step.after.owner.size, change_in_words(case, step, language)
    return [WORDS.say(language, "promise", rate=rate, count=count, total=total, change=change)]

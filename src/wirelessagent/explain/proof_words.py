"""Prices, the certificate, and how sure a decision is, in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.explain.case import Case
from wirelessagent.explain.certainty import Certainty, certainty
from wirelessagent.explain.contested import Contested
from wirelessagent.explain.lexicon import Lexicon, listed, paragraph, place, value_name
from wirelessagent.explain.prices import MarginalPrices, marginal_prices
from wirelessagent.explain.proof import Certificate, basis, certificate
from wirelessagent.explain.reasons import reason_in_words
from wirelessagent.explain.table import Table
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import called

_STEP_BPS = 100e3
_SHOWN_DB, _SHOWN_COST = 0.005, 1e-6
"""A contest of less margin that costs no larger share of the value either way is none."""

WORDS = Lexicon(
    english={
        # prices
        "power": "One more watt would raise the {figure} by {price} at the margin; the budget of {budget} is used up.",
        "power_idle": "Power has no price: {spent} of the {budget} allowed are used, and more would change nothing.",
        "power_least": "The power itself is what is to be small: a larger budget than {budget} changes nothing.",
        "power_unknown": "The price of power is not known here.",
        "dearest": "The dearest promise is that to {user}: 100 kbit/s more would {direction} the {figure} by {price}.",
        "free": "No promise binds, so none has a price.",
        "up": "raise",
        "down": "lower",
        "slopes": "Prices are slopes of the bound: for small steps. Ask for a step, such as 'one more watt', to "
        "have it solved anew.",
        "promises": "Prices of promises",
        "user": "user",
        "promised": "promised",
        "gets": "gets",
        "price": "100 kbit/s more changes the value by",
        # certificate
        "closed_form": "Every subcarrier goes to the user that makes most of it, and one water level shares the "
        "power: that is the optimum in closed form, and the dual bound, worked out from prices "
        "alone, is the same {bound}.",
        "bound": "No allocation on the estimated channel is worth more than {bound}: at the prices of power and "
        "rates that were found nobody could make more of any subcarrier, and that holds for all "
        "allocations, searched or not.",
        "bound_least": "No allocation on the estimated channel does with less than {bound}: at the prices of the "
        "promised rates that were found nobody could make more of any subcarrier, and that holds "
        "for all allocations, searched or not.",
        "bound_outage": "No promises kept with {sure} are worth more than {bound}: it is proven on a channel that "
        "is better than any that such promises may count on.",
        "bound_outage_least": "No allocation keeps these promises with {sure} for less than {bound}: it is proven "
        "on a channel that is better than any that such promises may count on.",
        "rests_on_levels": "It rests on this alone: a higher rate is worth no less to {objective}.",
        "rests_on_law": "It rests on what {objective} declares a rate r to be worth, {law}, at every rate.",
        "rests_on_conjugate": "It rests on the conjugate that {objective} states, which speaks of all rates at once; "
        "no values of its utility were tried out.",
        "by_dual": "The method {method} proves nothing itself; the bound is that of the method dual.",
        "value": "This decision is worth {value}, so at most {left} ({gap}) could still be gained.",
        "value_least": "This decision takes {value}, so at most {left} ({gap}) could still be saved.",
        "reached": "This decision reaches it, so it is optimal.",
        "nothing": "The method {method} gives no bound, so how far this decision is from the best is not known.",
        "infeasible": "It is proven that the request cannot be met: {reason}.",
        "undecided": "Nothing was found that meets the request, and nothing proves that it cannot be met: {reason}.",
        "estimated": "The proof speaks of the channel as it was estimated; {repaired} of its {entries} gains were "
        "not measured.",
        # uncertainty
        "all_known": "Every gain was measured, and nothing here is uncertain.",
        "noisy": "Every gain was measured, {noisy} of {entries} of them not exactly.",
        "repaired": "{repaired} of {entries} gains were not measured ({share}); {method} filled them. {resting} of "
        "the {used} subcarriers in use rest on such a gain.",
        "rests_on_none": "So nothing that was decided is uncertain.",
        "unseen": "Nothing was measured of {names}: the level is a guess.",
        "band": "With a probability of 90 % the true channel carries {low} to {high} in all.",
        "promise": "Each promise is to be kept with {sure}; by draws that the decision did not see the least sure "
        "one, to {user}, is kept with {kept}.",
        "commitment": "Rates are committed so that most is expected to arrive; the least sure one, of {user}, is "
        "kept with {kept}. {missed:.2g} of {served} are expected to fail.",
        "asked": "Rates are asked for without a probability: the least sure one, for {user}, is kept with {kept}, and "
        "{missed:.2g} of {served} are expected to fail. An accepted outage, as in 'kept with 95 %', makes promises of "
        "them.",
        "widest": "The gain in use that is known least is that of {user} on {place}: within {low:+.2f} to "
        "{high:+.2f} dB of what was counted on (90 %).",
        # contests
        "contests": "Most contested subcarriers",
        "subcarrier": "subcarrier",
        "winner": "won by",
        "runner_up": "next",
        "margin": "margin",
        "other_way": "cost of giving it to the next",
        "not_met": "cannot be met",
    },
    chinese={
        "power": "边际上再多一瓦，{figure}提高 {price}；{budget} 的预算已用完。",
        "power_idle": "功率没有价格：允许的 {budget} 中用了 {spent}，再多也不会改变什么。",
        "power_least": "目标就是功率最小：预算高于 {budget} 不会改变什么。",
        "power_unknown": "这里不知道功率的价格。",
        "dearest": "最贵的是对{user}的承诺：再多 100 kbit/s 会使{figure}{direction} {price}。",
        "free": "没有起约束作用的承诺，因此都没有价格。",
        "up": "提高",
        "down": "降低",
        "slopes": "价格是界的斜率，只适用于微小变化。可以询问某一步（如“再多一瓦”），会重新求解。",
        "promises": "承诺的价格",
        "user": "用户",
        "promised": "承诺",
        "gets": "得到",
        "price": "再多 100 kbit/s 使目标值改变",
        "closed_form": "每个子载波给最能利用它的用户，以同一水位分配功率：这是闭式最优解，仅由价格算出的对偶界同为 "
        "{bound}。",
        "bound": "在估计信道上任何分配的价值都不超过 {bound}：按所得的功率与速率价格，没有用户能从任何子载波得到更"
        "多；这对所有分配成立，无论是否搜索过。",
        "bound_least": "在估计信道上任何分配都不会少于 {bound}：按所得的承诺速率价格，没有用户能从任何子载波得到更"
        "多；这对所有分配成立，无论是否搜索过。",
        "bound_outage": "以 {sure} 兑现的任何承诺，价值都不超过 {bound}：这是在一个比此类承诺所能依据的都好的信道上"
        "证明的。",
        "bound_outage_least": "任何分配以 {sure} 兑现这些承诺都不会少于 {bound}：这是在一个比此类承诺所能依据的都好"
        "的信道上证明的。",
        "rests_on_levels": "它只依据一点：对{objective}而言，更高的速率价值不会更低。",
        "rests_on_law": "它依据{objective}所声明的速率 r 的价值：{law}，对任何速率都成立。",
        "rests_on_conjugate": "它依据{objective}给出的共轭函数，该函数涵盖所有速率；没有对其效用取样。",
        "by_dual": "{method}本身不作证明；此界来自对偶法。",
        "value": "本方案的价值为 {value}，因此最多还能增加 {left}（{gap}）。",
        "value_least": "本方案需要 {value}，因此最多还能节省 {left}（{gap}）。",
        "reached": "本方案达到该界，因此是最优的。",
        "nothing": "{method}不提供界，因此与最优解的差距未知。",
        "infeasible": "已证明该要求无法满足：{reason}。",
        "undecided": "没有找到满足要求的分配，也没有证明它无法满足：{reason}。",
        "estimated": "该证明针对估计信道；其 {entries} 个增益中有 {repaired} 个没有测得。",
        "all_known": "所有增益都已测得，没有不确定的地方。",
        "noisy": "所有增益都已测得，但 {entries} 个中有 {noisy} 个不精确。",
        "repaired": "{entries} 个增益中有 {repaired} 个没有测得（{share}），由{method}填补。使用的 {used} 个子载"
        "波中有 {resting} 个依赖这样的增益。",
        "rests_on_none": "因此所决定的都没有不确定性。",
        "unseen": "没有测得{names}的任何增益：其水平只是猜测。",
        "band": "真实信道以 90 % 的概率总共承载 {low} 至 {high}。",
        "promise": "每个承诺应以 {sure} 兑现；按决策时未用的抽样，最没有把握的是对{user}的承诺，以 {kept} 兑现。",
        "commitment": "预定速率使预期到达的最多；最没有把握的是{user}的，以 {kept} 兑现。预计 {served} 个中有 "
        "{missed:.2g} 个落空。",
        "asked": "所要求的速率未指定概率：最没有把握的是{user}的，以 {kept} 兑现，预计 {served} 个中有 "
        "{missed:.2g} 个落空。给定可靠性（如“以 95 % 兑现”）即成为承诺。",
        "widest": "使用中最不确定的增益是{user}在{place}上的：在所计数值的 {low:+.2f} 至 {high:+.2f} dB 之内（90 %）。",
        "contests": "竞争最激烈的子载波",
        "subcarrier": "子载波",
        "winner": "得到者",
        "runner_up": "其次",
        "margin": "领先",
        "other_way": "改给其次者的代价",
        "not_met": "无法满足",
    },
)


def prices_answer(case: Case, language: str) -> str:
    """The prices of power and of the dearest promise."""
    prices, figure = marginal_prices(case), value_name(case, language)
    said = [_power_price(case, prices, figure, language)]
    cost = np.abs(np.where(case.promised_bps > 0, prices.rate, 0.0))
    if np.nanmax(cost, initial=0.0) > 0:
        dearest = int(np.nanargmax(cost))
        price = human(float(cost[dearest]) * _STEP_BPS, case.decision.unit)
        direction = WORDS.say(language, "up" if prices.rate[dearest] > 0 else "down")
        user = called(language, case.estimate.user_names[dearest])
        said.append(WORDS.say(language, "dearest", user=user, direction=direction, figure=figure, price=price))
    elif case.promised_bps.any():
        said.append(WORDS.say(language, "free"))
    return paragraph([*said, WORDS.say(language, "slopes")], language)


def prices_table(case: Case, language: str) -> Table | None:
    """What 100 kbit/s more would cost for each user with a promise; None where nobody has one."""
    users = np.flatnonzero(case.promised_bps > 0)
    if not users.size:
        return None
    rate, unit = marginal_prices(case).rate, case.decision.unit
    rows = tuple(
        (
            called(language, case.estimate.user_names[user]),
            human(float(case.promised_bps[user]), "bit/s"),
            human(float(case.decision.rate_bps[user]), "bit/s"),
            human(float(rate[user]) * _STEP_BPS, unit),
        )
        for user in users.tolist()
    )
    columns = tuple(WORDS.say(language, key) for key in ("user", "promised", "gets", "price"))
    return Table(title=WORDS.say(language, "promises"), columns=columns, rows=rows)


def _power_price(case: Case, prices: MarginalPrices, figure: str, language: str) -> str:
    budget, spent = human(case.problem.budget_w(case.cell), "W"), human(case.decision.total_power_w, "W")
    if case.objective.measure == "power":
        return WORDS.say(language, "power_least", budget=budget)
    if np.isnan(prices.power):
        return WORDS.say(language, "power_unknown")
    if prices.power > 0 and prices.binds:
        price = human(prices.power, case.decision.unit)
        return WORDS.say(language, "power", figure=figure, price=price, budget=budget)
    return WORDS.say(language, "power_idle", spent=spent, budget=budget)


def certificate_answer(case: Case, language: str) -> str:
    """What is proven, how, and what it leaves open."""
    decision, found = case.decision, certificate(case)
    if found.proof in ("nothing", "infeasible", "undecided"):
        return WORDS.say(
            language, found.proof, method=called(language, decision.method), reason=reason_in_words(decision, language)
        )
    said = [_bound(case, found, language), _left(case, found, language)]
    repaired, entries = int(case.estimate.repaired.sum()), case.estimate.repaired.size
    if repaired:
        said.append(WORDS.say(language, "estimated", repaired=repaired, entries=entries))
    return paragraph(said, language)


def _bound(case: Case, found: Certificate, language: str) -> str:
    bound, outage = human(found.bound, case.decision.unit), case.problem.outage_probability
    if found.proof == "closed_form":
        return WORDS.say(language, "closed_form", bound=bound)
    unsure = "_outage" if outage is not None and case.decision.expected_rate_bps.size else ""
    least = "_least" if case.objective.direction == "min" else ""
    said = [WORDS.say(language, f"bound{unsure}{least}", bound=bound, sure=reliability(outage or 0.0))]
    said.append(rests_on(case.objective, language))
    if found.by != case.decision.method:
        said.append(WORDS.say(language, "by_dual", method=called(language, case.decision.method)))
    return paragraph(said, language)


def rests_on(objective: Objective, language: str) -> str:
    """What of the objective the bound rests on; empty where it is the promised rates alone."""
    on = basis(objective)
    if on == "promises":
        return ""
    alpha = objective.power_law() or 0.0
    law = {0.0: "r", 1.0: "ln r"}.get(alpha, f"r^(1 − α)/(1 − α) with α = {alpha:g}")
    return WORDS.say(language, f"rests_on_{on}", objective=called(language, objective.name), law=law)


def _left(case: Case, found: Certificate, language: str) -> str:
    if case.decision.status == "optimal" or found.gap <= 0:
        return WORDS.say(language, "reached")
    unit = case.decision.unit
    value, left = human(case.decision.value, unit), human(found.left, unit)
    key = "value_least" if case.objective.direction == "min" else "value"
    return WORDS.say(language, key, value=value, left=left, gap=percent(found.gap))


def uncertainty_answer(case: Case, language: str) -> str:
    """What was missing, what it was repaired by, and how sure the decision is."""
    found, names = certainty(case), case.estimate.user_names
    if not found.repaired and not found.noisy:
        return WORDS.say(language, "all_known")
    share = percent(found.repaired / found.entries)
    figures = {
        "repaired": found.repaired,
        "entries": found.entries,
        "noisy": found.noisy,
        "method": called(language, found.method),
    }
    key = "repaired" if found.repaired else "noisy"
    said = [WORDS.say(language, key, **figures, share=share, resting=found.resting, used=found.used)]
    if found.unseen:
        said.append(WORDS.say(language, "unseen", names=listed([names[user] for user in found.unseen], language)))
    if case.decision.is_usable and found.least_sure is None:
        said.append(WORDS.say(language, "rests_on_none"))
    return paragraph([*said, *_sure(case, found, language)], language)


def _sure(case: Case, found: Certainty, language: str) -> list[str]:
    """How sure the rates are, and the gain that is known least."""
    if found.least_sure is None or found.widest is None:
        return []
    names, outage = case.estimate.user_names, case.problem.outage_probability
    user, subcarrier = found.widest
    low, high = human(found.low_bps, "bit/s"), human(found.high_bps, "bit/s")
    kept, least_sure = f"{100 * found.least_kept:.3g} %", called(language, names[found.least_sure])
    served = int((case.decision.committed_bps > 0).sum())
    firm = "asked" if case.problem.promises_rates else "commitment"
    key = firm if outage is None else "promise"
    return [
        WORDS.say(language, "band", low=low, high=high) if low != high else "",
        WORDS.say(
            language, key, user=least_sure, kept=kept, missed=found.expected_missed, served=served,
            sure=reliability(outage or 0.0),
        ),
        WORDS.say(
            language, "widest", user=called(language, names[user]), place=place(subcarrier, subcarrier, language),
            low=found.widest_low_db, high=found.widest_high_db,
        ),
    ]  # fmt: skip


def contested_table(case: Case, found: list[Contested], language: str) -> Table | None:
    """Who won the most contested subcarriers, and by how much; None where nothing was contested."""
    names, unit = case.estimate.user_names, case.decision.unit
    least = _SHOWN_COST * abs(case.decision.value)
    found = [one for one in found if np.isnan(one.cost) or one.cost > least or abs(one.contest.margin_db) >= _SHOWN_DB]
    rows = tuple(
        (
            f"{one.first + 1}" if one.first == one.last else f"{one.first + 1}–{one.last + 1}",
            called(language, names[one.contest.winner]),
            called(language, names[one.contest.runner_up]),
            f"{one.contest.margin_db:.2g} dB" if abs(one.contest.margin_db) >= _SHOWN_DB else "0 dB",
            WORDS.say(language, "not_met") if np.isnan(one.cost) else human(one.cost, unit),
        )
        for one in found
    )
    columns = tuple(
        WORDS.say(language, key) for key in ("subcarrier", "winner", "runner_up", "margin", "other_way")
    )  # fmt: skip
    return Table(title=WORDS.say(language, "contests"), columns=columns, rows=rows) if rows else None

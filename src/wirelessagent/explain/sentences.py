"""The sentences that explain a decision, in English and Chinese, with places for their figures."""

from __future__ import annotations

from collections.abc import Mapping

_ENGLISH: Mapping[str, str] = {
    "language": "en",
    "sentence": "{said}.",
    "allocation": "{used} of {total} subcarriers serve {served} of {users} users with {power} of the {budget} allowed.",
    "optimal": "This is the optimum on the estimated channel: the bound proves that nothing does better.",
    "gap": "Nothing on the estimated channel does better than {bound}; this decision is within {gap} of that.",
    "outage_optimal": "No promises at this probability do better, by what is known here: the bound proves it.",
    "outage_gap": "No promises at this probability, by what is known of the channel, do better than {bound}; this "
    "decision is within {gap} of that, part of which is what not knowing costs.",
    "outage": "Each promised rate is kept with a probability of {sure}, by the joint posterior of the gains that it "
    "rests on; {promised} are promised in all.",
    "times": "Nothing on the estimated channel does better than {bound}; this decision is {times:.3g} times that.",
    "zero_bound": "A value of zero is not ruled out, so how far this is from the best is not known.",
    "no_bound": "The method {method} gives no bound, so how far this is from the best is not known.",
    "infeasible": "This cannot be done, and that is proven: {reason}.",
    "undecided": "No allocation was found that does this, and no proof that there is none: {reason}.",
    "figure": "The users' {figure} is to be as large as can be; it is {value}.",
    "weights": "Users' rates count by their weights, from {least:g} to {most:g}.",
    "shares": "Users are to get rates in proportion to their weights, from {least:g} to {most:g}; the {figure} is "
    "per unit of weight.",
    "cannot_serve": "{left} of {users} users cannot be served",
    "cannot_serve_places": "{left} of {users} users cannot be served: there are only {places} {kind}",
    "subcarriers": "subcarriers",
    "groups_of": "resource-block groups",
    "starved": "{names} cannot be given any rate here, and that makes the {figure} zero.",
    "power_max": "One more watt would buy about {price} at the margin.",
    "power_figure": "One more watt would raise the {figure} by about {price} at the margin.",
    "rate_price": "{step} more for {user} would cost about {price} at the margin, the dearest of all.",
    "rate_figure": "{step} more promised to {user} would lower the {figure} by about {price} at the margin, "
    "the dearest of all.",
    "idle_one": "Nothing for {names}, who is {margin:.1f} dB behind the winner on its best subcarrier.",
    "groups": "Assigning subcarriers in groups of {size} costs at most {cost} of the {figure}: one by one, "
    "nothing does better than {bound}.",
    "idle": "Nothing for {names}; the closest, {closest}, is {margin:.1f} dB behind the winner on its best subcarrier.",
    "repaired": "Repaired by {method}: {missing} of {entries} gains; "
    "{resting} of the {used} subcarriers in use rest on a repaired gain.",
    "forecast": "The true channel is expected to carry {mean} in all, with a probability of 90 % from {low} to {high}.",
    "forecast_sure": "The true channel is expected to carry {mean} in all.",
    "commitment": "{committed} of it are committed, so that the most is expected to arrive: each user's rate is kept "
    "with a probability of at least {sure}.",
    "asked": "Rates are asked for without a probability: the least sure one, {rate} for {name}, is kept with {sure}.",
    "asked_unsure": "Rates are asked for without a probability: the least sure one, {rate} for {name}, is kept with "
    "{sure} only; an outage probability makes promises of them.",
    "regret_max": "With every gain known the {figure} would have been {perfect}: not knowing cost {cost}.",
    "regret_none": "With every gain known it would have been the same, {perfect}.",
    "regret_goodput": "With every gain known {perfect} would have arrived, and {goodput} did: not knowing cost {cost}, "
    "{choice} of it by the choice of users and powers and the rest by the rates committed.",
    "regret_min": "With every gain known the same rates would have taken {perfect}: not knowing cost {cost} more.",
    "saved": "With every gain known the same rates would have taken {perfect}: this took {cost} less, and fell short.",
    "guessed": "No gain of {names} was observed: their level is a guess, and so is what rests on it.",
    "no_promise": "No rate is promised to anybody, so nothing has to be sent; a minimum rate would change that.",
    "complete": "No gain was missing, so nothing was repaired.",
    "kept_promised": "On the true channel every promised rate was kept.",
    "kept_asked": "On the true channel every rate asked for was reached.",
    "kept_committed": "On the true channel every committed rate was kept.",
    "missed_promised": "On the true channel {names} fell short of the promised rate, by up to {short}.",
    "missed_asked": "On the true channel {names} fell short of the rate asked for, by up to {short}.",
    "missed_committed": "On the true channel {names} fell short of the committed rate, by up to {short}.",
    "value": "value",
    "comma": ", ",
}

_CHINESE: Mapping[str, str] = {
    "language": "zh",
    "sentence": "{said}。",
    "allocation": "{total} 个子载波中使用了 {used} 个，"
    "服务 {users} 个用户中的 {served} 个，功率 {power}（上限 {budget}）。",
    "optimal": "这是估计信道上的最优解：对偶界证明没有更好的分配。",
    "gap": "在估计信道上任何分配都不会优于 {bound}；本方案与该界相差不超过 {gap}。",
    "outage_optimal": "在对信道已有的了解下，以此概率作出的任何承诺都不会更优：对偶界已证明。",
    "outage_gap": "在对信道已有的了解下，以此概率作出的任何承诺都不会优于 {bound}；本方案与该界相差不超过 {gap}，"
    "其中一部分是信道不确定的代价。",
    "outage": "按所依据增益的联合后验分布，每个承诺速率以 {sure} 的概率兑现；承诺总和为 {promised}。",
    "times": "在估计信道上任何分配都不会优于 {bound}；本方案是该界的 {times:.3g} 倍。",
    "zero_bound": "尚不能排除零值，因此与最优解的差距未知。",
    "no_bound": "{method}不提供界，因此与最优解的差距未知。",
    "infeasible": "该要求无法满足，并且已被证明：{reason}。",
    "undecided": "没有找到满足要求的分配，也没有证明它不存在：{reason}。",
    "figure": "目标是各用户的{figure}尽可能大，现为 {value}。",
    "weights": "各用户的速率按权重计，权重从 {least:g} 到 {most:g}。",
    "shares": "各用户的速率应与其权重成正比，权重从 {least:g} 到 {most:g}；{figure}按单位权重计。",
    "cannot_serve": "{users} 个用户中有 {left} 个无法服务",
    "cannot_serve_places": "{users} 个用户中有 {left} 个无法服务：只有 {places} 个{kind}",
    "subcarriers": "子载波",
    "groups_of": "子载波组",
    "starved": "这里无法给{names}任何速率，因此{figure}为零。",
    "power_max": "边际上每增加一瓦约可换来 {price}。",
    "power_figure": "边际上每增加一瓦，{figure}约提高 {price}。",
    "rate_price": "边际上给{user}再增加 {step} 约需 {price}，是所有用户中最贵的。",
    "rate_figure": "边际上向{user}多承诺 {step}，{figure}约降低 {price}，是所有用户中最贵的。",
    "idle_one": "{names}没有分到子载波，在其最好的子载波上比胜者低 {margin:.1f} dB。",
    "groups": "以 {size} 个子载波为一组分配，{figure}的损失最多为 {cost}：逐个分配时任何方案都不会优于 {bound}。",
    "idle": "{names}没有分到子载波；其中最接近的{closest}在其最好的子载波上仍比胜者低 {margin:.1f} dB。",
    "repaired": "{entries} 个增益中缺失 {missing} 个，由{method}修复；"
    "使用的 {used} 个子载波中有 {resting} 个依赖修复值。",
    "forecast": "真实信道预计总共承载 {mean}，以 90 % 的概率在 {low} 到 {high} 之间。",
    "forecast_sure": "真实信道预计总共承载 {mean}。",
    "commitment": "其中预定 {committed}，使预期送达的最多：每个用户的速率至少以 {sure} 的概率兑现。",
    "asked": "所要求的速率未指定概率：最没有把握的是{name}的 {rate}，以 {sure} 的概率兑现。",
    "asked_unsure": "所要求的速率未指定概率：最没有把握的是{name}的 {rate}，仅以 {sure} 的概率兑现；"
    "给出中断概率即成为承诺。",
    "regret_max": "若增益全部已知，{figure}为 {perfect}：信道未知的代价为 {cost}。",
    "regret_none": "即使增益全部已知，结果也一样，为 {perfect}。",
    "regret_goodput": "若增益全部已知，可送达 {perfect}，实际送达 {goodput}：信道未知的代价为 {cost}，"
    "其中 {choice} 来自用户和功率的选择，其余来自预定的速率。",
    "regret_min": "若增益全部已知，同样的速率需 {perfect}：信道未知的代价是多用 {cost}。",
    "saved": "若增益全部已知，同样的速率需 {perfect}；本方案少用 {cost}，但未全部达到。",
    "guessed": "没有观测到{names}的任何增益：其水平只是猜测，依赖它的也是。",
    "no_promise": "没有向任何用户承诺速率，因此无需发送；给出最低速率即可改变这一点。",
    "complete": "没有缺失的增益，因此无需修复。",
    "kept_promised": "在真实信道上，所有承诺速率都已兑现。",
    "kept_asked": "在真实信道上，所要求的速率都已达到。",
    "kept_committed": "在真实信道上，所有预定速率都已兑现。",
    "missed_promised": "在真实信道上{names}未达到承诺速率，最多少 {short}。",
    "missed_asked": "在真实信道上{names}未达到所要求的速率，最多少 {short}。",
    "missed_committed": "在真实信道上{names}未达到预定速率，最多少 {short}。",
    "value": "目标值",
    "comma": "、",
}


def sentences(language: str) -> Mapping[str, str]:
    """The sentences by name, in Chinese ("zh") or English."""
    return _CHINESE if language == "zh" else _ENGLISH

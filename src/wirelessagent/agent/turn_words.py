"""What the agent says about turns of the conversation itself, in English and Chinese."""

from __future__ import annotations

from collections.abc import Mapping

_ENGLISH: Mapping[str, str] = {
    "nothing_to_cancel": "Nothing waits that could be cancelled. Say 'undo' to take back the last change, or 'start "
    "over' to forget what is asked for. Which one?",
    "question_dropped": "The question is dropped; nothing was changed.",
    "asked_for": "Asked for: {request}",
    "nothing_asked": "Nothing is asked for now.",
    "undone_fewer": "All {count} changes are taken back; there were no more.",
    "asked_but_taken_back": "So what is asked for is not in effect; figures shown are of what was taken back.",
    "breaks_what_holds": "What was in effect then, {power}, breaks its limits, so what is in effect now stays.",
    "back_to_turn": "As in turn {number:g}.",
    "no_turn": "There is no turn {number}; there are turns 1 to {last}.",
    "no_turn_but_one": "There is no turn {number}; there is only turn 1.",
    "no_turns": "There is no turn {number}: nothing was said yet.",
    "turn_without_request": "Nothing was asked for in turn {number}; 'start over' forgets what is asked for now.",
    "turn_without_decision": "Nothing was decided in turn {number}.",
    "compared_turn": "Beside {turn}: {line}.",
    "compared_with_itself": "The decision that holds is that of {turn}; name another turn to compare it with.",
    "limits_stay": "The limits stay as they were.",
    "in_effect": "Of what is in effect, as the last request cannot be met: {answer}",
    "not_nothing": "{user} is not without anything.",
    "not_least": "{user} does not get the least. {who}",
    "not_most": "{user} does not get the most. {who}",
    "dearest": "Nobody has to be left out: what is asked for is met. {user} takes the most power for its rate: {power} "
    "for {rate}.",
    "channel_given": "The channel is as it was sensed, and its noise and bandwidth as they were set up. What else "
    "should be different: a power, a rate, the users, the aim, or what is missing?",
    "as_before": "As before: {limits}.",
    "no_longer": "No longer: {limits}.",
    "kept_as_it_is": "All stays as it is.",
    "which_way": "That cannot be met as asked. Which of the ways that can: say its figure, or whom to leave out.",
    "promised_and_left_out": "{user} can't be promised {rate} and be left out at once. Which of the two should hold? "
    "To give the promise up, say '{user} needs no minimum rate'.",
    "plan_or_what_if": "The plan still waits: 'yes' applies {request}; 'do that' takes the what-if instead.",
    "between": ", ",
    "by_method": "by the method {method}",
    "column": "{name}: {outcome}.",
    "because": " ({reason})",
    "budget_unused": "A budget of {budget} changes nothing: only {spent} is used.",
    "solved_by": "Solved by {method} instead.",
    "method_in_use": "In use: {method}.",
    "able": "For this there are: {methods}.",
    "every_user": "each of the {count} users",
    "most_promised": "At most {rate} for {who} with {power}, kept with {sure}, solved for this.",
    "most_proven": "No promises do better than {bound}: that is proven (gap {gap}).",
    "needs": "That takes {power} of radiated power; less than {least} is proven to be too little.",
    "needs_exactly": "That takes {power} of radiated power, and not less: that is proven.",
    "needs_more": "The cell radiates at most {limit}.",
    "needs_too_much": "No power is enough: {reason}.",
    "needs_nothing": "No rates are promised, so nothing needs any power: the power serves the aim alone.",
    "needed_enough": "So {enough} is not needed: {power} is enough.",
    "enough_enough": "So {enough} is enough.",
    "not_enough": "So {enough} is not enough.",
    "perhaps_enough": "Whether {enough} is enough is not known.",
    "no_duration": "How long it took is not recorded, so that a replay is the same everywhere; {method} did it.",
    "beside_now": "With it: {then}. Now: {now}.",
    "beside_figures": "total rate {total}, lowest rate {lowest}, {power} radiated",
    "plan_still_waits": "The plan still waits: 'yes' applies {request}.",
    "shall_i_apply": "Nothing is applied yet. What waits is {request}. Shall I apply it, yes or no?",
    "left_waiting": "Nothing is applied. What goes on waiting is {request}. 'yes' applies it, 'no' drops it.",
    "plan_dropped": "The plan is dropped.",
}

_CHINESE: Mapping[str, str] = {
    "nothing_to_cancel": "没有可取消的计划或问题。说“撤销”可撤回上一次改动，说“重新开始”可清除要求。要哪一个？",
    "question_dropped": "问题已取消，没有任何更改。",
    "asked_for": "要求：{request}",
    "nothing_asked": "现在没有任何要求。",
    "undone_fewer": "全部 {count} 次改动均已撤销，没有更多。",
    "asked_but_taken_back": "因此所要求的尚未生效；所示数据属于被撤回的分配。",
    "breaks_what_holds": "当时生效的分配（{power}）超出其限制，因此现行分配保持不变。",
    "back_to_turn": "同第 {number:g} 轮。",
    "no_turn": "没有第 {number} 轮；现有第 1 至 {last} 轮。",
    "no_turn_but_one": "没有第 {number} 轮；只有第 1 轮。",
    "no_turns": "没有第 {number} 轮：还没有对话。",
    "turn_without_request": "第 {number} 轮时没有任何要求；说“重新开始”可清除现在的要求。",
    "turn_without_decision": "第 {number} 轮没有作出决定。",
    "compared_turn": "与{turn}比较：{line}。",
    "compared_with_itself": "现行的决定就是{turn}的决定；请说明与哪一轮比较。",
    "limits_stay": "原有限制保持不变。",
    "in_effect": "上一个要求无法满足，以下是正在生效的分配：{answer}",
    "not_nothing": "{user}并非什么都没有。",
    "not_least": "{user}得到的并不是最少的。{who}",
    "not_most": "{user}得到的并不是最多的。{who}",
    "dearest": "不必放弃任何用户：要求已经满足。按速率计，{user}用的功率最多：{power} 换来 {rate}。",
    "channel_given": "信道以测得的为准，噪声和带宽以设定的为准。"
    "还要假设什么不同：功率、速率、用户、目标，还是缺失的比例？",
    "as_before": "仍然有效：{limits}。",
    "no_longer": "不再要求：{limits}。",
    "kept_as_it_is": "一切保持不变。",
    "which_way": "所要求的无法满足。要哪一种可以满足的方案？请说出其数值，或不服务哪个用户。",
    "promised_and_left_out": "不能既向{user}承诺 {rate} 又不服务它。以哪一个为准？"
    "要放弃承诺，请说“取消{user}的最低速率”。",
    "plan_or_what_if": "原计划仍在等待：说“是”即应用{request}；说“就这么办”则改用这个假设。",
    "between": "，",
    "by_method": "用{method}求解",
    "column": "{name}：{outcome}。",
    "because": "（{reason}）",
    "budget_unused": "{budget} 的预算不会改变什么：只用了 {spent}。",
    "solved_by": "改由{method}求解。",
    "method_in_use": "正在使用：{method}。",
    "able": "可用的方法：{methods}。",
    "every_user": "这 {count} 个用户每人",
    "most_promised": "以 {power} 最多可向{who}保证 {rate}，以 {sure} 的概率兑现（为此重新求解）。",
    "most_proven": "任何承诺都不会优于 {bound}：这已被证明（差距 {gap}）。",
    "needs": "这需要 {power} 的发射功率；已证明少于 {least} 不够。",
    "needs_exactly": "这需要 {power} 的发射功率，已证明不能更少。",
    "needs_more": "小区最多发射 {limit}。",
    "needs_too_much": "多大功率都不够：{reason}。",
    "needs_nothing": "没有承诺任何速率，因此不需要任何功率：功率只为目标服务。",
    "needed_enough": "所以不需要 {enough}：{power} 就够了。",
    "enough_enough": "所以 {enough} 够了。",
    "not_enough": "所以 {enough} 不够。",
    "perhaps_enough": "{enough} 是否够，尚不清楚。",
    "no_duration": "没有记录用了多久，这样重放处处相同；求解用的是{method}。",
    "beside_now": "这样：{then}。现在：{now}。",
    "beside_figures": "总速率 {total}，最低速率 {lowest}，发射 {power}",
    "plan_still_waits": "原计划仍在等待：说“是”即应用{request}。",
    "shall_i_apply": "尚未应用。等待确认的是{request}。是否应用？（是／否）",
    "left_waiting": "尚未应用。继续等待确认的是{request}。说“是”即应用，说“否”即放弃。",
    "plan_dropped": "该计划已放弃。",
}


def told(language: str, key: str, **names: object) -> str:
    """The sentence of this key in the operator's language, with its names filled in."""
    return (_CHINESE if language == "zh" else _ENGLISH)[key].format(**names)


def all_turn_words() -> tuple[Mapping[str, str], Mapping[str, str]]:
    """The sentences in both languages, which must speak of the same things."""
    return _ENGLISH, _CHINESE

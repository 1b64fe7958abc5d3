"""What the operator reads, in English and Chinese: restatements with figures and units, and specific questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language.intent import Constraint
from wirelessagent.language.restating import limits_in_words, users_in_words
from wirelessagent.telling.catalogue import has_message, message

_DROPPED = {
    "en": {
        "max_power_w": "the power limit", "min_rate_bps": "the minimum rate", "max_rate_bps": "the rate cap",
        "circuit_power_w": "the circuit power", "outage_probability": "the outage limit", "weights": "the weights",
        "users": "the choice of "
            "users", "leave_out": "leaving users out", "subcarrier_max_power_w": "the subcarrier cap",
        "resource_block_group_size": "the groups of subcarriers",
    },
    "zh": {
        "max_power_w": "功率上限", "min_rate_bps": "最低速率", "max_rate_bps": "速率上限",
        "circuit_power_w": "电路功率",
        "outage_probability": "中断概率", "weights": "权重", "users": "用户选择", "leave_out": "排除的用户",
        "subcarrier_max_power_w": "子载波功率上限", "resource_block_group_size": "子载波分组",
    },
}  # fmt: skip

_SENTENCES: dict[str, dict[str, str]] = {
    "en": {
        "restated": "{goal}{constraints}.",
        "not_used": " ({text} is taken from the channel itself.)",
        "aim": "What should the cell aim for: {choices}?",
        "greeting": "Hello. What should the cell aim for: {choices}?",
        "empty": "Nothing was said. What should the cell aim for: {choices}?",
        "unclear": "I am not sure what you want. What should the cell aim for: {choices}?",
        "weak": "Did you mean {goal}, or rather {choices}?",
        "negated": "Understood what not to do. What should the cell aim for instead: {choices}?",
        "contradiction": (
            "You asked for {both}, which pull against each other. Which comes first, or do you want the compromise "
            "between them, the energy efficiency: {choices}?"
        ),
        "rivals": "You asked for {both} at once. Which one should it be: {choices}?",
        "opposite": "I can't aim for {goal} as such. What should the cell aim for: {choices}?",
        "fairness": "Fair in which way: {both}?",
        "starving": (
            "How much should each user get at least, so that nobody goes without: say for example “{goal}, 500 kbit/s "
            "each”. Or should I share instead, as {both}?"
        ),
        "unsupported_with_goal": "I can't steer {text}. Shall I go on without it, for {goal} alone?",
        "unread": (
            "I can use plain figures with a unit: a power (W, dBm), a rate (bit/s, Mbit/s) or an outage (%). "
            "What is {text}?"
        ),
        "calculated": "I don't calculate with {text}. What does it come to: which single figure should I use?",
        "whose_power": "Is {text} the most that the cell may radiate, or something else?",
        "whose_rate": "Is {text} a rate that users should get, or something else?",
        "some_users": "Does {text} mean every user of the cell, or only some of them? Which ones: user 1, user 2, …?",
        "strange": "I can't steer {text}. What should the cell aim for: {choices}?",
        "limits_only": "With {constraints}: what should the cell aim for, {choices}?",
        "rate_only": (
            "With {constraints}: shall I find the least power that carries it, the highest total rate beyond it, or "
            "another aim ({choices})?"
        ),
        "too_long": "That is too long for one request. In a sentence or two: what should the cell aim for, {choices}?",
        "too_many_figures": "Those are more figures than I can use in one request. Please give at most {most}, "
            "and say what the cell should aim for: {choices}.",
        "impossible": "{text} is not possible here. Which positive and finite figure did you mean?",
        "huge": "{text} is millions of watts, more than any cell radiates. Did you mean milliwatts (mW), and how many?",
        "power_per_user": "I can limit the total power, not {text} per user. What should the total be, in W or dBm?",
        "power_floor": "I can't promise to radiate at least {text}. Did you mean at most {text}?",
        "change": "Is {text} the new limit, or the amount to change it by? If a change, what should the limit be?",
        "unit_missing": "{text} of what: W, mW or dBm of power, kbit/s or Mbit/s of rate, or %?",
        "not_understood": "I can't use the limit {text}. Can you give it as a power (W, dBm) or a rate (Mbit/s)?",
        "bits_or_bytes": "Is {text} megabits or megabytes: bits (Mbit/s) or bytes (MB/s, eight times as much)?",
        "share": "{text} of what? I can use an outage or a reliability; a limit needs W or bit/s: which is it?",
        "total_rate": "I can promise a rate to each user, not a total of {text}. How much should each user get?",
        "refused": "Not {text}, then. Which figure should it be instead?",
        "status": "Is {text} what users have now, or the rate that each should get at least?",
        "conflict": "You gave both {one} and {other} for the same thing. Which one should I use?",
        "rates_crossed": "At least {low} and at most {high} can't both hold. Which rates did you mean?",
        "named_user": "What about {text}: a rate, a weight, left out, or served alone? What should the cell aim "
            "for, {choices}?",
        "exact_power": "Exactly {text} and the least power don't go together. Did you mean at most {text}?",
        "no_rate_to_change": "There is no such rate to change yet. What should each user get, at least or at most?",
        "only_told": "Noted; nothing was changed. Should that hold from now on: {constraints}?",
        "welcome": "You're welcome.",
        "nothing_left_of_it": "That would leave nothing of it. What should the limit be?",
        "no_limit_of_its_own": "Nothing of that kind is promised to {users} or asked of them. What should change?",
        "not_promised": "{text} is not what holds for {users}. It stays: {constraints}. What should change?",
        "served_already": "All that is asked for serves {users} already. What should change?",
        "all_served": "Everyone is served already. What should change?",
        "what_changes": "I am not sure what should change. Say for example 'now with 5 W', 'leave user 3 out' or "
            "another aim.",
        "what_of_user": "What about {users}: a rate, a weight, left out, or served alone?",
        "who_is_back": "Who is back: {users}?",
        "whose_figure": "Whose is {text}: {users}?",
        "sentence": "{text}.",
        "no_longer": "without {text}",
        "question.why_user": "A question about why {user} got what they got.",
        "question.why_infeasible": "A question about why it cannot be done.",
        "question.certificate": "A question about how good the result is.",
        "question.uncertainty": "A question about what was missing and how sure the estimate is.",
        "question.what_if": "A what-if question; nothing is changed.",
        "question.step": "A question about what a little more would buy.",
        "question.prices": "A question about prices.",
        "question.users": "A question about the users.",
        "question.capabilities": "{help}",
        "question.concept": "A question about what a word means.",
        "question.other": "A question about the cell.",
        "command.apply": "Apply the plan.",
        "command.confirm": "Yes.",
        "command.reject": "No.",
        "command.undo": "Undo the last change.",
        "command.reset": "Start afresh.",
        "command.compare": "Compare the results.",
        "command.explain": "Explain the result.",
        "command.history": "Show what was asked before.",
        "command.status": "Show the state of the cell.",
        "command.help": "{help}",
        "command.export": "Export the result.",
        "nothing_yet": "There is no request yet that {text} would change. {offers}",
        "method_later": "Then name the method {name} again; it is not in use yet.",
        "unsure_command": "Did you mean: {text} Yes or no?",
        "unsure_question": "I am not sure whether that is a question or a request. What should the cell aim for: "
            "{choices}?",
        "help": "I allocate the subcarriers and the power of a cell. {offers}",
        "hello": "Hello. {offers}",
        "out_of_scope": "That is outside what I do: I allocate the subcarriers and the power of a cell. {offers}",
        "unsupported": "I can't steer {text}. {offers}",
        "offers": "You can ask for {choices}, with limits such as 10 W, 40 dBm or 1 Mbit/s each.",
        "restated_alone": "", "restated_limits": ": ", "or": " or ", "either": " or ", "comma": ", ", "and": " and ",
    },
    "zh": {
        "restated": "{goal}{constraints}。",
        "not_used": "（{text} 以实测信道为准。）",
        "aim": "小区应以什么为目标：{choices}？",
        "greeting": "你好。小区应以什么为目标：{choices}？",
        "empty": "没有内容。小区应以什么为目标：{choices}？",
        "unclear": "我不确定您的意思。小区应以什么为目标：{choices}？",
        "weak": "您是指{goal}，还是{choices}？",
        "negated": "明白不要什么了。那么应以什么为目标：{choices}？",
        "contradiction": "您要求{both}，两者相互矛盾。以哪个为先，还是取两者的折中即能效：{choices}？",
        "rivals": "您同时要求{both}。应以哪一个为目标：{choices}？",
        "opposite": "不能以{goal}本身为目标。应以什么为目标：{choices}？",
        "fairness": "怎样才算公平：{both}？",
        "starving": "为了不让任何人落空，每个用户至少多少？例如“{goal}，每人至少500 kbit/s”。还是改为分享：{both}？",
        "unsupported_with_goal": "我不能控制{text}。是否不考虑它，只求{goal}？",
        "unread": "{text} 指什么？可用带单位的数值：功率（W、dBm）、速率（bit/s）或中断概率（%），是哪个？",
        "calculated": "我不会用 {text} 做运算。结果应是哪个数值？",
        "whose_power": "{text} 是小区发射功率的上限，还是别的功率？",
        "whose_rate": "{text} 是用户应得的速率，还是别的速率？",
        "some_users": "{text} 是指小区的所有用户，还是只指其中一部分？是哪几个用户？",
        "strange": "我不能控制{text}。小区应以什么为目标：{choices}？",
        "limits_only": "在{constraints}的条件下，应以什么为目标：{choices}？",
        "rate_only": "在{constraints}的条件下，是用最低功率满足它，还是在此之上总速率最高，或其他目标（{choices}）？",
        "too_many_figures": "数字太多，一次请求用不了。请最多给出 {most} 个，并说明目标：{choices}。",
        "too_long": "内容太长。请用一两句话说明应以什么为目标：{choices}？",
        "impossible": "{text} 在这里不可能。您指的是哪个正的有限数值？",
        "huge": "{text} 是百万瓦级，没有小区能发射这么大功率。您是指毫瓦（mW）吗，多少？",
        "power_per_user": "我只能限制总功率，不能按每个用户 {text} 限制。总功率上限应为多少（W 或 dBm）？",
        "power_floor": "我不能保证至少发射 {text}。您是指不超过 {text} 吗？",
        "change": "{text} 是新的上限，还是变化量？如果是变化量，上限应为多少？",
        "unit_missing": "{text} 的单位是什么：功率 W、mW、dBm，速率 kbit/s、Mbit/s，还是 %？",
        "not_understood": "我无法使用限制 {text}。能否用功率（W、dBm）或速率（kbit/s、Mbit/s）表示？",
        "bits_or_bytes": "{text} 是比特（Mbit/s）还是字节（MB/s，八倍）？",
        "share": "{text} 指什么？我可以使用中断概率或可靠性；功率或速率的限制请用 W 或 bit/s，是哪个？",
        "total_rate": "我只能保证每个用户的速率，不能保证总共 {text}。每个用户应得多少？",
        "refused": "那就不用 {text}。应改为多少？",
        "status": "{text} 是现在的速率，还是每个用户至少应得的速率？",
        "conflict": "同一项给出了 {one} 和 {other} 两个数值。用哪一个？",
        "rates_crossed": "至少 {low} 与不超过 {high} 不能同时成立。您指的是哪些速率？",
        "named_user": "{text}要怎样：速率、权重、不服务，还是只服务它？小区应以什么为目标：{choices}？",
        "exact_power": "正好 {text} 与功率最低不能并存。您是指不超过 {text} 吗？",
        "no_rate_to_change": "目前没有可以更改的速率要求。每个用户的速率应是多少，至少还是不超过？",
        "only_told": "已知悉，没有任何更改。今后要求{constraints}吗？",
        "welcome": "不客气。",
        "nothing_left_of_it": "这样就什么都不剩了。限制应是多少？",
        "no_limit_of_its_own": "{users}没有这样的要求。应更改什么？",
        "not_promised": "{users}的要求不是 {text}。保持不变：{constraints}。应更改什么？",
        "served_already": "{users}已在服务之中。应更改什么？",
        "all_served": "所有用户都已在服务之中。应更改什么？",
        "what_changes": "我不确定要更改什么。例如说“改为 5 W”“不要用户3”，或另一个目标。",
        "what_of_user": "{users}要怎样：速率、权重、不服务，还是只服务它？",
        "who_is_back": "谁回来了：{users}？",
        "whose_figure": "{text} 是指哪个用户：{users}？",
        "sentence": "{text}。",
        "no_longer": "取消{text}",
        "question.why_user": "问{user}为何得到这样的结果。",
        "question.why_infeasible": "问为何做不到。",
        "question.certificate": "问结果有多好。",
        "question.uncertainty": "问缺了什么、估计有多可靠。",
        "question.what_if": "假设性的问题，不作任何改动。",
        "question.step": "问再多一点能换来什么。",
        "question.prices": "问代价。",
        "question.users": "问用户的情况。",
        "question.capabilities": "{help}",
        "question.concept": "问一个词的意思。",
        "question.other": "问小区的情况。",
        "command.apply": "应用该方案。",
        "command.confirm": "是。",
        "command.reject": "否。",
        "command.undo": "撤销上一次改动。",
        "command.reset": "重新开始。",
        "command.compare": "比较结果。",
        "command.explain": "解释结果。",
        "command.history": "显示之前的请求。",
        "command.status": "显示小区状态。",
        "command.help": "{help}",
        "command.export": "导出结果。",
        "nothing_yet": "还没有可以用{text}来修改的请求。{offers}",
        "method_later": "届时请再说一次方法{name}，它尚未启用。",
        "unsure_command": "您是指“{text}”吗？请回答是或否。",
        "unsure_question": "我不确定这是问题还是请求。小区应以什么为目标：{choices}？",
        "help": "我为小区分配子载波和功率。{offers}",
        "hello": "你好。{offers}",
        "out_of_scope": "这超出了我的范围：我为小区分配子载波和功率。{offers}",
        "unsupported": "我不能控制{text}。{offers}",
        "offers": "您可以要求{choices}，并附上限制，如 10 W、40 dBm 或每用户 1 Mbit/s。",
        "restated_alone": "", "restated_limits": "，", "or": "还是", "either": "或", "comma": "、", "and": "和",
    },
}  # fmt: skip


class Voice:
    """Sentences in one language, about the objectives that are on offer.

    Attributes:
        language: "en" or "zh"; any other falls back to English.
        labels: what each registered objective is called, in the order in which they are offered.
    """

    def __init__(self, language: str, labels: Mapping[str, str]) -> None:
        self.language = language if language in _SENTENCES else "en"
        self.labels = labels

    def say(self, key: str, **names: str) -> str:
        """The sentence of this key with its names filled in; {choices} and {offers} list what is on offer."""
        sentences = _SENTENCES[self.language]
        offers = sentences["offers"].format(choices=self.choices("either"))
        given = {"choices": self.choices(), "offers": offers, "help": sentences["help"].format(offers=offers)}
        return sentences[key].format(**(given | names))

    def ending(self, key: str, **names: str) -> str:
        """How the sentence of this key ends, behind the operator's own words in it."""
        return self.say(key, text="\0", **names).partition("\0")[2]

    def choices(self, last: str = "or", *, without: str = "") -> str:
        """The objectives on offer, "a, b or c"."""
        return self._listed([self.label(name) for name in self.labels if name != without], last)

    def label(self, objective: str) -> str:
        key = f"goal.{objective}"
        return message(self.language, key) if has_message(self.language, key) else self.labels.get(objective, objective)

    def both(self, objectives: Sequence[str], last: str = "and") -> str:
        return self._listed([self.label(name) for name in objectives], last)

    def constraints(self, values: Mapping[str, Constraint]) -> str:
        """The constraints with figures and units, "at least 1 Mbit/s for each user, at most 10 W …"."""
        return limits_in_words(values, self.language)

    def user(self, reference: str) -> str:
        """What to call a user: "user 3" for "3", "everyone else" for everybody who is not named."""
        return users_in_words((reference,), self.language)

    def users(self, references: Sequence[str]) -> str:
        """Several users in one list."""
        return users_in_words(references, self.language)

    def amended(self, values: Mapping[str, Constraint], dropped: Sequence[str]) -> str:
        """What changes in the current request, as one sentence."""
        gone = [_DROPPED[self.language][name] for name in dropped if name not in values]
        parts = [*([self.constraints(values)] if values else [])]
        if gone:
            parts.append(self.say("no_longer", text=self._listed(gone, "and")))
        said = _SENTENCES[self.language]["comma"].join(parts)
        return self.say("sentence", text=said[:1].upper() + said[1:])

    def restated(self, objective: str, values: Mapping[str, Constraint], not_used: Sequence[str]) -> str:
        """What was understood, as one sentence."""
        label = self.label(objective)
        limits = self.constraints(values)
        separator = _SENTENCES[self.language]["restated_limits" if limits else "restated_alone"]
        sentence = self.say("restated", goal=label[:1].upper() + label[1:], constraints=separator + limits)
        note = self.say("not_used", text=self._listed(list(not_used), "and")) if not_used else ""
        return sentence + note

    def _listed(self, items: Sequence[str], last: str) -> str:
        words = _SENTENCES[self.language]
        if len(items) < 2:
            return "".join(items)
        return words["comma"].join(items[:-1]) + words[last] + items[-1]

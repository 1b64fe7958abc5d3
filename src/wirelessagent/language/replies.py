"""What the operator reads, in English and Chinese: restatements with figures and units, and specific questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

GOALS: dict[str, dict[str, str]] = {
    "en": {
        "max_rate": "the highest total rate",
        "min_power": "the least power",
        "max_energy_efficiency": "the most bits per joule (energy efficiency)",
        "proportional_fairness": "a fair share for everyone (proportional fairness)",
        "max_min_rate": "the highest rate for the slowest user (max-min)",
        "less_fairness": "less fairness",
        "less_rate": "less rate",
        "more_power": "more power",
        "less_efficiency": "fewer bits per joule",
        "waste_power": "wasting power",
    },
    "zh": {
        "max_rate": "总速率最高",
        "min_power": "功率最低",
        "max_energy_efficiency": "能效最高（每焦耳比特数最多）",
        "proportional_fairness": "公平分配（比例公平）",
        "max_min_rate": "最慢用户的速率最高（最大最小公平）",
        "less_fairness": "降低公平性",
        "less_rate": "降低速率",
        "more_power": "增加功率",
        "less_efficiency": "降低能效",
        "waste_power": "浪费功率",
    },
}

_CONSTRAINTS: dict[str, dict[str, str]] = {
    "en": {
        "max_power_w": "at most {} of radiated power",
        "min_rate_bps": "at least {} for each user",
        "max_rate_bps": "at most {} for each user",
        "circuit_power_w": "{} of circuit power",
        "outage_probability": "an outage of at most {}",
    },
    "zh": {
        "max_power_w": "发射功率不超过 {}",
        "min_rate_bps": "每个用户至少 {}",
        "max_rate_bps": "每个用户不超过 {}",
        "circuit_power_w": "电路功率 {}",
        "outage_probability": "中断概率不超过 {}",
    },
}

_UNITS = {
    "max_power_w": "W",
    "min_rate_bps": "bit/s",
    "max_rate_bps": "bit/s",
    "circuit_power_w": "W",
    "outage_probability": "%",
}

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))

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
        "unsupported_with_goal": "I can't steer {text}. Shall I go on without it, for {goal} alone?",
        "unread": (
            "I can use plain figures with a unit: a power (W, dBm), a rate (bit/s, Mbit/s) or an outage (%). "
            "What is {text}?"
        ),
        "calculated": "I don't calculate with {text}. What does it come to: which single figure should I use?",
        "whose_power": "Is {text} the most that the cell may radiate, or something else?",
        "some_users": "Does {text} mean every user of the cell, or only some of them, which I can't treat apart yet?",
        "strange": "I can't steer {text}. What should the cell aim for: {choices}?",
        "limits_only": "With {constraints}: what should the cell aim for, {choices}?",
        "rate_only": (
            "With {constraints}: shall I find the least power that carries it, the highest total rate beyond it, or "
            "another aim ({choices})?"
        ),
        "too_long": "That is too long for one request. In a sentence or two: what should the cell aim for, {choices}?",
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
        "status": "Is {text} what users have now, or the rate that each should get at least?",
        "conflict": "You gave both {one} and {other} for the same thing. Which one should I use?",
        "rates_crossed": "At least {low} and at most {high} can't both hold. Which rates did you mean?",
        "named_user": "I can't treat {text} differently from the others yet. Shall I apply the request to all users?",
        "exact_power": "Exactly {text} and the least power don't go together. Did you mean at most {text}?",
        "question": "I carry out requests and can't answer questions yet; each result brings its figures. {offers}",
        "command": "There is no earlier allocation to work on: each request stands by itself. {offers}",
        "help": "I allocate the subcarriers and the power of a cell. {offers}",
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
        "unsupported_with_goal": "我不能控制{text}。是否不考虑它，只求{goal}？",
        "unread": "{text} 指什么？可用带单位的数值：功率（W、dBm）、速率（bit/s）或中断概率（%），是哪个？",
        "calculated": "我不会用 {text} 做运算。结果应是哪个数值？",
        "whose_power": "{text} 是小区发射功率的上限，还是别的功率？",
        "some_users": "{text} 是指小区的所有用户，还是只指其中一部分（暂不能单独对待）？",
        "strange": "我不能控制{text}。小区应以什么为目标：{choices}？",
        "limits_only": "在{constraints}的条件下，应以什么为目标：{choices}？",
        "rate_only": "在{constraints}的条件下，是用最低功率满足它，还是在此之上总速率最高，或其他目标（{choices}）？",
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
        "status": "{text} 是现在的速率，还是每个用户至少应得的速率？",
        "conflict": "同一项给出了 {one} 和 {other} 两个数值。用哪一个？",
        "rates_crossed": "至少 {low} 与不超过 {high} 不能同时成立。您指的是哪些速率？",
        "named_user": "暂时不能单独对待{text}。是否对所有用户执行该请求？",
        "exact_power": "正好 {text} 与功率最低不能并存。您是指不超过 {text} 吗？",
        "question": "我执行请求，暂不能回答问题；每个结果都附有数据。{offers}",
        "command": "这里没有可操作的先前分配：每个请求都是独立的。{offers}",
        "help": "我为小区分配子载波和功率。{offers}",
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
        return sentences[key].format(**({"choices": self.choices(), "offers": offers} | names))

    def choices(self, last: str = "or", *, without: str = "") -> str:
        """The objectives on offer, "a, b or c"."""
        return self._listed([self.label(name) for name in self.labels if name != without], last)

    def label(self, objective: str) -> str:
        return GOALS[self.language].get(objective) or self.labels.get(objective, objective)

    def both(self, objectives: Sequence[str], last: str = "and") -> str:
        return self._listed([self.label(name) for name in objectives], last)

    def constraints(self, values: Mapping[str, float]) -> str:
        """The constraints with figures and units, "at least 1 Mbit/s for each user, at most 10 W …"."""
        parts = [
            _CONSTRAINTS[self.language][name].format(_figure(value, _UNITS[name])) for name, value in values.items()
        ]
        return _SENTENCES[self.language]["comma"].join(parts)

    def restated(self, objective: str, values: Mapping[str, float], not_used: Sequence[str]) -> str:
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


def _figure(value: float, unit: str) -> str:
    """A figure as the operator may check it: six digits, an SI prefix."""
    if unit == "%":
        return f"{100 * value:.6g} %"
    scale, prefix = next(((scale, prefix) for scale, prefix in _PREFIXES if value >= scale), _PREFIXES[-1])
    return f"{value / scale:.6g} {prefix}{unit}"

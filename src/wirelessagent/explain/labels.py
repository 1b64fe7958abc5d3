"""Labels of tables and names of things in the operator's language; English ones stand for themselves."""

from __future__ import annotations

import re
from collections.abc import Mapping

from wirelessagent.model.legible import legible

_CHINESE: Mapping[str, str] = {
    "Users": "用户",
    "user": "用户",
    "subcarriers": "子载波",
    "of them repaired": "其中修复的",
    "power": "功率",
    "predicted rate": "预测速率",
    "predicted rate (90 % band)": "预测速率（90 % 区间）",
    "committed (kept with)": "预定速率（兑现概率）",
    "asked for (kept with)": "要求的速率（兑现概率）",
    "achieved rate": "实际速率",
    "promised at {}": "以 {} 承诺",
    "Promised at {}": "以 {} 承诺",
    "{} of {} kept": "{}/{} 兑现",
    "{} ({})": "{}（{}）",
    "{} ({} short)": "{}（少 {}）",
    "weighted total rate": "加权总速率",
    "weighted energy efficiency": "加权能效",
    "{}, as decided on": "{}（决策时所计）",
    "{}, at the promised rates": "{}（按承诺速率）",
    "figure": "指标",
    "predicted": "预测",
    "achieved": "实际",
    "all gains known": "增益全部已知时",
    "at least": "至少",
    "at most": "至多",
    "Predicted on the estimate": "在估计信道上预测",
    "Predicted on the estimate, achieved on the true channel": "估计信道上的预测与真实信道上的实际",
    "What it would take": "需要什么",
    "power that the rates asked for need": "所要求的速率所需功率",
    "largest common scaling of the rates asked for": "所要求的速率的最大共同倍数",
    "Sum rate": "总速率",
    "Goodput": "有效吞吐量",
    "Radiated power": "发射功率",
    "Energy efficiency": "能效",
    "Spectral efficiency": "频谱效率",
    "Jain's fairness index": "Jain 公平指数",
    "Side by side": "并列比较",
    "objective": "目标",
    "status": "状态",
    "value": "目标值",
    "bound": "界",
    "gap": "差距",
    "power needed": "所需功率",
    "lowest rate": "最低速率",
    "users served": "服务的用户",
    "promises missed": "未兑现的承诺",
    "turn": "轮次",
    "said": "内容",
    "came to": "结果",
}

_NAMED: Mapping[str, str] = {
    "simulated": "模拟基站",
    "offline": "离线识别",
    "llm": "大语言模型",
    "dual": "对偶法",
    "exact": "精确法",
    "greedy": "贪心法",
    "equal_power": "等功率法",
    "round_robin": "轮询法",
    "paper": "论文方法",
    "paper_bisection": "论文二分法",
    "paper_inversion": "论文信道反转法",
    "paper_scan": "论文功率扫描法",
    "kriging": "克里金法",
    "linear": "线性插值",
    "nncf": "最近邻协同过滤",
    "nncf_paper": "论文最近邻协同过滤",
    "user_mean": "用户均值法",
    "predictor": "时间预测法",
    "learned_covariance": "学习协方差法",
}
"""What built-in plug-ins and recognisers are called in a sentence; those of others keep their names."""
_NUMBERED = re.compile(r"(?i)user\s*(\d+)")


def called(language: str, name: str) -> str:
    """A user, a method or the like by name, in the operator's language where it has no name of its own.

    A name stays within its line, so that none can add a line to what is said.

    >>> called("zh", "user 3"), called("zh", "Ada"), called("en", "user 3")
    ('用户3', 'Ada', 'user 3')
    """
    name = legible(name, keep="")
    if language != "zh":
        return name
    number = _NUMBERED.fullmatch(name)
    return f"用户{number[1]}" if number is not None else _NAMED.get(name, name)


def worded(language: str, label: str, *figures: object) -> str:
    """A label of a table in the operator's language, with its figures filled in."""
    return (_CHINESE.get(label, label) if language == "zh" else label).format(*figures)

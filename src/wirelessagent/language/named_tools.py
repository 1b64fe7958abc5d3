"""Methods and repairers by the names that operators say: "equal power", "the paper's method", "等功率"."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from wirelessagent import plugins

_SPOKEN: Mapping[str, tuple[str, ...]] = {
    "dual": ("dual decomposition", "lagrangian", "对偶"),
    "exact": ("brute force", "branch and bound", "精确"),
    "greedy": ("贪心", "贪婪"),
    "equal_power": ("equal power allocation", "uniform power", "等功率", "平均功率", "均分功率"),
    "round_robin": ("roundrobin", "轮询", "轮转"),
    "paper": ("论文",),
    "paper_bisection": ("论文二分", "二分法", "bisection"),
    "paper_inversion": ("论文信道反转", "信道反转", "channel inversion"),
    "paper_scan": ("论文功率扫描", "功率扫描", "power scan"),
    "kriging": ("克里金",),
    "linear": ("linear interpolation", "线性插值"),
    "nncf": ("nearest neighbours", "nearest neighbors", "最近邻"),
    "user_mean": ("mean of the user", "用户均值"),
    "learned_covariance": ("学习协方差",),
    "predictor": ("时间预测",),
}


def tools_named(text: str, *kinds: plugins.Kind) -> tuple[str, ...]:
    """The installed plug-ins of these kinds that are named, in their order.

    >>> tools_named("compare with equal power and the paper's method", "method")
    ('equal_power', 'paper')
    """
    spoken = _spoken(tuple(name for kind in kinds for name in plugins.names(kind)))
    longest_first = sorted(spoken, key=len, reverse=True)
    pattern = "|".join(rf"{'' if _is_chinese(said) else chr(92) + 'b'}{re.escape(said)}" for said in longest_first)
    found = re.finditer(rf"({pattern})(?![a-z])", re.sub(r"[-_\s]+", " ", text.lower())) if spoken else ()
    return tuple(dict.fromkeys(spoken[match[1]] for match in found))


@functools.cache
def _spoken(names: tuple[str, ...]) -> Mapping[str, str]:
    """The plug-in that each name or spoken name means."""
    return {said: name for name in names for said in (name.lower().replace("_", " "), *_SPOKEN.get(name, ()))}


def _is_chinese(said: str) -> bool:
    return not said.isascii()

"""A request as one sentence, with figures and units, for the operator to check."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from wirelessagent import plugins
from wirelessagent.agent.request import Request
from wirelessagent.language.intent import EVERYBODY, Constraint
from wirelessagent.language.replies import GOALS
from wirelessagent.model.units import reliability

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))

_WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "max_power_w": "at most {} of radiated power",
        "min_rate_bps": "at least {} for {}",
        "max_rate_bps": "at most {} for {}",
        "circuit_power_w": "{} of circuit power",
        "outage_probability": "promises kept with {}",
        "weights": "weight {1} for {0}",
        "users": "serving only {}",
        "leave_out": "without {}",
        "subcarrier_max_power_w": "at most {} per subcarrier",
        "resource_block_group_size": "subcarriers in groups of {}",
        "everybody": "each user", "everybody_else": "everyone else", "user": "user {}", "and": " and ", "comma": ", ",
        "of": "{}: {}.", "alone": "{}.",
    },
    "zh": {
        "max_power_w": "发射功率不超过 {}",
        "min_rate_bps": "{1}至少 {0}",
        "max_rate_bps": "{1}不超过 {0}",
        "circuit_power_w": "电路功率 {}",
        "outage_probability": "承诺以 {} 兑现",
        "weights": "{}的权重为 {}",
        "users": "只服务{}",
        "leave_out": "不含{}",
        "subcarrier_max_power_w": "每个子载波不超过 {}",
        "resource_block_group_size": "子载波每 {} 个一组",
        "everybody": "每个用户", "everybody_else": "其他用户", "user": "用户{}", "and": "和", "comma": "，",
        "of": "{}：{}。", "alone": "{}。",
    },
}  # fmt: skip


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    words = _WORDS.get(language, _WORDS["en"])
    goal = goal_words(request.objective, language)
    limits = words["comma"].join(_limit(words, name, value) for name, value in request.constraints.items())
    start = goal[:1].upper() + goal[1:]
    return words["of"].format(start, limits) if limits else words["alone"].format(start)


def goal_words(objective: str, language: str) -> str:
    """What an objective is called: in the built-in words, else by its own first phrase."""
    own = plugins.objective(objective).phrases
    spoken = own.get(language) or own.get("en") or next(iter(own.values()), (objective.replace("_", " "),))
    return GOALS.get(language, GOALS["en"]).get(objective) or spoken[0]


def _limit(words: Mapping[str, str], name: str, value: Constraint) -> str:
    if isinstance(value, tuple):
        return words[name].format(_listed(words, [_user(words, user) for user in value]))
    if name == "weights":
        return _weights(words, value)
    if name == "outage_probability":
        return words[name].format(reliability(cast(float, value)))
    if name == "resource_block_group_size":
        return words[name].format(f"{cast(float, value):g}")
    unit = "bit/s" if name.endswith("bps") else "W"
    if isinstance(value, Mapping):
        parts = [words[name].format(_figure(figure, unit), who) for figure, who in _by_figure(words, value)]
        return words["comma"].join(parts)
    return words[name].format(_figure(value, unit), words["everybody"])


def _weights(words: Mapping[str, str], value: float | Mapping[str, float]) -> str:
    by_user = value if isinstance(value, Mapping) else {EVERYBODY: value}
    said = [words["weights"].format(who, f"{figure:g}") for figure, who in _by_figure(words, by_user)]
    return words["comma"].join(said)


def _by_figure(words: Mapping[str, str], by_user: Mapping[str, float]) -> list[tuple[float, str]]:
    """(figure, who gets it), the same figures together and those who are not named last."""
    named: dict[float, list[str]] = {}
    for user, figure in by_user.items():
        if user != EVERYBODY:
            named.setdefault(figure, []).append(_user(words, user))
    said = [(figure, _listed(words, users)) for figure, users in named.items()]
    if EVERYBODY in by_user:
        said.append((by_user[EVERYBODY], words["everybody_else" if named else "everybody"]))
    return said


def _user(words: Mapping[str, str], reference: str) -> str:
    return words["user"].format(reference) if reference.isdigit() else reference


def _listed(words: Mapping[str, str], names: list[str]) -> str:
    return words["and"].join([words["comma"].join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _figure(value: float, unit: str) -> str:
    """A figure as the operator may check it: six digits, an SI prefix."""
    scale, prefix = next(((scale, prefix) for scale, prefix in _PREFIXES if value >= scale), _PREFIXES[-1])
    return f"{value / scale:.6g} {prefix}{unit}"

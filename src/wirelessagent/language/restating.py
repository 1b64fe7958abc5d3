"""Limits of a request as one phrase, with figures and units, for the operator to check."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import EVERYBODY, Constraint
from wirelessagent.model.units import reliability

_ROUNDING = 1e-9

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))

_WORDS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "max_power_w": "at most {figure} of radiated power",
        "min_rate_bps": "at least {figure} for {who}",
        "max_rate_bps": "at most {figure} for {who}",
        "circuit_power_w": "{figure} of circuit power",
        "outage_probability": "promises kept with {figure}",
        "weights": "weight {figure} for {who}",
        "users": "serving only {who}",
        "leave_out": "without {who}",
        "subcarrier_max_power_w": "at most {figure} on each subcarrier",
        "resource_block_group_size": "subcarriers in groups of {figure}",
        "everybody": "each user",
        "everybody_else": "everyone else",
        "but": "{who} but {users}",
        "no_promise": "no least rate for {who}",
        "user": "user {}",
        "users_by_number": "users {}",
        "and": " and ",
        "comma": ", ",
        "between": ", ",
    },
    "zh": {
        "max_power_w": "发射功率不超过 {figure}",
        "min_rate_bps": "{who}至少 {figure}",
        "max_rate_bps": "{who}不超过 {figure}",
        "circuit_power_w": "电路功率 {figure}",
        "outage_probability": "承诺以 {figure} 的概率兑现",
        "weights": "{who}的权重为 {figure}",
        "users": "只服务{who}",
        "leave_out": "不服务{who}",
        "subcarrier_max_power_w": "每个子载波不超过 {figure}",
        "resource_block_group_size": "子载波每 {figure} 个一组",
        "everybody": "每个用户",
        "everybody_else": "其余用户",
        "but": "除{users}外{who}",
        "no_promise": "不保证{who}的最低速率",
        "user": "用户{}",
        "users_by_number": "用户{}",
        "and": "和",
        "comma": "、",
        "between": "，",
    },
}

_NUMBERED = deferred(r"(?i)(?:user\s*)?(\d+)")
_SEVERAL = 3
"""So many users are named by their numbers alone."""


def limits_in_words(limits: Mapping[str, Constraint], language: str) -> str:
    """Limits with their figures, the same figures for several users together.

    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "2": 3e6, "4": 3e6}, "leave_out": ("3",)}, "en")
    'at least 3 Mbit/s for user 2 and user 4, at least 1 Mbit/s for everyone else, without user 3'
    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "3": 0.0}}, "en")
    'at least 1 Mbit/s for each user but user 3'
    """
    words = _WORDS.get(language, _WORDS["en"])
    return words["between"].join(part for name, value in limits.items() for part in _limit(words, name, value))


def users_in_words(references: Sequence[str], language: str) -> str:
    """Users in a row, "3" as "user 3"; EVERYBODY is everyone who is not named.

    >>> users_in_words(("3", "anna", "all"), "en"), users_in_words(("user 3",), "zh")
    ('user 3, anna and everyone else', '用户3')
    """
    words = _WORDS.get(language, _WORDS["en"])
    return _listed(words, [_user(words, reference) for reference in references])


def _limit(words: Mapping[str, str], name: str, value: Constraint) -> list[str]:
    if isinstance(value, tuple):
        return [words[name].format(who=_listed(words, [_user(words, user) for user in value]))]
    by_user = value if isinstance(value, Mapping) else {EVERYBODY: value}
    exempt = [_user(words, user) for user, figure in by_user.items() if figure == 0 and name == "min_rate_bps"]
    promised = {user: figure for user, figure in by_user.items() if figure > 0 or not exempt}
    said = [
        words[name].format(figure=_figure(name, figure), who=who) for figure, who in _by_figure(words, promised, exempt)
    ]
    return (
        said if EVERYBODY in promised or not exempt else [*said, words["no_promise"].format(who=_listed(words, exempt))]
    )


def _by_figure(words: Mapping[str, str], by_user: Mapping[str, float], exempt: list[str]) -> list[tuple[float, str]]:
    """(figure, who gets it), the same figures together and those who are not named last, but for the exempt."""
    named: dict[float, list[str]] = {}
    for user, figure in by_user.items():
        if user != EVERYBODY and figure != by_user.get(EVERYBODY):
            named.setdefault(figure, []).append(_user(words, user))
    said = [(figure, _listed(words, users)) for figure, users in named.items()]
    if EVERYBODY in by_user:
        others = words["everybody_else" if named else "everybody"]
        others = words["but"].format(who=others, users=_listed(words, exempt)) if exempt else others
        said.append((by_user[EVERYBODY], others))
    return said


def _user(words: Mapping[str, str], reference: str) -> str:
    number = _NUMBERED.fullmatch(reference)
    if number is not None:
        return words["user"].format(number[1])
    return words["everybody_else"] if reference == EVERYBODY else reference


def _listed(words: Mapping[str, str], names: list[str]) -> str:
    pattern = deferred(re.escape(words["user"]).replace(r"\{\}", r"(\d+)"))
    numbers = [match[1] for match in map(pattern.fullmatch, names) if match is not None]
    if len(names) >= _SEVERAL and len(numbers) == len(names):  # "users 1, 3 and 4"
        return words["users_by_number"].format(_listed(words, numbers))
    return words["and"].join([words["comma"].join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _figure(name: str, value: float) -> str:
    """A figure as the operator may check it: four digits, an SI prefix, and dBm where those are rounder.

    >>> _figure("max_power_w", 10**0.3), _figure("max_power_w", 1.0), _figure("min_rate_bps", 1.5e6)
    ('33 dBm (1.995 W)', '1 W', '1.5 Mbit/s')
    """
    if name == "outage_probability":
        return reliability(value)
    if name in ("weights", "resource_block_group_size"):
        return f"{value:g}"
    unit = "bit/s" if name.endswith("bps") else "W"
    scale, prefix = next(((scale, prefix) for scale, prefix in _PREFIXES if value >= scale), _PREFIXES[-1])
    said = f"{value / scale:.4g} {prefix}{unit}"
    if unit == "bit/s" or abs(float(f"{value:.4g}") - value) <= _ROUNDING * value:
        return said
    dbm = 10 * math.log10(value) + 30
    return f"{round(dbm, 1):g} dBm ({said})" if abs(dbm - round(dbm, 1)) <= _ROUNDING else said

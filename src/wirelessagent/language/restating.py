"""Limits of a request as one phrase, with figures and units, for the operator to check."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from wirelessagent.language.intent import EVERYBODY, Constraint
from wirelessagent.model.units import reliability
from wirelessagent.telling.catalogue import listed, message

_ROUNDING = 1e-9

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def limits_in_words(limits: Mapping[str, Constraint], language: str) -> str:
    """Limits with their figures, the same figures for several users together.

    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "2": 3e6, "4": 3e6}, "leave_out": ("3",)}, "en")
    'at least 3 Mbit/s for user 2 and user 4, at least 1 Mbit/s for everyone else, without user 3'
    >>> limits_in_words({"min_rate_bps": {"all": 1e6, "3": 0.0}}, "en")
    'at least 1 Mbit/s for each user but user 3'
    """
    return message(language, "text.between").join(
        part for name, value in limits.items() for part in _limit(language, name, value)
    )


def users_in_words(references: Sequence[str], language: str) -> str:
    """Users in a row, "3" as "user 3"; EVERYBODY is everyone who is not named.

    >>> users_in_words(("3", "anna", "all"), "en"), users_in_words(("user 3",), "zh")
    ('user 3, anna and everyone else', '用户3')
    >>> users_in_words(("1", "user 3", "4"), "en")
    'users 1, 3 and 4'
    """
    everybody_else = message(language, "whom.everybody_else")
    names = (everybody_else if reference == EVERYBODY else reference for reference in references)
    return listed(language, (f"user {name}" if name.isdecimal() else name for name in names))


def _limit(language: str, name: str, value: Constraint) -> list[str]:
    if isinstance(value, tuple):
        return [message(language, f"holds.{name}", who=users_in_words(value, language))]
    by_user = value if isinstance(value, Mapping) else {EVERYBODY: value}
    exempt = [user for user, figure in by_user.items() if figure == 0 and name == "min_rate_bps"]
    promised = {user: figure for user, figure in by_user.items() if figure > 0 or not exempt}
    said: list[str] = [
        message(language, f"holds.{name}", figure=figure_in_words(name, figure), who=who)
        for figure, who in _by_figure(language, promised, exempt)
    ]
    if EVERYBODY in promised or not exempt:
        return said
    return [*said, message(language, "whom.no_promise", who=users_in_words(exempt, language))]


def _by_figure(language: str, by_user: Mapping[str, float], exempt: list[str]) -> list[tuple[float, str]]:
    """(figure, who gets it), the same figures together and those who are not named last, but for the exempt."""
    named: dict[float, list[str]] = {}
    for user, figure in by_user.items():
        if user != EVERYBODY and figure != by_user.get(EVERYBODY):
            named.setdefault(figure, []).append(user)
    said = [(figure, users_in_words(users, language)) for figure, users in named.items()]
    if EVERYBODY in by_user:
        others = message(language, "whom.everybody_else" if named else "whom.everybody")
        if exempt:
            others = message(language, "whom.but", who=others, users=users_in_words(exempt, language))
        said.append((by_user[EVERYBODY], others))
    return said


def figure_in_words(name: str, value: float) -> str:
    """A figure as the operator may check it: four digits, an SI prefix, and dBm where those are rounder.

    >>> figure_in_words("max_power_w", 10**0.3), figure_in_words("min_rate_bps", 1.5e6)
    ('33 dBm (1.995 W)', '1.5 Mbit/s')
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

"""Sentences with what they mean: ``meanings/*.tsv``, the spoken requests that say their constraints, and marked ones.

In ``marked/<language>.txt`` figures and users are marked with what they are there for. A mark is the words of a figure
or of somebody named in brackets, and the role behind them in braces: "leave [user 3]{leave_out} out, at most
[10 W]{limit}". Of "<least power|highest rate>, without [user 3]{leave_out}" each choice is a sentence. Roles are the
labels of :mod:`wirelessagent.language.figure_roles`, some by a shorter name; numbers without a mark describe. They hold
what a meaning cannot show: figures to ask about, and users who stay.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from wirelessagent.language.figure_roles import LABELS
from wirelessagent.language.intent import EVERYBODY
from wirelessagent.language.judged import BORROWING, Look, figures_of
from wirelessagent.language.mentions import Mention
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.training.examples import spoken
from wirelessagent.model.errors import InputError

MARKED = Path(__file__).with_name("marked")
_MARK = re.compile(r"\[([^\[\]]+)\]\{(\w+)\}")
_CHOICE = re.compile(r"<([^<>]*\|[^<>]*)>")
_MEANS = {
    "min": "min_rate_bps", "max": "max_rate_bps", "limit": "max_power_w", "circuit": "circuit_power_w",
    "carrier": "subcarrier_max_power_w",
    "theirs": "unclear", "uncapped": "unclear", "elsewhere": "unclear",
}  # fmt: skip


def marked(folder: Path = MARKED) -> list[str]:
    """The marked sentences.

    Raises:
        InputError: there are none; an installed package leaves them out.
    """
    lines = [line for path in sorted(folder.glob("*.txt")) for line in path.read_text(encoding="utf-8").splitlines()]
    found = [sentence for line in lines for sentence in _chosen(line)]
    if not found:
        raise InputError(f"no marked sentences in {folder}: train from a checkout of the sources, which has them")
    return found


def _chosen(line: str) -> Iterator[str]:
    """Each sentence that a line with choices stands for."""
    choice = _CHOICE.search(line)
    if choice is None:
        yield line
        return
    for words in choice[1].split("|"):
        yield from _chosen(line[: choice.start()] + words + line[choice.end() :])


def unmarked(line: str) -> tuple[str, list[tuple[int, int, str]]]:
    """A sentence without its marks, and what was marked, from where to where and as what.

    >>> unmarked("skip [user 3]{leave_out}, [10 W]{limit} on air")
    ('skip user 3, 10 W on air', [(5, 11, 'leave_out'), (13, 17, 'max_power_w')])
    """
    text, spans, place = "", list[tuple[int, int, str]](), 0
    for match in _MARK.finditer(line):
        text += line[place : match.start()]
        spans.append((len(text), len(text) + len(match[1]), _MEANS.get(match[2], match[2])))
        text, place = text + match[1], match.end()
    return text + line[place:], spans


class Marked:
    """A marked sentence, asked what its figures and users are there for, as one with its meaning is."""

    def __init__(self, line: str) -> None:
        self.text, self._marks = unmarked(line)

    def _roles(self, start: int, end: int) -> set[str]:
        return {role for first, last, role in self._marks if start < last and first < end}

    def of_number(self, number: Number) -> set[str]:
        """A user, or a figure that borrows a unit; it describes where it is not marked, but for "twice"."""
        roles = self._roles(number.start, number.end)
        if not roles and number.form == "times":
            return set()
        if roles == {"unclear"}:
            return {"limit"}
        if roles and roles <= {"user", "weight", "group", "share"}:
            return roles
        means = (means for means in ("user", "rate", "power") if roles and roles <= set(LABELS[means]))
        return {next(means, "harmless")}

    def of_user(self, mention: Mention, _: Sequence[Mention]) -> set[str]:
        return self._roles(mention.start, mention.end)

    def of_pronoun(self, _: Mention, __: Sequence[Mention]) -> set[str]:
        return set()

    def of_figure(self, figure: Quantity) -> set[str]:
        return self._roles(figure.start, figure.end)

    def owners(self, _: Quantity) -> set[str]:
        """Whose a rate is, marks do not say."""
        return set()

    def weighed(self, _: float) -> set[str]:
        return set()


MEANINGS = Path(__file__).with_name("meanings")
_CLOSE = 1e-6
_ENDS = re.compile(r"\s*(?:$|[,.;:!?)\uff0c。；、])")
_NOTHING = {"none", "stale", "refused"}
_MAX_POWER_W = 20.0  # whose shares sentences say


def sentences() -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(sentence, constraints)."""
    for path in sorted(MEANINGS.glob("*.tsv")):
        for line in path.read_text(encoding="utf-8").splitlines():
            text, _, meaning = line.partition("\t")
            yield text, json.loads(meaning)
    for each in spoken():
        if each.constraints is not None:
            yield each.text, each.constraints


class Meant:
    """The meaning of a sentence, asked by figure."""

    def __init__(self, constraints: Mapping[str, Any], look: Look) -> None:
        self._constraints, self._look = constraints, look
        self._values = {
            name: _by_user(constraints[name])
            for name in ("min_rate_bps", "max_rate_bps", "weights")
            if name in constraints
        }
        self._powers = {
            name: float(constraints[name])
            for name in ("max_power_w", "circuit_power_w", "subcarrier_max_power_w")
            if name in constraints
        }
        self._users = {name: {str(user) for user in constraints.get(name, ())} for name in ("users", "leave_out")}
        self._all_users = self._users["users"] | self._users["leave_out"]
        for figures in self._values.values():
            self._all_users |= figures.keys() - {EVERYBODY}
        self._rates = [
            value
            for name in ("min_rate_bps", "max_rate_bps")
            for value in self._values.get(name, {}).values()
            if value > 0  # nobody says a floor of zero in figures
        ]
        self._worth = {number: self._worth_of(number) for number in (*look.loose, *look.ones)}
        self._known = [(figure.kind, figure.value) for figure in look.figures]
        self._borrowing = {number: roles for number in self._worth for roles in [self._borrows(number)] if roles}
        self._known += [
            (BORROWING[role], self._worth[number][role]) for number, roles in self._borrowing.items() for role in roles
        ]
        outage = constraints.get("outage_probability")
        self._complete = {
            "power": all(map(self._is_said, self._powers.values())),
            "rate": all(self._has("rate", value) for value in self._rates),
            "ratio": outage is None or self._has("ratio", outage) or self._has("ratio", 1 - outage),
        }

    def _has(self, kind: str, value: float) -> bool:
        return any(kind == known and _close(value, each) for known, each in self._known)

    def _is_said(self, power: float) -> bool:
        """Whether a power stands there, or as a share of the cell's."""
        return self._has("power", power) or self._has("ratio", power / _MAX_POWER_W)

    def _is_share(self, value: float) -> bool:
        """Whether a ratio is a share of the cell's power."""
        most = self._powers.get("max_power_w", 0.0)
        return _close(value * _MAX_POWER_W, most) and not self._has("power", most)

    def _worth_of(self, number: Number) -> dict[str, float]:
        """What a number would be worth in each role that borrows a unit."""
        look = self._look
        found = {role: figures_of(look.plain, {number: role}, (), look.figures).get(number) for role in BORROWING}
        return {role: figure.value for role, figure in found.items() if figure is not None}

    def _borrows(self, number: Number) -> set[str]:
        """The role in which a number is a wanted figure that stands nowhere with its unit."""
        outage = self._constraints.get("outage_probability")
        missing = {
            "rate": [rate for rate in self._rates if not self._has("rate", rate)],
            "power": [power for power in self._powers.values() if not self._is_said(power)],
            "outage": [outage] if outage is not None and not self._has("ratio", outage) else [],
            "reliability": [1 - outage] if outage is not None and not self._has("ratio", 1 - outage) else [],
        }
        limits = [power for power in missing["power"] if power == self._powers.get("max_power_w")]
        missing["share"] = [power / _MAX_POWER_W for power in limits]
        missing["multiple"] = missing["rate"] if number.form == "times" else []
        worth = self._worth[number]
        roles = {role for role, value in worth.items() if any(_close(value, each) for each in missing[role])}
        if "rate" in worth and not roles and not self._is_unnamed_user(number):
            value = worth["rate"]
            stated = sum(figure.kind == "rate" and _close(value, figure.value) for figure in self._look.figures)
            more = sum(_close(value, rate) for rate in self._rates) > stated > 0 and not missing["rate"]
            return {"rate"} if more and self._is_alone(number) else set()
        return set() if roles and self._is_unnamed_user(number) else roles

    def _is_alone(self, number: Number) -> bool:
        """Whether nobody is counted by a number: "the other two" are users."""
        return _ENDS.match(self._look.plain, number.end) is not None

    def _is_unnamed_user(self, number: Number) -> bool:
        named = {user for mention in self._look.mentions for user in mention.users}
        value = number.value
        return value is not None and value == int(value) and str(int(value)) in self._all_users - named

    def of_figure(self, figure: Quantity) -> set[str]:
        if not self._complete[figure.kind]:
            return set()
        if figure.kind == "ratio":
            outage = self._constraints.get("outage_probability", -1.0)
            meant = {"share": self._is_share(figure.value), "outage": _close(figure.value, outage),
                     "reliability": _close(1 - figure.value, outage)}  # fmt: skip
            return {role for role, is_one in meant.items() if is_one} or {"none", "missing"}
        if figure.kind == "power":
            return {name for name, value in self._powers.items() if _close(value, figure.value)} or _NOTHING
        whose = {
            name: {user for user, value in self._values.get(name, {}).items() if _close(value, figure.value)}
            for name in ("min_rate_bps", "max_rate_bps")
        }
        if set.intersection(*whose.values()) and set(self._rates) == {figure.value}:
            return {"both"}
        return {name for name, users in whose.items() if users} or _NOTHING

    def of_user(self, mention: Mention, found: Sequence[Mention]) -> set[str]:
        users = set(mention.users)
        again = any(other is not mention and users & set(other.users) for other in found)
        for name in ("leave_out", "users"):
            if users <= self._users[name]:
                return {name, "given"} if again else {name}
            if users & self._users[name]:
                return set()
        floors = self._values.get("min_rate_bps", {})
        if any(floors.get(user) == 0 for user in users):
            return {"exempt", "given"} if again else {"exempt"}
        given = {user for figures in self._values.values() for user in figures}
        if users & given:
            return {"given"}
        return {"kept"}

    def of_pronoun(self, pronoun: Mention, found: Sequence[Mention]) -> set[str]:
        named = [other for other in found if other.role == "named" and other.end <= pronoun.start]
        return {"given", *self.of_user(named[-1], found)} if named else {"given"}

    def of_number(self, number: Number) -> set[str]:
        value = None if number.value is None else float(number.value)
        if value is None:
            return {"limit"} if not all(self._complete.values()) else set()
        if number in self._borrowing:
            return self._borrowing[number]
        scaled = any(_is_scaled(value, rate, (1.0, 1e3, 1e6, 8e3, 8e6)) for rate in self._rates)
        powers = any(_is_power(value, power) for power in self._powers.values())
        if (scaled and not self._complete["rate"]) or (powers and not self._complete["power"]):
            return set() if self._is_unnamed_user(number) else {"limit"}
        if number in self._look.ones:
            return {"harmless"} if all(self._complete.values()) and "weights" not in self._values else set()
        outage = self._constraints.get("outage_probability")
        if not self._complete["ratio"] and outage is not None:
            return {"limit"}
        known = self._all_users | self._values.get("weights", {}).keys()
        user = number.form != "times" and value == int(value) and str(int(value)) in known
        weight = any(_close(value, each) for each in self._values.get("weights", {}).values())
        group = _close(value, self._constraints.get("resource_block_group_size", 0.0))
        roles = {name for name, is_one in (("user", user), ("weight", weight), ("group", group)) if is_one}
        if roles:
            return roles if len(roles) == 1 else set()
        if value == 1 and "weights" in self._values:
            return {"weight", "harmless"}  # "all others 1" is what they count anyway
        return {"harmless"} if all(self._complete.values()) else set()

    def owners(self, figure: Quantity) -> set[str]:
        """The users whose rate a figure is."""
        figures = [self._values.get(name, {}) for name in ("min_rate_bps", "max_rate_bps")]
        found = {user for each in figures for user, value in each.items() if _close(value, figure.value)}
        return found | self._users["users"] if EVERYBODY in found else found

    def weighed(self, value: float) -> set[str]:
        return {user for user, weight in self._values.get("weights", {}).items() if _close(weight, value)}


def _by_user(value: float | Mapping[str, float]) -> dict[str, float]:
    return (
        {str(user): float(each) for user, each in value.items()}
        if isinstance(value, Mapping)
        else {EVERYBODY: float(value)}
    )


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_CLOSE, abs_tol=1e-12)


def _is_scaled(value: float, other: float, factors: Iterable[float]) -> bool:
    return any(_close(value * factor, other) for factor in factors)


def _is_power(value: float, power: float) -> bool:
    return _is_scaled(value, power, (1.0, 1e-3)) or (value < 300 and _close(10 ** ((value - 30) / 10), power))

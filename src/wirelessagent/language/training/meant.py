"""Sentences with what they mean: ``meanings/*.tsv``, the spoken requests that say their constraints, and marked ones.

In ``marked/<language>.txt`` figures and users are marked with what they are there for. A mark is the words of a figure
or of somebody named in brackets, and the role behind them in braces: "leave [user 3]{leave_out} out, at most
[10 W]{limit}". Of "<least power|highest rate>, without [user 3]{leave_out}" each choice is a sentence. Roles are the
labels of :mod:`wirelessagent.language.figure_roles`, some by a shorter name; numbers without a mark describe. They hold
what a meaning cannot show: figures to ask about, and users who stay.
"""

from __future__ import annotations

import itertools
import json
import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from wirelessagent.language.conversation.possible import POWERS
from wirelessagent.language.figure_roles import LABELS
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, RATES
from wirelessagent.language.mentions import Mention
from wirelessagent.language.number_roles import BORROWING, Look, figures_of
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.training.examples import lines_of, spoken

MARKED, MEANINGS = Path(__file__).with_name("marked"), Path(__file__).with_name("meanings")
_MARK = re.compile(r"\[([^\[\]]+)\]\{(\w+)\}")
_CHOICE = re.compile(r"<([^<>]*\|[^<>]*)>")
_MEANS = {
    "min": "min_rate_bps", "max": "max_rate_bps", "limit": "max_power_w", "circuit": "circuit_power_w",
    "carrier": "subcarrier_max_power_w",
    "theirs": "unclear", "uncapped": "unclear", "elsewhere": "unclear",
}  # fmt: skip


def marked() -> list[str]:
    """The marked sentences, each that a line with choices stands for."""
    choices = ((part.split("|") for part in _CHOICE.split(line)) for _, line in lines_of(MARKED))
    return ["".join(parts) for each in choices for parts in itertools.product(*each)]


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

    def _roles(self, item: Number | Mention | Quantity) -> set[str]:
        return {role for first, last, role in self._marks if item.start < last and first < item.end}

    def of_number(self, number: Number) -> set[str]:
        """A user, or a figure that borrows a unit; it describes where it is not marked, but for "twice"."""
        roles = self._roles(number)
        if not roles and number.form == "times":
            return set()
        if roles == {"unclear"}:
            return {"limit"}
        if roles and roles <= {"user", "weight", "group", "share"}:
            return roles
        means = (means for means in ("user", "rate", "power") if roles and roles <= set(LABELS[means]))
        return {next(means, "harmless")}

    def of_user(self, mention: Mention, _: Sequence[Mention]) -> set[str]:
        return self._roles(mention) if mention.role == "named" else set()

    def of_figure(self, figure: Quantity) -> set[str]:
        return self._roles(figure)

    def owners(self, _: float, *__: str) -> set[str]:
        """Whose a figure is, marks do not say."""
        return set()


_CLOSE = 1e-6
_ENDS = re.compile(r"\s*(?:$|[,.;:!?)\uff0c。；、])")
_NOTHING = {"none", "stale", "refused"}
_MAX_POWER_W = 20.0  # whose shares sentences say


def sentences() -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(sentence, constraints)."""
    for _, line in lines_of(MEANINGS):
        text, meaning = line.split("\t")
        yield text, json.loads(meaning)
    for each in spoken():
        if each.constraints is not None:
            yield each.text, each.constraints


class Meant:
    """The meaning of a sentence, asked by figure."""

    def __init__(self, constraints: Mapping[str, Any], look: Look) -> None:
        self._look = look
        self._stated = defaultdict[str, dict[str, float]](dict)
        self._stated.update((name, _by_user(value)) for name, value in constraints.items())
        self._powers = {name: value for name in POWERS for value in self._stated[name].values()}
        self._outage = self._stated["outage_probability"].get(EVERYBODY)
        self._users = {user for name in (*FIGURES_OF_USERS, *LISTS_OF_USERS) for user in self._stated[name]}
        figures = (value for name in RATES for value in self._stated[name].values())
        self._rates = [value for value in figures if value > 0]  # nobody says a floor of zero in figures
        self._worth = {number: self._worth_of(number) for number in (*look.loose, *look.ones)}
        self._known = [(figure.kind, figure.value) for figure in look.figures]
        self._borrowing = {number: roles for number in self._worth for roles in [self._borrows(number)] if roles}
        self._known += [
            (BORROWING[role], self._worth[number][role]) for number, roles in self._borrowing.items() for role in roles
        ]
        outage = self._outage
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
        outage = self._outage
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
        return value is not None and value == int(value) and str(int(value)) in self._users - named

    def of_figure(self, figure: Quantity) -> set[str]:
        if not self._complete[figure.kind]:
            return set()
        if figure.kind == "ratio":
            outage = -1.0 if self._outage is None else self._outage
            meant = {"share": self._is_share(figure.value), "outage": _close(figure.value, outage),
                     "reliability": _close(1 - figure.value, outage)}  # fmt: skip
            return {role for role, is_one in meant.items() if is_one} or {"none", "missing"}
        if figure.kind == "power":
            return {name for name, value in self._powers.items() if _close(value, figure.value)} or _NOTHING
        floors, caps = (self.owners(figure.value, name) for name in RATES)
        if floors & caps and set(self._rates) == {figure.value}:
            return {"both"}
        return {name for name, users in zip(RATES, (floors, caps), strict=True) if users} or _NOTHING

    def of_user(self, mention: Mention, found: Sequence[Mention]) -> set[str]:
        if mention.role == "pronoun":
            somebody = antecedent(mention, found)
            return {"given"} if somebody is None else {"given", *self.of_user(somebody, found)}
        users = set(mention.users)
        again = any(other is not mention and users & set(other.users) for other in found)
        for name in ("leave_out", "users"):
            if users <= self._stated[name].keys():
                return {name, "given"} if again else {name}
            if users & self._stated[name].keys():
                return set()
        if any(self._stated["min_rate_bps"].get(user) == 0 for user in users):
            return {"exempt", "given"} if again else {"exempt"}
        return {"given"} if users & self._users else {"kept"}

    def of_number(self, number: Number) -> set[str]:
        value = None if number.value is None else float(number.value)
        if value is None:
            return {"limit"} if not all(self._complete.values()) else set()
        if number in self._borrowing:
            return self._borrowing[number]
        watts = [value, value * 1e-3, *([10 ** ((value - 30) / 10)] if value < 300 else [])]  # in mW, in dBm
        is_rate = any(_close(value * factor, rate) for factor in (1.0, 1e3, 1e6, 8e3, 8e6) for rate in self._rates)
        is_power = any(_close(each, power) for each in watts for power in self._powers.values())
        if (is_rate and not self._complete["rate"]) or (is_power and not self._complete["power"]):
            return set() if self._is_unnamed_user(number) else {"limit"}
        if number in self._look.ones:
            return {"harmless"} if all(self._complete.values()) and not self._stated["weights"] else set()
        if not self._complete["ratio"]:
            return {"limit"}
        user = number.form != "times" and value == int(value) and str(int(value)) in self._users
        weight = bool(self.owners(value, "weights"))
        group = _close(value, self._stated["resource_block_group_size"].get(EVERYBODY, 0.0))
        roles = {name for name, is_one in (("user", user), ("weight", weight), ("group", group)) if is_one}
        if roles:
            return roles if len(roles) == 1 else set()
        if value == 1 and self._stated["weights"]:
            return {"weight", "harmless"}  # "all others 1" is what they count anyway
        return {"harmless"} if all(self._complete.values()) else set()

    def owners(self, value: float, *kinds: str) -> set[str]:
        """Whose figure of these kinds it is, also of those who are served alone where it is everybody's."""
        found = {user for kind in kinds for user, each in self._stated[kind].items() if _close(each, value)}
        return found | self._stated["users"].keys() if EVERYBODY in found else found


def antecedent(pronoun: Mention, found: Sequence[Mention]) -> Mention | None:
    """Who is named last ahead of a pronoun."""
    return next((each for each in found[::-1] if each.role == "named" and each.end <= pronoun.start), None)


def _by_user(value: float | Mapping[str, float] | Sequence[str]) -> dict[str, float]:
    """A constraint's figures by user; a user of a list counts as 1."""
    if isinstance(value, Mapping):
        return {str(user): float(each) for user, each in value.items()}
    return {str(user): 1.0 for user in value} if isinstance(value, Sequence) else {EVERYBODY: float(value)}


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_CLOSE, abs_tol=1e-12)

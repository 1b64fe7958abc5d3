"""Make the model of roles anew: ``python -m wirelessagent.language.training.roles [FILE]``.

Each sentence with its constraints shows what its figures and users are: a power that is the wanted circuit power has
that role, a user who is wanted left out is named to be left out. A sentence whose wanted figures were not all read
shows nothing about figures of their kind.
"""

from __future__ import annotations

import logging
import math
import re
import sys
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import optimize, sparse

from wirelessagent.language.figure_roles import LABELS, ROLES_FILE, View
from wirelessagent.language.intent import EVERYBODY
from wirelessagent.language.looks import BORROWING, Look, figures_of, first_look, second_look
from wirelessagent.language.mentions import Mention
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.role_features import BUCKETS, hashed
from wirelessagent.language.text import normalise
from wirelessagent.language.training.marked import Marked, marked
from wirelessagent.language.training.meant import sentences
from wirelessagent.language.training.named import named
from wirelessagent.language.training.shortened import shortened

_RIDGE = 1e-6
_STEPS = 200
_BALANCE = 0.3
_CLOSE, _SMALL = 1e-6, 4
_ENDS = re.compile(r"\s*(?:$|[,.;:!?)\uff0c。；、])")
_SHORTENED = ("number", "user", "link")  # what is learned from sentences said shorter
_MARKED_COUNT = 2
"""How often a marked sentence counts, beside one with its meaning."""

_FAINT = 3
"""Weights of so many 127ths of the largest cost half of the file and change nothing."""

_NOTHING = {"none", "stale", "refused"}


@dataclass(frozen=True, kw_only=True)
class Example:
    """One figure or user: the buckets of each answer and which answers are right.

    For a question with labels there is one row of buckets, for "link" one for each candidate.
    """

    question: str
    rows: tuple[npt.NDArray[np.int64], ...]
    right: tuple[bool, ...]


def examples(text: str, constraints: Mapping[str, Any]) -> Iterator[Example]:
    """What a sentence with its meaning shows."""
    look = first_look(normalise(text), parse_quantities(text))
    yield from _shown(look, _Wanted(constraints, look))


def shown_by(line: str) -> Iterator[Example]:
    """What a sentence shows whose figures and users are marked."""
    marked_one = Marked(line)
    yield from _shown(first_look(normalise(marked_one.text), parse_quantities(marked_one.text)), marked_one)


def named_in(text: str, names: Sequence[tuple[int, int]]) -> Iterator[Example]:
    """What a sentence shows of words that are somebody's name, as those in the spans ``names`` are, and of others.

    The small words of a name show nothing: "my", "on the".
    """
    plain = normalise(text)
    view = first_look(plain, parse_quantities(text)).view()
    for place in view.words:
        start, end = view.span(place)
        name = any(first < end and start < last for first, last in names)
        if not (name and end - start < _SMALL and plain[start].islower() and plain[start].isascii()):
            yield from _example("word", view.word(place), {"somebody" if name else "nobody"})


def _shown(look: Look, wanted: _Wanted | Marked) -> Iterator[Example]:
    numbers = [(number, wanted.of_number(number)) for number in (*look.loose, *look.ones)]
    view = look.view()
    for number, roles in numbers:
        yield from _example("number", view.number(number, look.bound(number)), roles)
    only = {number: next(iter(roles)) for number, roles in numbers if len(roles) == 1}
    users = [number for number, role in only.items() if role == "user"]
    look = second_look(look, users, {number: role for number, role in only.items() if role in BORROWING})
    view, found = look.view(), look.mentions
    weights = [number for number, role in only.items() if role == "weight"]
    for mention in found:
        if mention.role == "named":
            yield from _example("user", view.user(mention), wanted.of_user(mention, found))
        elif mention.role == "pronoun":
            yield from _example("user", view.user(mention), wanted.of_pronoun(mention, found))
    for index, figure in enumerate(look.figures):
        yield from _example(figure.kind, view.figure(index), wanted.of_figure(figure))
        if figure.kind == "rate":
            yield from _link(view, figure.start, found, wanted.owners(figure))
    for number in weights:
        if number.value is not None:
            yield from _link(view, number.start, found, wanted.weighed(float(number.value)))


def _example(question: str, features: set[str], roles: set[str]) -> Iterator[Example]:
    right = tuple(label in roles for label in LABELS[question])
    if any(right):
        yield Example(question=question, rows=(hashed(question, features),), right=right)


def _link(view: View, start: int, found: Sequence[Mention], owners: set[str]) -> Iterator[Example]:
    candidates: list[Mention | None] = [*found, None]
    right = [_is_for(mention, found, owners) for mention in candidates]
    if EVERYBODY in owners and any(m is not None and m.role == "others" for m in candidates):
        right = [ok and m is not None and m.role != "everybody" for ok, m in zip(right, candidates, strict=True)]
        if not any(right):
            right = [_is_for(mention, found, owners) for mention in candidates]
    if any(right):
        rows = [hashed("link", each) for each in view.owners(start, candidates)]
        yield Example(question="link", rows=tuple(rows), right=tuple(right))


def _is_for(mention: Mention | None, found: Sequence[Mention], owners: set[str]) -> bool:
    if mention is None or mention.role in ("others", "everybody"):
        return EVERYBODY in owners
    if mention.role == "pronoun":
        named = [other for other in found if other.role == "named" and other.end <= mention.start]
        return bool(named) and owners.issuperset(named[-1].users)
    return owners.issuperset(mention.users)


class _Wanted:
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
            "power": all(self._has("power", value) for value in self._powers.values()),
            "rate": all(self._has("rate", value) for value in self._rates),
            "ratio": outage is None or self._has("ratio", outage) or self._has("ratio", 1 - outage),
        }

    def _has(self, kind: str, value: float) -> bool:
        return any(kind == known and _close(value, each) for known, each in self._known)

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
            "power": [power for power in self._powers.values() if not self._has("power", power)],
            "outage": [outage] if outage is not None and not self._has("ratio", outage) else [],
            "reliability": [1 - outage] if outage is not None and not self._has("ratio", 1 - outage) else [],
        }
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
            outage = self._constraints.get("outage_probability")
            if outage is None:
                return {"none", "missing"}
            roles = {"outage"} if _close(figure.value, outage) else set[str]()
            return roles | ({"reliability"} if _close(1 - figure.value, outage) else set()) or {"none", "missing"}
        if figure.kind == "power":
            return {name for name, value in self._powers.items() if _close(value, figure.value)} or _NOTHING
        roles = {
            name
            for name in ("min_rate_bps", "max_rate_bps")
            if any(_close(value, figure.value) for value in self._values.get(name, {}).values())
        }
        return {"both"} if len(roles) > 1 and set(self._rates) == {figure.value} else roles or _NOTHING

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
        user = value == int(value) and str(int(value)) in self._all_users | self._values.get("weights", {}).keys()
        weight = any(_close(value, each) for each in self._values.get("weights", {}).values())
        if user and weight:
            return set()
        if user or weight:
            return {"user"} if user else {"weight"}
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


def fit(question: str, shown: Sequence[Example], ridge: float = _RIDGE) -> npt.NDArray[np.float32]:
    """Weights (bucket, label) that make the right answers likeliest, with a ridge."""
    classes = len(LABELS[question])
    rows = [row for example in shown for row in example.rows]
    matrix = _matrix(rows)
    # Row i of ``group`` belongs to sentence ``owner[i]``: answers of one example compete with each other.
    owner = np.repeat(np.arange(len(shown)), [len(example.rows) for example in shown])
    right = np.array([each for example in shown for each in example.right], dtype=bool).reshape(len(rows), classes)
    columns = matrix.T.tocsr()
    importance = _importance(right, owner, len(shown)) if classes > 1 else np.full(len(shown), 1 / len(shown))

    def loss(flat: npt.NDArray[np.float64]) -> tuple[float, npt.NDArray[np.float64]]:
        weights = flat.reshape(BUCKETS, classes)
        score = np.asarray(matrix @ weights)
        score -= _most(score.max(axis=1), owner, len(shown))[owner][:, None]
        likely = np.exp(score)
        likely /= np.bincount(owner, likely.sum(axis=1), len(shown))[owner][:, None]
        chosen = likely * right
        total = np.bincount(owner, chosen.sum(axis=1), len(shown)) + 1e-300
        slope = (likely - chosen / total[owner][:, None]) * importance[owner][:, None]
        value = -float(importance @ np.log(total)) + ridge * float((weights**2).sum())
        return value, (np.asarray(columns @ slope) + 2 * ridge * weights).ravel()

    found = optimize.minimize(
        loss, np.zeros(BUCKETS * classes), jac=True, method="L-BFGS-B", options={"maxiter": _STEPS, "maxcor": 5}
    )
    return np.asarray(found.x, dtype=np.float32).reshape(BUCKETS, classes)


def _importance(right: npt.NDArray[np.bool_], owner: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.float64]:
    """What each example counts: rare answers more, though not equally."""
    share = right.mean(axis=0)
    rows = np.where(right, np.maximum(share, 1e-9) ** -_BALANCE, 0).max(axis=1)
    importance = np.zeros(count)
    np.maximum.at(importance, owner, rows)
    return importance / importance.sum()


def _most(values: npt.NDArray[np.float64], owner: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.float64]:
    most = np.full(count, -np.inf)
    np.maximum.at(most, owner, values)
    return most


def _matrix(rows: Sequence[npt.NDArray[np.int64]]) -> sparse.csr_matrix:
    sizes = np.array([len(row) for row in rows])
    values = np.repeat(1 / np.sqrt(sizes), sizes)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return sparse.csr_matrix((values, np.concatenate(rows), starts), shape=(len(rows), BUCKETS))


def trained(sentences: Iterable[tuple[str, Mapping[str, Any]]]) -> dict[str, npt.NDArray[np.float32]]:
    """The weights of each question, from sentences with their constraints."""
    shown: dict[str, list[Example]] = {question: [] for question in LABELS}
    for text, constraints in sentences:
        for example in examples(text, constraints):
            shown[example.question].append(example)
        for words in shortened(text):
            for example in examples(words, constraints):
                if example.question in _SHORTENED:
                    shown[example.question].append(example)
    for line in marked():
        for example in shown_by(line):
            shown[example.question] += [example] * _MARKED_COUNT
    for text, names, count in named():
        for example in named_in(text, names):
            shown["word"] += [example] * count
    return {question: fit(question, each) for question, each in shown.items()}


def rounded(weights: npt.NDArray[np.float32]) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float32]]:
    """Weights as int8, the faint ones as none, and a scale per label."""
    scales = np.asarray(np.abs(weights).max(axis=0) / 127, dtype=np.float32)
    found = np.asarray(np.rint(weights / scales), dtype=np.int8)
    return np.where(np.abs(found) > _FAINT, found, np.int8(0)), scales


def save(path: Path, found: Mapping[str, npt.NDArray[np.float32]]) -> None:
    """Write the model."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for question, weights in found.items():
        arrays[f"{question}_weights"], arrays[f"{question}_scales"] = rounded(weights)
    np.savez_compressed(path, allow_pickle=False, **arrays)


def main(path: Path) -> None:
    """Read, fit and write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    start = time.perf_counter()
    save(path, trained(sentences()))
    seconds = time.perf_counter() - start
    logging.getLogger(__name__).info("%s: %d kB (%.0f s)", path.name, path.stat().st_size // 1000, seconds)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROLES_FILE)

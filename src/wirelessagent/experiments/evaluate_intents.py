"""How well sentences are understood: a recogniser against a file of sentences with their meanings.

A *wrong action* is the worst: something is carried out that was not said, on another objective or with another figure.
A *unit error* is a figure that is off by a power of ten, by eight (bits and bytes), by 1024, or by taking decibels for
watts. A sentence that is asked back about counts as not understood, and harms nobody.
"""

from __future__ import annotations

import json
import math
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np

from wirelessagent import plugins
from wirelessagent.language.intent import Constraint, Intent, IntentKind, checked_constraints, same_constraints
from wirelessagent.language.recogniser import Recogniser
from wirelessagent.model.errors import InputError
from wirelessagent.model.units import dbm_to_w

_CLOSE = 1e-9
_ACTING_COMMANDS = ("apply", "confirm", "undo", "reset")


@dataclass(frozen=True, kw_only=True)
class Meant:
    """A sentence and what it means.

    Attributes:
        line: where it stands in its file, from 1.
    """

    text: str
    language: str
    kind: str
    objective: str | None
    constraints: Mapping[str, Constraint]
    line: int


@dataclass(frozen=True, kw_only=True)
class Understood:
    """What a recogniser made of a sentence, and how that compares."""

    meant: Meant
    intent: Intent
    seconds: float
    goal_right: bool
    constraints_right: bool
    wrong_action: bool
    unit_errors: tuple[str, ...]

    @property
    def right(self) -> bool:
        return self.goal_right and self.constraints_right


@dataclass(frozen=True, kw_only=True)
class Figures:
    """The figures of an evaluation; shares are of 1."""

    sentences: int
    with_quantities: int
    kind_and_objective: float
    constraints: float
    wrong_actions: float
    unit_errors: int
    median_ms: float
    slow_ms: float
    by_language: Mapping[str, tuple[int, int]] = field(default_factory=dict[str, tuple[int, int]])
    confusion: Mapping[tuple[str, str], int] = field(default_factory=dict[tuple[str, str], int])


def read_meant(path: Path) -> list[Meant]:
    """The sentences of a file of JSON lines, ``{"text", "language", "kind", "objective", "constraints"}`` each.

    Raises:
        InputError: the file cannot be read, or a line is no such thing; it is named.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path} cannot be read: {error}") from error
    found: list[Meant] = []
    for number, line in enumerate(lines, start=1):
        if line.strip():
            try:
                found.append(_meant(json.loads(line), number))
            except (ValueError, KeyError, TypeError, AttributeError, InputError) as error:
                what = f"no {error}" if isinstance(error, KeyError) else str(error)
                raise InputError(f"{path}, line {number}: {what}; each line is an object with text, kind, objective "
                                 "and constraints") from error  # fmt: skip
    if not found:
        raise InputError(f"{path} holds no sentences")
    return found


def _meant(row: Any, number: int) -> Meant:
    if not isinstance(row, dict):
        raise ValueError(f"it is {row!r}")
    fields = cast("dict[str, Any]", row)
    text, kind, objective = fields["text"], fields["kind"], fields.get("objective")
    given = fields.get("constraints")
    if not isinstance(text, str):
        raise ValueError(f"text is {text!r}")
    if kind not in get_args(IntentKind):
        raise ValueError(f"kind is {kind!r}, not one of {', '.join(get_args(IntentKind))}")
    if objective is not None and objective not in plugins.names("objective"):
        raise ValueError(f"objective is {objective!r}, not null or one of {', '.join(plugins.names('objective'))}")
    if given is not None and not isinstance(given, dict):
        raise ValueError(f"constraints are {given!r}, not an object")
    stated = cast("dict[str, Any]", given or {})
    constraints = {name: _listed(value) for name, value in stated.items()}
    return Meant(
        text=text, language=str(fields.get("language", "")), kind=kind, objective=objective,
        constraints=checked_constraints(constraints), line=number,
    )  # fmt: skip


def _listed(value: Any) -> Any:
    """Users, which JSON has as a list, as Intent has them; anything else as it is."""
    return tuple(str(user) for user in cast("list[Any]", value)) if isinstance(value, list) else value


def evaluate(
    recogniser: Recogniser, sentences: Sequence[Meant], told: Callable[[int, int], object] = lambda done, total: None
) -> list[Understood]:
    """Each sentence understood and timed by itself, without a conversation around it."""
    found: list[Understood] = []
    for done, meant in enumerate(sentences, start=1):
        start = time.perf_counter()
        intent = recogniser.recognise(meant.text)
        found.append(compared(meant, intent, time.perf_counter() - start))
        told(done, len(sentences))
    return found


def compared(meant: Meant, intent: Intent, seconds: float = 0.0) -> Understood:
    """How an intent compares with what was meant."""
    goal_right = (intent.kind, intent.objective) == (meant.kind, meant.objective)
    constraints_right = same_constraints(intent.constraints, meant.constraints)
    acts = intent.kind == "allocate" or (intent.kind == "command" and intent.topic in _ACTING_COMMANDS)
    return Understood(
        meant=meant, intent=intent, seconds=seconds, goal_right=goal_right, constraints_right=constraints_right,
        wrong_action=acts and not (goal_right and constraints_right),
        unit_errors=tuple(_unit_errors(intent.constraints, meant.constraints)),
    )  # fmt: skip


def figures_of(found: Sequence[Understood]) -> Figures:
    """The figures of a whole evaluation."""
    quantified = [each for each in found if each.meant.constraints]
    times = np.array([1000 * each.seconds for each in found])
    languages = {each.meant.language: (0, 0) for each in found}
    for each in found:
        right, total = languages[each.meant.language]
        languages[each.meant.language] = (right + each.goal_right, total + 1)
    return Figures(
        sentences=len(found), with_quantities=len(quantified),
        kind_and_objective=_share(each.goal_right for each in found),
        constraints=_share(each.constraints_right for each in quantified),
        wrong_actions=_share(each.wrong_action for each in found),
        unit_errors=sum(len(each.unit_errors) for each in found),
        median_ms=float(np.median(times)), slow_ms=float(np.quantile(times, 0.95)), by_language=languages,
        confusion=Counter((_named(each.meant), _named(each.intent)) for each in found),
    )  # fmt: skip


def _by_user(value: float | Mapping[str, float]) -> Mapping[str, float]:
    return value if isinstance(value, Mapping) else {"all": value}


def _unit_errors(got: Mapping[str, Constraint], meant: Mapping[str, Constraint]) -> Iterable[str]:
    """The names of constraints whose figure is the meant one in another unit."""
    for name, value in got.items():
        other = meant.get(name)
        if other is None or isinstance(value, tuple) or isinstance(other, tuple):
            continue
        a, b = _by_user(value), _by_user(other)
        if any(_confuses_units(a[user], b[user]) for user in a if user in b):
            yield name


def _confuses_units(got: float, meant: float) -> bool:
    """Whether one figure is the other by a power of ten, by eight or 1024, or by decibels for watts.

    >>> _confuses_units(0.01, 10.0), _confuses_units(10.0, 0.01), _confuses_units(12.0, 10.0)
    (True, True, False)
    """
    if not (0 < got < math.inf and meant > 0) or math.isclose(got, meant, rel_tol=_CLOSE):
        return False
    tens = math.log10(got / meant)
    if abs(tens - round(tens)) < _CLOSE or any(math.isclose(max(got, meant), k * min(got, meant)) for k in (8, 1024)):
        return True
    pairs = ((got, meant), (meant, got))
    return any(math.isclose(a, dbm_to_w(b + shift), rel_tol=1e-6) for a, b in pairs for shift in (0.0, 30.0) if b < 200)


def _named(one: Meant | Intent) -> str:
    return one.objective or one.kind


def _share(hits: Iterable[bool]) -> float:
    counted = list(hits)
    return sum(counted) / len(counted) if counted else 1.0

"""What an LLM is told, and the form that it fills in: the meaning of an intent, with figures by reference.

It is told the task, with the registered objectives, and one sentence with its figures, as JSON. The sentence, the
users' names and everything else that others wrote stand in the data only, never in the instructions. The figures that
the LLM may use are the parser's, what the rules make of them (99 % reliability is an outage of 1 %, 40 % of the power
is 8 W) and the conversation's own; it refers to them by label or by value, and brings none itself.
"""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias, cast

from pydantic import BaseModel, ConfigDict, Field, create_model

from wirelessagent import plugins
from wirelessagent.language.comparators import Comparator
from wirelessagent.language.intent import COMMANDS, EVERYBODY, QUESTIONS, Constraint, Detail, Intent, IntentKind
from wirelessagent.language.numerals import numbers
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence
from wirelessagent.language.vocabulary import OwnWords

_MOST_USERS = 300
_LONGEST_NAME = 60
_UNITS = {"power": "W", "rate": "bit/s"}
_LONGEST = 600

FiguredConstraint = Literal[
    "max_power_w", "min_rate_bps", "max_rate_bps", "circuit_power_w", "outage_probability", "weights",
    "subcarrier_max_power_w", "resource_block_group_size",
]  # fmt: skip
AnyConstraint = Literal[FiguredConstraint, "users", "leave_out"]
Reference = str | float
_REFERENCE = "label of a figure that is listed, such as F1, or its value"

FigureKind: TypeAlias = Literal["power", "rate", "ratio", "number"]

KINDS: Mapping[str, FigureKind] = {
    "max_power_w": "power", "circuit_power_w": "power", "subcarrier_max_power_w": "power", "min_rate_bps": "rate",
    "max_rate_bps": "rate", "outage_probability": "ratio", "weights": "number", "resource_block_group_size": "number",
    "power_w": "power", "rate_bps": "rate", "missing_share": "ratio", "number": "number",
}  # fmt: skip
"""Which kind of figure each constraint takes, and each detail of a question or a command."""


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A figure: F1 for the sentence's own, N1 for its other numbers, S1 for the conversation's or the rules'.

    ``words`` are the operator's or say where it comes from; ``comparator`` is how the sentence bounds it, and
    ``stands_for`` the constraint or detail that an S belongs to, and no other.
    """

    label: str
    value: float
    kind: FigureKind
    words: str
    comparator: Comparator | None = None
    stands_for: str = ""


def figures_of(
    sentence: Sentence, context: Context, offline: Intent, rules: Mapping[str, Constraint]
) -> tuple[Figure, ...]:
    """Every figure that may be used for a sentence, of which the rules read these constraints.

    >>> from wirelessagent.language.offline import recognise
    >>> from wirelessagent.language.sentence import own_words
    >>> text = "at most 10 W"
    >>> found = figures_of(Sentence(text, own_words()), Context(), recognise(text), {"max_power_w": 10.0})
    >>> [(figure.label, figure.value) for figure in found]
    [('F1', 10.0), ('S1', 20.0)]
    """
    known: list[Figure] = []
    for place, q in enumerate(sentence.quantities, start=1):
        kind: FigureKind = q.kind if q.kind in ("power", "rate", "ratio") else "number"
        if 0 < q.value < math.inf and not q.doubtful:
            known.append(Figure(label=f"F{place}", value=q.value, kind=kind, words=q.text, comparator=q.comparator))
    inside = [(quantity.start, quantity.end) for quantity in sentence.quantities]
    for place, number in enumerate(numbers(sentence.plain), start=1):
        value = math.inf if number.value is None else float(number.value)
        if math.isfinite(value) and not any(start <= number.start < end for start, end in inside):
            words = sentence.plain[number.start : number.end]
            known.append(Figure(label=f"N{place}", value=value, kind="number", words=words))
    said = {**sentence.reading.evidence, **offline.evidence}
    held = [("max_power_w", context.max_power_w, "the cell's limit")]
    held += [(name, value, f"{name} of the current request") for name, value in _values(context.constraints)]
    held += [(name, value, f"{name}, said before the question") for name, value in _values(context.question.pending)]
    read = [(name, value, said.get(name) or name) for name, value in _values({**offline.details, **rules})]
    held += [each for each in read if matching(known, each[1], each[0]) is None]
    for place, (name, value, words) in enumerate(held, start=1):
        known.append(Figure(label=f"S{place}", value=value, kind=KINDS[name], words=words, stands_for=name))
    return tuple(known)


def matching(figures: Iterable[Figure], given: str | float, name: str) -> Figure | None:
    """The figure that a label or a value refers to for a constraint or a detail; the sentence's own before others."""
    fitting = (figure for figure in figures if figure.kind == KINDS[name] and figure.stands_for in ("", name))
    return next((figure for figure in fitting if _means(figure, given)), None)


def _means(figure: Figure, given: str | float) -> bool:
    try:
        return math.isclose(figure.value, float(given), rel_tol=1e-6)
    except ValueError:
        return isinstance(given, str) and figure.label.casefold() == given.strip().casefold()


def _values(stated: Mapping[str, Constraint | Detail]) -> Iterator[tuple[str, float]]:
    """The figures among constraints and details, by name."""
    for name, value in stated.items():
        each = value.values() if isinstance(value, Mapping) else [value]
        yield from ((name, float(one)) for one in each if name in KINDS and isinstance(one, int | float))


def instructions(own: Iterable[OwnWords]) -> str:
    """The task, with the objectives that are registered, what each is and how operators ask for it."""
    summaries = {found.name: found.summary for found in plugins.plugins("objective")}
    lines: list[str] = []
    for words in own:
        said = "; ".join(f"{language}: {', '.join(phrases)}" for language, phrases in words.phrases if phrases)
        lines.append(f"- {words.objective}: {summaries.get(words.objective, '')}" + (f" ({said})" if said else ""))
    task = Path(__file__).with_name("task.txt").read_text(encoding="utf-8")
    return task.rstrip().format(objectives="\n".join(lines))


def case(text: str, figures: Iterable[Figure], context: Context) -> str:
    """One sentence with its figures and what it may refer to, as JSON."""
    names = [name[:_LONGEST_NAME] for name in context.user_names[:_MOST_USERS]]
    current = {"objective": context.objective, "constraints": plain(context.constraints)}
    data = {
        "sentence": text,
        "figures": [
            {"label": figure.label, "words": figure.words, "kind": figure.kind, "value": figure.value,
             "unit": _UNITS.get(figure.kind, ""), "bound": figure.comparator}
            for figure in figures
        ],
        "user_names": names,
        "num_users": len(context.user_names),
        "current_request": None if context.objective is None else current,
        "awaited": context.awaits,
        "before_the_question": plain(context.question.pending),
    }  # fmt: skip
    return json.dumps(data, ensure_ascii=False)


def plain(constraints: Mapping[str, Constraint]) -> dict[str, Any]:
    """Constraints as JSON takes them."""
    found: dict[str, Any] = {}
    for name, value in constraints.items():
        if isinstance(value, Mapping):
            found[name] = {("everybody else" if user == EVERYBODY else user): each for user, each in value.items()}
        else:
            found[name] = list(value) if isinstance(value, tuple) else value
    return found


class _Filled(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Stated(_Filled):
    """One constraint that the sentence states."""

    constraint: FiguredConstraint
    figure: Reference = Field(description=_REFERENCE)
    users: list[str] = Field(
        default_factory=list, max_length=1000, description="whose, as the operator calls them ('3'); empty: everybody's"
    )


class Details(_Filled):
    """Figures and names of a question or a command."""

    user: str | None = Field(None, max_length=100, description="the user it is about, as the operator calls them ('3')")
    compared_with: str | None = Field(
        None, max_length=100, description="'last', or the registered name of a method or repairer to compare with"
    )
    number: Reference | None = Field(None, description=f"number of an entry of the history: {_REFERENCE}")
    format: Literal["ts28312", "tmf921"] | None = None
    missing_share: Reference | None = Field(None, description=f"share of gains that would be missing: {_REFERENCE}")
    power_w: Reference | None = Field(None, description=f"a step of power: {_REFERENCE}")
    rate_bps: Reference | None = Field(None, description=f"a step of rate: {_REFERENCE}")


class Meaning(_Filled):
    """The meaning of the operator's sentence. Figures are referred to, never made."""

    kind: IntentKind
    objective: str | None = Field(None, description="for allocate, or for a what-if question about another objective")
    objective_words: str = Field("", max_length=_LONGEST, description="the operator's own words for it, copied exactly")
    constraints: list[Stated] = Field(default_factory=list[Stated], max_length=1000)
    users: list[str] = Field(default_factory=list, max_length=1000, description="users to serve alone, such as '3'")
    leave_out: list[str] = Field(default_factory=list, max_length=1000, description="users to leave out, such as '3'")
    drops: list[AnyConstraint] = Field(
        default_factory=list[AnyConstraint], description="constraints of the current request that no longer hold"
    )
    amends: bool = Field(False, description="whether it changes the current request instead of replacing it")
    topic: str | None = Field(None, description="for command and question")
    details: Details = Field(default_factory=lambda: Details.model_validate({}))
    question: str = Field("", max_length=_LONGEST, description="for clarify: what to ask, in the operator's language")
    language: str = Field(pattern=r"^[a-z]{2,3}$", description="the operator's language, such as en or zh")


@functools.lru_cache(maxsize=8)
def meaning_with(objectives: tuple[str, ...]) -> type[Meaning]:
    """The type of a meaning whose objective is one of these, and whose topic is one that there is."""
    make = cast("Callable[..., type[Meaning]]", create_model)
    choices: dict[str, Any] = {
        name: (cast("Any", Literal)[values] | None, Meaning.model_fields[name])
        for name, values in (("objective", objectives), ("topic", (*COMMANDS, *QUESTIONS)))
    }
    return make("Meaning", __base__=Meaning, __doc__=Meaning.__doc__, **choices)

"""Methods side by side on the same problem."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np

from wirelessagent import plugins
from wirelessagent.chain import decide, resolve
from wirelessagent.deciding.method import Method
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import UnknownNameError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem
from wirelessagent.model.shown import Picture, Plain, Shown, Summary
from wirelessagent.model.units import human, percent
from wirelessagent.plugin_options import options_of


@dataclass(frozen=True, kw_only=True, repr=False)
class Compared(Plain):
    """One method's answer beside the others': its decision, or why it has none, and the time it took."""

    method: str
    decision: Decision | None
    refusal: str
    time_s: float

    @property
    def status(self) -> str:
        """The decision's, or "refused"."""
        return "refused" if self.decision is None else self.decision.status


@dataclass(frozen=True, repr=False)
class Comparison(Shown):
    """Each method's answer, in the order in which the methods were named: to be gone through, counted and indexed."""

    answers: tuple[Compared, ...]

    def __iter__(self) -> Iterator[Compared]:
        return iter(self.answers)

    def __len__(self) -> int:
        return len(self.answers)

    def __getitem__(self, place: int) -> Compared:
        return self.answers[place]

    def summary(self) -> Summary:
        header = ("method", "status", "value", "bound", "gap", "power", "time")
        rows = [(one.method, one.status, *_figures(one.decision), human(one.time_s, "s")) for one in self]
        return Summary(title=f"Comparison of {len(self)} methods", header=header, rows=tuple(rows))

    def picture(self) -> Picture | None:
        decided = any(one.decision is not None for one in self)
        return Picture(kind="comparison", parts={"found": self.answers}) if decided else None

    def columns(self) -> Mapping[str, Any]:
        """One row for each method; NaN where it has no decision."""
        names = ("value", "bound", "gap", "total_power_w")
        return {
            "method": [one.method for one in self],
            "status": [one.status for one in self],
            **{
                name: [np.nan if one.decision is None else getattr(one.decision, name) for one in self]
                for name in names
            },
            "time_s": [one.time_s for one in self],
            "refusal": [one.refusal for one in self],
        }


def _figures(decision: Decision | None) -> tuple[str, str, str, str]:
    if decision is None:
        return "–", "–", "–", "–"
    value, bound = (human(figure, decision.unit) for figure in (decision.value, decision.bound))
    return value, bound, percent(decision.gap), human(decision.total_power_w, "W") if decision.is_usable else "–"


def compare(
    estimate: ChannelEstimate,
    problem: Problem,
    cell: Cell | None = None,
    methods: Iterable[str | Method] | None = None,
    **options: Any,
) -> Comparison:
    """Each method's decision on the same problem; all methods that solve it if none are named.

    An option goes to every method by name that has it; methods of your own making, as in Dual(effort="thorough"), have
    their options already. The time is the second call's, so that compiling is not counted. A method that was named
    and does not solve the problem is listed with its refusal; one that was not named is left out.

    Raises:
        UnknownNameError: none of the methods has an option of this name.
    """
    resolved = resolve(problem)
    named = list(methods) if methods is not None else [one.name for one in plugins.plugins("method") if one.cls]
    known = {name: {one.name for one in options_of(plugins.load("method", name))} for name in named if _is_name(name)}
    surplus = options.keys() - set[str]().union(*known.values())
    if surplus:
        of = f"the methods {', '.join(map(_label, named))}"
        raise UnknownNameError("option", min(surplus), set[str]().union(*known.values()), of=of, beside=("methods",))
    found: list[Compared] = []
    for method in named:
        own = {name: value for name, value in options.items() if _is_name(method) and name in known[method]}
        try:
            decide(estimate, resolved, cell, method, **own)
        except UnsupportedProblemError as refusal:
            if methods is not None:
                found.append(Compared(method=_label(method), decision=None, refusal=str(refusal), time_s=np.nan))
            continue
        start = time.perf_counter()
        decision = decide(estimate, resolved, cell, method, **own)
        elapsed = time.perf_counter() - start
        found.append(Compared(method=_label(method), decision=decision, refusal="", time_s=elapsed))
    return Comparison(tuple(found))


def _is_name(method: str | Method) -> TypeGuard[str]:
    return isinstance(method, str)


def _label(method: str | Method) -> str:
    """A method's name, with the options that are not at their defaults: "dual (effort=thorough)"."""
    if isinstance(method, str):
        return method
    values = {one.name: (getattr(method, one.name), one.default) for one in options_of(type(method))}
    set_apart = [f"{name}={value}" for name, (value, default) in values.items() if value != default]
    return f"{method.name} ({', '.join(set_apart)})" if set_apart else method.name

"""Calls, times and tables of the bars."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError, UnsupportedProblemError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.problem import Problem

CONTENDERS: dict[str, tuple[str, dict[str, Any]]] = {
    "paper's rule": ("paper", {}),
    "greedy": ("greedy", {}),
    "dual fast": ("dual", {"effort": "fast"}),
    "dual thorough": ("dual", {"effort": "thorough"}),
    "exact": ("exact", {}),
}
"""Who is measured: a label, a registered method and its options. Methods that are not installed are left out."""


def contenders(*labels: str) -> dict[str, tuple[str, dict[str, Any]]]:
    """Those of ``labels`` (all if none are given) whose method is installed."""
    installed = set(plugins.names("method"))
    return {label: CONTENDERS[label] for label in labels or CONTENDERS if CONTENDERS[label][0] in installed}


def seconds(call: Callable[[], Any], *, at_least_s: float = 0.01, calls: int = 3) -> float:
    """The median time of a call, over at least ``calls`` of them and ``at_least_s`` in all, after a warm-up."""
    times: list[float] = []
    while len(times) < calls or sum(times) < at_least_s:
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
        if times[-1] > 1.0:
            break
    return float(np.median(times))


def fastest(call: Callable[[], Any], *, at_least_s: float = 0.5) -> float:
    """The least time of a call, over blocks of about a millisecond: what the machine does when nobody disturbs it."""
    start = time.perf_counter()
    call()
    block = max(1, int(1e-3 / (time.perf_counter() - start)))
    least, spent = np.inf, 0.0
    while spent < at_least_s:
        start = time.perf_counter()
        for _ in range(block):
            call()
        elapsed = time.perf_counter() - start
        least, spent = min(least, elapsed / block), spent + elapsed
    return least


@dataclass
class Tally:
    """What one method did on many draws.

    Attributes:
        gap: certified gaps of usable decisions.
        distance: (value − optimum)/|optimum|, positive where worse, of usable decisions with a proven optimum beside.
        time_s: median time of a call of ``wa.decide``, one per draw.
        statuses: the statuses met, one per draw.
        refusal: why the method does not solve such problems.
        beaten: decisions better than what was held to be the optimum, which must not be.
    """

    gap: list[float] = field(default_factory=list)
    distance: list[float] = field(default_factory=list)
    time_s: list[float] = field(default_factory=list)
    statuses: list[str] = field(default_factory=list)
    refusal: str = ""
    beaten: int = 0

    def ask(
        self,
        estimate: ChannelEstimate,
        problem: Problem,
        cell: Cell,
        method: str,
        *,
        optimum: float = np.nan,
        timed: bool = True,
        **options: Any,
    ) -> Decision | None:
        """Let ``method`` decide and note how it did; None where it refuses such problems."""
        first = time.perf_counter()
        try:
            decision = wa.decide(estimate, problem, cell, method, **options)
        except UnsupportedProblemError as refusal:
            self.refusal = str(refusal)
            return None
        except InputError as refusal:  # a method may only take problems of some size
            self.statuses.append("refused")
            self.refusal = str(refusal)
            return None
        elapsed = time.perf_counter() - first
        if timed and elapsed < 1.0:
            elapsed = seconds(lambda: wa.decide(estimate, problem, cell, method, **options))
        self.time_s.append(elapsed)
        self.statuses.append(decision.status)
        if decision.is_usable:
            self.gap.append(decision.gap)
            self.distance.append(worse_by(decision.value, optimum, decision))
            self.beaten += self.distance[-1] < -1e-9
        return decision

    @property
    def distance_known(self) -> bool:
        return bool(np.isfinite(self.distance).any())

    def figures(self, *, is_exact: bool = False) -> list[str]:
        """Distance to the optimum, certified gap and time: medians and maxima; of the exact method, what is proven."""
        distance = [f"proven: {self.share('optimal')}", ""] if is_exact else list(spread(self.distance))
        if self.beaten:
            distance[1] += f", BEATEN {self.beaten} times"
        return [*distance, *spread(self.gap), *spread(self.time_s, duration)]

    def share(self, *statuses: str) -> str:
        """The share of draws that ended with one of ``statuses``."""
        return percent(np.mean([status in statuses for status in self.statuses])) if self.statuses else "–"


def worse_by(value: float, optimum: float, decision: Decision) -> float:
    """(value − optimum)/|optimum|, positive where the value is worse."""
    objective = decision.problem.objective
    assert not isinstance(objective, str)
    sign = 1.0 if objective.direction == "min" else -1.0
    return sign * (value - optimum) / abs(optimum) if optimum else np.nan


def proven(decision: Decision | None) -> float:
    """The value of a decision that is proven optimal, else NaN."""
    return decision.value if decision is not None and decision.status == "optimal" else np.nan


def percent(share: float) -> str:
    return "–" if np.isnan(share) else f"{100 * share + 0.0:.3g} %"


def duration(time_s: float) -> str:
    if np.isnan(time_s):
        return "–"
    scales = ((1.0, "s"), (1e3, "ms"), (1e6, "µs"))
    factor, unit = next((scale for scale in scales if time_s * scale[0] >= 1.0), scales[-1])
    return f"{time_s * factor:.3g} {unit}"


def spread(values: Iterable[float], show: Callable[[float], str] = percent) -> tuple[str, str]:
    """Median and maximum, as shown in tables."""
    finite = [value for value in values if not np.isnan(value)]
    return (show(float(np.median(finite))), show(max(finite))) if finite else ("–", "–")


def table(title: str, header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table, columns as wide as they need."""
    cells = [list(header), *(list(row) for row in rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    print(f"\n{title}")
    for number, row in enumerate(cells):
        print(
            "  "
            + "  ".join(
                text.ljust(w) if i < 2 else text.rjust(w) for i, (text, w) in enumerate(zip(row, widths, strict=True))
            )
        )
        if number == 0:
            print("  " + "  ".join("-" * w for w in widths), flush=True)

"""One picture of several methods on one problem: how good each answer is, how much it proves, and what it costs."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path

from wirelessagent.comparison import Compared
from wirelessagent.model.decision import OPTIMAL_GAP, Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.objective import Objective
from wirelessagent.model.units import human, percent, prefixed
from wirelessagent.pictures.canvas import GREY, PALETTE, Canvas, Panel, can_show, check_suffix
from wirelessagent.pictures.method_names import readable
from wirelessagent.pictures.needed import needed_lines

_NOTHING = "no allocation"
_STATUSES = {"optimal": ("o", PALETTE[2]), "feasible": ("D", PALETTE[0]), _NOTHING: ("X", GREY)}
"""Shape and colour of a decision's marks."""
_WIDE = 20.0
"""Ratio of values from which their axis is logarithmic."""
_ROOM = 0.08
"""Of an axis, on either side of what it shows."""
_MOST_TICKS = 6
_MARK_PT = 8.0


def draw_comparison(found: Sequence[Compared], path: Path) -> None:
    """Write the picture of a comparison, :func:`comparison_canvas`, to ``path``: PNG, SVG or PDF.

    Raises:
        InputError: nothing to compare, an unknown suffix, or a path that cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    path = Path(path)
    check_suffix(path)
    comparison_canvas(found).save(path)


def comparison_canvas(found: Sequence[Compared]) -> Canvas:
    """The picture of ``wa.compare(…)``: a row for each method in the order given, in three panels.

    The value of each allocation, with a line to the method's own bound and a dashed one at the tightest bound of all;
    the gap; and the time. Methods without an allocation have their status instead; where none has one, the picture
    says why and what it would take.

    Raises:
        InputError: no method is given, or none was able to decide.
        MissingDependencyError: matplotlib is not installed.
    """
    decisions = [one.decision for one in found if one.decision is not None]
    if not decisions:
        raise InputError("there is no decision to draw: compare methods that solve the problem")
    objective = decisions[0].problem.objective
    assert isinstance(objective, Objective)
    if not any(decision.is_usable for decision in decisions):
        return _nothing_canvas(found, decisions, objective)
    canvas = Canvas(columns=3, width_in=11.0, height_in=1.8 + 0.5 * max(len(found), 3))
    value, gap, time = canvas.panels
    canvas.title(f"Methods for {objective.name}")
    _draw_values(value, found, objective)
    _draw_gaps(gap, found)
    _draw_times(time, found)
    names = [
        readable(one.method) if can_show(one.method) else f"method {row}" for row, one in enumerate(found, start=1)
    ]
    for panel in canvas.panels:
        panel.grid()
        panel.limits(y=(len(found) - 0.5, -0.8))
        panel.ticks("y", range(len(found)), names if panel is value else [""] * len(found))
    canvas.legend_below(value, columns=5)
    return canvas


def _nothing_canvas(found: Sequence[Compared], decisions: Sequence[Decision], objective: Objective) -> Canvas:
    """Why there is no allocation, in the words of the first method that has none, and who says what."""
    statuses = ("refused" if one.decision is None else one.decision.status for one in found)
    verdicts = [f"{readable(one.method)}: {status}" for one, status in zip(found, statuses, strict=True)]
    reason = next((f"{one.status}: {one.reason}" for one in decisions if one.reason), "")
    said = [reason, *needed_lines(decisions), "; ".join(verdicts)]
    canvas = Canvas(width_in=8.0, height_in=3.0)
    canvas.title(f"Methods for {objective.name}: none has an allocation")
    canvas.panels[0].note("\n\n".join(textwrap.fill(line, 84) for line in said if line))
    return canvas


def _draw_values(panel: Panel, found: Sequence[Compared], objective: Objective) -> None:
    """The values on one axis, from which each method's line leads to what it has proven."""
    usable = _usable(found)
    bounds = [one.decision.bound for one in found if one.decision is not None and math.isfinite(one.decision.bound)]
    tightest = (min if objective.direction == "max" else max)(bounds, default=math.nan)
    shown = [decision.value for _, decision in usable] + [tightest] * bool(bounds)
    scale, unit = prefixed(max(shown, default=0.0), objective.unit)
    more, beyond = ("more", "above") if objective.direction == "max" else ("less", "below")
    panel.describe(f"Value ({more} is better)", f"Value ({unit})", "")
    _axis(panel, [one / scale for one in shown], logarithmic=0.0 < _WIDE * min(shown, default=0.0) < max(shown))
    told = "the method's own bound"
    for row, decision in usable:
        if math.isfinite(decision.bound):
            panel.span(decision.value / scale, decision.bound / scale, row, colour=GREY, label=told)
            told = None
    if bounds:
        panel.upright(tightest / scale, label=f"no allocation is {beyond} {tightest / scale:.4g} {unit}")
    for row, decision in usable:
        _mark(panel, decision.value / scale, row, decision, f"{decision.value / scale:.4g}")
    for row, one in enumerate(found):
        if one.decision is None or not one.decision.is_usable:
            panel.caption(row, "refused" if one.decision is None else one.decision.status)
    met = {one.decision.status if one.decision.is_usable else _NOTHING for one in found if one.decision is not None}
    for status, (shape, colour) in _STATUSES.items():
        if status in met:
            panel.marks([math.nan], [math.nan], size_pt=_MARK_PT, shape=shape, colour=colour, label=status)


def _draw_gaps(panel: Panel, found: Sequence[Compared]) -> None:
    """The gaps in % on a logarithmic axis, whose left end stands for none."""
    panel.describe("Gap (the optimum is at most that far)", "Gap to the method's own bound (%)", "")
    gaps = {row: 100.0 * decision.gap for row, decision in _usable(found)}
    open_gaps = [gap for gap in gaps.values() if 100.0 * OPTIMAL_GAP < gap < math.inf]
    lowest, highest = _decades(open_gaps or [1.0])
    none = 10.0 ** (lowest - 1)
    _axis(panel, [none, 10.0**highest], logarithmic=True)
    step = math.ceil((highest - lowest + 1) / _MOST_TICKS)
    decades = [10.0**decade for decade in range(lowest, highest + 1, step)]
    panel.ticks("x", [none, *decades], ["0", *(f"{decade:g}" for decade in decades)])
    for row, decision in _usable(found):
        gap = gaps[row]
        if not math.isfinite(gap):
            panel.caption(row, "no bound")
        elif decision.gap <= OPTIMAL_GAP:
            _mark(panel, none, row, decision, "0 %")
        else:
            _mark(panel, gap, row, decision, percent(decision.gap))


def _draw_times(panel: Panel, found: Sequence[Compared]) -> None:
    """What a decision takes, in ms."""
    panel.describe("Time (of one decision)", "Time (ms)", "")
    lowest, highest = _decades([1e3 * one.time_s for one in found if one.decision is not None])
    _axis(panel, [10.0**lowest, 10.0**highest], logarithmic=True)
    panel.plain_ticks("x", [10.0**decade for decade in range(lowest, highest + 1)])
    for row, one in enumerate(found):
        if one.decision is not None:
            _mark(panel, 1e3 * one.time_s, row, one.decision, human(one.time_s, "s"))


def _usable(found: Sequence[Compared]) -> list[tuple[int, Decision]]:
    """Rows and decisions of the methods that have an allocation."""
    return [(row, one.decision) for row, one in enumerate(found) if one.decision is not None and one.decision.is_usable]


def _mark(panel: Panel, x: float, row: int, decision: Decision, text: str) -> None:
    shape, colour = _STATUSES[decision.status if decision.is_usable else _NOTHING]
    panel.marks([x], [row], size_pt=_MARK_PT, shape=shape, colour=colour, label=None)
    panel.tag(x, row, text)


def _axis(panel: Panel, shown: Sequence[float], *, logarithmic: bool) -> None:
    """An x axis with some room on either side of the values."""
    low, high = min(shown, default=0.0), max(shown, default=1.0)
    if logarithmic:
        room = (high / low) ** _ROOM
        panel.scales(x="log")
        panel.limits(x=(low / room, high * room))
    else:
        room = _ROOM * (high - low) or 0.05 * abs(high) or 1.0
        panel.limits(x=(low - room, high + room))


def _decades(values: Sequence[float]) -> tuple[int, int]:
    """The powers of ten that enclose the values."""
    lowest, highest = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return lowest, max(highest, lowest + 1)

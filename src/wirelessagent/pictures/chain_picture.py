"""One picture of a run of the chain: what was sensed, repaired, decided and, where known, achieved."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.rates import normalised_gain, owned_gain
from wirelessagent.model.units import db, human, prefixed
from wirelessagent.pictures.canvas import GREY, PALETTE, Canvas, Panel, can_show, check_suffix
from wirelessagent.pictures.method_names import readable
from wirelessagent.pictures.needed import needed_lines

_MOST_NAMED = 16
"""Users up to which every one gets a tick with its name; more are counted."""

_GREYS = ("#C4C4C4", "#5A5A5A")
"""Of predicted and achieved rates: greys, because the colours beside are the users'."""

_ZERO_DB = -4000.0

_SMALLEST_DOTTED_CELL_PT = 5.0
_LEGEND_ROW_PT = 14.0

_DYNAMIC_RANGE_DB = 80.0
"""Gains further below the strongest are drawn in the scale's last colour, which gets an arrow."""


def draw_chain(
    *,
    observation: ChannelObservation,
    estimate: ChannelEstimate,
    decision: Decision,
    outcome: Outcome | None,
    path: Path,
) -> None:
    """Write the picture of a run, :func:`chain_canvas`, to ``path``: PNG, SVG or PDF, whole or not at all.

    Raises:
        InputError: an unknown suffix, or a path that cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    path = Path(path)
    check_suffix(path)
    chain_canvas(observation=observation, estimate=estimate, decision=decision, outcome=outcome).save(path)


def chain_canvas(
    *, observation: ChannelObservation, estimate: ChannelEstimate, decision: Decision, outcome: Outcome | None
) -> Canvas:
    """The picture of a run, in four panels.

    The sensed gains with their holes, the repaired ones with the repaired entries marked, owner and power of each
    subcarrier, and each user's predicted rate beside the achieved one. Subcarriers are counted from 1, and so are
    users whose names the font cannot show, or who are too many to be named on an axis. Where nothing is allocated, the
    panel of the powers has the reason instead, and that of the rates only what was asked for.
    """
    canvas = Canvas(rows=2, columns=2, width_in=11.0, height_in=7.4)
    sensed, repaired, allocation, rates = canvas.panels
    names = labels(decision.user_names)
    draw_gains(sensed, repaired, observation, estimate, names)
    draw_allocation(allocation, decision, names, estimate)
    draw_rates(rates, decision, names, outcome)
    return canvas


def draw_gains(
    sensed: Panel, repaired: Panel, observation: ChannelObservation, estimate: ChannelEstimate, names: list[str]
) -> None:
    """The sensed gains with their holes, and beside them the repaired ones in the same colours."""
    sensed_db, estimate_db = (gain_db(gain) for gain in (observation.current, estimate.gain))
    lowest, highest, clipped = colour_limits(estimate_db)
    for panel, shown_db in ((sensed, sensed_db), (repaired, estimate_db)):
        panel.matrix(shown_db, limits=(lowest, highest), clipped=clipped, colour_label="Power gain (dB)")
        subcarrier_ticks(panel, estimate.num_subcarriers)
    lost = np.count_nonzero(observation.missing)
    share = lost / observation.missing.size
    sensed.describe(
        f"Sensed: {lost} of {observation.missing.size} gains missing ({share:.0%})",
        "Subcarrier",
        user_ticks(sensed, "y", names),
    )
    mark = mark_repaired(repaired, estimate.repaired)
    title = f"Repaired by {readable(estimate.method)} ({mark})" if lost else "Nothing to repair"
    repaired.describe(title, "Subcarrier", user_ticks(repaired, "y", names))


def labels(user_names: tuple[str, ...]) -> list[str]:
    """Names short enough for a tick and within the font's characters; else, or if they are many, the user's number."""
    if len(user_names) > _MOST_NAMED:
        return [f"user {k}" for k in range(1, len(user_names) + 1)]
    return [
        textwrap.shorten(name, 14, placeholder="…") if can_show(name) and len(name.split(" ")[0]) < 14 else f"user {k}"
        for k, name in enumerate(user_names, start=1)
    ]


def gain_db(gain: FloatArray) -> FloatArray:
    """Gains in dB; zero becomes a value below every colour scale, while NaN stays NaN."""
    return db(gain, floor_db=_ZERO_DB)


def colour_limits(gain_db: FloatArray) -> tuple[float, float, bool]:
    """Lowest and highest gain of the colour scale in dB, and whether lower ones exist."""
    positive = gain_db[gain_db > _ZERO_DB]
    if not positive.size:
        return -1.0, 0.0, True
    highest = float(positive.max())
    lowest = max(float(positive.min()), highest - _DYNAMIC_RANGE_DB)
    clipped = lowest > float(gain_db.min())
    return (lowest, highest, clipped) if highest > lowest else (highest - 1.0, highest + 1.0, clipped)


def user_ticks(panel: Panel, axis: Literal["x", "y"], names: list[str]) -> str:
    """A tick with each user's name, or, where they are too many, even ticks with numbers; the label of the axis."""
    count = len(names)
    if count > _MOST_NAMED:
        step = _step(count, most_ticks=10)
        numbers = range(step, count + 1, step)
        panel.ticks(axis, [k - 1 for k in numbers], [str(k) for k in numbers])
        return "User (number)"
    panel.ticks(axis, range(count), names, slanted=axis == "x" and max(map(len, names)) * count > 56)
    return ""


def subcarrier_ticks(panel: Panel, num_subcarriers: int) -> None:
    """Ticks at subcarriers 1, step, 2 step, …, counted from 1."""
    step = _step(num_subcarriers, most_ticks=8)
    numbers = sorted({1, *range(step, num_subcarriers + 1, step)})
    if step > 1 and len(numbers) > 1 and numbers[1] - 1 <= step / 2:
        del numbers[1]
    panel.ticks("x", [n - 1 for n in numbers], [str(n) for n in numbers])


def _step(count: int, *, most_ticks: int) -> int:
    """The smallest of the steps 1, 2, 5, 10, … with which so many ticks are enough."""
    return next((step for step in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if count / step <= most_ticks), 5000)


def mark_repaired(panel: Panel, where: BoolArray) -> str:
    """Mark the repaired entries and say how: a dot in each, or a paler colour where a dot would not fit."""
    users, subcarriers = np.nonzero(where)
    width, height = panel.size_pt()
    cell = min(width / where.shape[1], height / where.shape[0])
    if cell < _SMALLEST_DOTTED_CELL_PT:
        panel.fade(where)
        return "paler"
    if len(users):
        panel.marks(subcarriers, users, size_pt=min(0.35 * cell, 5.0), shape="o", colour="white", label=None)
    return "white dots"


def draw_allocation(panel: Panel, decision: Decision, names: list[str], estimate: ChannelEstimate | None) -> None:
    """Power per subcarrier in its owner's colour with a water level if there is one, or why nothing is allocated."""
    if decision.is_usable and decision.power_w.any():
        title = f"Decided by {readable(decision.method)}: {human(decision.total_power_w, 'W')}"
        draw_powers(panel, title, decision.owner, decision.power_w, names, _water_level_w(estimate, decision))
        return
    reason = "No power is radiated" if decision.is_usable else f"{decision.status}: {decision.reason}"
    verdict = "0 W" if decision.is_usable else decision.status
    panel.describe(f"Decided by {readable(decision.method)}: {verdict}", "", "")
    panel.note("\n".join(textwrap.fill(line, 48) for line in [reason, *needed_lines([decision])]))


def draw_powers(
    panel: Panel, title: str, owner: IntArray, power_w: FloatArray, names: list[str], level_w: float | None = None
) -> None:
    """Power per subcarrier in its owner's colour; a strip below shows the owner where it is too little to be seen."""
    tallest = max(float(power_w.max()), level_w or 0.0)
    scale, unit = prefixed(tallest, "W")
    panel.describe(title, "Subcarrier (strip: its owner)", f"Power ({unit})")
    subcarrier_ticks(panel, owner.size)
    panel.limits(x=(-0.7, owner.size - 0.3))
    colours = _owner_colours(panel, owner, names)
    own = [colours.get(one, GREY) for one in owner.tolist()]
    panel.bars(np.arange(owner.size), power_w / scale, width=0.8, colour=own)
    entries = len(colours) if len(colours) <= len(PALETTE) else 0
    for user, colour in list(colours.items())[:entries]:
        panel.swatch(colour, names[user])
    if level_w is not None:
        panel.level(level_w / scale, label=f"water level {human(level_w, 'W')}")
    _headroom(panel, tallest / scale, entries=entries + (level_w is not None), columns=3)
    panel.strip(np.arange(owner.size), [colours.get(one, "white") for one in owner.tolist()], below=-0.05 * panel.top())


def _owner_colours(panel: Panel, owner: IntArray, names: list[str]) -> dict[int, str]:
    """The colour of each user that owns a subcarrier: its own, one by one, or along a scale where they are too many."""
    owners: list[int] = np.unique(owner[owner >= 0]).tolist()
    if len(names) <= len(PALETTE):
        return {owner: PALETTE[owner] for owner in owners}
    if len(owners) <= len(PALETTE):
        return dict(zip(owners, PALETTE, strict=False))
    scale = panel.colour_scale(len(names), label="Owner (user number)")
    return {owner: scale[owner] for owner in owners}


def _headroom(panel: Panel, tallest: float, *, entries: int, columns: int) -> None:
    """Room above the bars for a legend of so many entries, and the legend."""
    legend_pt = _LEGEND_ROW_PT * (1 + -(-entries // columns))  # a row more, for its frame and air
    share = min(legend_pt / panel.size_pt()[1], 0.6)
    panel.limits(y=(0.0, 1.05 * tallest / (1.0 - share) or 1.0))
    panel.legend(columns=columns, place="upper center")


def _water_level_w(estimate: ChannelEstimate | None, decision: Decision) -> float | None:
    """The common p + 1/a of all powered subcarriers in W; None where they have none, or are fewer than two."""
    if estimate is None:
        return None
    powered = decision.power_w > 0
    gain = owned_gain(estimate.gain, decision.owner)[powered]
    if gain.size < 2 or not np.all(gain > 0):
        return None
    levels = decision.power_w[powered] + 1.0 / normalised_gain(gain, decision.cell)
    return float(levels.mean()) if np.ptp(levels) <= 1e-6 * levels.max() else None


def draw_rates(panel: Panel, decision: Decision, names: list[str], outcome: Outcome | None = None) -> None:
    """Each user's predicted rate, beside it the achieved one where known, and the rate it was promised at least."""
    wanted = decision.problem.min_rates_bps(len(names))
    if not decision.is_usable:
        nothing = "No rate was asked for" if not wanted.any() else ""
        draw_rate_bars(panel, "Rates asked for; nothing is allocated", {}, names, wanted=wanted, nothing=nothing)
    elif outcome is None or outcome.achieved is None:
        draw_rate_bars(panel, "Predicted rates", {"predicted": decision.rate_bps}, names, wanted=wanted)
    else:
        rates = {"predicted": decision.rate_bps, "achieved": outcome.achieved.user_rate_bps}
        missed = np.flatnonzero(outcome.missed)
        draw_rate_bars(panel, "Predicted and achieved rates", rates, names, wanted=wanted, missed=missed)


def draw_rate_bars(
    panel: Panel,
    title: str,
    rates_bps: Mapping[str, FloatArray],
    names: list[str],
    *,
    wanted: FloatArray,
    missed: Sequence[int] | IntArray = (),
    nothing: str = "",
) -> None:
    """A bar for each user and each of one or two kinds of rates, who ``missed`` theirs, and what was ``wanted``."""
    users = np.arange(len(names))
    tallest = np.max([wanted, *rates_bps.values()], axis=0)
    scale, unit = prefixed(float(tallest.max()), "bit/s")
    offset = 0.2 if len(rates_bps) > 1 else 0.0
    for side, (label, rate_bps) in enumerate(rates_bps.items()):
        place = users + (offset if side else -offset)
        panel.bars(place, rate_bps / scale, width=0.8 - 2 * offset, colour=_GREYS[side], label=label)
    panel.describe(title, user_ticks(panel, "x", names), f"Rate ({unit})")
    if tallest.max() == 0:
        panel.note(nothing or "No user gets a rate")
        return
    if len(missed):
        heights = (tallest[missed] + 0.04 * tallest.max()) / scale
        panel.marks(missed, heights, size_pt=6, shape="X", colour=PALETTE[1], label="missed")
    if np.any(wanted > 0):
        panel.segments(users - 0.45, users + 0.45, wanted / scale, label="minimum")
    panel.limits(x=(-0.7, len(names) - 0.3))
    _headroom(panel, float(tallest.max()) / scale, entries=4, columns=4)

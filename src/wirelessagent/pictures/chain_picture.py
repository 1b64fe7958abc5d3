"""One picture of a run of the chain: what was sensed, repaired, decided and, where known, achieved."""

from __future__ import annotations

import textwrap
from pathlib import Path

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.rates import normalised_gain, owned_gain
from wirelessagent.model.units import db
from wirelessagent.pictures.canvas import GREY, PALETTE, Canvas, Panel, can_show, check_suffix

_MOST_NAMED = 16
"""Users up to which every one gets a tick."""

_PREDICTED, _ACHIEVED = "#C4C4C4", "#5A5A5A"
"""Greys, because the colours beside are the users'."""

_ZERO_DB = -4000.0

_SMALLEST_DOTTED_CELL_PT = 5.0

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
    users whose names the font cannot show.
    """
    canvas = Canvas(rows=2, columns=2, width_in=11.0, height_in=7.4)
    sensed, repaired, allocation, rates = canvas.panels
    names = _labels(decision.user_names)
    sensed_db, estimate_db = (_gain_db(gain) for gain in (observation.current, estimate.gain))
    lowest, highest, clipped = _colour_limits(estimate_db)
    for panel, gain_db in ((sensed, sensed_db), (repaired, estimate_db)):
        panel.matrix(gain_db, limits=(lowest, highest), clipped=clipped, colour_label="Power gain (dB)")
        _user_ticks(panel, "y", names)
        _subcarrier_ticks(panel, estimate.num_subcarriers)
    lost = np.count_nonzero(observation.missing)
    share = lost / observation.missing.size
    sensed.describe(f"Sensed: {lost} of {observation.missing.size} gains missing ({share:.0%})", "Subcarrier", "")
    mark = _mark_repaired(repaired, estimate)
    repaired.describe(f"Repaired by {estimate.method} ({mark})" if lost else "Nothing to repair", "Subcarrier", "")
    _draw_allocation(allocation, estimate, decision, names)
    _draw_rates(rates, decision, outcome, names)
    return canvas


def _labels(user_names: tuple[str, ...]) -> list[str]:
    """Names short enough for a tick and within the font's characters; else the user's number."""
    return [
        textwrap.shorten(name, 14, placeholder="…") if can_show(name) and len(name.split(" ")[0]) < 14 else f"user {k}"
        for k, name in enumerate(user_names, start=1)
    ]


def _gain_db(gain: FloatArray) -> FloatArray:
    """Gains in dB; zero becomes a value below every colour scale, while NaN stays NaN."""
    return db(gain, floor_db=_ZERO_DB)


def _colour_limits(gain_db: FloatArray) -> tuple[float, float, bool]:
    """Lowest and highest gain of the colour scale in dB, and whether lower ones exist."""
    positive = gain_db[gain_db > _ZERO_DB]
    if not positive.size:
        return -1.0, 0.0, True
    highest = float(positive.max())
    lowest = max(float(positive.min()), highest - _DYNAMIC_RANGE_DB)
    clipped = lowest > float(gain_db.min())
    return (lowest, highest, clipped) if highest > lowest else (highest - 1.0, highest + 1.0, clipped)


def _user_ticks(panel: Panel, axis: str, names: list[str]) -> None:
    step = max(1, -(-len(names) // _MOST_NAMED))
    shown = range(0, len(names), step)
    slanted = axis == "x" and max(len(names[k]) for k in shown) * len(shown) > 56
    panel.ticks("y" if axis == "y" else "x", list(shown), [names[k] for k in shown], slanted=slanted)


def _subcarrier_ticks(panel: Panel, num_subcarriers: int) -> None:
    """Ticks at subcarriers 1, 1 + step, …, counted from 1."""
    steps = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
    step = next((step for step in steps if num_subcarriers / step <= 8), 5000)
    numbers = sorted({1, *range(step, num_subcarriers + 1, step)})
    if step > 1 and len(numbers) > 1 and numbers[1] - 1 <= step / 2:
        del numbers[1]
    panel.ticks("x", [n - 1 for n in numbers], [str(n) for n in numbers])


def _mark_repaired(panel: Panel, estimate: ChannelEstimate) -> str:
    """Mark the repaired entries and say how: a dot in each, or a paler colour where a dot would not fit."""
    users, subcarriers = np.nonzero(estimate.repaired)
    width, height = panel.size_pt()
    cell = min(width / estimate.num_subcarriers, height / estimate.num_users)
    if cell < _SMALLEST_DOTTED_CELL_PT:
        panel.fade(estimate.repaired)
        return "paler"
    if len(users):
        panel.marks(subcarriers, users, size_pt=min(0.35 * cell, 5.0), shape="o", colour="white", label=None)
    return "white dots"


def _draw_allocation(panel: Panel, estimate: ChannelEstimate, decision: Decision, names: list[str]) -> None:
    """Power per subcarrier in its owner's colour, with the water level where there is one.

    A strip below shows the owner where the power is too little to be seen.
    """
    verdict = f"{decision.total_power_w:.3g} W" if decision.is_usable else decision.status
    panel.describe(f"Decided by {decision.method}: {verdict}", "Subcarrier (strip: its owner)", "Power (W)")
    _subcarrier_ticks(panel, decision.owner.size)
    panel.limits(x=(-0.7, decision.owner.size - 0.3))
    if not decision.is_usable:
        panel.note(textwrap.fill(f"{decision.status}: {decision.reason}", 48))
    if not np.any(decision.power_w > 0):
        return
    colours = _owner_colours(panel, decision, names)
    subcarriers, owners = np.arange(decision.owner.size), decision.owner.tolist()
    own = [colours.get(owner, GREY) for owner in owners]
    panel.bars(subcarriers, decision.power_w, width=0.8, colour=own)
    entries = len(colours) if len(colours) <= len(PALETTE) else 0
    for owner, colour in list(colours.items())[:entries]:
        panel.swatch(colour, names[owner])
    level = _water_level_w(estimate, decision)
    if level is not None:
        panel.level(level, label=f"water level {level:.3g} W")
    _headroom(panel, max(float(decision.power_w.max()), level or 0.0), entries=entries + (level is not None), columns=3)
    panel.strip(subcarriers, [colours.get(owner, "white") for owner in owners], below=-0.05 * panel.top())


def _owner_colours(panel: Panel, decision: Decision, names: list[str]) -> dict[int, str]:
    """The colour of each user that owns a subcarrier: its own, one by one, or along a scale where they are too many."""
    owners: list[int] = np.unique(decision.owner[decision.owner >= 0]).tolist()
    if len(names) <= len(PALETTE):
        return {owner: PALETTE[owner] for owner in owners}
    if len(owners) <= len(PALETTE):
        return dict(zip(owners, PALETTE, strict=False))
    scale = panel.colour_scale(len(names), label="Owner (user number)")
    return {owner: scale[owner] for owner in owners}


def _headroom(panel: Panel, tallest: float, *, entries: int, columns: int) -> None:
    """Room above the bars for a legend of so many entries, and the legend."""
    rows = -(-entries // columns)
    panel.limits(y=(0.0, tallest * (1.10 + 0.12 * rows) or 1.0))
    panel.legend(columns=columns, place="upper center")


def _water_level_w(estimate: ChannelEstimate, decision: Decision) -> float | None:
    """The common p + 1/a of all powered subcarriers in W; None where they have none, or are fewer than two."""
    powered = decision.power_w > 0
    gain = owned_gain(estimate.gain, decision.owner)[powered]
    if gain.size < 2 or not np.all(gain > 0):
        return None
    levels = decision.power_w[powered] + 1.0 / normalised_gain(gain, decision.cell)
    return float(levels.mean()) if np.ptp(levels) <= 1e-6 * levels.max() else None


def _draw_rates(panel: Panel, decision: Decision, outcome: Outcome | None, names: list[str]) -> None:
    """Each user's predicted rate, beside it the achieved one where known, and the rate it was promised at least."""
    achieved = None if outcome is None else outcome.achieved
    users = np.arange(len(names))
    wanted = decision.problem.min_rates_bps(len(names))
    known = [decision.rate_bps, wanted] + ([] if achieved is None else [achieved.user_rate_bps])
    tallest = np.max(known, axis=0)
    scale, unit = _rate_scale(float(tallest.max()))
    offset = 0.0 if achieved is None else 0.2
    width = 0.8 - 2 * offset
    panel.bars(users - offset, decision.rate_bps / scale, width=width, colour=_PREDICTED, label="predicted")
    if achieved is not None and outcome is not None:
        panel.bars(users + offset, achieved.user_rate_bps / scale, width=width, colour=_ACHIEVED, label="achieved")
        missed = np.flatnonzero(outcome.missed)
        heights = (tallest[missed] + 0.04 * tallest.max()) / scale
        if missed.size:
            panel.marks(missed, heights, size_pt=6, shape="X", colour=PALETTE[1], label="missed")
    if np.any(wanted > 0):
        panel.segments(users - 0.45, users + 0.45, wanted / scale, label="minimum")
    title = "Predicted rates" if achieved is None else "Predicted and achieved rates"
    if not decision.is_usable:
        title = "No rates: nothing is allocated"
    panel.describe(title, "", f"Rate ({unit})")
    _user_ticks(panel, "x", names)
    panel.limits(x=(-0.7, len(names) - 0.3))
    _headroom(panel, float(tallest.max()) / scale, entries=4, columns=4)


def _rate_scale(largest_bps: float) -> tuple[float, str]:
    for scale, unit in ((1e9, "Gbit/s"), (1e6, "Mbit/s"), (1e3, "kbit/s")):
        if largest_bps >= scale:
            return scale, unit
    return 1.0, "bit/s"

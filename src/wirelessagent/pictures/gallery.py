"""The picture of every object that has one: small beside its summary in a notebook, large for ``.plot()``.

Objects say what is to be drawn (:class:`wirelessagent.model.shown.Picture`); each kind is one function here, whose
keyword arguments are the picture's parts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from wirelessagent.comparison import Compared
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.gain_views import Matrix
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.shown import Picture
from wirelessagent.model.units import human
from wirelessagent.pictures.canvas import Canvas, Panel
from wirelessagent.pictures.chain_picture import (
    chain_canvas,
    colour_limits,
    draw_allocation,
    draw_powers,
    draw_rate_bars,
    draw_rates,
    gain_db,
    labels,
    mark_repaired,
    subcarrier_ticks,
    user_ticks,
)
from wirelessagent.pictures.compare_picture import comparison_canvas

_SMALL_IN, _LARGE_IN = (4.6, 2.7), (6.6, 4.0)
"""Width and height of a panel."""
_WIDEST_IN = 13.2
"""Of a picture, which is made smaller where a page is narrower, and its words with it."""


def draw(picture: Picture, *, small: bool) -> Canvas:
    """The picture, drawn.

    Raises:
        MissingDependencyError: matplotlib is not installed.
    """
    return _DRAWERS[picture.kind](small=small, **picture.parts)


def _panels(count: int, *, small: bool) -> Canvas:
    width, height = _SMALL_IN if small else _LARGE_IN
    return Canvas(columns=count, width_in=min(width * count, _WIDEST_IN), height_in=height)


def _matrices(*, small: bool, user_names: tuple[str, ...], matrices: Sequence[Matrix]) -> Canvas:
    """One panel for each matrix; only the first where it is small."""
    shown = matrices[:1] if small else matrices
    canvas = _panels(len(shown), small=small)
    gains = [gain_db(matrix.values).ravel() for matrix in shown if matrix.in_db]
    limits = colour_limits(np.concatenate(gains))  # one scale for all, so that they can be compared
    for panel, matrix in zip(canvas.panels, shown, strict=True):
        _draw_matrix(panel, matrix, user_names, limits)
    return canvas


def _draw_matrix(
    panel: Panel, matrix: Matrix, user_names: tuple[str, ...], limits_db: tuple[float, float, bool]
) -> None:
    values = gain_db(matrix.values) if matrix.in_db else matrix.values
    lowest, highest, clipped = limits_db if matrix.in_db else (0.0, _largest(values), False)
    panel.matrix(values, limits=(lowest, highest), clipped=clipped, colour_label=matrix.colour_label)
    subcarrier_ticks(panel, values.shape[1])
    title = matrix.title
    if matrix.marked is not None and matrix.marked.any():
        title = f"{title} ({mark_repaired(panel, matrix.marked)})"
    panel.describe(title, matrix.x_label, user_ticks(panel, "y", labels(user_names)))


def _largest(values: FloatArray) -> float:
    """The largest that is known, for a scale from 0."""
    known = values[~np.isnan(values)]
    return float(known.max(initial=0.0)) or 1.0


def _decision(*, small: bool, decision: Decision) -> Canvas:
    """Who has which subcarrier at what power, and the rates that come of it."""
    canvas = _panels(2, small=small)
    names = labels(decision.user_names)
    draw_allocation(canvas.panels[0], decision, names, decision.estimate)
    draw_rates(canvas.panels[1], decision, names)
    return canvas


def _outcome(*, small: bool, outcome: Outcome) -> Canvas:
    """The allocation as it was read back, and what became of the rates."""
    canvas = _panels(2, small=small)
    count = outcome.promised_bps.size
    names = labels(tuple(f"user {user + 1}" for user in range(count)))
    allocation, rates = canvas.panels
    title = f"Read back: {human(float(outcome.power_w.sum()), 'W')}"
    if outcome.power_w.any():
        draw_powers(allocation, title, outcome.owner, outcome.power_w, names)
    else:
        allocation.describe(title, "", "")
        allocation.note("No power is radiated")
    known = {} if outcome.achieved is None else {"achieved": outcome.achieved.user_rate_bps}
    title = f"Committed{' and achieved' if known else ''} rates"
    found = {"committed": outcome.promised_bps, **known}
    draw_rate_bars(rates, title, found, names, wanted=np.zeros(count), missed=np.flatnonzero(outcome.missed))
    return canvas


def _rates(*, small: bool, decision: Decision, achieved: LinkMetrics | None, missed_users: tuple[int, ...]) -> Canvas:
    """Each user's predicted rate beside the achieved one."""
    canvas = _panels(1, small=small)
    names, panel = labels(decision.user_names), canvas.panels[0]
    if achieved is None:
        draw_rates(panel, decision, names)
        return canvas
    found = {"predicted": decision.rate_bps, "achieved": achieved.user_rate_bps}
    wanted = decision.problem.min_rates_bps(len(names))
    draw_rate_bars(panel, "Predicted and achieved rates", found, names, wanted=wanted, missed=missed_users)
    return canvas


def _comparison(*, small: bool, found: Sequence[Compared]) -> Canvas:
    del small  # its rows are as many as there are methods
    return comparison_canvas(found)


def _chain(
    *,
    small: bool,
    observation: ChannelObservation,
    estimate: ChannelEstimate,
    decision: Decision,
    outcome: Outcome | None,
) -> Canvas:
    """The four stages of a run; small, what was decided and achieved."""
    if not small:
        return chain_canvas(observation=observation, estimate=estimate, decision=decision, outcome=outcome)
    canvas = _panels(2, small=True)
    names = labels(decision.user_names)
    draw_allocation(canvas.panels[0], decision, names, estimate)
    draw_rates(canvas.panels[1], decision, names, outcome)
    return canvas


_DRAWERS: Mapping[str, Callable[..., Canvas]] = {
    "matrices": _matrices,
    "decision": _decision,
    "outcome": _outcome,
    "rates": _rates,
    "comparison": _comparison,
    "chain": _chain,
}

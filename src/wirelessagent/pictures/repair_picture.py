"""A picture of a repair: what was sensed, what it was completed to, and how sure each completed gain is."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.pictures.canvas import Canvas, check_suffix
from wirelessagent.pictures.chain_picture import draw_gains, labels, subcarrier_ticks, user_ticks


def draw_repair(*, observation: ChannelObservation, estimate: ChannelEstimate, path: Path) -> None:
    """Write :func:`repair_canvas` to ``path``: PNG, SVG or PDF, whole or not at all.

    Raises:
        InputError: an unknown suffix, or a path that cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    check_suffix(path)
    repair_canvas(observation=observation, estimate=estimate).save(path)


def repair_canvas(*, observation: ChannelObservation, estimate: ChannelEstimate) -> Canvas:
    """The gains of the current slot before and after, and the deviation of each repaired one in shares of its gain."""
    canvas = Canvas(columns=3, width_in=15.0, height_in=4.2)
    sensed, repaired, sure = canvas.panels
    names = labels(estimate.user_names)
    draw_gains(sensed, repaired, observation, estimate, names)
    if not estimate.repaired.any():
        sure.note("Nothing was repaired, so nothing is uncertain but by measurement")
        return canvas
    known = estimate.repaired & (estimate.gain > 0)
    share = np.full(estimate.gain.shape, np.nan)
    np.divide(np.sqrt(estimate.gain_variance), estimate.gain, out=share, where=known)
    highest = max(1.0, float(share[known].max(initial=0.0)))
    sure.matrix(share, limits=(0.0, highest), clipped=False, colour_label="Standard deviation / gain")
    subcarrier_ticks(sure, estimate.num_subcarriers)
    sure.describe("How sure the repaired gains are (others hatched)", "Subcarrier", user_ticks(sure, "y", names))
    return canvas

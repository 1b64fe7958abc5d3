"""Output files: checked before the work starts, so that a mistyped name costs nothing.

Also the metadata beside gains in a file of ours, and the pictures.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wirelessagent import __version__
from wirelessagent.model.atomic import writable_target
from wirelessagent.model.errors import InputError, MissingDependencyError

if TYPE_CHECKING:
    from wirelessagent.comparison import Compared
    from wirelessagent.model.cell import Cell
    from wirelessagent.model.decision import Decision
    from wirelessagent.model.estimate import ChannelEstimate
    from wirelessagent.model.observation import ChannelObservation
    from wirelessagent.model.outcome import Outcome


def check_allocation(path: Path | None) -> None:
    """Raise an error where an allocation cannot be written to ``path``; None is fine."""
    if path is not None:
        from wirelessagent.acting.file import allocation_writer

        allocation_writer(path)
        writable_target(path)


def check_gains(path: Path | None, *, csv: bool = False) -> None:
    """Raise an error where gains cannot be written to ``path``, as CSV only if ``csv``; None is fine."""
    if path is not None:
        if csv and path.suffix.lower() not in (".csv", ".npz"):
            raise InputError(f"gains are written as NPZ or CSV; end the name in .npz or .csv instead of {path.name!r}")
        if not csv:
            from wirelessagent.sensing.npz import check_npz

            check_npz(path)
        writable_target(path)


def is_csv(path: Path) -> bool:
    """Whether its name says that a file is to be CSV."""
    return path.suffix.lower() == ".csv"


def check_picture(path: Path | None) -> None:
    """Raise an error where a picture cannot be drawn to ``path``; None is fine."""
    if path is not None:
        from wirelessagent.pictures.canvas import check_suffix, require_matplotlib

        check_suffix(path)
        writable_target(path)
        require_matplotlib()


def can_draw() -> bool:
    """Whether what draws pictures is installed."""
    from wirelessagent.pictures.canvas import require_matplotlib

    try:
        require_matplotlib()
    except MissingDependencyError:
        return False
    return True


def draw_run(
    path: Path,
    observation: ChannelObservation,
    estimate: ChannelEstimate,
    decision: Decision,
    outcome: Outcome | None = None,
) -> None:
    """Draw a run of the chain; the drawing library is loaded only here."""
    from wirelessagent.pictures.chain_picture import draw_chain

    draw_chain(observation=observation, estimate=estimate, decision=decision, outcome=outcome, path=path)


def draw_repair(path: Path, observation: ChannelObservation, estimate: ChannelEstimate) -> None:
    """Draw what a repair did; the drawing library is loaded only here."""
    from wirelessagent.pictures import repair_picture

    repair_picture.draw_repair(observation=observation, estimate=estimate, path=path)


def draw_comparison(path: Path, found: Sequence[Compared]) -> None:
    """Draw methods side by side; the drawing library is loaded only here."""
    from wirelessagent.pictures import compare_picture

    compare_picture.draw_comparison(found, path)


def channel_meta(cell: Cell, *, axes: str, maker: str = "") -> dict[str, Any]:
    """The metadata beside gains in a file of ours, read back by the file source."""
    return {
        "generator": f"wirelessagent {__version__}{maker}",
        "axes": axes,
        "units": "linear power gain",
        "rb_bandwidth_hz": cell.subcarrier_bandwidth_hz,
        "noise_w_per_rb": cell.noise_power_w,
    }

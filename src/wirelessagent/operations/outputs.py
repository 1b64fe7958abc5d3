"""Checks of output files before the work starts: a mistyped name costs nothing, and no stage is shown in vain."""

from __future__ import annotations

from pathlib import Path

from wirelessagent.acting.file import allocation_writer
from wirelessagent.model.atomic import writable_target


def check_allocation(path: Path | None) -> None:
    """Raise an error where an allocation cannot be written to ``path``; None is fine."""
    if path is not None:
        allocation_writer(path)
        writable_target(path)


def check_gains(path: Path | None) -> None:
    """Raise an error where gains cannot be written to ``path``; None is fine."""
    if path is not None:
        writable_target(path)


def check_picture(path: Path | None) -> None:
    """Raise an error where a picture cannot be drawn to ``path``; None is fine."""
    if path is not None:
        from wirelessagent.pictures.canvas import check_suffix, require_matplotlib

        check_suffix(path)
        writable_target(path)
        require_matplotlib()

"""A gain matrix in a file as the input of an operation."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, cast

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.model.scene import Scene
from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.fields import OptionsOf, PluginOptions, Positional
from wirelessagent.operations.operation import Event, Progress
from wirelessagent.sensing.source import ChannelSource


class ChannelFile(CellOptions):
    """A file with gains, how to read it, and the cell it belongs to."""

    panel: ClassVar[str] = "Options"

    path: Annotated[Path, Positional()] = Field(
        description="gain matrix: CSV, JSON, NPZ, NPY, MATLAB, HDF5 or netCDF; users in rows, NaN or empty = missing"
    )
    file_options: Annotated[PluginOptions, OptionsOf("channel_source", only="file", but=("path",))] = Field(
        default_factory=dict, description="how to read the file"
    )

    def scene(self, progress: Progress, *, wanted_power_w: float | None = None) -> Scene:
        """What the file holds, told to ``progress`` as it was understood."""
        return file_scene(self, self.path, self.file_options, progress, wanted_power_w=wanted_power_w)


_DETAILS = frozenset({"array", "separator", "range", "users", "frequencies", "slot times", "truth"})
"""Facts that the record holds and a terminal can do without."""


def file_scene(
    cell_options: CellOptions,
    path: Path,
    options: Mapping[str, Any],
    progress: Progress,
    *,
    wanted_power_w: float | None = None,
) -> Scene:
    """The scene in a file; options of the cell that were given win over what the file states."""
    source = cast(ChannelSource, plugins.create("channel_source", "file", {**options, "path": path}))
    scene = source.observe(cell_options.cell())
    scene = dataclasses.replace(scene, cell=cell_options.cell(scene.cell, wanted_power_w=wanted_power_w))
    understood = "; ".join(f"{label}: {text}" for label, text in scene.facts.items() if label not in _DETAILS)
    progress(Event(stage="sense", message=f"{path}: {understood}"))
    return scene

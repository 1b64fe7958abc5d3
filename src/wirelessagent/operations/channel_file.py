"""A gain matrix in a file as the input of an operation."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, cast

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.fields import OptionsOf, PluginOptions, Positional
from wirelessagent.operations.operation import Event, Progress
from wirelessagent.operations.pseudonyms import hidden_scene

if TYPE_CHECKING:
    from wirelessagent.model.scene import Scene
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
    """The scene in a file; options of the cell that were given win over what the file states, and the facts say so."""
    from wirelessagent.model.units import human

    source = cast("ChannelSource", plugins.create("channel_source", "file", {**options, "path": path}))
    scene = hidden_scene(source.observe(cell_options.cell()))
    cell = cell_options.cell(scene.cell, wanted_power_w=wanted_power_w)
    facts = {**scene.facts, **_given(cell_options, scene)}
    if cell_options.cell_max_power_w is None and cell.max_power_w > scene.cell.max_power_w:
        facts["power limit"] = f"{human(cell.max_power_w, 'W')} (the budget; --cell-max-power-w sets another)"
    scene = dataclasses.replace(scene, cell=cell, facts=facts)
    understood = "; ".join(f"{label}: {text}" for label, text in scene.facts.items() if label not in _DETAILS)
    progress(Event(stage="read", message=f"{path}: {understood}"))
    return scene


def _given(options: CellOptions, scene: Scene) -> dict[str, str]:
    """The facts on bandwidth and noise that were given as options, beside what the file says of them."""
    from wirelessagent.model.units import human
    from wirelessagent.sensing.file_metadata import FROM_FILE

    facts: dict[str, str] = {}
    fields: tuple[tuple[str, str, Callable[[float], str]], ...] = (
        ("bandwidth", "subcarrier_bandwidth_hz", lambda value: human(value, "Hz")),
        ("noise", "noise_psd_w_per_hz", lambda value: f"{value:.4g} W/Hz"),
    )
    for label, name, shown in fields:
        given = getattr(options, name)
        if given is not None:
            stated = scene.facts.get(label, "").endswith(f"({FROM_FILE})")
            instead = f"; the file says {shown(getattr(scene.cell, name))}" if stated else ""
            facts[label] = f"{shown(given)} (given{instead})"
    return facts

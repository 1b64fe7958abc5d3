"""A cell to talk about as options: its channel, what gets lost, its base station, and who understands."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field

from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.channel_file import file_scene
from wirelessagent.operations.fields import Advanced, Known, Local, OptionsOf, PluginName, PluginOptions
from wirelessagent.operations.operation import Progress
from wirelessagent.operations.recognisers import RecogniserOption
from wirelessagent.operations.simulate import loss_patterns
from wirelessagent.operations.tool_options import MethodOptions, RepairerOptions

if TYPE_CHECKING:
    from wirelessagent.agent.session import Session
    from wirelessagent.model.scene import Loss, Scene


class SiteOptions(RecogniserOption, MethodOptions, RepairerOptions, CellOptions):
    """All that a conversation about a cell starts from."""

    panel: ClassVar[str] = "Options"

    csi: Path | None = Field(None, description="gain matrix to work on; a simulated cell if not given")
    source: Annotated[str, PluginName("channel_source"), Advanced()] = Field(
        "rayleigh", description="channel source without --csi"
    )
    source_options: Annotated[PluginOptions, OptionsOf("channel_source", but=("path",))] = Field(
        default_factory=dict, description="options of the channel source; with --csi, how to read the file"
    )
    loss: Annotated[list[str] | None, Known(loss_patterns)] = Field(
        None,
        description="what gets lost, such as random:0.3 or bursts:0.2+users:1; random:0.2 for a simulated cell and "
        "nothing for a file if not given",
    )
    base_station: Annotated[str | None, PluginName("base_station"), Advanced()] = Field(
        None, description="base station; simulated where the true channel is known"
    )
    base_station_options: Annotated[PluginOptions, OptionsOf("base_station")] = Field(
        default_factory=dict, description="options of the base station"
    )
    yes: Annotated[bool, Local()] = Field(False, description="apply without asking; simulated base stations never ask")
    tolerance: Annotated[float | None, Advanced()] = Field(
        None,
        ge=0,
        description="share of what was promised that may be lacking before it is taken back; 0.1 if not given",
    )
    seed: int = Field(1, description="seed of every draw")

    def scene(self, progress: Progress) -> Scene:
        """The cell and its channel."""
        if self.csi is not None:
            return file_scene(self, self.csi, self.source_options, progress)
        from wirelessagent import chain

        return chain.simulate(self.source, self.cell(), seed=self.seed, **self.source_options)

    def session(self, progress: Progress, **settings: Any) -> Session:
        """A conversation about the cell that was not begun yet; ``settings`` of the session win over the options."""
        from wirelessagent.agent.acting import TOLERANCE
        from wirelessagent.agent.session import Session
        from wirelessagent.agent.turn import Tools

        options: dict[str, Any] = {
            "seed": self.seed,
            "recogniser": self.chosen_recogniser(),
            "confirm": False if self.yes else None,
            "tolerance": TOLERANCE if self.tolerance is None else self.tolerance,
            "tools": Tools(**{item.name: getattr(self, item.name) for item in dataclasses.fields(Tools)}),
            "progress": progress,
        }
        return Session(self.scene(progress), *self.losses(), **{**options, **settings})

    def losses(self) -> list[Loss]:
        """What gets lost."""
        from wirelessagent.sensing.loss import parse

        default_loss = [] if self.csi else ["random:0.2"]
        return [parse(text) for text in (default_loss if self.loss is None else self.loss)]
